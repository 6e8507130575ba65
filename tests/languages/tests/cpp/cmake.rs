//! The CMake package: `bindings/cpp/tests/cmake_project` built as a user builds it.

use super::build::{binding, run};
use rustix::process::Signal;
use scl_tests::{Process, System, c_library};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use tempfile::TempDir;

/// A copy of the project, and its build folder.
struct Project {
    folder: TempDir,
}

/// The promise: a build does what is needed and nothing else, and the checker's text is what a user sees of a mistake.
#[test]
fn a_project_is_built_checked_and_built_again() {
    let project = Project::new();
    project.configure(&source_tree()).expect("configured");
    let first = project.build().expect("built");
    for work in ["Compiling rover.proto with protoc", "Building CXX object CMakeFiles/controller.dir/controller.cpp.o"]
    {
        assert!(first.contains(work), "{first}");
    }
    assert!(project.is_up_to_date());
    project.exchange();

    project.edit("topology.yaml", "connections:", "# A comment.\nconnections:");
    assert!(project.is_up_to_date(), "what the header does not contain does not matter");
    project.edit("topology.yaml", "One reading every 100 ms.", "One reading every 10 ms.");
    let rebuilt = project.build().expect("built");
    assert!(rebuilt.contains("sensor.cpp.o") && !rebuilt.contains("protoc"), "{rebuilt}");
    project.edit("rover.proto", "double speed = 1;", "double speed = 1;\n  double heading = 2;");
    let rebuilt = project.build().expect("built");
    assert!(rebuilt.contains("protoc") && rebuilt.contains("sensor.cpp.o"), "{rebuilt}");
    assert!(project.is_up_to_date());
    project.exchange();

    for (file, right, wrong, words) in [
        (
            "topology.yaml",
            "sensor.measurements,",
            "sensor.measurement,",
            "component `sensor` has no gate `measurement`",
        ),
        ("rover.proto", "string text = 1;", "strin text = 1;", "[SCL0406]"),
        ("sensor.cpp", "sensor.measurements.send", "sensor.measurement.send", "did you mean"),
    ] {
        project.edit(file, right, wrong);
        // A second build fails as well.
        for _ in 0..2 {
            let text = project.build().expect_err("a mistake");
            assert!(text.contains(words), "`{words}` is not in:\n{text}");
        }
        project.edit(file, wrong, right);
        project.build().unwrap_or_else(|text| panic!("{file}:\n{text}"));
    }
}

/// The promise: `TESTABLE` lets a program open a component beside its counterpart.
#[test]
fn a_component_is_testable_if_asked_for() {
    let project = Project::new();
    let test = "#include \"rover.scl.hpp\"\n\nint main() {\n    auto [controller, peer] = rover::Controller::test();\n    \
                rover::Setpoint setpoint;\n    setpoint.set_throttle(0.5);\n    controller.actuator.send(setpoint);\n    \
                return peer.actuator.recv().throttle() == 0.5 ? 0 : 1;\n}\n";
    fs::write(project.path("controller.cpp"), test).expect("a source");
    project.configure(&source_tree()).expect("configured");
    let told = project.build().expect_err("there is no `test` yet");
    assert!(told.contains("'test' is not a member of 'rover::Controller'"), "{told}");
    project.edit("CMakeLists.txt", "COMPONENTS controller", "COMPONENTS controller TESTABLE");
    project.build().expect("built");
    run(&mut Command::new(project.path("build/controller")));
}

/// The promise: protoc is told where the imports of the schemas begin.
#[test]
fn schemas_are_found_below_their_root() {
    let project = Project::new();
    let schemas = "schemas: [proto/msg/rover.proto]\nschema_roots: [proto]";
    project.edit("topology.yaml", "schemas: [rover.proto]", schemas);
    for folder in ["proto/msg", "proto/common"] {
        fs::create_dir_all(project.path(folder)).expect("a folder");
    }
    fs::rename(project.path("rover.proto"), project.path("proto/msg/rover.proto")).expect("moved");
    let common = "syntax = \"proto3\";\npackage common;\nmessage Header {}\n";
    fs::write(project.path("proto/common/header.proto"), common).expect("a schema");
    project.edit("proto/msg/rover.proto", "package rover;", "package rover;\nimport \"common/header.proto\";");
    project.configure(&source_tree()).expect("configured");
    let built = project.build_target("sensor").expect("built");
    for name in ["common/header.proto", "msg/rover.proto"] {
        assert!(built.contains(&format!("Compiling {name} with protoc")), "{built}");
    }
}

