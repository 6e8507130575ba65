//! From the taps into the queue: numbers the gates, counts losses, and reacts to signals and requests.

use super::contents::now_ns;
use super::gate::Message;
use super::losses::Losses;
use super::missed::Missed;
use super::options::Notes;
use super::parameters::Parameters;
use super::plans::Plans;
use super::queue::QueueSender;
use super::storage::{Command, Progress, SaveAnswer};
use super::trigger::{TriggerListener, answer};
use crate::format::{MISSED, PARAMETERS, Part, sequence};
use crate::record::file::WrittenFile;
use scl::tap::{Observation, ObservedKind, TapEvent};
use scl_observe::{ObservedGate, StopSignals, System, Taps, TapsEvent};
use scl_terminal::Problem;
use std::path::PathBuf;
use std::time::Duration;
use tokio::signal::unix::Signal;
use tokio::sync::oneshot;
use tokio::time::{Instant, MissedTickBehavior, interval, sleep, timeout};

/// Interval at which the figures on a terminal are updated, and the files of the components are read.
const SHOW: Duration = Duration::from_millis(500);

/// At the end of recording: after how long without a message no more are expected, and how long to wait in any case.
const ARRIVAL: Duration = Duration::from_millis(50);
const LAST_LOOK: Duration = Duration::from_millis(500);

/// Collects messages from the taps until recording ends.
pub(crate) struct Collector<'a> {
    pub(crate) system: &'a System,
    pub(crate) taps: Taps,
    /// The queue to the storage.
    pub(crate) queue: QueueSender<Command>,
    /// Listens for requests to write the ring; `None` without a ring.
    pub(crate) trigger: Option<TriggerListener>,
    pub(crate) notes: Notes,
    pub(crate) losses: Vec<Losses>,
    pub(crate) plans: Plans,
    pub(crate) parameters: Parameters,
    pub(crate) missed: Missed,
    /// Number of gates that were running at the beginning, and of those that are not connected yet.
    pub(crate) initial: usize,
    pub(crate) unconnected: usize,
}

