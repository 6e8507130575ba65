//! The processes that are observed.

use super::components::{Neighbour, Station};
use crate::raw::SocketPaths;
use crate::runtime::start_runtime;
use crate::worker::{print_line, unknown_arguments};
use std::future::pending;
use std::time::{Duration, Instant};
use zeromq::{DealerSocket, PullSocket, PushSocket, RouterSocket, Socket, SubSocket};

const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// Opens something, prints how long that took in nanoseconds, and idles. The arguments are what to open, the scratch
/// folder, and whether to wait for the neighbour.
pub(crate) fn run_station(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, ready] = arguments else { return Err(unknown_arguments(arguments)) };
    let options = scl::OpenOptions::new().runtime_dir(*folder).system("open");
    start_runtime()?.block_on(async {
        let started = Instant::now();
        match *id {
            "station" => {
                let station = Station::open_with(options).await?;
                print_elapsed(started)?;
                if *ready == "connected" {
                    station.ready(CONNECT_TIMEOUT).await?;
                }
                idle(station).await
            }
            "neighbour" => idle(Neighbour::open_with(options).await?).await,
            "sockets" => {
                let sockets = open_sockets(&SocketPaths::new(folder, "socket")).await?;
                print_elapsed(started)?;
                idle(sockets).await
            }
            "nothing" => {
                print_elapsed(started)?;
                idle(()).await
            }
            _ => Err(unknown_arguments(arguments)),
        }
    })
}

fn print_elapsed(started: Instant) -> scl::Result<()> {
    print_line(&started.elapsed().as_nanos().to_string())
}

/// Keeps what was opened until the process ends.
async fn idle<T>(opened: T) -> scl::Result<()> {
    print_line("idle")?;
    pending::<()>().await;
    drop(opened);
    Ok(())
}

/// The fewest sockets that ten such gates need. Those of the listening gates are bound.
async fn open_sockets(paths: &SocketPaths) -> scl::Result<impl Sized + use<>> {
    let mut router = RouterSocket::new();
    let mut pull = PullSocket::new();
    let publishers = (paths.bind_xpub("a").await?, paths.bind_xpub("b").await?, paths.bind_xpub("c").await?);
    router.bind(&paths.endpoint("d")).await?;
    pull.bind(&paths.endpoint("e")).await?;
    let connecting = ([SubSocket::new(), SubSocket::new(), SubSocket::new()], DealerSocket::new(), PushSocket::new());
    Ok((publishers, router, pull, connecting))
}
