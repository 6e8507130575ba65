//! The subscriber processes.

use super::PERIOD;
use super::components::Subscriber;
use crate::clock::now;
use crate::raw::{SocketPaths, first_frame};
use crate::runtime::start_runtime;
use crate::worker::{print_line, unknown_arguments};
use scl::bytes::{Buf, Bytes};
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;
use zeromq::{SocketRecv, SubSocket};

/// New values that are received before each pause, so that it starts from a steady state.
const STEADY: usize = 50;

/// Delays the first pause of each subscriber by a different time, so that they do not all wake up at once.
const STAGGER: Duration = Duration::from_millis(7);

/// Pauses repeatedly, and after each pause prints the age of the first value and the time of the call, in nanoseconds.
///
/// The arguments are the id of the variant, the scratch folder, the number of repetitions, the pause in microseconds,
/// and the number of the subscriber.
pub(crate) fn run_subscriber(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, repetitions, pause, number] = arguments else { return Err(unknown_arguments(arguments)) };
    let (repetitions, pause, number): (usize, u64, u32) = (repetitions.parse()?, pause.parse()?, number.parse()?);
    let runtime = start_runtime()?;
    let mut subscription = Subscription::open(&runtime, id, folder)?;
    subscription.receive_steadily(&runtime)?;
    std::thread::sleep(STAGGER * number);
    for _ in 0..repetitions {
        subscription.receive_steadily(&runtime)?;
        subscription.pause(&runtime, Duration::from_micros(pause));
        let started = Instant::now();
        let mut value = subscription.first_value(&runtime)?;
        let (received, call) = (now(), started.elapsed());
        let age = received.saturating_sub(value.try_get_u64()?);
        print_line(&format!("{age} {}", call.as_nanos()))?;
    }
    // The publishers go on until all subscribers are done.
    loop {
        subscription.receive(&runtime)?;
    }
}

/// The receiving end of a variant.
enum Subscription {
    SclRecv(Subscriber),
    SclRecvPolled(Subscriber),
    SclRecvBlocking(Subscriber),
    SclLatest(Subscriber),
    Zeromq(SubSocket),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
}

impl Subscription {
    fn open(runtime: &Runtime, id: &str, folder: &str) -> scl::Result<Self> {
        let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
        let paths = SocketPaths::new(folder, id);
        if id == "scl-recv-blocking" {
            return Ok(Self::SclRecvBlocking(Subscriber::open_blocking_with(options)?));
        }
        runtime.block_on(async {
            Ok(match id {
                "scl-recv" => Self::SclRecv(Subscriber::open_with(options).await?),
                "scl-recv-polled" => Self::SclRecvPolled(Subscriber::open_with(options).await?),
                "scl-latest" => Self::SclLatest(Subscriber::open_with(options).await?),
                "zeromq" => Self::Zeromq(paths.connect_sub("position").await?),
                #[cfg(feature = "libzmq")]
                "libzmq" => Self::Libzmq(connect_conflated(&paths)?),
                other => return Err(unknown_arguments(&[other])),
            })
        })
    }

    /// Receives until the values are new ones, and some of these.
    fn receive_steadily(&mut self, runtime: &Runtime) -> scl::Result<()> {
        let mut new_values = 0;
        while new_values < STEADY {
            let sent = self.receive(runtime)?.try_get_u64()?;
            if u128::from(now().saturating_sub(sent)) < 5 * PERIOD.as_nanos() {
                new_values += 1;
            }
        }
        Ok(())
    }

    /// Does not receive for a while.
    fn pause(&self, runtime: &Runtime, pause: Duration) {
        match self {
            Self::SclRecvPolled(_) => runtime.block_on(async { tokio::time::sleep(pause).await }),
            _ => std::thread::sleep(pause),
        }
    }

    /// The first value after a pause.
    fn first_value(&mut self, runtime: &Runtime) -> scl::Result<Bytes> {
        let Self::SclLatest(subscriber) = self else { return self.receive(runtime) };
        runtime.block_on(async {
            loop {
                if let Some(value) = subscriber.position.latest()? {
                    return Ok(value);
                }
                tokio::task::yield_now().await;
            }
        })
    }

    fn receive(&mut self, runtime: &Runtime) -> scl::Result<Bytes> {
        match self {
            Self::SclRecv(subscriber) | Self::SclRecvPolled(subscriber) | Self::SclLatest(subscriber) => {
                Ok(runtime.block_on(subscriber.position.recv())?)
            }
            Self::SclRecvBlocking(subscriber) => Ok(subscriber.position.recv_blocking()?),
            Self::Zeromq(socket) => Ok(first_frame(runtime.block_on(socket.recv())?)),
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) => Ok(socket.recv_bytes(0)?.into()),
        }
    }
}

#[cfg(feature = "libzmq")]
fn connect_conflated(paths: &SocketPaths) -> scl::Result<zmq2::Socket> {
    let mark = crate::libzmq::HighWaterMark::Default;
    let socket = crate::libzmq::without_timeout(crate::libzmq::new_socket(&zmq2::Context::new(), zmq2::SUB, mark)?)?;
    // Takes effect only before the socket connects.
    socket.set_conflate(true)?;
    socket.set_subscribe(b"")?;
    socket.connect(&paths.endpoint("position"))?;
    Ok(socket)
}
