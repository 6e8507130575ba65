//! A diagnostic as cargo prints those of rustc, one line of JSON, for editors that run a command in place of
//! `cargo check`.
//!
//! The format is that of `cargo check --message-format=json`; cargo's reference names it "external tools".

use scl_topology::diagnostic::{Diagnostic, Edit, Label, Proposal, Severity, render};
use scl_topology::source::{LineColumn, SourceFile, Sources};
use serde_json::{Value, json};
use std::path::Path;

/// Maximum number of lines of one span whose text is given.
const MOST_LINES: usize = 20;

/// Maximum length of a line whose text is given, in bytes.
const LONGEST_LINE: usize = 4_096;

/// The package and target that the messages are about. Cargo's format requires both, so a topology file stands for one
/// of each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::check) struct CargoUnit {
    /// The absolute path of the topology file.
    pub(in crate::check) file: String,
    /// The absolute path of the folder to which the paths of the sources are relative.
    pub(in crate::check) folder: String,
    /// The Cargo.toml next to or above the file; the file itself where there is none.
    pub(in crate::check) manifest: String,
}

impl CargoUnit {
    /// Returns an id that no cargo package has, so that editors keep the problems of the file and of the crate apart.
    fn package_id(&self) -> String {
        format!("scl+file://{}", self.file)
    }

    fn target(&self) -> Value {
        json!({
            "kind": ["topology"], "crate_types": ["topology"], "name": "topology", "src_path": self.file,
            "edition": "2024", "doc": false, "doctest": false, "test": false,
        })
    }
}

/// Returns the line before the diagnostics of a file: a `compiler-artifact`, at which editors clear the file's earlier
/// diagnostics.
pub(in crate::check) fn cargo_start(unit: &CargoUnit) -> String {
    json!({
        "reason": "compiler-artifact", "package_id": unit.package_id(), "manifest_path": unit.manifest,
        "target": unit.target(),
        "profile": {
            "opt_level": "0", "debuginfo": 0, "debug_assertions": true, "overflow_checks": true, "test": false,
        },
        "features": [], "filenames": [], "executable": null, "fresh": false,
    })
    .to_string()
}

/// One diagnostic: a `compiler-message` without line breaks.
///
/// The code is `scl::SCL0502`, in the manner of Clippy's lints, so that editors show `scl` as its source. Lines and
/// columns count from 1, columns in characters, the end is one past the last one; bytes count from 0, without a byte
/// order mark. A diagnostic without a place is put at the start of the file, because editors drop diagnostics without a
/// span.
pub(in crate::check) fn to_cargo(diagnostic: &Diagnostic, sources: &Sources, unit: &CargoUnit) -> String {
    let level = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning | Severity::Lint => "warning",
    };
    let message = json!({
        "$message_type": "diagnostic",
        "message": diagnostic.message,
        "code": { "code": format!("scl::{}", diagnostic.code()), "explanation": null },
        "level": level,
        "spans": spans(diagnostic, sources, unit),
        "children": children(diagnostic, sources, unit),
        "rendered": format!("{}\n\n", render(diagnostic, sources)),
    });
    json!({
        "reason": "compiler-message", "package_id": unit.package_id(), "manifest_path": unit.manifest,
        "target": unit.target(), "message": message,
    })
    .to_string()
}

/// The line after all others: `build-finished`.
pub(in crate::check) fn cargo_end(success: bool) -> String {
    json!({ "reason": "build-finished", "success": success }).to_string()
}

fn spans(diagnostic: &Diagnostic, sources: &Sources, unit: &CargoUnit) -> Vec<Value> {
    match &diagnostic.primary {
        None => vec![start_of_file(unit)],
        Some(primary) => {
            let secondary = diagnostic.secondary.iter().map(|label| span(label, false, sources, unit));
            std::iter::once(span(primary, true, sources, unit)).chain(secondary).collect()
        }
    }
}

fn span(label: &Label, is_primary: bool, sources: &Sources, unit: &CargoUnit) -> Value {
    let file = sources.file(label.span.file);
    let (start, end) = (file.line_column(label.span.start), file.line_column(label.span.end));
    json!({
        "file_name": Path::new(&unit.folder).join(file.path()).display().to_string(),
        "byte_start": label.span.start, "byte_end": label.span.end,
        "line_start": start.line, "line_end": end.line,
        "column_start": start.column, "column_end": end.column,
        "is_primary": is_primary,
        "text": covered_lines(file, start, end),
        "label": Some(&label.text).filter(|text| !text.is_empty()),
        "suggested_replacement": null, "suggestion_applicability": null, "expansion": null,
    })
}

