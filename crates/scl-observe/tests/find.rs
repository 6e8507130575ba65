//! Which system is meant.

use crate::world::World;
use expect_test::{Expect, expect};

#[track_caller]
fn check_problem(world: &World, name: Option<&str>, expected: &Expect) {
    expected.assert_eq(&world.text(&world.find(name).unwrap_err()));
}

const OTHER: &str = "components: [{name: lamp, gates: [{light: {pub: nav.Light, unconnected: ok}}]}]";

#[tokio::test]
async fn the_only_running_system_is_found_and_several_are_listed() {
    let world = World::new();
    check_problem(
        &world,
        None,
        &expect![[r#"
        error: no system is running
          = help: start one, for example with `scl run`
          = note: the runtime folder does not exist (`SCL_RUNTIME_DIR` chooses another)
    "#]],
    );
    let sensor = world.open("sensor").await;
    assert_eq!(world.find(None).unwrap().name(), "rover");
    check_problem(
        &world,
        Some("rovr"),
        &expect![[r#"
        error: there is no system `rovr`
          = help: did you mean `rover`?
          = note: looked in `FOLDER/run` (`SCL_RUNTIME_DIR` chooses another folder)
          = note: running: `rover`
    "#]],
    );

    let lamp = world.open_in("house", OTHER, "lamp").await;
    check_problem(
        &world,
        None,
        &expect![[r#"
        error: several systems are running
          = help: name one: `--system house`, or set `SCL_SYSTEM`
          = note: running: `house`, `rover`
    "#]],
    );
    assert_eq!(world.find(Some("house")).unwrap().name(), "house");
    assert_eq!(world.find_with(None, Some("house")).unwrap().name(), "house");
    assert_eq!(world.find_with(Some("rover"), Some("house")).unwrap().name(), "rover");
    assert_eq!(world.find_with(Some("rover"), Some("")).unwrap().name(), "rover");

    drop(sensor);
    assert_eq!(world.find(None).unwrap().name(), "house", "the other one is stopped");
    assert!(!world.find(Some("rover")).unwrap().components().iter().any(|component| component.is_running()));
    drop(lamp);
    check_problem(
        &world,
        None,
        &expect![[r#"
        error: no system is running
          = help: start one, for example with `scl run`
          = note: looked in `FOLDER/run` (`SCL_RUNTIME_DIR` chooses another folder)
          = note: stopped: `house`, `rover`
    "#]],
    );
}

#[tokio::test]
async fn the_topology_in_the_working_folder_decides_between_several() {
    let world = World::new();
    let _sensor = world.open("sensor").await;
    let lamp = world.open_in("house", OTHER, "lamp").await;
    std::fs::write(world.folder().join("topology.yaml"), "system: house\ncomponents: nonsense\n").unwrap();
    assert_eq!(world.find(None).unwrap().name(), "house", "whatever mistakes the file has");
    drop(lamp);
    assert_eq!(world.find(None).unwrap().name(), "rover", "the only one that runs");
    drop(_sensor);
    assert_eq!(world.find(None).unwrap().name(), "house", "that of the folder, though it is stopped");
}

#[test]
fn unusable_folders_and_names_are_explained() {
    let world = World::new();
    std::fs::write(world.runtime_dir(), "").unwrap();
    check_problem(
        &world,
        None,
        &expect![[r#"
        error: the runtime folder `FOLDER/run` is a file, not a folder
          = help: remove it, or choose another folder with `SCL_RUNTIME_DIR`
    "#]],
    );
    std::fs::remove_file(world.runtime_dir()).unwrap();
    std::fs::create_dir(world.runtime_dir()).unwrap();
    check_problem(
        &world,
        Some("../x\u{1b}"),
        &expect![[r#"
        error: `../x` cannot be the name of a system
          = help: use letters, digits and underscores; the name becomes a file in the runtime folder
    "#]],
    );
    check_problem(
        &world,
        Some("rover"),
        &expect![[r#"
        error: there is no system `rover`
          = help: start it, for example with `scl run`
          = note: looked in `FOLDER/run` (`SCL_RUNTIME_DIR` chooses another folder)
          = note: no system is running there
    "#]],
    );
}
