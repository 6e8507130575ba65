//! Programs that read the parameters of their component, through generated code.

use crate::c::Project;
use crate::fixture::{testable, topology};
use scl_generate::Target;
use scl_tests::{Compile, System};
use std::path::Path;

const SET: [(&str, &str); 1] = [("SCL_SET", "controller.gain=1.5,left_motor.pin=3")];

#[test]
fn a_program_in_c_reads_its_parameters() {
    let path = topology("controls.yaml");
    let project = Project::with(&path, &testable(&path, Target::C));
    let program = project.path().join("parameters");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs/parameters.c");
    let compile = Compile::c(source).option(format!("-I{}", project.path().display()));
    let compile = compile.source(project.path().join("controls_scl.c"));
    let options = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    options.into_iter().fold(compile, Compile::option).program(&program);

    let system = System::new();
    let exit = system.start_with(program.to_str().unwrap(), &[], &SET).wait_for_exit();
    assert_eq!((exit.code(), exit.output.as_slice(), exit.text().as_str()), (0, &["done".to_owned()][..], "done"));
}
