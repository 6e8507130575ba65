//! Replay: playing recorded components in a running system.
//!
//! Each played component is opened from the recording's plan, under its own lock, so its peers cannot tell it from the
//! program that was recorded. Its `pub`, `push` and `req` gates send the recorded messages at the recorded intervals.
//! Its `rep` gates answer with the recorded replies; its other gates receive messages and discard them.

mod answers;
mod pace;
mod participants;
mod players;
mod report;
mod routes;
mod timeline;

pub use report::{AnswerReport, GateReport, Late, NotTaken, ReplayReport};

use crate::recording::{RecordedChannel, Recording, Survey};
use answers::{GateId, read_answers};
use pace::Pace;
use participants::Participants;
use players::Players;
use routes::{Route, route};
use scl_plan::{GateKind, SystemPlan};
use scl_terminal::{Problem, escape, quoted_list};
use std::ops::Range;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use timeline::{Batch, Batches, Timed};

/// How a recording is replayed.
#[derive(Debug, Clone)]
pub struct ReplayOptions {
    /// The components to play; empty: all that are not running.
    pub components: Vec<String>,
    /// Replay these gates only, named as recorded or by the gate that sends; empty: all.
    pub only: Vec<String>,
    /// How fast to replay.
    pub rate: Rate,
    /// Begin at this time of the recording.
    pub start: Duration,
    /// End before this time of the recording.
    pub end: Option<Duration>,
    /// Begin again at the end, until a stop is requested.
    pub repeat: bool,
    /// The name of the system in which to replay; `None`: `$SCL_SYSTEM`, else that of the plan.
    pub system: Option<String>,
    /// The longest pause between two messages; longer ones are shortened. `None`: pauses are as recorded.
    pub max_gap: Option<Duration>,
    /// How long the peers of the played components may take to connect; zero: do not wait.
    pub ready_within: Duration,
    /// The plan to use instead of the recorded one, from another topology.
    pub plan: Option<SystemPlan>,
}

/// How fast a recording is replayed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rate {
    /// This many times as fast as it was recorded.
    Times(f64),
    /// As fast as the peers take the messages. None is dropped.
    Max,
}

impl Rate {
    pub(crate) fn is_max(self) -> bool {
        self == Self::Max
    }
}

/// Replays a recording until its end, or until a stop is requested. Needs a tokio runtime.
///
/// `survey` is that of the recording; `progress` is called with the position in it.
///
/// # Errors
/// The recording cannot be read, has no plan, or does not fit the running system; a component cannot be opened; a peer
/// is missing.
pub async fn replay(
    recording: &Recording,
    survey: &Survey,
    options: &ReplayOptions,
    progress: &dyn Fn(Duration),
) -> Result<ReplayReport, Problem> {
    // Install the signal handlers: from now on a signal ends the replay cleanly.
    drop(scl::stop_requested());
    let plan = match &options.plan {
        Some(plan) => plan.clone(),
        None => recording.plan()?.ok_or_else(|| no_plan(recording))?,
    };
    let cast = Participants::choose(&plan, options)?;
    check_only(&plan, options)?;
    let (origin, span) = span(recording, survey, options)?;
    // Read the first batch before opening any gate: an unsuitable recording must not disturb the running system.
    let mut batches = timeline::read(recording, span.clone());
    let first = batches.recv().await.unwrap_or_else(|| Ok(Batch::default()))?;
    let mut stage = Stage { plan: &plan, cast: &cast, options, gates: Vec::new(), report: ReplayReport::default() };
    stage.add_channels(&first.channels)?;
    let first = Batch { channels: Vec::new(), ..first };

    let players = Players::open(&cast, options, read_answers(recording, &answering_gates(&cast))?).await?;
    let pace = Pace::new(options.rate, options.max_gap)?;
    let mut run = Run { recording, span, stage, players, pace, origin, progress };
    let started = Instant::now();
    let played = until_stopped(run.play_all(batches, first)).await;
    let Run { stage: Stage { mut report, .. }, players, pace, .. } = run;
    report.late = pace.late();
    report.was_stopped = played.is_none();
    let played = played.unwrap_or(Ok(()));
    let replies = players.replies();
    // A lossless replay waits for slow peers until it is stopped.
    let closed = match report.was_stopped || played.is_err() {
        true => Some(players.close(true).await),
        false => until_stopped(players.close(false)).await,
    };
    report.was_stopped |= closed.is_none();
    (report.not_taken, report.answers) = closed.unwrap_or_default();
    for gate in &mut report.gates {
        gate.replies = gate.sender.as_ref().and_then(|sender| Some(replies.get(sender)?.load(Ordering::Relaxed)));
    }
    report.took = started.elapsed();
    played.map(|()| report)
}

