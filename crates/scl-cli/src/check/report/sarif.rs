//! Diagnostics as SARIF 2.1.0, the format that code hosts and review tools read.

use crate::explain::{all_rules, explain_rule};
use scl_topology::diagnostic::{Diagnostic, Label, Proposal, Severity};
use scl_topology::source::{Sources, Span};
use serde_json::{Value, json};

/// One checked file with what was found in it.
#[derive(Debug, Clone, Copy)]
pub(in crate::check) struct CheckedFile<'a> {
    /// The path as messages name it.
    pub(in crate::check) path: &'a str,
    /// The texts that the diagnostics point into.
    pub(in crate::check) sources: &'a Sources,
    /// What was found.
    pub(in crate::check) diagnostics: &'a [Diagnostic],
}

/// One SARIF log with one run over all files, over several lines.
///
/// The rules are the codes that occur, sorted. Columns count characters from 1, the end is one past the last one. The
/// text of a result is the headline, then the label, the helps and the notes, each on its own line; the secondary
/// labels are related locations. Paths become relative URIs, absolute ones `file:` URIs. A diagnostic without a place
/// is located at its file as a whole.
pub(in crate::check) fn to_sarif(files: &[CheckedFile<'_>]) -> String {
    let mut found: Vec<&Diagnostic> = files.iter().flat_map(|file| file.diagnostics).collect();
    found.sort_by_key(|diagnostic| diagnostic.code());
    found.dedup_by_key(|diagnostic| diagnostic.rule);
    let codes: Vec<&str> = found.iter().map(|diagnostic| diagnostic.code()).collect();
    let results = files.iter().flat_map(|file| file.diagnostics.iter().map(|it| result(it, file, &codes)));
    let driver = json!({
        "name": "scl", "semanticVersion": env!("CARGO_PKG_VERSION"),
        "rules": found.iter().map(|diagnostic| rule(diagnostic)).collect::<Vec<_>>(),
    });
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": driver },
            "columnKind": "unicodeCodePoints",
            "results": results.collect::<Vec<_>>(),
        }],
    });
    format!("{log:#}")
}

/// Returns the SARIF rule of a diagnostic's code, with what the catalogue says about it.
fn rule(diagnostic: &Diagnostic) -> Value {
    let mut rule = json!({ "id": diagnostic.code(), "defaultConfiguration": { "level": level(diagnostic.severity) } });
    if let Some(known) = all_rules().into_iter().find(|known| *known == diagnostic.rule) {
        rule["shortDescription"] = json!({ "text": known.title });
        rule["fullDescription"] = json!({ "text": known.explanation });
        rule["defaultConfiguration"]["level"] = json!(level(known.severity));
    }
    if let Some(entry) = explain_rule(diagnostic.code()) {
        rule["help"] = json!({ "text": entry, "markdown": entry });
    }
    rule
}

fn result(diagnostic: &Diagnostic, file: &CheckedFile<'_>, codes: &[&str]) -> Value {
    let place = match &diagnostic.primary {
        Some(label) => location(label, file.sources),
        None => json!({ "physicalLocation": { "artifactLocation": { "uri": uri(file.path) } } }),
    };
    let related = diagnostic.secondary.iter().enumerate().map(|(id, label)| {
        let mut related = location(label, file.sources);
        related["id"] = json!(id);
        related
    });
    let mut result = json!({
        "ruleId": diagnostic.code(),
        "ruleIndex": codes.iter().position(|code| *code == diagnostic.code()),
        "level": level(diagnostic.severity),
        "message": { "text": text(diagnostic) },
        "locations": [place],
        "relatedLocations": related.collect::<Vec<_>>(),
    });
    let fixes = fixes(diagnostic, file.sources);
    if !fixes.is_empty() {
        result["fixes"] = json!(fixes);
    }
    result
}

/// Returns each proposal as a separate SARIF fix.
fn fixes(diagnostic: &Diagnostic, sources: &Sources) -> Vec<Value> {
    let helps = diagnostic.shown_helps();
    helps
        .flat_map(|help| help.proposals.iter().map(move |proposal| fix(&help.title(proposal), proposal, sources)))
        .collect()
}

fn fix(title: &str, proposal: &Proposal, sources: &Sources) -> Value {
    let mut paths: Vec<&str> = proposal.edits.iter().map(|edit| sources.file(edit.span.file).path()).collect();
    paths.dedup();
    let changes = paths.into_iter().map(|path| {
        let here = proposal.edits.iter().filter(|edit| sources.file(edit.span.file).path() == path);
        let replacements = here.map(|edit| {
            json!({ "deletedRegion": region(edit.span, sources), "insertedContent": { "text": edit.replacement } })
        });
        json!({ "artifactLocation": { "uri": uri(path) }, "replacements": replacements.collect::<Vec<_>>() })
    });
    json!({ "description": { "text": title }, "artifactChanges": changes.collect::<Vec<_>>() })
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Lint => "note",
    }
}

fn text(diagnostic: &Diagnostic) -> String {
    let label = diagnostic.primary.iter().map(|label| label.text.clone()).filter(|text| !text.is_empty());
    let helps = diagnostic.shown_helps().map(|help| format!("help: {}", help.text()));
    let notes = diagnostic.all_notes().map(|note| format!("note: {note}"));
    let lines = std::iter::once(diagnostic.message.clone()).chain(label).chain(helps).chain(notes);
    lines.collect::<Vec<_>>().join("\n")
}

fn location(label: &Label, sources: &Sources) -> Value {
    let file = sources.file(label.span.file);
    let mut location = json!({
        "physicalLocation": {
            "artifactLocation": { "uri": uri(file.path()) },
            "region": region(label.span, sources),
        },
    });
    if !label.text.is_empty() {
        location["message"] = json!({ "text": label.text });
    }
    location
}