/// The promise: what is missing is named, with the way to get it.
#[test]
fn what_is_missing_is_named() {
    let settings = source_tree();
    let without = |prefix: &str| settings.iter().filter(|it| !it.starts_with(prefix)).cloned().collect::<Vec<_>>();
    let with = |prefix: &str, more: &str| [without(prefix), more.split(' ').map(str::to_owned).collect()].concat();
    let cases = [
        (without("-Dscl_DIR"), "sclConfig.cmake"),
        (
            with("-DSCL_LIBRARY", "-DSCL_LIBRARY=SCL_LIBRARY-NOTFOUND -DCMAKE_FIND_LIBRARY_SUFFIXES=.none"),
            "cargo cinstall -p scl-c",
        ),
        (with("-DSCL_EXECUTABLE", "-DSCL_EXECUTABLE=OFF"), "cargo install scl-cli"),
        (
            with("-", &format!("{} -DCMAKE_DISABLE_FIND_PACKAGE_Protobuf=TRUE", settings.join(" "))),
            "apt-get install protobuf-compiler libprotobuf-dev",
        ),
    ];
    for (settings, words) in cases {
        let text = Project::new().configure(&settings).expect_err("something is missing");
        // CMake wraps its texts.
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(words), "`{words}` is not in:\n{text}");
    }
}

#[test]
fn wrong_calls_are_explained() {
    for (right, wrong, words) in [
        ("COMPONENTS sensor", "COMPONENTS senor", "did you mean `sensor`?"),
        ("COMPONENTS sensor", "COMPONENTS", "`COMPONENTS` without names"),
        ("COMPONENTS sensor", "sensor", "unknown argument `sensor`"),
        ("scl_generate(sensor ", "scl_generate(sensors ", "there is no target `sensors`"),
        ("find_package(scl 0.1", "find_package(scl 0.2", "version: 0.1.0"),
        ("topology.yaml COMPONENTS sensor", "topologie.yaml COMPONENTS sensor", "topologie.yaml"),
    ] {
        let project = Project::new();
        project.edit("CMakeLists.txt", right, wrong);
        let text = project.configure(&source_tree()).expect_err(wrong);
        assert!(text.contains(words), "`{words}` is not in:\n{text}");
    }
}

#[test]
fn an_old_cmake_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = folder.path().join("old.cmake");
    let config = binding().join("cmake/sclConfig.cmake");
    let text = format!(
        "set(CMAKE_VERSION 3.18.4)\ninclude({})\nmessage(\"${{scl_FOUND}} ${{scl_NOT_FOUND_MESSAGE}}\")\n",
        config.display()
    );
    fs::write(&script, text).expect("a script");
    let text = run(Command::new("cmake").arg("-P").arg(&script));
    assert!(text.contains("FALSE SCL needs CMake 3.19 or later, and this is 3.18.4"), "{text}");
}

/// The promise: the headers and CMake files can be installed, and work from there.
#[test]
fn an_installed_package_is_found_by_its_prefix() {
    let folder = tempfile::tempdir().expect("a folder");
    let (build, prefix) = (folder.path().join("build"), folder.path().join("prefix"));
    run(Command::new("cmake").arg("-S").arg(binding()).arg("-B").arg(&build));
    run(Command::new("cmake").arg("--install").arg(&build).arg("--prefix").arg(&prefix));
    // What `cargo cinstall -p scl-c` installs.
    fs::create_dir_all(prefix.join("lib")).expect("a folder");
    fs::copy(c_library().include.join("scl.h"), prefix.join("include/scl.h")).expect("a copy");
    fs::copy(c_library().folder.join("libscl.so"), prefix.join("lib/libscl.so")).expect("a copy");

    let project = Project::new();
    let found = project
        .configure(&[
            format!("-DCMAKE_PREFIX_PATH={}", prefix.display()),
            format!("-DSCL_EXECUTABLE={}", scl().display()),
        ])
        .expect("configured");
    assert!(found.contains(&format!("Found scl: {}", prefix.join("lib/libscl.so").display())), "{found}");
    let cache = fs::read_to_string(project.path("build/CMakeCache.txt")).expect("the cache");
    for header in ["SCL_INCLUDE_DIR", "SCL_CPP_INCLUDE_DIR"] {
        assert!(cache.contains(&format!("{header}:PATH={}", prefix.join("include").display())), "{cache}");
    }
    project.build().expect("built");
    project.exchange();
}