/// Waits for a future; `None` if a stop is requested first.
async fn until_stopped<F: Future>(future: F) -> Option<F::Output> {
    tokio::select! {
        () = scl::stop_requested() => None,
        output = future => Some(output),
    }
}

/// What is played, and the report so far.
struct Stage<'a> {
    plan: &'a SystemPlan,
    cast: &'a Participants,
    options: &'a ReplayOptions,
    /// How each of the recording's channels is played, by index.
    gates: Vec<Played>,
    report: ReplayReport,
}

/// What becomes of the messages of a channel.
struct Played {
    sender: Option<GateId>,
    /// Index in the report; `None` for replies.
    reported: Option<usize>,
}

struct Run<'a> {
    recording: &'a Recording,
    /// The times of the recording that are played.
    span: Range<u64>,
    stage: Stage<'a>,
    players: Players,
    pace: Pace,
    /// The time at which the recording begins.
    origin: u64,
    progress: &'a dyn Fn(Duration),
}

impl Run<'_> {
    async fn play_all(&mut self, mut batches: Batches, first: Batch) -> Result<(), Problem> {
        if !self.stage.options.ready_within.is_zero() {
            self.players.ready(self.stage.options.ready_within).await?;
        }
        let mut batch = first;
        loop {
            self.pace.begin((self.span.start > 0).then_some(self.span.start));
            loop {
                self.play(batch).await?;
                let Some(next) = batches.recv().await else { break };
                batch = next?;
            }
            let takes_time =
                self.stage.report.sent() > 0 || self.players.answers() && !self.stage.options.rate.is_max();
            if !self.stage.options.repeat || !takes_time {
                return Ok(());
            }
            self.stage.gates.clear();
            batches = timeline::read(self.recording, self.span.clone());
            batch = Batch::default();
        }
    }

    async fn play(&mut self, batch: Batch) -> Result<(), Problem> {
        self.stage.add_channels(&batch.channels)?;
        for Timed { time, message } in batch.messages {
            let gate = &self.stage.gates[message.channel];
            let (sender, reported) = (gate.sender.clone(), gate.reported);
            let Some(sender) = sender else {
                // Take as long as the recording, because requesters may ask at other times than they did then.
                if self.players.answers() {
                    self.pace.wait_for(time).await?;
                }
                self.stage.count(reported, |gate| gate.skipped += 1);
                continue;
            };
            self.pace.wait_for(time).await?;
            (self.progress)(Duration::from_nanos(time.saturating_sub(self.origin)));
            match self.players.send(&sender, &message.payload).await? {
                None => self.stage.count(reported, |gate| gate.sent += 1),
                Some(reason) => self.stage.count(reported, |gate| {
                    gate.reason = reason;
                    gate.skipped += 1;
                }),
            }
        }
        Ok(())
    }
}

