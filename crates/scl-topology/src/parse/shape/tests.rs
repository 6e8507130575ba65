//! What the first proposal of a problem makes of a text.

use crate::advice::apply;
use crate::diagnostic::{Diagnostic, Edit, Severity};
use crate::parse::testing::parse_text;

/// Applies the first proposal of each error.
fn proposed(text: &str) -> String {
    let (_, problems, _) = parse_text(text);
    let errors = problems.iter().filter(|problem| problem.severity == Severity::Error);
    let edits: Vec<&Edit> =
        errors.filter_map(|problem| problem.proposals().next()).flat_map(|way| &way.edits).collect();
    apply(text, &edits).unwrap_or_default()
}

fn errors(text: &str) -> usize {
    parse_text(text).1.iter().filter(|problem: &&Diagnostic| problem.severity == Severity::Error).count()
}

/// Checks that each wrong text has one error, and that its first proposal makes the right one of it.
#[track_caller]
fn check(cases: &[(&str, &str)], around: impl Fn(&str) -> String) {
    for (wrong, right) in cases {
        let text = around(wrong);
        assert_eq!(errors(&text), 1, "{text}");
        assert_eq!(proposed(&text), around(right));
    }
}

#[test]
fn gates_in_other_notations() {
    let cases = [
        ("- x pub", "- x: pub"),
        ("- x: [pub, T]", "- x: {pub: T}"),
        ("- x: pub T   # why", "- x: {pub: T}   # why"),
        ("- x: Publisher<a.T>", "- x: {pub: a.T}"),
        ("- x: <pub type=\"T\" doc=\"A b.\"/>", "- x: {pub: T, doc: \"A b.\"}"),
        ("- x: {kind: pub, type: T, doc: A}", "- x: {pub: T, doc: A}"),
        ("- x: {direction: out, msg: T}", "- x: {pub: T}"),
        ("- {name: x, kind: pub, type: T, codec: json}", "- {x: {pub: T, codec: json}}"),
        ("- name: x\n        kind: sub\n        queue: 1", "- x: {sub: , queue: 1}"),
        ("- [x, pub]", "- x: pub"),
        ("- x: {pub: , type: T}", "- x: {pub: T}"),
        ("- x:\n        pub: T\n        doc: A", "- x:\n          pub: T\n          doc: A"),
        ("- x: sub # why\n        queue: 1", "- x: {sub: , queue: 1} # why"),
        ("- x: {sub: T}\n        queue: 1", "- x: {sub: T, queue: 1}"),
        ("- x: pub\n        y: {sub: T}", "- x: pub\n      - y: {sub: T}"),
        ("- x: {sub = T, queue = 1}", "- x: {sub: T, queue: 1}"),
        ("- x: {rep: (A) returns (B)}", "- x: {rep: A -> B}"),
        ("- x: {rep: A, B}", "- x: {rep: A -> B}"),
        ("- x: {rep: (A, B)}", "- x: {rep: A -> B}"),
        ("- x: {req: {request: A, response: B}}", "- x: {req: A -> B}"),
        ("- x: {rep: B (A)}", "- x: {rep: A -> B}"),
        ("- x: {pub: [t.T]}", "- x: {pub: t.T}"),
        ("- x: {pub: {$ref: '#/schemas/T'}} # a.T", "- x: {pub: a.T} # a.T"),
    ];
    check(&cases, |gate| format!("components:\n  - name: a\n    gates:\n      {gate}\nconnections: []\n"));
}

