//! The functions of a component: opening, waiting for peers, closing.

use super::function::Function;
use super::gate::{member, refuse_null};
use super::literal::literal;
use super::prefix;
use crate::system::{Component, System};

/// The functions of a component. A counterpart is opened together with its component.
pub(super) fn component_functions(system: &System, component: &Component) -> Vec<Function> {
    let own = prefix(system, component);
    let function =
        |call, doc, parameter: &str, body| Function::new(&own, call, doc, format!("{own} *self, {parameter}"), body);
    let open = component.counterpart_of.is_none().then(|| {
        let doc = "Opens the component; `options_json` may be NULL, see scl_open.";
        function("open", doc, "const char *options_json", open_body(component))
    });
    let test = component.counterpart.as_ref().map(|peer| {
        let doc = "Opens the component for a unit test, with the other ends of its gates, see scl_open_test.";
        function("test", doc, &format!("{} *peer", prefix(system, peer)), test_body(component))
    });
    let ready = function(
        "ready",
        "Waits until all required peers are connected, see scl_ready.",
        "int64_t timeout_ns",
        "return scl_ready(self == NULL ? NULL : self->component, timeout_ns);".to_owned(),
    );
    let doc = "Waits until running peers have taken all messages, then closes the component, see scl_close.";
    let close = function("close", doc, "int64_t timeout_ns", close_body());
    open.into_iter().chain(test).chain([ready, close]).collect()
}

fn open_body(component: &Component) -> String {
    let (refuse, name, find) = (refuse_null("self"), literal(&component.name), find_gates(component, &["self"]));
    format!(
        "{refuse}\n\
         memset(self, 0, sizeof *self);\n\
         scl_status status = open_component({name}, options_json, &self->component);\n\
         {find}return status;"
    )
}

fn test_body(component: &Component) -> String {
    let [refuse_self, refuse_peer] = ["self", "peer"].map(refuse_null);
    let (name, find) = (literal(&component.name), find_gates(component, &["self", "peer"]));
    format!(
        "{refuse_self}\n{refuse_peer}\n\
         memset(self, 0, sizeof *self);\n\
         memset(peer, 0, sizeof *peer);\n\
         scl_status status = open_test({name}, &self->component, &peer->component);\n\
         {find}return status;"
    )
}

/// Lines that store the handles of the gates in these structs if the component was opened.
fn find_gates(component: &Component, structs: &[&str]) -> String {
    if component.gates.is_empty() {
        return String::new();
    }
    let find = structs.iter().flat_map(|of| {
        component.gates.iter().map(move |gate| {
            let (member, name) = (member(gate), literal(&gate.name));
            format!("    {of}->gates.{member} = scl_gate_by_name({of}->component, {name});\n")
        })
    });
    format!("if (status == SCL_OK) {{\n{}}}\n", find.collect::<String>())
}

/// The body of the function that closes the component. The handles become invalid with it; clearing them prevents their
/// accidental use.
fn close_body() -> String {
    let refuse = refuse_null("self");
    format!(
        "{refuse}\n\
         scl_status status = scl_close(self->component, timeout_ns);\n\
         if (status != SCL_FORKED) {{\n    memset(self, 0, sizeof *self);\n}}\n\
         return status;"
    )
}
