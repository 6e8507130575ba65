//! Plays a component of `circle.yaml` and follows commands: `circle left`. `send 9` sends up to 9 messages, as long as
//! none has to wait, and prints how many; `take 9` receives 9 messages.

use scl::bytes::Bytes;
use scl::{Pub, Sub};
use scl_tests::{Commands, say};
use std::time::Duration;

scl::topology!("topologies/circle.yaml");

#[tokio::main(flavor = "current_thread")]
async fn main() -> scl::Result<()> {
    macro_rules! play {
        ($component:ident) => {{
            let mut component = $component::open().await?;
            component.ready(Duration::from_secs(300)).await?;
            play(&mut component.outbox, &mut component.inbox).await
        }};
    }
    match std::env::args().nth(1).unwrap_or_default().as_str() {
        "left" => play!(Left),
        "right" => play!(Right),
        "free_left" => play!(FreeLeft),
        _ => play!(FreeRight),
    }
}

async fn play(outbox: &mut Pub<Bytes>, inbox: &mut Sub<Bytes>) -> scl::Result<()> {
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let count = words.get(1).and_then(|word| word.parse().ok()).unwrap_or_default();
        match words[0].as_str() {
            "send" => {
                let message = Bytes::from_static(b"message");
                let sent = (0..count).take_while(|_| outbox.try_send(&message).is_ok()).count();
                say(format!("sent {sent}"));
            }
            _ => {
                for _ in 0..count {
                    inbox.recv().await?;
                }
                say(format!("took {count}"));
            }
        }
    }
    Ok(())
}