impl Collector<'_> {
    /// Collects until a signal of `stop`, until `run_for` has passed, or until the storage stops; then closes the
    /// queue.
    pub(crate) async fn run(
        mut self,
        (mut stop, mut save): (StopSignals, Signal),
        run_for: Option<Duration>,
        progress: &Progress,
        mut stopped: oneshot::Receiver<()>,
    ) {
        let end = sleep(run_for.unwrap_or(Duration::MAX));
        tokio::pin!(end);
        let mut show = interval(SHOW);
        show.set_missed_tick_behavior(MissedTickBehavior::Skip);
        if self.initial == 0 {
            self.notes.say("no gate to record is running yet; waiting");
        }
        let is_stored = loop {
            tokio::select! {
                // Signals first: under load a message is always ready.
                biased;
                () = stop.received() => break true,
                () = &mut end => break true,
                _ = &mut stopped => break false,
                _ = save.recv() => self.save_for_signal(),
                Ok(stream) = accept(&self.trigger) => {
                    let saved = self.save();
                    tokio::spawn(async move { answer(stream, &result_of(saved).await).await });
                }
                _ = show.tick() => {
                    self.look_at_files();
                    self.notes.show(progress);
                }
                event = self.taps.next() => self.handle(event),
            }
        };
        if is_stored {
            self.take_arrived().await;
            self.look_at_files();
        }
        for (gate, losses) in self.losses.iter_mut().enumerate() {
            let lost = losses.take();
            if lost > 0 {
                self.queue.command(Command::Lost(gate, lost));
            }
        }
        self.notes.clear();
    }

    /// Collects messages that were sent before now and are still in flight.
    async fn take_arrived(&mut self) {
        let (now, deadline) = (now_ns(), Instant::now() + LAST_LOOK);
        while Instant::now() < deadline
            && let Ok(event) = timeout(ARRIVAL, self.taps.next()).await
        {
            match event {
                TapsEvent::Event { event: TapEvent::Observed(observation), .. } if observation.sent_ns > now => {}
                event => self.handle(event),
            }
        }
    }

    /// Looks at what the components write into files.
    fn look_at_files(&mut self) {
        let parameters = self.parameters.update(self.system, &self.plans).map(|values| (PARAMETERS, values));
        let missed = self.missed.update(self.system, &self.plans).map(|missed| (MISSED, missed));
        for (name, latest) in [parameters, missed].into_iter().flatten() {
            self.queue.command(Command::Latest(name, latest));
        }
    }

    fn handle(&mut self, event: TapsEvent) {
        match event {
            TapsEvent::Started(gate) => self.start(gate),
            TapsEvent::Event { gate, event: TapEvent::Observed(observation) } => self.observe(gate, observation),
            TapsEvent::Event { gate, event: TapEvent::Connected } => self.connect(gate),
            TapsEvent::Event { event: TapEvent::Disconnected, .. } => {}
        }
    }

    fn start(&mut self, gate: ObservedGate) {
        let is_initial = self.losses.len() < self.initial;
        self.losses.push(if is_initial { Losses::running() } else { Losses::started() });
        if !is_initial {
            self.notes.say(&format!("`{}` has started", gate.name()));
        }
        self.queue.command(Command::Gate(gate));
    }

    fn connect(&mut self, gate: usize) {
        // A restarted component may have a different plan.
        if let Some(plan) = self.plans.update(self.system) {
            self.queue.command(Command::Plan(plan));
        }
        if gate < self.initial && self.unconnected > 0 {
            self.unconnected -= 1;
            if self.unconnected == 0 {
                self.notes.say(&format!("connected to {} gates", self.initial));
            }
        }
    }

    fn observe(&mut self, gate: usize, observation: Observation) {
        let losses = &mut self.losses[gate];
        if observation.latched && losses.is_last(observation.sequence, observation.sent_ns) {
            return;
        }
        losses.see(observation.sequence, observation.sent_ns);
        let lost_before = losses.take();
        let part = match observation.kind {
            ObservedKind::Message => Part::Message,
            ObservedKind::Request => Part::Request,
            ObservedKind::Reply => Part::Reply,
        };
        let message = Message {
            gate,
            part,
            sequence: sequence(part, observation.sequence, observation.call_id),
            // A latched message may be older than the recording, which begins with it.
            sent_ns: if observation.latched { observation.received_ns } else { observation.sent_ns },
            received_ns: observation.received_ns,
            lost_before,
            latched: observation.latched,
            payload: observation.payload,
        };
        if !self.queue.push(message) {
            losses.add(lost_before + 1);
        }
    }

    fn save(&self) -> oneshot::Receiver<Result<Option<WrittenFile>, Problem>> {
        let (sender, saved): (SaveAnswer, _) = oneshot::channel();
        self.queue.command(Command::Save(sender));
        saved
    }

    fn save_for_signal(&self) {
        let (saved, notes) = (self.save(), self.notes.clone());
        let with_ring = self.trigger.is_some();
        tokio::spawn(async move {
            match result_of(saved).await {
                Ok(path) if with_ring => notes.say(&format!("wrote `{}`", path.display())),
                Ok(_) => {}
                Err(text) => notes.say(&text),
            }
        });
    }
}

async fn accept(trigger: &Option<TriggerListener>) -> std::io::Result<tokio::net::UnixStream> {
    match trigger {
        Some(trigger) => Ok(trigger.listener.accept().await?.0),
        None => std::future::pending().await,
    }
}

/// Waits for the result of a request to write the ring: the path of the file, or the error.
async fn result_of(saved: oneshot::Receiver<Result<Option<WrittenFile>, Problem>>) -> Result<PathBuf, String> {
    match saved.await {
        Ok(Ok(written)) => {
            let path = written.map(|file| file.path).unwrap_or_default();
            Ok(std::path::absolute(&path).unwrap_or(path))
        }
        Ok(Err(problem)) => Err(problem.to_string().trim_start_matches("error: ").trim_end().to_owned()),
        Err(_) => Err("the recorder has stopped".to_owned()),
    }
}
