//! A gate with one peer has no senders to tell apart.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut display: Display) -> scl::Result<()> {
    let _from = display.left.recv_from().await?;
    let (motor, _state) = display.states.recv_from().await?;
    let _is_left = motor == MotorInstance::LeftMoter;
    Ok(())
}
