//! The programs in `languages`, each compiled or generated once.

use crate::cpp::build::{cached, program as cpp_program, run};
use rustix::process::Signal;
use scl_generate::{Format, Target, generate};
use scl_tests::{Compile, Exit, Process, System, python_with_packages, python_with_scl};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// The formats of messages: each pattern has a gate for each.
pub(super) const FORMATS: [&str; 3] = ["protobuf", "json", "bytes"];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Language {
    Rust,
    C,
    Cpp,
    Python,
    Libzmq,
    Pyzmq,
}
use Language::{C, Cpp, Libzmq, Python, Pyzmq, Rust};

const MATRIX: &str = env!("CARGO_BIN_EXE_matrix");

/// The languages of SCL.
pub(super) const SCL: [Language; 4] = [Rust, C, Cpp, Python];
/// Programs without SCL.
pub(super) const PLAIN: [Language; 2] = [Libzmq, Pyzmq];
pub(super) const ALL: [Language; 6] = [Rust, C, Cpp, Python, Libzmq, Pyzmq];

/// A program of the matrix, open.
pub(super) struct Program {
    pub(super) language: Language,
    process: Process,
    component: &'static str,
}

impl Program {
    /// Compiles or generates the program now, where its start must not take that long.
    pub(super) fn build(language: Language) {
        match language {
            Rust => {}
            C => drop(LazyLock::force(&C_PROGRAM)),
            Cpp => drop(LazyLock::force(&CPP_PROGRAM)),
            Python => drop((python_with_scl(), LazyLock::force(&GENERATED))),
            Libzmq => drop(LazyLock::force(&LIBZMQ_PROGRAM)),
            Pyzmq => drop((python_with_packages(), LazyLock::force(&GENERATED))),
        }
    }

    /// Starts `left` or `right` and waits until its gates are open.
    #[track_caller]
    pub(super) fn start(system: &System, language: Language, component: &'static str) -> Self {
        Self::start_with(system, language, component, &[])
    }

    /// The same with more environment variables.
    #[track_caller]
    pub(super) fn start_with(
        system: &System,
        language: Language,
        component: &'static str,
        more: &[(&str, &str)],
    ) -> Self {
        let mut process = match language {
            Rust => system.start_with(MATRIX, &[component], more),
            C => system.start_with(text(&C_PROGRAM), &[component], more),
            Cpp => system.start_with(text(&CPP_PROGRAM), &[component], more),
            Python => start_python(system, &[component], more),
            Libzmq => {
                let arguments = [vec![component.to_owned()], endpoints(system, component)].concat();
                system.start(text(&LIBZMQ_PROGRAM), &arguments.iter().map(String::as_str).collect::<Vec<_>>())
            }
            Pyzmq => {
                let python = python_with_packages().to_str().expect("text");
                let file = GENERATED.join("matrix.zmq.json");
                let descriptors = GENERATED.join("matrix.desc");
                let main = languages().join("pyzmq/main.py");
                let folder = folder(system);
                system.start(python, &[text(&main), component, text(&file), text(&folder), text(&descriptors)])
            }
        };
        process.expect("open");
        Self { language, process, component }
    }

    /// Starts a component with the plan of another topology, without generated code.
    #[track_caller]
    pub(super) fn start_plan(system: &System, language: Language, component: &'static str, plan: &str) -> Self {
        let mut process = match language {
            Rust => system.start(MATRIX, &[component, plan]),
            C => system.start(text(&C_PROGRAM), &[component, plan]),
            Cpp => system.start(text(&CPP_PROGRAM), &[component, plan]),
            Python => start_python(system, &[component, plan], &[]),
            Libzmq | Pyzmq => unreachable!("a plain program has no plan"),
        };
        process.expect("open");
        Self { language, process, component }
    }

    pub(super) fn is_plain(&self) -> bool {
        PLAIN.contains(&self.language)
    }

    pub(super) fn id(&self) -> u32 {
        self.process.id()
    }

    pub(super) fn tell(&mut self, command: &str) {
        self.process.tell(command);
    }

    #[track_caller]
    pub(super) fn answer(&mut self, command: &str) -> String {
        self.process.tell(command);
        self.process.next_line()
    }

    #[track_caller]
    pub(super) fn expect(&mut self, expected: &str) {
        let (line, who) = (self.process.next_line(), (self.language, self.component));
        assert_eq!(line, expected, "from {who:?}");
    }

    #[track_caller]
    pub(super) fn ask(&mut self, command: &str, expected: &str) {
        let (line, who) = (self.answer(command), (self.language, self.component));
        assert_eq!(line, expected, "from {who:?} after `{command}`");
    }

    #[track_caller]
    pub(super) fn get_ready(&mut self) {
        self.process.get_ready();
    }

    /// What a gate has sent, received and rejected. Plain programs do not count.
    #[track_caller]
    pub(super) fn expect_account(&mut self, gate: &str, expected: &str) {
        if !self.is_plain() {
            self.ask(&format!("account {gate}"), expected);
        }
    }

    pub(super) fn kill(self) {
        self.process.kill();
    }

    pub(super) fn terminate(self) -> Exit {
        self.signal(Signal::TERM);
        self.process.wait_for_exit()
    }

    pub(super) fn signal(&self, signal: Signal) {
        self.process.signal(signal);
    }

