//! Projects that are built. It takes as long as a new user waits, less what the tests have already compiled.

use crate::new::new;
use crate::system::{BuildFolder, System};
use std::process::Command;

#[test]
fn the_minimal_template_is_built_tested_checked_and_run() {
    let project = Project::new("zoo", "minimal");
    project.check();
    project.talks(2, &["display | speed 1.84 m/s", "display | speed 1.91 m/s"]);
}

#[test]
fn the_control_template_is_built_tested_checked_and_run() {
    // A name that code spells in another way, and that sorts before the names of crates.
    let project = Project::new("Air-Ship", "control");
    project.check();
    project.talks(
        3,
        &[
            "sensor     | speed 1.84 m/s",
            "display    | throttle -0.",
            "display    | asked for 0.5 m/s: accepted",
            "display    | event: target is now 0.5 m/s",
        ],
    );
}

#[test]
fn the_drive_template_is_built_tested_checked_and_run() {
    let project = Project::new("carrier", "drive");
    project.check();
    project.talks(6, &["logger      | rear_left: runs", "logger      | chassis: drives: all wheels report"]);
}

struct Project {
    system: System,
    name: &'static str,
    build_folder: BuildFolder,
}

impl Project {
    fn new(name: &'static str, template: &str) -> Self {
        let build_folder = BuildFolder::lock();
        let system = System::of_files(&[]);
        // Not by the URL of a repository, which would take a network.
        let repository = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        let output = new(&system, &[name, "--template", template, "--path", repository]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        Self { system, name, build_folder }
    }

    /// What the CI file of the project runs.
    fn check(&self) {
        self.succeeds(self.cargo(&["fmt", "--check"]));
        self.succeeds(self.cargo(&["clippy", "--quiet", "--all-targets", "--", "-D", "warnings"]));
        let tested = self.succeeds(self.cargo(&["test"]));
        let passed = tested.lines().filter(|line| line.starts_with("test ") && line.ends_with(" ... ok")).count();
        assert!(passed > 0, "{tested}");
        self.succeeds(self.prepared(self.system.scl(&["check", "--deny", "warnings", "--lints"])));
    }

    /// Waits until its processes have printed a line that starts like each of these, in any order.
    fn talks(&self, processes: usize, starts: &[&str]) {
        let mut run = self.system.start_with(&[self.name], |command| {
            self.environment(command);
        });
        let (mut missing, mut lines) = (starts.to_vec(), 0);
        while !missing.is_empty() {
            let Some(line) = run.next_line() else {
                panic!("no lines {missing:?}:\n{}", run.finish().2);
            };
            missing.retain(|start| !line.starts_with(start));
            // More than a minute of output.
            lines += 1;
            assert!(lines < 2000, "no lines {missing:?}, but `{line}`");
        }
        run.signal("-INT");
        let (status, _, err) = run.finish();
        assert_eq!(status.code(), Some(0), "{err}");
        assert_eq!(err.matches(" ended with exit code 0 after ").count(), processes, "{err}");
    }

    fn cargo(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO"));
        command.args(arguments);
        self.prepared(command)
    }

    fn prepared(&self, mut command: Command) -> Command {
        command.current_dir(self.system.path(self.name));
        self.environment(&mut command);
        command
    }

    fn environment(&self, command: &mut Command) {
        command.env("CARGO_NET_OFFLINE", "true").env("CARGO_TARGET_DIR", self.build_folder.path());
        command.env("SCL_RUNTIME_DIR", self.system.path("run"));
    }

    fn succeeds(&self, mut command: Command) -> String {
        let output = command.output().unwrap();
        let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success(), "{command:?}:\n{out}{err}");
        out.into_owned()
    }
}