#[test]
fn the_package_has_the_version_of_the_workspace() {
    let version = env!("CARGO_PKG_VERSION");
    for (file, line) in [
        ("cmake/sclConfigVersion.cmake", format!("set(PACKAGE_VERSION {version})")),
        ("CMakeLists.txt", format!("project(scl VERSION {version} LANGUAGES NONE)")),
    ] {
        let text = fs::read_to_string(binding().join(file)).expect("a file of the package");
        assert!(text.contains(&line), "`{line}` is not in {file}");
    }
}

impl Project {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let examples = binding().join("../../examples/quickstart");
        let sources = fs::read_dir(binding().join("tests/cmake_project")).expect("the project").flatten();
        let files = sources.map(|file| file.path());
        for file in files.chain(["topology.yaml", "rover.proto"].map(|name| examples.join(name))) {
            fs::copy(&file, folder.path().join(file.file_name().unwrap_or_default())).expect("a copy");
        }
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn configure(&self, settings: &[String]) -> Result<String, String> {
        output(Command::new("cmake").arg("-S").arg(self.folder.path()).arg("-B").arg(self.path("build")).args(settings))
    }

    fn build(&self) -> Result<String, String> {
        output(Command::new("cmake").arg("--build").arg(self.path("build")))
    }

    fn build_target(&self, target: &str) -> Result<String, String> {
        output(Command::new("cmake").arg("--build").arg(self.path("build")).args(["--target", target]))
    }

    #[track_caller]
    fn is_up_to_date(&self) -> bool {
        let text = self.build().expect("built");
        !["Building", "Linking", "Compiling"].iter().any(|work| text.contains(work))
    }

    /// Replaces a text in a file. Makefiles compare times of files, so that of the change is made a later one.
    fn edit(&self, file: &str, old: &str, new: &str) {
        let path = self.path(file);
        let text = fs::read_to_string(&path).expect("a file of the project");
        assert!(text.contains(old), "`{old}` is not in {file}");
        fs::write(&path, text.replacen(old, new, 1)).expect("written");
    }

    /// Runs both programs until a message has arrived.
    fn exchange(&self) {
        let system = System::new();
        let start = |name: &str| system.start(self.path("build").join(name).to_str().expect("ASCII"), &[]);
        let (mut controller, sensor): (Process, Process) = (start("controller"), start("sensor"));
        controller.expect("1.5");
        for process in [controller, sensor] {
            process.signal(Signal::TERM);
            let exit = process.wait_for_exit();
            assert_eq!(exit.code(), 0, "{exit:?}");
        }
    }
}

/// The settings for the package in the source tree.
fn source_tree() -> Vec<String> {
    let library = c_library().folder.join("libscl.so");
    vec![
        format!("-Dscl_DIR={}", binding().join("cmake").display()),
        format!("-DSCL_LIBRARY={}", library.display()),
        format!("-DSCL_EXECUTABLE={}", scl().display()),
    ]
}

/// The program `scl`.
fn scl() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| scl_tests::build("scl-cli").join("scl"))
}

/// The output of a command, or what it printed before it failed.
fn output(command: &mut Command) -> Result<String, String> {
    let advice = "on Debian: apt-get install cmake make g++";
    let output = command.env("LC_ALL", "C").output().unwrap_or_else(|error| panic!("{command:?}: {error}; {advice}"));
    let text = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if output.status.success() { Ok(text) } else { Err(text) }
}
