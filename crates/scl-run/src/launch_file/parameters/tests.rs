//! Values of parameters in launch files, and what is told about those that a parameter cannot have.

use super::super::{LaunchDocument, LaunchTopology, check_launch_file};
use crate::system_names::SystemNames;
use crate::system_names::tests::rover;
use expect_test::{Expect, expect};
use scl_topology::advice::apply;
use scl_topology::diagnostic::{Diagnostic, render};
use scl_topology::source::Sources;

/// All problems of a text, as `scl check` shows them.
fn checked(text: &str) -> String {
    let mut sources = Sources::new();
    let file = sources.add("launch.yaml", text);
    let found = check_launch_file(&sources, file, |_| LaunchTopology::Names(rover())).diagnostics;
    found.iter().map(|problem| format!("{}\n", render(problem, &sources))).collect()
}

/// The values of each component, with these profiles.
fn values(text: &str, known: Option<&SystemNames>, profiles: &[&str]) -> String {
    let file = LaunchDocument::parse("launch.yaml", text).read_shown(known).expect("a file without mistakes");
    let profiles: Vec<String> = profiles.iter().map(|name| (*name).to_owned()).collect();
    let components = file.components_with(&profiles).expect("known profiles");
    let shown = components.iter().map(|component| {
        let values = component.parameters.iter().map(|(name, value)| format!(" {name}={value}"));
        format!("{}:{}\n", component.name, values.collect::<String>())
    });
    shown.collect()
}

/// Messages, labels and what each proposal makes of the value, for each value of a parameter of `controller`.
#[track_caller]
fn check_values(values: &[&str], expected: &Expect) {
    let told = values.iter().map(|value| {
        let text = format!(
            "components:\n  controller:\n    command: ./c\n    parameters:\n      {value}\n  motor: {{command: ./m, parameters: {{pin: 1}}}}\n"
        );
        let found = LaunchDocument::parse("launch.yaml", &text).check(Some(&rover())).1;
        let shown = |problem: &Diagnostic| {
            let label = problem.primary.as_ref().map_or("", |label| &label.text);
            let ways = problem.proposals().map(|way| {
                let changed = apply(&text, &way.edits.iter().collect::<Vec<_>>()).unwrap_or_default();
                let lines = changed.lines().filter(|line| !text.lines().any(|old| old == *line)).map(str::trim);
                format!("  {} {}\n", if way.is_sure { "=>" } else { "?>" }, lines.collect::<Vec<_>>().join(" | "))
            });
            let notes = problem.notes.iter().map(|note| format!("  ({note})\n"));
            format!("{} [{label}]\n{}", problem.message, ways.chain(notes).collect::<String>())
        };
        format!("# {value}\n{}", found.iter().map(shown).collect::<String>())
    });
    expected.assert_eq(&told.collect::<String>());
}

const GOOD: &str = "\
components:
  right_motor: {parameters: {pin: 2}}
  motor: {command: ./motor, parameters: {pin: 1, name: 0.50}}
  controller:
    command: ./controller
    parameters: {period: 5ms, gain: 1.5, offsets: [0, 0.1, 0], mode: auto}
profiles:
  slow:
    controller: {parameters: {period: 50ms, debug: true}}
    motor: {parameters: {name: 'a, b'}}
  replayed:
    left_motor: {replay: flight.mcap}
    controller: {command: ./other}
";

