//! Receives what `station` publishes for `heater`, beside it or in its place, with the `zeromq` library alone.

use serde_json::Value;
use std::{env, error::Error, fs, os::unix::fs::MetadataExt, time::Duration};
use zeromq::{Socket, SocketRecv, SubSocket};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let config: Value = serde_json::from_str(include_str!("../../greenhouse.zmq.json"))?;
    let gate = &config["components"]["heater"]["gates"]["heating"];
    let endpoint = gate["zmq_endpoints"][0].as_str().ok_or("no endpoint")?;
    let endpoint = endpoint.replace("{folder}", &system_folder(config["system"].as_str().ok_or("no system")?)?);
    // Unlike libzmq, this library does not wait for a peer that starts later.
    let mut socket = loop {
        let mut socket = SubSocket::new();
        match socket.connect(&endpoint).await {
            Ok(()) => break socket,
            Err(_) => tokio::time::sleep(Duration::from_millis(20)).await,
        }
    };
    socket.subscribe("").await?;
    loop {
        let message = socket.recv().await?;
        let heating: Value = serde_json::from_slice(message.get(0).ok_or("no frame")?)?;
        // Canonical protobuf JSON omits fields that are false or zero.
        println!("heating {}", if heating["on"] == true { "on" } else { "off" });
    }
}

fn system_folder(system: &str) -> Result<String, Box<dyn Error>> {
    let session = env::var("XDG_RUNTIME_DIR").map(|session| format!("{session}/scl"));
    let temporary = format!("{}/scl-{}", env::temp_dir().display(), fs::metadata("/proc/self")?.uid());
    let runtime_dir = env::var("SCL_RUNTIME_DIR").or(session).unwrap_or(temporary);
    Ok(format!("{runtime_dir}/{}", env::var("SCL_SYSTEM").unwrap_or(system.to_owned())))
}
