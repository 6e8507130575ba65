//! The variants of SCL that differ only in their transport, and in who makes the copies.

use super::batch::{Batch, BatchReceiver, BatchSender};
use super::message::Message;
use crate::engines::{FAR, NEAR, Sink, Source, options};
use crate::worker::Worker;
use std::time::Duration;
use tokio::runtime::Runtime;

const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

struct EngineSender {
    source: Source,
    is_blocking: bool,
    is_loaned: bool,
    /// Dropped after the component.
    #[cfg(feature = "gateway")]
    _gateways: Option<crate::gateway::Gateways>,
}

struct EngineReceiver {
    sink: Sink,
    is_blocking: bool,
}

pub(super) fn start(
    runtime: &Runtime,
    id: &str,
    folder: &str,
    receiver: &[&str],
) -> scl::Result<(Box<dyn BatchSender>, Worker)> {
    let (sender, receiver) = connect(runtime, id, folder, receiver)?;
    Ok((Box::new(sender), receiver))
}

/// [`start`] over two gateways.
#[cfg(feature = "gateway")]
pub(super) fn start_across_hosts(
    runtime: &Runtime,
    folder: &str,
    receiver: &[&str],
) -> scl::Result<(Box<dyn BatchSender>, Worker)> {
    let gateways = crate::engines::start_gateways(folder)?;
    let (sender, receiver) = connect(runtime, "gateway", folder, receiver)?;
    Ok((Box::new(EngineSender { _gateways: Some(gateways), ..sender }), receiver))
}

fn connect(runtime: &Runtime, id: &str, folder: &str, receiver: &[&str]) -> scl::Result<(EngineSender, Worker)> {
    let (is_blocking, is_loaned) = (id.ends_with("-blocking"), id.contains("-loan"));
    let receiver = Worker::start(receiver)?;
    let source = if is_blocking {
        let source = Source::open_blocking_with(options(id, folder, NEAR))?;
        source.ready_blocking(CONNECT_TIMEOUT)?;
        source
    } else {
        runtime.block_on(async {
            let source = Source::open_with(options(id, folder, NEAR)).await?;
            source.ready(CONNECT_TIMEOUT).await?;
            Ok::<_, scl::Error>(source)
        })?
    };
    let sender = EngineSender {
        source,
        is_blocking,
        is_loaned,
        #[cfg(feature = "gateway")]
        _gateways: None,
    };
    Ok((sender, receiver))
}

pub(super) fn open(runtime: &Runtime, id: &str, folder: &str) -> scl::Result<Box<dyn BatchReceiver>> {
    let is_blocking = id.ends_with("-blocking");
    let sink = if is_blocking {
        Sink::open_blocking_with(options(id, folder, FAR))?
    } else {
        runtime.block_on(Sink::open_with(options(id, folder, FAR)))?
    };
    Ok(Box::new(EngineReceiver { sink, is_blocking }))
}

impl BatchSender for EngineSender {
    fn send_batch(&mut self, runtime: &Runtime, message: &Message, batch: usize) -> scl::Result<()> {
        let (time, payload) = (message.time()?.to_be_bytes(), &message.payload);
        let stream = &mut self.source.stream;
        if self.is_blocking {
            for _ in 0..batch {
                if self.is_loaned {
                    let mut loaned = stream.loan_bytes(payload.len())?;
                    loaned[..time.len()].copy_from_slice(&time);
                    loaned.send_blocking()?;
                } else {
                    stream.send_blocking(payload)?;
                }
            }
            return Ok(());
        }
        runtime.block_on(async {
            for _ in 0..batch {
                if self.is_loaned {
                    let mut loaned = stream.loan_bytes(payload.len())?;
                    loaned[..time.len()].copy_from_slice(&time);
                    loaned.send().await?;
                } else {
                    stream.send(payload).await?;
                }
            }
            Ok(())
        })
    }
}

impl BatchReceiver for EngineReceiver {
    fn receive_batch(&mut self, runtime: &Runtime, batch: &mut Batch) -> scl::Result<()> {
        if self.is_blocking {
            while !batch.is_complete() {
                batch.add(&self.sink.stream.recv_blocking()?)?;
            }
            return Ok(());
        }
        runtime.block_on(async {
            while !batch.is_complete() {
                batch.add(&self.sink.stream.recv().await?)?;
            }
            Ok(())
        })
    }
}
