//! One struct for all components of a kind, and the gates of every component.

use futures_core::Stream;
use scl::{Component, OpenError, OpenOptions, Result};
use std::future::poll_fn;
use std::pin::Pin;
use std::task::Context;
use std::time::Duration;

scl::topology!("kinds.yaml");

const LONG: Duration = Duration::from_secs(60);

fn in_folder(folder: &tempfile::TempDir) -> OpenOptions {
    OpenOptions::new().runtime_dir(folder.path())
}

#[tokio::test]
async fn each_component_of_a_kind_has_its_own_connections() -> Result<()> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut left = Motor::open_as_with(MotorInstance::LeftMotor, in_folder(&folder)).await?;
    let mut right = Motor::open_as_with(MotorInstance::RightMotor, in_folder(&folder)).await?;
    let mut controller = Controller::open_with(in_folder(&folder)).await?;
    assert_eq!((left.instance(), right.instance()), (MotorInstance::LeftMotor, MotorInstance::RightMotor));
    controller.ready(LONG).await?;
    controller.left.send(&1).await?;
    controller.right.send(&2).await?;
    assert_eq!((left.setpoint.recv().await?, right.setpoint.recv().await?), (1, 2));
    left.state.send(&3).await?;
    assert_eq!(controller.states.recv().await?, 3);
    right.state.send(&4).await?;
    assert_eq!(controller.states.recv().await?, 4);
    Ok(())
}

#[tokio::test]
async fn each_component_has_the_gate_of_everyone() -> Result<()> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut logger = Logger::open_with(in_folder(&folder)).await?;
    let mut left = Motor::open_as_with(MotorInstance::LeftMotor, in_folder(&folder)).await?;
    left.log.send(&"left".to_owned()).await?;
    assert_eq!(logger.records.recv().await?, "left");
    let mut right = Motor::open_as_with(MotorInstance::RightMotor, in_folder(&folder)).await?;
    right.log.send(&"right".to_owned()).await?;
    assert_eq!(logger.records.recv().await?, "right");
    Ok(())
}

#[tokio::test]
async fn a_component_of_a_kind_runs_once() -> Result<()> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let open = || Motor::open_as_with(MotorInstance::RightMotor, in_folder(&folder));
    let _first = open().await?;
    let error = scl::Error::from(open().await.err().expect("it runs already"));
    assert!(format!("{error:?}").contains("right-motor"), "{error:?}");
    Ok(())
}

#[tokio::test]
async fn a_program_must_know_which_component_it_is() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let error = Motor::open_with(in_folder(&folder)).await.err().expect("SCL_COMPONENT is not set");
    assert!(matches!(&error, OpenError::WhichComponent { kind, .. } if kind == "motor"), "{error:?}");
    let expected = "this program is a `motor`: set SCL_COMPONENT to `left_motor` or `right-motor`";
    assert_eq!(error.to_string(), expected);
    let error = Motor::open_blocking_with(in_folder(&folder)).err().expect("SCL_COMPONENT is not set");
    assert_eq!(error.to_string(), expected);
}

#[test]
fn the_components_of_a_kind_are_known_by_their_names() {
    let names: Vec<String> = MotorInstance::ALL.iter().map(ToString::to_string).collect();
    assert_eq!(names, ["left_motor", "right-motor"]);
    let kind = Motor::KIND.expect("a kind");
    assert_eq!((kind.name, kind.components.len(), Motor::SPEC.name), ("motor", 2, "left_motor"));
    assert!(Controller::KIND.is_none());
}

#[tokio::test]
async fn a_kind_is_tested_like_a_component() -> Result<()> {
    let (mut motor, mut peer) = Motor::test().await?;
    peer.setpoint.send(&7).await?;
    assert_eq!(motor.setpoint.recv().await?, 7);
    assert_eq!(motor.instance(), MotorInstance::LeftMotor);
    Ok(())
}

#[tokio::test]
async fn components_of_a_kind_are_told_apart_by_its_enum() -> Result<()> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut left = Motor::open_as_with(MotorInstance::LeftMotor, in_folder(&folder)).await?;
    let mut right = Motor::open_as_with(MotorInstance::RightMotor, in_folder(&folder)).await?;
    let mut controller = Controller::open_with(in_folder(&folder)).await?;
    assert_eq!(controller.states.sender(), None);
    for number in 0..3 {
        left.state.send(&number).await?;
        assert_eq!(controller.states.recv_from().await?, (MotorInstance::LeftMotor, number));
        right.state.send(&(10 + number)).await?;
        assert_eq!(controller.states.recv_from().await?, (MotorInstance::RightMotor, 10 + number));
        assert_eq!(controller.states.sender(), Some(MotorInstance::RightMotor));
    }
    left.state.send(&7).await?;
    let next = |cx: &mut Context<'_>| Pin::new(&mut controller.states).poll_next(cx);
    let received = poll_fn(next).await.expect("a stream never ends")?;
    assert_eq!((controller.states.sender(), received), (Some(MotorInstance::LeftMotor), 7));
    let connection = controller.states.last_connection().expect("a message was received");
    assert_eq!((connection.peer_component, connection.peer_gate), ("left_motor", "state"));
    Ok(())
}

#[test]
fn gates_of_different_components_are_told_apart_by_an_enum_of_their_own() -> Result<()> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut left = Motor::open_blocking_as_with(MotorInstance::LeftMotor, in_folder(&folder))?;
    let mut controller = Controller::open_blocking_with(in_folder(&folder))?;
    let mut display = Display::open_blocking_with(in_folder(&folder))?;
    left.state.send_blocking(&1)?;
    assert_eq!(display.numbers.recv_from_blocking()?, (DisplayNumbersSender::LeftMotor, 1));
    controller.left.send_blocking(&2)?;
    assert_eq!(display.numbers.recv_from_blocking()?, (DisplayNumbersSender::ControllerLeft, 2));
    controller.right.send_blocking(&3)?;
    assert_eq!(display.numbers.recv_timeout(LONG)?, 3);
    assert_eq!(display.numbers.sender(), Some(DisplayNumbersSender::ControllerRight));
    left.state.send_blocking(&4)?;
    let newest = loop {
        if let Some(newest) = display.numbers.latest()? {
            break newest;
        }
        std::thread::yield_now();
    };
    assert_eq!((display.numbers.sender(), newest), (Some(DisplayNumbersSender::LeftMotor), 4));
    Ok(())
}

#[tokio::test]
async fn in_a_unit_test_the_first_peer_sends() -> Result<()> {
    let (mut controller, mut peer) = Controller::test().await?;
    peer.states.send(&1).await?;
    assert_eq!(controller.states.recv_from().await?, (MotorInstance::LeftMotor, 1));
    Ok(())
}
