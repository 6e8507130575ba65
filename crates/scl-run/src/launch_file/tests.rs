//! What becomes of good launch files, and that no text at all is too bad. The words are tested with the real command.

use super::super::policy::{Restart, RestartDelay, RestartLimit};
use super::super::system_names::SystemNames;
use super::super::system_names::tests::rover;
use super::super::terminal::StandardInput;
use super::keys::{self, Key};
use super::{EXAMPLE, LAUNCH_RULES, LaunchComponent, LaunchDocument, LaunchFile, Settings, Source};
use scl_terminal::Problem;
use std::time::Duration;

fn parse_launch_file(text: &str, known: Option<&SystemNames>) -> Result<LaunchFile, Vec<Problem>> {
    LaunchDocument::parse("launch.yaml", text).read_shown(known)
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
    working_directory: control
profiles:
  python:
    controller: {command: [python3, controller.py], environment: {GAIN: 2}}
    display: {command: ./display}
  debug:
    controller: {build: make debug, working_directory: debug, environment: {LOG: all}}
topology: ../topology.yaml
transports: {sensor.images: shm}
";

fn components(names: &[&str]) -> SystemNames {
    SystemNames { components: words(names), gates: words(&["sensor.images"]), ..SystemNames::default() }
}

fn pairs(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

fn command(line: &[&str]) -> Source {
    Source::Command(words(line))
}

fn in_folder(folder: &str) -> Settings {
    Settings { working_directory: Some(folder.to_owned()), ..Settings::default() }
}

fn sensor() -> LaunchComponent {
    LaunchComponent {
        name: "sensor".to_owned(),
        build: Some(words(&["make", "-j", "2"])),
        source: command(&["./sensor", "--rate", "100", "0.5", "true", "1.10"]),
        ..LaunchComponent::default()
    }
}

fn controller() -> LaunchComponent {
    LaunchComponent {
        name: "controller".to_owned(),
        source: command(&["/bin/sh", "-c", "./controller 2>> log"]),
        environment: pairs(&[("GAIN", "0.50")]),
        settings: in_folder("control"),
        ..LaunchComponent::default()
    }
}

fn without_places(components: &[LaunchComponent]) -> Vec<LaunchComponent> {
    components.iter().map(|component| LaunchComponent { place: String::new(), ..component.clone() }).collect()
}

#[test]
fn an_entry_may_name_the_components_that_its_program_opens() {
    let text = "components:
  a: {command: ./a}
  b: {command: ./b, opens: [a, c]}
  c: {command: ./c, opens: any}
profiles:
  replayed: {a: {replay: a.mcap}, b: {command: ./other}}
";
    let file = parse_launch_file(text, None).unwrap();
    let expected = |profiles: &[&str], topology| {
        let components = file.components_with(&words(profiles)).unwrap();
        components.iter().map(|component| component.expected(topology)).collect::<Vec<_>>()
    };
    let some = |text: &str| Some(text.to_owned());
    assert_eq!(expected(&[], Some("rover")), [some("rover.a"), some("rover.b,rover.a,rover.c"), None]);
    assert_eq!(expected(&[], None), [some("a"), some("b,a,c"), None]);
    assert_eq!(expected(&["replayed"], Some("rover")), [None, some("rover.b"), None]);
}

#[test]
fn a_good_file_keeps_its_order_and_its_values() {
    let known = components(&["sensor", "controller", "display", "other"]);
    for text in [GOOD.to_owned(), GOOD.replace('\n', "\r\n"), format!("\u{feff}{GOOD}")] {
        let file = parse_launch_file(&text, Some(&known)).unwrap();
        assert_eq!(without_places(&file.components), [sensor(), controller()]);
        assert_eq!(file.components[1].place, "launch.yaml:9:3");
        assert_eq!(file.build, Some(words(&["make", "all"])));
        assert_eq!(file.environment, pairs(&[("RUST_LOG", "info"), ("LEVEL", "2")]));
        assert_eq!(file.transports.variable(Some("tcp")).as_deref(), Some("ipc,sensor.images=shm"));
    }
}

#[test]
fn the_topology_is_named_with_its_place() {
    let document = LaunchDocument::parse("launch.yaml", GOOD);
    assert_eq!(document.topology_with_place(), Some(("../topology.yaml", "launch.yaml:20:11".to_owned())));
}

#[test]
fn a_profile_replaces_programs_or_changes_keys_and_later_ones_win() {
    let file = parse_launch_file(GOOD, None).unwrap();
    let running = |line: &[&str]| LaunchComponent { source: command(line), ..controller() };
    let environment = |more: &[(&str, &str)]| [pairs(&[("GAIN", "0.50")]), pairs(more)].concat();
    let display = || LaunchComponent {
        name: "display".to_owned(),
        source: command(&["./display"]),
        ..LaunchComponent::default()
    };
    let python = ["python3", "controller.py"];
    let debug_build = Some(words(&["make", "debug"]));
    let cases: [(&[&str], Vec<LaunchComponent>); 4] = [
        (&[], vec![sensor(), controller()]),
        (
            &["python"],
            vec![
                sensor(),
                LaunchComponent {
                    settings: Settings::default(),
                    environment: environment(&[("GAIN", "2")]),
                    ..running(&python)
                },
                display(),
            ],
        ),
        (
            &["debug"],
            vec![
                sensor(),
                LaunchComponent {
                    build: debug_build.clone(),
                    settings: in_folder("debug"),
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
                    settings: in_folder("debug"),
                    environment: environment(&[("GAIN", "2"), ("LOG", "all")]),
                    ..running(&python)
                },
                display(),
            ],
        ),
    ];
    for (profiles, expected) in cases {
        let found = file.components_with(&words(profiles)).map(|found| without_places(&found));
        assert_eq!(found, Ok(expected), "{profiles:?}");
    }
}

#[test]
fn transports_become_one_variable() {
    let both = "transport: ipc\ntransports: {camera.frames: shm, logger.frames: tcp}\n";
    let single = "transports: {camera.frames: shm}\n";
    let cases = [
        ("", None, None),
        ("", Some("tcp"), None),
        ("transport: shm\n", None, Some("shm")),
        ("transport: shm\n", Some("tcp,a.b=ipc"), Some("shm")),
        (both, Some("tcp"), Some("ipc,camera.frames=shm,logger.frames=tcp")),
        (single, None, Some("camera.frames=shm")),
        (single, Some(""), Some("camera.frames=shm")),
        (single, Some("tcp,camera.frames=ipc"), Some("tcp,camera.frames=ipc,camera.frames=shm")),
    ];
    for (text, inherited, expected) in cases {
        let file = parse_launch_file(&format!("{text}components: {{a: {{command: ls}}}}"), None).unwrap();
        assert_eq!(file.transports.variable(inherited).as_deref(), expected, "{text} {inherited:?}");
    }
}

fn row(Key { name, form, default, meaning, in_defaults, .. }: &Key) -> String {
    let mark = if *in_defaults { " *" } else { "" };
    format!("| `{name}`{mark} | {} | {default} | {meaning} |\n", form.description())
}

const SETTINGS: &str = "\
defaults: {restart: always, essential: false, stop_within: 3s, cpu: 1, descriptors: 2048, working_directory: below}
components:
  sensor:
    command: [./sensor]
    restart: on_failure
    restart_delay: 10ms..1m
    restart_limit: 3 in 1h
    essential: true
    stop_within: 0s
    ready_within: 5s
    alive_within: 500ms
    cpu: [2, 3]
    priority: fifo:80
    descriptors: 4096
    working_directory: .
  gps: {replay: flight.mcap, restart_delay: 1s}
profiles:
  sim:
    sensor: {command: ./sim, restart: never}
  flight:
    sensor: {replay: flight.mcap}
";

#[test]
fn settings_are_read_and_fall_back_to_the_defaults() {
    let file = parse_launch_file(SETTINGS, None).unwrap();
    let seconds = Duration::from_secs;
    let expected = Settings {
        restart: Some(Restart::OnFailure),
        restart_delay: Some(RestartDelay { first: Duration::from_millis(10), longest: seconds(60) }),
        restart_limit: Some(RestartLimit { count: 3, within: seconds(3600) }),
        essential: Some(true),
        stop_within: Some(Duration::ZERO),
        ready_within: Some(seconds(5)),
        alive_within: Some(Duration::from_millis(500)),
        cpu: Some(vec![2, 3]),
        priority: Some(80),
        descriptors: Some(4096),
        working_directory: Some(".".to_owned()),
    };
    assert_eq!(file.components[0].settings, expected);
    assert_eq!(file.components[0].settings.clone().over(&file.defaults), expected);
    let gps = file.components[1].settings.clone().over(&file.defaults);
    assert_eq!((gps.restart, gps.essential, gps.cpu.as_deref()), (Some(Restart::Always), Some(false), Some(&[1][..])));
    assert_eq!(gps.descriptors, Some(2048));
    assert_eq!(gps.restart_delay, Some(RestartDelay { first: seconds(1), longest: seconds(1) }));
    assert_eq!(gps.policy(seconds(7)).stop_within, seconds(3));
    assert_eq!(Settings::default().policy(seconds(7)).stop_within, seconds(7));
    let with = |profile: &str| file.components_with(&words(&[profile])).unwrap().remove(0);
    assert_eq!(
        with("sim").settings,
        Settings { restart: Some(Restart::Never), working_directory: None, ..expected.clone() }
    );
    assert_eq!(with("flight").source, Source::Replay("flight.mcap".to_owned()));
    assert_eq!(with("flight").settings.restart, Some(Restart::OnFailure));
}

/// What the table says of defaults is what the code does.
#[test]
fn the_defaults_of_the_table_are_those_of_the_policy() {
    let written = |key: &str| {
        let row = keys::COMPONENT.iter().find(|row| row.name == key).unwrap();
        row.default.trim_matches('`').to_owned()
    };
    let keys = ["restart", "restart_delay", "restart_limit", "essential"].map(|key| format!("{key}: {}", written(key)));
    let text = format!("components: {{a: {{command: ls, {}, stop_within: 5s}}}}", keys.join(", "));
    let file = parse_launch_file(&text, None).unwrap();
    let written = file.components[0].settings.policy(Duration::MAX);
    assert_eq!(written, super::super::policy::Policy::default());
    assert_eq!(super::super::policy::Policy::default().stop_within, Duration::from_secs(5));
}

/// The page has the tables of the keys as they are here, and all of its launch files can be used.
#[test]
fn the_reference_page_is_current() {
    let page = include_str!("../../../../docs/launch.md");
    for keys in [keys::TOP, keys::COMPONENT, keys::HOST, keys::GATEWAY] {
        let rows: String = keys.iter().map(row).collect();
        let table = format!("| key | value | default | meaning |\n|---|---|---|---|\n{rows}");
        assert!(page.contains(&table), "docs/launch.md lacks this table:\n{table}");
    }
    let codes: String = LAUNCH_RULES.iter().map(|rule| format!("| {} | {} |\n", rule.code, rule.title)).collect();
    assert!(page.contains(&format!("| code | mistake |\n|---|---|\n{codes}")), "docs/launch.md lacks:\n{codes}");
    assert!(page.contains(&format!("```yaml\n{EXAMPLE}```\n")), "docs/launch.md lacks the example:\n{EXAMPLE}");
    let blocks: Vec<&str> = page.split("```yaml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let motors = rover();
    for text in &blocks {
        let known = text.contains("left_motor").then_some(&motors);
        assert_eq!(parse_launch_file(text, known).err(), None, "{text}");
    }
    assert!(blocks.len() > 2);
}

#[test]
fn no_damaged_file_is_too_bad() {
    let known = components(&["sensor", "controller", "display"]);
    let parse = |text: &str| match parse_launch_file(text, Some(&known)) {
        Ok(file) => assert!(!file.components.is_empty(), "nothing to start in:\n{text}"),
        Err(problems) => assert!(!problems.is_empty(), "rejected without a reason:\n{text}"),
    };
    for (at, character) in GOOD.char_indices().step_by(3) {
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

#[test]
fn programs_get_what_is_written() {
    let scalars = "0x68, True, 1.10, 1234e56, 18446744073709551616, -170141183460469231731687303715884105729, 017, +5, .5, \
                   1_000, 2026-01-02, yes, .inf, 0o17, 1e3, '0x1', \"a b\"";
    let expected = "0x68 True 1.10 1234e56 18446744073709551616 -170141183460469231731687303715884105729 017 +5 .5 \
                    1_000 2026-01-02 yes .inf 0o17 1e3 0x1 a b";
    let names: Vec<String> = (0..17).map(|at| format!("V{at}")).collect();
    let variables: Vec<String> =
        names.iter().zip(scalars.split(", ")).map(|(name, scalar)| format!("{name}: {scalar}")).collect();
    let variables = variables.join(", ");
    let text = format!(
        "environment: {{{variables}, True: 1, 0x1: 2}}
build: &b [make, {scalars}]
components:
  command: {{command: [./a, {scalars}], environment: {{{variables}}}, build: *b, essential: True, cpu: 0o1}}
profiles:
  environment:
    command: {{command: [./b, {scalars}], environment: {{{variables}}}}}
"
    );
    let file = parse_launch_file(&text, None).unwrap();
    let values = |variables: &[(String, String)]| {
        variables.iter().take(17).map(|(_, value)| value.clone()).collect::<Vec<_>>().join(" ")
    };
    let arguments = |line: &[String]| line[1..].join(" ");
    assert_eq!(values(&file.environment), expected);
    assert_eq!(file.environment[17..], pairs(&[("True", "1"), ("0x1", "2")]));
    assert_eq!(file.build.as_deref().map(arguments).as_deref(), Some(expected));
    for profiles in [&[][..], &["environment"]] {
        let component = file.components_with(&words(profiles)).unwrap().remove(0);
        let Source::Command(line) = &component.source else { panic!("{:?}", component.source) };
        assert_eq!(arguments(line), expected, "{profiles:?}");
        assert_eq!(values(&component.environment), expected, "{profiles:?}");
        assert_eq!((component.settings.essential, component.settings.cpu), (Some(true), Some(vec![1])));
    }
}

#[test]
fn a_number_that_no_key_can_have_has_its_place() {
    let text = "components:\n  a: {command: ls, cpu: 18446744073709551616, restart_limit: 1234e56}\n";
    let problems = parse_launch_file(text, None).unwrap_err();
    let told: Vec<String> = problems.iter().map(ToString::to_string).collect();
    assert!(
        told.iter().any(|it| it.contains("not `18446744073709551616`") && it.contains("launch.yaml:2:25")),
        "{told:?}"
    );
}

#[test]
fn one_component_may_have_the_terminal() {
    let text = "components:
  a: {command: ./a, input: terminal}
  b: {command: ./b, input: empty}
profiles:
  both: {b: {input: terminal}}
  other: {a: {command: ./c}, b: {input: terminal}}
";
    let file = parse_launch_file(text, None).unwrap();
    let inputs = |profiles: &[&str]| {
        let found = file.components_with(&words(profiles));
        found.map(|found| found.iter().map(|component| component.input).collect::<Vec<_>>())
    };
    assert_eq!(inputs(&[]), Ok(vec![StandardInput::Terminal, StandardInput::Empty]));
    assert_eq!(inputs(&["other"]), Ok(vec![StandardInput::Empty, StandardInput::Terminal]));
    let problems = inputs(&["both"]).unwrap_err();
    let expected = "error: the components `a` and `b` both have `input: terminal`\n --> launch.yaml:3:3\n  = help: one \
                    component can read from the terminal: remove one of the two\n";
    assert_eq!(problems.iter().map(ToString::to_string).collect::<String>(), expected);
    let problems = parse_launch_file(&text.replace("empty", "termnal"), None).unwrap_err();
    assert!(problems[0].to_string().contains("did you mean `input: terminal`?"), "{}", problems[0]);
}
