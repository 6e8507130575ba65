//! No role allocates per message in the steady state. Allocations are counted, not timed, so this is a test.
//!
//! This process plays one role, a worker plays the opposite one, so that the allocations of this process are those of
//! one role. Everything in it is counted, including the threads of SCL and of the runtime, so nothing else may run
//! meanwhile: it has a `main` of its own, which is also that of the workers.

use reading::Reading;
use scl::OpenOptions;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::io::{Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::runtime::{Builder, Runtime};

scl::topology!("allocations.yaml");

/// The message: of fixed size, so that its codec does not allocate.
mod reading {
    use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

    /// 20 bytes, as in the paper.
    #[derive(Debug, Clone, Default, FromBytes, IntoBytes, KnownLayout, Immutable)]
    #[repr(C)]
    pub(crate) struct Reading {
        values: [u32; 5],
    }
}

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Enough to fill all queues, so that no buffer grows afterwards.
const WARM_UP: usize = 5_000;

const MESSAGES: usize = 20_000;

/// Per 1000 messages: a buffer that many messages share may be allocated again, but nothing for each of them.
const TOLERANCE: f64 = 10.0;

const ROLES: [&str; 7] =
    ["SCL pub", "SCL sub", "SCL push", "SCL pull", "SCL req", "SCL rep", "SCL pub and sub, in turn"];

const BASELINE: &str = "Unix socket, round trip";

const CONNECT_TIMEOUT: Duration = Duration::from_secs(60);

/// The first argument of a worker.
const WORKER: &str = "worker";

fn main() -> scl::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [WORKER, role, folder] => play_opposite(role, Path::new(folder)),
        // `cargo test` asks for a list of tests, which a program without the usual harness does not have.
        ["--list", ..] => Ok(()),
        _ => check(),
    }
}

fn check() -> scl::Result<()> {
    println!("allocations per 1000 messages of {} bytes ({MESSAGES} counted)", size_of::<Reading>());
    println!("{:24}  {:>8}  {:>8}", "", "async", "blocking");
    // What tokio allocates by itself is not counted against SCL.
    let allowed = count_both(BASELINE)?.map(|allocations| allocations + TOLERANCE);
    let mut failed = Vec::new();
    for role in ROLES {
        let counts = count_both(role)?;
        if counts[0] > allowed[0] || counts[1] > allowed[1] {
            failed.push(format!("{role}: {counts:?}"));
        }
    }
    if failed.is_empty() {
        return Ok(());
    }
    Err(scl::Error::message(format!("allocations per 1000 messages, async and blocking: {}", failed.join("; "))))
}

fn count_both(role: &str) -> scl::Result<[f64; 2]> {
    let counts = [count(role, false)?, count(role, true)?];
    println!("{role:24}  {:8.2}  {:8.2}", counts[0], counts[1]);
    Ok(counts)
}

/// The allocations of this process per 1000 messages.
fn count(role: &str, is_blocking: bool) -> scl::Result<f64> {
    let folder = tempfile::Builder::new().prefix("scl-bench").tempdir()?;
    if role == BASELINE {
        return count_baseline(is_blocking, folder.path());
    }
    let worker = Worker::start(role, folder.path())?;
    if is_blocking {
        let mut near = Near::open_blocking_with(options(folder.path()))?;
        near.ready_blocking(CONNECT_TIMEOUT)?;
        let counted = repeat_blocking(|| exchange_blocking(&mut near, role));
        drop(worker);
        return counted;
    }
    start_runtime()?.block_on(async {
        let mut near = Near::open_with(options(folder.path())).await?;
        near.ready(CONNECT_TIMEOUT).await?;
        let counted = repeat(async || exchange(&mut near, role).await).await;
        drop(worker);
        counted
    })
}

fn count_baseline(is_blocking: bool, folder: &Path) -> scl::Result<f64> {
    let listener = UnixListener::bind(folder.join("baseline"))?;
    let _worker = Worker::start(BASELINE, folder)?;
    let (mut stream, _) = listener.accept()?;
    let mut frame = [0; size_of::<Reading>()];
    if is_blocking {
        return repeat_blocking(|| {
            stream.write_all(&frame)?;
            Ok(stream.read_exact(&mut frame)?)
        });
    }
    stream.set_nonblocking(true)?;
    start_runtime()?.block_on(async {
        let mut stream = tokio::net::UnixStream::from_std(stream)?;
        repeat(async || {
            stream.write_all(&frame).await?;
            stream.read_exact(&mut frame).await?;
            Ok(())
        })
        .await
    })
}

