//! SCL1906: words of a choice that cannot become an enum.

use crate::check::named::with_first;
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::grammar::parameter::ONE_OF;
use crate::model::{ComponentModel, Model, ParameterModel, WrittenValue};
use crate::rust_name::{component_type, is_unescapable};
use crate::senders::enum_name;
use crate::source::Span;
use crate::spelling::is_well_formed;
use crate::topology::{GateKind, choice_name, parameters_name};
use std::collections::HashMap;

/// SCL1906.
pub(crate) const WORDS: Rule = Rule {
    code: "SCL1906",
    severity: Severity::Error,
    title: "words of a parameter cannot become an enum",
    explanation: "A parameter that is `one_of` several words becomes an enum in programs: of `mode` of the component \
                  `controller`, the enum `ControllerMode`. Its words consist of letters, digits, `_` and `-`, start \
                  with a letter, and differ in more than case and hyphens. No other type may have the name of the \
                  enum, and none the name of the struct with the parameters, `ControllerParameters`.",
    example: " components:
   - name: controller
     parameters:
-      - mode: {one_of: [manual, Manual]}
+      - mode: {one_of: [manual, auto]}
     gates: []
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    let mut types: Option<HashMap<String, (Span, String)>> = None;
    for owner in model.owners().filter(|owner| !owner.parameters.is_empty()) {
        let types = types.get_or_insert_with(|| other_types(model));
        let name = &owner.name;
        take(types, parameters_name(&name.value), name.span, &format!("the parameters of `{}`", name.value), problems);
        for parameter in owner.parameters.iter().filter(|parameter| parameter.kind.value == ONE_OF) {
            check_words(parameter, problems);
            let what = format!("the words of `{}.{}`", name.value, parameter.name.value);
            take(types, choice_name(&name.value, &parameter.name.value), parameter.name.span, &what, problems);
        }
    }
}

/// The types that programs have of components and gates, with their places and what they are.
fn other_types(model: &Model) -> HashMap<String, (Span, String)> {
    let mut types = HashMap::new();
    for owner in model.owners() {
        let (name, rust) = (&owner.name, component_type(&owner.name.value));
        let mut add = |end: &str, what: String| types.insert(format!("{rust}{end}"), (name.span, what));
        add("", format!("`{}`", name.value));
        add("Peer", format!("the counterpart of `{}` in tests", name.value));
        if model.kinds.iter().any(|kind| std::ptr::eq(kind, owner)) {
            add("Instance", format!("the components of the kind `{}`", name.value));
        }
        senders(owner, &mut types);
    }
    types
}

/// A gate may get an enum of its senders, if it has several.
fn senders(owner: &ComponentModel, types: &mut HashMap<String, (Span, String)>) {
    for gate in owner.gates.iter().filter(|gate| GateKind::of(&gate.kind.value) == Some(GateKind::Sub)) {
        let what = format!("the senders of `{}.{}`", owner.name.value, gate.name.value);
        types.insert(enum_name(&owner.name.value, &gate.name.value), (gate.name.span, what));
    }
}

/// Gives a type its name, unless another one has it.
fn take(types: &mut HashMap<String, (Span, String)>, rust: String, at: Span, what: &str, problems: &mut Diagnostics) {
    if let Some((other, which)) = types.get(&rust) {
        let headline = format!("{what} would become the type `{rust}`, like {which}");
        let found = WORDS.at(headline, at, format!("becomes `{rust}`")).label(*other, format!("becomes `{rust}`, too"));
        problems.push(found.help("give one of them another name"));
        return;
    }
    types.insert(rust, (at, what.to_owned()));
}

fn check_words(parameter: &ParameterModel, problems: &mut Diagnostics) {
    let Some(WrittenValue::Many(words, _)) = &parameter.value else { return };
    for word in words {
        let variant = component_type(&word.value);
        let is_spelt = is_well_formed(&word.value) && word.value.starts_with(char::is_alphabetic);
        if !is_spelt || is_unescapable(&variant) {
            let headline = format!("`{}` cannot be a word of parameter `{}`", word.value, parameter.name.value);
            let found = WORDS.at(headline, word.span, "");
            problems.push(match is_spelt {
                true => found.help(format!("`{variant}` is a keyword of Rust: choose another word")),
                false => found.help("a word consists of letters, digits, `_` and `-`, and starts with a letter"),
            });
        }
    }
    let repeated = with_first(words.iter(), component_type).filter(|(first, word)| !std::ptr::eq(*first, *word));
    for (first, word) in repeated {
        let (variant, name) = (component_type(&word.value), &parameter.name.value);
        let (headline, help) = match first.value == word.value {
            true => (format!("parameter `{name}` lists `{}` twice", word.value), "remove one of them"),
            false => (format!("two words of parameter `{name}` would become `{variant}`"), "rename one of them"),
        };
        let found = WORDS.at(headline, word.span, "the second one").label(first.span, "the first one");
        problems.push(found.help(help));
    }
}
