//! Random schemas with awkward names: where the schemas' own headers compile, so does what SCL generates for them.
//!
//! `SCL_TEST_SCHEMAS=250 cargo test -p scl-generate --test with_tools names -- --nocapture` tries more, and tells how
//! many.

use crate::fixture::{repository, run};
use scl_generate::{System, Target, generate, write};
use scl_loader::{Request, load};
use scl_tests::python_with_scl;
use scl_ui_tests::awkward;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// The systems whose names are accepted, with generated code in a folder for each.
fn accepted(target: Target, usual: u64) -> Vec<(System, TempDir)> {
    let tried = std::env::var("SCL_TEST_SCHEMAS").map_or(usual, |count| count.parse().unwrap());
    let systems = (0..tried).filter_map(|seed| {
        let folder = tempfile::tempdir().unwrap();
        let system = awkward::system(seed);
        for (name, text) in &system.schemas {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let path = folder.path().join("t.yaml");
        std::fs::write(&path, &system.topology).unwrap();
        let mut system = System::of(&load(&Request::new(path)))?;
        system.make_testable();
        for file in generate(&system, target).ok()? {
            write(folder.path(), &file).unwrap();
        }
        Some((system, folder))
    });
    let systems: Vec<_> = systems.collect();
    println!("{target:?}: {} of {tried} accepted", systems.len());
    assert!(systems.len() as u64 > tried / 5, "{} of {tried}", systems.len());
    systems
}

/// Compiles first the headers of the schemas, then what SCL generates. Schemas that protoc cannot write are left out.
fn compile(systems: &[(System, TempDir)], language: &Language) {
    let mut compiled = 0;
    for (system, folder) in systems {
        let schemas = system.descriptors.iter().flat_map(|descriptors| &descriptors.file).map(|file| file.name());
        let schemas: Vec<&str> = schemas.filter(|name| !name.starts_with("google/")).collect();
        let mut protoc = Command::new(language.protoc);
        if !run(protoc.arg(language.output).args(&schemas).current_dir(folder.path()), language.package).0 {
            continue;
        }
        let includes =
            schemas.iter().map(|schema| format!("#include \"{}\"\n", schema.replace("proto", language.suffix)));
        let alone = language.include.to_owned() + &includes.collect::<String>();
        if !language.compile(folder.path(), &alone).0 {
            continue;
        }
        let (succeeds, told) = language.compile(folder.path(), &(language.generated)(system));
        assert!(succeeds, "{}: {told}\n{system:#?}", system.name);
        compiled += 1;
    }
    println!("{} of {} compiled; protoc cannot write the others", compiled, systems.len());
    assert!(compiled > systems.len() / 4, "{compiled} of {}", systems.len());
}

struct Language {
    protoc: &'static str,
    output: &'static str,
    suffix: &'static str,
    package: &'static str,
    compiler: [&'static str; 3],
    /// What every program includes.
    include: &'static str,
    /// A program that includes all that is generated.
    generated: fn(&System) -> String,
}

impl Language {
    fn compile(&self, folder: &Path, text: &str) -> (bool, String) {
        let source = folder.join("main");
        std::fs::write(&source, text).unwrap();
        let [compiler, language, standard] = self.compiler;
        let mut command = Command::new(compiler);
        command.args(["-x", language, standard, "-fsyntax-only", "-I."]);
        for include in ["bindings/c/include", "bindings/cpp/include"] {
            command.arg("-I").arg(repository().join(include));
        }
        run(command.arg(source).current_dir(folder), self.package)
    }
}

#[test]
fn accepted_names_compile_in_cpp() {
    let language = Language {
        protoc: "protoc",
        output: "--cpp_out=.",
        suffix: "pb.h",
        package: "protobuf-compiler g++ libprotobuf-dev",
        compiler: ["c++", "c++", "-std=c++17"],
        include: "#include <scl.hpp>\n",
        generated: |system| format!("#include \"{}.scl.hpp\"\n", system.snake_name()),
    };
    compile(&accepted(Target::Cpp, 16), &language);
}

#[test]
fn accepted_names_compile_in_c() {
    let language = Language {
        protoc: "protoc-c",
        output: "--c_out=.",
        suffix: "pb-c.h",
        package: "protobuf-c-compiler gcc libprotobuf-c-dev",
        compiler: ["cc", "c", "-std=c11"],
        include: "#include <scl.h>\n",
        generated: |system| format!("#include \"{}_scl.c\"\n", system.snake_name()),
    };
    compile(&accepted(Target::C, 40), &language);
}

#[test]
fn accepted_names_are_sound_for_mypy() {
    let systems = accepted(Target::Python, 40);
    let modules = tempfile::tempdir().unwrap();
    for (system, folder) in &systems {
        let name = format!("{}_scl.py", system.snake_name());
        std::fs::copy(folder.path().join(&name), modules.path().join(&name)).unwrap();
    }
    let mut mypy = Command::new(python_with_scl());
    mypy.args(["-m", "mypy", "--strict", "--cache-dir=/dev/null", "."]).current_dir(modules.path());
    let output = mypy.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}
