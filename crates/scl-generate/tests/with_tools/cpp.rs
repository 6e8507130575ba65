//! Generated C++ compiles, with all the awkward names.

use crate::fixture::{generated, repository, run, system, testable, topology};
use scl_generate::{Target, write};
use std::path::Path;
use std::process::Command;

#[test]
fn generated_headers_compile_without_a_warning() {
    let quickstart = repository().join("examples/quickstart/topology.yaml");
    let cases = [topology("every_kind.yaml"), topology("bytes.yaml"), quickstart].map(|path| (path, false));
    let testable_cases = [topology("every_kind.yaml"), topology("controls.yaml")].map(|path| (path, true));
    for (path, is_testable) in cases.into_iter().chain(testable_cases) {
        let folder = tempfile::tempdir().unwrap();
        for file in if is_testable { testable(&path, Target::Cpp) } else { generated(&path, Target::Cpp) } {
            write(folder.path(), &file).unwrap();
            std::fs::write(folder.path().join("main.cpp"), format!("#include \"{}\"\n", file.name)).unwrap();
        }
        compile_schemas(&path, folder.path());
        let mut command = Command::new("c++");
        command.args(["-std=c++17", "-Wall", "-Wextra", "-Werror", "-pedantic", "-fsyntax-only", "-I."]);
        for include in ["bindings/c/include", "bindings/cpp/include"] {
            command.arg("-I").arg(repository().join(include));
        }
        let (succeeds, told) = run(command.arg("main.cpp").current_dir(folder.path()), "g++ libprotobuf-dev");
        assert!(succeeds, "{}: {told}", path.display());
    }
}

fn compile_schemas(topology: &Path, output: &Path) {
    let schemas = system(topology).descriptors.unwrap_or_default();
    for file in schemas.file {
        let mut command = Command::new("protoc");
        command.arg("-I").arg(topology.parent().unwrap()).arg(format!("--cpp_out={}", output.display()));
        let (succeeds, told) = run(command.arg(file.name()), "protobuf-compiler");
        assert!(succeeds, "{told}");
    }
}
