//! The cable between the hosts: a hub that this test program plays, in a process and a network namespace of its own.
//!
//! Why not `tc netem`: kernels of virtual machines are often built without it, and then these tests could not run. The
//! hub moves Ethernet frames from each port to all others, and does to them what a bad network does: it loses, delays,
//! reorders and drops what is more than the rate allows. A cut port loses all frames, as a cable that is pulled out of
//! a switch that is farther away; the host's own network card notices nothing.

mod checksum;
mod hub;
mod port;
mod stream;

use crate::namespace::Namespace;
use scl_tests::Process;

/// Set in the process of the hub: its ports.
const PORTS: &str = "SCL_TEST_CABLE";

/// The test that becomes the hub.
const TEST: &str = "cable::frames_arrive_unchanged_until_the_cable_is_cut";

/// What a cable does to the frames of one host, in both directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shape {
    /// Share of frames that are lost: 0.01 is 1 %.
    pub(crate) loss: f64,
    /// Milliseconds each frame takes.
    pub(crate) delay: f64,
    /// Milliseconds more, at random. Frames overtake each other.
    pub(crate) jitter: f64,
    /// Bits per second; 0 for no limit.
    pub(crate) rate: f64,
}

impl Shape {
    pub(crate) const PERFECT: Self = Self { loss: 0.0, delay: 0.0, jitter: 0.0, rate: 0.0 };
}

/// A running hub. It ends when dropped.
pub(crate) struct Cable {
    process: Process,
}

impl Cable {
    /// Connects the ports of a namespace: network devices called `port0`, `port1` and so on.
    pub(crate) fn start(namespace: &Namespace, ports: usize) -> Self {
        let mut command = namespace.command(std::env::current_exe().unwrap());
        command.args(["--exact", TEST, "--nocapture", "--test-threads=1"]).env(PORTS, ports.to_string());
        let mut process = Process::spawn(command);
        process.expect_containing("= hub");
        Self { process }
    }

    /// From now on, no frame passes this port.
    pub(crate) fn cut(&mut self, port: usize) {
        self.tell(&format!("cut {port}"));
    }

    /// Undoes [`cut`](Self::cut).
    pub(crate) fn repair(&mut self, port: usize) {
        self.tell(&format!("repair {port}"));
    }

    /// What happens to the frames of this port that come from now on.
    pub(crate) fn shape(&mut self, port: usize, shape: Shape) {
        let Shape { loss, delay, jitter, rate } = shape;
        self.tell(&format!("shape {port} {loss} {delay} {jitter} {rate}"));
    }

    /// How many frames of this port were passed on and lost so far.
    pub(crate) fn counts(&mut self, port: usize) -> (u64, u64) {
        let line = self.tell(&format!("counts {port}"));
        let mut numbers = line.split_whitespace().filter_map(|word| word.parse().ok());
        (numbers.next().unwrap(), numbers.next().unwrap())
    }

    fn tell(&mut self, command: &str) -> String {
        self.process.tell(command);
        self.process.expect_containing("= ")
    }
}

#[test]
fn frames_arrive_unchanged_until_the_cable_is_cut() {
    if let Ok(ports) = std::env::var(PORTS) {
        return hub::run(ports.parse().unwrap());
    }
    stream::check();
}
