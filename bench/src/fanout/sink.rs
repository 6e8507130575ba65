//! The processes that listen.

use super::components::{Sink1, Sink2, Sink3, Sink4, Sink5, Sink6, Sink7, Sink8};
use super::message::Message;
use crate::clock::now;
use crate::one_way::Received;
use crate::processes::{say, start_runtime, wrong_words};
use crate::raw::{RawPlace, only_frame};
use rustix::process::{Signal, set_parent_process_death_signal};
use scl::Sub;
use scl::bytes::Bytes;
use zeromq::{SocketRecv, SubSocket};

/// Listens for ever on the way that the words name, with the scenario's folder and which of the eight it is; says the
/// delays of each batch when its last message has come.
pub(crate) fn play_sink(words: &[&str]) -> scl::Result<()> {
    let [word, folder, number] = words else { return Err(wrong_words(words)) };
    // A process that is stopped does not see that its input has ended.
    set_parent_process_death_signal(Some(Signal::KILL))?;
    start_runtime()?.block_on(async {
        let mut sink = Sink::open(word, folder, number).await?;
        let (mut batch, mut delays) = (0, Vec::new());
        loop {
            let message = Message::decode(sink.receive().await?)?;
            if message.batch != batch {
                batch = message.batch;
                delays.clear();
            }
            delays.push(now().saturating_sub(message.sent));
            if message.following == 0 {
                say(&Received { span: batch.into(), delays: std::mem::take(&mut delays) }.to_line())?;
            }
        }
    })
}

/// The receiving end of a way.
enum Sink {
    Scl(Sub<Bytes>),
    Raw(SubSocket),
}

impl Sink {
    async fn open(word: &str, folder: &str, number: &str) -> scl::Result<Self> {
        match word {
            "scl" => {
                let options = scl::OpenOptions::new().runtime_dir(folder).system(word);
                Ok(Self::Scl(open_gate(number, options).await?))
            }
            "raw" => Ok(Self::Raw(RawPlace::new(folder, word).subscribe("stream").await?)),
            other => Err(wrong_words(&[other])),
        }
    }

    async fn receive(&mut self) -> scl::Result<Bytes> {
        Ok(match self {
            Self::Scl(stream) => stream.recv().await?,
            Self::Raw(socket) => only_frame(socket.recv().await?),
        })
    }
}

async fn open_gate(number: &str, options: scl::OpenOptions) -> scl::Result<Sub<Bytes>> {
    Ok(match number {
        "1" => Sink1::open_with(options).await?.stream,
        "2" => Sink2::open_with(options).await?.stream,
        "3" => Sink3::open_with(options).await?.stream,
        "4" => Sink4::open_with(options).await?.stream,
        "5" => Sink5::open_with(options).await?.stream,
        "6" => Sink6::open_with(options).await?.stream,
        "7" => Sink7::open_with(options).await?.stream,
        "8" => Sink8::open_with(options).await?.stream,
        other => return Err(wrong_words(&[other])),
    })
}
