//! Generated C: its text, and what compilers say about it and about programs that use it wrongly.

use crate::fixture::{generated, repository, run, system, testable, text, topology};
use expect_test::{Expect, expect, expect_file};
use scl_generate::{File, Target, generate, write};
use std::path::{Path, PathBuf};
use std::process::Command;

const STRICT: [&str; 5] = ["-Wall", "-Wextra", "-Werror", "-pedantic", "-fsyntax-only"];

#[test]
fn every_kind_of_gate_has_its_functions() {
    let files = generated(&topology("every_kind.yaml"), Target::C);
    expect_file!["../expected/every_kind_scl.h"].assert_eq(&text(&files, "every_kind_scl.h"));
    expect_file!["../expected/every_kind_scl.c"].assert_eq(&text(&files, "every_kind_scl.c"));
}

#[test]
fn generated_code_compiles_without_a_warning() {
    let quickstart = repository().join("examples/quickstart/topology.yaml");
    for path in [topology("every_kind.yaml"), topology("bytes.yaml"), topology("controls.yaml"), quickstart] {
        let project = Project::of(&path);
        let source = format!("{}_scl.c", system(&path).snake_name());
        project.compiles("cc", &[&["-std=c11"], &STRICT[..], &[&source]].concat());
        project.compiles("c++", &[&["-std=c++17", "-x", "c++"], &STRICT[..], &[&source]].concat());
    }
    let path = topology("every_kind.yaml");
    let project = Project::with(&path, &testable(&path, Target::C));
    project.compiles("cc", &[&["-std=c11"], &STRICT[..], &["every_kind_scl.c"]].concat());
    project.compiles("c++", &[&["-std=c++17", "-x", "c++"], &STRICT[..], &["every_kind_scl.c"]].concat());
}

#[test]
fn one_component_alone_compiles() {
    let path = topology("every_kind.yaml");
    for index in 0..system(&path).components.len() {
        let mut system = system(&path);
        system.components = vec![system.components.swap_remove(index)];
        let project = Project::of(&path);
        generate(&system, Target::C).unwrap().iter().for_each(|file| {
            write(project.path(), file).unwrap();
        });
        project.compiles("cc", &[&["-std=c11"], &STRICT[..], &["every_kind_scl.c"]].concat());
    }
}

