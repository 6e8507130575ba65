//! Finds the gates at the ends of connections. Ends without a gate go to the rules about them: all ends with the same
//! unknown component or gate together, because they are one mistake.

use super::draft::Draft;
use super::end::{End, Fault};
use super::{commented_out, connection_end, duplicate_name, suspect, unknown_component, unknown_gate};
use crate::diagnostic::Diagnostics;
use std::collections::HashMap;

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    for link in 0..draft.links.len() {
        let ends = draft.links[link].model.ends.each_ref().map(|end| draft.find(&end.value));
        draft.links[link].ends = ends;
    }
    // Mark all named gates first: suggestions prefer gates that no other connection names.
    name_all(draft);
    let mut faults: Vec<(Fault<'_>, Vec<End>)> = Vec::new();
    let mut known: HashMap<Fault<'_>, usize> = HashMap::new();
    for end in (0..draft.links.len()).flat_map(|link| [[link, 0], [link, 1]]) {
        if let Some(fault) = fault(draft, end) {
            let at = *known.entry(fault).or_insert(faults.len());
            if at == faults.len() {
                faults.push((fault, Vec::new()));
            }
            faults[at].1.push(end);
        }
    }
    duplicate_name::check(draft, &mut faults, problems);
    let is_unknown = |(fault, _): &(Fault<'_>, Vec<End>)| matches!(fault, Fault::Component(_));
    let commented_out = if faults.iter().any(is_unknown) { commented_out::names(draft) } else { HashMap::new() };
    for (fault, ends) in faults {
        match fault {
            Fault::Shape => connection_end::check(draft, &ends, problems),
            Fault::Swapped(component, gate) => unknown_component::swapped(draft, [component, gate], &ends, problems),
            Fault::Component(component) => {
                let comment = commented_out.get(component).copied();
                unknown_component::check(draft, component, comment, &ends, problems);
            }
            Fault::Gate(component, gate) => unknown_gate::check(draft, [component, gate], &ends, problems),
        }
    }
    suspect::mark(draft);
}

fn fault<'m>(draft: &Draft<'m>, [link, end]: End) -> Option<Fault<'m>> {
    let (model, found) = (draft.links[link].model, draft.links[link].ends[end]);
    let text = model.ends[end].value.as_str();
    if found.is_some() || text.is_empty() {
        return None;
    }
    // A whole component in a group looks like a gate of another one.
    let parts = connection_end::parts(draft, text).filter(|_| draft.component(text).is_none());
    let Some((component, gate)) = parts else { return Some(Fault::Shape) };
    Some(match draft.component(component) {
        _ if draft.gate(gate, component).is_some() => Fault::Swapped(component, gate),
        None => Fault::Component(component),
        Some(_) => Fault::Gate(component, gate),
    })
}

