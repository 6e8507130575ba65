//! The subscriber processes.

use super::PERIOD;
use crate::clock::now;
use crate::components::fresh::Subscriber;
use crate::ends::Receiver;
use crate::link::open;
use crate::raw::SocketPaths;
use crate::runtime::{run, start_runtime};
use crate::worker::{print_line, unknown_arguments};
use scl::bytes::Buf;
use std::thread;
use std::time::{Duration, Instant};

/// New values that are received before each pause, so that it starts from a steady state.
const STEADY: usize = 50;

/// Delays the first pause of each subscriber by a different time, so that they do not all wake up at once.
const STAGGER: Duration = Duration::from_millis(7);

/// Pauses repeatedly, and after each pause prints the age of the first value and the time of the call, in nanoseconds.
///
/// The arguments are the id of the variant, the scratch folder, the number of repetitions, the pause in microseconds,
/// and the number of the subscriber.
pub(crate) fn run_subscriber(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, repetitions, pause, number] = *arguments else { return Err(unknown_arguments(arguments)) };
    let (repetitions, number): (usize, u32) = (repetitions.parse()?, number.parse()?);
    let pause = Duration::from_micros(pause.parse()?);
    run(&start_runtime()?, id, async {
        let mut receiver = open_receiver(id, folder).await?;
        receive_steadily(&mut receiver).await?;
        thread::sleep(STAGGER * number);
        for _ in 0..repetitions {
            receive_steadily(&mut receiver).await?;
            if id == "scl-recv-polled" {
                tokio::time::sleep(pause).await;
            } else {
                thread::sleep(pause);
            }
            let started = Instant::now();
            let sent = first_value(&mut receiver, id).await?;
            let (received, call) = (now(), started.elapsed());
            print_line(&format!("{} {}", received.saturating_sub(sent), call.as_nanos()))?;
        }
        // Keep receiving: the publishers continue until all subscribers are done.
        loop {
            receiver.receive().await?;
        }
    })
}

async fn open_receiver(id: &str, folder: &str) -> scl::Result<Receiver> {
    let paths = SocketPaths::new(folder, id);
    Ok(match id {
        "scl-recv" | "scl-recv-polled" | "scl-recv-blocking" | "scl-latest" => {
            let is_blocking = id.ends_with("-blocking");
            let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
            Receiver::Sub(open!(Subscriber, options, is_blocking).position, is_blocking)
        }
        "zeromq" => Receiver::Zeromq(Box::new(paths.connect_sub("position").await?)),
        #[cfg(feature = "libzmq")]
        "libzmq" => Receiver::Libzmq(paths.connect_conflated("position")?),
        other => return Err(unknown_arguments(&[other])),
    })
}

/// Receives until [`STEADY`] values were new, that is less than five periods old, on arrival.
async fn receive_steadily(receiver: &mut Receiver) -> scl::Result<()> {
    let mut new_values = 0;
    while new_values < STEADY {
        let sent = receiver.receive().await?.sent_time()?;
        if u128::from(now().saturating_sub(sent)) < 5 * PERIOD.as_nanos() {
            new_values += 1;
        }
    }
    Ok(())
}

/// Receives the first value after a pause and returns the time at which it was sent.
async fn first_value(receiver: &mut Receiver, id: &str) -> scl::Result<u64> {
    match receiver {
        Receiver::Sub(gate, _) if id == "scl-latest" => loop {
            if let Some(mut value) = gate.latest()? {
                return Ok(value.try_get_u64()?);
            }
            tokio::task::yield_now().await;
        },
        receiver => receiver.receive().await?.sent_time(),
    }
}
