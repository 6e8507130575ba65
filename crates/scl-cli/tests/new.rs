//! `scl new`: each template is built, tested, checked and run as a new user would, without a network.

use crate::system::System;
use std::os::unix::fs::PermissionsExt;
use std::process::Output;

#[cfg(feature = "run")]
mod built;
#[cfg(all(feature = "observe", feature = "record", feature = "run"))]
mod commands;

fn new(system: &System, arguments: &[&str]) -> Output {
    system.scl(&[&["new"], arguments].concat()).output().unwrap()
}

/// The names in the folder, hidden ones too.
fn names(system: &System) -> Vec<String> {
    let entries = std::fs::read_dir(system.path("")).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_last_line_says_what_to_do_next() {
    let system = System::of_files(&[]);
    let output = new(&system, &["rover"]);
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "cd rover && scl run\n");
    assert!(String::from_utf8(output.stderr).unwrap().starts_with("created `rover` with "));
    assert_eq!(output.status.code(), Some(0));
    for name in [
        "Cargo.toml",
        "topology.yaml",
        "rover.proto",
        "src/bin/sensor.rs",
        "src/bin/controller.rs",
        "src/bin/display.rs",
        "tests/controller.rs",
        "launch.yaml",
        ".github/workflows/ci.yml",
        "README.md",
        ".gitignore",
    ] {
        assert!(system.path("rover").join(name).is_file(), "{name}");
    }
    assert_eq!(names(&system), ["rover"]);
}

#[test]
fn names_that_cannot_be_used_write_nothing() {
    let system = System::of_files(&[]);
    let too_long = "a_name_that_goes_on_and_on_and_on_and_on_a";
    for (name, expected) in [
        ("2nd", "error: [SCL0305] a system name must start with a letter or `_`\n"),
        ("a b", "error: [SCL0303] a system name cannot contain a space\n"),
        ("röver", "error: [SCL0304] system name `röver` contains the letter `ö` (U+00F6), which is not ASCII\n"),
        ("a--b", "error: [SCL0303] a system name cannot contain two hyphens in a row\n"),
        (too_long, "error: [SCL0312] this name has 42 characters; the limit is 40\n"),
        ("it's", "error: [SCL0303]"),
        ("", "error: `` cannot be a name\n"),
        ("\u{1b}[31m", "error: `\\u{1b}[31m` cannot be a name\n"),
        ("a: [b", "error: [SCL0303]"),
        ("a/b", "error: `a/b` is a path, not a name\n"),
        ("..", "error: [SCL030"),
        ("_", "error: `_` has no letter\n"),
        ("null", "error: a project cannot be called `null`\n  = help: for example `my_null`\n"),
        ("type", "error: a project cannot be called `type`\n"),
        ("Self", "error: a project cannot be called `Self`\n"),
        ("crate", "error: a project cannot be called `crate`\n"),
        ("test", "error: a project cannot be called `test`\n"),
        ("core", "error: a project cannot be called `core`\n"),
        ("proc-macro", "error: a project cannot be called `proc-macro`\n"),
        ("scl", "error: a project cannot be called `scl`\n"),
        ("f64", "error: a project cannot be called `f64`\n"),
        ("controller", "error: a project cannot be called `controller`\n"),
    ] {
        let output = new(&system, &[name]);
        let err = String::from_utf8(output.stderr).unwrap();
        assert!(err.starts_with(expected), "{name}: {err}");
        assert_eq!((output.status.code(), output.stdout), (Some(2), Vec::new()), "{name}");
        assert!(names(&system).is_empty(), "{name}");
    }
}

#[test]
fn nothing_existing_is_touched() {
    let system = System::of_files(&[("folder/mine", "a"), ("file", "b")]);
    std::fs::create_dir(system.path("empty")).unwrap();
    std::os::unix::fs::symlink("nowhere", system.path("link")).unwrap();
    for name in ["folder", "file", "empty", "link"] {
        let output = new(&system, &[name]);
        let err = String::from_utf8(output.stderr).unwrap();
        assert!(err.contains(&format!("called `{name}` exists already\n  = help: choose another name")), "{err}");
        assert_eq!(output.status.code(), Some(2));
    }
    assert_eq!(names(&system), ["empty", "file", "folder", "link"]);
    assert_eq!(std::fs::read_to_string(system.path("folder/mine")).unwrap(), "a");
    assert_eq!(std::fs::read_to_string(system.path("file")).unwrap(), "b");
    assert_eq!(std::fs::read_dir(system.path("folder")).unwrap().count(), 1);
}

