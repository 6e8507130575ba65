//! Support for gateways to other hosts: stand-ins for components of other hosts in this host's runtime folder, and
//! reports of the components that run here. This module carries no promise of stability.
//!
//! A [`Mirror`] stands in for a component that runs on another host, with its lock, its announcement and its schema.
//! The gateway opens the ends of its connections one by one on [`ZeroMq`](crate::transport::zeromq), with the endpoints
//! that the mirror returns. [`Presence`] reports which components run here; a [`Profile`] is a component's announcement
//! with its messages.

mod folder_events;
mod mirror;
mod presence;
mod profile;

pub use mirror::{Mirror, MirrorError};
pub use presence::{Change, Presence};
pub use profile::{Profile, ProfileError};
