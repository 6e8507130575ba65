//! Projects as they are created, without building them; `crates/scl-cli/tests/new.rs` does that.

use crate::read;
use scl_loader::{Request, load};
use scl_new::{Project, Source, Template, create};
use std::path::Path;

fn project(name: &str, template: Template) -> (tempfile::TempDir, String) {
    let parent = tempfile::tempdir().unwrap();
    create(parent.path(), &Project { name: name.to_owned(), template, scl: Source::OfThisProgram }).unwrap();
    let folder = parent.path().join(name).to_str().unwrap().to_owned();
    (parent, folder)
}

#[test]
fn every_name_makes_a_sound_topology() {
    // The longest name, names that code spells in another way, keywords of YAML and protobuf, and the template's own.
    let longest = "a_name_of_forty_characters_in_a_template";
    for name in [longest, "My-Rover", "_x", "rover", "roverrover", "message", "google", "rep", "a"] {
        for template in Template::ALL {
            let (_parent, folder) = project(name, template);
            let loaded = load(&Request::new(format!("{folder}/topology.yaml")));
            assert!(loaded.topology.is_some(), "{name}: {:?}", loaded.diagnostics);
            assert!(loaded.diagnostics.is_empty(), "{name}: {:?}", loaded.diagnostics);
            let manifest = std::fs::read_to_string(format!("{folder}/Cargo.toml")).unwrap();
            assert!(manifest.contains(&format!("name = \"{name}\"\n")), "{manifest}");
            let readme = std::fs::read_to_string(format!("{folder}/README.md")).unwrap();
            assert!(readme.starts_with(&format!("# {name}\n")), "{readme}");
        }
    }
}

/// The program under test lies in its source folder, so that is where the project finds SCL.
#[test]
fn scl_is_found_where_it_was_built() {
    let (_parent, folder) = project("rover", Template::Control);
    let manifest = std::fs::read_to_string(format!("{folder}/Cargo.toml")).unwrap();
    let scl = crate::repository().join("scl");
    assert!(manifest.contains(&format!("package = \"scl-gates\", path = {scl:?} }}\n")), "{manifest}");
    assert!(!manifest.contains("[workspace]"));
    let workflow = std::fs::read_to_string(format!("{folder}/.github/workflows/ci.yml")).unwrap();
    assert!(
        workflow.contains("cargo install --path '") && workflow.contains("check SCL out at that path"),
        "{workflow}"
    );
    assert!(Path::new(&folder).join("Cargo.lock").is_file());
}

#[test]
fn a_project_inside_a_workspace_is_not_its_member() {
    let parent = tempfile::tempdir().unwrap();
    std::fs::write(parent.path().join("Cargo.toml"), "[workspace]\nmembers = []\n").unwrap();
    create(
        parent.path(),
        &Project { name: "rover".to_owned(), template: Template::Minimal, scl: Source::OfThisProgram },
    )
    .unwrap();
    let manifest = std::fs::read_to_string(parent.path().join("rover/Cargo.toml")).unwrap();
    assert!(manifest.ends_with("\n[workspace]\n"), "{manifest}");
}

/// The template `control` is the quick start with a display in place of the actuator and the user interface.
#[test]
fn the_template_and_the_quick_start_agree() {
    let (template, quickstart) = ("crates/scl-new/templates/control", "examples/quickstart");
    assert_eq!(read(&format!("{template}/rover.proto")), read(&format!("{quickstart}/rover.proto")));
    let main_of_sensor = |folder: &str| {
        let text = read(&format!("{folder}/src/bin/sensor.rs"));
        text[text.find("#[scl::main]").unwrap()..].replace("rover::", "")
    };
    assert_eq!(main_of_sensor(template), main_of_sensor(quickstart));
}

/// The template `drive` is the example of the same name.
#[test]
fn the_template_and_the_example_of_larger_systems_agree() {
    let example =
        read("examples/drive/topology.yaml").replace("drive.", "rover.").replace("system: drive", "system: rover");
    assert_eq!(read("crates/scl-new/templates/drive/topology.yaml"), example);
}

#[test]
fn versions_in_the_templates_are_those_of_the_workspace() {
    let workspace = read("Cargo.toml");
    let version = |key: &str| {
        let line = workspace.lines().find(|line| line.starts_with(&format!("{key} = "))).unwrap();
        line.split('"').nth(1).unwrap().to_owned()
    };
    for template in ["minimal", "control", "drive"] {
        let manifest = read(&format!("crates/scl-new/templates/{template}/Cargo.toml.template"));
        assert!(manifest.contains(&format!("package = \"scl-gates\", version = \"{}\"", version("version"))));
        assert!(manifest.contains(&format!("\nrust-version = \"{}\"\n", version("rust-version"))));
        assert!(manifest.contains(&format!("\nedition = \"{}\"\n", version("edition"))));
        let workflow = read(&format!("crates/scl-new/templates/{template}/.github/workflows/ci.yml"));
        assert!(workflow.contains(&format!("cargo install scl-cli --version {} ", version("version"))));
    }
}
