//! Programs that fork when they are told to.

use rustix::process::Signal;
use scl_tests::{Process, System, wait_until};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// What programs need to fork, and where their children read and write.
pub(crate) struct Forking {
    folder: TempDir,
}

impl Forking {
    /// Builds the library that makes a program fork.
    pub(crate) fn new() -> Self {
        let forking = Self { folder: TempDir::with_prefix("scl").expect("a folder") };
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/src/fork_on_signal.c");
        let built = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(forking.library()).arg(source).status();
        assert!(built.is_ok_and(|status| status.success()), "needs a C compiler called `cc`");
        forking
    }

    /// Starts a program that reads its commands with its first thread.
    pub(crate) fn start(&self, system: &System, program: &str, component: &str) -> Process {
        let text = |path: &Path| path.to_str().expect("UTF-8").to_owned();
        let (library, input, output) = (text(&self.library()), text(&self.input()), text(&self.output()));
        let environment = [("LD_PRELOAD", &*library), ("CHILD_INPUT", &*input), ("CHILD_OUTPUT", &*output)];
        system.start_with(program, &[component], &environment)
    }

    /// Forks a program, which has no other child, and gives the child commands. Returns what the child said until its
    /// end.
    pub(crate) fn fork(&self, parent: &Process, commands: &str) -> String {
        fs::write(self.input(), format!("{commands}\n")).expect("written");
        parent.signal(Signal::USR1);
        wait_until("the child has ended", || child_has_ended(parent.id()));
        let said = fs::read_to_string(self.output()).expect("what the child said");
        fs::remove_file(self.output()).expect("removed");
        said
    }

    fn library(&self) -> PathBuf {
        self.folder.path().join("fork_on_signal.so")
    }

    fn input(&self) -> PathBuf {
        self.folder.path().join("input")
    }

    fn output(&self) -> PathBuf {
        self.folder.path().join("output")
    }
}

/// Returns true if the only child of a program's first thread has ended, and waits for its parent to notice.
fn child_has_ended(parent: u32) -> bool {
    let children = fs::read_to_string(format!("/proc/{parent}/task/{parent}/children")).unwrap_or_default();
    let status = fs::read_to_string(format!("/proc/{}/stat", children.trim())).unwrap_or_default();
    status.rsplit(')').next().is_some_and(|fields| fields.trim_start().starts_with('Z'))
}
