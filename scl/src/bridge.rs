//! What a gateway to other hosts needs: components of other hosts that are present in this host's runtime folder, and
//! the components that run here. It carries no promise of stability.
//!
//! A [`Mirror`] takes the place of a component that runs on another host: its lock, its announcement and its schema.
//! The ends of its connections are opened one by one, with the endpoints that it gives, on
//! [`ZeroMq`](crate::transport::zeromq). [`Presence`] says which components run here; a [`Profile`] is what a component
//! says of itself.

mod folder_events;
mod mirror;
mod presence;
mod profile;

pub use mirror::{Mirror, MirrorError};
pub use presence::{Change, Presence};
pub use profile::{Profile, ProfileError};
