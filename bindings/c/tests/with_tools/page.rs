//! The code of `docs/c.md` compiles.

use scl_generate::{System, Target, generate, write};
use scl_tests::Compile;
use std::path::Path;
use std::process::Command;

/// What the statements of the page take for granted.
const BEFORE: &str = "\
#include \"controls_scl.h\"
#include <stdio.h>
#include <stdlib.h>
#include <sys/epoll.h>
void statements(controls_controller *controller, scl_component *component, scl_gate *gate, scl_gate *other);
void statements(controls_controller *controller, scl_component *component, scl_gate *gate, scl_gate *other)
{
(void)controller, (void)component, (void)gate, (void)other;
";

#[test]
fn the_header_compiles_as_cpp() {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("header.cpp");
    std::fs::write(&source, "#include <scl.h>\nint main() { return scl_abi() == SCL_ABI ? SCL_OK : 1; }\n").unwrap();
    Compile::cpp(&source).option("-pedantic").check().unwrap();
}

#[test]
fn the_code_of_the_page_compiles() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(repository.join("docs/c.md")).unwrap();
    let blocks = page.split("\n```c\n").skip(1).filter_map(|part| part.split_once("```"));
    let blocks: Vec<&str> = blocks.map(|(block, _)| block).collect();
    assert!(blocks.len() > 6, "{} blocks", blocks.len());

    let folder = tempfile::tempdir().unwrap();
    generate_rover(&repository.join("examples/quickstart"), folder.path());
    generate_c(&repository.join("crates/scl-generate/tests/topologies/controls.yaml"), folder.path());
    for (index, block) in blocks.iter().enumerate() {
        let whole = block.starts_with("#include");
        let text = if whole { (*block).to_owned() } else { format!("{BEFORE}{block}}}\n") };
        let source = folder.path().join(format!("block_{index}.c"));
        std::fs::write(&source, &text).unwrap();
        // Examples leave values unused.
        let compile = Compile::c(source).option("-Wno-unused-but-set-variable").option("-Wno-unused-variable");
        let compile = compile.option(format!("-I{}", folder.path().display()));
        compile.check().unwrap_or_else(|error| panic!("{error}\n{text}"));
    }
    // The first is a whole program, which must link, too.
    let generated = ["rover_scl.c", "rover.pb-c.c"].map(|name| folder.path().join(name));
    let first = Compile::c(folder.path().join("block_0.c")).option(format!("-I{}", folder.path().display()));
    let first: Compile = generated.into_iter().fold(first, Compile::source);
    first.option("-lprotobuf-c").program(&folder.path().join("controller"));
}

/// The generated C of the quick start, with what protoc-c makes of its schema.
fn generate_rover(quickstart: &Path, folder: &Path) {
    generate_c(&quickstart.join("topology.yaml"), folder);
    let mut protoc = Command::new("protoc-c");
    protoc.arg(format!("--c_out={}", folder.display())).arg("-I").arg(quickstart).arg(quickstart.join("rover.proto"));
    let made = protoc.output().unwrap_or_else(|error| {
        panic!("`protoc-c` does not start: {error}; install it (Debian: apt-get install protobuf-c-compiler)")
    });
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
}

/// The generated C of a topology.
fn generate_c(topology: &Path, folder: &Path) {
    let system = System::of(&scl_loader::load(&scl_loader::Request::new(topology))).unwrap();
    for file in generate(&system, Target::C).unwrap() {
        write(folder, &file).unwrap();
    }
}
