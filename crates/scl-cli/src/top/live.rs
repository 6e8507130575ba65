//! The loop of the live display: handles snapshots of the system, keys and signals.

use super::Order;
use super::draw::draw;
use super::screen::Screen;
use super::view::{Action, View};
use crossterm::event::{self, Event};
use rustix::process::{Signal, getpid, kill_process};
use scl_observe::{ComponentRow, GateRow, Snapshot, StopSignals, Watch, block_on};
use scl_terminal::{Problem, output_is_terminal};
use std::io::{self, IsTerminal, stdin};
use std::process::ExitCode;
use std::thread;
use std::time::Duration;
use tokio::signal::unix::{self, SignalKind};
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};
use tokio::time::{MissedTickBehavior, interval};

/// Shows the system until the user ends it.
pub(super) fn run(watches: Vec<Watch>, period: Duration, order: Order) -> Result<ExitCode, Problem> {
    if !output_is_terminal() || !stdin().is_terminal() {
        return Err(Problem::new("standard input and output are not a terminal").help("add `--once` for a table"));
    }
    let failed = |error: io::Error| Problem::new(format!("cannot use the terminal: {error}"));
    block_on(async {
        let stop = StopSignals::watch()?;
        show(watches, period, order, stop).await.map_err(failed)
    })?;
    Ok(ExitCode::SUCCESS)
}

async fn show(mut watches: Vec<Watch>, period: Duration, order: Order, mut stop: StopSignals) -> io::Result<()> {
    let mut suspend = unix::signal(SignalKind::from_raw(Signal::TSTP.as_raw()))?;
    let mut screen = Screen::enter()?;
    let mut view = View::new(look(&mut watches), order, has_colours());
    let mut events = read_events();
    let mut ticks = interval(period);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    ticks.tick().await;
    loop {
        screen.draw(|frame| draw(frame, &view))?;
        let action = tokio::select! {
            () = stop.received() => Action::Quit,
            _ = suspend.recv() => Action::Suspend,
            _ = ticks.tick() => {
                view.update(look(&mut watches));
                Action::Draw
            }
            event = events.recv() => match event {
                Some(Event::Key(key)) => view.press(key),
                Some(_) => Action::Draw,
                // The terminal is gone.
                None => Action::Quit,
            },
        };
        match action {
            Action::Quit => return Ok(()),
            // SIGSTOP, because SIGTSTP is handled here. SIGCONT resumes the program at the next line.
            Action::Suspend => screen.leave_during(|| {
                // Sending a valid signal to this process cannot fail.
                let _ = kill_process(getpid(), Signal::STOP);
            })?,
            Action::Draw | Action::Nothing => {}
        }
    }
}

/// Takes one snapshot of all systems. If there are several, the components' names are prefixed with those of their
/// systems.
fn look(watches: &mut [Watch]) -> Snapshot {
    let mut snapshots: Vec<Snapshot> = watches.iter_mut().map(Watch::look).collect();
    if snapshots.len() == 1 {
        return snapshots.remove(0);
    }
    let mut all = Snapshot::default();
    let mut names = Vec::new();
    for snapshot in snapshots {
        let full = |component: &str| format!("{}/{component}", snapshot.system);
        all.components.extend(snapshot.components.into_iter().map(|row| ComponentRow { name: full(&row.name), ..row }));
        all.gates.extend(snapshot.gates.into_iter().map(|row| GateRow { component: full(&row.component), ..row }));
        names.push(snapshot.system);
    }
    Snapshot { system: names.join(", "), ..all }
}

/// Reads keys and changes of the terminal's size on a separate thread, which ends with the program.
fn read_events() -> UnboundedReceiver<Event> {
    let (sender, receiver) = unbounded_channel();
    thread::spawn(move || {
        while !sender.is_closed() {
            match event::read() {
                Ok(event) => drop(sender.send(event)),
                // Interrupted by a signal, for example after the program was suspended.
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(_) => break,
            }
        }
    });
    receiver
}

/// Returns false if `NO_COLOR` is set and not empty (<https://no-color.org>).
fn has_colours() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
