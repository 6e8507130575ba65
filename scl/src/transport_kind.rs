//! What the listening gates of a component listen on.

scl_text::words! {
    /// What a component listens on. Connecting gates find out by themselves, so the components of a system may differ.
    /// The words are those of `SCL_TRANSPORT` and of launch files.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum TransportKind {
        /// Unix sockets in the runtime folder.
        #[default]
        Ipc = "ipc",
        /// TCP on 127.0.0.1, with the ports in the runtime folder.
        Tcp = "tcp",
        /// Unix sockets in the runtime folder, which offer shared memory for long messages. A peer that does not use
        /// shared memory is served through the socket. Needs the feature `shm` of the crate `scl`.
        Shm = "shm",
    }
}
