//! The SCL component of the example: heats while it is too cold.

scl::topology!("topology.yaml", only = [station]);

#[scl::main]
async fn main(mut c: Station) -> scl::Result<()> {
    let mut target = 20.0;
    loop {
        tokio::select! {
            measured = c.temperature.recv() => {
                let on = measured?.celsius < target;
                c.heating.send(&greenhouse::Heating { on }).await?;
            }
            request = c.target.recv() => {
                let request = request?;
                let previous_celsius = std::mem::replace(&mut target, request.celsius);
                request.reply(&greenhouse::Accepted { previous_celsius })?;
            }
        }
    }
}