impl Stage<'_> {
    fn add_channels(&mut self, channels: &[RecordedChannel]) -> Result<(), Problem> {
        for channel in channels {
            let recorded = channel.topic.gate_name();
            let mut route = route(self.plan, self.cast, channel)?;
            if let Route::Send { component, gate } = &route
                && !self.is_wanted(&recorded, &format!("{component}.{gate}"))
            {
                route = Route::Skip("not selected by `--only`".to_owned());
            }
            let (sender, reason) = match &route {
                Route::Send { component, gate } => (Some((component.clone(), gate.clone())), String::new()),
                Route::Skip(reason) => (None, reason.clone()),
                Route::Reply => (None, String::new()),
            };
            let reported = (route != Route::Reply).then(|| self.reported(&recorded, sender.as_ref(), reason));
            self.gates.push(Played { sender, reported });
        }
        Ok(())
    }

    /// Returns the index of a recorded gate's entry in the report, which is added if it is new. A replay that begins
    /// again continues to count.
    fn reported(&mut self, recorded: &str, sender: Option<&GateId>, reason: String) -> usize {
        let gates = &mut self.report.gates;
        gates.iter().position(|gate| gate.recorded == recorded).unwrap_or_else(|| {
            let sender = sender.map(|(component, gate)| format!("{component}.{gate}"));
            gates.push(GateReport { recorded: recorded.to_owned(), sender, reason, ..GateReport::default() });
            gates.len() - 1
        })
    }

    fn is_wanted(&self, recorded: &str, sender: &str) -> bool {
        let only = &self.options.only;
        only.is_empty() || only.iter().any(|name| name == recorded || name == sender)
    }

    fn count(&mut self, reported: Option<usize>, change: impl FnOnce(&mut GateReport)) {
        if let Some(gate) = reported.and_then(|index| self.report.gates.get_mut(index)) {
            change(gate);
        }
    }
}

/// The `rep` gates that are played.
fn answering_gates(cast: &Participants) -> Vec<GateId> {
    let gates = cast.played.iter().flat_map(|plan| plan.gates.iter().map(|gate| (&plan.component, gate)));
    let answering = gates.filter(|(_, gate)| gate.kind == GateKind::Rep);
    answering.map(|(component, gate)| (component.clone(), gate.name.clone())).collect()
}

/// The time at which the recording begins, and the times that are played.
fn span(recording: &Recording, survey: &Survey, options: &ReplayOptions) -> Result<(u64, Range<u64>), Problem> {
    // `first_ns` is the send time of the first message received, which is almost the earliest one.
    let Some(first) = survey.first_ns else {
        let problem = Problem::new(format!("the recording `{}` has no messages", recording.name()));
        return Err(survey.notes().into_iter().fold(problem, Problem::note));
    };
    let (length, start, end) = (survey.length, options.start, options.end);
    if start > length {
        let message = format!("`--start {start:?}` is after the end of the recording, which is {length:.1?} long");
        return Err(Problem::new(message));
    }
    if end.is_some_and(|end| end <= start) {
        return Err(Problem::new("nothing is left to replay: `--end` is not after `--start`"));
    }
    let at = |position: Duration| first.saturating_add(scl_text::duration::nanoseconds(position));
    let from = if start.is_zero() { 0 } else { at(start) };
    Ok((first, from..end.map_or(u64::MAX, at)))
}

/// Checks that the gates of `--only` exist.
fn check_only(plan: &SystemPlan, options: &ReplayOptions) -> Result<(), Problem> {
    let gates = || plan.components.iter().flat_map(|plan| plan.gates.iter().map(move |gate| (plan, gate)));
    let names: Vec<_> = gates().map(|(plan, gate)| format!("{}.{}", plan.component, gate.name)).collect();
    if let Some(name) = options.only.iter().find(|name| !names.contains(name)) {
        let problem = Problem::new(format!("there is no gate `{}`", escape(name)));
        return Err(problem.did_you_mean_or(name, names.iter().map(String::as_str), |problem| {
            problem.note(format!("gates: {}", quoted_list(&names)))
        }));
    }
    Ok(())
}

fn no_plan(recording: &Recording) -> Problem {
    Problem::new(format!("the recording `{}` has no plan, so its components cannot be played", recording.name()))
        .help("name the topology file with `--topology`")
}