async fn repeat(mut exchange: impl AsyncFnMut() -> scl::Result<()>) -> scl::Result<f64> {
    for _ in 0..WARM_UP {
        exchange().await?;
    }
    let before = allocations();
    for _ in 0..MESSAGES {
        exchange().await?;
    }
    Ok((allocations() - before) as f64 * 1000.0 / MESSAGES as f64)
}

fn repeat_blocking(mut exchange: impl FnMut() -> scl::Result<()>) -> scl::Result<f64> {
    for _ in 0..WARM_UP {
        exchange()?;
    }
    let before = allocations();
    for _ in 0..MESSAGES {
        exchange()?;
    }
    Ok((allocations() - before) as f64 * 1000.0 / MESSAGES as f64)
}

fn allocations() -> usize {
    let stats = ALLOCATOR.stats();
    stats.allocations + stats.reallocations
}

async fn exchange(near: &mut Near, role: &str) -> scl::Result<()> {
    let reading = Reading::default();
    match role {
        "SCL pub" => near.publish.send(&reading).await?,
        "SCL sub" => {
            near.subscribe.recv().await?;
        }
        "SCL push" => near.push.send(&reading).await?,
        "SCL pull" => {
            near.pull.recv().await?;
        }
        "SCL req" => {
            near.request.call(&reading).await?;
        }
        "SCL rep" => near.reply.recv().await?.reply(&reading)?,
        _ => {
            near.publish.send(&reading).await?;
            near.subscribe.recv().await?;
        }
    }
    Ok(())
}

fn exchange_blocking(near: &mut Near, role: &str) -> scl::Result<()> {
    let reading = Reading::default();
    match role {
        "SCL pub" => near.publish.send_blocking(&reading)?,
        "SCL sub" => {
            near.subscribe.recv_blocking()?;
        }
        "SCL push" => near.push.send_blocking(&reading)?,
        "SCL pull" => {
            near.pull.recv_blocking()?;
        }
        "SCL req" => {
            near.request.call_blocking(&reading)?;
        }
        "SCL rep" => near.reply.recv_blocking()?.reply(&reading)?,
        _ => {
            near.publish.send_blocking(&reading)?;
            near.subscribe.recv_blocking()?;
        }
    }
    Ok(())
}

/// This program, started again to play the opposite role. Dropping it kills it, before the near end is closed.
struct Worker(Child);

impl Worker {
    fn start(role: &str, folder: &Path) -> scl::Result<Self> {
        let mut command = Command::new(std::env::current_exe()?);
        Ok(Self(command.arg(WORKER).arg(role).arg(folder).stdin(Stdio::piped()).spawn()?))
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // Fails if it has exited already.
        let _killed = self.0.kill();
        let _status = self.0.wait();
    }
}

/// The worker, which ends when its input closes.
fn play_opposite(role: &str, folder: &Path) -> scl::Result<()> {
    std::thread::spawn(|| {
        let _ended = std::io::copy(&mut std::io::stdin(), &mut std::io::sink());
        std::process::exit(0);
    });
    if role == BASELINE {
        let mut stream = UnixStream::connect(folder.join("baseline"))?;
        let mut frame = [0; size_of::<Reading>()];
        while stream.read_exact(&mut frame).and_then(|()| stream.write_all(&frame)).is_ok() {}
        return Ok(());
    }
    start_runtime()?.block_on(async {
        let mut far = Far::open_with(options(folder)).await?;
        let reading = Reading::default();
        loop {
            match role {
                "SCL pub" => {
                    far.subscribe.recv().await?;
                }
                "SCL sub" => far.publish.send(&reading).await?,
                "SCL push" => {
                    far.pull.recv().await?;
                }
                "SCL pull" => far.push.send(&reading).await?,
                "SCL req" => far.reply.recv().await?.reply(&reading)?,
                "SCL rep" => {
                    far.request.call(&reading).await?;
                }
                _ => {
                    far.subscribe.recv().await?;
                    far.publish.send(&reading).await?;
                }
            }
        }
    })
}

fn options(folder: &Path) -> OpenOptions {
    OpenOptions::new().runtime_dir(folder).system("allocations")
}

fn start_runtime() -> scl::Result<Runtime> {
    Ok(Builder::new_current_thread().enable_all().build()?)
}
