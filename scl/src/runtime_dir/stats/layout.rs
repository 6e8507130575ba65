//! The bytes of a stats file, as `docs/stats.md` describes them.

use super::{ComponentStats, ConnectionFigures, GateFigures};
use bytes::{Buf, BufMut};
use scl_text::duration::nanoseconds;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

const MAGIC: &[u8; 8] = b"SCLSTATS";
const VERSION: u32 = 3;
/// The version before the length of each record was in the header.
const FIXED: u32 = 2;

/// Offsets of *begin* and of the body.
pub(super) const BEGIN: usize = 16;
pub(super) const BODY: usize = 24;
/// Length of a counter.
pub(super) const COUNTER: usize = 8;

const HEADER: usize = 72;
const GATE: usize = 136;
const CONNECTION: usize = 80;
/// The lengths in version 2: what a record has at least.
const FIXED_GATE: usize = 120;
const FIXED_CONNECTION: usize = 64;

/// Writes the whole block into `block`, which is emptied first; both counters are `counter`.
pub(super) fn encode(stats: &ComponentStats, counter: u64, block: &mut Vec<u8>) {
    let connections: usize = stats.gates.iter().map(|gate| gate.connections.len()).sum();
    let length = HEADER + GATE * stats.gates.len() + CONNECTION * connections + COUNTER;
    block.clear();
    block.reserve(length);
    block.put_slice(MAGIC);
    block.put_u32_le(VERSION);
    block.put_u32_le(count(length));
    block.put_u64_le(counter);
    block.put_u64_le(nanos(Some(stats.written)));
    block.put_u64_le(nanoseconds(stats.period));
    block.put_u64_le(nanos(Some(stats.started)) / 1_000_000);
    block.put_u32_le(stats.pid);
    block.put_u32_le(stats.ready.into());
    block.put_u32_le(count(stats.gates.len()));
    block.put_u32_le(count(GATE));
    block.put_u32_le(count(CONNECTION));
    block.put_u32_le(0);
    for gate in &stats.gates {
        put_gate(gate, block);
    }
    block.put_u64_le(counter);
    debug_assert_eq!(block.len(), length);
}

fn put_gate(gate: &GateFigures, block: &mut Vec<u8>) {
    for number in [
        gate.sent,
        gate.received,
        gate.dropped_oldest,
        gate.dropped_newest,
        gate.dropped_for_observers,
        gate.tap_dropped,
        gate.lost,
        gate.rejected,
        gate.undecodable,
        gate.bytes,
        gate.waiting,
        gate.peers,
        nanos(gate.last_activity),
        gate.replaced,
    ] {
        block.put_u64_le(number);
    }
    block.put_u32_le(count(gate.connections.len()));
    block.put_u32_le(0);
    block.put_u64_le(gate.missed);
    block.put_u64_le(gate.expired);
    for one in &gate.connections {
        for number in [
            u64::from(one.connected),
            one.waiting,
            one.taken,
            one.dropped,
            one.lost,
            one.replaced,
            one.in_flight,
            one.latched,
            one.missed,
            one.expired,
        ] {
            block.put_u64_le(number);
        }
    }
}

/// Reads a block, also of a release with more or fewer figures. Returns `None` if its version is unknown, or its parts
/// do not fit together.
pub(super) fn decode(block: &[u8]) -> Option<ComponentStats> {
    let mut rest = block.strip_prefix(MAGIC)?;
    let (version, length) = (rest.try_get_u32_le().ok()?, rest.try_get_u32_le().ok()?);
    if ![FIXED, VERSION].contains(&version) || usize::try_from(length) != Ok(block.len()) {
        return None;
    }
    let _begin = rest.try_get_u64_le().ok()?;
    let written = time(rest.try_get_u64_le().ok()?)?;
    let period = Duration::from_nanos(rest.try_get_u64_le().ok()?);
    let started = UNIX_EPOCH.checked_add(Duration::from_millis(rest.try_get_u64_le().ok()?))?;
    let pid = rest.try_get_u32_le().ok()?;
    let ready = rest.try_get_u32_le().ok()? & 1 != 0;
    let gates = rest.try_get_u32_le().ok()?;
    let lengths = match version {
        FIXED => Lengths { gate: FIXED_GATE, connection: FIXED_CONNECTION },
        _ => Lengths::read(&mut rest)?,
    };
    let _reserved = rest.try_get_u32_le().ok()?;
    // Collecting stops at the first missing gate, so a wrong count does not cause a large allocation.
    let gates = (0..gates).map(|_| take_gate(&mut rest, &lengths)).collect::<Option<Vec<_>>>()?;
    (rest.len() == COUNTER).then_some(ComponentStats { written, period, pid, started, ready, gates })
}

