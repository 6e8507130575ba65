//! The topology file does not exist, and the program uses a component of it.

scl::topology!("topolgy.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    loop {
        c.sensor.recv().await?;
    }
}
