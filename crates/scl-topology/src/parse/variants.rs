//! The variants of each rule, mostly in flow style: text and headlines.

use super::testing::headlines;
use expect_test::{Expect, expect};

fn check(texts: &[&str], expected: Expect) {
    let all: Vec<String> = texts.iter().map(|text| format!("{}\n{}", visible(text), headlines(text))).collect();
    expected.assert_eq(&all.join("\n"));
}

/// The text with escapes for all that an editor may hide.
fn visible(text: &str) -> String {
    let escape = |c: char| if c.is_ascii() && c != '\t' { c.to_string() } else { c.escape_default().to_string() };
    text.chars().map(escape).collect()
}

#[test]
fn syntax() {
    check(
        &[
            "components:\n  - name: a\n      gates: []\n",
            "components:\n  - name: a\n  gates: []\n",
            "components\n  - name: a\n",
            "components:\n  - name: a\n    gates:\n      - b: {pub:c.D}\n      - e:pub\nconnections: []\n",
            "components:\n  - name: \"a\n    gates: [\"b\"]\n",
            "components:\n  - {name: a]\n",
            "components:\n  - name: ]\n",
            "components:\n  - name: a: b\n",
            "components:\n  - name: *\n",
            "components:\n  - name: a\n  -name: b\n",
            "components:\n  - name: a\n      - b: pub\n",
            "components: *a\n",
            "a: &b c\n---\n--- d\n",
            "components:\n  - &a name: b\n    gates: [\n",
            "{\n\t\"components\": []\n}\n",
            "components: [] # \u{202e}\nx-a: \"\u{200d}\"\nx-\u{200b}b: 1\n",
            "%YAML 1.2\n# a\n--- # b\ncomponents: []\n",
        ],
        expect![[r#"
            components:
              - name: a
                  gates: []

            SCL0105 3:7 this line is indented by 6 spaces, which matches no line above it

            components:
              - name: a
              gates: []

            SCL0105 3:3 this key is indented like the `-` of the list item above it, not like its keys

            components
              - name: a

            SCL0123 1:1 missing `:` after `components`

            components:
              - name: a
                gates:
                  - b: {pub:c.D}
                  - e:pub
            connections: []

            SCL0103 4:16 missing space after `:`
            SCL0103 5:10 missing space after `:`

            components:
              - name: "a
                gates: ["b"]

            SCL0104 2:11 this quoted string is never closed

            components:
              - {name: a]

            SCL0102 2:13 this `]` does not close `{`

            components:
              - name: ]

            SCL0102 2:11 this `]` closes nothing

            components:
              - name: a: b

            SCL0125 2:12 `: b` is not expected here

            components:
              - name: *

            SCL0106 2:11 a value cannot start with `*` in YAML

            components:
              - name: a
              -name: b

            SCL0124 3:3 missing space after `-`

            components:
              - name: a
                  - b: pub

            SCL0105 3:7 this list belongs to no key

            components: *a

            SCL0111 1:13 YAML anchors and aliases are not supported in a topology

            a: &b c
            ---
            --- d

            SCL0111 1:4 YAML anchors and aliases are not supported in a topology
            SCL0114 2:1 a topology is one YAML document; a second one starts here

            components:
              - &a name: b
                gates: [

            SCL0111 2:5 YAML anchors and aliases are not supported in a topology
            SCL0102 3:12 this `[` is never closed

            {
            \t"components": []
            }

            SCL0101 2:1 a tab character is used for indentation

            components: [] # \u{202e}
            x-a: "\u{200d}"
            x-\u{200b}b: 1

            SCL0117 1:18 invisible character U+202E (bidirectional control)
            SCL0117 3:3 invisible character U+200B (zero width space)

            %YAML 1.2
            # a
            --- # b
            components: []

            SCL0118 1:1 YAML directives are not supported
        "#]],
    );
}

#[test]
fn names() {
    check(
        &[
            "components: [{name: 017, gates: []}, {name: 12:30, gates: []}, {name: 2024-01-01, gates: []}, {name: .inf, gates: []}]\n",
            "components: [{name: y, gates: []}, {name: Off, gates: []}, {name: oFF, gates: []}, {name: \"no\", gates: []}, {name: '1', gates: []}]\n",
            "components: [{name: ~, gates: []}, {name: '', gates: []}, {name: [a], gates: []}]\n",
        ],
        expect![[r#"
            components: [{name: 017, gates: []}, {name: 12:30, gates: []}, {name: 2024-01-01, gates: []}, {name: .inf, gates: []}]

            SCL0109 1:21 a name is expected here, and `017` is a number
            SCL0109 1:45 a name is expected here, and `12:30` is a number
            SCL0109 1:71 a name is expected here, and `2024-01-01` is a date
            SCL0109 1:102 a name is expected here, and `.inf` is a number

            components: [{name: y, gates: []}, {name: Off, gates: []}, {name: oFF, gates: []}, {name: "no", gates: []}, {name: '1', gates: []}]

            SCL0108 1:43 `Off` is a boolean in YAML 1.1

            components: [{name: ~, gates: []}, {name: '', gates: []}, {name: [a], gates: []}]

            SCL0110 1:21 the component name is empty
            SCL0110 1:43 the component name is empty
            SCL0215 1:66 `name` must be text; this is a list
        "#]],
    );
}

#[test]
fn gates() {
    check(
        &[
            "components: [{name: a, gates: [b, {}, [c, pub], {d: }, {e: []}, {f: {}}, {g: {queue: 1}}, {h: pub T}]}]\nconnections: []\n",
            "components: [{name: a, gates: [{b: pub, queue: 1}, {c: pub, d: sub}, {name: e, kind: pub}, {f: {kind: pub, type: T}}, {g: {pub: A, sub: B}}]}]\nconnections: []\n",
            "components: [{name: a, gates: [{b: {publish: T, queue: 1}}, {c: {sub: T, queue: '1', when_full: wiat, timeout: 5, share: yes, unconnected: no}}]}]\nconnections: []\n",
            "components: [{name: a, gates: {b: pub}}, {name: c, gates: d}]\nconnections: []\n",
        ],
        expect![[r#"
            components: [{name: a, gates: [b, {}, [c, pub], {d: }, {e: []}, {f: {}}, {g: {queue: 1}}, {h: pub T}]}]
            connections: []

            SCL0210 1:32 gate `b` has no kind
            SCL0210 1:35 this gate has no name
            SCL0210 1:39 a gate is written as `name: kind`; this is a list
            SCL0210 1:50 gate `d` has no kind
            SCL0210 1:60 the kind of gate `e` must be one word; this is a list
            SCL0210 1:69 gate `f` has no kind
            SCL0210 1:78 gate `g` has no kind
            SCL0210 1:95 gate `h` has its type outside of braces

            components: [{name: a, gates: [{b: pub, queue: 1}, {c: pub, d: sub}, {name: e, kind: pub}, {f: {kind: pub, type: T}}, {g: {pub: A, sub: B}}]}]
            connections: []

            SCL0214 1:41 `queue` belongs inside the braces of gate `b`, not beside it
            SCL0210 1:61 two gates in one list item (`c`, `d`)
            SCL0210 1:71 a gate is written as `name: kind`
            SCL0210 1:97 the kind of gate `f` is written as a value
            SCL0210 1:132 gate `g` has two kinds, `pub` and `sub`

            components: [{name: a, gates: [{b: {publish: T, queue: 1}}, {c: {sub: T, queue: '1', when_full: wiat, timeout: 5, share: yes, unconnected: no}}]}]
            connections: []

            SCL0215 1:81 `queue` must be a whole number
            SCL0215 1:97 `when_full` must be `drop_oldest`, `drop_newest` or `wait`
            SCL0215 1:140 `unconnected` must be `ok`

            components: [{name: a, gates: {b: pub}}, {name: c, gates: d}]
            connections: []

            SCL0204 1:32 `gates` must be a list; this is a mapping
            SCL0204 1:59 `gates` must be a list; this is text
        "#]],
    );
}

#[test]
fn components() {
    check(
        &[
            "components: [a, [b], null, {gates: []}, {name: d, queue: 1, scl: 1, gate: [], optional: 1, gates: []}]\n",
            "components:\n  - name: a\n  - gates: [b: pub]\n",
        ],
        expect![[r#"
            components: [a, [b], null, {gates: []}, {name: d, queue: 1, scl: 1, gate: [], optional: 1, gates: []}]

            SCL0208 1:14 this component has no name
            SCL0208 1:17 this component has no name
            SCL0110 1:22 the list item is empty
            SCL0208 1:28 this component has no name
            SCL0214 1:51 `queue` belongs inside a gate, not beside the gates of component `d`
            SCL0214 1:61 `scl` belongs at the top level, not inside component `d`
            SCL0207 1:69 unknown key `gate` in component `d`
            SCL0215 1:89 `optional` must be `true` or `false`

            components:
              - name: a
              - gates: [b: pub]

            SCL0209 2:11 component `a` has no gates
            SCL0214 3:3 these `gates` belong to component `a`, but their `-` starts a new component
        "#]],
    );
}

#[test]
fn sections() {
    check(
        &[
            "gates: []\nsystem: [a]\nschemas: a.proto\ncodec:\nscl: x\nqueue: 3\ncomponent: []\n",
            "components: a\nconnections: {a.b: c.d}\n",
            "{}\n",
            "components\n",
            "{\"scl\": 2, \"components\": [], \"components\": []}\n",
        ],
        expect![[r#"
            gates: []
            system: [a]
            schemas: a.proto
            codec:
            scl: x
            queue: 3
            component: []

            SCL0214 1:1 `gates` belongs inside a component, not at the top level
            SCL0215 2:9 `system` must be text; this is a list
            SCL0204 3:10 `schemas` must be a list; this is text
            SCL0110 4:1 the codec is empty
            SCL0215 5:6 `scl` must be a whole number
            SCL0214 6:1 `queue` belongs inside a gate, not at the top level
            SCL0202 7:1 unknown section `component`

            components: a
            connections: {a.b: c.d}

            SCL0204 1:13 `components` must be a list; this is text
            SCL0204 2:15 `connections` must be a list; this is a mapping

            {}

            SCL0203 1:1 the section `components` is missing

            components

            SCL0201 1:1 a topology starts with `components:`, and this file starts with text

            {"scl": 2, "components": [], "components": []}

            SCL0213 1:9 this file needs topology format 2; this version of scl reads format 1
            SCL0107 1:30 the key `components` is written twice in this file
        "#]],
    );
}

#[test]
fn connections() {
    check(
        &[
            "components: []\nconnections: [a.b, a.b -> c.d, a.b ->, a.b: c.d, [a.b], [], [a: b, c.d], null, [1.2, c.d]]\n",
        ],
        expect![[r#"
            components: []
            connections: [a.b, a.b -> c.d, a.b ->, a.b: c.d, [a.b], [], [a: b, c.d], null, [1.2, c.d]]

            SCL0211 2:15 a connection joins exactly two gates; this one is text
            SCL0211 2:20 a connection joins exactly two gates; this one is text
            SCL0211 2:32 a connection joins exactly two gates; this one is text
            SCL0211 2:40 a connection joins exactly two gates; this one is a mapping
            SCL0211 2:50 a connection joins exactly two gates; this one lists 1
            SCL0211 2:57 a connection joins exactly two gates; this one is empty
            SCL0211 2:62 an end of a connection is `component.gate`; this is a mapping
            SCL0110 2:74 the list item is empty
            SCL0109 2:81 a name is expected here, and `1.2` is a number
        "#]],
    );
}