/// The bytes of each record. What follows the known fields is of a later release; what is missing is 0.
struct Lengths {
    gate: usize,
    connection: usize,
}

impl Lengths {
    fn read(rest: &mut &[u8]) -> Option<Self> {
        let mut length = |least| usize::try_from(rest.try_get_u32_le().ok()?).ok().filter(|length| *length >= least);
        Some(Self { gate: length(FIXED_GATE)?, connection: length(FIXED_CONNECTION)? })
    }
}

fn take_gate(rest: &mut &[u8], lengths: &Lengths) -> Option<GateFigures> {
    let mut record = rest.split_off(..lengths.gate)?;
    let mut number = || record.try_get_u64_le().ok();
    let mut gate = GateFigures {
        sent: number()?,
        received: number()?,
        dropped_oldest: number()?,
        dropped_newest: number()?,
        dropped_for_observers: number()?,
        tap_dropped: number()?,
        lost: number()?,
        rejected: number()?,
        undecodable: number()?,
        bytes: number()?,
        waiting: number()?,
        peers: number()?,
        ..GateFigures::default()
    };
    gate.last_activity = match number()? {
        0 => None,
        at => Some(time(at)?),
    };
    gate.replaced = number()?;
    let connections = record.try_get_u32_le().ok()?;
    let _reserved = record.try_get_u32_le().ok()?;
    gate.missed = record.try_get_u64_le().unwrap_or(0);
    gate.expired = record.try_get_u64_le().unwrap_or(0);
    gate.connections = (0..connections).map(|_| take_connection(rest, lengths)).collect::<Option<_>>()?;
    Some(gate)
}

fn take_connection(rest: &mut &[u8], lengths: &Lengths) -> Option<ConnectionFigures> {
    let mut record = rest.split_off(..lengths.connection)?;
    let mut number = || record.try_get_u64_le().ok();
    Some(ConnectionFigures {
        connected: number()? != 0,
        waiting: number()?,
        taken: number()?,
        dropped: number()?,
        lost: number()?,
        replaced: number()?,
        in_flight: number()?,
        latched: number()?,
        missed: number().unwrap_or(0),
        expired: number().unwrap_or(0),
    })
}

fn nanos(time: Option<SystemTime>) -> u64 {
    let since = time.and_then(|time| time.duration_since(UNIX_EPOCH).ok()).unwrap_or_default();
    nanoseconds(since)
}

fn time(nanos: u64) -> Option<SystemTime> {
    UNIX_EPOCH.checked_add(Duration::from_nanos(nanos))
}

