//! The hub itself: which frame goes where, when, or nowhere.

use super::Shape;
use super::port::Port;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::io::BufRead;
use std::sync::{Arc, Condvar, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// What waits at most where the rate is limited: as in a small router.
const BACKLOG: Duration = Duration::from_millis(100);

/// A frame to be written, ordered by time, then by arrival.
type Due = Reverse<(Instant, u64, Arc<[u8]>)>;

struct Hub {
    ports: Vec<Port>,
    /// By port: what waits to be written there.
    waiting: Vec<(Mutex<BinaryHeap<Due>>, Condvar)>,
    state: Mutex<State>,
}

struct State {
    cables: Vec<CableState>,
    /// At which port a hardware address is.
    found: HashMap<[u8; 6], usize>,
    random: u64,
    number: u64,
}

struct CableState {
    shape: Shape,
    is_cut: bool,
    /// When all that was taken in has passed, for the rate; from the host and to it.
    free_at: [Instant; 2],
    passed: u64,
    lost: u64,
}

/// Plays the hub until standard input ends.
pub(super) fn run(ports: usize) {
    let now = Instant::now();
    let cable = || CableState { shape: Shape::PERFECT, is_cut: false, free_at: [now; 2], passed: 0, lost: 0 };
    let cables = (0..ports).map(|_| cable()).collect();
    let hub = Arc::new(Hub {
        ports: (0..ports).map(Port::open).collect(),
        waiting: (0..ports).map(|_| Default::default()).collect(),
        // Always the same sequence, so that a failure has a chance to come again.
        state: Mutex::new(State { cables, found: HashMap::new(), random: 42, number: 0 }),
    });
    for port in 0..ports {
        let (reading, writing) = (Arc::clone(&hub), Arc::clone(&hub));
        thread::spawn(move || {
            loop {
                reading.take(port, reading.ports[port].read().into());
            }
        });
        thread::spawn(move || {
            loop {
                writing.ports[port].write(&writing.next(port));
            }
        });
    }
    println!("= hub");
    for line in std::io::stdin().lock().lines() {
        println!("= {}", hub.state.lock().unwrap().handle(&line.unwrap()));
    }
}

impl Hub {
    /// A frame has come from a host.
    fn take(&self, from: usize, frame: Arc<[u8]>) {
        let Some((Ok(to_address), Ok(from_address))) =
            frame.get(..12).map(|header| (header[..6].try_into(), header[6..].try_into()))
        else {
            return;
        };
        let mut state = self.state.lock().unwrap();
        state.found.insert(from_address, from);
        let one: Option<usize> = state.found.get::<[u8; 6]>(&to_address).copied();
        for to in (0..self.ports.len()).filter(|to| *to != from && one.is_none_or(|one| one == *to)) {
            let Some(due) = state.due(from, to, frame.len()) else { continue };
            state.number += 1;
            let (heap, changed) = &self.waiting[to];
            heap.lock().unwrap().push(Reverse((due, state.number, Arc::clone(&frame))));
            changed.notify_one();
        }
    }

    /// Waits until a frame is to be written.
    fn next(&self, port: usize) -> Arc<[u8]> {
        let (heap, changed) = &self.waiting[port];
        let mut heap = heap.lock().unwrap();
        loop {
            let now = Instant::now();
            let wait = match heap.peek() {
                Some(Reverse((due, ..))) if *due <= now => return heap.pop().unwrap().0.2,
                Some(Reverse((due, ..))) => *due - now,
                None => Duration::from_secs(3600),
            };
            heap = changed.wait_timeout(heap, wait).unwrap().0;
        }
    }
}

impl State {
    /// When a frame arrives, or `None` if it is lost.
    fn due(&mut self, from: usize, to: usize, length: usize) -> Option<Instant> {
        let mut due = Instant::now();
        for (cable, direction) in [(from, 0), (to, 1)] {
            let (lost, late) = (self.chance(), self.chance());
            let cable = &mut self.cables[cable];
            let shape = cable.shape;
            let queued = cable.free_at[direction].saturating_duration_since(due);
            if cable.is_cut || lost < shape.loss || queued > BACKLOG {
                cable.lost += 1;
                return None;
            }
            cable.passed += 1;
            if shape.rate > 0.0 {
                due += queued + Duration::from_secs_f64(length as f64 * 8.0 / shape.rate);
                cable.free_at[direction] = due;
            }
            due += Duration::from_secs_f64((shape.delay + shape.jitter * late) / 1000.0);
        }
        Some(due)
    }

    /// A number from 0 to below 1 (SplitMix64).
    fn chance(&mut self) -> f64 {
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.random;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn handle(&mut self, line: &str) -> String {
        let words: Vec<&str> = line.split(' ').collect();
        let number = |index: usize| words[index].parse::<f64>().unwrap();
        let cable = &mut self.cables[words[1].parse::<usize>().unwrap()];
        match words[0] {
            "cut" => cable.is_cut = true,
            "repair" => cable.is_cut = false,
            "shape" => {
                cable.shape = Shape { loss: number(2), delay: number(3), jitter: number(4), rate: number(5) };
            }
            "counts" => return format!("{} {}", cable.passed, cable.lost),
            _ => panic!("{line}"),
        }
        "done".to_owned()
    }
}
