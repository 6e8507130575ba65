//! What rust-analyzer gets: the same structs with the same gates, and no name of ours.

use super::{LISTING_1, errors, expand, expand_for_editor, parsed};
use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;

const TYPED: &str = "\
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement, queue: 8}
      - commands: {rep: crate.Command -> Status}
  - name: controller
    gates:
      - sensor: sub
      - commands: req
connections:
  - [sensor.measurements, controller.sensor]
  - [sensor.commands, controller.commands]
";

/// Structs with their documentation and fields; types are compared where the compiler looks none up.
fn described(tokens: &TokenStream) -> Vec<String> {
    let file = parsed(tokens);
    let structs = file.items.into_iter().filter_map(|item| match item {
        syn::Item::Struct(item) if !item.ident.to_string().starts_with("__scl_") => Some(item),
        _ => None,
    });
    let field = |field: &syn::Field| {
        let doc: String = field.attrs.iter().map(|it| it.to_token_stream().to_string()).collect();
        format!("\n  {doc}\n  {}", field.ident.as_ref().unwrap())
    };
    let gates = |item: &syn::ItemStruct| -> String {
        item.fields.iter().filter(|it| it.ident.as_ref().is_some_and(|it| it != "__scl")).map(field).collect()
    };
    let attributes =
        |item: &syn::ItemStruct| -> String { item.attrs.iter().map(|it| it.to_token_stream().to_string()).collect() };
    structs.map(|item| format!("{}\n{}{}", item.ident, attributes(&item), gates(&item))).collect()
}

fn internal_names(tokens: TokenStream) -> Vec<String> {
    let mut names = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Group(group) => names.extend(internal_names(group.stream())),
            TokenTree::Ident(ident) if ident.to_string().starts_with("__") => names.push(ident.to_string()),
            _ => {}
        }
    }
    names
}

#[test]
fn an_editor_gets_the_structs_of_the_compiler() {
    for yaml in [LISTING_1, TYPED] {
        let shown = expand_for_editor(&[("t.yaml", yaml)], "");
        assert_eq!(described(&shown), described(&expand(yaml)));
        assert_eq!(internal_names(shown), [""; 0]);
    }
}

#[test]
fn an_editor_gets_the_types_as_they_are_written() {
    let shown = expand_for_editor(&[("t.yaml", TYPED)], "").to_string();
    assert!(shown.contains("pub measurements : scl :: private :: Pub < rover :: Measurement >"), "{shown}");
    assert!(shown.contains("pub commands : scl :: private :: Rep < crate :: Command , Status >"), "{shown}");
}

#[test]
fn a_broken_file_keeps_its_gates_with_kind_type_and_peers() {
    let broken = TYPED.replace("controller.sensor]", "controller.sensr]").replace("{rep: crate", "{repp: crate");
    let shown = expand_for_editor(&[("t.yaml", &broken)], "");
    assert!(errors(&shown) > 0, "{shown}");
    let text = described(&shown).join("\n");
    for part in [
        "`pub`: publishes `rover.Measurement` to `controller.sensr`.",
        "Options: `queue: 8`.",
        "`req`: requests `crate.Command` -> `Status` from `sensor.commands`.",
        "`repp`: `crate.Command` -> `Status`; connected to `controller.commands`.",
        "Declared at `t.yaml:4:9`.",
        "| `sensor` | `sub` | `bytes` | no peer |",
    ] {
        assert!(text.contains(part), "{part}:\n{text}");
    }
    assert_eq!(internal_names(shown), [""; 0]);
}

#[test]
fn no_prefix_of_a_file_shows_an_internal_name() {
    for end in (0..TYPED.len()).step_by(3) {
        let shown = expand_for_editor(&[("t.yaml", &TYPED[..end])], "");
        parsed(&shown);
        assert_eq!(internal_names(shown), [""; 0]);
    }
}
