//! Topologies of several files.

use super::*;
use scl_topology::diagnostic::Edit;

const SENSORS: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
";

const MAIN: &str = "\
include: [parts/sensors.yaml]
components:
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
";

/// The codes of all problems but lints, and whether a topology comes out.
fn codes(files: &[(&str, &str)]) -> String {
    let loaded = load_from(&folder(files), "t.yaml");
    let told = loaded.diagnostics.iter().filter(|problem| problem.severity != Severity::Lint);
    let codes: Vec<&str> = told.map(|problem| problem.code()).collect();
    assert_eq!(loaded.topology.is_none(), !errors(&loaded).is_empty());
    codes.join(" ")
}

#[test]
fn included_files_belong_to_the_system() {
    let folder = folder(&[("t.yaml", MAIN), ("parts/sensors.yaml", SENSORS)]);
    let loaded = load_from(&folder, "t.yaml");
    assert_eq!(rendered(&loaded), "");
    let topology = loaded.topology.unwrap();
    assert_eq!((topology.system(), topology.connections().len()), ("t", 1));
    let names: Vec<&str> = topology.components().map(|(_, component)| component.name()).collect();
    assert_eq!(names, ["controller", "sensor"]);
    assert_eq!(loaded.files_read, ["t.yaml", "parts/sensors.yaml"].map(|name| folder.path().join(name)));
}

