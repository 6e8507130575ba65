//! Steers towards the speed that was last asked for.

use rover_system::Controller;

#[scl::main]
async fn main(controller: Controller) -> scl::Result<()> {
    rover_system::controller::run(controller).await
}
