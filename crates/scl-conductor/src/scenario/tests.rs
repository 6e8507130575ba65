use super::*;
use crate::faults::Effect;
use crate::random::Between;
use scl_loader::{Request, load_bytes};

const TOPOLOGY: &str = "\
system: rover
schemas: [rover.proto]
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement}
      - raw: pub
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement}
      - commands: {rep: rover.Measurement -> rover.Measurement}
  - name: logger
    gates:
      - raw: sub
  - name: operator
    gates:
      - commands: {req: rover.Measurement -> rover.Measurement}
connections:
  - [operator.commands, controller.commands]
  - [sensor.measurements, controller.sensor]
  - [sensor.raw, logger.raw]
";
const PROTO: &str = "\
syntax = \"proto3\";
package rover;
message Measurement { double speed = 1; bool fault = 2; }
";

fn read(text: &str) -> Result<Scenario, Vec<String>> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("rover.proto"), PROTO).unwrap();
    let loaded = load_bytes(&Request::new(folder.path().join("topology.yaml")), TOPOLOGY.into());
    let system = loaded.system_plan().unwrap();
    let shown = |problems: Vec<Problem>| problems.iter().map(Problem::to_string).collect();
    Scenario::read("rough.yaml", text, &system).map_err(shown)
}

#[test]
fn a_scenario_says_what_goes_wrong_and_what_must_hold() {
    let scenario = read(
        "\
until: 2min
delays: {sensor.*: 1ms, sensor.measurements: 80ms..120ms}
takes: {controller: 2ms..30ms, logger: 1ms}
faults:
  - {at: 12s, kill: controller}
  - {every: 5s..20s, from: 10s, kill: any, except: [sensor]}
  - {at: 40s..41s, pause: [sensor, logger], for: 2s}
  - {at: 50s, cut: [controller.commands, logger], for: 500ms}
expect:
  - {always: sensor.measurements, where: 'speed < 1.5'}
  - {eventually: sensor.measurements, where: 'fault', by: 110s}
  - {exit: controller, code: 0}
",
    );
    let scenario = scenario.unwrap();
    assert_eq!(scenario.until, Some(Duration::from_secs(120)));
    let ms = Duration::from_millis;
    let takes = |component: &str, least, most| (component.to_owned(), Between { least: ms(least), most: ms(most) });
    assert_eq!(scenario.takes, [takes("controller", 2, 30), takes("logger", 1, 1)]);
    assert_eq!(scenario.expectations.len(), 3);
    assert_eq!(scenario.expectations[1].place, "rough.yaml:11:5");
    let faults = scenario.faults(1, scenario.until).unwrap();
    assert!(faults.iter().all(|fault| fault.effect != Effect::Kill || fault.target != "sensor"), "{faults:?}");
    assert_eq!(faults.iter().filter(|fault| fault.effect == Effect::Pause(Duration::from_secs(2))).count(), 2);
    let cut = |target: &str| faults.iter().any(|it| it.target == target && it.effect == Effect::Cut(ms(500)));
    assert!(cut("controller.commands") && cut("logger"), "{faults:?}");
    let late = Between { least: ms(80), most: ms(120) };
    let routes = |component: &str| -> Vec<[Between; 2]> {
        scenario.routes.iter().filter(|route| route.component == component).map(|route| route.delays).collect()
    };
    assert_eq!(routes("controller"), [[Between::default(), late]]);
    assert_eq!(routes("logger"), [[Between::default(), Between { least: ms(1), most: ms(1) }]]);
    assert_eq!(routes("operator"), [[Between::default(); 2]], "nothing but a cut");
    let endless = scenario.faults(1, None).unwrap_err();
    assert_eq!(endless.message(), "faults come again and again, but the simulation has no end");
}