fn region(span: Span, sources: &Sources) -> Value {
    let file = sources.file(span.file);
    let (start, end) = (file.line_column(span.start), file.line_column(span.end));
    json!({ "startLine": start.line, "startColumn": start.column, "endLine": end.line, "endColumn": end.column })
}

/// Converts a path to a URI. Bytes other than `/` and the unreserved ASCII characters are percent-encoded.
fn uri(path: &str) -> String {
    let mut uri = String::from(if path.starts_with('/') { "file://" } else { "" });
    for byte in path.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => uri.push(char::from(byte)),
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::{CheckedFile, fixes, to_sarif, uri};
    use crate::check::report::testing::{OTHER, WARNING};
    use scl_topology::diagnostic::Edit;
    use scl_topology::external::FILE_NOT_FOUND;
    use scl_topology::source::{Sources, Span};
    use serde_json::{Value, json};

    fn example() -> Value {
        let mut sources = Sources::new();
        let file = sources.add("a b/ä.yaml", "ä: \"b\"\r\nc:\n");
        let span = |start, end| Span { file, start, end };
        let problem =
            WARNING.at("what", span(4, 7), "why").label(span(9, 10), "here").help("write `[a.b, c.d]`").note("rule");
        let first = [problem.clone(), OTHER.at("other", span(0, 1), "")];
        let second = [FILE_NOT_FOUND.without_place("no file"), problem];
        let files = [("a b/ä.yaml", &first), ("/x.yaml", &second)];
        let files = files.map(|(path, diagnostics)| CheckedFile { path, sources: &sources, diagnostics });
        serde_json::from_str(&to_sarif(&files)).unwrap()
    }

    #[test]
    fn one_run_with_each_code_once() {
        let log = example();
        assert_eq!((&log["version"], log["runs"].as_array().map(Vec::len)), (&json!("2.1.0"), Some(1)));
        let run = &log["runs"][0];
        let ids: Vec<_> = run["tool"]["driver"]["rules"].as_array().unwrap().iter().map(|rule| &rule["id"]).collect();
        assert_eq!(ids, ["SCL0001", "SCL0100", "SCL0999"]);
        let results = run["results"].as_array().unwrap();
        let rules: Vec<_> = results.iter().map(|result| (&result["ruleId"], &result["ruleIndex"])).collect();
        let expected = [("SCL0999", 2), ("SCL0100", 1), ("SCL0001", 0), ("SCL0999", 2)];
        assert_eq!(rules, expected.map(|(id, at)| (json!(id), json!(at))).each_ref().map(|(id, at)| (id, at)));
    }

    #[test]
    fn rules_explain_themselves() {
        let rule = &example()["runs"][0]["tool"]["driver"]["rules"][0];
        assert_eq!(rule["shortDescription"]["text"], "topology file not found");
        assert!(rule["help"]["markdown"].as_str().unwrap().starts_with("# SCL0001 "));
        assert_eq!(rule["defaultConfiguration"]["level"], "error");
    }

    #[test]
    fn a_result_has_its_region_its_words_and_related_places() {
        let location = |region: Value, text: &str| {
            json!({
                "physicalLocation": { "artifactLocation": { "uri": "a%20b/%C3%A4.yaml" }, "region": region },
                "message": { "text": text },
            })
        };
        let mut related = location(json!({"startLine": 2, "startColumn": 1, "endLine": 2, "endColumn": 2}), "here");
        related["id"] = json!(0);
        assert_eq!(
            example()["runs"][0]["results"][0],
            json!({
                "ruleId": "SCL0999", "ruleIndex": 2, "level": "warning",
                "message": { "text": "what\nwhy\nhelp: write `[a.b, c.d]`\nnote: rule" },
                "locations": [
                    location(json!({"startLine": 1, "startColumn": 4, "endLine": 1, "endColumn": 7}), "why"),
                ],
                "relatedLocations": [related],
            })
        );
    }

    #[test]
    fn each_proposal_is_a_fix() {
        let mut sources = Sources::new();
        let file = sources.add("t.yaml", "ä: b\n");
        let span = |start, end| Span { file, start, end };
        let problem = WARNING.at("what", span(4, 5), "").did_you_mean("b", &["c", "d"]);
        let problem = problem.propose("write it so", [Edit::new(span(0, 0), "("), Edit::new(span(5, 5), ")")]);
        let region = |start, end| json!({ "startLine": 1, "startColumn": start, "endLine": 1, "endColumn": end });
        let change =
            |start, end, text| json!({ "deletedRegion": region(start, end), "insertedContent": { "text": text } });
        let fix = |text, replacements: &[Value]| {
            let change = json!({ "artifactLocation": { "uri": "t.yaml" }, "replacements": replacements });
            json!({ "description": { "text": text }, "artifactChanges": [change] })
        };
        assert_eq!(
            fixes(&problem, &sources),
            [
                fix("replace with `c`", &[change(4, 5, "c")]),
                fix("replace with `d`", &[change(4, 5, "d")]),
                fix("write it so", &[change(1, 1, "("), change(5, 5, ")")]),
            ]
        );
    }

    #[test]
    fn what_is_nowhere_is_at_its_file() {
        let place = json!({ "physicalLocation": { "artifactLocation": { "uri": "file:///x.yaml" } } });
        assert_eq!(example()["runs"][0]["results"][2]["locations"], json!([place]));
    }

    #[test]
    fn uris_are_ascii() {
        for (path, expected) in [("a/b.yaml", "a/b.yaml"), ("<stdin>", "%3Cstdin%3E"), ("/a%20", "file:///a%2520")] {
            assert_eq!(uri(path), expected, "{path}");
        }
    }
}