/// The limit of the size of a file stops the writing half-way, also for root, whom no permission stops.
#[test]
fn a_failed_write_leaves_nothing() {
    let system = System::of_files(&[]);
    let scl = env!("CARGO_BIN_EXE_scl");
    // Units of 512 bytes. Without the signal, the write fails with an error.
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" new rover";
    let mut shell = system.scl(&[]);
    shell = {
        let mut command = std::process::Command::new("/bin/sh");
        command.args(["-c", script, scl]).current_dir(shell.get_current_dir().unwrap());
        command
    };
    let output = shell.output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.starts_with("error: cannot write the project `rover`: File too large"), "{err}");
    assert_eq!((output.status.code(), output.stdout), (Some(2), Vec::new()));
    assert!(names(&system).is_empty());
}

#[test]
fn a_folder_without_permission_to_write_is_named() {
    let system = System::of_files(&[]);
    // `/proc` refuses new folders from everybody; permissions would not stop root.
    let output = system.scl(&["new", "rover"]).current_dir("/proc").output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.starts_with("error: cannot write the project `rover`: "), "{err}");
    assert_eq!(output.status.code(), Some(2));

    std::fs::set_permissions(system.path(""), PermissionsExt::from_mode(0o555)).unwrap();
    let may_write = std::fs::write(system.path("probe"), "").is_ok();
    let output = new(&system, &["rover"]);
    std::fs::set_permissions(system.path(""), PermissionsExt::from_mode(0o755)).unwrap();
    assert_eq!(output.status.code(), Some(if may_write { 0 } else { 2 }));
}

#[test]
fn a_repository_is_named_by_its_url() {
    let system = System::of_files(&[]);
    let output = new(&system, &["rover", "--git", "git@host:team/scl.git", "--rev", "4f1d2ab"]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.ends_with("files; it uses SCL from ssh://git@host/team/scl.git at 4f1d2ab\n"), "{err}");
    let file = |name: &str| std::fs::read_to_string(system.path("rover").join(name)).unwrap();
    let (manifest, ci) = (file("Cargo.toml"), file(".github/workflows/ci.yml"));
    let line = "scl = { package = \"scl-gates\", git = \"ssh://git@host/team/scl.git\", rev = \"4f1d2ab\" }\n";
    assert!(manifest.contains(line), "{manifest}");
    assert!(ci.contains("cargo install --git 'ssh://git@host/team/scl.git' --rev '4f1d2ab' scl-cli --no"), "{ci}");

    for (arguments, expected) in [
        (
            &["--git", "/srv/scl"][..],
            "error: `/srv/scl` is not the URL of a repository\n  = help: for example `https://",
        ),
        (&["--git", "\u{1b}[31m"], "error: `\\u{1b}[31m` is not the URL"),
        (&["--git", "https://host/scl", "--path", "."], "error: the argument '--git <URL>' cannot be used with"),
        (&["--rev", "4f1d2ab"], "error: the following required arguments were not provided"),
    ] {
        let output = new(&system, &[&["other"], arguments].concat());
        let err = String::from_utf8(output.stderr).unwrap();
        assert!(err.starts_with(expected), "{arguments:?}: {err}");
        assert_eq!(output.status.code(), Some(2));
    }
    assert_eq!(names(&system), ["rover"]);
}

#[test]
fn a_project_for_this_machine_only_says_so() {
    let system = System::of_files(&[("repository/scl/Cargo.toml", "[package]\nname = \"scl-gates\"\n")]);
    let output = new(&system, &["rover", "--path", "repository"]);
    let err = String::from_utf8(output.stderr).unwrap();
    let note = "note: it builds on this machine only, because SCL is at `../repository/scl`; `--git URL` names";
    assert!(err.contains(note), "{err}");
}

#[test]
fn a_path_must_lead_to_scl() {
    let system = System::of_files(&[
        ("repository/scl/Cargo.toml", "[package]\nname = \"scl-gates\"\n"),
        ("repository/Cargo.lock", "version = 4\n"),
        ("other/Cargo.toml", "[package]\nname = \"other\"\n"),
    ]);
    for (path, expected) in [("other", "`other` is not a copy of SCL"), ("nowhere", "`nowhere` is not a folder")] {
        let output = new(&system, &["rover", "--path", path]);
        let err = String::from_utf8(output.stderr).unwrap();
        assert!(err.starts_with(&format!("error: {expected}\n  = help: name the folder of SCL's repository")), "{err}");
        assert_eq!(output.status.code(), Some(2));
    }
    let absolute = system.path("repository").to_str().unwrap().to_owned();
    for (name, path, expected) in [
        ("one", "repository", "../repository/scl"),
        ("two", "./repository/scl", "../repository/scl"),
        ("three", &absolute, &format!("{absolute}/scl")),
    ] {
        assert_eq!(new(&system, &[name, "--path", path]).status.code(), Some(0));
        let manifest = std::fs::read_to_string(system.path(name).join("Cargo.toml")).unwrap();
        let line = format!("scl = {{ package = \"scl-gates\", path = \"{expected}\" }}\n");
        assert!(manifest.contains(&line), "{manifest}");
        assert!(system.path(name).join("Cargo.lock").is_file());
    }
}