#[test]
fn the_documented_example_compiles() {
    let page = std::fs::read_to_string(repository().join("docs/c.md")).unwrap();
    let example = page.split("```c\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let project = Project::of(&repository().join("examples/quickstart/topology.yaml"));
    std::fs::write(project.path().join("main.c"), example).unwrap();
    project.compiles("cc", &[&["-std=c11"], &STRICT[..], &["main.c"]].concat());
}

/// A program for the quick start with one statement, and what the compiler says, also if it is told to say less.
#[track_caller]
fn refused(statement: &str, expected: Expect) {
    refused_with(&[], statement, &expected);
}

#[track_caller]
fn refused_whatever_the_options(statement: &str, expected: Expect) {
    for options in [&[][..], &["-w"], &["-w", "-std=c11"]] {
        refused_with(options, statement, &expected);
    }
}

#[track_caller]
fn refused_with(options: &[&str], statement: &str, expected: &Expect) {
    let project = Project::of(&repository().join("examples/quickstart/topology.yaml"));
    let program = format!(
        "#include \"rover_scl.h\"\nint main(void) {{\n    rover_sensor sensor;\n    rover_controller controller;\n    \
         Rover__Measurement measurement = ROVER__MEASUREMENT__INIT;\n    \
         Rover__Setpoint setpoint = ROVER__SETPOINT__INIT;\n    Rover__Setpoint *received;\n    \
         (void)sensor, (void)controller, (void)measurement, (void)setpoint, (void)received;\n    {statement}\n}}\n"
    );
    std::fs::write(project.path().join("main.c"), program).unwrap();
    // Without any option that asks for warnings: the header asks for the errors itself.
    let (compiles, told) = project.compile("cc", &[options, &["-fsyntax-only", "main.c"]].concat());
    // Without the places, and without the names of options, which differ between versions of compilers.
    let shown = told.lines().filter_map(|line| {
        let error = line.split_once("error: ").map(|(_, error)| error);
        let text = error.or_else(|| line.split_once("note: expected").map(|(_, note)| note.trim_start()))?;
        Some(text.split_once(" [-W").map_or(text, |(text, _)| text))
    });
    let errors: String = shown.map(|text| format!("{text}\n")).collect();
    expected.assert_eq(&errors);
    assert_eq!(compiles, errors.is_empty());
}

#[test]
fn a_right_program_compiles() {
    refused("return rover_sensor_measurements_send(&sensor, &measurement, -1);", expect![""]);
}

#[test]
fn a_misspelt_gate_does_not_compile() {
    refused(
        "return rover_sensor_measurement_send(&sensor, &measurement, -1);",
        expect![[r#"
            implicit declaration of function 'rover_sensor_measurement_send'; did you mean 'rover_sensor_measurements_send'?
        "#]],
    );
}

#[test]
fn the_wrong_direction_does_not_compile() {
    refused(
        "return rover_sensor_measurements_recv(&sensor, &received, -1);",
        expect![[r#"
            implicit declaration of function 'rover_sensor_measurements_recv'; did you mean 'rover_sensor_measurements_send'?
        "#]],
    );
}

#[test]
fn the_wrong_message_does_not_compile() {
    refused_whatever_the_options(
        "return rover_sensor_measurements_send(&sensor, &setpoint, -1);",
        expect![[r#"
            '_Generic' selector of type 'Rover__Setpoint *' is not compatible with any association
        "#]],
    );
    refused_whatever_the_options(
        "return rover_controller_sensor_recv(&controller, &received, -1);",
        expect![[r#"
            '_Generic' selector of type 'Rover__Setpoint **' is not compatible with any association
        "#]],
    );
    refused_whatever_the_options(
        "rover_controller_sensor_free(&setpoint);",
        expect![[r#"
            '_Generic' selector of type 'Rover__Setpoint *' is not compatible with any association
        "#]],
    );
}

#[test]
fn a_number_in_place_of_a_message_does_not_compile() {
    refused_whatever_the_options(
        "return rover_sensor_measurements_send(&sensor, 1, -1);",
        expect![[r#"
            '_Generic' selector of type 'int' is not compatible with any association
        "#]],
    );
}

#[test]
fn right_pointers_of_every_kind_compile() {
    refused_whatever_the_options(
        "const Rover__Measurement *same = &measurement; return rover_sensor_measurements_send(&sensor, same, -1);",
        expect![""],
    );
    refused_whatever_the_options(
        "void *any = &measurement; return rover_sensor_measurements_send(&sensor, any, -1);",
        expect![""],
    );
    refused_whatever_the_options(
        "Rover__Measurement two[2]; return rover_sensor_measurements_send(&sensor, two, -1);",
        expect![""],
    );
    refused_whatever_the_options(
        "return rover_sensor_measurements_send(&sensor, &(Rover__Measurement)ROVER__MEASUREMENT__INIT, -1);",
        expect![""],
    );
    refused_whatever_the_options("rover_controller_sensor_free(NULL);", expect![""]);
}

#[test]
fn the_wrong_component_does_not_compile() {
    refused_whatever_the_options(
        "return rover_sensor_measurements_send(&controller, &measurement, -1);",
        expect![[r#"
            '_Generic' selector of type 'rover_controller *' is not compatible with any association
        "#]],
    );
}

/// A folder with generated code and what `protoc-c` makes of the schemas.
pub(crate) struct Project {
    folder: tempfile::TempDir,
}

impl Project {
    pub(crate) fn of(topology: &Path) -> Self {
        Self::with(topology, &generated(topology, Target::C))
    }

    /// With these files of generated code.
    pub(crate) fn with(topology: &Path, files: &[File]) -> Self {
        let project = Self { folder: tempfile::tempdir().unwrap() };
        for file in files {
            write(project.path(), file).unwrap();
        }
        let schemas = system(topology).descriptors.unwrap_or_default();
        let names = schemas.file.iter().map(|file| file.name().to_owned());
        let folder = topology.parent().unwrap();
        let include = format!("-I{}", folder.display());
        for name in names {
            let mut command = Command::new("protoc-c");
            command.arg(&include).arg(format!("--c_out={}", project.path().display())).arg(name);
            let (succeeds, told) = run(&mut command, "protobuf-c-compiler");
            assert!(succeeds, "{told}");
        }
        project
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    fn compile(&self, compiler: &str, arguments: &[&str]) -> (bool, String) {
        let include: PathBuf = repository().join("bindings/c/include");
        let mut command = Command::new(compiler);
        command.current_dir(self.path()).arg("-I.").arg("-I").arg(include).args(arguments).env("LC_ALL", "C");
        run(&mut command, "gcc g++ libprotobuf-c-dev")
    }

    #[track_caller]
    fn compiles(&self, compiler: &str, arguments: &[&str]) {
        let (succeeds, told) = self.compile(compiler, arguments);
        assert!(succeeds, "{told}");
    }
}
