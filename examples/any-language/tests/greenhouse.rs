//! The whole example as real processes: an SCL component between programs that have only a ZeroMQ library.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use scl_generate::{Format, System as Topology, Target, generate};
use scl_loader::{Request, load};
use scl_tests::{Process, System, python_with_packages};
use std::path::{Path, PathBuf};

const STATION: &str = env!("CARGO_BIN_EXE_station");

#[derive(Debug, Clone, Copy)]
enum Language {
    Python,
    Rust,
}

const LANGUAGES: [Language; 2] = [Language::Python, Language::Rust];

impl Language {
    /// Starts `publish`, `subscribe` or `ask`.
    fn start(self, system: &System, program: &str, arguments: &[&str]) -> Process {
        match self {
            Self::Rust => {
                let path = Path::new(STATION).with_file_name(format!("plain_{program}"));
                system.start(path.to_str().unwrap(), arguments)
            }
            Self::Python => {
                let script = folder().join("python").join(format!("{program}.py")).display().to_string();
                system.start(python_with_packages().to_str().unwrap(), &[&[script.as_str()], arguments].concat())
            }
        }
    }
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn plain_programs_publish_subscribe_and_ask() {
    for language in LANGUAGES {
        for other in LANGUAGES {
            let system = System::new();
            let _station = system.start(STATION, &[]);
            let _probe = language.start(&system, "publish", &["15"]);
            let mut heater = other.start(&system, "subscribe", &[]);
            heater.expect("heating on");
            let mut panel = language.start(&system, "ask", &["10"]);
            panel.expect("before: 20.0");
            heater.expect_containing("heating off");
            let mut panel = other.start(&system, "ask", &["18.5"]);
            panel.expect("before: 10.0");
            heater.expect_containing("heating on");
        }
    }
}

/// What joins a system in a new language stays small.
#[test]
fn a_plain_program_has_at_most_40_lines() {
    let mut count = 0;
    for part in ["python", "src/bin"] {
        for entry in std::fs::read_dir(folder().join(part)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                let lines = std::fs::read_to_string(&path).unwrap().lines().count();
                assert!(lines <= 40, "{} has {lines} lines", path.display());
                count += 1;
            }
        }
    }
    assert_eq!(count, 7);
}

#[test]
fn the_file_of_sockets_is_up_to_date() {
    let topology = Topology::of(&load(&Request::new(folder().join("topology.yaml")))).unwrap();
    let file = generate(&topology, Target::Zmq(Format::Json)).unwrap().remove(0);
    expect_test::expect_file!["../greenhouse.zmq.json"].assert_eq(&file.text);
}
