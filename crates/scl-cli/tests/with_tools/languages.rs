//! `examples/languages`: the quick start in four languages, as `scl run` builds and runs it on a new machine.

use crate::system::{BuildFolder, Started, System};
use std::path::{Path, PathBuf};
use std::process::Command;

/// One test, because its parts build into the same folder and would wait for each other.
#[test]
fn every_language_runs_every_component_and_takes_over_from_another() {
    let _build_folder = BuildFolder::lock();
    let example = Example::new();
    for profile in ["rust", "c", "cpp", "python"] {
        example.check_lines(&["--profile", profile]);
    }
    example.check_lines(&[]);
    example.compile_the_listings();
    example.swap_the_controller();
}

#[test]
fn a_machine_without_compilers_is_told_what_to_install() {
    let example = Example::new();
    // What the build script itself needs.
    std::fs::create_dir(example.system.path("bin")).unwrap();
    for tool in ["dirname", "mkdir"] {
        std::os::unix::fs::symlink(Path::new("/usr/bin").join(tool), example.system.path("bin").join(tool)).unwrap();
    }
    let packages = [
        ("c", "gcc make pkg-config protobuf-compiler protobuf-c-compiler libprotobuf-c-dev"),
        ("cpp", "g++ make cmake pkg-config protobuf-compiler libprotobuf-dev"),
        ("python", "python3-venv"),
    ];
    for (profile, packages) in packages {
        let run = example.start_with(&["--profile", profile, "--only", "controller"], |command| {
            command.env("PATH", example.system.path("bin"));
        });
        let (status, _, err) = run.finish();
        let told = format!("controller | error: missing: {packages}; on Debian: apt-get install {packages}\n");
        assert!(err.contains(&told), "{err}");
        assert_eq!(status.code(), Some(2));
    }
}

/// The listings of the readme: as long as its table says.
#[test]
fn the_readme_counts_the_lines_of_its_listings() {
    let readme = std::fs::read_to_string(example().join("README.md")).unwrap();
    let lines_of = |listing: &str| listing.lines().filter(|line| !line.trim().is_empty()).count();
    for (language, fence) in [("Rust", "rust"), ("C", "c"), ("C++", "cpp"), ("Python", "python")] {
        let [publisher, subscriber] = listings(&readme, fence).map(|listing| lines_of(&listing));
        let row = format!("| {language} | {publisher} | {subscriber} |\n");
        assert!(readme.contains(&row), "README.md lacks `{row}`");
    }
}

/// The publisher and the subscriber in a language.
fn listings(readme: &str, fence: &str) -> [String; 2] {
    let start = format!("```{fence}\n");
    let blocks = readme.split(&start).skip(1).filter_map(|rest| rest.split("```").next());
    blocks.map(str::to_owned).collect::<Vec<_>>().try_into().unwrap()
}

struct Example {
    system: System,
}

impl Example {
    fn new() -> Self {
        Self { system: System::of_files(&[]) }
    }

    fn start(&self, arguments: &[&str]) -> Started {
        self.start_with(arguments, |_| {})
    }

    fn start_with(&self, arguments: &[&str], prepare: impl Fn(&mut Command)) -> Started {
        let example = example();
        let arguments = [&[example.to_str().unwrap(), "--grace", "1h"], arguments].concat();
        self.system.start_with(&arguments, |command| {
            command.env("SCL_RUNTIME_DIR", self.system.path("run")).env_remove("SCL_SYSTEM");
            prepare(command);
        })
    }

