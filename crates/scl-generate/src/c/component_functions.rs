//! The functions of a component: opening, waiting for peers, closing.

use super::function::Function;
use super::gate::{member, refuse_null};
use super::literal::literal;
use super::prefix;
use crate::system::{Component, System};

/// The functions of a component. A counterpart is opened together with its component.
pub(super) fn component_functions(system: &System, component: &Component) -> Vec<Function> {
    let function = |call, parameter| function(&prefix(system, component), call, parameter);
    let is_opened = component.counterpart_of.is_none();
    let open = is_opened.then(|| Function {
        doc: "Opens the component; `options_json` may be NULL, see scl_open.",
        body: open_body(component),
        ..function("open", "const char *options_json".to_owned())
    });
    let test = component.counterpart.as_ref().map(|peer| Function {
        doc: "Opens the component for a unit test, with the other ends of its gates, see scl_open_test.",
        body: test_body(component),
        ..function("test", format!("{} *peer", prefix(system, peer)))
    });
    let ready = Function {
        doc: "Waits until all required peers are connected, see scl_ready.",
        body: vec!["return scl_ready(self == NULL ? NULL : self->component, timeout_ns);".to_owned()],
        ..function("ready", "int64_t timeout_ns".to_owned())
    };
    let close = Function {
        doc: "Hands over what was sent, and closes the component, see scl_close.",
        body: close_body(),
        ..function("close", "int64_t timeout_ns".to_owned())
    };
    open.into_iter().chain(test).chain([ready, close]).collect()
}

fn function(prefix: &str, call: &str, parameter: String) -> Function {
    Function {
        doc: "",
        result: "scl_status",
        name: format!("{prefix}_{call}"),
        parameters: vec![format!("{prefix} *self"), parameter],
        body: Vec::new(),
    }
}

fn open_body(component: &Component) -> Vec<String> {
    let name = literal(&component.name);
    let mut body = refuse_null("self");
    body.push("memset(self, 0, sizeof *self);".to_owned());
    body.push(format!("scl_status status = open_component({name}, options_json, &self->component);"));
    body.extend(find_gates(component, &["self"]));
    body.push("return status;".to_owned());
    body
}

fn test_body(component: &Component) -> Vec<String> {
    let name = literal(&component.name);
    let mut body = [refuse_null("self"), refuse_null("peer")].concat();
    body.extend(["self", "peer"].map(|it| format!("memset({it}, 0, sizeof *{it});")));
    body.push(format!("scl_status status = open_test({name}, &self->component, &peer->component);"));
    body.extend(find_gates(component, &["self", "peer"]));
    body.push("return status;".to_owned());
    body
}

/// Stores the handles of the gates in these structs, if they were opened.
fn find_gates(component: &Component, structs: &[&str]) -> Vec<String> {
    if component.gates.is_empty() {
        return Vec::new();
    }
    let mut body = vec!["if (status == SCL_OK) {".to_owned()];
    for of in structs {
        body.extend(component.gates.iter().map(|gate| {
            let (member, name) = (member(gate), literal(&gate.name));
            format!("    {of}->gates.{member} = scl_gate_by_name({of}->component, {name});")
        }));
    }
    body.push("}".to_owned());
    body
}

/// The handles end with the component; cleared, they cannot be used by mistake.
fn close_body() -> Vec<String> {
    let close = [
        "scl_status status = scl_close(self->component, timeout_ns);",
        "if (status != SCL_FORKED) {",
        "    memset(self, 0, sizeof *self);",
        "}",
        "return status;",
    ];
    refuse_null("self").into_iter().chain(close.map(str::to_owned)).collect()
}
