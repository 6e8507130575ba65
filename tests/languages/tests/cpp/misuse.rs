//! What the compiler says about programs that do not fit their topology: the cases of `bindings/cpp/tests/misuse.txt`.

use super::build::{binding, cached, generated, include_options, run};
use scl_tests::Compile;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

struct Case<'a> {
    name: &'a str,
    body: String,
    expected: Vec<&'a str>,
}

#[test]
fn wrong_programs_do_not_compile_and_are_told_why() {
    let text = fs::read_to_string(binding().join("tests/misuse.txt")).expect("the cases");
    let cases = cases(&text);
    assert!(cases.len() > 20, "{} cases", cases.len());
    let header = precompiled_header();
    check(&header, "").unwrap_or_else(|text| panic!("the program around the cases does not compile:\n{text}"));
    let mut wrong = Vec::new();
    for case in cases {
        match check(&header, &case.body) {
            Ok(()) => wrong.push(format!("`{}` compiles", case.name)),
            Err(text) => {
                // Quotes differ between compilers and locales, and long lines name every type in full.
                let text = text.replace(['‘', '’'], "'");
                let missing = case.expected.iter().filter(|word| !text.contains(**word));
                wrong.extend(missing.map(|word| format!("`{}`: `{word}` is not in:\n{text}", case.name)));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// A case begins with `== name`; lines with `-- ` are expected words.
fn cases(text: &str) -> Vec<Case<'_>> {
    let of = |case| {
        let (name, rest): (&str, &str) = str::split_once(case, '\n').expect("a name and a body");
        let (expected, body): (Vec<&str>, Vec<&str>) = rest.lines().partition(|line| line.starts_with("-- "));
        let expected: Vec<&str> = expected.iter().map(|line| &line[3..]).collect();
        assert!(!expected.is_empty(), "`{name}` expects nothing");
        Case { name, body: body.join("\n"), expected }
    };
    text.split("\n== ").skip(1).map(of).collect()
}

/// The headers that every case includes, compiled once.
fn precompiled_header() -> PathBuf {
    let topology = binding().parent().expect("bindings").join("../examples/quickstart/topology.yaml");
    let folder = generated(&topology).folder;
    let inputs = [folder.clone(), binding().join("include")];
    cached("misuse".as_ref(), &inputs, &"", |made| {
        fs::create_dir_all(made).expect("a folder");
        let header = made.join("misuse.hpp");
        fs::write(&header, "#include <rover.scl.hpp>\n").expect("a header");
        let mut command = Command::new("c++");
        command.args(["-std=c++17", "-Wall", "-Wextra", "-Werror", "-g", "-x", "c++-header"]).args(include_options());
        run(command.arg("-I").arg(&folder).arg(&header));
    })
}

fn check(header: &Path, body: &str) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a folder");
    let source = folder.path().join("main.cpp");
    let text = format!(
        "void use(rover::Controller& controller, rover::Sensor& sensor, rover::UserInterface& ui) {{\n\
         (void)controller, (void)sensor, (void)ui;\n{body}\n}}\n"
    );
    fs::write(&source, text).expect("a source");
    let options = ["-include".to_owned(), header.join("misuse.hpp").display().to_string()];
    let options = include_options().into_iter().chain(options);
    options.fold(Compile::cpp(&source), Compile::option).check()
}
