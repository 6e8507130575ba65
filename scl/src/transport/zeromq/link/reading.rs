//! What a link reads from its peer: acknowledgements, subscriptions and commands.

use super::{RAW_READS, SendLink, State};
use crate::transport::zeromq::session::Closed;
use crate::transport::zeromq::zmtp::{Command, FINISHED, Item, ProtocolError};
use std::task::Context;

impl SendLink {
    pub(super) fn handle(&mut self, item: Item) -> Result<(), ProtocolError> {
        match item {
            Item::Command(Command::Acknowledged { taken, received }) => {
                if let Some(credit) = &mut self.credit {
                    credit.acknowledge(taken, received)?;
                    self.sharing.acknowledge(taken);
                }
            }
            Item::Command(Command::ShmOpen) => self.sharing.open(),
            Item::Command(Command::CatchUp(number)) => self.waiting_report.ask(number),
            Item::Command(Command::Finish) if self.state == State::Open => self.state = State::Finishing,
            // Everything else is ignored, except for subscriptions.
            item => {
                if let (Some(topics), Some(subscription)) = (&mut self.topics, item.into_subscription()) {
                    topics.handle(subscription)?;
                }
            }
        }
        Ok(())
    }

    pub(super) fn try_drive(&mut self, cx: &mut Context<'_>) -> Result<(), Closed> {
        // Without a runtime, nothing else stops this loop while a peer keeps sending.
        let mut reads = if self.detached { RAW_READS } else { usize::MAX };
        loop {
            while let Some(item) = self.session.buffered_item()? {
                self.handle(item)?;
            }
            if reads == 0 || self.session.poll_fill(cx)?.is_pending() {
                break;
            }
            reads -= 1;
        }
        if self.state == State::Finishing {
            // Written after all messages that were sent.
            self.session.write(FINISHED)?;
            self.state = State::Finished;
        }
        Ok(self.session.flush(cx)?)
    }

    /// Reads and writes the socket directly, without the runtime.
    pub(super) fn try_drive_raw(&mut self, cx: &Context<'_>) -> Result<(), Closed> {
        let mut reads = RAW_READS;
        while reads > 0 && self.session.fill_raw()? {
            while let Some(item) = self.session.buffered_item()? {
                self.handle(item)?;
            }
            reads -= 1;
            // tokio does not see raw reads, and the task may be waiting for an acknowledgement, so wake it explicitly.
            cx.waker().wake_by_ref();
        }
        Ok(self.session.flush_raw()?)
    }
}
