//! SCL0503: an end that is not `component.gate`. Finds the gates of all other ends, and passes unknown names on to the
//! rules about components and gates.

use super::draft::Draft;
use super::{unknown_component, unknown_gate};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::Spanned;
use scl_text::list::{listed, shortened};

/// SCL0503.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0503",
    severity: Severity::Error,
    title: "end is not `component.gate`",
    explanation: "An end is written `component.gate`: two names with one dot and nothing else between them. Other \
                  separators, spaces and wildcards are not allowed.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
   - name: controller
     gates:
       - sensor: sub
 connections:
-  - [measurements, controller.sensor]
+  - [sensor.measurements, controller.sensor]
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    for link in 0..draft.links.len() {
        draft.links[link].ends = draft.links[link].model.ends.each_ref().map(|end| resolved(draft, &end.value));
    }
    // Mark all named gates first: suggestions prefer gates that no other connection names.
    name_all(draft);
    for (link, end) in (0..draft.links.len()).flat_map(|link| [(link, 0), (link, 1)]) {
        if draft.links[link].ends[end].is_none() {
            report(draft, link, end, problems);
        }
    }
}

fn resolved(draft: &Draft<'_>, text: &str) -> Option<usize> {
    let (component, gate) = text.split_once('.')?;
    draft.gate(component, gate)
}

/// Marks every gate that a connection names as connected, so that a broken connection is reported once.
fn name_all(draft: &mut Draft<'_>) {
    let whole = draft.links.iter().flat_map(|link| link.ends.into_iter().flatten());
    let broken = draft.model.broken_ends.iter().filter_map(|end| resolved(draft, &end.value));
    let named: Vec<usize> = whole.chain(broken).collect();
    for gate in named {
        draft.gates[gate].named = true;
    }
}

fn report(draft: &mut Draft<'_>, link: usize, end: usize, problems: &mut Diagnostics) {
    let text = &draft.links[link].model.ends[end];
    if text.value.is_empty() {
        return;
    }
    match parts(&text.value) {
        None => problems.push(misshapen(draft, text)),
        Some((component, gate)) if draft.component(component).is_none() => {
            unknown_component::check(draft, [link, end], [component, gate], problems);
        }
        Some((component, gate)) => unknown_gate::check(draft, [link, end], [component, gate], problems),
    }
}

/// Splits an end into component and gate. Returns `None` if it has another shape.
fn parts(text: &str) -> Option<(&str, &str)> {
    let (component, gate) = text.split_once('.')?;
    let is_name = |name: &str| {
        !name.is_empty() && name.chars().all(|letter| letter.is_alphanumeric() || letter == '_' || letter == '-')
    };
    (is_name(component) && is_name(gate)).then_some((component, gate))
}

fn misshapen(draft: &mut Draft<'_>, text: &Spanned<String>) -> Diagnostic {
    let headline = "a connection end is written `component.gate`";
    if let Some((mended, label)) = respelt(&text.value) {
        let known = resolved(draft, &mended);
        if let Some(gate) = known {
            draft.gates[gate].named = true;
        }
        let found = RULE.at(headline, text.span, label);
        let (help, edit) = (format!("write `{mended}`"), rewritten(draft, text, &mended));
        return if known.is_some() { found.propose(help, [edit]) } else { found.suggest(help, [edit]) };
    }
    let may_search = draft.may_search();
    let owners = if may_search { owners(draft, &text.value) } else { Vec::new() };
    if let Some(&gate) = owners.first() {
        return without_component(draft, headline, text, gate, &owners);
    }
    if draft.component(&text.value).is_some() {
        if !may_search {
            return RULE.at(headline, text.span, "which gate?");
        }
        let gates: Vec<String> = draft.gates_of(&text.value).map(|gate| draft.path_and_kind(gate)).collect();
        let note = format!("gates of `{}`: {}", text.value, shortened(&gates));
        return RULE.at(headline, text.span, "which gate?").note(note);
    }
    let (label, help) = oddity(&text.value);
    RULE.at(headline, text.span, label).help(help)
}

/// The gates of this name, of any component.
fn owners(draft: &Draft<'_>, gate: &str) -> Vec<usize> {
    let is_meant = |at: &usize| draft.gates[*at].model.name.value == gate && !draft.gates[*at].duplicate;
    (0..draft.gates.len()).filter(is_meant).collect()
}

