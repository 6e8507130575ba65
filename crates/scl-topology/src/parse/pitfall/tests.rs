//! Mistakes by which a text is not YAML, and what is advised.

use crate::parse::testing::advice;
use expect_test::expect;

const SOUND: &str = "system: rover
components:
  - name: sensor
    doc: Reads the bus.
    gates:
      - value: {pub: A.V}
      - state: {pub: A.S}
  - name: user
    gates:
      - value: {sub: A.V, queue: 1}
      - state: {sub: A.S, queue: 1}
connections:
  - [sensor.value, user.value]
  - [sensor.state, user.state]
";

fn all(replaced: &[(&str, &str)]) -> String {
    let told = replaced.iter().map(|(sound, wrong)| {
        assert!(SOUND.contains(sound), "{sound}");
        format!("{}: {}\n", wrong.escape_debug(), advice(&SOUND.replace(sound, wrong)))
    });
    told.collect()
}

#[test]
fn the_same_mistake_in_several_lines() {
    expect![[r#"
         queue: SCL0122 a comma is missing before `queue` [!add `,` after `A.V`, and the same on line 11]
        {pub: Bus: : SCL0125 a key has one value, and this is a second colon [write `pub: A.V`, and the same on line 7]
        {pub: A.S, doc: STATE #24, a}: SCL0130 a text with ` #` in it needs quotes [put the whole text in quotes: `doc: "STATE #24, a"`]
          – name: SCL0127 `–` (U+2013) is an en dash, not `-` [!retype it as `-`, and the same on line 8]
              • : SCL0127 `•` (U+2022) is a bullet, not `-` [!retype it as `-`, and the same on the 3 such lines from 7 to 11]
          * [: SCL0124 a list item starts with `-`, not with `*` [!write `- [sensor.value, user.value]`, and the same on line 14]
        读\n    gates：: SCL0127 `：` (U+FF1A) is a fullwidth colon, not `:` [!retype it as `:`]
    "#]].assert_eq(&all(&[
        (", queue", " queue"),
        ("{pub: ", "{pub: Bus: "),
        ("{pub: A.S}", "{pub: A.S, doc: STATE #24, a}"),
        ("  - name", "  – name"),
        ("      - ", "      • "),
        ("  - [", "  * ["),
        ("Reads the bus.\n    gates:", "读\n    gates："),
    ]));
}

#[test]
fn marks_of_other_notations() {
    expect![[r#"
        [connections]: SCL0131 `[connections]` is a heading in INI files and TOML; in YAML, it is a list [!write `connections:`]
        [links]: SCL0131 `[links]` is a heading in INI files and TOML; in YAML, it is a list [a section begins with its key and a colon, for example `components:`]
        queue: 1}  % newest: SCL0131 `%` starts a comment in TeX and MATLAB; in YAML, `#` does [!write `#` in place of `%` in both lines]
        [[sensor.value](http://sensor.value),: SCL0131 this is a link in Markdown, not a name [!write `- [sensor.value, user.value]`]
        [sensor[0].: SCL0131 `sensor[0]` is not a name: names have no brackets [write `sensor0`, and the same on line 14 | write `sensor_0`, and the same on line 14 | write `sensor-0`, and the same on line 14]
        float64[6]: SCL0125 `float64[6]` is not a type [a gate carries messages: for a list, declare a message with a `repeated` field in a schema, or a type in Rust, and write its name here]
        pub: A.V: SCL0102 a second key and its value in one line need braces [!write `- value: {pub: A.V}`]
        {rep: A: B}: SCL0125 a key has one value, and this is a second colon [write `rep: A -> B`]
        system: @NAME@: SCL0131 `@NAME@` is a placeholder, and this file is read as it is [write the value itself here, or check the file in which the tool has filled it in]
        queue: ${DEPTH}: SCL0131 `${DEPTH}` is a placeholder, and this file is read as it is [write the value itself here, or check the file in which the tool has filled it in]
        queue: $(arg depth): SCL0131 `$(arg depth)` is a placeholder, and this file is read as it is [write the value itself here, or check the file in which the tool has filled it in]; SCL0131 `$(arg depth)` is a placeholder, and this file is read as it is [write the value itself here, or check the file in which the tool has filled it in]
        [sensor.value, #user: SCL0102 this `#` starts a comment, so `]` behind it closes nothing [if `user.value` belongs to the list, remove `#`]
        [&sensor.value: SCL0111 `&` before a name is not supported in a topology [write `sensor.value`, without `&`]
        connections:\n  - [sensor.value[0], user.value]\n: SCL0131 `value[0]` is not a name: names have no brackets [write `value0` | write `value_0` | write `value-0`]
    "#]].assert_eq(&all(&[
        ("connections:", "[connections]"),
        ("connections:", "[links]"),
        ("queue: 1}", "queue: 1}  % newest"),
        ("[sensor.value,", "[[sensor.value](http://sensor.value),"),
        ("[sensor.", "[sensor[0]."),
        ("A.V", "float64[6]"),
        ("{pub: A.V}", "pub: A.V"),
        ("{pub: A.V}", "{rep: A: B}"),
        ("system: rover", "system: @NAME@"),
        ("queue: 1", "queue: ${DEPTH}"),
        ("queue: 1", "queue: $(arg depth)"),
        ("[sensor.value, user", "[sensor.value, #user"),
        ("[sensor.value", "[&sensor.value"),
        ("connections:\n", "connections:\n  - [sensor.value[0], user.value]\n"),
    ]));
}

#[test]
fn lines_of_a_text() {
    expect![[r#"
        |\n    Reads the bus: often.\n    And more.: SCL0105 the lines of a text are indented deeper than its key [!indent lines 5 and 6 by 6 spaces]
        > Reads the bus.\n      And more.: SCL0130 after `>`, a text begins on the next line [remove `>` | end the line after `doc: >`, and write the text below it]
        Reads the bus.\n    And more.: SCL0125 this line is neither a key nor a list item [if it belongs to the text above, indent it by 6 spaces | if it is a comment, write `# And more.`]
        \"C:\\Users\\rover\": SCL0130 `\U` in double quotes starts an escape [!write `'C:\Users\rover'`: in single quotes, a backslash has no meaning]
          this is the user\n  - name: user: SCL0125 this line is neither a key nor a list item [if it is a comment, write `# this is the user`]
        and the rest\nconnections:: SCL0125 this line is neither a key nor a list item [if it is a comment, write `# and the rest`]
        34    Rovers and more\nconnections:: SCL0125 this line is neither a key nor a list item [if it is a comment, write `# 34    Rovers and more`]
        doc：Reads: SCL0127 `：` (U+FF1A) is a fullwidth colon, not `:` [!write `doc: Reads the bus.`]
        “Bus: reads it.”: SCL0130 a text with `: ` in it needs quotes [!put the whole text in quotes: `doc: "Bus: reads it."`]
        components:\n  (* the bus *)\n: SCL0131 `(*` starts a comment in Structured Text and Pascal; in YAML, `#` does [!write `# the bus`]
              - value: {pub: A.V}\n    gates:\n: SCL0105 this list belongs to no key [move it below `gates:`]
    "#]].assert_eq(&all(&[
        ("Reads the bus.", "|\n    Reads the bus: often.\n    And more."),
        ("Reads the bus.", "> Reads the bus.\n      And more."),
        ("Reads the bus.", "Reads the bus.\n    And more."),
        ("rover", "\"C:\\Users\\rover\""),
        ("  - name: user", "  this is the user\n  - name: user"),
        ("connections:", "and the rest\nconnections:"),
        ("connections:", "34    Rovers and more\nconnections:"),
        ("doc: Reads", "doc：Reads"),
        ("Reads the bus.", "“Bus: reads it.”"),
        ("components:\n", "components:\n  (* the bus *)\n"),
        ("    gates:\n      - value: {pub: A.V}\n", "      - value: {pub: A.V}\n    gates:\n"),
    ]));
}

#[test]
fn elements_of_arrays() {
    let array = SOUND.replace("- state: {pub: A.S}", "- phase[2]: {pub: A.S}");
    let used = array.replace("sensor.state", "sensor.phase[1]");
    let outside = array.replace("sensor.state", "sensor.phase[2]");
    expect![[r#"
        SCL0131 `phase[2]` is not a name: names have no brackets [declare each of them, and use these names: `phase_0`, `phase_1` | write `phase2`, and the same on line 14 | write `phase_2`, and the same on line 14 | write `phase-2`, and the same on line 14]
        SCL0131 `phase[2]` is not a name: names have no brackets [write `phase2`, and the same on line 14 | write `phase_2`, and the same on line 14 | write `phase-2`, and the same on line 14]
    "#]].assert_eq(&[used, outside].map(|text| format!("{}\n", advice(&text))).concat());
}

#[test]
fn no_indentation() {
    let flat: String = SOUND.lines().map(|line| format!("{}\n", line.trim_start())).collect();
    expect![[r#"
        SCL0105 no line of this file is indented [!indent `doc` by 4 spaces and the gates by 6, and the same in all components]
    "#]].assert_eq(&format!("{}\n", advice(&flat)));
}

#[test]
fn one_end_in_each_line() {
    let split = "- sensor.value\n  - user.value\n\n  - sensor.state\n  - user.state";
    expect![[r#"
        - sensor.value\n  - user.value\n\n  - sensor.state\n  - user.state: SCL0211 the two ends of a connection stand in one entry [write `- [sensor.value, user.value]`, and join the other entries two by two in the same way]
        - sensor.value\n  - user.value: SCL0211 the two ends of a connection stand in one entry [write `- [sensor.value, user.value]`]
        - sensor.value: SCL0211 a connection joins exactly two gates; this one is text [the gate at the other end is missing: a connection is written `[sensor.value, component.gate]`]
    "#]].assert_eq(&all(&[
        ("- [sensor.value, user.value]\n  - [sensor.state, user.state]", split),
        ("- [sensor.value, user.value]\n  - [sensor.state, user.state]", "- sensor.value\n  - user.value"),
        ("- [sensor.value, user.value]", "- sensor.value"),
    ]));
}

#[test]
fn a_second_document() {
    let second = "---\ncomponents:\n  - name: b\n    gates: []\nconnections:\n  - [a.x, b.x]\n";
    let found = advice(&format!("{SOUND}{second}"));
    expect!["SCL0114 a topology is one YAML document; a second one starts here [remove the `---` line, and move the entries of `components` and `connections` below it to those above]"].assert_eq(&found);
}
