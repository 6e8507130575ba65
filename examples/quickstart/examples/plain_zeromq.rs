//! Takes the place of `actuator` with nothing but a ZeroMQ library: no SCL, no topology, only the endpoint's name.
//!
//! Start the other components, then this instead of `actuator`:
//!
//! ```sh
//! cargo run -p quickstart --bin sensor &
//! cargo run -p quickstart --bin controller &
//! cargo run -p quickstart --example plain_zeromq
//! ```
//!
//! No lock keeps a second such program from starting, and nothing checks the message type that it was built for.

use std::error::Error;
use std::path::PathBuf;
use zeromq::{Socket, SocketRecv, SubSocket};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let mut socket = SubSocket::new();
    socket.connect(&format!("ipc://{}", endpoint()?.display())).await?;
    socket.subscribe("").await?;
    loop {
        let message = socket.recv().await?;
        let frame = message.get(0).ok_or("a message without a frame")?;
        println!("throttle {:+.2}", throttle(frame));
    }
}

/// The socket of the connection in the system's folder. Its name ends in a hash of type and codec.
fn endpoint() -> Result<PathBuf, Box<dyn Error>> {
    let folder = PathBuf::from(std::env::var("SCL_RUNTIME_DIR")?).join("rover");
    let entries = std::fs::read_dir(&folder)?.flatten();
    let mut paths = entries
        .filter(|entry| entry.file_name().to_string_lossy().starts_with("controller.actuator--actuator.setpoint."));
    Ok(paths.next().ok_or("`controller` is not running")?.path())
}

/// Decodes `message Setpoint { double throttle = 1; }`; protobuf leaves out a zero.
fn throttle(frame: &[u8]) -> f64 {
    match frame {
        [0x09, value @ ..] => value.try_into().map_or(f64::NAN, f64::from_le_bytes),
        _ => 0.0,
    }
}
