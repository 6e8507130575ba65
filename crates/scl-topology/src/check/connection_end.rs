//! SCL0503: an end that is not `component.gate`.

use super::draft::Draft;
use super::end::{End, MOST_PLACES};
use super::wildcard;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::{Span, Spanned};
use scl_text::gate_name::split;
use scl_text::list::{listed, shortened};
use std::collections::HashMap;

/// SCL0503.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0503",
    severity: Severity::Error,
    title: "end is not `component.gate`",
    explanation: "An end is written `component.gate`: two names with one dot and nothing else between them. If the \
                  component is in a group, the name of the group is part of its own: `left_arm.planner.command`. Other \
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

/// Maximum length of an end that is searched for names, in bytes: every place in it may be where the dot belongs.
const LONGEST: usize = 160;

/// Maximum number of gates that a search looks at.
const SEARCHED: usize = 32;

/// Maximum number of gates that a help names.
const MOST: usize = 3;

const FORM: &str = "an end is the name of a component, a dot and the name of one of its gates";
const HEADLINE: &str = "a connection end is written `component.gate`";

/// Reports ends of another shape. Those that have the same slip are one mistake.
pub(super) fn check(draft: &mut Draft<'_>, ends: &[End], problems: &mut Diagnostics) {
    let mut told: HashMap<String, Respelt> = HashMap::new();
    let mut order: Vec<String> = Vec::new();
    for &end in ends {
        let texts = &draft.links[end[0]].model.ends;
        let text = &texts[end[1]];
        if text.value.contains('*') {
            // Two ends with wildcards are one mistake.
            if end[1] == 0 || !texts[0].value.contains('*') {
                let found = RULE.at(HEADLINE, text.span, "no wildcards");
                problems.push(wildcard::written_out(draft, found, end));
            }
            continue;
        }
        match respelt(draft, &text.value) {
            Some((label, gate)) => {
                let path = draft.path(gate);
                draft.gates[gate].named = true;
                let edit = Edit::new(text.span, draft.sources.quoted_as(text.span, &path));
                if !told.contains_key(&label) {
                    order.push(label.clone());
                }
                let slip = told.entry(label).or_default();
                slip.paths.push(path);
                slip.edits.push(edit);
            }
            None => problems.push(misshapen(draft, end, text)),
        }
    }
    for (label, slip) in order.into_iter().filter_map(|label| told.remove(&label).map(|slip| (label, slip))) {
        let places: Vec<Span> = slip.edits.iter().map(|edit| edit.span).collect();
        let help = match slip.paths.as_slice() {
            [only] => format!("write `{only}`"),
            paths => format!("write {}", listed(paths)),
        };
        let found = RULE.at(HEADLINE, places[0], label).propose(help, slip.edits).otherwise(FORM);
        let others = places.iter().skip(1).take(MOST_PLACES);
        problems.push(found.labels(others.map(|place| (*place, "and here"))));
    }
}

/// Ends with one slip: the gates that they mean, and the changes.
#[derive(Default)]
struct Respelt {
    paths: Vec<String>,
    edits: Vec<Edit>,
}

/// Splits an end into component and gate. Returns `None` if it has another shape, for example more than one dot in a
/// file without groups.
pub(super) fn parts<'t>(draft: &Draft<'_>, text: &'t str) -> Option<(&'t str, &'t str)> {
    let (component, gate) = split(text)?;
    let is_name = |name: &str| !name.is_empty() && name.chars().all(is_letter);
    let may_be_component = match component.contains('.') {
        true => draft.has_groups() && component.split('.').all(is_name),
        false => is_name(component),
    };
    (may_be_component && is_name(gate)).then_some((component, gate))
}

fn is_letter(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_' || letter == '-'
}

/// The gate that an end means, if it contains the names of a component and of its gate in this order and nothing else
/// but marks, or names before or after them. Returns a label that names the slip, too.
fn respelt(draft: &Draft<'_>, text: &str) -> Option<(String, usize)> {
    if text.len() > LONGEST {
        return None;
    }
    let words: Vec<&str> = text.split(|letter| !is_letter(letter)).filter(|word| !word.is_empty()).collect();
    let pairs = words.windows(2).map(|pair| (pair[0], pair[1]));
    let mut found: Vec<usize> = pairs.filter_map(|(component, gate)| draft.gate(component, gate)).collect();
    // The word before the name of a repeated component may say which one is meant.
    if words.len() > 2 && found.iter().any(|gate| draft.declarations(draft.component_name(*gate)).nth(1).is_some()) {
        return None;
    }
    if let [only] = words.as_slice() {
        found = split_anywhere(draft, only);
    } else if let Some(gate) = draft.find(&words.join(".")) {
        // `left_arm/planner/command`.
        found = vec![gate];
    } else if found.is_empty() {
        // `drive.left.currents` of the component `drive_left`.
        found = split_anywhere(draft, &words.join("_"));
    }
    let &[gate] = found.as_slice() else { return None };
    Some((slip(text, &words), gate))
}

