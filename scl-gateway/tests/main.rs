//! The gateway as processes on real networks.

mod wire;
