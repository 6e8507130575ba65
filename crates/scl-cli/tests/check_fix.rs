//! `scl check --fix` on real files: what is written, what is printed, and the exit codes.

use crate::system::{SpawnGuarded, System};
use expect_test::{Expect, expect};
use std::fs;
use std::io::Write;
use std::process::Stdio;

/// Two mistakes with a sure fix, one without.
const WRONG: &str = "\
components:
  - name: sensor
    gates:
      - measurements: publish
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor/measurements, controller.sensor]
  - [sensor.measurements, nobody.there]
";

fn fixed() -> String {
    WRONG.replace("publish", "pub").replace("sensor/measurements", "sensor.measurements")
}

/// What `scl check --fix` with these arguments prints, and its exit code.
fn run(system: &System, arguments: &[&str]) -> (String, String, Option<i32>) {
    let output = system.scl(&[&["check", "--fix"], arguments].concat()).output().unwrap();
    (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap(), output.status.code())
}

#[track_caller]
fn check(text: &str, arguments: &[&str], code: i32, expected: Expect) -> String {
    let system = System::of_files(&[("topology.yaml", text)]);
    let (out, err, found) = run(&system, arguments);
    expected.assert_eq(&format!("{out}----\n{err}"));
    assert_eq!(found, Some(code));
    fs::read_to_string(system.path("topology.yaml")).unwrap()
}

