//! The viewer: receives frames and pictures, counts those in shared memory, and may keep some.

use crate::Viewer;
use crate::order::Order;
use crate::picture::number_of;
use scl::bytes::Bytes;
use scl_tests::{Commands, is_shared, ranges, say, say_result};
use std::time::Duration;

pub(crate) async fn play() -> scl::Result<()> {
    let mut viewer = Viewer::open().await?;
    say("open");
    let mut commands = Commands::listen();
    let mut kept: Vec<Bytes> = Vec::new();
    while let Some(words) = commands.next().await {
        let number = words.get(1).and_then(|word| word.parse::<u64>().ok()).unwrap_or_default();
        match words.first().map_or("", String::as_str) {
            "ready" => say_result(viewer.ready(Duration::from_secs(300)).await, |()| "ready".to_owned()),
            "receive" => {
                let mut seen = Seen::default();
                for _ in 0..number {
                    seen.add(viewer.frames.recv().await?);
                }
                seen.say();
            }
            "receive_up_to" => {
                let mut seen = Seen::default();
                while seen.add(viewer.frames.recv().await?) != number {}
                seen.say();
            }
            // Until the next command. Says of the first frame that it is there.
            "stream" => {
                let mut order = Order::default();
                loop {
                    let frame = tokio::select! {
                        frame = viewer.frames.recv() => frame?,
                        () = commands.arrived() => break,
                    };
                    order.add(number_of(&frame));
                }
            }
            "keep" => {
                for _ in 0..number {
                    kept.push(viewer.frames.recv().await?);
                }
                let shared = kept.iter().filter(|frame| is_shared(frame)).count();
                say(format!("{shared} of {} shared", kept.len()));
            }
            "kept" => say(ranges(&kept.iter().map(number_of).collect::<Vec<_>>())),
            "release" => {
                kept.clear();
                say("released");
            }
            "view" => {
                let (mut numbers, mut shared) = (Vec::new(), 0);
                for _ in 0..number {
                    let picture = viewer.pictures.recv_view().await?;
                    assert!(picture.is_whole(), "picture {} is damaged", picture.number);
                    shared += u64::from(is_shared(&picture.pixels));
                    numbers.push(picture.number);
                }
                say(format!("{}, {shared} shared", ranges(&numbers)));
            }
            other => say(format!("unknown command `{other}`")),
        }
    }
    Ok(())
}

#[derive(Default)]
struct Seen {
    numbers: Vec<u64>,
    shared: u64,
}

impl Seen {
    fn add(&mut self, frame: Bytes) -> u64 {
        let number = number_of(&frame);
        self.numbers.push(number);
        self.shared += u64::from(is_shared(&frame));
        number
    }

    fn say(&self) {
        say(format!("{}, {} shared", ranges(&self.numbers), self.shared));
    }
}