fn count(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stats() -> ComponentStats {
        let at = |seconds| UNIX_EPOCH + Duration::from_secs(seconds);
        let connection = ConnectionFigures {
            connected: true,
            waiting: 12,
            taken: 13,
            dropped: 14,
            lost: 15,
            replaced: 16,
            in_flight: 17,
            latched: 19,
            missed: 20,
            expired: 22,
        };
        let gate = GateFigures {
            sent: 1,
            received: 2,
            dropped_oldest: 3,
            dropped_newest: 4,
            dropped_for_observers: 5,
            tap_dropped: 6,
            lost: 7,
            rejected: 8,
            undecodable: 9,
            bytes: 10,
            waiting: 11,
            peers: 12,
            last_activity: Some(at(3)),
            replaced: 18,
            missed: 21,
            expired: 23,
            connections: vec![connection, ConnectionFigures::default()],
        };
        ComponentStats {
            written: at(1),
            period: Duration::from_millis(500),
            pid: 77,
            started: at(2),
            ready: true,
            gates: vec![gate, GateFigures::default()],
        }
    }

    #[test]
    fn the_block_is_laid_out_as_documented() {
        let mut block = Vec::new();
        encode(&stats(), 0x99, &mut block);
        let number = |at: usize| u64::from_le_bytes(block[at..at + 8].try_into().unwrap());
        let short = |at: usize| u32::from_le_bytes(block[at..at + 4].try_into().unwrap());
        assert_eq!(&block[..8], b"SCLSTATS");
        assert_eq!((short(8), short(12) as usize), (3, block.len()));
        assert_eq!((number(16), number(block.len() - 8)), (0x99, 0x99));
        assert_eq!((number(24), number(32), number(40)), (1_000_000_000, 500_000_000, 2_000));
        assert_eq!((short(48), short(52), short(56)), (77, 1, 2));
        assert_eq!((short(60), short(64), short(68)), (136, 80, 0));
        assert_eq!((0..12).map(|index| number(72 + 8 * index)).collect::<Vec<_>>(), (1..13).collect::<Vec<_>>());
        assert_eq!((number(72 + 96), number(72 + 104)), (3_000_000_000, 18));
        assert_eq!((number(72 + 120), number(72 + 128)), (21, 23));
        assert_eq!((short(72 + 112), short(72 + 116)), (2, 0));
        assert_eq!(
            (0..10).map(|index| number(208 + 8 * index)).collect::<Vec<_>>(),
            [1, 12, 13, 14, 15, 16, 17, 19, 20, 22]
        );
        assert_eq!(block.len(), 72 + 136 + 2 * 80 + 136 + 8);
    }

    #[test]
    fn a_block_is_read_back_and_no_part_of_one_is() {
        let mut block = Vec::new();
        encode(&stats(), 7, &mut block);
        assert_eq!(decode(&block), Some(stats()));
        for length in 0..block.len() {
            assert_eq!(decode(&block[..length]), None, "{length} bytes");
        }
        let wrong = [(0, b'X'), (8, 1), (8, 4), (12, 1), (56, 1), (56, 3), (59, 0xff), (72 + 112, 1), (72 + 115, 0xff)];
        let lengths = [(60, 112), (60, 144), (63, 0xff), (64, 56), (64, 88), (67, 0xff)];
        for (at, wrong) in wrong.into_iter().chain(lengths) {
            let mut block = block.clone();
            block[at] = wrong;
            assert_eq!(decode(&block), None, "{wrong} at {at}");
        }
    }

    #[test]
    fn figures_that_a_later_release_adds_are_skipped() {
        let (mut block, mut longer) = (Vec::new(), Vec::new());
        encode(&stats(), 7, &mut block);
        let mut rest = &block[..];
        // The header, the first gate, its connections, the second gate and the counter.
        for (length, added) in [(72, 0), (136, 16), (80, 8), (80, 8), (136, 16), (8, 0)] {
            longer.extend_from_slice(rest.split_off(..length).unwrap());
            longer.resize(longer.len() + added, 0xff);
        }
        assert_eq!(rest, b"");
        let length = u32::try_from(longer.len()).unwrap();
        for (at, number) in [(12, length), (60, 136 + 16), (64, 80 + 8)] {
            longer[at..at + 4].copy_from_slice(&number.to_le_bytes());
        }
        assert_eq!(decode(&longer), Some(stats()));
    }

    #[test]
    fn writing_again_needs_no_more_memory() {
        let mut block = Vec::new();
        encode(&stats(), 1, &mut block);
        let (memory, capacity) = (block.as_ptr(), block.capacity());
        encode(&stats(), 2, &mut block);
        assert_eq!((block.as_ptr(), block.capacity()), (memory, capacity));
    }
}
