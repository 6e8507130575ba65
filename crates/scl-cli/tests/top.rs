//! `scl top`: its table, its JSON, and the live display in a real terminal.

use crate::rover::{COMPONENTS, Rover};
use scl_needs::needs;
use serde_json::Value;
use std::process::{Command, Output};

#[test]
fn a_table_lists_components_and_gates() {
    let rover = Rover::start();
    let text = rover.text(&["top", "--once"]);
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(lines[0], ["COMPONENT", "STATE", "PID", "CPU", "MEM", "SINCE"]);
    let sensor = lines.iter().find(|line| line.first() == Some(&"sensor")).unwrap();
    assert_eq!(sensor[2], rover.process_id("sensor").to_string());
    assert!(lines.iter().any(|line| line[..] == ["actuator", "stopped", "-", "-", "-", "-"]), "{text}");
    let header = ["GATE", "KIND", "RATE", "SENT", "RECEIVED", "WAIT", "DROP", "LOST", "PEERS"];
    assert!(lines.iter().any(|line| line[..] == header), "{text}");
    let gate = lines.iter().find(|line| line.first() == Some(&"sensor.measurements")).unwrap();
    assert_eq!((gate[1], gate[8]), ("pub", "1/1"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80) && !text.contains('\u{1b}'), "{text}");
}

#[test]
fn json_has_the_figures_of_the_stats_files() {
    let rover = Rover::start();
    let sending = ["sensor.measurements", "sensor.log", "controller.log", "logger.events"];
    // A component that gets no processor hangs for a while, and its gates have no rate.
    let top = rover.wait_for(&["top", "--once", "--period", "2s"], |top| {
        let are_ready = COMPONENTS.iter().all(|&name| row(top, "component", name)["state"] == "ready");
        let send = sending.iter().all(|&name| row(top, "gate", name)["rate_hz"].as_f64().unwrap() > 0.0);
        (are_ready && send).then(|| top.clone())
    });
    assert_eq!(top["system"], "rover");
    for component in COMPONENTS {
        let row = row(&top, "component", component);
        assert_eq!(row["pid"], rover.process_id(component), "{row}");
        assert!(row["memory_bytes"].as_u64().unwrap() > 100_000 && row["cpu_percent"].is_f64(), "{row}");
    }
    let measurements = row(&top, "gate", "sensor.measurements");
    assert_eq!((&measurements["connected"], &measurements["kind"]), (&1.into(), &"pub".into()));
    assert_eq!(measurements["peers"][0]["gate"], "controller.sensor");
}

/// The row of a component or a gate, which is what `key` says.
fn row<'a>(top: &'a Value, key: &str, name: &str) -> &'a Value {
    let rows = top[format!("{key}s")].as_array().unwrap();
    rows.iter().find(|row| row[key] == name).unwrap()
}

#[test]
fn rows_are_sorted() {
    let rover = Rover::start();
    let top = rover.json(&["top", "--once", "--sort", "memory", "--format", "json"]);
    let memory: Vec<_> = top["components"].as_array().unwrap().iter().map(|row| row["memory_bytes"].as_u64()).collect();
    assert!(memory.is_sorted_by(|one, other| one >= other), "{memory:?}");
}

#[test]
fn a_hanging_component_is_seen_without_its_help() {
    let rover = Rover::start();
    crate::system::kill("-STOP", rover.process_id("sensor"));
    while !rover
        .text(&["top", "--once", "--period", "100ms"])
        .lines()
        .any(|line| line.starts_with("sensor ") && line.contains(" hangs "))
    {}
    crate::system::kill("-CONT", rover.process_id("sensor"));
}

#[test]
fn the_live_display_needs_a_terminal() {
    let rover = Rover::start();
    let error = rover.error(&["top"], 2);
    assert!(error.contains("= help: add `--once` for a table"), "{error}");
    assert!(rover.error(&["top", "--format", "json"], 2).contains("= help: add `--once`"));
}

/// Runs `scl top` in a pseudo terminal of 80 columns and 24 lines, and does what the steps say; then prints whether the
/// terminal was restored, and how the program ended. A text that a step waits to see is one word: spaces are not drawn.
const TERMINAL: &str = r#"
import fcntl, os, pty, select, signal, struct, sys, termios

