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
            // Anything else that a peer sends here has no meaning.
            item => {
                if let (Some(topics), Some(subscription)) = (&mut self.topics, item.into_subscription()) {
                    topics.handle(subscription)?;
                }
            }
        }
        Ok(())
    }

    pub(super) fn try_drive(&mut self, cx: &mut Context<'_>) -> Result<(), Closed> {
        // Without a runtime nothing interrupts a peer that never stops sending.
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
            // Behind everything that was sent.
            self.session.write(FINISHED)?;
            self.state = State::Finished;
        }
        Ok(self.session.flush(cx)?)
    }

    /// Looks past what the runtime knows.
    pub(super) fn try_drive_raw(&mut self, cx: &Context<'_>) -> Result<(), Closed> {
        let mut reads = RAW_READS;
        while reads > 0 && self.session.fill_raw()? {
            while let Some(item) = self.session.buffered_item()? {
                self.handle(item)?;
            }
            reads -= 1;
            // The runtime does not report what was read without it, and the task may wait for an acknowledgement.
            cx.waker().wake_by_ref();
        }
        Ok(self.session.flush_raw()?)
    }
}
