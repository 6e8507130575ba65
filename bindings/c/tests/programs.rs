//! The programs in C, compiled as they are and with AddressSanitizer, and what they are started with.

use scl::plan::SystemPlan;
use scl::untyped::Component;
use scl_tests::{Compile, Process, System};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use tempfile::TempDir;

/// How a program is compiled. With AddressSanitizer, a leak is a failure, too, also one of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Build {
    Plain,
    Address,
}

/// The component `program` of a runtime folder, as a C program, and the plan of its system.
pub struct Program {
    pub system: System,
    build: Build,
    plan: PathBuf,
    plans: SystemPlan,
    _folder: TempDir,
}

/// The programs that were compiled by this process.
static COMPILED: Mutex<BTreeMap<(Build, String), PathBuf>> = Mutex::new(BTreeMap::new());

/// Runs a test with programs as they are and with AddressSanitizer.
pub fn on_each_build(test: impl Fn(Program)) {
    for build in [Build::Plain, Build::Address] {
        test(Program::new(System::new(), build));
    }
}

impl Program {
    pub fn new(system: System, build: Build) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let (plan, plans) = (folder.path().join("plan.json"), plans("border.yaml"));
        std::fs::write(&plan, plans.to_json()).unwrap();
        Self { system, build, plan, plans, _folder: folder }
    }

    /// The path of the plan, for programs that read it.
    pub fn plan(&self) -> &str {
        self.plan.to_str().unwrap()
    }

    /// Opens the peer in this process.
    pub fn peer(&self) -> Component {
        Component::open_blocking_with(self.plans.component("peer").unwrap(), self.system.options()).unwrap()
    }

    /// Starts a program of the folder `programs` with the path of the plan and more arguments.
    pub fn start(&self, program: &str, more: &[&str]) -> Process {
        self.start_with(program, more, &[])
    }

    /// Starts a program with more environment variables.
    pub fn start_with(&self, program: &str, more: &[&str], environment: &[(&str, &str)]) -> Process {
        let program = compiled(program, self.build);
        let arguments = [&[self.plan()], more].concat();
        self.system.start_with(program.to_str().unwrap(), &arguments, environment)
    }

    /// Starts a program with another plan.
    pub fn start_plan(&self, program: &str, plan: &Path, more: &[&str]) -> Process {
        let program = compiled(program, self.build);
        self.system.start(program.to_str().unwrap(), &[&[plan.to_str().unwrap()], more].concat())
    }

    /// Starts any command in the runtime folder.
    pub fn spawn(&self, mut command: Command) -> Process {
        command.env("SCL_RUNTIME_DIR", self.system.runtime_dir());
        Process::spawn(command)
    }

    /// Starts `commands` and waits until it has opened the component.
    #[track_caller]
    pub fn commands(&self) -> Process {
        let mut process = self.start("commands", &["program", ""]);
        process.expect("open");
        process
    }
}

/// The plans of a topology file in this folder.
pub fn plans(file: &str) -> SystemPlan {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(file);
    let loaded = scl_loader::load(&scl_loader::Request::new(path));
    let problems = || loaded.diagnostics.iter().map(|found| found.message.to_string()).collect::<Vec<_>>();
    loaded.system_plan().unwrap_or_else(|| panic!("{file}: {:#?}", problems()))
}

/// The path of a program of the folder `programs`.
pub fn source(program: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/programs/{program}.c"))
}

/// A compiled program.
pub fn compiled(program: &str, build: Build) -> PathBuf {
    let mut compiled = COMPILED.lock().unwrap_or_else(PoisonError::into_inner);
    let made = compiled.entry((build, program.to_owned())).or_insert_with(|| {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("c-{program}-{build:?}"));
        let mut compile = Compile::c(source(program)).option("-D_GNU_SOURCE").option("-pthread");
        if build == Build::Address {
            compile = compile.option("-fsanitize=address,undefined").option("-fno-sanitize-recover=all");
        }
        compile.program(&path);
        path
    });
    made.clone()
}

/// A shared library, compiled from a source in C.
pub fn shared_library(source: &Path, name: &str, options: &[&str]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("c-{name}.so"));
    let compile = Compile::c(source).option("-D_GNU_SOURCE").option("-pthread").option("-shared").option("-fPIC");
    options.iter().fold(compile, |compile, option| compile.option(*option)).program(&path);
    path
}

/// Asserts that a program ends with success, which it does not after a leak.
#[track_caller]
pub fn expect_success(process: Process) {
    let exit = process.wait_for_exit();
    assert_eq!(exit.code(), 0, "{exit:?}");
}
