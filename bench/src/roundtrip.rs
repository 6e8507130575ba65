//! How long a message takes to another process and back.

use crate::figures::{self, Figures};
use scl::bytes::Bytes;
use std::os::unix::fs::DirBuilderExt;
use std::path::Path;
use std::process::{Child, Command};
use std::time::{Duration, Instant};
use zeromq::{DealerSocket, RouterSocket, Socket, SocketRecv, SocketSend, SubSocket, XPubSocket, ZmqMessage};

scl::topology!("roundtrip.yaml");

/// Rounds of [`BATCH`] messages of each way; the first ones only warm up.
const ROUNDS: usize = 80;
const WARM_UP: usize = 10;
const BATCH: usize = 500;

/// Measures round trips of a payload of so many bytes.
pub(crate) fn measure(bytes: usize) -> scl::Result<()> {
    let folder = tempfile::Builder::new().prefix("scl-bench").tempdir()?;
    let path = folder.path().to_string_lossy().into_owned();
    std::fs::DirBuilder::new().mode(0o700).create(folder.path().join("raw"))?;
    on_one_thread(play_ball(&path, Bytes::from(vec![7; bytes])))
}

/// The other process: sends everything back.
pub(crate) fn send_back(folder: &str) -> scl::Result<()> {
    on_one_thread(play_wall(folder))
}

fn on_one_thread(main: impl Future<Output = scl::Result<()>>) -> scl::Result<()> {
    tokio::runtime::Builder::new_current_thread().enable_all().build()?.block_on(main)
}

async fn play_ball(folder: &str, payload: Bytes) -> scl::Result<()> {
    let mut raw_there = XPubSocket::new();
    raw_there.bind(&raw(folder, "there")).await?;
    let _wall = OtherProcess::start(folder)?;
    let mut ball = Ball::open_with(scl::OpenOptions::new().runtime_dir(folder)).await?;
    ball.ready(Duration::from_secs(10)).await?;
    let mut raw_back = SubSocket::new();
    raw_back.connect(&raw(folder, "back")).await?;
    raw_back.subscribe("").await?;
    let mut raw_question = DealerSocket::new();
    raw_question.connect(&raw(folder, "question")).await?;
    raw_there.recv().await?;
    first_exchange(&mut raw_there, &mut raw_back, &payload).await?;

    let mut publishing = [Figures::of("SCL pub/sub"), Figures::of("raw XPUB/SUB")];
    let mut asking = [Figures::of("SCL req/rep"), Figures::of("raw DEALER/ROUTER")];
    for round in 0..ROUNDS {
        for _ in 0..BATCH {
            let started = Instant::now();
            ball.there.send(&payload).await?;
            ball.back.recv().await?;
            record(&mut publishing[0], round, started);
        }
        for _ in 0..BATCH {
            let started = Instant::now();
            raw_there.send(payload.clone().into()).await?;
            raw_back.recv().await?;
            record(&mut publishing[1], round, started);
        }
        for _ in 0..BATCH {
            let started = Instant::now();
            ball.question.call(&payload).await?;
            record(&mut asking[0], round, started);
        }
        for _ in 0..BATCH {
            let started = Instant::now();
            let mut question = ZmqMessage::from(Bytes::new());
            question.push_back(payload.clone());
            raw_question.send(question).await?;
            raw_question.recv().await?;
            record(&mut asking[1], round, started);
        }
    }
    figures::print(&format!("round trip of {} bytes between two processes", payload.len()), &[publishing, asking]);
    Ok(())
}

/// The raw subscriber's subscription takes a while to arrive, and a raw publisher does not wait for it.
async fn first_exchange(there: &mut XPubSocket, back: &mut SubSocket, payload: &Bytes) -> scl::Result<()> {
    loop {
        there.send(payload.clone().into()).await?;
        if tokio::time::timeout(Duration::from_millis(50), back.recv()).await.is_ok() {
            while tokio::time::timeout(Duration::from_millis(50), back.recv()).await.is_ok() {}
            return Ok(());
        }
    }
}

fn record(figures: &mut Figures, round: usize, started: Instant) {
    if round >= WARM_UP {
        figures.record(started.elapsed());
    }
}

async fn play_wall(folder: &str) -> scl::Result<()> {
    let mut raw_back = XPubSocket::new();
    raw_back.bind(&raw(folder, "back")).await?;
    let mut raw_question = RouterSocket::new();
    raw_question.bind(&raw(folder, "question")).await?;
    let mut raw_there = SubSocket::new();
    raw_there.connect(&raw(folder, "there")).await?;
    raw_there.subscribe("").await?;
    let mut wall = Wall::open_with(scl::OpenOptions::new().runtime_dir(folder)).await?;
    raw_back.recv().await?;
    loop {
        tokio::select! {
            ball = wall.there.recv() => wall.back.send(&ball?).await?,
            question = wall.question.recv() => {
                let question = question?;
                let answer = question.message().clone();
                question.reply(&answer).await?;
            }
            ball = raw_there.recv() => raw_back.send(ball?).await?,
            question = raw_question.recv() => raw_question.send(question?).await?,
        }
    }
}

fn raw(folder: &str, name: &str) -> String {
    format!("ipc://{}", Path::new(folder).join("raw").join(name).display())
}

/// The other process; ended when dropped.
struct OtherProcess(Child);

impl OtherProcess {
    fn start(folder: &str) -> scl::Result<Self> {
        Ok(Self(Command::new(std::env::current_exe()?).args(["wall", folder]).spawn()?))
    }
}

impl Drop for OtherProcess {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ended = self.0.kill();
        let _status = self.0.wait();
    }
}
