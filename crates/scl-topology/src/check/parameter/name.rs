//! SCL1904: names of parameters that are taken.

use crate::check::named::with_first;
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::{ComponentModel, Model};
use crate::rust_name::gate_field;

/// SCL1904.
pub(crate) const TAKEN: Rule = Rule {
    code: "SCL1904",
    severity: Severity::Error,
    title: "name of a parameter is taken",
    explanation: "Each parameter of a component becomes a field of one struct, so no two of them have the same name in \
                  a program, where `set-point` and `setPoint` both become `set_point`. Parameters and gates of a \
                  component have different names, too: `controller.gain` names one thing only. A component with \
                  parameters has no gate `parameters`, which is the name of the struct in programs.",
    example: " components:
   - name: controller
     parameters:
       - gain: f64
-      - gain: u8
+      - pin: u8
     gates: []
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    model.owners().filter(|owner| !owner.parameters.is_empty()).for_each(|owner| check_owner(owner, problems));
}

fn check_owner(owner: &ComponentModel, problems: &mut Diagnostics) {
    let of = &owner.name.value;
    let names = || owner.parameters.iter().map(|parameter| &parameter.name);
    for (first, second) in with_first(names(), gate_field).filter(|(first, name)| !std::ptr::eq(*first, *name)) {
        let headline = match first.value == second.value {
            true => format!("component `{of}` declares parameter `{}` twice", second.value),
            false => {
                let (a, b, field) = (&first.value, &second.value, gate_field(&second.value));
                format!("parameters `{a}` and `{b}` of `{of}` would both become the field `{field}`")
            }
        };
        let found = TAKEN.at(headline, second.span, "second declaration").label(first.span, "first declaration");
        problems.push(found.help("give one of them another name"));
    }
    for gate in &owner.gates {
        let field = gate_field(&gate.name.value);
        if field == crate::grammar::parameter::PARAMETERS {
            let headline =
                format!("gate `{}` of `{of}` has the name of the field with its parameters", gate.name.value);
            problems.push(TAKEN.at(headline, gate.name.span, "").help("give the gate another name"));
        }
        if let Some(parameter) = names().find(|name| gate_field(&name.value) == field) {
            let headline = format!("a gate and a parameter of `{of}` are called `{}`", parameter.value);
            let found = TAKEN.at(headline, parameter.span, "the parameter").label(gate.name.span, "the gate");
            problems.push(found.help("give one of them another name"));
        }
    }
}
