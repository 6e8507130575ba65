//! Prints what all others log.

scl::topology!("topology.yaml");

#[scl::main]
fn main(mut logger: Logger) -> scl::Result<()> {
    loop {
        let record = logger.records.recv_blocking()?;
        println!("{}: {}", record.component, record.text);
    }
}
