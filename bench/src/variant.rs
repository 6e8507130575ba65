//! The lines that `roundtrip` and `rate` have in common: SCL over a transport, and its baselines.

use crate::transport::Transport;

/// A way to exchange messages: its id in the arguments of processes, its name in the report, and its baselines.
#[derive(Clone, Copy)]
pub(crate) struct Variant {
    pub(crate) id: &'static str,
    pub(crate) name: &'static str,
    pub(crate) baselines: &'static [&'static str],
}

/// Returns the variants over a transport; `ipc` are the benchmark's own variants over Unix sockets.
pub(crate) fn over(transport: Transport, ipc: &'static [Variant]) -> &'static [Variant] {
    match transport {
        Transport::Ipc => ipc,
        Transport::Shm => SHM,
        Transport::Gateway => GATEWAY,
    }
}

pub(crate) const UNIX_NAME: &str = "Unix socket (tokio)";
pub(crate) const UNIX_BLOCKING_NAME: &str = "Unix socket (blocking)";
const SCL_IPC: &str = "SCL ipc";
const SCL_IPC_BLOCKING: &str = "SCL ipc (blocking)";
const SCL_TCP: &str = "SCL tcp";
const ICEORYX_LOAN: &str = "iceoryx2, loaned";
const ICEORYX_COPY: &str = "iceoryx2, copied";
const ZENOH: &str = "zenoh";

pub(crate) const UNIX: Variant = Variant { id: "unix", name: UNIX_NAME, baselines: &[] };
pub(crate) const UNIX_BLOCKING: Variant = Variant { id: "unix-blocking", name: UNIX_BLOCKING_NAME, baselines: &[] };

/// In the order of their turns, like all lists of variants.
const SHM: &[Variant] = &[
    Variant { id: "shm-loan", name: "SCL shm, loaned", baselines: &[ICEORYX_LOAN, SCL_IPC] },
    Variant {
        id: "shm-loan-blocking",
        name: "SCL shm, loaned (blocking)",
        baselines: &[ICEORYX_LOAN, SCL_IPC_BLOCKING],
    },
    Variant { id: "shm-copy", name: "SCL shm, copied", baselines: &[ICEORYX_COPY, SCL_IPC] },
    Variant {
        id: "shm-copy-blocking",
        name: "SCL shm, copied (blocking)",
        baselines: &[ICEORYX_COPY, SCL_IPC_BLOCKING],
    },
    Variant { id: "iceoryx-loan", name: ICEORYX_LOAN, baselines: &[] },
    Variant { id: "iceoryx-copy", name: ICEORYX_COPY, baselines: &[] },
    Variant { id: "ipc", name: SCL_IPC, baselines: &[UNIX_NAME] },
    Variant { id: "ipc-blocking", name: SCL_IPC_BLOCKING, baselines: &[UNIX_BLOCKING_NAME] },
    UNIX,
    UNIX_BLOCKING,
];

const GATEWAY: &[Variant] = &[
    Variant { id: "gateway", name: "SCL over two gateways", baselines: &[ZENOH, SCL_TCP, SCL_IPC] },
    Variant { id: "zenoh", name: ZENOH, baselines: &[] },
    Variant { id: "tcp", name: SCL_TCP, baselines: &[] },
    Variant { id: "ipc", name: SCL_IPC, baselines: &[] },
];
