//! Prints what all others log.

use rover_system::Logger;

#[scl::main]
fn main(mut logger: Logger) -> scl::Result<()> {
    loop {
        let record = logger.records.recv_blocking()?;
        println!("{}: {}", record.component, record.text);
    }
}