#[test]
fn values_of_kinds_components_and_profiles_are_added_and_the_last_counts() {
    expect![[r#"
        left_motor: pin=1 name=0.50
        right_motor: pin=1 name=0.50 pin=2
        controller: period=5ms gain=1.5 offsets=[0, 0.1, 0] mode=auto
    "#]]
    .assert_eq(&values(GOOD, Some(&rover()), &[]));
    expect![[r#"
        left_motor: pin=1 name=0.50 name=a, b
        right_motor: pin=1 name=0.50 pin=2 name=a, b
        controller: period=5ms gain=1.5 offsets=[0, 0.1, 0] mode=auto period=50ms debug=true
    "#]]
    .assert_eq(&values(GOOD, Some(&rover()), &["slow", "replayed"]));
}

#[test]
fn without_a_topology_values_are_taken_as_they_are_written() {
    let text = "components: {a: {command: ./a, parameters: {x: 0x10, y: [a, 'b, c', \"\"], z: {}}}}";
    let found = LaunchDocument::parse("launch.yaml", text).read(None).unwrap_err();
    let found: Vec<&str> = found.iter().map(|problem| problem.message.as_str()).collect();
    assert_eq!(found, ["parameter `a.z` is a text, a number or a list of them, not a mapping"]);
    expect![[r#"
        a: x=0x10 y=[a, "b, c", ""]
    "#]]
    .assert_eq(&values(&text.replace(", z: {}", ""), None, &[]));
}

#[test]
fn a_value_that_the_parameter_cannot_have_is_told_with_what_may_be_meant() {
    check_values(
        &[
            "period: 5",
            "period: 5 msec",
            "gain: fast",
            "gain: 11",
            "gain: 1_0",
            "gain: [1]",
            "count: 0x10",
            "count: 300",
            "count: 1.5",
            "debug: yes",
            "debug: True",
            "mode: atuo",
            "mode: AUTO",
            "mode: fast",
            "offsets: [0, 0]",
            "offsets: 0, 1, 2",
            "offsets: '[0, 1, 2]'",
            "offsets: 5",
            "offsets: [0, 0, x]",
            "offsets: [0, 0, 20]",
            "offsets: [[0, 0, 0]]",
            "offsets: [0, , 0]",
            "gain: {value: 1}",
            "gain:",
            "gain: ${GAIN}",
            "gian: 2",
            "speed: 2",
            "gain: 2\n      gain: 3",
        ],
        &expect![[r#"
            # period: 5
            parameter `controller.period` cannot have this value [the unit is missing: write `5s` or `5ms`]
              ?> period: 5s
              ?> period: 5ms
            # period: 5 msec
            parameter `controller.period` cannot have this value [unknown unit `msec`; the units are us, ms, s, min, m, h]
              ?> period: 5ms
            # gain: fast
            parameter `controller.gain` cannot have this value [expected a finite number, found `fast`]
            # gain: 11
            parameter `controller.gain` cannot have this value [`11` is not from 0 to 10]
            # gain: 1_0
            parameter `controller.gain` cannot have this value [expected a finite number, found `1_0`]
              ?> gain: 10
            # gain: [1]
            parameter `controller.gain` cannot have this value [expected one value, found a list]
            # count: 0x10
            parameter `controller.count` cannot have this value [expected a whole number from 0 to 255, found `0x10`]
              ?> count: 16
            # count: 300
            parameter `controller.count` cannot have this value [expected a whole number from 0 to 255, found `300`]
            # count: 1.5
            parameter `controller.count` cannot have this value [expected a whole number from 0 to 255, found `1.5`]
            # debug: yes
            parameter `controller.debug` cannot have this value [expected `true` or `false`, found `yes`]
              ?> debug: true
            # debug: True
            parameter `controller.debug` cannot have this value [expected `true` or `false`, found `True`]
              ?> debug: true
            # mode: atuo
            parameter `controller.mode` cannot have this value [expected `manual` or `auto`, found `atuo`]
              ?> mode: auto
            # mode: AUTO
            parameter `controller.mode` cannot have this value [expected `manual` or `auto`, found `AUTO`]
              ?> mode: auto
            # mode: fast
            parameter `controller.mode` cannot have this value [expected `manual` or `auto`, found `fast`]
            # offsets: [0, 0]
            parameter `controller.offsets` cannot have this value [expected 3 items, found 2]
            # offsets: 0, 1, 2
            parameter `controller.offsets` cannot have this value [a list is written in brackets: `[1, 2]`]
              ?> offsets: [0, 1, 2]
            # offsets: '[0, 1, 2]'
            parameter `controller.offsets` cannot have this value [a list is written in brackets: `[1, 2]`]
              ?> offsets: [0, 1, 2]
            # offsets: 5
            parameter `controller.offsets` cannot have this value [a list is written in brackets: `[1, 2]`]
            # offsets: [0, 0, x]
            parameter `controller.offsets` cannot have this value [expected a finite number, found `x`]
            # offsets: [0, 0, 20]
            parameter `controller.offsets` cannot have this value [`[0, 0, 20]` is not from -10 to 10]
            # offsets: [[0, 0, 0]]
            an item of parameter `controller.offsets` is a text or a number, not a list []
            # offsets: [0, , 0]
            `,` is not expected here [not expected]
            # gain: {value: 1}
            parameter `controller.gain` is a text, a number or a list of them, not a mapping []
            # gain:
            parameter `controller.gain` is a text, a number or a list of them, not nothing []
            # gain: ${GAIN}
            parameter `controller.gain` cannot have this value [expected a finite number, found `${GAIN}`]
              (placeholders of templates and of the shell are not replaced here)
            # gian: 2
            component `controller` has no parameter `gian` []
              => gain: 2
              (it has the parameters `period`, `gain`, `offsets`, `mode`, `debug`, `count`)
            # speed: 2
            component `controller` has no parameter `speed` []
              (it has the parameters `period`, `gain`, `offsets`, `mode`, `debug`, `count`)
            # gain: 2
                  gain: 3
            the key `gain` is written twice in `parameters` [second time]
              ?> 
              ?> 
              (YAML tools disagree which one wins: PyYAML silently keeps the second)
        "#]],
    );
}

#[test]
fn values_have_their_places() {
    let text = "\
components:
  controller:
    command: ./c
    parameters: {gain: 11, mode: atuo}
  sensor: {command: ./s, parameters: {rate: 5}}
  motor: {command: ./m, parameters: {pin: x, pim: 1}}
profiles:
  simulation:
    left_motor: {parameters: {pin: 256}}
";
    expect![[r#"
        error: [SCL1202] parameter `controller.gain` cannot have this value
         --> launch.yaml:4:24
          |
        4 |     parameters: {gain: 11, mode: atuo}
          |                        ^^ `11` is not from 0 to 10
        error: [SCL1202] parameter `controller.mode` cannot have this value
         --> launch.yaml:4:34
          |
        4 |     parameters: {gain: 11, mode: atuo}
          |                                  ^^^^ expected `manual` or `auto`, found `atuo`
          |
          = help: did you mean `mode: auto`?
        error: [SCL1205] component `sensor` has no parameters
         --> launch.yaml:5:26
          |
        5 |   sensor: {command: ./s, parameters: {rate: 5}}
          |                          ^^^^^^^^^^
          |
          = help: remove `parameters`
          = note: the topology declares the parameters of its components
        error: [SCL1202] parameter `motor.pin` cannot have this value
         --> launch.yaml:6:43
          |
        6 |   motor: {command: ./m, parameters: {pin: x, pim: 1}}
          |                                           ^ expected a whole number from 0 to 255, found `x`
        error: [SCL1205] kind `motor` has no parameter `pim`
         --> launch.yaml:6:46
          |
        6 |   motor: {command: ./m, parameters: {pin: x, pim: 1}}
          |                                              ^^^
          |
          = note: it has the parameters `pin`, `name`
        error: [SCL1202] parameter `left_motor.pin` cannot have this value
         --> launch.yaml:9:36
          |
        9 |     left_motor: {parameters: {pin: 256}}
          |                                    ^^^ expected a whole number from 0 to 255, found `256`
    "#]]
    .assert_eq(&checked(text));
}

#[test]
fn parameters_in_another_shape_or_place_are_written_as_they_belong() {
    let entry = |entry: &str| {
        let text = format!("components: {{motor: {{command: ./m, parameters: {{pin: 1}}}}, controller: {{{entry}}}}}");
        let found = LaunchDocument::parse("launch.yaml", &text).check(Some(&rover())).1;
        let told = found.iter().map(|problem| {
            let helps = problem.shown_helps().map(|help| format!("  {}\n", help.text()));
            format!("{}\n{}", problem.message, helps.collect::<String>())
        });
        format!("# {entry}\n{}", told.collect::<String>())
    };
    let all = [
        "command: ./c, parameters: [gain=2, mode=auto]",
        "command: ./c, parameters: [{gain: 2}]",
        "command: ./c, parameters: gain=2",
        "command: ./c, params: {gain: 2}",
        "command: ./c, paramters: {gain: 2}",
        "command: ./c, environment: {SCL_SET: controller.gain=2}",
        "command: ./c, config: c.yaml",
    ];
    expect![[r#"
        # command: ./c, parameters: [gain=2, mode=auto]
        `parameters` is a mapping, not a list
          write `parameters: {gain: 2, mode: auto}`
        # command: ./c, parameters: [{gain: 2}]
        `parameters` is a mapping, not a list
          write `parameters: {gain: 2}`
        # command: ./c, parameters: gain=2
        `parameters` is a mapping, not `gain=2`
          write `parameters: {gain: 2}`
        # command: ./c, params: {gain: 2}
        unknown key `params` in component `controller`
          did you mean `parameters`?
        # command: ./c, paramters: {gain: 2}
        unknown key `paramters` in component `controller`
          did you mean `parameters`?
        # command: ./c, environment: {SCL_SET: controller.gain=2}
        `SCL_SET` cannot be set here: `scl run` writes it
          write the values in the entry of the component: `parameters: {gain: 1.5}`
        # command: ./c, config: c.yaml
        unknown key `config` in component `controller`
    "#]]
    .assert_eq(&all.map(entry).concat());
}

#[test]
fn a_parameter_without_default_and_value_is_told_at_the_entry() {
    let texts = [
        "components: {motor: {command: ./m}}\n",
        "components: {motor: {command: ./m}, left_motor: {cpu: 1}}\n",
        "components: {motor: {command: ./m}, left_motor: {parameters: {pin: 1}}}\n",
        "components: {motor: {replay: flight.mcap}}\n",
        "components: {motor: {command: ./m}}\nprofiles: {real: {motor: {parameters: {pin: 3}}}}\n",
        "components: {motor: {replay: a.mcap}}\nprofiles: {real: {left_motor: {command: ./m}}}\n",
        "components: {motor: {command: ./m, parameters: {pni: 1}}}\n",
    ];
    expect![[r#"
        # components: {motor: {command: ./m}}
        warning: [SCL1211] parameter `pin` (u8) of `left_motor`, `right_motor` has no value
         --> launch.yaml:1:14
          |
        1 | components: {motor: {command: ./m}}
          |              ^^^^^
          |
          = help: add `parameters: {pin: ...}`
          = note: the topology declares it without a default
        # components: {motor: {command: ./m}, left_motor: {cpu: 1}}
        warning: [SCL1211] parameter `right_motor.pin` (u8) has no value
         --> launch.yaml:1:14
          |
        1 | components: {motor: {command: ./m}, left_motor: {cpu: 1}}
          |              ^^^^^
          |
          = help: add `parameters: {pin: ...}`
          = note: the topology declares it without a default
        warning: [SCL1211] parameter `left_motor.pin` (u8) has no value
         --> launch.yaml:1:37
          |
        1 | components: {motor: {command: ./m}, left_motor: {cpu: 1}}
          |                                     ^^^^^^^^^^
          |
          = help: add `parameters: {pin: ...}`
          = note: the topology declares it without a default
        # components: {motor: {command: ./m}, left_motor: {parameters: {pin: 1}}}
        warning: [SCL1211] parameter `right_motor.pin` (u8) has no value
         --> launch.yaml:1:14
          |
        1 | components: {motor: {command: ./m}, left_motor: {parameters: {pin: 1}}}
          |              ^^^^^
          |
          = help: add `parameters: {pin: ...}`
          = note: the topology declares it without a default
        # components: {motor: {replay: flight.mcap}}
        # components: {motor: {command: ./m}}
        profiles: {real: {motor: {parameters: {pin: 3}}}}
        # components: {motor: {replay: a.mcap}}
        profiles: {real: {left_motor: {command: ./m}}}
        warning: [SCL1211] parameter `left_motor.pin` (u8) has no value
         --> launch.yaml:1:14
          |
        1 | components: {motor: {replay: a.mcap}}
          |              ^^^^^
          |
          = help: add `parameters: {pin: ...}`
          = note: the topology declares it without a default
        # components: {motor: {command: ./m, parameters: {pni: 1}}}
        error: [SCL1205] kind `motor` has no parameter `pni`
         --> launch.yaml:1:49
          |
        1 | components: {motor: {command: ./m, parameters: {pni: 1}}}
          |                                                 ^^^
          |
          = help: did you mean `pin`?
          = note: it has the parameters `pin`, `name`
    "#]]
    .assert_eq(&texts.map(|text| format!("# {text}{}", checked(text))).concat());
}