    /// Ends the program by closing its input.
    #[track_caller]
    pub(super) fn end(self) {
        let (language, exit) = (self.language, self.process.wait_for_exit());
        assert_eq!(exit.code(), 0, "{language:?}: {exit:?}");
    }
}

fn start_python(system: &System, arguments: &[&str], more: &[(&str, &str)]) -> Process {
    let python = python_with_scl().to_str().expect("text");
    let main = languages().join("python/main.py");
    system.start_with(
        python,
        &[&[text(&main)], arguments].concat(),
        &[&[("PYTHONPATH", text(&GENERATED))], more].concat(),
    )
}

static CPP_PROGRAM: LazyLock<PathBuf> = LazyLock::new(|| {
    cpp_program(&languages().join("cpp/main.cpp"), &topology("matrix"), crate::cpp::build::Build::Plain)
});

static C_PROGRAM: LazyLock<PathBuf> =
    LazyLock::new(|| compiled("c", &["matrix_scl.c", "matrix.pb-c.c"], &["-D_DEFAULT_SOURCE", "-lprotobuf-c"]));

/// The C library of SCL is in the compiler's command like anywhere else, but nothing of it is linked.
static LIBZMQ_PROGRAM: LazyLock<PathBuf> =
    LazyLock::new(|| compiled("libzmq", &["matrix.pb-c.c"], &["-Wl,--as-needed", "-lzmq", "-lprotobuf-c"]));

/// What `scl generate` and protoc make of the topology.
static GENERATED: LazyLock<PathBuf> = LazyLock::new(|| {
    let loaded = scl_loader::load(&scl_loader::Request::new(topology("matrix")));
    let system = scl_generate::System::of(&loaded).unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
    let targets = [Target::C, Target::Python, Target::Zmq(Format::Json)];
    let files =
        targets.map(|target| generate(&system, target).unwrap_or_else(|clashes| panic!("{clashes:?}"))).concat();
    let texts: Vec<_> = files.iter().map(|file| &file.text).collect();
    require("protoc", &["--version"]);
    require("protoc-c", &["--version"]);
    cached(OsStr::new("matrix"), &loaded.files_read, &texts, |folder| {
        fs::create_dir_all(folder).expect("a folder");
        for file in &files {
            fs::write(folder.join(&file.name), &file.text).expect("a generated file");
        }
        let home = topology("matrix").parent().expect("the folder of the topology").to_owned();
        let in_folder = |name: &str| format!("{name}={}", text(folder));
        run(Command::new("protoc-c").arg("-I").arg(&home).arg(in_folder("--c_out")).arg(home.join("matrix.proto")));
        let descriptors = format!("--descriptor_set_out={}", text(&folder.join("matrix.desc")));
        run(Command::new("protoc").arg("-I").arg(&home).arg(descriptors).arg(home.join("matrix.proto")));
    })
});

/// Asserts that what a program needs is installed.
#[track_caller]
fn require(command: &str, arguments: &[&str]) {
    let found = Command::new(command).args(arguments).output().is_ok_and(|output| output.status.success());
    let advice =
        "on Debian: apt-get install pkg-config protobuf-compiler protobuf-c-compiler libprotobuf-c-dev libzmq3-dev";
    assert!(found, "`{command} {}` fails; {advice}", arguments.join(" "));
}

/// A program in C: `main.c` of a folder with generated sources.
fn compiled(folder: &str, sources: &[&str], options: &[&str]) -> PathBuf {
    require("pkg-config", &["--exists", "libprotobuf-c", "libzmq"]);
    let main = languages().join(folder).join("main.c");
    let inputs = [main.clone(), languages().join("common.h"), GENERATED.clone(), include()];
    cached(OsStr::new(&format!("matrix-{folder}")), &inputs, &options, |path| {
        let compile = Compile::c(&main).option(format!("-I{}", text(&GENERATED)));
        let compile = sources.iter().fold(compile, |compile, source| compile.source(GENERATED.join(source)));
        options.iter().fold(compile, |compile, option| compile.option(*option)).program(path);
    })
}

fn include() -> PathBuf {
    scl_tests::c_library().include.clone()
}

/// `GATE=ENDPOINT` for each gate of a component, from the file of `scl generate --for zmq`.
fn endpoints(system: &System, component: &str) -> Vec<String> {
    let document = fs::read_to_string(GENERATED.join("matrix.zmq.json")).expect("a generated file");
    let document: serde_json::Value = serde_json::from_str(&document).expect("JSON");
    let gates = document["components"][component]["gates"].as_object().expect("gates");
    let folder = folder(system);
    let endpoint = |(name, gate): (&String, &serde_json::Value)| {
        let endpoint = gate["zmq_endpoints"][0].as_str().expect("an endpoint");
        format!("{name}={}", endpoint.replace("{folder}", text(&folder)))
    };
    gates.iter().map(endpoint).collect()
}

/// The folder of the sockets, which the first program of SCL would make.
fn folder(system: &System) -> PathBuf {
    system.path("matrix", "socket").parent().expect("a folder").to_owned()
}

fn languages() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("languages")
}

/// A topology of the matrix: `matrix`, or one that differs.
pub(super) fn topology(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("topologies/matrix/{name}.yaml"))
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}
