//! What `Pub` and `Push` are besides their own calls, once for both. The calls themselves are written out in each, so
//! that rustc shows a user plain code.

/// Makes a gate that sends known to its component, and a `Sink`.
macro_rules! sending_gate {
    ($gate:ident) => {
        use crate::component::Core;
        use crate::gate::AnyGate;
        use crate::spec::{GateSpec, LinkSpec};
        use futures_sink::Sink;
        use std::pin::Pin;
        use std::sync::Arc;
        use std::task::{Context, Poll};

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
