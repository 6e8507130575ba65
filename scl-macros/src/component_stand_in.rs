//! The error that rustc reports if the component of `#[scl::main]` does not exist.
//!
//! A type with the component's name is declared outside the block in which the names of the module are in scope. If the
//! module has the component, nothing refers to this type. Otherwise its use is the only error: everything that depends
//! on it has an erroneous type, so rustc reports no more.

use crate::expand::{escape_braces, on_unimplemented};
use crate::known_components::{self, KnownTopology};
use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use scl_text::list::{listed, quoted_list};
use scl_topology::external::UNKNOWN_IN_CODE;
use scl_topology::suggest::similar;
use syn::spanned::Spanned;
use syn::{Ident, Type};

/// Expands the stand-in; nothing for a path of several segments, which may refer to anything.
pub(crate) fn expand_stand_in(component: &Type) -> TokenStream {
    let Type::Path(path) = component else { return TokenStream::new() };
    let Some(name) = path.path.get_ident() else { return TokenStream::new() };
    let topologies = known_components::of_crate();
    if let Some(broken) = topologies.iter().find(|topology| topology.broken) {
        // The component may be declared in the part of the file that could not be read, which has its own error.
        let unknown = Ident::new(&broken.unknown_type, component.span());
        return quote!(#[allow(dead_code)] type #name = #unknown;);
    }
    let (message, notes) = words(&name.to_string(), &topologies);
    let report = on_unimplemented(&escape_braces(&message), "`topology!` generates no such struct", &notes);
    // rustc prints these two names. No component can have them: they are not in camel case.
    let not_found = format_ident!("{name}_not_found", span = component.span());
    let of_topology = format_ident!("topology_component", span = component.span());
    quote_spanned! { component.span() =>
        #[allow(non_camel_case_types, dead_code)]
        struct #not_found;
        #report
        #[allow(non_camel_case_types, dead_code)]
        trait #of_topology { type Type; }
        // Without any implementation, rustc would propose to add one.
        #[diagnostic::do_not_recommend]
        impl #of_topology for () { type Type = (); }
        #[allow(dead_code)]
        type #name = <#not_found as #of_topology>::Type;
        // Lets calls on the erroneous type resolve. The inherent functions of a real component take precedence.
        #[allow(dead_code)]
        trait __SclMain {
            fn __scl_main_async<Main>(_: Main) -> ::std::process::ExitCode { ::core::unreachable!() }
            fn __scl_main_blocking<Main>(_: Main) -> ::std::process::ExitCode { ::core::unreachable!() }
            fn __scl_returned<Any>(_: &Any) -> __SclReturned { __SclReturned }
        }
        #[allow(dead_code)]
        struct __SclReturned;
        #[allow(dead_code)]
        impl __SclReturned {
            fn convert<Any>(&self, _: Any) {}
        }
        impl<Any> __SclMain for Any {}
    }
}

/// A message and its notes.
fn words(name: &str, topologies: &[KnownTopology]) -> (String, Vec<String>) {
    let code = UNKNOWN_IN_CODE.code;
    let all = || topologies.iter().flat_map(|topology| topology.components.iter().map(move |it| (topology, it)));
    if let Some((topology, component)) = all().find(|(_, it)| it.rust_name == name && !it.included) {
        let message = format!(
            "[{code}] the component `{}` is left out by `only = [..]` of `topology!(\"{}\")`",
            component.name, topology.path
        );
        let entry = component.name.replace('-', "_");
        return (message, vec![format!("add `{entry}` to `only`, or leave `only` out")]);
    }
    if let Some((_, kind)) = all().find(|(_, it)| it.instances.iter().any(|instance| instance == name)) {
        let message = format!("[{code}] `{name}` is a component of the kind `{}`, and no struct", kind.name);
        return (message, vec![format!("write `{}`: its `instance()` says which component it is", kind.rust_name)]);
    }
    let message = format!("[{code}] cannot find the component `{name}`");
    let names: Vec<&str> = all().filter(|(_, it)| it.included).map(|(_, it)| it.rust_name.as_str()).collect();
    if names.is_empty() {
        let note = "`scl::topology!` generates one struct per component: `user_interface` becomes `UserInterface`";
        return (message, vec![note.to_owned()]);
    }
    let near = similar(name, names.iter().copied()).first().map(|near| format!("did you mean `{near}`?"));
    let files = quoted_list(topologies.iter().map(|topology| &topology.path));
    let components = format!("components of {files}: {}", listed(names));
    (message, near.into_iter().chain([components]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::known_components::KnownComponent;

    fn topology(components: &[(&str, bool)]) -> KnownTopology {
        let component = |&(name, included): &(&str, bool)| KnownComponent {
            name: name.to_lowercase(),
            rust_name: name.to_owned(),
            included,
            instances: vec![format!("Left{name}")],
        };
        let components = components.iter().map(component).collect();
        KnownTopology { path: "t.yaml".into(), components, broken: false, unknown_type: String::new() }
    }

    #[test]
    fn unknown_components_are_told_with_those_that_exist() {
        let cases: [(&str, &[KnownTopology], &str, &str); 5] = [
            ("Gps", &[], "cannot find the component `Gps`", "`scl::topology!` generates one struct per"),
            (
                "Gsp",
                &[topology(&[("Gps", true), ("Camera", true)])],
                "cannot find",
                "did you mean `Gps`? / components of `t.yaml`: `Gps`, `Camera`",
            ),
            (
                "Gps",
                &[topology(&[("Gps", false), ("Camera", true)])],
                "the component `gps` is left out by `only = [..]`",
                "add `gps` to `only`",
            ),
            (
                "LeftMotor",
                &[topology(&[("Motor", true)])],
                "`LeftMotor` is a component of the kind `motor`, and no struct",
                "write `Motor`",
            ),
            (
                "Radar",
                &[topology(&[("Gps", false), ("Camera", true)])],
                "cannot find",
                "components of `t.yaml`: `Camera`",
            ),
        ];
        for (name, topologies, message, notes) in cases {
            let (found, found_notes) = words(name, topologies);
            assert!(found.contains(message), "{found}");
            assert!(found_notes.join(" / ").starts_with(notes), "{}", found_notes.join(" / "));
        }
    }
}
