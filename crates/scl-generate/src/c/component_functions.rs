//! The functions of a component: opening, waiting for peers, closing.

use super::enumeration::{names_of_kind, of_kind};
use super::function::Function;
use super::gate::{member, refuse_null};
use super::literal::literal;
use super::{parameters, prefix};
use crate::system::{Component, System};

/// The functions of a component. A counterpart is opened together with its component.
pub(super) fn component_functions(system: &System, component: &Component) -> Vec<Function> {
    let own = prefix(system, component);
    let function =
        |call, doc, parameter: &str, body| Function::new(&own, call, doc, format!("{own} *self, {parameter}"), body);
    let enumeration = of_kind(system, component);
    let open = component.counterpart_of.is_none().then(|| {
        let doc = match enumeration {
            None => "Opens the component; `options_json` may be NULL, see scl_open.",
            Some(_) => {
                "Opens the component of the kind that SCL_COMPONENT names; `options_json` may be NULL, see scl_open."
            }
        };
        function("open", doc, "const char *options_json", open_body(&own, component, enumeration.as_deref()))
    });
    let open_as = enumeration.as_ref().map(|enumeration| {
        let doc = "Opens this component of the kind; `options_json` may be NULL, see scl_open.";
        let parameters = format!("{enumeration} instance, const char *options_json");
        function("open_as", doc, &parameters, open_as_body(&own, component, enumeration))
    });
    let test = component.counterpart.as_ref().map(|peer| {
        let doc = "Opens the component for a unit test, with the other ends of its gates, see scl_open_test.";
        function("test", doc, &format!("{} *peer", prefix(system, peer)), test_body(&own, component))
    });
    let with_parameters = component.counterpart.as_ref().filter(|_| !component.parameters.is_empty());
    let test_with = with_parameters.map(|peer| {
        let doc = "The same with values of parameters; `options_json` may be NULL, see scl_open_test_with.";
        let parameters = format!("{} *peer, const char *options_json", prefix(system, peer));
        function("test_with", doc, &parameters, test_with_body(&own, component))
    });
    let update = component.has_live_parameters().then(|| {
        let doc = "Takes over the live parameters that have changed, see scl_update_parameters.";
        function("update_parameters", doc, "int64_t timeout_ns, bool *changed", parameters::update_body(&own))
    });
    let ready = function(
        "ready",
        "Waits until all required peers are connected, see scl_ready.",
        "int64_t timeout_ns",
        "return scl_ready(self == NULL ? NULL : self->component, timeout_ns);".to_owned(),
    );
    let doc = "Waits until running peers have taken all messages, then closes the component, see scl_close.";
    let close = function("close", doc, "int64_t timeout_ns", close_body());
    open.into_iter().chain(open_as).chain(test).chain(test_with).chain(update).chain([ready, close]).collect()
}

fn open_body(own: &str, component: &Component, enumeration: Option<&str>) -> String {
    let (refuse, name) = (refuse_null("self"), literal(&component.name));
    let find_instance = enumeration.map_or(String::new(), |enumeration| {
        let names = names_of_kind(enumeration);
        format!(
            "    const char *name = scl_component_name(self->component);\n    \
                 size_t count = sizeof {names} / sizeof *{names};\n    \
                 self->instance = ({enumeration})find_name(name, {names}, count);\n"
        )
    });
    let once_open = once_open(own, component, find_instance + &find_gates(component, &["self"]), &["self"]);
    format!(
        "{refuse}\n\
         memset(self, 0, sizeof *self);\n\
         scl_status status = open_component({name}, options_json, &self->component);\n\
         {once_open}return status;"
    )
}

fn open_as_body(own: &str, component: &Component, enumeration: &str) -> String {
    let (refuse, names) = (refuse_null("self"), names_of_kind(enumeration));
    let once_open = once_open(own, component, find_gates(component, &["self"]), &["self"]);
    format!(
        "{refuse}\n\
         memset(self, 0, sizeof *self);\n\
         if ((size_t)instance >= sizeof {names} / sizeof *{names}) {{\n    \
             return scl_fail(SCL_ARGUMENT, \"`instance` is not one of the kind\");\n\
         }}\n\
         self->instance = instance;\n\
         scl_status status = open_component({names}[instance], options_json, &self->component);\n\
         {once_open}return status;"
    )
}

fn test_body(own: &str, component: &Component) -> String {
    match component.parameters.is_empty() {
        true => test_lines(own, component, &format!("open_test({}, ", literal(&component.name))),
        false => format!("return {own}_test_with(self, peer, NULL);"),
    }
}

fn test_with_body(own: &str, component: &Component) -> String {
    test_lines(own, component, &format!("open_test_with({}, options_json, ", literal(&component.name)))
}

/// The body of a function that opens both ends; `open` is the begin of the call.
fn test_lines(own: &str, component: &Component, open: &str) -> String {
    let [refuse_self, refuse_peer] = ["self", "peer"].map(refuse_null);
    let structs = ["self", "peer"];
    let once_open = once_open(own, component, find_gates(component, &structs), &structs);
    format!(
        "{refuse_self}\n{refuse_peer}\n\
         memset(self, 0, sizeof *self);\n\
         memset(peer, 0, sizeof *peer);\n\
         scl_status status = {open}&self->component, &peer->component);\n\
         {once_open}return status;"
    )
}

/// Lines that are run if the component was opened. Reading its parameters fails only if the library is another one than
/// `scl.h` is of; then these structs are closed again.
fn once_open(own: &str, component: &Component, lines: String, structs: &[&str]) -> String {
    let read = parameters::once_open(own, component);
    let close = structs
        .iter()
        .map(|of| format!("        scl_close({of}->component, 0);\n        memset({of}, 0, sizeof *{of});\n"));
    let close = match read.is_empty() {
        true => String::new(),
        false => format!("    if (status != SCL_OK) {{\n{}    }}\n", close.collect::<String>()),
    };
    let lines = lines + &read + &close;
    if lines.is_empty() { lines } else { format!("if (status == SCL_OK) {{\n{lines}}}\n") }
}

/// Lines that store the handles of the gates in these structs.
fn find_gates(component: &Component, structs: &[&str]) -> String {
    let find = structs.iter().flat_map(|of| {
        component.gates.iter().map(move |gate| {
            let (member, name) = (member(gate), literal(&gate.name));
            format!("    {of}->gates.{member} = scl_gate_by_name({of}->component, {name});\n")
        })
    });
    find.collect()
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
