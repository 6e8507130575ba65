//! Several mistakes at once: all are reported, and nothing that only follows from them.

use super::testing::{advice, codes, problems};
use crate::diagnostic::Severity;
use crate::source::Span;
use expect_test::expect;

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
    let cases: [(&str, String, &[&str]); 15] = [
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
            "an unread type is not taken over",
            file("x: {pub: T}; y: {pub: U}", "z: {sub: [T, U]}", "[a.x, b.z]; [a.y, b.z]"),
            &["SCL0215"],
        ),
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
fn what_belongs_together_is_changed_together() {
    let cases = [
        file("x: pub; w: pub", "x: sub; w: sub", "[a.*, b.*]"),
        file("x: {pub: T}; w: {pub: U}", "x: {sub: T}; w: {sub: U}", "['*.x', b.x]; [a.w, b.w]"),
        file("x_1: pub; x_2: pub", "all: sub", "[a.x_*, b.all]"),
        file("x: pub", "x: sub", "[c*.x, b.x]"),
        file(
            "x: {push: T, backpressure: true}",
            "x: {pull: T, when_full: wait}; w: {pull: T, when_full: wait}",
            "[a.x, b.x]; [a.x, b.w]",
        ),
        file("x: {push: T, share: 2}", "x: {pull: T}; w: {pull: T}", "[a.x, b.x]; [a.x, b.w]"),
        file("x: {req: Q -> R, timeout: 1s}", "x: {rep: Q -> R}; w: {rep: Q -> R}", "[a.x, b.x]; [a.x, b.w]"),
        file("x: {sub: , queue: 5}", "t: {pub: T}; u: {pub: U}; v: {pub: U}", "[a.x, b.t]; [a.x, b.u]; [a.x, b.v]"),
        file("x: {pub: T}; x: {pub: T}", "x: {sub: T}", "[a.x, b.x]"),
        file("x: {sub: T, queue: 1}; x: {sub: T, queue: 2}", "x: {pub: T}", "[a.x, b.x]"),
        file("x: {pub: T}; x: {sub: T}", "x: {pub: T}; x: {sub: T}", "[a.x, b.x]; [b.x, a.x]"),
        file("x: {pub: T}; x: {pub: U}", "x: {sub: T}", "[a.x, b.x]"),
        file("x_1: pub; x_2: pub", "x_1: sub; x_2: sub", "[a.x_1, b.x_1]; [a.x_1, b.x_1]"),
        file("x: pub; w: pub", "x: sub; w: sub", "[a.x, b.x]; [a.w, b.w]; [a.x, b.x]"),
        file("ask: req; x: rep", "x: rep", "[a.ask, a.ask]"),
        file("ask: req; x: rep", "x: req", "[a.ask, a.x]; [a.x, b.x]"),
        file("x: pub; w: sub", "w: sub", "[a.x, a.w]; [a.x, b.w]"),
        file(
            "ask: {req: Q -> R, timeout: 1s}; state: {rep: Q -> S}",
            "do: {rep: Q -> R}; state: {req: Q -> S}",
            "[a.ask, b.do]; [b.state, a.state]",
        ),
        file("x: pub", "x: req; w: sub", "[a.x, b.x]"),
        file("x: pub", "x: sub; x_in: sub", "[a.x, b.x]; [a.x, b.x_in]")
            .replace("name: b", "name: b_node")
            .replace("b.x", "node.x"),
        file("x: pub", "x: sub", "[a.x, b.x]; [ghost.y, b.x]")
            .replace("components:", "components:\n#  - name: ghost\n#    gates: [y: pub]"),
        file("x: {pub: T}", "w: {pub: T}", "[a.x, b.w]; [b.w, c.in]")
            .replace("connections:", "  - name: c\n    gates:\n      - in: {sub: T}\nconnections:"),
        file("x: {sub: T, backpressure: true}", "x: {pub: T}", "[a.x, b.x]"),
        file("x: {pub: T, share: true}", "x: {sub: T}; w: {sub: T}", "[a.x, b.x]; [a.x, b.w]"),
        file("x: {req: T -> U, share: true}", "x: {rep: T -> U}", "[a.x, b.x]"),
        file("x: {pub: T -> U}", "x: {sub: U}", "[a.x, b.x]"),
        file("x: {pub: T}; w: pub", "x: a/x; w: sub", "[a.w, b.w]"),
        file("x: {pub: T}", "x: {sub: T}", "[a.left.x, b.x]").replace("name: a", "name: a_left"),
        file("x: {pub: T}", "x: {sub: T}", "[a.x, a.x]; [a.x, b.x]"),
        file("x: {dealer: T -> U}", "x: {rep: T -> U}", "[a.x, b.x]"),
        file("x: {pub: T}", "x: {sub: T}; w: {sub: T}", "[a.x, [b.x, b.w]]"),
        file("x: {req: T -> None}", "x: {rep: T -> None}", "[a.x, b.x]"),
        file("x: {push: T, when_full: wait}", "x: {pull: T}", "[a.x, b.x]"),
        file("{topic: x, type: p.T}", "x: {sub: p.T}", "[a.x, b.x]"),
        file("x: {pub: T, .codec = raw}", "x: {sub: T, codec: raw}", "[a.x, b.x]"),
        file("x: {pub: T}", "x: {sub: T, queue => 5}", "[a.x, b.x]"),
        file("x: {pub: T}", "x: {sub: T}", "[a.x, b.x]")
            .replace("  - name: b", "#else\n  - name: a\n    gates: []\n#endif\n  - name: b"),
    ];
    let told: String = cases.iter().map(|yaml| format!("{}\n", advice(yaml))).collect();
    expect![[r#"
        SCL0503 a connection end is written `component.gate` [write a connection for each gate: `[a.x, b.x]`, `[a.w, b.w]`]
        SCL0503 a connection end is written `component.gate` [write a connection for each gate: `[a.x, b.x]`]
        SCL0503 a connection end is written `component.gate` [write a connection for each gate: `[a.x_1, b.all]`, `[a.x_2, b.all]`]
        SCL0503 a connection end is written `component.gate` [write a connection for each gate, without `*`]
        SCL0513 gate `a.x` pushes to two components, so each of them gets only a part of the messages [if they share the work, write `x: {push: T, backpressure: true, share: true}` | if both need every message, make `a.x` a `pub` gate, and each of `b.x`, `b.w` a `sub` gate]
        SCL0215 `share` must be `true` or `false` [write `share: true`]
        SCL0512 gate `a.x` asks two repliers [declare one `req` gate for each replier: `b_x`, `b_w` | or keep only one of these connections]
        SCL0601 2 connections of `a.x` use different message types at their two ends [give `a` one gate for each type: `t` and `u` | write `T` at `b.u`, `b.v`]
        SCL0302 component `a` declares gate `x` twice [remove one of the two]
        SCL0302 component `a` declares gate `x` twice [remove the first one, which has `queue: 1` | remove the second one, which has `queue: 2` | or give one of them another name]
        SCL0302 component `a` declares gate `x` twice [give the `sub` gate a name of its own, for example `x_in`, also in its connections]; SCL0302 component `b` declares gate `x` twice [give the `sub` gate a name of its own, for example `x_in`, also in its connections]
        SCL0302 component `a` declares gate `x` twice [gate names are unique within a component: give one of them another name, also in its connections]
        SCL0510 this connection is already declared [write `[a.x_2, b.x_2]` | remove one of the two]
        SCL0510 this connection is already declared [remove one of the two]
        SCL0507 gate `a.ask` is connected to itself [write `[a.ask, b.x]`]
        SCL0508 component `a` sends requests to itself [call a function inside the component, and remove this connection and the gate `a.ask`]

        SCL0707 components wait for each other: `a` -> `b` -> `a` [let `a` publish what `b.state` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req` | or let `b` publish what `a.ask` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req` | or, if a component never waits at its connection while another one waits for it, write
        `# scl: allow(SCL0707) reason` above that connection]
        SCL0506 a `pub` gate cannot be connected to a `req` gate [make `a.x` a `rep` gate | make `b.x` a `sub` gate]
        SCL0501 unknown component `node` [did you mean `b_node`? | or rename the component `b_node` to `node`]
        SCL0501 unknown component `ghost` [make comments of its connections, too | or declare the component `ghost` with the gate `y` (pub), or remove the connection]
        SCL0505 both ends of this connection publish [a `pub` gate connects to a `sub` gate | connect `a.x` to `c.in` (sub) | make `a.x` a `sub` gate]
        SCL0408 option `backpressure` is not available on a `sub` gate [write `backpressure: true` at `b.x` | remove it]
        SCL0408 option `share` is not available on a `pub` gate [remove it | or make this a `push` gate, and each of `b.x`, `b.w` a `pull` gate]
        SCL0408 option `share` is not available on a `req` gate [remove it]
        SCL0404 a `pub` gate sends one type and gets no answer [write `U` alone, as at the other end]
        SCL0401 unknown gate kind `a/x` [write `x: {sub: T}`, and add the connection `[a.x, b.x]`]
        SCL0503 a connection end is written `component.gate` [write `a_left.x`]
        SCL0507 gate `a.x` is connected to itself [remove this connection]
        SCL0401 unknown gate kind `dealer` [two types are those of a request and its reply: write `req`]
        SCL0211 an end of a connection is one gate; this is a list [write one connection for each pair:
        - [a.x, b.x]
        - [a.x, b.w]]
        SCL0403 `None` cannot be a message type [request and reply are both messages; one without fields, `message Done {}`, says only that it came]
        SCL0408 option `when_full` is not available on a `push` gate [write `backpressure: true` here, and `when_full: wait` at `b.x` | remove it]
        SCL0210 a gate is written as `name: kind` [write `- x: {pub: p.T}`]
        SCL0210 `=` stands where the `:` after `.codec` is expected [write `codec: raw`]
        SCL0210 `=>` stands where the `:` after `queue` is expected [write `queue: 5`]
        SCL0301 component `a` is declared twice [keep one of the two; the programs of a component are chosen in the launch file, by `profiles` | if they are one component, remove the second one; otherwise give it another name]
    "#]].assert_eq(&told);
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
