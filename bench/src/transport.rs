//! The transports that a benchmark can measure.

use clap::ValueEnum;

/// The transport of the `SCL` lines, which also determines what they are compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Transport {
    /// Unix sockets, beside other libraries over Unix sockets.
    #[default]
    Ipc,
    /// Shared memory, beside plain iceoryx2; needs the feature `shm` of this program.
    Shm,
    /// Two gateways on loopback, beside plain zenoh; needs the feature `gateway` of this program.
    Gateway,
}

impl Transport {
    /// Fails if this program was built without what the transport needs.
    pub(crate) fn check_is_built_in(self) -> scl::Result<()> {
        let (word, feature, is_built_in) = match self {
            Self::Ipc => return Ok(()),
            Self::Shm => ("shm", "shm", cfg!(feature = "shm")),
            Self::Gateway => ("gateway", "gateway", cfg!(feature = "gateway")),
        };
        if is_built_in {
            return Ok(());
        }
        Err(scl::Error::message(format!(
            "this `scl` was built without the transport `{word}`; \
             build it with `cargo build --release -p scl-cli --features {feature}`"
        )))
    }
}
