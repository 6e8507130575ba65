//! Plays `right` of `twins.yaml` with the sockets of the `zeromq` library: `zeromq_twin NAME=ADDRESS...`.
//!
//! `values`, `jobs_in` and `answer` listen; `values_in`, `jobs` and `question` connect. A socket that listens at
//! `tcp:PATH` chooses a port and writes it to `PATH.tcp`. Commands come line by line.

use scl::bytes::Bytes;
use scl_tests::{Commands, ranges, say};
use std::collections::HashMap;
use std::time::Duration;
use zeromq::{
    PubSocket, PullSocket, PushSocket, RepSocket, ReqSocket, Socket, SocketRecv, SocketSend, SubSocket, ZmqMessage,
    ZmqResult,
};

/// The message type of the topology.
mod twins {
    scl::topology!("topologies/twins.yaml", only = []);
    pub(crate) use test::Number;
}

#[tokio::main]
async fn main() -> ZmqResult<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let addresses: HashMap<&str, &str> = arguments.iter().filter_map(|argument| argument.split_once('=')).collect();
    let mut values: PubSocket = listen(addresses["values"]).await?;
    let mut jobs_in: PullSocket = listen(addresses["jobs_in"]).await?;
    let answer: RepSocket = listen(addresses["answer"]).await?;
    let mut values_in: SubSocket = connect(addresses["values_in"]).await;
    values_in.subscribe("").await?;
    let mut jobs: PushSocket = connect(addresses["jobs"]).await;
    let mut question: ReqSocket = connect(addresses["question"]).await;
    tokio::spawn(serve(answer));
    say("open");
    let mut commands = Commands::listen();
    let mut next = commands.next().await;
    while let Some(words) = next.take() {
        let item = |index: usize| words.get(index).and_then(|word| word.parse::<u64>().ok()).unwrap_or_default();
        match words[0].as_str() {
            // A publisher does not know when its first subscriber is there.
            "stream" => next = stream(&mut values, &mut commands).await?,
            "stop" => {
                values.send(encode(1_000_000)).await?;
                say("stopped");
            }
            "push" => {
                for value in item(1)..item(2) {
                    jobs.send(encode(value)).await?;
                }
                say("pushed");
            }
            "call" => {
                question.send(encode(item(1))).await?;
                say(decode(&question.recv().await?));
            }
            "values" => receive_up_to(&mut values_in, item(1)).await?,
            "jobs" => receive_up_to(&mut jobs_in, item(1)).await?,
            other => say(format!("unknown command `{other}`")),
        }
        if next.is_none() {
            next = commands.next().await;
        }
    }
    Ok(())
}

/// Publishes a message each millisecond until the next command comes.
async fn stream(values: &mut PubSocket, commands: &mut Commands) -> ZmqResult<Option<Vec<String>>> {
    let mut tick = tokio::time::interval(Duration::from_millis(1));
    for value in 0.. {
        tokio::select! {
            biased;
            command = commands.next() => return Ok(command),
            _ = tick.tick() => values.send(encode(value)).await?,
        }
    }
    Ok(None)
}

async fn listen<S: Socket>(address: &str) -> ZmqResult<S> {
    let mut socket = S::new();
    match address.strip_prefix("tcp:") {
        Some(path) => {
            let bound = socket.bind("tcp://127.0.0.1:0").await?.to_string();
            std::fs::write(format!("{path}.tcp"), bound.trim_start_matches("tcp://"))?;
        }
        None => {
            // The library fails if an earlier program left its socket behind.
            let _nothing_left = std::fs::remove_file(address.trim_start_matches("ipc://"));
            socket.bind(address).await?;
        }
    }
    Ok(socket)
}

/// The library does not wait for a peer that starts later.
async fn connect<S: Socket>(address: &str) -> S {
    loop {
        let mut socket = S::new();
        if socket.connect(address).await.is_ok() {
            return socket;
        }
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
}

async fn receive_up_to<S: SocketRecv>(socket: &mut S, last: u64) -> ZmqResult<()> {
    let mut values = vec![decode(&socket.recv().await?)];
    while values.last() < Some(&last) {
        values.push(decode(&socket.recv().await?));
    }
    say(ranges(&values));
    Ok(())
}

async fn serve(mut answer: RepSocket) -> ZmqResult<()> {
    loop {
        let doubled = encode(2 * decode(&answer.recv().await?));
        answer.send(doubled).await?;
    }
}

fn encode(value: u64) -> ZmqMessage {
    Bytes::from(prost::Message::encode_to_vec(&twins::Number { value, padding: Vec::new() })).into()
}

fn decode(message: &ZmqMessage) -> u64 {
    let body = message.get(0).cloned().unwrap_or_default();
    prost::Message::decode(body).map_or(u64::MAX, |number: twins::Number| number.value)
}