#[test]
fn sure_fixes_are_written_and_the_rest_is_told() {
    let text = check(
        WRONG,
        &[],
        1,
        expect![[r#"
            ----
            topology.yaml: 2 problems fixed

            error: [SCL0501] unknown component `nobody`
              --> topology.yaml:10:27
               |
            10 |   - [sensor.measurements, nobody.there]
               |                           ^^^^^^ no component has this name
               |
               = help: declare the component `nobody` with the gate `there` (sub), or remove the connection
               = note: declared components: `controller`, `sensor`

            topology.yaml: 1 error
        "#]],
    );
    assert_eq!(text, fixed());
}

#[test]
fn line_ends_and_a_missing_last_one_stay() {
    for spelt in [
        |text: &str| text.replace('\n', "\r\n"),
        |text: &str| text.trim_end().to_owned(),
        |text: &str| format!("\u{feff}{}", text.replace('\n', "\r\n").trim_end()),
    ] {
        let system = System::of_files(&[("topology.yaml", &spelt(WRONG))]);
        assert_eq!(run(&system, &[]).2, Some(1));
        assert_eq!(fs::read_to_string(system.path("topology.yaml")).unwrap(), spelt(&fixed()));
    }
}

#[test]
fn a_dry_run_prints_the_difference_and_writes_nothing() {
    let text = check(
        WRONG,
        &["--dry-run"],
        1,
        expect![[r#"
            --- topology.yaml
            +++ topology.yaml
            @@ -1,10 +1,10 @@
             components:
               - name: sensor
                 gates:
            -      - measurements: publish
            +      - measurements: pub
               - name: controller
                 gates:
                   - sensor: sub
             connections:
            -  - [sensor/measurements, controller.sensor]
            +  - [sensor.measurements, controller.sensor]
               - [sensor.measurements, nobody.there]
            ----
            topology.yaml: 2 problems can be fixed

            error: [SCL0401] unknown gate kind `publish`
             --> topology.yaml:4:23
              |
            4 |       - measurements: publish
              |                       ^^^^^^^
              |
              = help: the kind is called `pub`
              = note: kinds: `pub` and `sub` (one to many, no answer), `req` and `rep` (question and answer), `push` and `pull` (many to one, no answer)

            error: [SCL0503] a connection end is written `component.gate`
             --> topology.yaml:9:6
              |
            9 |   - [sensor/measurements, controller.sensor]
              |      ^^^^^^^^^^^^^^^^^^^ `/` instead of a dot
              |
              = help: write `sensor.measurements`

            error: [SCL0501] unknown component `nobody`
              --> topology.yaml:10:27
               |
            10 |   - [sensor.measurements, nobody.there]
               |                           ^^^^^^ no component has this name
               |
               = help: declare the component `nobody` with the gate `there`, or remove the connection
               = note: declared components: `controller`, `sensor`

            topology.yaml: 3 errors
        "#]],
    );
    assert_eq!(text, WRONG);
}

#[test]
fn a_difference_is_what_patch_reads() {
    let system = System::of_files(&[("topology.yaml", &WRONG.replace('\n', "\r\n"))]);
    fs::write(system.path("fixes.diff"), run(&system, &["--dry-run"]).0).unwrap();
    let patch = std::process::Command::new("git")
        .args(["apply", "-p0", "fixes.diff"])
        .current_dir(system.path(""))
        .output()
        .unwrap();
    assert!(patch.status.success(), "{}", String::from_utf8_lossy(&patch.stderr));
    assert_eq!(fs::read_to_string(system.path("topology.yaml")).unwrap(), fixed().replace('\n', "\r\n"));
}

#[test]
fn standard_input_comes_out_fixed() {
    let system = System::of_files(&[]);
    let mut child = system.scl(&["check", "--fix", "-"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn_guarded();
    child.stdin.take().unwrap().write_all(WRONG.as_bytes()).unwrap();
    let output = child.wait_with_output();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), fixed());
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn what_needs_no_fix_is_not_written() {
    let system = System::of_files(&[("topology.yaml", &fixed())]);
    let written = || fs::metadata(system.path("topology.yaml")).unwrap().modified().unwrap();
    let before = written();
    run(&system, &[]);
    assert_eq!(written(), before);
}

#[test]
fn a_fixed_file_is_clean_with_every_format() {
    let wrong = WRONG.replace("  - [sensor.measurements, nobody.there]\n", "");
    for format in ["text", "json", "sarif", "cargo"] {
        let system = System::of_files(&[("topology.yaml", &wrong)]);
        assert_eq!(run(&system, &["--format", format]).2, Some(0), "{format}");
    }
}

#[test]
fn arguments_that_contradict_are_refused() {
    for arguments in [&["--watch"][..], &["--dry-run", "--format", "json"], &["-", "--format", "sarif"]] {
        let system = System::of_files(&[("topology.yaml", WRONG)]);
        assert_eq!(run(&system, arguments).2, Some(2), "{arguments:?}");
        assert_eq!(fs::read_to_string(system.path("topology.yaml")).unwrap(), WRONG);
    }
}

#[test]
fn a_larger_file_needs_its_size() {
    let large = format!("{WRONG}#{}\n", " ".repeat(1 << 20));
    let system = System::of_files(&[("topology.yaml", &large)]);
    for (arguments, code) in [
        (&["check"][..], 2),
        (&["check", "--max-size", "2MiB"], 1),
        (&["schema", "topology.yaml", "--max-size", "2MiB"], 0),
    ] {
        assert_eq!(system.scl(arguments).output().unwrap().status.code(), Some(code), "{arguments:?}");
    }
    for command in ["graph", "diff"] {
        let sound = large
            .replace("publish", "pub")
            .replace("sensor/", "sensor.")
            .replace("  - [sensor.measurements, nobody.there]\n", "");
        fs::write(system.path("topology.yaml"), sound).unwrap();
        let files = if command == "diff" { &["topology.yaml", "topology.yaml"][..] } else { &["topology.yaml"] };
        let code = |more: &[&str]| system.scl(&[&[command], files, more].concat()).output().unwrap().status.code();
        assert_eq!((code(&[]), code(&["--max-size", "2MiB"])), (Some(2), Some(0)), "{command}");
    }
    let refused = system.scl(&["check", "--max-size", "2MB"]).output().unwrap();
    assert!(String::from_utf8(refused.stderr).unwrap().contains("did you mean `2MiB`?"));
}

/// A file with two mistakes in its connections, and one in a file that it includes.
fn two_files() -> [(&'static str, String); 2] {
    let (sensors, rest) = WRONG.split_at(WRONG.find("  - name: controller").unwrap());
    let main = format!("include: [parts/sensors.yaml]\ncomponents:\n{rest}");
    [("topology.yaml", main), ("parts/sensors.yaml", sensors.to_owned())]
}

#[test]
fn an_included_file_is_fixed_too() {
    let files = two_files();
    let system = System::of_files(&files.each_ref().map(|(name, text)| (*name, text.as_str())));
    let (out, err, code) = run(&system, &[]);
    assert_eq!((out.as_str(), code), ("", Some(1)), "{err}");
    assert!(err.starts_with("topology.yaml: 2 problems fixed\n"), "{err}");
    let read = |name: &str| fs::read_to_string(system.path(name)).unwrap();
    for (name, text) in &files {
        let expected = text.replace("publish", "pub").replace("sensor/measurements", "sensor.measurements");
        assert_eq!(read(name), expected.replace("sensor.controller", "controller.sensor"), "{name}");
    }
}

#[test]
fn a_dry_run_prints_the_differences_of_all_files() {
    let files = two_files();
    let system = System::of_files(&files.each_ref().map(|(name, text)| (*name, text.as_str())));
    let (out, err, _) = run(&system, &["--dry-run"]);
    let headers: Vec<&str> = out.lines().filter(|line| line.starts_with("+++")).collect();
    assert_eq!(headers, ["+++ topology.yaml", "+++ parts/sensors.yaml"]);
    assert!(err.starts_with("topology.yaml: 2 problems can be fixed\n"), "{err}");
    assert!(err.contains("= note: `parts/sensors.yaml` is included at topology.yaml:1:11"), "{err}");
    files.iter().for_each(|(name, text)| assert_eq!(&fs::read_to_string(system.path(name)).unwrap(), text));
}
