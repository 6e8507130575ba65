//! `scl diff` between a git revision and the files of today.

use super::*;

fn git(system: &System, arguments: &[&str]) {
    let mut command = Command::new("git");
    command.args(["-c", "user.name=test", "-c", "user.email=test@localhost", "-c", "init.defaultBranch=main"]);
    let output = command.arg("-C").arg(system.path("")).args(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

fn commit_all(system: &System, message: &str) {
    git(system, &["add", "."]);
    git(system, &["commit", "-q", "-m", message]);
}

/// A repository whose last commit has [`ROVER`], and whose working folder has the new topology.
fn repository(new: &str) -> System {
    let system = System::of_files(&[("rover/topology.yaml", ROVER)]);
    git(&system, &["init", "-q"]);
    commit_all(&system, "first");
    system.write("rover/topology.yaml", &ROVER.replace("sensor: sub", "sensor: {sub: rover.Measurement, queue: 7}"));
    commit_all(&system, "second");
    system.write("rover/topology.yaml", new);
    system
}

fn diff_in(system: &System, folder: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = system.scl(&[&["diff"], arguments].concat()).current_dir(system.path(folder)).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn a_git_revision_is_compared_with_the_file() {
    let system = repository(ROVER);
    let index = std::fs::read(system.path(".git/index")).unwrap();
    assert_eq!(diff_in(&system, "rover", &["HEAD~1"]).0, Some(0));
    let (code, text, error) = diff_in(&system, "rover", &["HEAD"]);
    assert_eq!((code, &*error), (Some(1), ""));
    assert!(text.contains("controller.sensor") && text.contains("queue"), "{text}");
    assert_eq!(diff_in(&system, "", &["HEAD", "--", "rover/topology.yaml"]), (code, text.clone(), error));
    let (code, between, _) = diff_in(&system, "rover", &["HEAD~1..HEAD"]);
    assert_eq!(code, Some(1));
    assert!(between.contains("controller.sensor"), "{between}");
    assert_eq!(diff_in(&system, "rover", &["HEAD..HEAD"]).0, Some(0));
    assert_eq!(std::fs::read(system.path(".git/index")).unwrap(), index, "the index is left alone");
}

#[test]
fn schemas_are_those_of_the_revision() {
    let proto = "syntax = \"proto3\";\npackage rover;\nmessage Fix { double x = 1; }\n";
    let topology = "system: rover\nschemas: [../proto/rover.proto]\ncomponents:\n  - {name: a, gates: [fix: {pub: rover.Fix}]}\n  \
                    - {name: b, gates: [fix: sub]}\nconnections: [[a.fix, b.fix]]\n";
    let system = repository(ROVER);
    system.write("proto/rover.proto", proto);
    system.write("rover/topology.yaml", topology);
    commit_all(&system, "third");
    assert_eq!(diff_in(&system, "rover", &["HEAD"]), (Some(0), String::new(), String::new()));
    system.write("proto/rover.proto", &proto.replace("double", "string"));
    let (code, text, error) = diff_in(&system, "rover", &["HEAD"]);
    assert_eq!((code, &*error), (Some(1), ""));
    assert!(text.contains("rover.Fix"), "{text}");
}

#[test]
fn revisions_that_cannot_be_read_are_explained() {
    let system = repository(ROVER);
    for (arguments, expected) in [
        (
            &["HEAD~9"][..],
            "error: there is no git revision `HEAD~9`\n  = help: two files are compared with `scl diff OLD NEW`\n",
        ),
        (&["topology.yaml"], "error: there is no git revision `topology.yaml`\n"),
        (&["--", "x"], "required"),
        (&["HEAD", "--", "other.yaml"], "error: revision `HEAD` has no file `rover/other.yaml`\n"),
    ] {
        let (code, text, error) = diff_in(&system, "rover", arguments);
        assert_eq!((code, &*text), (Some(2), ""), "{arguments:?}: {error}");
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
    let outside = System::of_files(&[("topology.yaml", ROVER)]);
    let mut command = outside.scl(&["diff", "HEAD"]);
    let output = command.env("GIT_CEILING_DIRECTORIES", outside.path("").parent().unwrap()).output().unwrap();
    assert!(
        String::from_utf8_lossy(&output.stderr).starts_with("error: `.` is not in a git repository\n"),
        "{output:?}"
    );
}

#[test]
fn included_files_are_those_of_the_revision() {
    let (sensors, rest) = ROVER.split_at(ROVER.find("  - name: controller").unwrap());
    let sensors = sensors.strip_prefix("system: rover\n").unwrap_or(sensors);
    let system = repository(ROVER);
    system.write("parts/sensors.yaml", sensors);
    system
        .write("rover/topology.yaml", &format!("system: rover\ninclude: [../parts/sensors.yaml]\ncomponents:\n{rest}"));
    commit_all(&system, "third");
    assert_eq!(diff_in(&system, "rover", &["HEAD~2"]), (Some(0), String::new(), String::new()));
    system.write("parts/sensors.yaml", &sensors.replace("measurements", "samples"));
    let (code, _, error) = diff_in(&system, "rover", &["HEAD"]);
    assert_eq!(code, Some(2), "{error}");
    assert!(error.contains("sensor` has no gate"), "{error}");
}
