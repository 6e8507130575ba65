//! Several mistakes at once: all are reported, and nothing that only follows from them.

use super::testing::{codes, problems};
use crate::diagnostic::Severity;
use crate::source::Span;

/// Two components with the gates given, and connections.
fn file(a: &str, b: &str, connections: &str) -> String {
    let list = |items: &str, indent: &str| -> String {
        items.split(';').map(|item| format!("{indent}- {}\n", item.trim())).collect()
    };
    let (a, b, connections) = (list(a, "      "), list(b, "      "), list(connections, "  "));
    format!("components:\n  - name: a\n    gates:\n{a}  - name: b\n    gates:\n{b}connections:\n{connections}")
}

#[test]
fn every_mistake_is_told_and_nothing_else() {
    let cases: [(&str, String, &[&str]); 14] = [
        (
            "three mistakes in three places",
            file("x: publish; w: {pub: T, codec: jsn}", "w: sub", "[a.w, b.z]"),
            &["SCL0401", "SCL0407", "SCL0502"],
        ),
        ("an unknown kind is no end of a pair", file("x: {publish: T}", "x: {sub: U}", "[a.x, b.x]"), &["SCL0401"]),
        ("what was meant is connected", file("ask: req", "orders: rep", "[a.ask, b.order]"), &["SCL0502"]),
        ("a peer of nobody is connected", file("ask: req", "x: pub", "[a.ask, c.order]; [b.x, c.x]"), &["SCL0501"]),
        ("a swapped end is connected", file("ask: req", "orders: rep", "[a.ask, orders.b]"), &["SCL0504"]),
        ("an end with a slash is connected", file("ask: req", "orders: rep", "[a.ask, b/orders]"), &["SCL0503"]),
        ("a gate of two kinds has none", file("x: pub; x: sub", "x: pub", "[a.x, b.x]"), &["SCL0302"]),
        ("a doubled connection is no peer", file("x: req", "x: rep", "[a.x, b.x]; [b.x, a.x]"), &["SCL0510"]),
        ("a wrong pair has no types", file("x: {pub: T}", "x: {req: T -> U}", "[a.x, b.x]"), &["SCL0506"]),
        ("a broken type is not compared", file("x: {pub: Vec<u8>}", "x: {sub: U}", "[a.x, b.x]"), &["SCL0403"]),
        (
            "a broken codec is not compared",
            file("x: {pub: U, codec: jsn}", "x: {sub: U, codec: cbor}", "[a.x, b.x]"),
            &["SCL0407"],
        ),
        ("a gate without a kind is connected", file("x", "x: sub", "[a.x, b.x]"), &["SCL0210"]),
        ("three ends are connected", file("x: pub", "x: sub; w: sub", "[a.x, b.x, b.w]"), &["SCL0211"]),
        (
            "conflicts of one type taken over are told once",
            file("x: pub", "x: {sub: T}; w: {sub: U}", "[a.x, b.x]; [a.x, b.w]"),
            &["SCL0601"],
        ),
    ];
    for (what, yaml, expected) in cases {
        assert_eq!(codes(&yaml), expected, "{what}\n{yaml}");
    }
}

#[test]
fn gates_of_both_declarations_of_a_component_exist() {
    let yaml = "components:\n  - name: a\n    gates:\n      - x: pub\n  - name: a\n    gates:\n      - w: pub\n  \
                - name: b\n    gates:\n      - x: sub\n      - w: sub\nconnections:\n  - [a.x, b.x]\n  - [a.w, b.w]\n";
    assert_eq!(codes(yaml), ["SCL0301"]);
}

#[test]
fn a_text_that_is_no_yaml_is_not_checked() {
    let yaml = "components:\n  - name: a b\n    gates:\n      - x: pib\nconnections: [\n";
    assert!(codes(yaml).iter().all(|code| code.starts_with("SCL01")), "{:?}", codes(yaml));
}

