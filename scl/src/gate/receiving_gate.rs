//! What `Sub` and `Pull` are besides their own calls, once for both. The calls themselves are written out in each, so
//! that rustc shows a user plain code.

/// Makes a gate that receives known to its component, and a `Stream`.
macro_rules! receiving_gate {
    ($gate:ident) => {
        use crate::component::Core;
        use crate::gate::AnyGate;
        use crate::spec::{GateSpec, LinkSpec};
        use futures_core::Stream;
        use std::pin::Pin;
        use std::sync::Arc;
        use std::task::{Context, Poll};

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
