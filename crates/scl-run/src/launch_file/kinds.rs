//! Entries of kinds: one entry for all components of a kind, which the entry of a single component changes.

use super::entry::{Entry, Needs};
use super::reader::Reader;
use super::rules::CONTRADICTION;
use super::terminal::decides_input;
use scl_terminal::quoted_list;
use scl_topology::parse::Field;
use std::collections::HashSet;

impl<'a> Reader<'a> {
    /// The components of a kind of the topology; `None` if it has no kind of this name.
    pub(super) fn components_of(&self, name: &str) -> Option<&'a [String]> {
        self.known?.components_of(name)
    }

    /// What messages call the owner of an entry.
    pub(super) fn owner(&self, name: &str) -> String {
        let noun = if self.components_of(name).is_some() { "kind" } else { "component" };
        format!("{noun} `{name}`")
    }

    /// The names, and the components of those that are kinds.
    pub(super) fn with_components_of_kinds(&self, mut names: Vec<String>) -> Vec<String> {
        let of_kinds = names.iter().filter_map(|name| self.components_of(name)).flatten().cloned();
        let of_kinds: Vec<String> = of_kinds.collect();
        names.extend(of_kinds);
        names
    }

    /// Reads the entries of `components` or of a profile: an entry of a kind is one of each of its components, and
    /// entries that change these follow it. `needs` gets a name, and whether its kind has an entry, too.
    pub(super) fn read_entries<'n>(
        &mut self,
        fields: &[Field<'_>],
        needs: impl Fn(&Self, &str, bool) -> Needs<'n>,
    ) -> Vec<Entry> {
        let of_kinds: HashSet<&str> =
            fields.iter().filter_map(|field| self.components_of(field.key)).flatten().map(String::as_str).collect();
        let mut ordered: Vec<Field<'_>> = fields.to_vec();
        ordered.sort_by_key(|field| of_kinds.contains(field.key));
        let mut entries = Vec::new();
        for field in ordered {
            let needs = needs(self, field.key, of_kinds.contains(field.key));
            let Some(entry) = self.read_entry(field, needs) else { continue };
            match self.components_of(field.key) {
                Some(components) => entries.extend(entry.of_each(components)),
                None => entries.push(entry),
            }
        }
        entries
    }

    /// Reports `input: terminal` at a kind, unless at most one of its components gets it.
    pub(super) fn check_terminal_of_kind(&mut self, kind: &str, input: Field<'_>, entries: &[Field<'_>]) {
        let has_own = |name: &String| entries.iter().any(|entry| entry.key == name && decides_input(entry.value));
        let components = self.components_of(kind).unwrap_or_default().iter().filter(|name| !has_own(name));
        let components: Vec<&String> = components.collect();
        if components.len() < 2 {
            return;
        }
        let message = format!("{} components of the kind `{kind}` have `input: terminal`", components.len());
        let problem = CONTRADICTION.at(message, input.key_span.to(input.value.span), "");
        let problem = match self.remove_entry(input) {
            Some(edit) => problem.suggest("remove it, or write it in an entry of one of them", [edit]),
            None => problem,
        };
        let problem = problem.note(format!("they are {}", quoted_list(components)));
        self.report(problem.note("only one component can read from the terminal"));
    }
}

#[cfg(test)]
mod tests {
    use super::super::entry::Source;
    use super::super::{LaunchComponent, LaunchDocument, LaunchFile};
    use crate::system_names::SystemNames;
    use expect_test::expect;

    fn words(words: &[&str]) -> Vec<String> {
        words.iter().map(|word| (*word).to_owned()).collect()
    }

    fn names() -> SystemNames {
        SystemNames {
            components: words(&["left_motor", "controller", "right_motor"]),
            kinds: vec![("motor".to_owned(), words(&["left_motor", "right_motor"]))],
            ..SystemNames::default()
        }
    }

    fn file(text: &str) -> LaunchFile {
        LaunchDocument::parse("launch.yaml", text).read_shown(Some(&names())).expect("a file without mistakes")
    }

    /// The components with their commands, processors and the places of their entries.
    fn shown(components: &[LaunchComponent]) -> String {
        let one = |component: &LaunchComponent| {
            let Source::Command(words) = &component.source else { return component.name.clone() };
            let (name, settings) = (&component.name, &component.settings);
            format!("{name}: {} {:?} {}\n", words.join(" "), settings.cpu, component.place)
        };
        components.iter().map(one).collect()
    }

