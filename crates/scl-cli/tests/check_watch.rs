//! `scl check --watch` on files that change, vanish and come back. The tests wait for its lines, never for a time.

use crate::system::{ChildGuard, SpawnGuarded, System, kill};
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{ChildStderr, ExitStatus, Stdio};

const CLEAN: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
";

/// A running `scl check --watch`.
struct Watch {
    process: ChildGuard,
    lines: BufReader<ChildStderr>,
}

impl Watch {
    fn start(system: &System, arguments: &[&str]) -> Self {
        let mut command = system.scl(&[&["check", "--watch"], arguments].concat());
        let mut process = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn_guarded();
        let lines = BufReader::new(process.stderr.take().unwrap());
        Self { process, lines }
    }

    /// What the next check says, without the lines around it.
    fn next_check(&mut self) -> String {
        let mut text = String::new();
        while !text.ends_with("scl: waiting for changes; press Ctrl-C to stop\n") {
            assert_ne!(self.lines.read_line(&mut text).unwrap(), 0, "ended after:\n{text}");
        }
        let text = text.trim_start().strip_prefix("scl: checking\n").unwrap();
        text.strip_suffix("scl: waiting for changes; press Ctrl-C to stop\n").unwrap().to_owned()
    }

    #[track_caller]
    fn says(&mut self, part: &str) {
        let text = self.next_check();
        assert!(text.contains(part), "does not say `{part}`:\n{text}");
    }

    fn stop(mut self, signal: &str) -> ExitStatus {
        kill(signal, self.process.id());
        self.process.wait().unwrap()
    }
}

/// Writes a file as a whole: on a busy machine it may take longer to write it in steps than it takes to be seen.
fn replace(system: &System, name: &str, text: &str) {
    system.write("new", text);
    fs::rename(system.path("new"), system.path(name)).unwrap();
}

#[test]
fn every_change_is_checked() {
    let system = System::of_files(&[("topology.yaml", CLEAN)]);
    let mut watch = Watch::start(&system, &[]);
    watch.says("2 components, 2 gates, 1 connection");
    replace(&system, "topology.yaml", "colour: red\n");
    watch.says("unknown section `colour`");
    fs::remove_file(system.path("topology.yaml")).unwrap();
    watch.says("cannot find the topology file");
    replace(&system, "topology.yaml", CLEAN);
    watch.says("2 components, 2 gates, 1 connection");
    assert_eq!(watch.stop("-INT").code(), Some(0));
}

#[test]
fn a_change_of_the_same_size_is_seen() {
    let system = System::of_files(&[("topology.yaml", CLEAN)]);
    let mut watch = Watch::start(&system, &[]);
    watch.says("1 connection");
    replace(&system, "topology.yaml", &CLEAN.replace("measurements: pub", "measurements: sub"));
    watch.says("both ends");
    assert_eq!(watch.stop("-TERM").code(), Some(1));
}

#[test]
fn schemas_and_what_they_import_are_watched() {
    let topology = format!("schemas: [rover.proto]\n{}", CLEAN.replace("pub", "{pub: rover.Fix}"));
    let system = System::of_files(&[("t/topology.yaml", &topology)]);
    let mut watch = Watch::start(&system, &["t/topology.yaml"]);
    watch.says("cannot find the schema file `rover.proto`");
    replace(&system, "t/deep.proto", "syntax = \"proto3\"; package deep; message Place {}");
    let schema = "syntax = \"proto3\"; package rover; import \"deep.proto\"; message Fix { deep.Place p = 1; }";
    replace(&system, "t/rover.proto", schema);
    watch.says("2 components, 2 gates, 1 connection");
    replace(&system, "t/deep.proto", "syntax = \"proto3\"; package deep; message Room {}");
    watch.says("SCL0406");
    assert_eq!(watch.stop("-HUP").code(), Some(1));
}

#[test]
fn several_files_are_checked_together() {
    let system = System::of_files(&[("a.yaml", CLEAN), ("b.yaml", CLEAN)]);
    let mut watch = Watch::start(&system, &["a.yaml", "b.yaml"]);
    watch.says("a.yaml: 2 components");
    replace(&system, "b.yaml", "colour: red\n");
    let text = watch.next_check();
    assert!(text.contains("a.yaml: 2 components") && text.contains("b.yaml:1:1"), "{text}");
    assert_eq!(watch.stop("-INT").code(), Some(1));
}

#[test]
fn included_files_are_watched_also_before_they_exist() {
    let (sensors, rest) = CLEAN.split_at(CLEAN.find("  - name: controller").unwrap());
    let main = format!("include: [sensors.yaml]\ncomponents:\n{rest}");
    let system = System::of_files(&[("topology.yaml", &main)]);
    let mut watch = Watch::start(&system, &[]);
    watch.says("cannot find the included file `sensors.yaml`");
    replace(&system, "sensors.yaml", sensors);
    watch.says("2 components, 2 gates, 1 connection in 2 files");
    replace(&system, "sensors.yaml", &sensors.replace("pub", "sub"));
    watch.says("both ends");
    watch.stop("-INT");
}
