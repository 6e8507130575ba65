//! The end of each case: all ends are there, and everything that was not lost as declared must arrive.

use super::stage::Stage;
use crate::model::runner::Outcome;
use std::future::poll_fn;
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};

/// How often the tasks may run until everything has arrived. Each time the memory transport can be filled.
const ROUNDS: usize = 50;
/// How long something may take over sockets at most.
const PATIENCE: Duration = Duration::from_secs(300);
/// How long to wait for a message until another one is sent, since the first may have been lost with a peer.
const AGAIN: Duration = Duration::from_millis(20);

impl Stage {
    pub(super) async fn end(&mut self) -> Outcome {
        self.sender_appears().await?;
        for reader in 0..self.readers.len() {
            self.reader_appears(reader).await?;
        }
        if self.promise.is_exact() { self.end_in_memory().await } else { self.end_over_sockets().await }
    }

    async fn end_in_memory(&mut self) -> Outcome {
        self.receive_everything().await?;
        self.try_send()?;
        self.receive_everything().await
    }

    async fn receive_everything(&mut self) -> Outcome {
        for _ in 0..ROUNDS {
            self.tasks_run().await?;
            for reader in 0..self.readers.len() {
                while self.poll_recv(reader, &mut Context::from_waker(Waker::noop()))?.is_some() {}
            }
            self.check()?;
            if self.model.lock().is_idle() {
                return Ok(());
            }
        }
        Err("not everything arrives".to_owned())
    }

    /// Sends until every reader has received something new, which comes after everything else.
    async fn end_over_sockets(&mut self) -> Outcome {
        let (before, started) = (self.last, Instant::now());
        let mut served = vec![false; self.readers.len()];
        while started.elapsed() < PATIENCE {
            if served.contains(&false) {
                self.try_send()?;
            }
            let arrives = poll_fn(|cx| {
                let mut any = false;
                for (reader, served) in served.iter_mut().enumerate() {
                    loop {
                        match self.poll_recv(reader, cx) {
                            Ok(Some(message)) => (any, *served) = (true, *served || message > before),
                            Ok(None) => break,
                            Err(reason) => return Poll::Ready(Err(reason)),
                        }
                    }
                }
                if any { Poll::Ready(Ok(())) } else { Poll::Pending }
            });
            if let Ok(Err(reason)) = tokio::time::timeout(AGAIN, arrives).await {
                return Err(reason);
            }
            self.check()?;
            if !served.contains(&false) && self.model.lock().is_idle() {
                return Ok(());
            }
        }
        Err(format!("not everything arrives; readers that receive at all: {served:?}"))
    }
}
