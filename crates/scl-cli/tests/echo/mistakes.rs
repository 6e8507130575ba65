//! Arguments that `scl echo` cannot use.

use super::*;

#[test]
fn mistakes_say_what_to_write() {
    let rover = Rover::start();
    let check = |arguments: &[&str], expected: Expect| {
        expected.assert_eq(&rover.error(&[&["echo"], arguments].concat(), 2));
    };
    check(
        &["sensor.measurement"],
        expect![[r#"
        error: component `sensor` has no gate `measurement`
          = help: did you mean `sensor.measurements`?
          = note: its gates: `sensor.measurements`, `sensor.position`, `sensor.image`, `sensor.log`
    "#]],
    );
    check(
        &["sensor.measurements", "--field", "sped"],
        expect![[r#"
        error: message `rover.Measurement` has no field `sped`
          = help: did you mean `speed`?
          = note: its fields: `speed`, `count`
    "#]],
    );
    check(
        &["sensor.measurements", "--field", "speed.x"],
        expect![[r#"
        error: `speed` is a number and has no fields
    "#]],
    );
    check(
        &["sensor.measurements", "--where", "sped > 1"],
        expect![[r#"
        error: message `rover.Measurement` has no field `sped`
          = help: did you mean `speed`?
          = note: its fields: `speed`, `count`
    "#]],
    );
    check(
        &["sensor.measurements", "--where", "count"],
        expect![[r#"
        error: `count` is a number, which is neither true nor false
          = help: compare it, for example `count > 0`
    "#]],
    );
    check(
        &["sensor.measurements", "--where", "speed > 'fast'"],
        expect![[r#"
        error: `speed` is a number, and `'fast'` is a text: they cannot be compared
          = help: put only texts in quotes
    "#]],
    );
    check(
        &["sensor.measurements", "--where", "speed >"],
        expect![[r#"
        error: invalid value 'speed >' for '--where <CONDITION>': `speed >` is not a condition: expected a field or a value at character 8

        For more information, try '--help'.
    "#]],
    );
    check(
        &["sensor.measurements", "--field", "a..b"],
        expect![[r#"
        error: invalid value 'a..b' for '--field <PATH>': `a..b` is not a field path: a name is expected before `.`

        For more information, try '--help'.
    "#]],
    );
    check(
        &["actuator.setpint"],
        expect![[r#"
        error: component `actuator` has no gate `setpint`
          = help: did you mean `setpoint`?
          = note: known in `topology.yaml`: `setpoint`
    "#]],
    );
}