/// Returns the whole lines that a span touches, each with the columns that it covers; editors compute their own columns
/// from them. Only the first lines of a long span are included, and none if one of them is too long, because each span
/// repeats the text.
fn covered_lines(file: &SourceFile, start: LineColumn, end: LineColumn) -> Vec<Value> {
    let lines = (start.line..=end.line).take(MOST_LINES).map(|number| (number, file.line_text(number)));
    let mut lines: Vec<(u32, &str)> = lines.collect();
    // A span may end after the last line break.
    lines.pop_if(|(_, line)| line.is_empty());
    if lines.iter().any(|(_, line)| line.len() > LONGEST_LINE) {
        return Vec::new();
    }
    lines
        .into_iter()
        .map(|(number, line)| {
            let from = if number == start.line { start.column as usize } else { 1 };
            let to = if number == end.line { end.column as usize } else { line.chars().count() + 1 };
            json!({ "text": line, "highlight_start": from, "highlight_end": to })
        })
        .collect()
}

fn start_of_file(unit: &CargoUnit) -> Value {
    json!({
        "file_name": unit.file,
        "byte_start": 0, "byte_end": 0, "line_start": 1, "line_end": 1, "column_start": 1, "column_end": 1,
        "is_primary": true, "text": [], "label": null,
        "suggested_replacement": null, "suggestion_applicability": null, "expansion": null,
    })
}

/// Returns the helps and notes. Editors that show them leave out the primary label, so it comes first, as a separate
/// note.
///
/// A proposal is the spans of a help, each with its replacement: those of the help that describes it, or, if that
/// offers several, of a separate one.
fn children(diagnostic: &Diagnostic, sources: &Sources, unit: &CargoUnit) -> Vec<Value> {
    let with_spans = |text: &str, proposal: &Proposal| {
        let mut help = child("help", &format!("help: {text}"));
        help["spans"] = proposal.edits.iter().map(|edit| replacement(edit, proposal, sources, unit)).collect();
        help
    };
    let helps = diagnostic.shown_helps().flat_map(|help| match help.proposals.as_slice() {
        [only] => vec![with_spans(&help.text(), only)],
        several => {
            let words = child("help", &format!("help: {}", help.text()));
            let others = several.iter().map(|proposal| with_spans(&help.title(proposal), proposal));
            std::iter::once(words).chain(others).collect()
        }
    });
    let notes = diagnostic.all_notes().map(|note| child("note", &format!("note: {note}")));
    let mut children: Vec<Value> = helps.chain(notes).collect();
    let label = diagnostic.primary.iter().map(|label| &label.text).find(|text| !text.is_empty());
    if let Some(label) = label.filter(|_| !children.is_empty()) {
        children.insert(0, child("note", label));
    }
    children
}

fn child(level: &str, text: &str) -> Value {
    json!({ "message": text, "code": null, "level": level, "spans": [], "children": [], "rendered": null })
}

fn replacement(edit: &Edit, proposal: &Proposal, sources: &Sources, unit: &CargoUnit) -> Value {
    let mut span = span(&Label { span: edit.span, text: String::new() }, true, sources, unit);
    span["suggested_replacement"] = json!(edit.replacement);
    span["suggestion_applicability"] = json!(if proposal.is_sure { "MachineApplicable" } else { "MaybeIncorrect" });
    span
}

#[cfg(test)]
mod tests {
    use super::{CargoUnit, cargo_end, cargo_start, to_cargo};
    use crate::check::report::testing::{ERROR, WARNING};
    use scl_topology::diagnostic::Edit;
    use scl_topology::external::FILE_NOT_FOUND;
    use scl_topology::source::{Sources, Span};
    use serde_json::{Value, json};

    fn unit() -> CargoUnit {
        let text = str::to_owned;
        CargoUnit { file: text("/w/a b/t.yaml"), folder: text("/w"), manifest: text("/w/Cargo.toml") }
    }

    fn parsed(line: &str) -> Value {
        assert!(!line.contains('\n'), "{line}");
        serde_json::from_str(line).unwrap()
    }

    fn example() -> Value {
        let mut sources = Sources::new();
        let file = sources.add("a b/t.yaml", "ä: \"b\"\r\nc:\n  d\n");
        let span = |start, end| Span { file, start, end };
        let problem = WARNING
            .at("what", span(4, 7), "why")
            .label(span(9, 15), "many lines")
            .label(span(16, 16), "")
            .help("one\ntwo")
            .note("rule");
        parsed(&to_cargo(&problem, &sources, &unit()))
    }

