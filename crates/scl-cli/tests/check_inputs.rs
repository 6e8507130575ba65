//! What `scl check` does with everything that may stand behind a path, and with `--deny`.

use crate::system::{SpawnGuarded, System};
use std::fs::{self, File, Permissions};
use std::io::Write;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::{Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

const CLEAN: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
";

fn warned() -> String {
    CLEAN.replace("connections:", "  - name: logger\nconnections:")
}

fn told(output: &Output) -> (Option<i32>, String) {
    (output.status.code(), String::from_utf8(output.stderr.clone()).unwrap())
}

#[track_caller]
fn check(system: &System, arguments: &[&str], code: i32, part: &str) {
    let (found, text) = told(&system.scl(&[&["check"], arguments].concat()).output().unwrap());
    assert_eq!(found, Some(code), "{arguments:?}: {text}");
    assert!(text.contains(part), "{arguments:?} does not say `{part}`:\n{text}");
    assert!(!text.contains("panicked"), "{text}");
}

#[track_caller]
fn check_stdin(system: &System, input: &[u8], arguments: &[&str], code: i32, part: &str) {
    let mut command = system.scl(&[&["check"], arguments].concat());
    let mut process = command.stdin(Stdio::piped()).stderr(Stdio::piped()).stdout(Stdio::piped()).spawn_guarded();
    // A refused input is not read to its end, so writing it may fail.
    let _ = process.stdin.take().unwrap().write_all(input);
    let output = process.wait_with_output();
    let (found, text) = told(&output);
    let text = text + &String::from_utf8(output.stdout).unwrap();
    assert_eq!(found, Some(code), "{text}");
    assert!(text.contains(part), "does not say `{part}`:\n{text}");
}

#[test]
fn standard_input_is_a_file_like_any_other() {
    let schema = "syntax = \"proto3\"; package rover; message Fix {}";
    let system = System::of_files(&[("rover.proto", schema), ("clean.yaml", CLEAN)]);
    let typed = CLEAN.replace("pub", "{pub: rover.Fix}");
    check_stdin(&system, CLEAN.as_bytes(), &["-"], 0, "<stdin>: 2 components, 2 gates, 1 connection");
    check_stdin(&system, b"\xef\xbb\xbfcolour: red\n", &["-"], 1, " --> <stdin>:1:1");
    check_stdin(&system, format!("schemas: [rover.proto]\n{typed}").as_bytes(), &["-"], 0, "1 connection");
    check_stdin(&system, b"", &["-"], 1, "SCL0115");
    check_stdin(&system, b"\xff\xfe", &["-"], 2, "`<stdin>` is not valid UTF-8");
    check_stdin(&system, &vec![b' '; 1024 * 1024 + 1], &["-"], 2, "SCL0004");
    check_stdin(&system, b"colour: red\n", &["--format", "json", "clean.yaml", "-"], 1, "\"file\":\"<stdin>\"");
    check_stdin(&system, b"", &["-", "-"], 2, "standard input can be read only once");
    check_stdin(&system, b"", &["-", "--watch"], 2, "standard input cannot be watched");
}

#[test]
fn endless_and_odd_standard_inputs_end() {
    let system = System::of_files(&[]);
    for (input, part) in [("/dev/zero", "SCL0004"), ("/dev/null", "SCL0115"), (".", "standard input cannot be read")] {
        let file = File::open(system.path(input)).unwrap();
        let (_, text) = told(&system.scl(&["check", "-"]).stdin(file).output().unwrap());
        assert!(text.contains(part), "{input}: {text}");
    }
}

#[test]
fn odd_paths_are_refused_without_waiting() {
    let system = System::of_files(&[("folder/topology.yaml", CLEAN)]);
    system.make_pipe("pipe.yaml");
    symlink("b.yaml", system.path("a.yaml")).unwrap();
    symlink("a.yaml", system.path("b.yaml")).unwrap();
    symlink("nowhere.yaml", system.path("dangling.yaml")).unwrap();
    check(&system, &["folder"], 2, "`folder` is a directory, not a file");
    check(&system, &["folder"], 2, "did you mean `folder/topology.yaml`?");
    check(&system, &["pipe.yaml"], 2, "is a named pipe");
    check(&system, &["/dev/zero"], 2, "is a device");
    check(&system, &["a.yaml"], 2, "a symbolic link that cannot be followed");
    check(&system, &["dangling.yaml"], 2, "a symbolic link that cannot be followed");
    check(&system, &[""], 2, "a value is required");
}

#[test]
fn links_spaces_and_letters_are_no_obstacle() {
    let system = System::of_files(&[("mein Rover/Übersicht 火星.yaml", CLEAN)]);
    symlink("mein Rover/Übersicht 火星.yaml", system.path("link.yaml")).unwrap();
    check(&system, &["mein Rover/Übersicht 火星.yaml"], 0, "mein Rover/Übersicht 火星.yaml: 2 components");
    check(&system, &["link.yaml"], 0, "link.yaml: 2 components");
}

#[test]
fn nothing_is_written_beside_the_file() {
    let system = System::of_files(&[("locked/topology.yaml", CLEAN)]);
    fs::set_permissions(system.path("locked"), Permissions::from_mode(0o555)).unwrap();
    check(&system, &["locked/topology.yaml"], 0, "2 components");
    let names = fs::read_dir(system.path("locked")).unwrap().count();
    fs::set_permissions(system.path("locked"), Permissions::from_mode(0o755)).unwrap();
    assert_eq!(names, 1);
}

#[test]
fn a_file_that_changes_while_it_is_read_is_no_panic() {
    let system = System::of_files(&[("topology.yaml", CLEAN)]);
    let (path, ended) = (system.path("topology.yaml"), AtomicBool::new(false));
    thread::scope(|scope| {
        scope.spawn(|| {
            while !ended.load(Ordering::Relaxed) {
                for text in [CLEAN, &warned(), "components: [", "\u{feff}", ""] {
                    fs::write(&path, text).unwrap();
                }
            }
        });
        for _ in 0..30 {
            let (code, text) = told(&system.scl(&["check"]).output().unwrap());
            assert!(matches!(code, Some(0 | 1)) && !text.contains("panicked"), "{code:?}: {text}");
        }
        ended.store(true, Ordering::Relaxed);
    });
}

#[test]
fn denied_warnings_are_errors_and_say_so() {
    let system = System::of_files(&[("topology.yaml", &warned())]);
    let untyped = "this connection carries bytes of no declared type";
    check(&system, &[], 0, "warning: [SCL0209]");
    check(&system, &["--deny", "warnings"], 1, "error: [SCL0209]");
    check(&system, &["--deny", "warnings"], 1, "= note: an error because of `--deny warnings`");
    check(&system, &["--deny", "warnings"], 1, "1 connection; 1 error\n");
    check(&system, &["--deny", "SCL0209"], 1, "= note: an error because of `--deny SCL0209`");
    check(&system, &["--deny", "scl0402"], 1, &format!("error: [SCL0402] {untyped}"));
    check(&system, &["--deny", "SCL0302"], 0, "1 warning");
    check(&system, &["--lints", "--deny", "warnings"], 1, "1 error, 1 lint");
    check(&system, &["--deny", "everything"], 2, "expected `warnings` or a code like `SCL0402`");
}
