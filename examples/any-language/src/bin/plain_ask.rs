//! Asks `station` for another temperature in the place of `panel`, with the `zeromq` library alone:
//! `plain_ask CELSIUS`.

use serde_json::{Value, json};
use std::{env, error::Error, fs, os::unix::fs::MetadataExt, time::Duration};
use zeromq::{ReqSocket, Socket, SocketRecv, SocketSend};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let config: Value = serde_json::from_str(include_str!("../../greenhouse.zmq.json"))?;
    let gate = &config["components"]["panel"]["gates"]["target"];
    let endpoint = gate["zmq_endpoints"][0].as_str().ok_or("no endpoint")?;
    let folder = system_folder(config["system"].as_str().ok_or("no system")?)?;
    let mut socket = ReqSocket::new();
    socket.connect(&endpoint.replace("{folder}", &folder)).await?;
    let celsius: f64 = env::args().nth(1).ok_or("usage: plain_ask CELSIUS")?.parse()?;
    socket.send(json!({"celsius": celsius}).to_string().into()).await?;
    let timeout = Duration::from_nanos(gate["timeout_ns"].as_u64().ok_or("no timeout")?);
    let message = tokio::time::timeout(timeout, socket.recv()).await??;
    let reply: Value = serde_json::from_slice(message.get(0).ok_or("no frame")?)?;
    println!("before: {:?}", reply["previousCelsius"].as_f64().unwrap_or(0.0));
    Ok(())
}

fn system_folder(system: &str) -> Result<String, Box<dyn Error>> {
    let session = env::var("XDG_RUNTIME_DIR").map(|session| format!("{session}/scl"));
    let temporary = format!("{}/scl-{}", env::temp_dir().display(), fs::metadata("/proc/self")?.uid());
    let runtime_dir = env::var("SCL_RUNTIME_DIR").or(session).unwrap_or(temporary);
    Ok(format!("{runtime_dir}/{}", env::var("SCL_SYSTEM").unwrap_or(system.to_owned())))
}
