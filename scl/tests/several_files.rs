//! A topology of several files: one space of names, whichever file declares a component.

use scl::{OpenOptions, Result};
use std::time::Duration;

scl::topology!("several_files/topology.yaml");

const LONG: Duration = Duration::from_secs(60);

#[tokio::test]
async fn components_of_several_files_are_one_system() -> Result<()> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let options = || OpenOptions::new().runtime_dir(folder.path());
    let mut left = Motor::open_as_with(MotorInstance::LeftMotor, options()).await?;
    let mut right = Motor::open_as_with(MotorInstance::RightMotor, options()).await?;
    let mut controller = Controller::open_with(options()).await?;
    let mut display = Display::open_with(options()).await?;
    left.ready(LONG).await?;
    right.ready(LONG).await?;
    right.state.send(&2).await?;
    assert_eq!(controller.states.recv_from().await?, (MotorInstance::RightMotor, 2));
    left.state.send(&1).await?;
    assert_eq!(controller.states.recv_from().await?, (MotorInstance::LeftMotor, 1));
    assert_eq!(display.states.recv().await?, 1);
    Ok(())
}
