//! The side that sends everything back.

use super::components::Wall;
use crate::processes::{say, start_runtime, wrong_words};
use crate::raw::{self, RawPlace};
use std::os::unix::net::UnixStream as StdUnixStream;
use tokio::net::UnixStream;
use zeromq::{RouterSocket, Socket, SocketRecv, SocketSend};

/// Plays the wall of the way that the words name, with the scenario's folder and the messages' length.
pub(crate) fn play_wall(words: &[&str]) -> scl::Result<()> {
    let [word, folder, bytes] = words else { return Err(wrong_words(words)) };
    let bytes: usize = bytes.parse()?;
    let place = RawPlace::new(folder, word);
    let options = scl::OpenOptions::new().runtime_dir(*folder).system(*word);
    let runtime = start_runtime()?;
    match *word {
        "scl-publish" => runtime.block_on(scl_publish(options)),
        "scl-call" => runtime.block_on(scl_call(options)),
        "scl-publish-blocking" => scl_publish_blocking(options),
        "scl-call-blocking" => scl_call_blocking(options),
        "raw-publish" => runtime.block_on(raw_publish(&place)),
        "raw-call" => runtime.block_on(raw_call(&place)),
        #[cfg(feature = "libzmq")]
        "libzmq-publish-blocking" => super::libzmq::send_back_published(&place),
        #[cfg(feature = "libzmq")]
        "libzmq-call-blocking" => super::libzmq::send_back_asked(&place),
        "unix" => runtime.block_on(async {
            let stream = UnixStream::connect(place.socket("stream")).await?;
            raw::send_back(stream, bytes).await
        }),
        "unix-blocking" => raw::send_back_blocking(StdUnixStream::connect(place.socket("stream"))?, bytes),
        _ => Err(wrong_words(words)),
    }
}

async fn scl_publish(options: scl::OpenOptions) -> scl::Result<()> {
    let mut wall = Wall::open_with(options).await?;
    loop {
        let message = wall.there.recv().await?;
        wall.back.send(&message).await?;
    }
}

async fn scl_call(options: scl::OpenOptions) -> scl::Result<()> {
    let mut wall = Wall::open_with(options).await?;
    loop {
        let question = wall.question.recv().await?;
        let answer = question.message().clone();
        question.reply(&answer).await?;
    }
}

fn scl_publish_blocking(options: scl::OpenOptions) -> scl::Result<()> {
    let mut wall = Wall::open_blocking_with(options)?;
    loop {
        let message = wall.there.recv_blocking()?;
        wall.back.send_blocking(&message)?;
    }
}

fn scl_call_blocking(options: scl::OpenOptions) -> scl::Result<()> {
    let mut wall = Wall::open_blocking_with(options)?;
    loop {
        let question = wall.question.recv_blocking()?;
        let answer = question.message().clone();
        question.reply_now(&answer)?;
    }
}

async fn raw_publish(place: &RawPlace) -> scl::Result<()> {
    let mut back = place.publish("back").await?;
    say("ready")?;
    let mut there = place.subscribe("there").await?;
    // The ball's subscription.
    back.recv().await?;
    loop {
        let message = there.recv().await?;
        back.send(message).await?;
    }
}

async fn raw_call(place: &RawPlace) -> scl::Result<()> {
    let mut socket = RouterSocket::new();
    socket.bind(&place.zeromq("question")).await?;
    say("ready")?;
    loop {
        let question = socket.recv().await?;
        socket.send(question).await?;
    }
}
