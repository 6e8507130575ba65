//! The lines of each table: SCL over the transport that is measured, and what it is compared with.

use crate::transport::Transport;

/// A way to exchange messages: its name between the processes, in the report, and what it is compared with.
pub(super) struct Variant {
    pub(super) id: &'static str,
    pub(super) name: &'static str,
    pub(super) baselines: &'static [&'static str],
}

/// The variants of a benchmark over `transport`, in the order of their turns.
pub(super) fn variants(transport: Transport) -> &'static [Variant] {
    match transport {
        Transport::Ipc => IPC,
        Transport::Shm => SHM,
        Transport::Gateway => GATEWAY,
    }
}

const SCL_PUB: &str = "SCL pub/sub";
const SCL_PUB_BLOCKING: &str = "SCL pub/sub (blocking)";
const SCL_REQ: &str = "SCL req/rep";
const SCL_REQ_BLOCKING: &str = "SCL req/rep (blocking)";
const ZEROMQ_PUB: &str = "zeromq XPUB/SUB";
const ZEROMQ_REQ: &str = "zeromq DEALER/ROUTER";
const LIBZMQ_PUB: &str = "libzmq XPUB/SUB";
const LIBZMQ_REQ: &str = "libzmq REQ/REP";
const UNIX: &str = "Unix socket (tokio)";
const UNIX_BLOCKING: &str = "Unix socket (blocking)";

const IPC: &[Variant] = &[
    Variant { id: "scl-pub", name: SCL_PUB, baselines: &[UNIX, ZEROMQ_PUB, LIBZMQ_PUB] },
    Variant { id: "scl-req", name: SCL_REQ, baselines: &[UNIX, ZEROMQ_REQ, LIBZMQ_REQ] },
    Variant { id: "zeromq-pub", name: ZEROMQ_PUB, baselines: &[] },
    Variant { id: "zeromq-req", name: ZEROMQ_REQ, baselines: &[] },
    Variant { id: "unix", name: UNIX, baselines: &[] },
    Variant { id: "scl-pub-blocking", name: SCL_PUB_BLOCKING, baselines: &[UNIX_BLOCKING, LIBZMQ_PUB, SCL_PUB] },
    Variant { id: "scl-req-blocking", name: SCL_REQ_BLOCKING, baselines: &[UNIX_BLOCKING, LIBZMQ_REQ, SCL_REQ] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-pub-blocking", name: LIBZMQ_PUB, baselines: &[] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-req-blocking", name: LIBZMQ_REQ, baselines: &[] },
    Variant { id: "unix-blocking", name: UNIX_BLOCKING, baselines: &[] },
];

const SHM_LOAN: &str = "SCL shm, loaned";
const SHM_LOAN_BLOCKING: &str = "SCL shm, loaned (blocking)";
const SHM_COPY: &str = "SCL shm, copied";
const SHM_COPY_BLOCKING: &str = "SCL shm, copied (blocking)";
const SCL_IPC: &str = "SCL ipc";
const SCL_IPC_BLOCKING: &str = "SCL ipc (blocking)";
const ICEORYX_LOAN: &str = "iceoryx2, loaned";
const ICEORYX_COPY: &str = "iceoryx2, copied";

const SHM: &[Variant] = &[
    Variant { id: "shm-loan", name: SHM_LOAN, baselines: &[ICEORYX_LOAN, SCL_IPC] },
    Variant { id: "shm-loan-blocking", name: SHM_LOAN_BLOCKING, baselines: &[ICEORYX_LOAN, SCL_IPC_BLOCKING] },
    Variant { id: "shm-copy", name: SHM_COPY, baselines: &[ICEORYX_COPY, SCL_IPC] },
    Variant { id: "shm-copy-blocking", name: SHM_COPY_BLOCKING, baselines: &[ICEORYX_COPY, SCL_IPC_BLOCKING] },
    Variant { id: "iceoryx-loan", name: ICEORYX_LOAN, baselines: &[] },
    Variant { id: "iceoryx-copy", name: ICEORYX_COPY, baselines: &[] },
    Variant { id: "ipc", name: SCL_IPC, baselines: &[UNIX] },
    Variant { id: "ipc-blocking", name: SCL_IPC_BLOCKING, baselines: &[UNIX_BLOCKING] },
    Variant { id: "unix", name: UNIX, baselines: &[] },
    Variant { id: "unix-blocking", name: UNIX_BLOCKING, baselines: &[] },
];

const SCL_GATEWAY: &str = "SCL over two gateways";
const SCL_TCP: &str = "SCL tcp";
const ZENOH: &str = "zenoh";

const GATEWAY: &[Variant] = &[
    Variant { id: "gateway", name: SCL_GATEWAY, baselines: &[ZENOH, SCL_TCP, SCL_IPC] },
    Variant { id: "zenoh", name: ZENOH, baselines: &[] },
    Variant { id: "tcp", name: SCL_TCP, baselines: &[] },
    Variant { id: "ipc", name: SCL_IPC, baselines: &[] },
];
