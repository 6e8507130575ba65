//! The code that `Sub` and `Pull` share. Their public methods are written out in each, so that rustc shows users plain
//! code.

/// Implements `AnyGate` and `Stream` for a gate that receives.
macro_rules! receiving_gate {
    ($gate:ident $(, $senders:ident)?) => {
        use crate::gate::{AnyGate, ReceivingGate, Watch, sealed};
        use crate::spec::GateSpec;
        use futures_core::Stream;
        use std::pin::Pin;
        use std::task::{Context, Poll};

        impl<T $(, $senders)?> $gate<T $(, $senders)?> {
            /// Reports the last message, which the program itself could not decode.
            pub(crate) fn reject(&mut self, source: crate::codec::DecodeError) -> Result<(), RecvError> {
                self.incoming.reject(source)
            }
        }

        impl<T $(, $senders)?> sealed::Sealed for $gate<T $(, $senders)?> {}

        impl<T $(, $senders)?> AnyGate for $gate<T $(, $senders)?> {
            fn spec(&self) -> &'static GateSpec {
                self.incoming.spec
            }

            fn watch(&self) -> Watch {
                self.incoming.watch()
            }
        }

        impl<T $(, $senders)?> ReceivingGate for $gate<T $(, $senders)?> {
            fn poll_ready(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), RecvError>> {
                self.incoming.poll_ready(cx)
            }
        }

        /// An endless stream of messages.
        impl<T $(, $senders)?> Stream for $gate<T $(, $senders)?> {
            type Item = Result<T, RecvError>;

            fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
                self.incoming.poll_next(cx).map(Some)
            }
        }

        impl<T $(, $senders)?> std::fmt::Debug for $gate<T $(, $senders)?> {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_tuple(stringify!($gate)).field(&self.incoming.spec.name).finish()
            }
        }
    };
}

pub(super) use receiving_gate;
