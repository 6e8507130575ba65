//! `scl completions`, in the shell for which it is.

use crate::system::System;
use std::process::Command;

#[test]
fn bash_completes_commands_and_formats() {
    let system = System::of_files(&[]);
    let script = system.scl(&["completions", "bash"]).output().unwrap();
    assert_eq!(script.status.code(), Some(0));
    system.write("scl.bash", &String::from_utf8(script.stdout).unwrap());
    for (words, expected) in [
        ("scl expl", "explain"),
        ("scl pla", "plan"),
        ("scl plan --com", "--component"),
        ("scl check --format sar", "sarif"),
        ("scl check --den", "--deny"),
    ] {
        let last = words.split(' ').count() - 1;
        let ask = format!(
            "source ./scl.bash; COMP_WORDS=({words}); COMP_CWORD={last}; _scl scl \"${{COMP_WORDS[{last}]}}\" \
             \"${{COMP_WORDS[{last} - 1]}}\"; echo \"${{COMPREPLY[*]}}\""
        );
        let answer = Command::new("bash").args(["-c", &ask]).current_dir(system.path("")).output().unwrap();
        assert_eq!(String::from_utf8(answer.stdout).unwrap().trim(), expected, "{words}");
    }
}

#[test]
fn hidden_commands_are_not_offered() {
    for shell in ["bash", "zsh", "fish"] {
        let script = System::of_files(&[]).scl(&["completions", shell]).output().unwrap();
        let script = String::from_utf8(script.stdout).unwrap();
        assert!(script.contains("explain") && !script.contains("__guard") && !script.contains("__start"), "{shell}");
    }
}
