//! Launch files in, exact unit files out.

use super::text::{duration, quoted};
use super::{UnitOptions, systemd_units};
use crate::system_names::tests::rover;
use crate::{Options, SystemNames};
use expect_test::expect;
use scl_plan::Assignment;
use std::time::Duration;

const LAUNCH: &str = "\
components:
  sensor:
    command: [/bin/cat, --rate, '100 %', '$HOME']
    restart: on_failure
    restart_delay: 200ms..5s
    ready_within: 5s
    alive_within: 500ms
    cpu: [2, 3]
    priority: fifo:80
    descriptors: 4096
  logger: {command: cat > log, working_directory: logs, environment: {NAME: a \"b\" 5%}}
environment: {RUST_LOG: info}
defaults: {stop_within: 3s}
";

/// All unit files of the launch file, one after the other; the folder of the test is shown as `FOLDER`.
fn units(launch: &str, user: Option<&str>) -> String {
    units_of(launch, user, &[])
}

/// As [`units`], of a system with kinds.
fn units_of(launch: &str, user: Option<&str>, kinds: &[(&str, &[&str])]) -> String {
    let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<String>>();
    let names = SystemNames {
        system: "rover".to_owned(),
        is_named: true,
        components: [owned(&["sensor", "logger"]), kinds.iter().flat_map(|(_, names)| owned(names)).collect()].concat(),
        kinds: kinds.iter().map(|(kind, components)| ((*kind).to_owned(), owned(components))).collect(),
        ..SystemNames::default()
    };
    units_with(launch, user, &names, &[])
}

/// As [`units`], of a system with these names, and with values of parameters.
fn units_with(launch: &str, user: Option<&str>, names: &SystemNames, set: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().canonicalize().unwrap();
    std::fs::create_dir(path.join("logs")).unwrap();
    std::fs::write(path.join("launch.yaml"), launch).unwrap();
    std::fs::write(path.join("topology.yaml"), "").unwrap();
    let set = set.iter().map(|text| Assignment::parse(text).unwrap()).collect();
    let run = Options { folder: path.clone(), grace: Duration::from_secs(5), set, ..Options::default() };
    let options = UnitOptions { run, user: user.map(str::to_owned) };
    let units = systemd_units(&options, &|_| Some(names.clone())).unwrap();
    let text: String = units.iter().map(|unit| format!("== {}\n{}", unit.name, unit.text)).collect();
    text.replace(path.to_str().unwrap(), "FOLDER")
}

#[test]
fn services_do_what_the_launch_file_says() {
    expect![[r#"
        == rover-sensor.service
        # Written by `scl deploy systemd`.
        [Unit]
        Description=Component sensor of rover
        StartLimitIntervalSec=60s
        StartLimitBurst=6
        PartOf=rover.target

        [Service]
        Type=notify
        TimeoutStartSec=5s
        WatchdogSec=500ms
        Restart=on-failure
        RestartSec=200ms
        CPUAffinity=2 3
        LimitNOFILE=4096
        CPUSchedulingPolicy=fifo
        CPUSchedulingPriority=80
        LimitRTPRIO=80
        LimitMEMLOCK=infinity
        Environment=SCL_SCHED=fifo:80
        NotifyAccess=all
        User=rover
        RuntimeDirectory=rover
        RuntimeDirectoryMode=0700
        RuntimeDirectoryPreserve=yes
        WorkingDirectory=FOLDER
        Environment=SCL_RUNTIME_DIR=/run/rover
        Environment=SCL_SYSTEM=rover
        Environment=SCL_COMPONENT=rover.sensor
        Environment=RUST_LOG=info
        ExecStart=/bin/cat --rate "100 %%" "$$HOME"
        TimeoutStopSec=3s
        == rover-logger.service
        # Written by `scl deploy systemd`.
        [Unit]
        Description=Component logger of rover
        PartOf=rover.target

        [Service]
        Type=exec
        Restart=no
        NotifyAccess=all
        User=rover
        RuntimeDirectory=rover
        RuntimeDirectoryMode=0700
        RuntimeDirectoryPreserve=yes
        WorkingDirectory=FOLDER/logs
        Environment=SCL_RUNTIME_DIR=/run/rover
        Environment=SCL_SYSTEM=rover
        Environment=SCL_COMPONENT=rover.logger
        Environment=RUST_LOG=info
        Environment="NAME=a \"b\" 5%%"
        ExecStart=/bin/sh -c "cat > log"
        TimeoutStopSec=3s
        == rover.target
        # Written by `scl deploy systemd`.
        [Unit]
        Description=System rover
        Wants=rover-sensor.service
        Wants=rover-logger.service

        [Install]
        WantedBy=multi-user.target
    "#]]
    .assert_eq(&units(LAUNCH, Some("rover")));
}

#[test]
fn components_of_a_kind_have_a_template() {
    let launch = "\
components:
  sensor: /bin/cat
  motor: {command: /bin/cat %i, environment: {SPEED: 5%}}
  back: {command: /bin/cat, restart: always}
";
    let launch = launch.replace("sensor: /bin/cat", "sensor: {command: /bin/cat}");
    let kinds: &[(&str, &[&str])] = &[("motor", &["left", "back", "arm.right"])];
    expect![[r#"
        == rover-sensor.service
        # Written by `scl deploy systemd`.
        [Unit]
        Description=Component sensor of rover
        PartOf=rover.target

        [Service]
        Type=exec
        Restart=no
        NotifyAccess=all
        RuntimeDirectory=rover
        RuntimeDirectoryMode=0700
        RuntimeDirectoryPreserve=yes
        WorkingDirectory=FOLDER
        Environment=SCL_RUNTIME_DIR=/run/rover
        Environment=SCL_SYSTEM=rover
        Environment=SCL_COMPONENT=rover.sensor
        ExecStart=/bin/cat
        TimeoutStopSec=5s
        == rover-motor@.service
        # Written by `scl deploy systemd`.
        [Unit]
        Description=Component %i of rover
        PartOf=rover.target

        [Service]
        Type=exec
        Restart=no
        NotifyAccess=all
        RuntimeDirectory=rover
        RuntimeDirectoryMode=0700
        RuntimeDirectoryPreserve=yes
        WorkingDirectory=FOLDER
        Environment=SCL_RUNTIME_DIR=/run/rover
        Environment=SCL_SYSTEM=rover
        Environment=SCL_COMPONENT=rover.%i
        Environment="SPEED=5%%"
        ExecStart=/bin/cat "%%i"
        TimeoutStopSec=5s
        == rover-back.service
        # Written by `scl deploy systemd`.
        [Unit]
        Description=Component back of rover
        StartLimitIntervalSec=60s
        StartLimitBurst=6
        PartOf=rover.target

        [Service]
        Type=exec
        Restart=always
        RestartSec=100ms
        NotifyAccess=all
        RuntimeDirectory=rover
        RuntimeDirectoryMode=0700
        RuntimeDirectoryPreserve=yes
        WorkingDirectory=FOLDER
        Environment=SCL_RUNTIME_DIR=/run/rover
        Environment=SCL_SYSTEM=rover
        Environment=SCL_COMPONENT=rover.back
        Environment="SPEED=5%%"
        ExecStart=/bin/cat
        TimeoutStopSec=5s
        == rover.target
        # Written by `scl deploy systemd`.
        [Unit]
        Description=System rover
        Wants=rover-sensor.service
        Wants=rover-motor@left.service
        Wants=rover-back.service
        Wants=rover-motor@arm.right.service

        [Install]
        WantedBy=multi-user.target
    "#]]
    .assert_eq(&units_of(&launch, None, kinds));
}

#[test]
fn services_get_the_values_of_parameters() {
    let launch = "\
components:
  sensor: {command: /bin/cat}
  motor: {command: /bin/cat, parameters: {pin: 1}}
  right_motor: {parameters: {name: 'at 5%, \"slow\"'}}
  controller: {command: /bin/cat, opens: [sensor]}
";
    let units = units_with(launch, None, &rover(), &["controller.gain=2", "controller.offsets=[1, 2, 3]"]);
    let is_shown = |line: &&str| line.starts_with("== ") || line.contains("SCL_SET");
    let shown: String = units.lines().filter(is_shown).map(|line| format!("{line}\n")).collect();
    expect![[r#"
        == rover-sensor.service
        == rover-motor@.service
        Environment="SCL_SET=left_motor.pin=1,right_motor.pin=1,right_motor.name=\"at 5%%, \\\"slow\\\"\""
        == rover-controller.service
        Environment="SCL_SET=controller.gain=2,controller.offsets=[1, 2, 3]"
        == rover.target
    "#]]
    .assert_eq(&shown);
}

#[test]
fn a_program_that_is_not_told_its_component_has_a_file_of_its_own() {
    let launch = "\
components:
  left: {command: /bin/cat}
  right: {command: /bin/cat, opens: [sensor]}
  back: {command: /bin/cat, opens: any}
  front: {replay: launch.yaml}
";
    let kinds: &[(&str, &[&str])] = &[("motor", &["left", "right", "back", "front"])];
    let units = units_of(launch, None, kinds);
    let names: Vec<&str> = units.lines().filter_map(|line| line.strip_prefix("== ")).collect();
    let expected = ["motor@", "right", "back", "front"].map(|name| format!("rover-{name}.service"));
    assert_eq!(names, [&expected[..], &["rover.target".to_owned()]].concat());
}

#[test]
fn words_are_read_as_they_were_written() {
    for (word, in_command, expected) in [
        ("--rate=100", true, "--rate=100"),
        ("", true, "\"\""),
        ("a b", true, "\"a b\""),
        ("$A 5% \"\\\n", true, r#""$$A 5%% \"\\\x0a""#),
        ("A=$B", false, "\"A=$B\""),
        ("'", true, "\"'\""),
        ("\u{e9}", true, "\"\u{e9}\""),
    ] {
        assert_eq!(quoted(word, in_command), expected, "{word:?}");
    }
}

#[test]
fn times_have_a_unit() {
    let micros = Duration::from_micros;
    let cases = [(0, "0s"), (1, "1us"), (1_000, "1ms"), (1_500_000, "1500ms"), (60_000_000, "60s")];
    for (time, expected) in cases {
        assert_eq!(duration(micros(time)), expected);
    }
}