fn without_component(
    draft: &mut Draft<'_>,
    headline: &str,
    text: &Spanned<String>,
    gate: usize,
    owners: &[usize],
) -> Diagnostic {
    let found = RULE.at(headline, text.span, "which component?");
    let paths: Vec<String> = owners.iter().map(|&gate| draft.path(gate)).collect();
    match paths.as_slice() {
        [only] => {
            let was_named = std::mem::replace(&mut draft.gates[gate].named, true);
            let label = format!("only `{}` has a gate of this name", draft.component_name(gate));
            let found = found.label(draft.gates[gate].model.name.span, label);
            let (help, edit) = (format!("write `{only}`"), rewritten(draft, text, only));
            if was_named { found.suggest(help, [edit]) } else { found.propose(help, [edit]) }
        }
        [_, _] | [_, _, _] => {
            found.choose(("write ", ""), paths.iter().map(|path| (path.as_str(), rewritten(draft, text, path))))
        }
        _ => found.note(format!("gates of this name: {}", listed(&paths))),
    }
}

/// The replacement of an end.
fn rewritten(draft: &Draft<'_>, text: &Spanned<String>, end: &str) -> Edit {
    Edit::new(text.span, draft.sources.quoted_as(text.span, end))
}

/// Corrects an end with another separator or with spaces. Returns the corrected end, and a label that names the
/// mistake.
fn respelt(text: &str) -> Option<(String, String)> {
    let separator = ["->", "::", "/", ":", " . ", " .", ". "].into_iter().find(|separator| text.contains(separator))?;
    let mended = text.split(separator).map(str::trim).collect::<Vec<_>>().join(".");
    parts(&mended)?;
    let label = match separator.trim() {
        "." => "a space beside the dot".to_owned(),
        other => format!("`{other}` instead of a dot"),
    };
    Some((mended, label))
}

/// Returns the label and the help for an end whose mistake nothing else explains.
fn oddity(text: &str) -> (&'static str, &'static str) {
    let dots = text.matches('.').count();
    match text {
        _ if text.contains('*') => ("no wildcards", "write one connection for each gate"),
        _ if text.ends_with('.') => ("no gate after the dot", "write the gate after the dot"),
        _ if text.starts_with('.') => ("no component before the dot", "write the component before the dot"),
        _ if dots > 1 => ("more than one dot", "write the component and its gate, with one dot between them"),
        _ if dots == 0 => ("no dot", "write the component, a dot and its gate"),
        _ => ("not two names", "write the component, a dot and its gate"),
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn end_is_not_component_gate() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0503] a connection end is written `component.gate`
             --> topology.yaml:9:6
              |
            4 |       - measurements: pub
              |         ------------ only `sensor` has a gate of this name
            ...
            9 |   - [measurements, controller.sensor]
              |      ^^^^^^^^^^^^ which component?
              |
              = help: write `sensor.measurements`
        "#]],
        );
    }

    #[test]
    fn other_shapes_of_ends() {
        let ends = ["a.b.c", "ui/ask", "ui::ask", "ui->ask", "ui . ask", "ui.", ".ask", "ui.*", "ui", "nothing"];
        let advice = |end: &str| {
            advice(&format!(
                "components:\n  - name: ui\n    gates:\n      - ask: req\n      - fix: sub\nconnections:\n  - ['{end}', x.z]\n"
            ))
        };
        let told: String = ends.iter().map(|end| format!("{end:8} {}\n", advice(end))).collect();
        expect![[r#"
            a.b.c    SCL0503 a connection end is written `component.gate` [write the component and its gate, with one dot between them]; SCL0501 unknown component `x` []
            ui/ask   SCL0503 a connection end is written `component.gate` [write `ui.ask`]; SCL0501 unknown component `x` []
            ui::ask  SCL0503 a connection end is written `component.gate` [write `ui.ask`]; SCL0501 unknown component `x` []
            ui->ask  SCL0503 a connection end is written `component.gate` [write `ui.ask`]; SCL0501 unknown component `x` []
            ui . ask SCL0503 a connection end is written `component.gate` [write `ui.ask`]; SCL0501 unknown component `x` []
            ui.      SCL0503 a connection end is written `component.gate` [write the gate after the dot]; SCL0501 unknown component `x` []
            .ask     SCL0503 a connection end is written `component.gate` [write the component before the dot]; SCL0501 unknown component `x` []
            ui.*     SCL0503 a connection end is written `component.gate` [write one connection for each gate]; SCL0501 unknown component `x` []
            ui       SCL0503 a connection end is written `component.gate` []; SCL0501 unknown component `x` []
            nothing  SCL0503 a connection end is written `component.gate` [write the component, a dot and its gate]; SCL0501 unknown component `x` []
        "#]].assert_eq(&told);
    }
}
