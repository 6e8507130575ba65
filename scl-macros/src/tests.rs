//! What whole calls expand to.

use crate::expand::expand_topology;
use crate::locate::Surroundings;
use proc_macro2::TokenStream;
use std::fs;
use tempfile::TempDir;

/// A fresh folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Expands `topology!("t.yaml")` with more arguments, called in a folder with these files.
fn expand_with(files: &[(&str, &str)], more: &str) -> TokenStream {
    let folder = folder(files);
    let surroundings = Surroundings {
        source_file: Some("main.rs".into()),
        package: Some(folder.path().into()),
        workspace: None,
        working: folder.path().into(),
    };
    expand_topology(format!("scl, \"t.yaml\" {more}").parse().unwrap(), &surroundings)
}

fn expand(yaml: &str) -> TokenStream {
    expand_with(&[("t.yaml", yaml)], "")
}

#[track_caller]
fn parsed(tokens: &TokenStream) -> syn::File {
    syn::parse2(tokens.clone()).unwrap_or_else(|error| panic!("{error}:\n{tokens}"))
}

/// The names of the structs, each with its fields.
fn structs(file: &syn::File) -> Vec<String> {
    let structs = file.items.iter().filter_map(|item| match item {
        syn::Item::Struct(item) => Some(item),
        _ => None,
    });
    let described = structs.map(|item| {
        let fields: Vec<String> =
            item.fields.iter().filter_map(|field| Some(field.ident.as_ref()?.to_string())).collect();
        format!("{} {}", item.ident, fields.join(" "))
    });
    described.collect()
}

fn errors(tokens: &TokenStream) -> usize {
    tokens.to_string().matches("compile_error").count()
}

const LISTING_1: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: actuator
    gates:
      - setpoint: sub
  - name: controller
    gates:
      - sensor: sub
      - actuator: pub
      - events: pub
      - commands: rep
  - name: user_interface
    gates:
      - events: sub
      - commands: req
connections:
  - [sensor.measurements, controller.sensor]
  - [actuator.setpoint, controller.actuator]
  - [controller.events, user_interface.events]
  - [controller.commands, user_interface.commands]
";

#[test]
fn listing_1_becomes_four_structs() {
    let tokens = expand(LISTING_1);
    assert_eq!(errors(&tokens), 0, "{tokens}");
    let expected = [
        "Sensor measurements",
        "Actuator setpoint",
        "Controller sensor actuator events commands",
        "UserInterface events commands",
    ];
    assert_eq!(structs(&parsed(&tokens)), expected);
}

#[test]
fn only_some_components_are_generated() {
    let tokens = expand_with(&[("t.yaml", LISTING_1)], ", only = [sensor, user_interface]");
    assert_eq!(structs(&parsed(&tokens)), ["Sensor measurements", "UserInterface events commands"]);
    let tokens = expand_with(&[("t.yaml", LISTING_1)], ", only = [sensr]");
    parsed(&tokens);
    assert!(tokens.to_string().contains("did you mean `sensor`?"), "{tokens}");
}

#[test]
fn every_prefix_of_a_file_expands() {
    for end in (0..LISTING_1.len()).step_by(3) {
        let tokens = expand(&LISTING_1[..end]);
        parsed(&tokens);
    }
}

#[test]
fn broken_files_keep_the_structs_that_can_be_read() {
    let cases = [
        ("components: [", 1, ""),
        ("components:\n  - name: a\n    gates:\n      - x: pubb\n", 1, "A x"),
        (
            "components:\n  - name: a\n    gates:\n      - x: pub\n  - name: b\n    gates:\n      - z: sub\nconnections:\n  - [a.x, b.u]\n",
            1,
            "A x/B z",
        ),
        (
            "components:\n  - name: a\n    gates:\n      - type: {req: P -> Q}\nconnections:\n  - [a.type, b.z]\n",
            1,
            "A r#type",
        ),
    ];
    for (yaml, at_least, expected) in cases {
        let tokens = expand(yaml);
        assert!(errors(&tokens) >= at_least, "{tokens}");
        assert_eq!(structs(&parsed(&tokens)).join("/"), expected, "{yaml}");
    }
}

#[test]
fn a_missing_file_is_one_error() {
    let tokens = expand_with(&[("t.yml", "")], "");
    parsed(&tokens);
    assert_eq!(errors(&tokens), 1);
    assert!(tokens.to_string().contains("a file with a similar name exists: `t.yml`"), "{tokens}");
}

#[test]
fn twenty_errors_are_shown_and_the_rest_is_counted() {
    let gates: String = (0..25).map(|at| format!("      - x{at}: pubb\n")).collect();
    let tokens = expand(&format!("components:\n  - name: a\n    gates:\n{gates}"));
    parsed(&tokens);
    assert_eq!(errors(&tokens), 21);
    assert!(tokens.to_string().contains("more problems"), "{tokens}");
}
