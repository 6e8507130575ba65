//! What becomes of good launch files, and that no text at all is too bad. The words are tested with the real command.

use super::{LaunchComponent, LaunchFile, parse_launch_file};

const GOOD: &str = "\
# A comment: command
transport: ipc
environment: {RUST_LOG: info, \"LEVEL\": 2}
components:
  sensor:
    command: [./sensor, --rate, 100, 0.5, true, '1.10']
  controller:
    command: ./controller 2>> log
    environment:
      GAIN: 0.50
    folder: control
";

fn pairs(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

#[test]
fn a_good_file_keeps_its_order_and_its_values() {
    let expected = LaunchFile {
        components: vec![
            LaunchComponent {
                name: "sensor".to_owned(),
                command: words(&["./sensor", "--rate", "100", "0.5", "true", "1.10"]),
                ..LaunchComponent::default()
            },
            LaunchComponent {
                name: "controller".to_owned(),
                command: words(&["/bin/sh", "-c", "./controller 2>> log"]),
                environment: pairs(&[("GAIN", "0.5")]),
                folder: Some("control".to_owned()),
            },
        ],
        environment: pairs(&[("RUST_LOG", "info"), ("LEVEL", "2")]),
        transport: Some("ipc".to_owned()),
    };
    let known = words(&["sensor", "controller", "other"]);
    for text in [GOOD.to_owned(), GOOD.replace('\n', "\r\n"), format!("\u{feff}{GOOD}")] {
        assert_eq!(parse_launch_file("launch.yaml", &text, Some(&known)), Ok(expected.clone()));
    }
}

#[test]
fn no_damaged_file_is_too_bad() {
    let known = words(&["sensor", "controller"]);
    let parse = |text: &str| match parse_launch_file("launch.yaml", text, Some(&known)) {
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
        assert!(parse_launch_file("launch.yaml", &text, None).is_err(), "{start}");
    }
}