    fn problems(text: &str) -> String {
        let found = LaunchDocument::parse("launch.yaml", text).check(Some(&names())).1;
        let one = |problem: &scl_topology::diagnostic::Diagnostic| {
            let helps = problem.shown_helps().map(|help| format!("  {}\n", help.text()));
            let notes = problem.notes.iter().map(|note| format!("  ({note})\n"));
            format!("{}\n{}", problem.message, helps.chain(notes).collect::<String>())
        };
        found.iter().map(one).collect()
    }

    #[test]
    fn an_entry_of_a_component_changes_that_of_its_kind() {
        // The order is that of the entries, wherever the changes stand.
        let text = "\
components:
  right_motor: {cpu: 2}
  motor: {command: ./motor, cpu: 1}
  controller: {command: ./controller}
profiles:
  simulation:
    left_motor: {cpu: 3}
    motor: {command: ./simulated}
  idle:
    motor: {cpu: 0}
";
        let file = file(text);
        expect![[r#"
            left_motor: ./motor Some([1]) launch.yaml:3:3
            right_motor: ./motor Some([2]) launch.yaml:3:3
            controller: ./controller None launch.yaml:4:3
        "#]]
        .assert_eq(&shown(&file.components));
        let with = |profile: &str| shown(&file.components_with(&[profile.to_owned()]).expect("a profile"));
        expect![[r#"
            left_motor: ./simulated Some([3]) launch.yaml:8:5
            right_motor: ./simulated Some([2]) launch.yaml:8:5
            controller: ./controller None launch.yaml:4:3
        "#]]
        .assert_eq(&with("simulation"));
        expect![[r#"
            left_motor: ./motor Some([0]) launch.yaml:3:3
            right_motor: ./motor Some([0]) launch.yaml:3:3
            controller: ./controller None launch.yaml:4:3
        "#]]
        .assert_eq(&with("idle"));
    }

    #[test]
    fn a_kind_may_have_an_entry_in_a_profile_alone() {
        let text = "components: {controller: {command: ./c}}\nprofiles: {all: {motor: {command: ./m}}}\n";
        let all = file(text).components_with(&["all".to_owned()]).expect("a profile");
        expect![[r#"
            controller: ./c None launch.yaml:1:14
            left_motor: ./m None launch.yaml:2:18
            right_motor: ./m None launch.yaml:2:18
        "#]]
        .assert_eq(&shown(&all));
    }

    #[test]
    fn mistakes_with_kinds_are_told() {
        let all = [
            "components: {moter: {command: ./m}}",
            "components: {motor: {cpu: 1}}",
            "components: {motor: {command: ./m, input: terminal}}",
            "components: {motor: {command: ./m, input: terminal}, right_motor: {input: empty}}",
            "components: {controller: {command: ./c, opens: [motor]}}",
            "components: {controller: {command: ./c}}\nprofiles: {all: {motor: {cpu: 1}}}",
            "components: {motor: {command: ./m}}\nhosts:\n  a: {address: 192.0.2.1, components: [motor]}\n  \
             b: {address: 192.0.2.2, components: [controller]}\ngateway: {port: 7447, certificates: ./keys}",
        ];
        let told = all.map(|text| format!("# {text}\n{}", problems(text))).concat();
        expect![[r#"
            # components: {moter: {command: ./m}}
            unknown component `moter`
              did you mean `motor`?
              (the topology has the components `left_motor`, `controller`, `right_motor`)
              (and the kinds `motor`)
            # components: {motor: {cpu: 1}}
            kind `motor` has no usable `command`
              (a command is a text, or a list of the program and its arguments)
            # components: {motor: {command: ./m, input: terminal}}
            2 components of the kind `motor` have `input: terminal`
              remove it, or write it in an entry of one of them
              (they are `left_motor`, `right_motor`)
              (only one component can read from the terminal)
            # components: {motor: {command: ./m, input: terminal}, right_motor: {input: empty}}
            # components: {controller: {command: ./c, opens: [motor]}}
            `motor` is a kind; components are listed here
              did you mean `left_motor, right_motor`?
            # components: {controller: {command: ./c}}
            profiles: {all: {motor: {cpu: 1}}}
            `motor` needs a `command` or a `replay` in profile `all`
              (`components` has no entry `motor`)
            # components: {motor: {command: ./m}}
            hosts:
              a: {address: 192.0.2.1, components: [motor]}
              b: {address: 192.0.2.2, components: [controller]}
            gateway: {port: 7447, certificates: ./keys}
            `motor` is a kind; components are listed here
              did you mean `left_motor, right_motor`?
        "#]]
        .assert_eq(&told);
    }
}
