//! Expansions of whole invocations.

mod editor;
mod mutations;
#[cfg(feature = "protobuf")]
mod schema_names;
#[cfg(feature = "protobuf")]
mod schemas;
mod spec;

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

/// Expands `topology!("t.yaml")` with more arguments, invoked in a folder with these files.
fn expand_with(files: &[(&str, &str)], more: &str) -> TokenStream {
    expand_in(files, more, |_| {})
}

/// The same as rust-analyzer gets it.
fn expand_for_editor(files: &[(&str, &str)], more: &str) -> TokenStream {
    expand_in(files, more, |surroundings| {
        surroundings.source_file = None;
        surroundings.extern_crates = None;
        surroundings.for_editor = true;
    })
}

fn expand_in(files: &[(&str, &str)], more: &str, change: fn(&mut Surroundings)) -> TokenStream {
    let folder = folder(files);
    let mut surroundings = Surroundings {
        source_file: Some("main.rs".into()),
        package: Some(folder.path().into()),
        workspace: None,
        working_dir: folder.path().into(),
        extern_crates: Some(["scl", "camera_msgs"].map(str::to_owned).into()),
        for_editor: false,
    };
    change(&mut surroundings);
    expand_topology(format!("scl, \"t.yaml\" {more}").parse().unwrap(), &surroundings)
}

fn expand(yaml: &str) -> TokenStream {
    expand_with(&[("t.yaml", yaml)], "")
}

#[track_caller]
fn parsed(tokens: &TokenStream) -> syn::File {
    syn::parse2(tokens.clone()).unwrap_or_else(|error| panic!("{error}:\n{tokens}"))
}

/// The names of the structs with their gates, without the counterparts.
fn structs(file: &syn::File) -> Vec<String> {
    structs_if(file, |item| !is_for_tests(item))
}

fn is_for_tests(item: &syn::ItemStruct) -> bool {
    item.attrs.iter().any(|attribute| attribute.path().is_ident("cfg"))
}

fn structs_if(file: &syn::File, wanted: fn(&syn::ItemStruct) -> bool) -> Vec<String> {
    let structs = file.items.iter().filter_map(|item| match item {
        syn::Item::Struct(item) if wanted(item) && !item.ident.to_string().starts_with("__scl_") => Some(item),
        _ => None,
    });
    let described = structs.map(|item| {
        let mut fields: Vec<String> =
            item.fields.iter().filter_map(|field| Some(field.ident.as_ref()?.to_string())).collect();
        // Fields are dropped in order, and a gate must not outlive what the last one refers to.
        assert_eq!(fields.pop().as_deref(), Some("__scl"), "{}", item.ident);
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
    assert!(!tokens.to_string().contains("deprecated"), "lints are not shown: {tokens}");
    let expected = [
        "Sensor measurements",
        "Actuator setpoint",
        "Controller sensor actuator events commands",
        "UserInterface events commands",
    ];
    assert_eq!(structs(&parsed(&tokens)), expected);
    let for_tests = structs_if(&parsed(&tokens), is_for_tests);
    assert_eq!(for_tests[2], "ControllerPeer sensor actuator events commands");
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
        // The field that every struct has anyway.
        ("components:\n  - name: a\n    gates:\n      - __scl: pub\n      - x: pub\n", 1, "A x"),
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

#[test]
fn types_that_may_be_aliases_are_compared_by_rustc() {
    let yaml = LISTING_1
        .replace("measurements: pub", "measurements: {pub: nav.Pose}")
        .replace("sensor: sub", "sensor: {sub: log.Pose}");
    let tokens = expand(&yaml);
    parsed(&tokens);
    let text = tokens.to_string();
    assert!(text.contains("Connection :: < < __scl_types_t_yaml as"), "{text}");
    let alone = expand_with(&[("t.yaml", &yaml)], ", only = [sensor]").to_string();
    assert!(!alone.contains("SameTypeAs"), "{alone}");
}

/// Prints the time: `cargo test -p scl-macros many -- --nocapture`.
#[test]
fn many_components_expand() {
    for count in [40, 1_000] {
        let yaml = ring(count);
        let start = std::time::Instant::now();
        let tokens = expand(&yaml);
        println!("{count} components, {} gates: {:?}", 3 * count, start.elapsed());
        assert_eq!(errors(&tokens), 0);
        assert_eq!(structs(&parsed(&tokens)).len(), count);
    }
}

/// A ring of components: each publishes to the one before it, and has an unconnected gate.
fn ring(count: usize) -> String {
    let component = |at: usize| {
        let next = (at + 1) % count;
        let gates = format!(
            "      - out{at}: {{pub: rover.M{at}}}\n      - in{at}: {{sub: rover.M{next}}}\n      - spare{at}: {{pub: rover.S{at}, unconnected: ok}}\n"
        );
        format!("  - name: c{at}\n    gates:\n{gates}")
    };
    let connection = |at: usize| format!("  - [c{0}.out{0}, c{1}.in{1}]\n", (at + 1) % count, at);
    let components: String = (0..count).map(component).collect();
    let connections: String = (0..count).map(connection).collect();
    format!("components:\n{components}connections:\n{connections}")
}
