//! The variants of SCL that differ only in their transport, and in who makes the copies.

use super::batch_client::BatchClient;
use crate::engines::{Client, Echo, FAR, NEAR, options};
use crate::worker::Worker;
use scl::bytes::Bytes;
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;

const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// The side that measures.
struct EngineClient {
    client: Client,
    is_blocking: bool,
    is_loaned: bool,
    /// Dropped after the component.
    #[cfg(feature = "gateway")]
    _gateways: Option<crate::gateway::Gateways>,
}

pub(super) fn start(
    runtime: &Runtime,
    id: &str,
    folder: &str,
    echo: &[&str],
) -> scl::Result<(Box<dyn BatchClient>, Worker)> {
    let (client, echo) = connect(runtime, id, folder, echo)?;
    Ok((Box::new(client), echo))
}

/// [`start`] over two gateways.
#[cfg(feature = "gateway")]
pub(super) fn start_across_hosts(
    runtime: &Runtime,
    folder: &str,
    echo: &[&str],
) -> scl::Result<(Box<dyn BatchClient>, Worker)> {
    let gateways = crate::engines::start_gateways(folder)?;
    let (client, echo) = connect(runtime, "gateway", folder, echo)?;
    Ok((Box::new(EngineClient { _gateways: Some(gateways), ..client }), echo))
}

fn connect(runtime: &Runtime, id: &str, folder: &str, echo: &[&str]) -> scl::Result<(EngineClient, Worker)> {
    let (is_blocking, is_loaned) = (id.ends_with("-blocking"), id.contains("-loan"));
    let echo = Worker::start(echo)?;
    let client = if is_blocking {
        let client = Client::open_blocking_with(options(id, folder, NEAR))?;
        client.ready_blocking(CONNECT_TIMEOUT)?;
        client
    } else {
        runtime.block_on(async {
            let client = Client::open_with(options(id, folder, NEAR)).await?;
            client.ready(CONNECT_TIMEOUT).await?;
            Ok::<_, scl::Error>(client)
        })?
    };
    let client = EngineClient {
        client,
        is_blocking,
        is_loaned,
        #[cfg(feature = "gateway")]
        _gateways: None,
    };
    Ok((client, echo))
}

impl EngineClient {
    async fn exchange_one(&mut self, message: &Bytes) -> scl::Result<()> {
        if self.is_loaned {
            self.client.ping.loan_bytes(message.len())?.send().await?;
        } else {
            self.client.ping.send(message).await?;
        }
        self.client.pong.recv().await?;
        Ok(())
    }

    fn exchange_one_blocking(&mut self, message: &Bytes) -> scl::Result<()> {
        if self.is_loaned {
            self.client.ping.loan_bytes(message.len())?.send_blocking()?;
        } else {
            self.client.ping.send_blocking(message)?;
        }
        self.client.pong.recv_blocking()?;
        Ok(())
    }
}

impl BatchClient for EngineClient {
    fn exchange(
        &mut self,
        runtime: &Runtime,
        message: &Bytes,
        messages: usize,
        record: &mut dyn FnMut(Instant),
    ) -> scl::Result<()> {
        if self.is_blocking {
            for _ in 0..messages {
                let started = Instant::now();
                self.exchange_one_blocking(message)?;
                record(started);
            }
            return Ok(());
        }
        runtime.block_on(async {
            for _ in 0..messages {
                let started = Instant::now();
                self.exchange_one(message).await?;
                record(started);
            }
            Ok(())
        })
    }
}

/// Sends every message back: copied, or as a new loan of the same size. A received message of a gate of bytes is a view
/// of the memory it arrived in.
pub(super) async fn echo(id: &str, folder: &str) -> scl::Result<()> {
    let mut echo = Echo::open_with(options(id, folder, FAR)).await?;
    loop {
        let message = echo.ping.recv().await?;
        if id.contains("-loan") {
            echo.pong.loan_bytes(message.len())?.send().await?;
        } else {
            echo.pong.send(&message).await?;
        }
    }
}

/// [`echo`] without async.
pub(super) fn echo_blocking(id: &str, folder: &str) -> scl::Result<()> {
    let mut echo = Echo::open_blocking_with(options(id, folder, FAR))?;
    loop {
        let message = echo.ping.recv_blocking()?;
        if id.contains("-loan") {
            echo.pong.loan_bytes(message.len())?.send_blocking()?;
        } else {
            echo.pong.send_blocking(&message)?;
        }
    }
}
