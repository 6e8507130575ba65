//! The commands that READMEs of projects and the pages for new users name.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

const PAGES: [&str; 9] = [
    "README.md",
    "crates/scl-new/templates/control/README.md",
    "crates/scl-new/templates/minimal/README.md",
    "docs/your-own-project.md",
    "docs/testing.md",
    "docs/shutdown.md",
    "docs/threads.md",
    "docs/troubleshooting.md",
    "docs/tutorial.md",
];

#[test]
fn commands_and_options_exist() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let mut named = BTreeSet::new();
    for page in PAGES {
        let text = std::fs::read_to_string(repository.join(page)).unwrap();
        for line in text.lines() {
            named.extend(commands(line).map(|(command, option)| (command, option, page)));
        }
    }
    assert!(named.len() > 30, "{named:?}");
    for (command, option, page) in named {
        let output = Command::new(env!("CARGO_BIN_EXE_scl")).args([&command, "--help"]).output().unwrap();
        // A part of SCL that is installed apart: its own package tests its options.
        let install = format!("install it: `cargo install scl-{command}`");
        if !output.status.success() && String::from_utf8_lossy(&output.stderr).contains(&install) {
            continue;
        }
        let help = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{page}: `scl {command}` does not exist");
        assert!(
            option.is_none_or(|option| help.contains(&option)),
            "{page}: `scl {command}` has no such option: {help}"
        );
    }
}

/// Each command in a line, alone and with each of its options: `scl run --for 5s`, in a line of its own or in
/// backticks.
fn commands(line: &str) -> impl Iterator<Item = (String, Option<String>)> {
    let in_prose = line.split('`').skip(1).step_by(2);
    let alone = (!line.contains('`')).then_some(line);
    let written = in_prose.chain(alone).filter_map(|text| text.trim_start().strip_prefix("scl "));
    written.filter(|rest| rest.starts_with(|letter: char| letter.is_ascii_lowercase())).flat_map(|rest| {
        let words: Vec<&str> = rest.split('#').next().unwrap_or_default().split_whitespace().collect();
        let command = words[0].to_owned();
        let options = words.into_iter().filter(|word| word.starts_with('-') && word.len() > 1).map(str::to_owned);
        std::iter::once(None).chain(options.map(Some)).map(move |option| (command.clone(), option)).collect::<Vec<_>>()
    })
}