    #[test]
    fn spans_have_bytes_lines_columns_and_texts() {
        let spans = &example()["message"]["spans"];
        assert_eq!(
            spans[0],
            json!({
                "file_name": "/w/a b/t.yaml", "byte_start": 4, "byte_end": 7,
                "line_start": 1, "line_end": 1, "column_start": 4, "column_end": 7, "is_primary": true,
                "text": [{"text": "ä: \"b\"", "highlight_start": 4, "highlight_end": 7}], "label": "why",
                "suggested_replacement": null, "suggestion_applicability": null, "expansion": null,
            })
        );
        assert_eq!(
            spans[1]["text"],
            json!([
                {"text": "c:", "highlight_start": 1, "highlight_end": 3},
                {"text": "  d", "highlight_start": 1, "highlight_end": 4},
            ])
        );
        assert_eq!((&spans[1]["line_end"], &spans[1]["is_primary"]), (&json!(3), &json!(false)));
        assert_eq!((&spans[2]["label"], &spans[2]["text"]), (&Value::Null, &json!([])));
    }

    #[test]
    fn helps_and_notes_are_children_after_the_label() {
        let message = &example()["message"];
        let children = message["children"].as_array().unwrap();
        let words: Vec<_> = children.iter().map(|child| (&child["level"], &child["message"])).collect();
        let expected = [("note", "why"), ("help", "help: one\ntwo"), ("note", "note: rule")];
        assert_eq!(words, expected.map(|(level, text)| (json!(level), json!(text))).each_ref().map(|(l, t)| (l, t)));
        assert_eq!((&message["level"], &message["code"]["code"]), (&json!("warning"), &json!("scl::SCL0999")));
        assert!(message["rendered"].as_str().unwrap().starts_with("warning: [SCL0999] what\n --> a b/t.yaml:1:4\n"));
    }

    #[test]
    fn proposals_are_spans_of_helps() {
        let mut sources = Sources::new();
        let file = sources.add("t.yaml", "a: b");
        let span = Span { file, start: 3, end: 4 };
        let problem =
            ERROR.at("what", span, "").propose("write `c`", [Edit::new(span, "c")]).did_you_mean("b", &["d", "e"]);
        let message = parsed(&to_cargo(&problem, &sources, &unit()));
        let children = message["message"]["children"].as_array().unwrap();
        let fixes: Vec<_> = children
            .iter()
            .map(|child| {
                let span = &child["spans"][0];
                let parts = [&child["message"], &span["suggested_replacement"], &span["suggestion_applicability"]];
                parts.map(|part| part.as_str().unwrap_or(""))
            })
            .collect();
        let expected = [
            ["help: write `c`", "c", "MaybeIncorrect"],
            ["help: did you mean `d` or `e`?", "", ""],
            ["help: replace with `d`", "d", "MaybeIncorrect"],
            ["help: replace with `e`", "e", "MaybeIncorrect"],
        ];
        assert_eq!(fixes, expected);
        assert_eq!(
            (&children[0]["spans"][0]["byte_start"], &children[0]["spans"][0]["byte_end"]),
            (&json!(3), &json!(4))
        );
    }

    #[test]
    fn long_lines_and_long_spans_are_not_repeated() {
        for text in ["a ".repeat(100_000), "a\n".repeat(100_000)] {
            let mut sources = Sources::new();
            let file = sources.add("t.yaml", text);
            let problem = ERROR.at("what", Span { file, start: 0, end: 199_999 }, "");
            assert!(to_cargo(&problem, &sources, &unit()).len() < 5_000);
        }
    }

    #[test]
    fn a_label_alone_needs_no_child() {
        let mut sources = Sources::new();
        let file = sources.add("t.yaml", "a");
        let problem = ERROR.at("what", Span { file, start: 0, end: 1 }, "why");
        assert_eq!(parsed(&to_cargo(&problem, &sources, &unit()))["message"]["children"], json!([]));
    }

    #[test]
    fn what_is_nowhere_is_at_the_start_of_the_file() {
        let message = parsed(&to_cargo(&FILE_NOT_FOUND.without_place("no file"), &Sources::new(), &unit()));
        let span = &message["message"]["spans"][0];
        assert_eq!((&span["file_name"], &span["line_start"]), (&json!("/w/a b/t.yaml"), &json!(1)));
    }

    #[test]
    fn all_lines_of_a_file_name_one_package() {
        let start = parsed(&cargo_start(&unit()));
        assert_eq!((&start["reason"], &start["fresh"]), (&json!("compiler-artifact"), &json!(false)));
        assert_eq!(start["package_id"], example()["package_id"]);
        assert_eq!(start["target"], example()["target"]);
        assert_eq!(parsed(&cargo_end(false)), json!({"reason": "build-finished", "success": false}));
    }
}
