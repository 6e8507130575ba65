//! The gateway as processes on real networks: several hosts, each with its own gateway, network and components, between
//! them a cable that loses, delays and cuts.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod accounts;
mod bad_network;
mod cable;
mod certificates;
mod clocks;
mod control_loop;
mod cut;
mod direct;
mod files;
mod fleet;
mod gateway;
mod host;
mod identities;
mod kills;
mod local;
mod long;
mod namespace;
mod network;
mod player;
mod quickstart;
mod receipts;
mod steady;
mod strangers;
mod three_hosts;
mod wire;
