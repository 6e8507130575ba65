//! Whole lines that belong to another tool, and marks at the ends of lines.

use super::{Found, Way, line_list, lines};
use crate::source::SourceFile;
use std::ops::Range;

/// What leaves an editor of the vi family.
const EDITOR_COMMANDS: [&str; 7] = [":wq!", ":wq", ":w", ":q!", ":q", ":x", "ZZ"];

/// Marks that end a line in other languages.
const LINE_ENDS: [(&str, &str); 3] = [
    (",", "a line needs no comma at its end outside of brackets"),
    (";", "a line needs no `;` at its end"),
    ("\\", "a line is not continued with `\\`: in brackets, it simply goes on"),
];

/// The fences of a code block.
pub(super) fn fences(text: &str, source: &SourceFile) -> Option<Found> {
    let message = |_: &str| "this is the fence of a Markdown code block, not YAML".to_owned();
    whole_lines(text, source, |line| line.starts_with("```") || line.starts_with("~~~"), message)
}

/// A conflict marker whose partners are gone.
pub(super) fn half_conflict(text: &str, source: &SourceFile) -> Option<Found> {
    let message = |_: &str| "this is part of a conflict marker of git".to_owned();
    whole_lines(text, source, |line| line.trim_end() == "=======", message)
}

/// Commands with the prompt of a shell, or a prompt alone.
pub(super) fn prompts(text: &str, source: &SourceFile) -> Option<Found> {
    let is_prompt = |line: &str| {
        let head = line.split(' ').next().unwrap_or("");
        line.starts_with("$ ") || line.starts_with("PS ") || head.contains('@') && head.ends_with(['$', '#', '%'])
    };
    whole_lines(text, source, is_prompt, |_| "this is the prompt of a shell, not YAML".to_owned())
}

/// Headings in brackets, as in INI files and in TOML.
pub(super) fn headings(text: &str, source: &SourceFile) -> Option<Found> {
    let heading = |(start, line): (usize, &str)| {
        let line = line.trim_end();
        let word = line.strip_prefix('[')?.strip_suffix(']')?;
        let word = word.strip_prefix('[').and_then(|word| word.strip_suffix(']')).unwrap_or(word);
        let is_word = !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_');
        is_word.then(|| (start..start + line.len(), format!("{word}:")))
    };
    let changes: Vec<_> = lines(text).filter_map(heading).collect();
    let (first, key) = changes.first()?.clone();
    let later: Vec<usize> = changes.iter().skip(1).map(|(at, _)| at.start).collect();
    let help = match later.is_empty() {
        true => format!("write `{key}`"),
        false => format!("write `{key}`, and the same on {}", line_list(&later, source)),
    };
    Some(Found {
        message: format!("`{}` is a heading in INI files and TOML; in YAML, it is a list", &text[first.clone()]),
        at: first,
        label: "a key and a colon stand here",
        ways: vec![Way { help, changes }],
        is_certain: true,
        otherwise: Some("a section begins with its key and a colon, for example `components:`"),
    })
}

/// Lines that `is_found`, which should go.
fn whole_lines(
    text: &str,
    source: &SourceFile,
    is_found: impl Fn(&str) -> bool,
    message: impl Fn(&str) -> String,
) -> Option<Found> {
    let found: Vec<(usize, &str)> = lines(text).filter(|(_, line)| is_found(line)).collect();
    let (first, line) = *found.first()?;
    let starts: Vec<usize> = found.iter().map(|(start, _)| *start).collect();
    let changes = found.iter().map(|(start, line)| (*start..start + line.len(), String::new()));
    Some(Found {
        at: first..first + line.trim_end().len(),
        message: message(line),
        label: "does not belong to the file",
        ways: vec![Way { help: format!("remove {}", line_list(&starts, source)), changes: changes.collect() }],
        is_certain: true,
        otherwise: None,
    })
}

/// A command of the editor that ended up in the text.
pub(super) fn editor_commands(text: &str, _: &SourceFile) -> Option<Found> {
    let (start, line, command) = lines(text).find_map(|(start, line)| {
        let content = line.trim_end();
        let command = EDITOR_COMMANDS.into_iter().find(|command| content.ends_with(command))?;
        Some((start, line, command))
    })?;
    let end = start + line.trim_end().len();
    let at = end - command.len()..end;
    let is_alone = text[start..at.start].trim().is_empty();
    let removed = if is_alone { start..start + line.len() } else { at.clone() };
    Some(Found {
        at,
        message: format!("`{command}` is a command of vi, not YAML"),
        label: "typed into the text",
        ways: vec![Way { help: format!("remove `{command}`"), changes: vec![(removed, String::new())] }],
        is_certain: true,
        otherwise: None,
    })
}

/// Commas, semicolons and backslashes at the ends of lines that do not end an entry in brackets.
pub(super) fn line_ends(text: &str, source: &SourceFile) -> Option<Found> {
    LINE_ENDS.iter().find_map(|(mark, message)| {
        let found: Vec<Range<usize>> = marked_ends(text, mark);
        let first = found.first()?.clone();
        let starts: Vec<usize> = found.iter().map(|at| at.start).collect();
        let help = match found.len() {
            1 => format!("remove `{mark}`"),
            _ => format!("remove `{mark}` at the end of {}", line_list(&starts, source)),
        };
        let changes = found.into_iter().map(|at| (at, String::new())).collect();
        Some(Found {
            at: first,
            message: (*message).to_owned(),
            label: "not expected",
            ways: vec![Way { help, changes }],
            is_certain: true,
            otherwise: None,
        })
    })
}

fn marked_ends(text: &str, mark: &str) -> Vec<Range<usize>> {
    let mut depth = 0_i32;
    let mut found = Vec::new();
    for (start, line) in lines(text) {
        let content = line.trim_end();
        depth += content.matches(['[', '{']).count() as i32 - content.matches([']', '}']).count() as i32;
        let is_comment = content.trim_start().starts_with('#') || content.contains(" #");
        let is_entry = mark == "," && depth > 0;
        if content.ends_with(mark) && !is_comment && !is_entry {
            let at = start + content[..content.len() - mark.len()].trim_end().len();
            found.push(at..start + content.len());
        }
    }
    found
}
