//! Plays a component of `bounded.yaml` and follows commands: `bounded camera` or `bounded viewer`.

use scl::bytes::Bytes;
use scl_tests::{Commands, say};
use std::time::Duration;

scl::topology!("topologies/bounded.yaml");

const FRAME: usize = 1 << 20;

#[tokio::main(flavor = "current_thread")]
async fn main() -> scl::Result<()> {
    match std::env::args().nth(1).unwrap_or_default().as_str() {
        "camera" => play_camera(Camera::open().await?).await,
        _ => play_viewer(Viewer::open().await?).await,
    }
}

async fn play_camera(mut camera: Camera) -> scl::Result<()> {
    camera.ready(Duration::from_secs(300)).await?;
    say("ready");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let count: u8 = words.first().and_then(|word| word.parse().ok()).unwrap_or_default();
        for number in 0..count {
            camera.frames.send(&Bytes::from(vec![number; FRAME])).await?;
        }
        say(format!("waiting {}", camera.frames.stats().waiting));
    }
    Ok(())
}

async fn play_viewer(mut viewer: Viewer) -> scl::Result<()> {
    let mut last = None;
    // The test sends frames 0 to 99.
    while last != Some(99) {
        last = viewer.frames.recv().await?.first().copied();
    }
    say("received the last frame");
    Ok(())
}
