//! A diagnostic as one line of JSON, for programs.

use scl_topology::diagnostic::{Diagnostic, Edit, Label, Proposal, Severity};
use scl_topology::source::{Sources, Span};
use serde_json::Value;

/// One object without line breaks:
/// `{"code","severity","message","file","line","column","end_line","end_column","labels":[...],"helps":[...],"notes":[...],"fixes":[...]}`.
///
/// A label is `{"file","line","column","end_line","end_column","text"}`; the first one is the primary label. Lines and
/// columns count from 1, columns in characters, and the end is one past the last character. Without a place, `file` and
/// the positions are `null`. A fix is
/// `{"file","line","column","end_line","end_column","replacement","sure","proposal","help"}`: those with the same
/// number in `proposal` belong together, and others are alternatives; `help` is the number of the text in `helps` that
/// describes it. Both count from 0.
pub(in crate::check) fn to_json(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Lint => "lint",
    };
    let mut fields: Vec<(&str, String)> =
        vec![("code", text(diagnostic.code())), ("severity", text(severity)), ("message", text(&diagnostic.message))];
    fields.extend(place(diagnostic.primary.as_ref().map(|label| label.span), sources));
    let labels = diagnostic.primary.iter().chain(&diagnostic.secondary).map(|of| label(of, sources));
    fields.push(("labels", list(labels)));
    fields.push(("helps", list(diagnostic.shown_helps().map(|help| text(&help.text())))));
    fields.push(("notes", list(diagnostic.all_notes().map(|note| text(&note)))));
    let proposals = diagnostic.shown_helps().enumerate();
    let proposals = proposals.flat_map(|(help, of)| of.proposals.iter().map(move |proposal| (help, proposal)));
    let fixes = proposals.enumerate().flat_map(|(number, (help, proposal))| {
        proposal.edits.iter().map(move |edit| fix(edit, proposal, [number, help], sources))
    });
    fields.push(("fixes", list(fixes)));
    object(&fields)
}

fn fix(edit: &Edit, proposal: &Proposal, [number, help]: [usize; 2], sources: &Sources) -> String {
    let mut fields = place(Some(edit.span), sources);
    fields.push(("replacement", text(&edit.replacement)));
    fields.push(("sure", proposal.is_sure.to_string()));
    fields.push(("proposal", number.to_string()));
    fields.push(("help", help.to_string()));
    object(&fields)
}

fn label(label: &Label, sources: &Sources) -> String {
    let mut fields = place(Some(label.span), sources);
    fields.push(("text", text(&label.text)));
    object(&fields)
}

fn place(span: Option<Span>, sources: &Sources) -> Vec<(&'static str, String)> {
    const KEYS: [&str; 5] = ["file", "line", "column", "end_line", "end_column"];
    let Some(span) = span else {
        return KEYS.map(|key| (key, Value::Null.to_string())).to_vec();
    };
    let file = sources.file(span.file);
    let (start, end) = (file.line_column(span.start), file.line_column(span.end));
    let numbers = [start.line, start.column, end.line, end.column].map(|number| number.to_string());
    KEYS.into_iter().zip(std::iter::once(text(file.path())).chain(numbers)).collect()
}

fn text(text: &str) -> String {
    Value::from(text).to_string()
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(","))
}

fn object(fields: &[(&str, String)]) -> String {
    let fields: Vec<String> = fields.iter().map(|(key, value)| format!("\"{key}\":{value}")).collect();
    format!("{{{}}}", fields.join(","))
}

#[cfg(test)]
mod tests {
    use super::to_json;
    use crate::check::report::testing::WARNING;
    use expect_test::expect;
    use scl_topology::diagnostic::Edit;
    use scl_topology::external::FILE_NOT_FOUND;
    use scl_topology::source::{Sources, Span};

    #[test]
    fn one_line_with_every_field() {
        let mut sources = Sources::new();
        let file = sources.add("t.yaml", "ä: \"b\"\r\nc:\n");
        let span = |start, end| Span { file, start, end };
        let problem = WARNING
            .at("a \"quote\"\nand more", span(4, 7), "why")
            .label(span(9, 10), "")
            .help("one\ntwo")
            .propose("write `d` and `e`", [Edit::new(span(9, 10), "d"), Edit::new(span(11, 11), "e")])
            .note("rule");
        let json = to_json(&problem, &sources);
        assert!(serde_json::from_str::<serde_json::Value>(&json).is_ok());
        expect![[r#"{"code":"SCL0999","severity":"warning","message":"a \"quote\"\nand more","file":"t.yaml","line":1,"column":4,"end_line":1,"end_column":7,"labels":[{"file":"t.yaml","line":1,"column":4,"end_line":1,"end_column":7,"text":"why"},{"file":"t.yaml","line":2,"column":1,"end_line":2,"end_column":2,"text":""}],"helps":["one\ntwo","write `d` and `e`"],"notes":["rule"],"fixes":[{"file":"t.yaml","line":2,"column":1,"end_line":2,"end_column":2,"replacement":"d","sure":false,"proposal":0,"help":1},{"file":"t.yaml","line":2,"column":3,"end_line":2,"end_column":3,"replacement":"e","sure":false,"proposal":0,"help":1}]}"#]].assert_eq(&json);
    }

    #[test]
    fn nulls_without_a_place() {
        let json = to_json(&FILE_NOT_FOUND.without_place("no file"), &Sources::new());
        expect![[r#"{"code":"SCL0001","severity":"error","message":"no file","file":null,"line":null,"column":null,"end_line":null,"end_column":null,"labels":[],"helps":[],"notes":[],"fixes":[]}"#]].assert_eq(&json);
    }
}
