//! What `pub` and `push` share: a message is encoded once, or written into memory that the gate lends.

use super::Connection;
use super::encoding::Encoding;
use super::fanout::{Fanout, Outbound};
use super::loaned::Loaned;
use super::tap::GateTap;
use crate::codec::Codec;
use crate::error::{LoanError, SendError, SendTimeoutError, TrySendError};
use crate::spec::GateSpec;
use crate::state::Owner;
use std::sync::{Arc, Mutex};
use std::time::Duration;

pub(crate) struct Outgoing<T> {
    pub(crate) fanout: Fanout,
    encoding: Encoding<T>,
}

impl<T> Outgoing<T> {
    pub(crate) fn new<C: Codec<T>>(
        state: Owner,
        spec: &'static GateSpec,
        connections: Vec<Arc<Mutex<Connection>>>,
        tap: GateTap,
    ) -> Self {
        let encoding = Encoding::new::<C>(&state, spec);
        Self { fanout: Fanout::new(state, spec, connections, tap), encoding }
    }

    pub(crate) async fn send(&mut self, message: &T) -> Result<(), SendError> {
        let message = self.encode(message)?;
        self.fanout.send(message).await
    }

    /// Sends after [`Fanout::poll_room`] was ready.
    pub(crate) fn send_now(&mut self, message: &T) -> Result<(), SendError> {
        let message = self.encode(message)?;
        self.fanout.hand_out(message);
        Ok(())
    }

    pub(crate) fn send_blocking(&mut self, message: &T) -> Result<(), SendError> {
        self.fanout.send_blocking(|| self.encoding.encode(message).map(Outbound::Bytes))
    }

    pub(crate) fn send_timeout(&mut self, message: &T, timeout: Duration) -> Result<(), SendTimeoutError> {
        self.fanout.send_timeout(|| self.encoding.encode(message).map(Outbound::Bytes), timeout)
    }

    pub(crate) fn try_send(&mut self, message: &T) -> Result<(), TrySendError> {
        self.fanout.try_send(|| self.encoding.encode(message).map(Outbound::Bytes))
    }

    /// See [`Fanout::offer`].
    #[cfg(feature = "logging")]
    pub(crate) fn offer(&mut self, message: &T) -> Result<bool, SendError> {
        self.fanout.offer(|| self.encoding.encode(message).map(Outbound::Bytes))
    }

    /// Lends memory for one message. Fails if the gate's codec is not `C`.
    pub(crate) fn loan<C: Codec<T>, M: ?Sized>(
        &mut self,
        length: usize,
        alignment: usize,
    ) -> Result<Loaned<'_, M>, LoanError> {
        if !self.encoding.is::<C>() {
            return Err(LoanError::Codec { gate: self.fanout.name, codec: self.fanout.spec.codec });
        }
        Loaned::new(&mut self.fanout, length, alignment)
    }

    fn encode(&mut self, message: &T) -> Result<Outbound, SendError> {
        self.fanout.accept(|| self.encoding.encode(message).map(Outbound::Bytes))
    }
}
