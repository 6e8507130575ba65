//! The gateway as processes on real networks: several hosts, each with its own gateway, network and components, between
//! them a cable that loses, delays and cuts.

mod accounts;
mod cable;
mod direct;
mod fleet;
mod host;
mod namespace;
mod network;
mod player;
mod receipts;
