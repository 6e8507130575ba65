//! What becomes of good launch files, and that no text at all is too bad. The words are tested with the real command.

use super::keys::{self, Key};
use super::{EXAMPLE, LaunchComponent, LaunchDocument, LaunchFile};
use scl_terminal::Problem;

fn parse_launch_file(text: &str, known: Option<&[String]>) -> Result<LaunchFile, Vec<Problem>> {
    LaunchDocument::parse("launch.yaml", text).map_err(|problem| vec![problem])?.read(known)
}

const GOOD: &str = "\
# A comment: command
transport: ipc
build: make all
environment: {RUST_LOG: info, \"LEVEL\": 2}
components:
  sensor:
    command: [./sensor, --rate, 100, 0.5, true, '1.10']
    build: [make, -j, 2]
  controller:
    command: ./controller 2>> log
    environment:
      GAIN: 0.50
    folder: control
profiles:
  python:
    controller: {command: [python3, controller.py], environment: {GAIN: 2}}
    display: {command: ./display}
  debug:
    controller: {build: make debug, folder: debug, environment: {LOG: all}}
topology: ../topology.yaml
";

fn pairs(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

fn sensor() -> LaunchComponent {
    LaunchComponent {
        name: "sensor".to_owned(),
        build: Some(words(&["make", "-j", "2"])),
        command: words(&["./sensor", "--rate", "100", "0.5", "true", "1.10"]),
        ..LaunchComponent::default()
    }
}

fn controller() -> LaunchComponent {
    LaunchComponent {
        name: "controller".to_owned(),
        build: None,
        command: words(&["/bin/sh", "-c", "./controller 2>> log"]),
        environment: pairs(&[("GAIN", "0.5")]),
        folder: Some("control".to_owned()),
    }
}

#[test]
fn a_good_file_keeps_its_order_and_its_values() {
    let known = words(&["sensor", "controller", "display", "other"]);
    for text in [GOOD.to_owned(), GOOD.replace('\n', "\r\n"), format!("\u{feff}{GOOD}")] {
        let file = parse_launch_file(&text, Some(&known)).unwrap();
        assert_eq!(file.components, [sensor(), controller()]);
        assert_eq!(file.build, Some(words(&["/bin/sh", "-c", "make all"])));
        assert_eq!(file.environment, pairs(&[("RUST_LOG", "info"), ("LEVEL", "2")]));
        assert_eq!(file.transport.as_deref(), Some("ipc"));
    }
}

#[test]
fn the_topology_is_named_with_its_place() {
    let document = LaunchDocument::parse("launch.yaml", GOOD).unwrap();
    assert_eq!(document.topology(), Some(("../topology.yaml", "launch.yaml:20:1".to_owned())));
}

#[test]
fn a_profile_replaces_programs_or_changes_keys_and_later_ones_win() {
    let file = parse_launch_file(GOOD, None).unwrap();
    let command = |line: &[&str]| LaunchComponent { command: words(line), ..controller() };
    let environment = |more: &[(&str, &str)]| [pairs(&[("GAIN", "0.5")]), pairs(more)].concat();
    let display = || LaunchComponent {
        name: "display".to_owned(),
        command: words(&["/bin/sh", "-c", "./display"]),
        ..LaunchComponent::default()
    };
    let python = ["python3", "controller.py"];
    let debug_build = Some(words(&["/bin/sh", "-c", "make debug"]));
    let debug_folder = Some("debug".to_owned());
    let cases: [(&[&str], Vec<LaunchComponent>); 4] = [
        (&[], vec![sensor(), controller()]),
        (
            &["python"],
            vec![
                sensor(),
                LaunchComponent { folder: None, environment: environment(&[("GAIN", "2")]), ..command(&python) },
                display(),
            ],
        ),
        (
            &["debug"],
            vec![
                sensor(),
                LaunchComponent {
                    build: debug_build.clone(),
                    folder: debug_folder.clone(),
                    environment: environment(&[("LOG", "all")]),
                    ..controller()
                },
            ],
        ),
        (
            &["python", "debug"],
            vec![
                sensor(),
                LaunchComponent {
                    build: debug_build,
                    folder: debug_folder,
                    environment: environment(&[("GAIN", "2"), ("LOG", "all")]),
                    ..command(&python)
                },
                display(),
            ],
        ),
    ];
    for (profiles, expected) in cases {
        assert_eq!(file.components_with(&words(profiles)), Ok(expected), "{profiles:?}");
    }
}

/// The page has the tables of the keys as they are here, and all of its launch files can be used.
#[test]
fn the_reference_page_is_current() {
    let page = include_str!("../../../docs/launch.md");
    for keys in [keys::TOP, keys::COMPONENT] {
        let row = |Key { name, value, meaning }: &Key| format!("| `{name}` | {value} | {meaning} |\n");
        let table = format!("| key | value | meaning |\n|---|---|---|\n{}", keys.iter().map(row).collect::<String>());
        assert!(page.contains(&table), "docs/launch.md lacks this table:\n{table}");
    }
    assert!(page.contains(&format!("```yaml\n{EXAMPLE}```\n")), "docs/launch.md lacks the example:\n{EXAMPLE}");
    let blocks: Vec<&str> = page.split("```yaml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    for text in &blocks {
        assert_eq!(parse_launch_file(text, None).err(), None, "{text}");
    }
    assert!(blocks.len() > 2);
}

#[test]
fn no_damaged_file_is_too_bad() {
    let known = words(&["sensor", "controller", "display"]);
    let parse = |text: &str| match parse_launch_file(text, Some(&known)) {
        Ok(file) => assert!(!file.components.is_empty(), "nothing to start in:\n{text}"),
        Err(problems) => assert!(!problems.is_empty(), "rejected without a reason:\n{text}"),
    };
    for (at, character) in GOOD.char_indices() {
        let (before, after) = (&GOOD[..at], &GOOD[at + character.len_utf8()..]);
        parse(before);
        parse(&format!("{before}{after}"));
        for odd in [":", "\t", "[", "{", "\"", "*a", "&a", "\u{0}", "\u{e9}", "<<: ", "!t ", "- "] {
            parse(&format!("{before}{odd}{after}"));
        }
    }
}

#[test]
fn texts_made_to_break_a_parser_are_rejected() {
    let doubling = |level: u8| format!("x{level}: &x{level} [*x{0}, *x{0}, *x{0}, *x{0}]\n", level - 1);
    let bomb = format!("x0: &x0 [a]\n{}", (1..60).map(doubling).collect::<String>());
    for text in [bomb, "[".repeat(100_000), "a: ".repeat(10_000), "? ".repeat(10_000), "- ".repeat(100_000)] {
        let start: String = text.chars().take(20).collect();
        assert!(parse_launch_file(&text, None).is_err(), "{start}");
    }
}