/// Marks every gate that a connection names as connected, so that a broken connection is reported once.
fn name_all(draft: &mut Draft<'_>) {
    let whole: Vec<usize> = draft.links.iter().flat_map(|link| link.ends.into_iter().flatten()).collect();
    let broken: Vec<usize> = draft.model.broken_ends.iter().filter_map(|end| draft.find(&end.value)).collect();
    for gate in whole.iter().chain(&broken) {
        draft.gates[*gate].named = true;
        draft.gates[*gate].uses += 1;
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::{advice, problems};

    /// Two components with a gate each, and another that is connected.
    fn file(connections: &str) -> String {
        let lines: String = connections.split("; ").map(|pair| format!("  - [{pair}]\n")).collect();
        format!(
            "system: uav\ncomponents:\n  - name: gps_unit\n    gates:\n      - fix: {{pub: Fix}}\n      - raw: {{pub: Raw}}\n  \
             - name: pilot\n    gates:\n      - fix: {{sub: Fix}}\n      - raw: {{sub: Raw}}\n  - name: log\n    gates:\n      \
             - raw: {{sub: Raw}}\nconnections:\n{lines}"
        )
    }

    #[test]
    fn what_an_end_means_is_proposed() {
        let raw = "gps_unit.raw, pilot.raw; gps_unit.raw, log.raw";
        let cases = [
            ("gps_unit/fix, pilot.fix", "SCL0503 a connection end is written `component.gate` [write `gps_unit.fix`]"),
            (
                "uav.gps_unit.fix, pilot.fix",
                "SCL0503 a connection end is written `component.gate` [write `gps_unit.fix`]",
            ),
            (
                "'http://gps_unit/fix', pilot.fix",
                "SCL0503 a connection end is written `component.gate` [write `gps_unit.fix`]",
            ),
            (
                "gps_unit_fix, pilotFix",
                "SCL0503 a connection end is written `component.gate` [write `gps_unit.fix`, `pilot.fix`]",
            ),
            ("gps_unit, pilot.fix", "SCL0503 a connection end is written `component.gate` [write `gps_unit.fix`]"),
            ("fix, pilot.fix", "SCL0503 a connection end is written `component.gate` [write `gps_unit.fix`]"),
            (
                "gps_unit.fixx, pilot.fix",
                "SCL0502 component `gps_unit` has no gate `fixx` [did you mean `fix`? | or rename the gate `fix` to `fixx`]",
            ),
            ("gps_unit.fix, log.fix", "SCL0502 component `log` has no gate `fix` [did you mean `pilot.fix`?]"),
            ("gps_unit.fix, nothing.fix", "SCL0501 unknown component `nothing` [did you mean `pilot`?]"),
            ("gps_uint.fix, pilot.fix", "SCL0501 unknown component `gps_uint` [did you mean `gps_unit`?]"),
            ("GPS_UNIT.FIX, pilot.fix", "SCL0501 unknown component `GPS_UNIT` [did you mean `gps_unit.fix`?]"),
        ];
        for (pair, expected) in cases {
            assert_eq!(advice(&file(&format!("{raw}; {pair}"))), expected, "{pair}");
        }
    }

    #[test]
    fn several_uses_of_one_name_mean_that_the_declaration_is_wrong() {
        let renamed = file("gps.fix, pilot.fix; gps.raw, pilot.raw; gps.raw, log.raw").replace("gps_unit", "gsp");
        assert_eq!(
            advice(&renamed),
            "SCL0501 unknown component `gps` [rename `gsp` to `gps`, as the connections call it | or write `gsp` in the connections]"
        );
        let renamed = file("gps_unit.fix, pilot.fix; gps_unit.rwa, pilot.raw; gps_unit.rwa, log.raw");
        let expected = "SCL0502 component `gps_unit` has no gate `rwa` [rename the gate `raw` to `rwa`, as the connections call it | or write `raw` in the connections]";
        assert_eq!(advice(&renamed), expected);
    }

    #[test]
    fn a_repeated_name_may_be_the_one_that_is_missing() {
        let copied = file("gps_unit.fix, pilot.fix; gps_unit.raw, log.raw; gps_unit.raw, view.raw").replace(
            "      - raw: {sub: Raw}\n  - name: log",
            "  - name: log\n    gates:\n      - raw: {sub: Raw}\n  - name: log",
        );
        let expected =
            "SCL0301 component `log` is declared twice [rename the second one to `view`, which the connections name]";
        assert_eq!(advice(&copied), expected);
        let copied = file("gps_unit.fix, pilot.fix; gps_unit.raw, pilot.raw; gps_unit.raw, log.raw")
            .replace("      - raw: {sub: Raw}\n  - name: log", "      - fix: {sub: Raw}\n  - name: log");
        let expected = "SCL0302 component `pilot` declares gate `fix` twice [rename the second one to `raw`, which the connections name]";
        assert_eq!(advice(&copied), expected);
    }

    #[test]
    fn an_unknown_end_leaves_no_gate_unconnected() {
        for pair in [
            "gps_unit.*, pilot.fix",
            "x.y, pilot.fix",
            "gps_unit.y, pilot.fix",
            "'?', pilot.fix",
            "*.fix, pilot.fix",
            "gps_unit.fix, x.y",
            "gps_unit.fix",
            "gps_unit.fix pilot.fix",
            "gps_unit.fix, [pilot.fix]",
            "gps_unit.fix, pilot",
            "gps_unit: fix, pilot: fix",
            "gps_unit.fix, 1.5",
        ] {
            // `raw` is unconnected in all of them.
            let (found, _) = problems(&file(pair), None);
            let told: Vec<&str> = found.iter().map(|found| found.message.as_str()).collect();
            let is_wrong = |told: &&str| {
                told.contains("fix` is not") || told.contains("to `gps_unit.fix") || told.contains("`pilot` is not")
            };
            assert!(!told.iter().any(is_wrong), "{pair}: {told:?}");
        }
    }
}
