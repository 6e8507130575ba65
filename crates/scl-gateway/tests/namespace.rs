//! Network namespaces: to the programs in it, each is a machine of its own, as far as the network goes.
//!
//! A namespace lives as long as the process that holds it, which ends with the test, however the test ends. So nothing
//! is left behind, and tests need no names that are free. Without root, a user namespace surrounds all of them.

use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};

/// One network namespace.
pub(crate) struct Namespace {
    holder: Child,
    /// The process inside. It is not the holder itself if that had to fork.
    inside: u32,
    has_clocks: bool,
}

impl Namespace {
    /// A namespace, and around it, without root, a user namespace.
    pub(crate) fn new() -> Self {
        let mut unshare = Command::new("unshare");
        if !is_root() {
            unshare.args(["--user", "--map-root-user"]);
        }
        Self::hold(unshare, 0)
    }

    /// A namespace that can be connected with this one. Its clocks that count from the start of the machine are this
    /// many seconds ahead.
    pub(crate) fn beside(&self, clocks_ahead: u32) -> Self {
        let unshare = if is_root() { Command::new("unshare") } else { self.command("unshare") };
        Self::hold(unshare, clocks_ahead)
    }

    fn hold(mut unshare: Command, clocks_ahead: u32) -> Self {
        // `cat` ends when its input does, with the test.
        let mut script = "echo $$; exec cat".to_owned();
        if clocks_ahead > 0 {
            unshare.args(["--time", "--fork", "--mount"]);
            unshare.arg(format!("--monotonic={clocks_ahead}")).arg(format!("--boottime={clocks_ahead}"));
            // Programs that libfaketime deceives leave files there when they are killed.
            script.insert_str(0, "mount -t tmpfs scl /dev/shm && ");
        }
        unshare.args(["--net", "sh", "-c", &script]);
        unshare.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut holder = unshare.spawn().unwrap_or_else(|error| panic!("{MISSING}\n`unshare`: {error}"));
        let mut line = String::new();
        BufReader::new(holder.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let inside = line.trim().parse().unwrap_or_else(|_| {
            let mut errors = String::new();
            holder.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
            panic!("{MISSING}\n{errors}")
        });
        Self { holder, inside, has_clocks: clocks_ahead > 0 }
    }

    /// A program that will run inside. The process that is started becomes that program, so its id is the program's.
    pub(crate) fn command(&self, program: impl AsRef<OsStr>) -> Command {
        let mut command = Command::new("nsenter");
        command.arg(format!("--target={}", self.inside)).arg("--net");
        if !is_root() {
            command.args(["--user", "--preserve-credentials"]);
        }
        if self.has_clocks {
            command.args(["--time", "--mount"]);
        }
        command.arg("--").arg(program);
        command
    }

    /// Runs a program inside, for example `ip link set lo up`.
    #[track_caller]
    pub(crate) fn run(&self, line: &str) {
        let mut words = line.split_whitespace();
        let mut command = self.command(words.next().unwrap());
        let output = command.args(words).output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{MISSING}\n`{line}`: {errors}");
    }

    /// For `ip`, which names namespaces by processes.
    pub(crate) fn id(&self) -> u32 {
        self.inside
    }
}

impl Drop for Namespace {
    fn drop(&mut self) {
        drop(self.holder.stdin.take());
        let _ended = self.holder.wait();
    }
}

/// The way out when a machine has no namespaces. Without them these tests would prove nothing, so they fail.
const MISSING: &str = "the tests of the gateway need network namespaces: root, or a kernel that gives them to users \
    (`unshare --user --map-root-user --net true` works); and the packages util-linux and iproute2";

fn is_root() -> bool {
    rustix::process::geteuid().is_root()
}
