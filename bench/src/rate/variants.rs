//! The lines of each table, with the lines they are compared with.

use crate::one_way::{
    GATEWAY, ICEORYX_COPY, ICEORYX_LOAN, IPC, IPC_BLOCKING, LIBZMQ_NODROP, LIBZMQ_PUB, LIBZMQ_PUSH,
    LIBZMQ_PUSH_UNLIMITED, SCL_PUB, SCL_PUB_BLOCKING, SCL_PUSH, SCL_PUSH_BLOCKING, SHM_COPY, SHM_COPY_BLOCKING,
    SHM_LOAN, SHM_LOAN_BLOCKING, TCP, UNIX, Variant, ZENOH, ZEROMQ_PUB, ZEROMQ_PUSH,
};
use crate::transport::Transport;

/// A variant and what it is compared with.
type Line = (Variant, &'static [Variant]);

/// The variants of a benchmark over `transport`, in the order of their turns.
pub(super) fn variants(transport: Transport) -> &'static [Line] {
    match transport {
        Transport::Ipc => ZEROMQ_LINES,
        Transport::Shm => SHM_LINES,
        Transport::Gateway => GATEWAY_LINES,
    }
}

const PUB_BASELINES: &[Variant] = &[LIBZMQ_NODROP, LIBZMQ_PUB, ZEROMQ_PUB];
const PUSH_BASELINES: &[Variant] = &[LIBZMQ_PUSH, LIBZMQ_PUSH_UNLIMITED, ZEROMQ_PUSH];

const ZEROMQ_LINES: &[Line] = &[
    (SCL_PUB, PUB_BASELINES),
    (SCL_PUB_BLOCKING, PUB_BASELINES),
    (ZEROMQ_PUB, &[]),
    #[cfg(feature = "libzmq")]
    (LIBZMQ_NODROP, &[]),
    #[cfg(feature = "libzmq")]
    (LIBZMQ_PUB, &[]),
    (SCL_PUSH, PUSH_BASELINES),
    (SCL_PUSH_BLOCKING, PUSH_BASELINES),
    (ZEROMQ_PUSH, &[]),
    #[cfg(feature = "libzmq")]
    (LIBZMQ_PUSH, &[]),
    #[cfg(feature = "libzmq")]
    (LIBZMQ_PUSH_UNLIMITED, &[]),
    (UNIX, &[]),
];

const SHM_LINES: &[Line] = &[
    (SHM_LOAN, &[ICEORYX_LOAN, IPC]),
    (SHM_LOAN_BLOCKING, &[ICEORYX_LOAN, IPC_BLOCKING]),
    (SHM_COPY, &[ICEORYX_COPY, IPC]),
    (SHM_COPY_BLOCKING, &[ICEORYX_COPY, IPC_BLOCKING]),
    (ICEORYX_LOAN, &[]),
    (ICEORYX_COPY, &[]),
    (IPC, &[UNIX]),
    (IPC_BLOCKING, &[UNIX]),
    (UNIX, &[]),
];

const GATEWAY_LINES: &[Line] = &[(GATEWAY, &[ZENOH, TCP, IPC]), (ZENOH, &[]), (TCP, &[]), (IPC, &[])];