    /// The lines are the same whatever the languages.
    fn check_lines(&self, arguments: &[&str]) {
        let mut run = self.start(arguments);
        let mut speeds = Vec::new();
        let mut throttles = 0;
        loop {
            let Some(line) = run.next_line() else { panic!("{arguments:?} ends: {}", run.finish().2) };
            match line.split_once(" | ").unwrap() {
                ("sensor        ", says) => {
                    speeds.push(says.to_owned());
                    assert!(
                        speeds.len() < 1000,
                        "{arguments:?}: the sensor runs, but the user interface gets no events"
                    );
                }
                ("actuator      ", says) => {
                    let throttle = says.strip_prefix("throttle ").unwrap();
                    let value: f64 = throttle.parse().unwrap();
                    assert!(throttle.len() == 5 && throttle.starts_with(['+', '-']), "{arguments:?}: {line}");
                    assert!((-1.0..=1.0).contains(&value), "{arguments:?}: {line}");
                    throttles += 1;
                }
                ("user_interface", "event: target is now 1.5 m/s") => break,
                ("user_interface", says) => {
                    let known = ["asked for 0.5 m/s: ", "asked for 1.5 m/s: ", "event: target is now 0.5 m/s"];
                    assert!(known.iter().any(|start| says.starts_with(start)), "{arguments:?}: {line}");
                }
                _ => panic!("{arguments:?}: {line}"),
            }
        }
        assert_eq!(speeds[..3], ["speed 1.00 m/s", "speed 1.84 m/s", "speed 1.91 m/s"], "{arguments:?}");
        assert!(throttles > 0, "{arguments:?}");
        stop(run, "-INT", &["sensor", "controller", "actuator", "user_interface"]);
    }

    /// What the listings of the readme call beside SCL is declared here.
    fn compile_the_listings(&self) {
        let readme = std::fs::read_to_string(example().join("README.md")).unwrap();
        self.system.write("hardware.h", "double read_hardware(void);\nvoid apply(double throttle);\n");
        let workspace = workspace();
        let source = workspace.join("examples/quickstart");
        let topology = source.join("topology.yaml");
        let include = |folder: &str| format!("-I{}", workspace.join(folder).display());
        let languages =
            [("c", "cc", "-std=c11", "protoc-c", "--c_out=."), ("cpp", "c++", "-std=c++17", "protoc", "--cpp_out=.")];
        for (fence, compiler, standard, protoc, out) in languages {
            self.succeed(&mut self.system.scl(&["generate", "--for", fence, topology.to_str().unwrap(), "-o", "."]));
            self.succeed(Command::new(protoc).arg(out).arg("--proto_path").arg(&source).arg("rover.proto"));
            for listing in listings(&readme, fence) {
                let name = format!("listing.{fence}");
                self.system.write(&name, &listing);
                let mut command = Command::new(compiler);
                command.args([standard, "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-include", "hardware.h"]);
                command.args(["bindings/c/include", "bindings/cpp/include"].map(include)).args(["-I.", &name]);
                self.succeed(&mut command);
            }
        }
        let python = workspace.join("target/examples/venv/bin/python");
        for listing in listings(&readme, "python") {
            let program = format!("import ast; ast.parse({listing:?})");
            self.succeed(Command::new(&python).args(["-c", &program]));
        }
    }

    fn succeed(&self, command: &mut Command) {
        let output = command.current_dir(self.system.path("")).output().unwrap();
        assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    }

    /// The others go on while the controller is killed and its twin in another language starts.
    fn swap_the_controller(&self) {
        let mut others = self.start(&["--without", "controller"]);
        let first = self.start(&["--only", "controller"]);
        others.wait_for("user_interface | event: target is now ");
        first.signal("-KILL");
        assert!(!first.finish().0.success());
        others.wait_until("no answer", |line| line.starts_with("user_interface") && line.ends_with("no answer"));
        let twin = self.start(&["--only", "controller", "--profile", "python"]);
        others.wait_for("user_interface | event: target is now ");
        others.wait_for("actuator       | throttle ");
        stop(twin, "-TERM", &["controller"]);
        stop(others, "-TERM", &["sensor", "actuator", "user_interface"]);
    }
}

fn stop(run: Started, signal: &str, components: &[&str]) {
    run.signal(signal);
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
    let width = components.iter().map(|name| name.len()).max().unwrap();
    for name in components {
        assert!(err.contains(&format!("{name:width$}  ended with exit code 0 after ")), "{name}: {err}");
    }
}

fn example() -> PathBuf {
    workspace().join("examples/languages")
}

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().to_owned()
}
