//! The face of the gates that receive, once for both of them.

/// Makes `Sub` and `Pull`: the same calls over [`Incoming`](super::incoming::Incoming), which knows the difference.
macro_rules! receiving_gate {
    ($(#[$doc:meta])* $gate:ident) => {
        use crate::component::Core;
        use crate::error::{RecvError, RecvTimeoutError};
        use crate::gate::incoming::Incoming;
        use crate::gate::{AnyGate, GateStats};
        use crate::spec::{GateSpec, LinkSpec};
        use futures_core::Stream;
        use std::pin::Pin;
        use std::sync::Arc;
        use std::task::{Context, Poll};
        use std::time::Duration;

        $(#[$doc])*
        pub struct $gate<T> {
            incoming: Incoming<T>,
        }

        impl<T> $gate<T> {
            pub(crate) fn new(incoming: Incoming<T>) -> Self {
                Self { incoming }
            }

            /// Waits for the next message.
            ///
            /// The gate's `queue` is applied to what has arrived: with `queue: 1` this is always the newest message.
            ///
            /// # Errors
            /// [`RecvError::Decode`] when a message is not what the codec reads; the next call goes on with the next message.
            ///
            /// # Cancel safety
            /// Cancel safe: no message is lost when this is dropped before it is ready.
            pub async fn recv(&mut self) -> Result<T, RecvError> {
                self.incoming.recv().await
            }

            /// [`recv`](Self::recv) from a program without async.
            ///
            /// # Errors
            /// Those of `recv`, and [`RecvError::Blocking`] inside async code, or when the program was told to stop.
            pub fn recv_blocking(&mut self) -> Result<T, RecvError> {
                self.incoming.recv_blocking()
            }

            /// [`recv_blocking`](Self::recv_blocking), but no longer than a given time.
            ///
            /// # Errors
            /// [`RecvTimeoutError::Timeout`] when nothing arrived in time.
            pub fn recv_timeout(&mut self, timeout: Duration) -> Result<T, RecvTimeoutError> {
                self.incoming.recv_timeout(timeout)
            }

            /// The next message if one has arrived.
            ///
            /// In async code a message is seen to arrive only while the program awaits something now and then.
            ///
            /// # Errors
            /// Those of [`recv_blocking`](Self::recv_blocking).
            pub fn try_recv(&mut self) -> Result<Option<T>, RecvError> {
                self.incoming.try_recv()
            }

            /// The newest message that has arrived, if any; the older ones are passed over.
            ///
            /// # Errors
            /// Those of [`recv_blocking`](Self::recv_blocking).
            pub fn latest(&mut self) -> Result<Option<T>, RecvError> {
                self.incoming.latest()
            }

            /// Whether all required peers are connected; a `pull` gate listens for any number of peers, and says yes.
            pub fn connected(&self) -> bool {
                self.missing().is_empty()
            }

            /// What this gate has done so far.
            pub fn stats(&self) -> GateStats {
                self.incoming.stats()
            }
        }

        impl<T> AnyGate for $gate<T> {
            fn spec(&self) -> &'static GateSpec {
                self.incoming.spec
            }

            fn missing(&self) -> Vec<&'static LinkSpec> {
                self.incoming.missing()
            }

            fn core(&self) -> &Arc<Core> {
                &self.incoming.core
            }
        }

        /// All messages, for ever.
        impl<T> Stream for $gate<T> {
            type Item = Result<T, RecvError>;

            fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
                self.incoming.poll_recv(cx).map(Some)
            }
        }

        impl<T> std::fmt::Debug for $gate<T> {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_tuple(stringify!($gate)).field(&self.incoming.spec.name).finish()
            }
        }
    };
}

pub(super) use receiving_gate;
