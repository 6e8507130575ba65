//! Without the feature `shm`: every message goes through the socket.

use super::super::zmtp::{PeerReady, ProtocolError, ShmReady};
use crate::runtime_dir::SystemDir;
use crate::transport::{Endpoint, Frame, Loan, TransportError};
use bytes::Bytes;
use std::io;

/// Nothing is offered.
pub(in super::super) enum Offer {}

impl Offer {
    pub(in super::super) fn open(_dir: &SystemDir, endpoint: &Endpoint) -> Result<Self, TransportError> {
        Err(TransportError::refused(&endpoint.name, &"shared memory needs the feature `shm` of the crate `scl`"))
    }

    pub(in super::super) fn next(&self) -> ShmReady {
        match *self {}
    }
}

/// The sending side.
pub(in super::super) struct Sharing;

impl Sharing {
    pub(in super::super) fn new(_dir: &SystemDir, _peer: &PeerReady) -> Self {
        Self
    }

    pub(in super::super) fn open(&mut self) {}

    pub(in super::super) fn has_room(&self) -> bool {
        true
    }

    pub(in super::super) fn is_for(&self, _length: usize) -> bool {
        false
    }

    pub(in super::super) fn send(&mut self, _message: &mut Frame, _number: u64) -> io::Result<Option<[u8; 31]>> {
        Ok(None)
    }

    pub(in super::super) fn acknowledge(&mut self, _number: u64) {}

    pub(in super::super) fn loan(&mut self, _length: usize) -> Option<Loan> {
        None
    }
}

/// The receiving side.
pub(in super::super) struct Arriving;

impl Arriving {
    pub(in super::super) fn open(_dir: &SystemDir, _peer: &PeerReady, _endpoint: &Endpoint) -> Self {
        Self
    }

    pub(in super::super) fn is_open(&self) -> bool {
        false
    }

    pub(in super::super) fn receive(&mut self, _sequence: u64, _length: u64) -> Result<(Bytes, bool), ProtocolError> {
        Err(ProtocolError::Sample("the peer sent a sample without shared memory".to_owned()))
    }

    pub(in super::super) fn acknowledged(&mut self) {}
}
