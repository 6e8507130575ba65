//! Messages that panels publish, at gates of components that do not run.

use foxglove::websocket::{Client, ClientChannel, ClientChannelId, ClientId, ServerListener, Status};
use scl_observe::Commands;
use scl_record::format::{Part, Topic};
use std::collections::HashMap;
use std::process::Stdio;
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::io::AsyncWriteExt;
use tokio::process::ChildStdin;
use tokio::runtime::Handle;
use tokio::sync::mpsc::{Receiver, Sender, channel};

/// Number of messages that wait for `scl pub`, which waits for the peers of the gate at first.
const AHEAD: usize = 256;

/// What panels publish, a channel each.
pub(crate) struct Publishing {
    commands: Commands,
    runtime: Handle,
    channels: Mutex<HashMap<(ClientId, ClientChannelId), Sender<String>>>,
}

impl Publishing {
    /// `runtime` runs the commands that publish.
    pub(crate) fn new(commands: Commands, runtime: Handle) -> Self {
        Self { commands, runtime, channels: Mutex::default() }
    }

    fn channels(&self) -> MutexGuard<'_, HashMap<(ClientId, ClientChannelId), Sender<String>>> {
        self.channels.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ServerListener for Publishing {
    fn on_client_advertise(&self, client: Client, channel: &ClientChannel) {
        match gate_of(channel) {
            Ok(gate) => {
                let (sender, messages) = self::channel(AHEAD);
                self.channels().insert((client.id(), channel.id), sender);
                self.runtime.spawn(publish(self.commands.clone(), gate, messages, client));
            }
            Err(error) => client.send_status(Status::error(error)),
        }
    }

    fn on_message_data(&self, client: Client, channel: &ClientChannel, payload: &[u8]) {
        // On one line, as `scl pub` reads it.
        let message = match serde_json::from_slice::<serde_json::Value>(payload) {
            Ok(message) => message.to_string(),
            Err(error) => return client.send_status(Status::error(format!("{}: {error}", channel.topic))),
        };
        if let Some(sender) = self.channels().get(&(client.id(), channel.id))
            && sender.try_send(message).is_err()
        {
            let problem = "a message is not published, because others are waiting or publishing has failed";
            client.send_status(Status::error(format!("{}: {problem}", channel.topic)));
        }
    }

    fn on_client_unadvertise(&self, client: Client, channel: &ClientChannel) {
        self.channels().remove(&(client.id(), channel.id));
    }
}

/// The gate of a channel, as `component.gate`.
fn gate_of(channel: &ClientChannel) -> Result<String, String> {
    let ClientChannel { topic, encoding, .. } = channel;
    if encoding != "json" {
        return Err(format!("{topic}: messages are published as `json`, not as `{encoding}`"));
    }
    match Topic::parse(topic) {
        Some(topic) if topic.part == Part::Message => Ok(topic.gate_name()),
        _ => Err(format!("{topic}: this is no gate; name it `/component/gate`")),
    }
}

/// Publishes messages until the panel ends. The client is told why it fails.
async fn publish(commands: Commands, gate: String, mut messages: Receiver<String>, client: Client) {
    // Not before there is a message: the gate's component is opened until the panel ends.
    let Some(first) = messages.recv().await else { return };
    let mut command = commands.command("pub", &[], &[&gate, "-"]);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = match command.spawn() {
        Ok(child) => child,
        Err(error) => return client.send_status(Status::error(commands.cannot_run(&error))),
    };
    let feeding = feed(child.stdin.take(), first, messages);
    let ended = child.wait_with_output();
    tokio::pin!(ended);
    let done = tokio::select! {
        done = &mut ended => done,
        () = feeding => ended.await,
    };
    match done {
        Ok(done) if done.status.success() => {}
        Ok(done) => client.send_status(Status::error(String::from_utf8_lossy(&done.stderr))),
        Err(error) => client.send_status(Status::error(commands.cannot_run(&error))),
    }
}

/// Writes messages until the panel ends, or nobody reads them.
async fn feed(input: Option<ChildStdin>, first: String, mut messages: Receiver<String>) {
    let Some(mut input) = input else { return };
    let mut next = Some(first);
    while let Some(message) = next {
        if input.write_all(format!("{message}\n").as_bytes()).await.is_err() {
            return;
        }
        next = messages.recv().await;
    }
}
