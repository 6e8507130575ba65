//! The programs of these tests, and what must be true at their end.

use crate::programs::{IMAGES, open_with};
use scl::TransportKind;
use scl_tests::{Process, System};
use std::fs;

/// The length of an image: 4 MiB, the `max_size` of the gates.
pub(crate) const IMAGE: usize = 4 << 20;
/// The queue of the viewer's and the worker's gates.
pub(crate) const QUEUE: u64 = 4;
/// The most messages whose receipt the sender does not know of yet: those on their way, those that wait at the
/// receiving gate, and those that the next acknowledgement will report.
pub(crate) const UNKNOWN: u64 = 3 * QUEUE;

/// A runtime folder whose connections use shared memory.
pub(crate) struct Stage {
    pub(crate) system: System,
}

impl Stage {
    pub(crate) fn new() -> Self {
        Self { system: System::over(TransportKind::Shm) }
    }

    pub(crate) fn open(&self, component: &str) -> Process {
        open_with(&self.system, IMAGES, component)
    }

    /// Starts a program with its first command.
    pub(crate) fn start(&self, component: &str, command: &str) -> Process {
        let mut program = self.system.start(IMAGES, &[component]);
        program.tell(command);
        program
    }

    /// A camera and a viewer that share memory.
    pub(crate) fn camera_and_viewer(&self) -> (Process, Process) {
        let (mut camera, viewer) = (self.open("camera"), self.open("viewer"));
        share(&mut camera);
        (camera, viewer)
    }

    /// Passes a queue of images from `number` on, none of which is copied.
    #[track_caller]
    pub(crate) fn assert_good(&self, camera: &mut Process, viewer: &mut Process, number: u64) {
        let end = number + QUEUE;
        camera.ask(&format!("lend {number} {end} {IMAGE}"), &format!("{QUEUE} shared"));
        viewer.ask(&format!("receive_up_to {}", end - 1), &format!("{number}..{end}, {QUEUE} shared"));
    }

    /// The same after messages that may wait still.
    #[track_caller]
    pub(crate) fn assert_good_after(&self, camera: &mut Process, viewer: &mut Process, number: u64) {
        let end = number + QUEUE;
        camera.ask(&format!("lend {number} {end} {IMAGE}"), &format!("{QUEUE} shared"));
        viewer.tell(&format!("receive_up_to {}", end - 1));
        let received = viewer.next_line();
        assert!(received.contains(&format!("..{end}, ")), "{received}");
    }

    /// Ends programs, which must succeed, and looks what they left behind: nothing.
    #[track_caller]
    pub(crate) fn end(&self, programs: impl IntoIterator<Item = Process>) {
        for program in programs {
            let exit = program.wait_for_exit();
            assert!(exit.status.success(), "{exit:?}");
            // A camera says so when its peers have acknowledged everything.
            assert!(exit.output.iter().all(|line| line == "closed"), "{exit:?}");
        }
        self.assert_nothing_left();
    }

    #[track_caller]
    pub(crate) fn assert_nothing_left(&self) {
        assert_eq!(self.system.shared_files("images"), Vec::<std::path::PathBuf>::new());
        let folder = self.system.runtime_dir().join("images/shm");
        let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
        let left: Vec<_> = entries.map(|entry| entry.file_name()).filter(|name| name != "lock").collect();
        assert!(left.is_empty(), "in {}: {left:?}", folder.display());
    }
}

/// Waits until a camera and the viewer that is running share memory.
pub(crate) fn share(camera: &mut Process) {
    for gate in ["frames", "pictures"] {
        camera.ask(&format!("lends {gate}"), "lends");
    }
}

/// The account of a connection: `published = taken + dropped + lost + waiting`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Account {
    pub(crate) published: u64,
    pub(crate) taken: u64,
    pub(crate) dropped: u64,
    pub(crate) lost: u64,
    pub(crate) waiting: u64,
}

impl Account {
    /// Asks a camera for one of its accounts, which must add up.
    #[track_caller]
    pub(crate) fn of(camera: &mut Process, gate: &str) -> Self {
        camera.tell(gate);
        let line = camera.next_line();
        let numbers: Vec<u64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let [published, taken, dropped, lost, waiting] = numbers[..] else { panic!("no account: {line}") };
        assert_eq!(published, taken + dropped + lost + waiting, "{line}");
        Self { published, taken, dropped, lost, waiting }
    }

    /// Asserts that nothing was dropped or lost. The peer acknowledges several messages at once, and says of those in
    /// its queue later that they were received, so some may count as waiting; that they are taken is shown by
    /// [`Stage::end`].
    #[track_caller]
    pub(crate) fn assert_all_taken(camera: &mut Process, gate: &str, published: u64) {
        let account = Self::of(camera, gate);
        assert_eq!((account.published, account.dropped, account.lost), (published, 0, 0), "{account:?}");
        assert!(account.waiting <= UNKNOWN, "{account:?}");
    }
}
