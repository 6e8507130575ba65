//! SCL0105: all lines begin in the first column, as in a text that a program has stripped of its spaces.

use super::habit::lines;
use super::indentation::RULE;
use crate::diagnostic::{Diagnostics, Edit};
use crate::parse::words::COMPONENT_KEYS;
use crate::source::SourceFile;

/// Reports a file without any indentation in which keys of components stand in the first column. Returns true if it is
/// one: then its keys do not mean what they seem to.
pub(super) fn check(source: &SourceFile, problems: &mut Diagnostics) -> bool {
    let mut is_in_components = false;
    let mut edits = Vec::new();
    let mut first = None;
    for (start, line) in lines(source.text()) {
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        if line.starts_with([' ', '\t']) {
            return false;
        }
        let key = line.split(':').next().unwrap_or("");
        let indent = match is_in_components {
            true if line.starts_with("- name:") => 2,
            true if line.starts_with("- ") => 6,
            true if COMPONENT_KEYS.contains(&key) && !edits.is_empty() => {
                first.get_or_insert(start..start + key.len());
                4
            }
            _ => {
                is_in_components = key == "components";
                continue;
            }
        };
        edits.push(Edit::new(source.span(start..start), " ".repeat(indent)));
    }
    let Some(first) = first else { return false };
    let key = &source.text()[first.clone()];
    problems.push(
        RULE.at("no line of this file is indented", source.span(first.clone()), "a key of the component above")
            .propose(format!("indent `{key}` by 4 spaces and the gates by 6, and the same in all components"), edits)
            .otherwise("the keys of a component stand in the column of its `name`, and gates are indented deeper"),
    );
    true
}
