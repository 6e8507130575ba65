//! Gates by name: where they are observed, and why not.

use crate::world::{TOPOLOGY, World, plan};
use expect_test::expect;
use scl::runtime_dir::Announcement;
use scl::runtime_dir::internals::ComponentLock;
use scl_observe::Selection;
use std::path::Path;

#[tokio::test]
async fn each_kind_is_observed_where_it_listens() {
    let world = World::new();
    let (_sensor, _controller) = (world.open("sensor").await, world.open("controller").await);
    let system = world.find(None).unwrap();
    let taps = |name: &str| {
        let gate = system.gate(name).unwrap();
        assert_eq!(gate.name(), name);
        gate.taps.iter().map(|tap| format!("{}.{}: {}", tap.component, tap.gate, tap.socket)).collect::<Vec<_>>()
    };
    for (name, expected) in [
        ("sensor.values", "sensor.values: sensor.values.tap"),
        ("sensor.jobs", "controller.jobs: controller.jobs.tap"),
        ("sensor.ask", "controller.answer: controller.answer.tap"),
        ("controller.values", "sensor.values: sensor.values.tap"),
        ("controller.jobs", "controller.jobs: controller.jobs.tap"),
        ("controller.answer", "controller.answer: controller.answer.tap"),
    ] {
        assert_eq!(taps(name), [expected]);
    }
    let own: Vec<String> = system.gates().iter().map(|gate| gate.name()).collect();
    assert_eq!(own, ["controller.jobs", "controller.answer", "sensor.values"]);
    let gate = system.gate("sensor.values").unwrap();
    assert_eq!((gate.payload.to_string(), &*gate.codec), ("nav.Fix".to_owned(), "json"));
    assert_eq!(gate.peers, ["controller.values", "display.values"]);
}

#[tokio::test]
async fn gates_that_cannot_be_observed_say_why() {
    let world = World::new();
    let _sensor = world.open("sensor").await;
    drop(world.open("controller").await);
    let system = world.find(None).unwrap();
    let names =
        ["sensor.jobs", "controller.jobs", "display.values", "sensor.value", "senor.values", "sensor", "x", "sensor."];
    let problems: Vec<String> = names.iter().map(|name| system.gate(name).unwrap_err().to_string()).collect();
    expect![[r#"
        error: `sensor.jobs` cannot be observed: none of its peers is running
          = help: `scl list` shows what runs
          = note: messages of a `push` gate are seen at its peers: `controller.jobs`

        error: component `controller` is not running
          = help: `scl list` shows what runs

        error: component `display` is not running
          = help: `scl list` shows what runs

        error: component `sensor` has no gate `value`
          = help: did you mean `sensor.values`?
          = note: its gates: `sensor.values`, `sensor.jobs`, `sensor.ask`

        error: system `rover` has no component `senor`
          = help: did you mean `sensor`?
          = note: known components: `controller`, `display`, `sensor`

        error: `sensor` is a component, not a gate
          = help: write one of its gates: `sensor.values`, `sensor.jobs`, `sensor.ask`

        error: `x` is not the name of a gate
          = help: write `component.gate`; `scl list` shows what runs with `-v`
          = note: components of `rover`: `controller`, `display`, `sensor`

        error: component `sensor` has no gate ``
          = note: its gates: `sensor.values`, `sensor.jobs`, `sensor.ask`
    "#]]
    .assert_eq(&problems.join("\n"));
}

#[tokio::test]
async fn states_are_read_anew() {
    let world = World::new();
    let sensor = world.open("sensor").await;
    let system = world.find(None).unwrap();
    let states = || {
        let components = system.components().into_iter();
        components.map(|component| format!("{} {}", component.name, component.state_word())).collect::<Vec<_>>()
    };
    assert_eq!(states(), ["controller stopped", "display stopped", "sensor running"]);
    drop(sensor);
    assert_eq!(states(), ["sensor stopped"], "nobody names its peers any more");
    std::fs::remove_dir_all(world.runtime_dir()).unwrap();
    assert!(states().is_empty());
}

#[tokio::test]
async fn a_killed_peer_is_no_place_to_observe() {
    let world = World::new();
    let (_sensor, controller) = (world.open("sensor").await, world.open("controller").await);
    // A killed process leaves its announcement behind; this one closes, and the file is put back.
    let file = world.runtime_dir().join("rover/controller.json");
    let announcement = std::fs::read(&file).unwrap();
    drop(controller);
    std::fs::write(&file, announcement).unwrap();
    let system = world.find(None).unwrap();
    assert_eq!(system.component("controller").unwrap().state_word(), "dead");
    let problem = system.gate("sensor.jobs").unwrap_err().to_string();
    assert!(problem.contains("none of its peers is running"), "{problem}");
    let problem = system.gate("controller.jobs").unwrap_err().to_string();
    assert!(problem.contains("component `controller` is not running") && problem.contains("was killed or crashed"));
}

/// The gateway shows components of other hosts in the runtime folder, but their taps are on their hosts.
#[tokio::test]
async fn gates_of_another_host_say_where_they_are_seen() {
    let world = World::new();
    let _sensor = world.open("sensor").await;
    let system = world.find(None).unwrap();
    let _lock = ComponentLock::take(system.dir(), "controller").unwrap();
    let mut announcement = Announcement::of_this_process("controller");
    announcement.plan = Some(plan(TOPOLOGY).component("controller").unwrap().clone());
    announcement.host = Some("board".to_owned());
    let _file = announcement.publish(system.dir()).unwrap();
    let expected = |name: &str| {
        format!(
            "error: the messages of `{name}` are seen on host `board`, where its component runs\n  \
               = help: run the command there, for example `ssh board scl echo {name} --system rover`\n"
        )
    };
    // Also what is sent to a component there.
    for name in ["controller.answer", "controller.jobs", "sensor.jobs", "sensor.ask"] {
        assert_eq!(system.gate(name).unwrap_err().to_string(), expected(name));
    }
    assert_eq!(system.gate("controller.values").unwrap().taps[0].component, "sensor");
    let own: Vec<String> = system.gates().iter().map(|gate| gate.name()).collect();
    assert_eq!(own, ["sensor.values"]);
    for name in ["controller", "controller.answer"] {
        let names = [name.to_owned()];
        let problem = Selection::new(&system, &names, &[], Path::new("none.yaml")).unwrap_err();
        assert_eq!(problem.to_string(), expected(name));
    }
    let names = ["controller.values".to_owned()];
    assert!(Selection::new(&system, &names, &[], Path::new("none.yaml")).unwrap().waiting().is_empty());
}