#[test]
fn every_mistake_is_told_with_its_place_and_what_to_write() {
    let cases = [
        ("util: 5s", "unknown key `util` in a scenario", "1:1", "did you mean `until`?"),
        ("until: 5", "the unit is missing", "1:8", "write a number and a unit: `80ms`, `1.5s`"),
        ("until: [5s]", "it is no time", "1:8", "write a number and a unit"),
        ("- 5s", "a scenario is a mapping", "1:1", "write the keys `until`, `delays`, `takes`, `faults`, `expect`"),
        ("until: 5s\nuntil: 6s", "`until` occurs twice in a scenario", "2:1", ""),
        ("takes: {control: 5ms}", "unknown component `control`", "1:9", "did you mean `controller`?"),
        ("takes: {controller: 5ms..2ms}", "`5ms..2ms` ends before it begins", "1:21", "write `2ms..5ms`"),
        ("takes: {controller: fast}", "expected a number and a unit", "1:21", "`80ms..120ms`"),
        ("takes: {logger: 1ms, logger: 2ms}", "`logger` occurs twice", "1:22", "keep one"),
        ("delays: {sensor: 5ms}", "`sensor` is no gate", "1:10", "`component.gate`, or all of a component as"),
        ("delays: {sensr.raw: 5ms}", "unknown component `sensr`", "1:10", "did you mean `sensor`?"),
        ("delays: {sensor.row: 5ms}", "unknown gate `sensor.row`", "1:10", "did you mean `sensor.raw`?"),
        ("delays: {logger.raw: 5ms}", "`logger.raw` sends nothing", "1:10", "that send to it: `sensor.raw`"),
        ("delays: {logger.*: 5ms}", "`logger` sends nothing", "1:10", "name the gates that send to it"),
        ("delays: {sensor.raw: 5}", "the unit is missing", "1:22", "`80ms..120ms`"),
        ("delays: [sensor.raw]", "`delays` is a mapping", "1:9", "`{sensor.values: 80ms..120ms}`"),
        ("faults:\n  - {at: 5s, cut: sensor}", "a cut has no end", "2:5", "`for: 2s`"),
        ("faults:\n  - {at: 5s, cut: sensor.row, for: 1s}", "unknown gate `sensor.row`", "2:19", "`sensor.raw`?"),
        ("faults:\n  - {at: 5s, kill: sensor.raw}", "unknown component `sensor.raw`", "2:20", ""),
        ("takes: 5ms", "`takes` is a mapping", "1:8", "`{controller: 2ms..5ms}`"),
        ("faults: {at: 5s}", "`faults` is a list", "1:9", "begin each item with `- `"),
        ("faults:\n  - {at: 5s}", "a fault has one of `kill`, `pause`, `cut`, and this one has none", "2:5", ""),
        ("faults:\n  - {kill: sensor}", "a fault has one of `at`, `every`, and this one has none", "2:5", ""),
        ("faults:\n  - {at: 5s, every: 6s, kill: sensor}", "this one has several", "2:5", ""),
        ("faults:\n  - {at: 5s, kill: any, except: [sensr]}", "unknown component `sensr`", "2:34", "`sensor`?"),
        ("faults:\n  - {at: 5s, kill: sensor, except: [logger]}", "`except` has an effect only with `any`", "2:", ""),
        (
            "faults:\n  - {at: 5s, kill: any, except: [sensor, controller, logger, operator]}",
            "leaves no component",
            "2:5",
            "",
        ),
        ("faults:\n  - {at: 5s, pause: sensor}", "a pause has no end", "2:5", "`for: 2s`"),
        ("faults:\n  - {at: 5s, kill: sensor, for: 2s}", "`for` has no effect without `pause` or `cut`", "2:5", ""),
        ("faults:\n  - {at: 5s, kill: sensor, from: 2s}", "`from` has no effect without `every`", "2:5", ""),
        ("faults:\n  - {every: 0s, kill: sensor}", "a fault cannot happen all the time", "2:13", "`every: 5s..20s`"),
        ("faults:\n  - {at: 5s, crash: sensor}", "unknown key `crash` in a fault", "2:14", ""),
        ("expect:\n  - {always: sensor.measurements}", "a condition is missing", "2:5", "`where: 'speed > 1.5'`"),
        (
            "expect:\n  - {always: sensor.measurement, where: 'speed < 1'}",
            "`sensor.measurement` is no gate whose messages are seen",
            "2:14",
            "did you mean `sensor.measurements`?",
        ),
        (
            "expect:\n  - {always: controller.commands, where: 'speed < 1'}",
            "`controller.commands` is no gate whose messages are seen",
            "2:14",
            "`sensor.measurements`",
        ),
        ("expect:\n  - {always: sensor.measurements, where: 'spede < 1'}", "`spede`", "2:42", "`speed`"),
        ("expect:\n  - {always: sensor.measurements, where: 'speed <'}", "is not a condition", "2:42", "`speed > 1.5`"),
        ("expect:\n  - {always: sensor.measurements, where: fault, by: 5s}", "`by` has no effect without", "2:5", ""),
        ("expect:\n  - {exit: controller}", "an exit code is a number from 0 to 255", "2:5", "`code: 0`"),
        ("expect:\n  - {exit: controller, code: -1}", "an exit code is a number from 0 to 255", "2:30", "`code: 0`"),
        ("expect:\n  - {exit: controler, code: 0}", "unknown component `controler`", "2:12", "`controller`?"),
        ("faults: [", "", "1:", ""),
        ("", "the scenario is empty", "1:1", "until: 1min"),
    ];
    for (text, message, place, help) in cases {
        let problems = read(text).unwrap_err();
        let [problem] = problems.as_slice() else { panic!("{text}: {problems:?}") };
        assert!(problem.contains(message), "{text}: {problem}");
        assert!(problem.contains(&format!(" --> rough.yaml:{place}")), "{text}: {problem}");
        assert!(problem.contains(help), "{text}: {problem}");
    }
}