#[test]
fn a_problem_is_shown_where_it_is() {
    says(
        &[
            ("t.yaml", MAIN),
            ("parts/sensors.yaml", "include: [imu.yaml]\ncomponents: []\n"),
            ("parts/imu.yaml", &SENSORS.replace("pub", "publ")),
        ],
        "t.yaml",
        expect![[r#"
            error: [SCL0401] unknown gate kind `publ`
             --> parts/imu.yaml:4:23
              |
            4 |       - measurements: publ
              |                       ^^^^
              |
              = help: did you mean `pub`?
              = note: kinds: `pub` and `sub` (one to many, no answer), `req` and `rep` (question and answer), `push` and `pull` (many to one, no answer)
              = note: `parts/imu.yaml` is included at parts/sensors.yaml:1:11, which is included at t.yaml:1:11
        "#]],
    );
}

#[test]
fn both_places_of_a_conflict_are_shown() {
    says(
        &[
            ("t.yaml", &format!("system: rover\n{}", MAIN.replace("controller", "sensor"))),
            ("parts/sensors.yaml", &format!("system: other\ncodec: json\n{SENSORS}")),
        ],
        "t.yaml",
        expect![[r#"
            warning: [SCL0509] component `sensor` subscribes to its own messages
             --> t.yaml:8:5
              |
            8 |   - [sensor.measurements, sensor.sensor]
              |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ leaves the process and comes back
              |
              = help: keep the value in the component, and remove this connection and the gates `sensor.measurements` and `sensor.sensor`
            error: [SCL1503] `system: other` stands in an included file
             --> parts/sensors.yaml:1:9
              |
            1 | system: other
              |         ^^^^^ holds for the whole system
              |
             ::: t.yaml:1:9
              |
            1 | system: rover
              |         ----- the system has this one
              |
              = help: move it to the file that no other one includes, or remove it
              = note: `parts/sensors.yaml` is included at t.yaml:2:11
            error: [SCL1503] `codec: json` stands in an included file
             --> parts/sensors.yaml:2:8
              |
            2 | codec: json
              |        ^^^^ holds for the whole system
              |
              = help: move it to the file that no other one includes, or remove it
              = note: `parts/sensors.yaml` is included at t.yaml:2:11
            error: [SCL0301] component `sensor` is declared twice
             --> parts/sensors.yaml:4:11
              |
            4 |   - name: sensor
              |           ^^^^^^ second declaration
              |
             ::: t.yaml:4:11
              |
            4 |   - name: sensor
              |           ------ first declaration
              |
              = help: a component is declared once, with all its gates; another one has another name
              = note: `parts/sensors.yaml` is included at t.yaml:2:11
        "#]],
    );
}

#[test]
fn files_that_cannot_be_included_are_refused() {
    says(
        &[
            (
                "t.yaml",
                &MAIN.replace(
                    "[parts/sensors.yaml]",
                    "[parts/sensor.yaml, parts, t.yaml, a.yaml, rover.proto, a.yaml, parts/*.yaml]",
                ),
            ),
            ("parts/sensors.yaml", SENSORS),
            ("a.yaml", "include: [b.yaml]\n"),
            ("b.yaml", "include: [a.yaml, ./t.yaml]\n"),
            ("rover.proto", "syntax = \"proto3\";\n"),
        ],
        "t.yaml",
        expect![[r#"
            error: [SCL1501] cannot find the included file `parts/sensor.yaml`
             --> t.yaml:1:11
              |
            1 | include: [parts/sensor.yaml, parts, t.yaml, a.yaml, rover.proto, a.yaml, parts/*.yaml]
              |           ^^^^^^^^^^^^^^^^^
              |
              = help: did you mean `parts/sensors.yaml`?
              = note: paths start at the folder of the file that contains them
            error: [SCL1501] the included file `parts` is a directory, not a file
             --> t.yaml:1:30
              |
            1 | include: [parts/sensor.yaml, parts, t.yaml, a.yaml, rover.proto, a.yaml, parts/*.yaml]
              |                              ^^^^^
              |
              = help: name each of them: `parts/sensors.yaml`
            error: [SCL1502] `t.yaml` includes itself
             --> t.yaml:1:37
              |
            1 | include: [parts/sensor.yaml, parts, t.yaml, a.yaml, rover.proto, a.yaml, parts/*.yaml]
              |                                     ^^^^^^
              |
              = help: remove the entry: all files share one space of names
            error: [SCL1501] `rover.proto` is a schema, not a topology file
             --> t.yaml:1:53
              |
            1 | include: [parts/sensor.yaml, parts, t.yaml, a.yaml, rover.proto, a.yaml, parts/*.yaml]
              |                                                     ^^^^^^^^^^^
              |
              = help: `schemas` names the `.proto` files that declare the messages
            warning: [SCL1504] `a.yaml` is included twice
             --> t.yaml:1:66
              |
            1 | include: [parts/sensor.yaml, parts, t.yaml, a.yaml, rover.proto, a.yaml, parts/*.yaml]
              |                                             ------ first time    ^^^^^^ second time
              |
              = help: remove one of the two
            error: [SCL1501] cannot find the included file `parts/*.yaml`
             --> t.yaml:1:74
              |
            1 | include: [parts/sensor.yaml, parts, t.yaml, a.yaml, rover.proto, a.yaml, parts/*.yaml]
              |                                                                          ^^^^^^^^^^^^
              |
              = help: name each of them: `parts/sensors.yaml`
              = note: a pattern names no file
            error: [SCL1502] `a.yaml` is included by a file that it includes
             --> b.yaml:1:11
              |
            1 | include: [a.yaml, ./t.yaml]
              |           ^^^^^^
              |
              = help: remove the entry: all files share one space of names
              = note: `b.yaml` is included at a.yaml:1:11, which is included at t.yaml:1:45
            error: [SCL1502] `./t.yaml` is included by a file that it includes
             --> b.yaml:1:19
              |
            1 | include: [a.yaml, ./t.yaml]
              |                   ^^^^^^^^
              |
              = help: remove the entry: all files share one space of names
              = note: `b.yaml` is included at a.yaml:1:11, which is included at t.yaml:1:45
        "#]],
    );
}

#[test]
fn a_file_that_several_include_is_read_once() {
    let both = MAIN.replace("[parts/sensors.yaml]", "[a.yaml, b.yaml]");
    let of = "include: [parts/sensors.yaml]\n";
    assert_eq!(codes(&[("t.yaml", &both), ("a.yaml", of), ("b.yaml", of), ("parts/sensors.yaml", SENSORS)]), "");
}

#[test]
fn the_first_file_may_only_include_others() {
    let rest = MAIN.strip_prefix("include: [parts/sensors.yaml]\n").unwrap();
    let main = "include: [parts/sensors.yaml, rest.yaml]\n";
    assert_eq!(codes(&[("t.yaml", main), ("rest.yaml", rest), ("parts/sensors.yaml", SENSORS)]), "");
    assert_eq!(codes(&[("t.yaml", "include: [a.yaml]\n"), ("a.yaml", "# nothing\n")]), "SCL0115");
    assert_eq!(codes(&[("t.yaml", "include: [a.yaml]\n"), ("a.yaml", "components: []\n")]), "SCL1504");
    assert_eq!(codes(&[("t.yaml", "include: []\ncomponents: []\n")]), "");
}

#[test]
fn kinds_and_everyone_hold_in_all_files() {
    let main = "include: [kinds.yaml, motors.yaml]\ncomponents:\n  - name: logger\n    gates:\n      - records: pull\n  \
                - name: controller\n    gates:\n      - states: sub\nconnections:\n  - [each motor.state, controller.states]\n";
    let kinds =
        "kinds:\n  - name: motor\n    gates:\n      - state: pub\neveryone:\n  - log: {push: , to: logger.records}\n";
    let motors = "components:\n  - {name: left_motor, kind: motor}\n  - {name: right_motor, kind: motor}\n";
    let folder = folder(&[("t.yaml", main), ("kinds.yaml", kinds), ("motors.yaml", motors)]);
    let loaded = load_from(&folder, "t.yaml");
    assert_eq!(rendered(&loaded), "");
    assert_eq!(loaded.topology.unwrap().connections().len(), 5);
}

#[test]
fn a_comment_allows_what_is_in_its_own_file() {
    let lonely = "components:\n  - name: ui\n    gates:\n      - events: pub";
    let allow = " # scl: allow(SCL0701) later\n";
    let main = "include: [a.yaml]\ncomponents:\n  - name: x\n    gates:\n      - events: pub";
    let [plain, allowed] = ["\n", allow].map(|end| format!("{lonely}{end}"));
    let [main, main_allowed] = ["\n", allow].map(|end| format!("{main}{end}connections: []\n"));
    assert_eq!(codes(&[("t.yaml", &main), ("a.yaml", &plain)]), "SCL0701 SCL0701");
    // The comment of one file stands in the line of the problem of the other.
    let shifted = format!("#\n{allowed}");
    assert_eq!(codes(&[("t.yaml", &main), ("a.yaml", &shifted)]), "SCL0701");
    assert_eq!(codes(&[("t.yaml", &main_allowed), ("a.yaml", &plain)]), "SCL0701");
    assert_eq!(codes(&[("t.yaml", &main_allowed), ("a.yaml", &allowed)]), "");
}

#[test]
fn proposals_are_tried_in_the_file_that_they_change() {
    let folder = folder(&[
        ("t.yaml", &MAIN.replace("sensor: sub", "sensor: subscribe")),
        ("parts/sensors.yaml", &SENSORS.replace("pub", "publish")),
    ]);
    let loaded = load_from(&folder, "t.yaml");
    let sure = loaded.diagnostics.iter().flat_map(|problem| problem.proposals()).filter(|way| way.is_sure);
    let files: Vec<&str> = sure.map(|way| loaded.sources.file(way.edits[0].span.file).path()).collect();
    assert_eq!(files, ["t.yaml", "parts/sensors.yaml"], "{}", rendered(&loaded));
}

#[test]
fn a_name_is_changed_in_all_files() {
    let folder = folder(&[
        ("t.yaml", &MAIN.replace("[sensor.measurements", "[sensors.measurements")),
        ("parts/sensors.yaml", SENSORS),
    ]);
    let loaded = load_from(&folder, "t.yaml");
    let helps: Vec<String> = loaded.diagnostics[0].shown_helps().map(|help| help.text().into_owned()).collect();
    assert_eq!(helps, ["did you mean `sensor`?", "or rename the component `sensor` to `sensors`"]);
    let [main, part] =
        [MAIN, SENSORS].map(|text| text.replace("name: sensor", "name: sen$or").replace("[sensor.", "[sen$or."));
    let folder = self::folder(&[("t.yaml", &main), ("parts/sensors.yaml", &part)]);
    let loaded = load_from(&folder, "t.yaml");
    let place = |edit: &Edit| loaded.sources.place(edit.span);
    let ways = loaded.diagnostics.iter().flat_map(|problem| problem.proposals());
    let places: Vec<String> = ways.map(|way| way.edits.iter().map(place).collect::<Vec<_>>().join(" ")).collect();
    assert_eq!(places, ["parts/sensors.yaml:2:11 t.yaml:7:6"], "{}", rendered(&loaded));
}

#[test]
fn too_many_files_are_refused() {
    let chain = |length: usize| -> Vec<(String, String)> {
        let file = |at: usize| (format!("{at}.yaml"), format!("include: [{}.yaml]\n", at + 1));
        let last = (format!("{length}.yaml"), SENSORS.to_owned());
        let first = ("t.yaml".to_owned(), "include: [1.yaml]\ncomponents: []\n".to_owned());
        std::iter::once(first).chain((1..length).map(file)).chain([last]).collect()
    };
    let of_length = |length| {
        let files = chain(length);
        codes(&files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect::<Vec<_>>())
    };
    assert_eq!((of_length(16).as_str(), of_length(17).as_str()), ("SCL0701", "SCL1505"));
}

#[test]
fn paths_of_this_machine_are_warned_of() {
    let folder = folder(&[("uav/t.yaml", &MAIN.replace("parts/", "../")), ("sensors.yaml", SENSORS)]);
    let loaded = load_from(&folder, "uav/t.yaml");
    assert!(rendered(&loaded).contains("[SCL1506] the path of an included file leaves"), "{}", rendered(&loaded));
    assert!(loaded.topology.is_some());
}

/// The schemas of an included file.
#[cfg(feature = "protobuf")]
#[test]
fn schemas_stand_beside_the_file_that_names_them() {
    let typed = SENSORS.replace("pub", "{pub: rover.Measurement}");
    let with = |schemas: &str| format!("schemas: [{schemas}]\n{typed}");
    let main = format!("schemas: [parts/rover.proto]\n{MAIN}");
    for (main, part) in [(MAIN, with("rover.proto")), (&main, with("./rover.proto")), (&main, typed.clone())] {
        let files = [("t.yaml", main), ("parts/sensors.yaml", part.as_str()), ("parts/rover.proto", PROTO)];
        assert_eq!(codes(&files), "", "{main}{part}");
    }
    let twice = with("rover.proto, ./rover.proto");
    let files = [("t.yaml", MAIN), ("parts/sensors.yaml", twice.as_str()), ("parts/rover.proto", PROTO)];
    assert_eq!(codes(&files), "SCL0416");
    let missing = with("rovre.proto");
    let files = [("t.yaml", MAIN), ("parts/sensors.yaml", missing.as_str()), ("parts/rover.proto", PROTO)];
    says(
        &files,
        "t.yaml",
        expect![[r#"
        error: [SCL0406] cannot find the schema file `rovre.proto`
         --> parts/sensors.yaml:1:11
          |
        1 | schemas: [rovre.proto]
          |           ^^^^^^^^^^^
          |
          = help: did you mean `rover.proto`?
          = note: paths start at the folder of the file that contains them
          = note: `parts/sensors.yaml` is included at t.yaml:1:11
    "#]],
    );
}
