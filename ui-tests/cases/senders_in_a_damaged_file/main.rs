//! The only mistake is in the topology: the enums of senders are known all the same.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut controller: Controller) -> scl::Result<()> {
    let (motor, state): (MotorInstance, u32) = controller.states.recv_from().await?;
    let (sender, number) = controller.all.recv_from().await?;
    match sender {
        ControllerAllSender::LeftMotorState => println!("{motor} {state} {number}"),
        _ => {}
    }
    Ok(())
}