master, slave = pty.openpty()
size = [24, 80]
def resize():
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", *size, 0, 0))

resize()
# `scl` may write the input speed where it was "the same as the output speed" (`CIBAUD`).
def attributes():
    found = termios.tcgetattr(slave)
    found[2] &= ~0o2003600000
    return found

before = attributes()
pid = os.fork()
if pid == 0:
    os.setsid()
    fcntl.ioctl(slave, termios.TIOCSCTTY, 0)
    for descriptor in range(3):
        os.dup2(slave, descriptor)
    os.execv(sys.argv[1], [sys.argv[1], "top"])

output = b""
ended = None
def status():
    global ended
    if ended is None:
        found, how = os.waitpid(pid, os.WNOHANG)
        ended = os.waitstatus_to_exitcode(how) if found else None
    return ended

def wait_for(text, on_screen=False):
    global output
    while text not in output:
        if select.select([master], [], [], 0.1)[0]:
            output += os.read(master, 65536)
        elif status() is not None:
            sys.exit(f"ended with {status()} before {text}: {output}")
        elif on_screen:
            # Only what has changed is drawn, which can be parts of a word. With another size, all of it is.
            size[0] ^= 1
            resize()
    output = output.split(text, 1)[1]

def restored():
    wait_for(b"\x1b[?1049l")
    return attributes() == before

wait_for(b"\x1b[?1049h")
wait_for(b"PEERS")
assert attributes() != before
for step in sys.argv[2:]:
    if step.startswith("key:"):
        os.write(master, step[4:].encode().decode("unicode_escape").encode("latin1"))
    elif step.startswith("signal:"):
        os.kill(pid, getattr(signal, step[7:]))
    elif step.startswith("see:"):
        wait_for(step[4:].encode(), on_screen=True)
    elif step.startswith("size:"):
        size = [int(number) for number in step[5:].split("x")]
        resize()
    elif step == "suspended":
        assert os.WIFSTOPPED(os.waitpid(pid, os.WUNTRACED)[1])
        print("suspended, restored:", restored())
        os.kill(pid, signal.SIGCONT)
        wait_for(b"\x1b[?1049h")
        wait_for(b"PEERS")
print("restored:", restored())
print("exit code:", status() if status() is not None else os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]))
"#;

fn in_terminal(steps: &[&str]) -> String {
    let rover = Rover::start();
    let mut command = Command::new("python3");
    let scl = rover.scl(&[]);
    command.args(["-c", TERMINAL, env!("CARGO_BIN_EXE_scl")]).args(steps).env("TERM", "xterm-256color");
    command.current_dir(rover.path("")).envs(scl.get_envs().filter_map(|(name, value)| Some((name, value?))));
    let Output { stdout, stderr, .. } = command.output().unwrap();
    assert!(stderr.is_empty(), "{}", String::from_utf8_lossy(&stderr));
    String::from_utf8(stdout).unwrap()
}

#[needs("python3")]
#[test]
#[cfg(feature = "tui")]
fn the_terminal_is_restored_however_the_display_ends() {
    let restored = "restored: True\nexit code: 0\n";
    for end in ["key:q", "key:\\x03", "signal:SIGTERM", "signal:SIGINT", "signal:SIGHUP"] {
        assert_eq!(in_terminal(&[end]), restored, "{end}");
    }
}

#[needs("python3")]
#[test]
#[cfg(feature = "tui")]
fn the_terminal_is_restored_while_the_display_is_suspended() {
    let expected = "suspended, restored: True\nrestored: True\nexit code: 0\n";
    for stop in ["key:\\x1a", "signal:SIGTSTP"] {
        assert_eq!(in_terminal(&[stop, "suspended", "key:q"]), expected, "{stop}");
    }
}

#[needs("python3")]
#[test]
#[cfg(feature = "tui")]
fn keys_and_sizes_change_what_is_shown() {
    // Down twice chooses the second gate, Enter shows its connections.
    let steps = ["key:\\x1b[B", "key:\\x1b[B", "key:\\r", "see:taken", "key:s", "size:20x40", "see:q", "key:q"];
    assert_eq!(in_terminal(&steps), "restored: True\nexit code: 0\n");
}