/// The gates whose component and name a word without a dot consists of: `sensor_fix`, `sensorFix`.
fn split_anywhere(draft: &Draft<'_>, word: &str) -> Vec<usize> {
    let splits = word.char_indices().skip(1).filter_map(|(at, letter)| {
        let (component, rest) = word.split_at(at);
        let gate = rest.strip_prefix(['_', '-']).unwrap_or(rest);
        let lower = letter.is_uppercase().then(|| gate.to_lowercase());
        draft.gate(component, gate).or_else(|| draft.gate(component, &lower?))
    });
    splits.collect()
}

fn slip(text: &str, words: &[&str]) -> String {
    match words {
        [_, _, _, ..] if !text.contains('.') => "no dots between the names".to_owned(),
        [_, _, _, ..] if text.matches('.').count() > 1 => "more than one dot".to_owned(),
        [_, _, _, ..] => "only a component and its gate".to_owned(),
        [component, gate] if text.starts_with(component) && text.ends_with(gate) => {
            match text[component.len()..text.len() - gate.len()].trim() {
                "" => "a space instead of a dot".to_owned(),
                "." => "a space beside the dot".to_owned(),
                mark => format!("`{mark}` instead of a dot"),
            }
        }
        [_] => "no dot".to_owned(),
        _ => "not only two names and a dot".to_owned(),
    }
}

fn misshapen(draft: &mut Draft<'_>, end: End, text: &Spanned<String>) -> Diagnostic {
    let found = |label: &str| RULE.at(HEADLINE, text.span, label);
    if !draft.may_search() {
        return found(oddity(&text.value));
    }
    let owners = draft.gates_named(&text.value).iter().copied().filter(|gate| !draft.gates[*gate].duplicate);
    let owners: Vec<usize> = owners.take(SEARCHED).collect();
    if !owners.is_empty() {
        let names = listed(owners.iter().map(|&gate| draft.path(gate)));
        let found = choose(draft, found("which component?"), end, text, &owners);
        return found.otherwise(format!("gates of this name: {names}"));
    }
    if draft.component(&text.value).is_some() {
        let gates: Vec<usize> = draft.gates_of(&text.value).collect();
        let names: Vec<String> = gates.iter().map(|&gate| draft.path_and_kind(gate)).collect();
        let note = format!("gates of `{}`: {}", text.value, shortened(&names));
        return choose(draft, found("which gate?"), end, text, &gates).note(note);
    }
    let label = oddity(&text.value);
    found(label).help(FORM).about(label)
}

/// Proposes those of some gates that fit the other end, and of these the unconnected ones, if there are any.
fn choose(draft: &mut Draft<'_>, found: Diagnostic, end: End, text: &Spanned<String>, gates: &[usize]) -> Diagnostic {
    let fitting: Vec<usize> = gates.iter().copied().filter(|gate| draft.fits(end, *gate)).collect();
    let open: Vec<usize> = fitting.iter().copied().filter(|gate| !draft.gates[*gate].named).collect();
    let best = if open.is_empty() { &fitting } else { &open };
    if best.len() > MOST {
        return found;
    }
    best.iter().for_each(|gate| draft.gates[*gate].named = true);
    let paths: Vec<String> = best.iter().map(|&gate| draft.path(gate)).collect();
    let edit = |path: &str| Edit::new(text.span, draft.sources.quoted_as(text.span, path));
    let found = match best.as_slice() {
        [only] => found.label(draft.gates[*only].model.name.span, "this gate fits"),
        _ => found,
    };
    let mut found = found.choose(("write ", ""), paths.iter().map(|path| (path.as_str(), edit(path))));
    if open.is_empty() {
        found.doubt();
    }
    found
}

/// Returns the label for an end whose mistake nothing else explains.
fn oddity(text: &str) -> &'static str {
    match text {
        _ if text.ends_with('.') => "no gate after the dot",
        _ if text.starts_with('.') => "no component before the dot",
        _ if text.contains('/') => "a slash, no dot",
        _ if text.matches('.').count() > 1 => "more than one dot",
        _ if !text.contains('.') => "no dot",
        _ => "not two names",
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
                  |         ------------ this gate fits
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
            a.b.c    SCL0503 a connection end is written `component.gate` [an end is the name of a component, a dot and the name of one of its gates]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            ui/ask   SCL0503 a connection end is written `component.gate` [write `ui.ask`]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            ui::ask  SCL0503 a connection end is written `component.gate` [write `ui.ask`]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            ui->ask  SCL0503 a connection end is written `component.gate` [an end is the name of a component, a dot and the name of one of its gates]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            ui . ask SCL0503 a connection end is written `component.gate` [write `ui.ask`]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            ui.      SCL0503 a connection end is written `component.gate` [an end is the name of a component, a dot and the name of one of its gates]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            .ask     SCL0503 a connection end is written `component.gate` [an end is the name of a component, a dot and the name of one of its gates]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            ui.*     SCL0503 a connection end is written `component.gate` [write a connection for each gate, without `*`]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            ui       SCL0503 a connection end is written `component.gate` [write `ui.ask`]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
            nothing  SCL0503 a connection end is written `component.gate` [an end is the name of a component, a dot and the name of one of its gates]; SCL0501 unknown component `x` [declare the component `x` with the gate `z`, or remove the connection]
        "#]].assert_eq(&told);
    }
}
