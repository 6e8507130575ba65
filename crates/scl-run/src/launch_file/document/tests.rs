//! Which mistakes are found, and where. Their words are tested with the real commands.

use super::super::Source;
use super::LaunchDocument;
use crate::system_names::SystemNames;
use expect_test::expect;

/// Codes and places of all mistakes of a text.
fn mistakes(text: &str) -> String {
    let document = LaunchDocument::parse("launch.yaml", text);
    let components = vec!["sensor".to_owned(), "b".to_owned()];
    let known = SystemNames { components, ..SystemNames::default() };
    let found = document.read(Some(&known)).err().unwrap_or_default();
    let told = found.iter().map(|problem| {
        let place = problem.primary.as_ref().map(|label| document.sources.place(label.span)).unwrap_or_default();
        format!("{} {}", problem.code(), place.trim_start_matches("launch.yaml:"))
    });
    told.collect::<Vec<_>>().join(", ")
}

/// The promise: what the checker knows of YAML, it knows in launch files too.
#[test]
fn mistakes_of_yaml_are_found_as_in_a_topology() {
    let one = |entry: &str| format!("components:\n  sensor:\n{entry}\n");
    let texts = [
        one("\tcommand: ./a"),
        one("    command:./a"),
        one("    command ./a"),
        one("    command: [./a, b"),
        one("    command: [./a b"),
        one("    command: './a"),
        one("    command: ./a\n   restart: never"),
        one("    command: @a"),
        one("    command: ./a\n    command: ./b"),
        one("    command: !text ./a"),
        one("    command: ./a\n---\nx: 1"),
        "# nothing\n".to_owned(),
        format!("components: {}", "[".repeat(20)),
        one("    command：./a"),
        one("<<<<<<< ours\n    command: ./a\n=======\n    command: ./b\n>>>>>>> theirs"),
        one("    command: ./a\n    r\u{435}start: always"),
        one("    command: *none"),
        "components: &all {sensor: *all}\n".to_owned(),
        one("    <<: {command: ./a}"),
        "- components\n".to_owned(),
    ];
    let found: String = texts.iter().map(|text| format!("{}\n", mistakes(text))).collect();
    expect![[r#"
        SCL0101 3:1
        SCL0103 3:12
        SCL0123 3:5
        SCL0102 3:14
        SCL0102 3:14
        SCL0104 3:14
        SCL0105 4:4
        SCL0106 3:14
        SCL0107 4:5
        SCL0113 3:14
        SCL0114 4:1
        SCL0115 1:1
        SCL0102 1:32
        SCL0127 3:12
        SCL0126 3:1
        SCL0304 4:5
        SCL0111 3:14
        SCL0111 1:27
        SCL0112 3:5
        SCL1203 1:1
    "#]]
    .assert_eq(&found);
}

#[test]
fn keys_of_the_users_own_are_ignored_at_the_top_only() {
    assert_eq!(
        mistakes("x-a: &a {<<: {b: c}, d: [1]}\nx-: 1\ncomponents: {b: {command: ./b, environment: {x-c: 1}}}\n"),
        ""
    );
    let text = "x_a: 1\ncomponents: {b: {command: ./b, x-note: b}}\ndefaults: {x-command: c}\n";
    assert_eq!(mistakes(text), "SCL1201 1:1, SCL1201 2:32, SCL1201 3:12");
    let problems = LaunchDocument::parse("launch.yaml", text).read_shown(None).unwrap_err();
    let told = problems.iter().filter(|problem| problem.to_string().contains("belong at the top of the file"));
    assert_eq!(told.count(), 2);
}

#[test]
fn an_alias_stands_for_the_value_of_its_anchor() {
    let text = "x-make: &make [make, -j, 2]
x-entry: &entry {command: ./a, build: *make}
components:
  sensor: *entry
  b: {command: ./b, build: *make}
build: *make
";
    let file = LaunchDocument::parse("launch.yaml", text).read_shown(None).unwrap();
    let make = Some(["make", "-j", "2"].map(str::to_owned).to_vec());
    assert_eq!((file.build, &file.components[0].build, &file.components[1].build), (make.clone(), &make, &make));
    assert_eq!(file.components[0].source, Source::Command(vec!["./a".to_owned()]));
    // A mistake is told once, where it is written.
    assert_eq!(mistakes(&text.replace("2]", "[]]")), "SCL1202 1:15");
}
