//! Takes the place of `probe` with the `zeromq` library alone: `plain_publish CELSIUS`.

use serde_json::{Value, json};
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::{env, error::Error, fs, time::Duration};
use zeromq::{PubSocket, Socket, SocketSend};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let config: Value = serde_json::from_str(include_str!("../../greenhouse.zmq.json"))?;
    let gate = &config["components"]["probe"]["gates"]["temperature"];
    let folder = system_folder(config["system"].as_str().ok_or("no system")?)?;
    let mut socket = PubSocket::new();
    for endpoint in gate["zmq_endpoints"].as_array().ok_or("no endpoints")? {
        let endpoint = endpoint.as_str().ok_or("no text")?.replace("{folder}", &folder);
        // A killed program leaves its socket file behind, and this library does not replace it.
        let _ = fs::remove_file(endpoint.trim_start_matches("ipc://"));
        socket.bind(&endpoint).await?;
    }
    let celsius: f64 = env::args().nth(1).ok_or("usage: plain_publish CELSIUS")?.parse()?;
    loop {
        socket.send(json!({"celsius": celsius}).to_string().into()).await?;
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
}

fn system_folder(system: &str) -> Result<String, Box<dyn Error>> {
    let session = env::var("XDG_RUNTIME_DIR").map(|session| format!("{session}/scl"));
    let temporary = format!("{}/scl-{}", env::temp_dir().display(), fs::metadata("/proc/self")?.uid());
    let runtime_dir = env::var("SCL_RUNTIME_DIR").or(session).unwrap_or(temporary);
    let folder = format!("{runtime_dir}/{}", env::var("SCL_SYSTEM").unwrap_or(system.to_owned()));
    fs::DirBuilder::new().recursive(true).mode(0o700).create(&folder)?;
    Ok(folder)
}
