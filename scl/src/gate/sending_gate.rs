//! The face of the gates that send, once for both of them.

/// Makes `Pub` and `Push`: the same calls over [`Sending`](super::sending::Sending), which knows the difference.
macro_rules! sending_gate {
    ($(#[$doc:meta])* $gate:ident to $peer:literal) => {
        use crate::component::Core;
        use crate::error::{SendError, TrySendError};
        use crate::gate::sending::Sending;
        use crate::gate::{AnyGate, GateStats};
        use crate::spec::{GateSpec, LinkSpec};
        use futures_sink::Sink;
        use std::pin::Pin;
        use std::sync::Arc;
        use std::task::{Context, Poll};

        $(#[$doc])*
        pub struct $gate<T> {
            sending: Sending<T>,
        }

        impl<T> $gate<T> {
            pub(crate) fn new(sending: Sending<T>) -> Self {
                Self { sending }
            }

            #[doc = concat!("Sends a message to ", $peer, ".")]
            ///
            /// It returns at once: what a peer cannot take now waits in that connection's queue and follows by itself. Only a
            /// gate with `backpressure: true` waits, for a peer with `when_full: wait` whose queue is full.
            ///
            /// # Errors
            /// [`SendError::Encode`] when the codec cannot express the message; nothing was sent then.
            ///
            /// # Cancel safety
            /// Cancel safe: a message goes to all connections at once, or, if this is dropped while it waits, to none.
            pub async fn send(&mut self, message: &T) -> Result<(), SendError> {
                self.sending.send(message).await
            }

            /// [`send`](Self::send) from a program without async.
            ///
            /// # Errors
            /// Those of `send`, and [`SendError::Blocking`] inside async code, which it would bring to a halt.
            pub fn send_blocking(&mut self, message: &T) -> Result<(), SendError> {
                self.sending.send_blocking(message)
            }

            /// Sends without ever waiting.
            ///
            /// # Errors
            /// [`TrySendError::Full`] where `send` would wait; the message was sent to nobody then.
            pub fn try_send(&mut self, message: &T) -> Result<(), TrySendError> {
                self.sending.try_send(message)
            }

            /// Whether all required peers are connected.
            pub fn connected(&self) -> bool {
                self.missing().is_empty()
            }

            /// What this gate has done so far.
            pub fn stats(&self) -> GateStats {
                self.sending.stats()
            }
        }

        impl<T> AnyGate for $gate<T> {
            fn spec(&self) -> &'static GateSpec {
                self.sending.spec
            }

            fn missing(&self) -> Vec<&'static LinkSpec> {
                self.sending.missing()
            }

            fn core(&self) -> &Arc<Core> {
                &self.sending.core
            }
        }

        /// Each item is one message; flushed means that connected peers were given everything.
        impl<T> Sink<T> for $gate<T> {
            type Error = SendError;

            fn poll_ready(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<(), SendError>> {
                self.sending.poll_room(cx).map(Ok)
            }

            fn start_send(mut self: Pin<&mut Self>, message: T) -> Result<(), SendError> {
                self.sending.send_now(&message)
            }

            fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<(), SendError>> {
                self.sending.poll_flushed(cx).map(Ok)
            }

            fn poll_close(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<(), SendError>> {
                self.poll_flush(cx)
            }
        }

        impl<T> std::fmt::Debug for $gate<T> {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_tuple(stringify!($gate)).field(&self.sending.spec.name).finish()
            }
        }
    };
}

pub(super) use sending_gate;
