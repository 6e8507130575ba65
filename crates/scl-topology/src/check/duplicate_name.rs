//! SCL0301: two components of one name. SCL0302: two gates of one name in a component. A connection could not say which
//! it means.

use super::draft::Draft;
use super::end::{End, Fault, MOST_PLACES};
use super::named::{Name, with_first};
use super::{merge, namespace, twin_gate};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use scl_text::gate_name::split;

/// SCL0301.
pub(crate) const COMPONENT: Rule = Rule {
    code: "SCL0301",
    severity: Severity::Error,
    title: "duplicate component",
    explanation: "Two components have the same name, so a connection could not say which one it means, and their \
                  programs could not run at the same time. Rename one, or merge their gates.",
    example: " components:
   - name: sensor
     gates: []
-  - name: sensor
+  - name: sensor_2
     gates: []
",
};

/// SCL0302.
pub(crate) const GATE: Rule = Rule {
    code: "SCL0302",
    severity: Severity::Error,
    title: "duplicate gate",
    explanation: "Two gates of a component have the same name. Even if their kinds differ, neither a connection nor a \
                  program could say which one it means. Rename one.",
    example: " components:
   - name: controller
     gates:
       - sensor: sub
-      - sensor: pub
+      - sensor_2: pub
",
};

/// Maximum number of repeated names for which a new name is searched among those that connections use.
const MOST_SEARCHES: usize = 16;

/// Maximum number of unknown names, and of the places of each, that such a search looks at.
const SEARCHED: usize = 32;

/// Reports repeated names. If connections use an unknown name that fits the second declaration, it is suggested, and is
/// not a fault of the connections.
pub(super) fn check<'m>(draft: &Draft<'m>, faults: &mut Vec<(Fault<'m>, Vec<End>)>, problems: &mut Diagnostics) {
    let mut searches = MOST_SEARCHES;
    let model = draft.model;
    for (first, second) in repeated(model.components.iter().map(|component| &component.name)) {
        let headline = format!("component `{}` is declared twice", second.value);
        let mut found = report(&COMPONENT, headline, first, second);
        // Both are searched in the whole file, so only for the first ones.
        let of = |name: &Name| model.components.iter().find(|component| std::ptr::eq(&component.name, name));
        if searches > 0
            && let Some(first) = of(first)
            && let Some(declared) = of(second)
        {
            let fits = |fault: &Fault<'m>, ends: &[End]| match fault {
                Fault::Component(_) => ends.iter().take(SEARCHED).all(|&[link, end]| {
                    let gate = split(&draft.links[link].model.ends[end].value).map(|(_, gate)| gate);
                    declared.gates.iter().any(|own| Some(own.name.value.as_str()) == gate)
                }),
                _ => false,
            };
            found = rename(draft, found, second, take(faults, &mut searches, fits));
            found = match namespace::prefixed(draft, &second.value, faults) {
                Some((help, edits)) => found.suggest(help, edits),
                None => merge::suggest(found, model, draft.sources, [first, declared]),
            };
        }
        problems
            .push(found.otherwise("a component is declared once, with all its gates; another one has another name"));
    }
    for component in &draft.components {
        let gates = &component.model.gates;
        for (first, second) in repeated(gates.iter().map(|gate| &gate.name)) {
            let owner = &component.model.name.value;
            let headline = format!("component `{owner}` declares gate `{}` twice", second.value);
            let mut found = report(&GATE, headline, first, second);
            let of = |name: &Name| gates.iter().position(|gate| std::ptr::eq(&gate.name, name));
            if searches > 0
                && let Some(one) = of(first)
                && let Some(two) = of(second)
            {
                let [one, two] = [one, two].map(|at| component.gates[at]);
                let fits = |fault: &Fault<'m>, ends: &[End]| match fault {
                    Fault::Gate(other, _) => {
                        owner == other && ends.iter().take(SEARCHED).all(|end| draft.fits(*end, two))
                    }
                    _ => false,
                };
                found = rename(draft, found, second, take(faults, &mut searches, fits));
                found = twin_gate::with_ways(draft, found, [one, two]);
            }
            problems.push(found.otherwise(
                "gate names are unique within a component: give one of them another name, also in its connections",
            ));
        }
    }
}

/// Takes the only fault that fits, if there is one.
fn take<'m>(
    faults: &mut Vec<(Fault<'m>, Vec<End>)>,
    searches: &mut usize,
    fits: impl Fn(&Fault<'m>, &[End]) -> bool,
) -> Option<(Fault<'m>, Vec<End>)> {
    *searches = searches.checked_sub(1)?;
    let mut fitting = (0..faults.len().min(SEARCHED)).filter(|&at| fits(&faults[at].0, &faults[at].1));
    let only = fitting.next()?;
    fitting.next().is_none().then(|| faults.remove(only))
}

/// Suggests the name that connections use for the second declaration.
fn rename(draft: &Draft<'_>, found: Diagnostic, second: &Name, fault: Option<(Fault<'_>, Vec<End>)>) -> Diagnostic {
    let Some((Fault::Component(name) | Fault::Gate(_, name), ends)) = fault else { return found };
    let help = format!("rename the second one to `{name}`, which the connections name");
    let edit = Edit::new(second.span, draft.sources.quoted_as(second.span, name));
    let places = ends.iter().take(MOST_PLACES).map(|&[link, end]| draft.links[link].model.ends[end].span);
    found.suggest(help, [edit]).labels(places.map(|place| (place, "not declared")))
}

/// Returns each repeated name, preceded by its first occurrence.
fn repeated<'m>(names: impl Iterator<Item = &'m Name>) -> impl Iterator<Item = (&'m Name, &'m Name)> {
    // Compare addresses: `with_first` pairs the first declaration with itself.
    with_first(names, |name| name).filter(|(first, name)| !std::ptr::eq(*first, *name))
}

fn report(rule: &'static Rule, headline: String, first: &Name, second: &Name) -> Diagnostic {
    rule.at(headline, second.span, "second declaration").label(first.span, "first declaration")
}

#[cfg(test)]
mod tests {
    use super::{COMPONENT, GATE};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn duplicate_component() {
        rule_example(
            &COMPONENT,
            expect![[r#"
                error: [SCL0301] component `sensor` is declared twice
                 --> topology.yaml:4:11
                  |
                2 |   - name: sensor
                  |           ------ first declaration
                3 |     gates: []
                4 |   - name: sensor
                  |           ^^^^^^ second declaration
                  |
                  = help: if they are one component, remove the second one; otherwise give it another name
            "#]],
        );
    }

    #[test]
    fn duplicate_gate() {
        rule_example(
            &GATE,
            expect![[r#"
                error: [SCL0302] component `controller` declares gate `sensor` twice
                 --> topology.yaml:5:9
                  |
                4 |       - sensor: sub
                  |         ------ first declaration
                5 |       - sensor: pub
                  |         ^^^^^^ second declaration
                  |
                  = help: give the `sub` gate a name of its own, for example `sensor_in`
            "#]],
        );
    }
}
