//! One program in another language runs every component of a kind, beside a controller in Rust.

use crate::cpp::build::{Build, cached, program};
use crate::programs::{MOTORS, open_with};
use scl_generate::Target;
use scl_tests::{Compile, Process, System, on_each_transport, python_with_scl};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// A program with its first arguments.
type Motor = Vec<&'static str>;

fn languages() -> [Motor; 3] {
    [vec![text(&C)], vec![text(&CPP)], python()]
}

fn python() -> Motor {
    static MAIN: LazyLock<PathBuf> = LazyLock::new(|| source("motor.py"));
    vec![text(python_with_scl()), text(&MAIN)]
}

/// Starts a motor with one more argument and what it finds in `SCL_COMPONENT`.
fn start(system: &System, motor: &Motor, argument: &[&str], component: &str) -> Process {
    let (program, arguments) = motor.split_first().expect("a program");
    let environment = [("SCL_COMPONENT", component), ("PYTHONPATH", text(&MODULES))];
    system.start_with(program, &[arguments, argument].concat(), &environment)
}

#[test]
fn each_process_is_the_component_that_it_was_started_as() {
    for motor in languages() {
        on_each_transport(|system| {
            let mut controller = open_with(&system, MOTORS, "controller");
            let mut left = start(&system, &motor, &["left_motor"], "");
            let mut right = start(&system, &motor, &[], "motors.right.motor");
            left.expect("left_motor");
            right.expect("right.motor");
            for (command, answer) in
                [("left 1", "left_motor 10"), ("right 2", "right.motor 20"), ("left 3", "left_motor 30")]
            {
                controller.tell(command);
                controller.expect(answer);
            }
            right.kill();
            let mut right = start(&system, &motor, &[], "right.motor");
            right.expect("right.motor");
            controller.tell("right 4");
            controller.expect("right.motor 40");
        });
    }
}

/// What a display may say.
const KNOWN: [&str; 4] = ["ControllerLeft 1", "LeftMotor 10", "ControllerRight 2", "RightMotor 20"];

#[test]
fn a_program_knows_who_has_sent_a_message() {
    for language in languages() {
        on_each_transport(|system| {
            let mut controller = start(&system, &language, &["controller"], "");
            controller.expect("open");
            let mut left = start(&system, &language, &[], "left_motor");
            let mut right = start(&system, &language, &[], "right.motor");
            left.expect("left_motor");
            right.expect("right.motor");
            for (command, answer) in [("left 1", "left_motor 10"), ("right 2", "right.motor 20")] {
                controller.tell(command);
                controller.expect(answer);
            }
            let mut display = start(&system, &language, &["display"], "");
            display.expect("open");
            for (command, expected) in
                [("left 1", ["ControllerLeft 1", "LeftMotor 10"]), ("right 2", ["ControllerRight 2", "RightMotor 20"])]
            {
                let mut missing = BTreeSet::from(expected);
                // The first ones may be sent before the display is connected.
                while !missing.is_empty() {
                    controller.tell(command);
                    controller.next_line();
                    while let Some(line) = display.try_next_line() {
                        assert!(KNOWN.contains(&line.as_str()), "{line}");
                        missing.remove(line.as_str());
                    }
                }
            }
        });
    }
}

/// The reason for which a motor does not start.
#[track_caller]
fn refused(motor: &Motor, argument: &[&str], component: &str) -> String {
    let exit = start(&System::new(), motor, argument, component).wait_for_exit();
    assert_ne!(exit.code(), 0, "{motor:?}");
    exit.text()
}

#[test]
fn a_process_that_does_not_know_its_component_says_so() {
    let all = "set SCL_COMPONENT to `left_motor` or `right.motor`";
    for motor in languages() {
        let told = refused(&motor, &[], "");
        assert!(told.contains(&format!("this program is a `motor`: {all}")), "{told}");
        let told = refused(&motor, &[], "motors.controller");
        let expected = format!("this program is a `motor`, but was started as `controller` of system `motors`: {all}");
        assert!(told.contains(&expected), "{told}");
        let told = refused(&motor, &["left_motor"], "right.motor");
        let expected = "component `left_motor` of system `motors` was not expected";
        assert!(told.contains(expected), "{told}");
    }
}

#[test]
fn a_component_that_is_not_of_the_kind_is_refused() {
    let expected =
        ["SCL_ARGUMENT: `instance` is not one of the kind", "the instance is not one of the kind", "'neither'"];
    for (motor, expected) in languages().iter().zip(expected) {
        let told = refused(motor, &["neither"], "");
        assert!(told.contains(expected), "{told}");
    }
}

#[test]
fn a_unit_test_opens_the_first_component() {
    for motor in languages() {
        let exit = start(&System::new(), &motor, &["test"], "").wait_for_exit();
        assert_eq!((exit.code(), exit.output.as_slice()), (0, &["70".to_owned()][..]), "{}", exit.text());
    }
}

#[test]
fn python_opens_a_kind_from_the_topology_file() {
    let system = System::new();
    let mut controller = open_with(&system, MOTORS, "controller");
    let topology = topology();
    let dynamic = ["dynamic", text(&topology)];
    let mut left = start(&system, &python(), &dynamic, "left_motor");
    let mut right = start(&system, &python(), &dynamic, "right.motor");
    left.expect("left_motor");
    right.expect("right.motor");
    controller.tell("left 1");
    controller.expect("left_motor 10");
    let told = refused(&python(), &dynamic, "");
    assert!(told.contains("OpenError: this program is a `motor`: set SCL_COMPONENT to"), "{told}");
}

static CPP: LazyLock<PathBuf> = LazyLock::new(|| program(&source("motor.cpp"), &topology(), Build::Address));

static C: LazyLock<PathBuf> = LazyLock::new(|| {
    let main = source("motor.c");
    let include = scl_tests::c_library().include.clone();
    cached(OsStr::new("motor"), &[main.clone(), GENERATED.clone(), include], &(), |path| {
        let compile = Compile::c(&main).source(GENERATED.join("motors_scl.c"));
        let compile = compile.option(format!("-I{}", text(&GENERATED)));
        let options = ["-pedantic", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
        options.into_iter().fold(compile, Compile::option).program(path);
    })
});

/// What `scl generate --testable` makes of the topology for C and Python.
static GENERATED: LazyLock<PathBuf> = LazyLock::new(|| {
    let loaded = scl_loader::load(&scl_loader::Request::new(topology()));
    let mut system = scl_generate::System::of(&loaded).unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
    system.make_testable();
    let files = [Target::C, Target::Python].map(|target| scl_generate::generate(&system, target));
    let files = files.map(|files| files.unwrap_or_else(|clashes| panic!("{clashes:?}"))).concat();
    let texts: Vec<_> = files.iter().map(|file| &file.text).collect();
    cached(OsStr::new("motors"), &loaded.files_read, &texts, |folder| {
        std::fs::create_dir_all(folder).expect("a folder");
        for file in &files {
            scl_generate::write(folder, file).expect("a generated file");
        }
    })
});

/// Python does not write into this folder: it is part of what the C program is made from.
static MODULES: LazyLock<PathBuf> = LazyLock::new(|| {
    cached(OsStr::new("motors-python"), std::slice::from_ref(&GENERATED), &(), |folder| {
        std::fs::create_dir_all(folder).expect("a folder");
        std::fs::copy(GENERATED.join("motors_scl.py"), folder.join("motors_scl.py")).expect("a copy");
    })
});

fn topology() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("topologies/motors.yaml")
}

fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("languages/motors").join(name)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("text")
}