#[test]
fn options_in_other_words() {
    let cases = [
        ("queue_size: 10", "queue: 10"),
        ("hwm: \"10\"", "queue: 10"),
        ("maxsize: 10", "queue: 10"),
        ("maxSize: 2MiB", "max_size: 2MiB"),
        ("history: keep_last", "when_full: drop_oldest"),
        ("whenFull: wait", "when_full: wait"),
        ("when_full: DropOldest", "when_full: drop_oldest"),
        ("when_full: block", "when_full: wait"),
        ("queue: 1,000", "queue: 1000"),
        ("queue: unlimited", "queue: 1000000"),
        ("max_size: 8_000_000", "max_size: 8000000B"),
        ("unconnected: yes", "unconnected: ok"),
        ("with: {queue: 1, when_full: wait}", "queue: 1, when_full: wait"),
        ("qos: {reliability: best_effort, history: keep_last, depth: 5}", "queue: 5"),
        ("max_nb_message: 16", "queue: 16"),
        ("maxMessageBytes: 2MiB", "max_size: 2MiB"),
        ("discard: new", "when_full: drop_newest"),
        ("leaky: downstream", "when_full: drop_oldest"),
        ("max_size: 1920*1080*3", "max_size: 6220800B"),
        ("queue: 2*8", "queue: 16"),
    ];
    check(&cases, |option| {
        format!("components:\n  - name: a\n    gates:\n      - x: {{sub: T, {option}}}\nconnections: []\n")
    });
}

#[test]
fn connections_in_other_notations() {
    let cases = [
        ("- a.x -> b.y", "- [a.x, b.y]"),
        ("- a/x => b/y # why", "- [a.x, b.y] # why"),
        ("- (a.x, b.y)", "- [a.x, b.y]"),
        ("- connect a.x to b.y", "- [a.x, b.y]"),
        ("- {from: a.x, to: b.y}", "- [a.x, b.y]"),
        ("- from: a.x\n    to: b.y", "- [a.x, b.y]"),
        ("- a.x: b.y", "- [a.x, b.y]"),
        ("- \"a.x:b.y\"", "- [a.x, b.y]"),
        ("- a.x--b.y", "- [a.x, b.y]"),
        ("- a.x: [b.y, c.z]", "- [a.x, b.y]\n  - [a.x, c.z]"),
        ("- [a, x, b.y]", "- [a.x, b.y]"),
        ("- [{a: x}, b.y]", "- [a.x, b.y]"),
        ("- [a.x, b.y, c.z]", "- [a.x, b.y]\n  - [a.x, c.z]"),
        ("a.x: b.y # why\n  c.z: d.w", "- [a.x, b.y] # why\n  - [c.z, d.w]"),
        ("one:\n    - [a.x, b.y]\n  two:\n    - [c.z, d.w]", "# one:\n    - [a.x, b.y]\n  # two:\n    - [c.z, d.w]"),
        ("{a.x: b.y}", "[[a.x, b.y]]"),
        ("a.x -> b.y", "[[a.x, b.y]]"),
    ];
    check(&cases, |entries| format!("components: []\nconnections:\n  {entries}\n"));
}

#[test]
fn components_in_other_notations() {
    let cases = [
        ("a:\n    gates: []", "- name: a\n    gates: []"),
        ("a: {gates: []}", "- {name: a, gates: []}"),
        ("- id: a\n    gates: []", "- name: a\n    gates: []"),
        ("- a:\n      gates: []", "- name: a\n    gates: []"),
        ("- name: a\n    ports: []", "- name: a\n    gates: []"),
        ("- name: a\n    required: false\n    gates: []", "- name: a\n    optional: true\n    gates: []"),
        (
            "- name: a\n    gates:\n      x: pub # why\n      y:\n        sub: T",
            "- name: a\n    gates:\n      - x: pub # why\n      - y:\n          sub: T",
        ),
    ];
    check(&cases, |components| format!("components:\n  {components}\nconnections: []\n"));
}

#[test]
fn sections_in_other_words() {
    let cases = [
        ("Codec: json", "codec: json"),
        ("encoding: json", "codec: json"),
        ("metadata:\n  name: rover", "system: rover"),
        ("name: rover", "system: rover"),
        ("imports: [a.proto]", "schemas: [a.proto]"),
        ("schemas: a.proto", "schemas: [a.proto]"),
        ("scl: 0.1", "scl: 1"),
        ("scl: \"1\"", "scl: 1"),
        ("version: 3", "scl: 1"),
    ];
    check(&cases, |section| format!("{section}\ncomponents: []\nconnections: []\n"));
}

