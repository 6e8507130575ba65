//! Sound programs have no diagnostics: the examples of the repository, new projects, and the cases.

use super::cases::CASES;
use super::editor;
use super::workspace::SOUND;
use scl_needs::needs;
use std::fs;
use std::path::PathBuf;

/// Cases in which the program itself is wrong, whatever stands at its `$0`.
const WRONG: [&str; 5] =
    ["main_blocking", "in_a_body_of_wrong_types", "behind_unfinished_code", "in_an_unknown_main", "rust_types"];

#[needs("rust-analyzer")]
#[test]
fn sound_programs_have_no_diagnostics() {
    let mut editor = editor();
    let files: Vec<PathBuf> = SOUND.iter().flat_map(|folder| editor.workspace.rust_files(folder)).collect();
    assert!(files.iter().filter(|file| fs::read_to_string(file).unwrap().contains("topology!")).count() > 10);
    let mut found = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        found.extend(editor.diagnose(&file, &text));
    }
    for case in CASES.iter().filter(|case| !WRONG.contains(&case.name)) {
        let path = editor.workspace.program(case.name);
        // Without the line that is typed.
        let lines: Vec<&str> = case.program.lines().filter(|line| !line.contains("$0")).collect();
        found.extend(editor.diagnose(&path, &lines.join("\n")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
