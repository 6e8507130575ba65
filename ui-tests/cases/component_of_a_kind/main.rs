//! A component of a kind has no struct of its own.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(_left: LeftMotor) -> scl::Result<()> {
    let _which = MotorInstance::RigthMotor;
    Ok(())
}