#[test]
fn components_in_other_lists() {
    let cases = [
        (
            "- name: a\n    gates:\n      - x: pub\n      - name: b # why\n        gates:\n          - x: sub\n      - y: pub",
            "- name: a\n    gates:\n      - x: pub\n      - y: pub\n  - name: b # why\n    gates:\n      - x: sub",
        ),
        (
            "- name: a\n    gates:\n      - name: b\n        gates: []\nconnections:\n  - [a.x, b.x]",
            "- name: a\n    gates:\n  - name: b\n    gates: []\nconnections:\n  - [a.x, b.x]",
        ),
        (
            "- {name: a, gates: []}\nconnections:\n- name: b\n  gates: []\n- [a.x, b.x]",
            "- {name: a, gates: []}\n  - name: b\n    gates: []\nconnections:\n- [a.x, b.x]",
        ),
    ];
    check(&cases, |components| format!("components:\n  {components}\nx-end: {{}}\n"));
}

#[test]
fn ports_in_the_place_of_gates() {
    let cases = [
        ("inputs: [c.x]", "gates: [x: sub]", "  - [c.x, b.x]\n"),
        ("inputs: {y: c/x}", "gates: [y: sub]", "  - [c.x, b.y]\n"),
        ("outputs:\n      y: a.T", "gates: [y: {pub: a.T}]", ""),
        ("outputs: [y, z]", "gates: [y: pub, z: pub]", ""),
    ];
    let file = |keys: &str, connection: &str| {
        format!("components:\n  - name: b\n    {keys}\nconnections:\n  - [c.z, d.z]\n{connection}")
    };
    for (wrong, right, connection) in cases {
        assert_eq!(proposed(&file(wrong, "")), file(right, connection));
    }
}

#[test]
fn repeated_lists_keep_their_entries() {
    let advice = |one: &str, two: &str| {
        let (_, problems, _) = parse_text(&format!("components: []\nconnections: {one}\nconnections: {two}\n"));
        let helps = problems.iter().flat_map(Diagnostic::shown_helps).map(|help| help.text().into_owned());
        helps.filter(|help| help.starts_with("remove")).collect::<Vec<_>>().join(" | ")
    };
    assert_eq!(advice("\n  - [a.x, b.x]", "[]"), "remove the second one");
    assert_eq!(advice("[]", "\n  - [a.x, b.x]"), "remove the first one");
    let both = "remove this line with `connections:`, so that both lists become one";
    assert_eq!(advice("\n  - [a.x, b.x]", "\n  - [a.y, b.y]"), both);
    assert_eq!(advice("[[a.x, b.x]]", "[[a.x, b.x]]"), "remove the second one | remove the first one");
}

#[test]
fn merged_keys_are_written_out() {
    let anchors = ["\n  queue: 1 # why\n  max_size: 4KiB", "{queue: 1, max_size: 4KiB}"];
    let gates = [
        ("sub: T\n          <<: *a", "sub: T\n          queue: 1\n          max_size: 4KiB"),
        ("{sub: T, <<: *a}", "{sub: T, queue: 1, max_size: 4KiB}"),
    ];
    for (anchor, (wrong, right)) in anchors.into_iter().flat_map(|anchor| gates.map(|gate| (anchor, gate))) {
        let gate = |gate: &str| {
            let line = if gate.starts_with('{') { " " } else { "\n          " };
            format!("components:\n  - name: b\n    gates:\n      - x:{line}{gate}\nconnections: []\n")
        };
        let space = if anchor.starts_with('{') { " " } else { "" };
        let text = format!("x-a: &a{space}{anchor}\n{}", gate(wrong));
        assert_eq!(errors(&text), 1, "{text}");
        assert_eq!(proposed(&text), format!("x-a:{space}{anchor}\n{}", gate(right)));
    }
}
