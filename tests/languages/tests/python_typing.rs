//! Programs beside generated modules, as type checkers see them: what is wrong in `bindings/python/tests/typing` has a
//! comment `# error: words`, and both mypy and pyright report these lines with these words, and no others.

use scl_tests::python_with_scl;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// By file and line, what a checker says of it.
type Report = BTreeMap<(String, u64), String>;

#[test]
fn mypy_reports_what_the_comments_expect() {
    let folder = programs();
    // An error in a generated module would be reported, too.
    let output = tool("mypy", &folder, &["--strict", "--no-color-output", "--no-error-summary", "--output=json", "."]);
    let mut found = Report::new();
    for line in output.lines() {
        let problem: Value = serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {output}"));
        if problem["severity"] == "error" {
            add(&mut found, &folder, &problem["file"], problem["line"].as_u64(), &problem["message"]);
        }
    }
    compare(&folder, &found);
}

#[test]
fn pyright_reports_what_the_comments_expect() {
    let folder = programs();
    let settings = serde_json::json!({
        "typeCheckingMode": "strict",
        // Not about types.
        "reportUnusedExpression": false,
        "reportUnusedImport": false,
    });
    std::fs::write(folder.path().join("pyrightconfig.json"), settings.to_string()).expect("written");
    let python = python_with_scl().to_string_lossy();
    let output = tool("basedpyright", &folder, &["--outputjson", "--pythonpath", &python]);
    let output: Value = serde_json::from_str(&output).unwrap_or_else(|error| panic!("{error}: {output}"));
    let mut found = Report::new();
    for problem in output["generalDiagnostics"].as_array().expect("a list") {
        let line = problem["range"]["start"]["line"].as_u64().map(|line| line + 1);
        add(&mut found, &folder, &problem["file"], line, &problem["message"]);
    }
    compare(&folder, &found);
}

#[test]
fn generated_modules_are_formatted() {
    let folder = modules();
    let output = tool("ruff", &folder, &["format", "--isolated", "--diff", "."]);
    assert!(output.is_empty(), "{output}");
}

#[test]
fn generated_modules_are_clean_in_the_strictest_modes() {
    let folder = modules();
    let output = tool("mypy", &folder, &["--strict", "--no-error-summary", "."]);
    assert!(output.is_empty(), "{output}");
    std::fs::write(folder.path().join("pyrightconfig.json"), r#"{"typeCheckingMode": "recommended"}"#)
        .expect("written");
    let output = tool("basedpyright", &folder, &["--pythonpath", &python_with_scl().to_string_lossy()]);
    assert_eq!(output.trim(), "0 errors, 0 warnings, 0 notes");
}

/// A folder with the expected modules and the programs that use them.
fn programs() -> TempDir {
    let folder = modules();
    copy_python(&repository().join("bindings/python/tests/typing"), folder.path());
    folder
}

/// A folder with the expected modules of `scl-generate`.
fn modules() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    copy_python(&repository().join("crates/scl-generate/tests/python/expected"), folder.path());
    folder
}

fn copy_python(from: &Path, to: &Path) {
    let mut count = 0;
    for entry in std::fs::read_dir(from).expect("a folder").flatten() {
        if entry.path().extension().is_some_and(|it| it == "py") {
            std::fs::copy(entry.path(), to.join(entry.file_name())).expect("copied");
            count += 1;
        }
    }
    assert!(count > 0, "no programs in {}", from.display());
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// What a tool of the virtual environment prints.
fn tool(name: &str, folder: &TempDir, arguments: &[&str]) -> String {
    let program = python_with_scl().with_file_name(name);
    let mut command = Command::new(&program);
    let output = command.args(arguments).current_dir(folder.path()).output();
    let output = output.unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    assert!(output.status.code().is_some_and(|code| code < 2), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

fn add(found: &mut Report, folder: &TempDir, file: &Value, line: Option<u64>, message: &Value) {
    let file = file.as_str().expect("a file");
    let folder = folder.path().to_str().expect("text");
    let file = file.strip_prefix(folder).unwrap_or(file).trim_start_matches('/').to_owned();
    let texts = found.entry((file, line.expect("a line"))).or_default();
    texts.push_str(message.as_str().expect("a message"));
    texts.push('\n');
}

fn compare(folder: &TempDir, found: &Report) {
    let expected = expectations(folder);
    assert!(expected.len() > 30, "{expected:?}");
    let mut wrong = String::new();
    for (place, words) in &expected {
        let text = found.get(place).map_or("", String::as_str);
        let missing: Vec<_> = words.split(' ').filter(|word| !text.contains(word)).collect();
        if text.is_empty() {
            wrong += &format!("{place:?}: no error; expected: {words}\n");
        } else if !missing.is_empty() {
            wrong += &format!("{place:?}: {missing:?} is not in: {text}");
        }
    }
    for (place, text) in found.iter().filter(|(place, _)| !expected.contains_key(place)) {
        wrong += &format!("{place:?}: unexpected: {text}");
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

fn expectations(folder: &TempDir) -> Report {
    let mut expected = Report::new();
    for entry in std::fs::read_dir(folder.path()).expect("a folder").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let Some(text) = name.ends_with(".py").then(|| std::fs::read_to_string(entry.path()).expect("text")) else {
            continue;
        };
        for (line, text) in (1..).zip(text.lines()) {
            if let Some((_, words)) = text.split_once("# error: ") {
                expected.insert((name.clone(), line), words.to_owned());
            }
        }
    }
    expected
}