#[test]
fn sound_files_are_silent() {
    let cases = [
        ("untyped", file("x: pub; ask: req", "x: sub; orders: rep", "[a.x, b.x]; [b.orders, a.ask]")),
        ("types taken over", file("x: {pub: T}", "x: sub; w: sub", "[a.x, b.x]; [a.x, b.w]")),
        ("aliases are the compiler's", file("x: {pub: nav.T}", "x: {sub: log.T}", "[a.x, b.x]")),
        ("codec taken over", file("x: {pub: T, codec: json}", "x: {sub: T}", "[a.x, b.x]")),
        ("own codec", file("x: {pub: T, codec: \"my_crate::Flat\"}", "x: sub", "[a.x, b.x]")),
        ("shared work", file("x: {push: T, share: true}", "x: pull; w: pull", "[a.x, b.x]; [a.x, b.w]")),
        ("waiting", file("x: {pub: T, backpressure: true}", "x: {sub: T, when_full: wait}", "[a.x, b.x]")),
        ("meant to be alone", file("x: pub; w: {pub: T, unconnected: ok}", "x: {sub: T, queue: 1}", "[a.x, b.x]")),
        (
            "untyped gates with options",
            file(
                "x: {pub: , backpressure: true}; w: {pub: null, unconnected: ok}",
                "x: {sub: ~, when_full: wait}",
                "[a.x, b.x]",
            ),
        ),
        ("a timeout", file("x: {req: A -> B, timeout: 500ms}", "x: rep", "[a.x, b.x]")),
    ];
    for (what, yaml) in cases {
        assert_eq!(codes(&yaml), [""; 0], "{what}\n{yaml}");
    }
}

/// A sound file whose words the tests remove, double or misspell, one at a time.
const TYPED: &str = "system: rover
schemas: [rover.proto]
codec: protobuf
components:
  - name: sensor
    doc: Reads the inertial unit.
    gates:
      - measurements: {pub: rover.Measurement, backpressure: true}
      - jobs: pull
  - name: pilot
    optional: true
    gates:
      - sensor: {sub: rover.Measurement, queue: 10, when_full: wait}
      - orders: {rep: rover.Order -> rover.Answer, codec: json, max_size: 64KiB}
      - jobs: {push: rover.Job, share: true}
  - name: ground
    gates:
      - orders: {req: rover.Order -> rover.Answer, timeout: 500ms}
      - jobs: pull
connections:
  - [sensor.measurements, pilot.sensor]
  - [ground.orders, pilot.orders]
  - [pilot.jobs, ground.jobs]
  - [pilot.jobs, sensor.jobs]
";

/// The ranges of the words in a text; `.` and `-` separate words.
fn words(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut words = Vec::new();
    let mut start = 0;
    for (at, letter) in text.char_indices().filter(|(_, letter)| !letter.is_alphanumeric() && *letter != '_') {
        if start < at {
            words.push(start..at);
        }
        start = at + letter.len_utf8();
    }
    words
}

#[test]
fn every_misspelt_name_of_a_connection_is_told_on_its_line() {
    assert_eq!(codes(TYPED), [""; 0]);
    let ends = TYPED.find("connections:\n").unwrap() + "connections:\n".len();
    for word in words(TYPED).into_iter().filter(|word| word.start >= ends) {
        let mut mutant = TYPED.to_owned();
        mutant.insert(word.start + 1, 'q');
        let line = mutant[..word.start].matches('\n').count() as u32 + 1;
        let (found, sources) = problems(&mutant, None);
        let at = |span: Span| sources.file(span.file).line_column(span.start).line;
        let errors: Vec<u32> = found
            .iter()
            .filter(|found| found.severity == Severity::Error)
            .filter_map(|found| found.primary.as_ref())
            .map(|label| at(label.span))
            .collect();
        assert_eq!(errors, [line], "{mutant}");
    }
}

#[test]
fn no_missing_or_doubled_word_makes_a_panic() {
    for word in words(TYPED) {
        let text = &TYPED[word.clone()];
        for other in ["", &format!("{text}{text}"), &format!("{text}.{text}"), "-", "ö", "0"] {
            let mut mutant = TYPED.to_owned();
            mutant.replace_range(word.clone(), other);
            // `codes` also holds that a topology comes out exactly when there is no error.
            codes(&mutant);
        }
    }
}
