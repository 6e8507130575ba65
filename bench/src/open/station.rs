//! The processes that are watched.

use super::components::{Neighbour, Station};
use crate::processes::{say, start_runtime, wrong_words};
use crate::raw::RawPlace;
use std::future::pending;
use std::time::{Duration, Instant};
use zeromq::{DealerSocket, PullSocket, PushSocket, RouterSocket, Socket, SubSocket};

const PATIENCE: Duration = Duration::from_secs(10);

/// Opens what the words name in a folder, says how long that took in nanoseconds, and rests.
pub(crate) fn play(words: &[&str]) -> scl::Result<()> {
    let [word, folder, ready] = words else { return Err(wrong_words(words)) };
    let options = scl::OpenOptions::new().runtime_dir(*folder).system("open");
    start_runtime()?.block_on(async {
        let started = Instant::now();
        match *word {
            "station" => {
                let station = Station::open_with(options).await?;
                say_time(started)?;
                if *ready == "connected" {
                    station.ready(PATIENCE).await?;
                }
                rest(station).await
            }
            "neighbour" => rest(Neighbour::open_with(options).await?).await,
            "sockets" => {
                let sockets = open_sockets(&RawPlace::new(folder, "socket")).await?;
                say_time(started)?;
                rest(sockets).await
            }
            "nothing" => {
                say_time(started)?;
                rest(()).await
            }
            _ => Err(wrong_words(words)),
        }
    })
}

fn say_time(started: Instant) -> scl::Result<()> {
    say(&started.elapsed().as_nanos().to_string())
}

/// Keeps what was opened until the process ends.
async fn rest<T>(kept: T) -> scl::Result<()> {
    say("rests")?;
    pending::<()>().await;
    drop(kept);
    Ok(())
}

/// The sockets that ten such gates need at least: the ends that listen are bound.
async fn open_sockets(place: &RawPlace) -> scl::Result<impl Sized + use<>> {
    let mut router = RouterSocket::new();
    let mut pull = PullSocket::new();
    let publishing = (place.publish("a").await?, place.publish("b").await?, place.publish("c").await?);
    router.bind(&place.zeromq("d")).await?;
    pull.bind(&place.zeromq("e")).await?;
    let connecting = ([SubSocket::new(), SubSocket::new(), SubSocket::new()], DealerSocket::new(), PushSocket::new());
    Ok((publishing, router, pull, connecting))
}
