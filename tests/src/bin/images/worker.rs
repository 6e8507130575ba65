//! The worker: pulls jobs.

use crate::Worker;
use crate::order::Order;
use crate::picture::number_of;
use scl_tests::{Commands, is_shared, ranges, say};

pub(crate) async fn play() -> scl::Result<()> {
    let mut worker = Worker::open().await?;
    say("open");
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        let number = words.get(1).and_then(|word| word.parse::<u64>().ok()).unwrap_or_default();
        match words.first().map_or("", String::as_str) {
            "pull" => {
                let (mut numbers, mut shared) = (Vec::new(), 0);
                for _ in 0..number {
                    let job = worker.jobs.recv().await?;
                    numbers.push(number_of(&job));
                    shared += u64::from(is_shared(&job));
                }
                say(format!("{}, {shared} shared", ranges(&numbers)));
            }
            // Until the next command. Says of the first job that it is there.
            "stream" => {
                let mut order = Order::without_gaps();
                loop {
                    let job = tokio::select! {
                        job = worker.jobs.recv() => job?,
                        () = commands.arrived() => break,
                    };
                    order.add(number_of(&job));
                }
            }
            other => say(format!("unknown command `{other}`")),
        }
    }
    Ok(())
}
