//! The code that `Pub` and `Push` share. Their public methods are written out in each, so that rustc shows users plain
//! code.

/// Implements `AnyGate` and `Sink` for a gate that sends.
macro_rules! sending_gate {
    ($gate:ident) => {
        use crate::gate::{AnyGate, Watch, sealed};
        use crate::spec::GateSpec;
        use futures_sink::Sink;
        use std::pin::Pin;
        use std::task::{Context, Poll};

        impl<T> sealed::Sealed for $gate<T> {}

        impl<T> AnyGate for $gate<T> {
            fn spec(&self) -> &'static GateSpec {
                self.outgoing.fanout.spec
            }

            fn watch(&self) -> Watch {
                self.outgoing.fanout.watch()
            }
        }

        /// Each item is one message. Flushed means that connected peers were given everything.
        impl<T> Sink<T> for $gate<T> {
            type Error = SendError;

            fn poll_ready(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<(), SendError>> {
                self.outgoing.fanout.poll_room(cx)
            }

            fn start_send(mut self: Pin<&mut Self>, message: T) -> Result<(), SendError> {
                self.outgoing.send_now(&message)
            }

            fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<(), SendError>> {
                self.outgoing.fanout.poll_flushed(cx).map(Ok)
            }

            fn poll_close(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Result<(), SendError>> {
                self.poll_flush(cx)
            }
        }

        impl<T> std::fmt::Debug for $gate<T> {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_tuple(stringify!($gate)).field(&self.outgoing.fanout.spec.name).finish()
            }
        }
    };
}

pub(super) use sending_gate;
