//! A recording, as pages see it: each page has a position of its own, and plays from there.

use crate::board::Board;
use crate::live::{Troubles, enliven};
use crate::picture::Picture;
use crate::shown::{Message, Shown};
use crate::site::{WINDOW, gates_of};
use crate::stream::Events;
use scl::tap::ObservedKind;
use scl_observe::{ConnectionRow, GateRow, Snapshot};
use scl_plan::{GateKind, GatePlan, Plan, SystemPlan};
use scl_record::format::Part;
use scl_record::recording::{Index, MessagesFrom, RecordedChannel, Recording, TimedMessage};
use scl_terminal::Problem;
use scl_value::{FieldPath, GateTypes, MessageType};
use serde_json::json;
use std::collections::{BTreeMap, HashMap, VecDeque};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::time::{MissedTickBehavior, interval};

/// The time between two values that the page gets.
const PERIOD: Duration = Duration::from_millis(250);
/// How much of the recording before a position is read there: what a plot shows at first.
const BEFORE: Duration = Duration::from_secs(10);

/// What all pages of a recording share.
pub(crate) struct Recorded {
    index: Arc<Index>,
    plans: SystemPlan,
    /// The channels with the messages of each gate, or of the gates that it receives from.
    channels: HashMap<String, Vec<usize>>,
    /// The last values of the parameters of each component.
    parameters: BTreeMap<String, BTreeMap<String, String>>,
    notes: Vec<String>,
}

/// Where and how a page plays.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Play {
    /// Counted from the beginning of the recording.
    pub(crate) from: Duration,
    /// Seconds of the recording in a second; 0 stands still.
    pub(crate) speed: f64,
}

/// One page.
struct Player {
    recorded: Arc<Recorded>,
    picture: Picture,
    board: Board,
    position: Duration,
    speed: f64,
    messages: MessagesFrom,
    /// The first message after the position.
    ahead: Option<TimedMessage>,
    /// By channel, when the messages of the last seconds were received.
    recent: Vec<VecDeque<Duration>>,
    gate: Option<Gate>,
}

/// The gate that a page shows, and its channels.
struct Gate {
    channels: Vec<usize>,
    shown: Shown,
}

impl Recorded {
    /// Reads a recording once. `plans` say what is drawn.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub(crate) fn open(recording: &Recording, plans: SystemPlan) -> Result<Self, Problem> {
        let index = Index::build(recording)?;
        let mut channels: HashMap<String, Vec<usize>> = HashMap::new();
        for (number, channel) in index.channels().iter().enumerate() {
            let gates = [channel.topic.gate_name()].into_iter().chain(channel.metadata.peers.iter().cloned());
            gates.for_each(|gate| channels.entry(gate).or_default().push(number));
        }
        let (parameters, notes) = (recording.parameters(), recording.notes());
        Ok(Self { index: Arc::new(index), plans, channels, parameters, notes })
    }

    fn channels_of(&self, gate: &str) -> &[usize] {
        self.channels.get(gate).map_or(&[], Vec::as_slice)
    }

    fn types_of(&self, channels: &[usize]) -> GateTypes {
        let of = |is_reply: bool| {
            let mut channels = channels.iter().map(|&channel| &self.index.channels()[channel]);
            let found = channels.find(|channel| (channel.topic.part == Part::Reply) == is_reply);
            found.map_or_else(|| MessageType::opaque("nothing of it was recorded"), RecordedChannel::message_type)
        };
        GateTypes { message: of(false), reply: of(true) }
    }
}

/// Plays a recording for a page until that closes, or shows why it cannot.
pub(crate) async fn play(
    recorded: Arc<Recorded>,
    variant: usize,
    play: Play,
    gate: Option<(String, Option<FieldPath>)>,
    mut events: Events,
) {
    let played = match Player::new(recorded, variant, play, gate) {
        Ok(player) => player.run(&mut events).await,
        Err(problem) => Err(problem),
    };
    if let Err(problem) = played
        && events.send("state", &json!({"problems": [problem.message()]})).await
    {
        events.closed().await;
    }
}

impl Player {
    /// Goes to a position.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    fn new(
        recorded: Arc<Recorded>,
        variant: usize,
        play: Play,
        gate: Option<(String, Option<FieldPath>)>,
    ) -> Result<Self, Problem> {
        let position = play.from.min(recorded.index.length());
        let gate = gate.map(|(name, field)| {
            let channels = recorded.channels_of(&name).to_vec();
            let types = recorded.types_of(&channels);
            Gate { channels, shown: Shown::new(name, types, field) }
        });
        let mut player = Self {
            messages: recorded.index.messages_from(position.saturating_sub(BEFORE))?,
            recent: vec![VecDeque::new(); recorded.index.channels().len()],
            picture: Picture::new(variant),
            board: Board::new(),
            speed: play.speed,
            recorded,
            position,
            ahead: None,
            gate,
        };
        player.advance()?;
        player.look_back()?;
        Ok(player)
    }

    /// Sends what changes, until the page closes.
    ///
    /// # Errors
    /// A file cannot be read any more.
    async fn run(mut self, events: &mut Events) -> Result<(), Problem> {
        let mut due = interval(PERIOD);
        due.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let (mut version, mut before) = (0, Instant::now());
        loop {
            let is_there = tokio::select! {
                () = events.closed() => false,
                () = events.quiet() => events.keep_alive().await,
                _ = due.tick() => true,
            };
            if !is_there {
                return Ok(());
            }
            let now = Instant::now();
            let passed = Duration::try_from_secs_f64(now.duration_since(before).as_secs_f64() * self.speed);
            before = now;
            self.position = (self.position + passed.unwrap_or_default()).min(self.recorded.index.length());
            self.advance()?;
            self.show(now);
            let (values, newest) = self.board.since(version);
            version = newest;
            let shown = self.gate.as_mut().and_then(|gate| gate.shown.take());
            let sent = values.is_empty() || events.send("state", &values.into_iter().collect()).await;
            let sent = sent && if let Some(shown) = shown { events.send("gate", &shown).await } else { true };
            if !sent {
                return Ok(());
            }
        }
    }

    /// Learns the last messages of the shown gate, however long ago they were.
    fn look_back(&mut self) -> Result<(), Problem> {
        let Some(gate) = self.gate.as_mut().filter(|gate| gate.shown.is_empty()) else { return Ok(()) };
        for &channel in &gate.channels {
            if let Some(message) = self.recorded.index.latest(channel, self.position)? {
                gate.shown.learn(message_of(&self.recorded, message));
            }
        }
        Ok(())
    }

    /// Reads up to the position.
    fn advance(&mut self) -> Result<(), Problem> {
        loop {
            let next = match self.ahead.take() {
                Some(message) => Some(message),
                None => self.messages.read()?,
            };
            let Some(next) = next else { break };
            if next.at > self.position {
                self.ahead = Some(next);
                break;
            }
            let channel = next.message.channel;
            self.recent[channel].push_back(next.at);
            if let Some(gate) = self.gate.as_mut().filter(|gate| gate.channels.contains(&channel)) {
                gate.shown.learn(message_of(&self.recorded, next));
            }
        }
        for times in &mut self.recent {
            while times.front().is_some_and(|&time| time + WINDOW < self.position) {
                times.pop_front();
            }
        }
        Ok(())
    }

    fn show(&mut self, now: Instant) {
        let (snapshot, troubles) = (self.snapshot(), Troubles::default());
        let plans = &self.recorded.plans;
        let mut values = self.picture.values(plans, |diagram| {
            enliven(diagram, plans, &snapshot, &troubles, now);
            // A recording does not tell which programs ran.
            diagram.blocks.iter_mut().for_each(|block| block.state = None);
        });
        let begin = self.recorded.index.first_ns().unwrap_or(0);
        let date = (u128::from(begin) + self.position.as_nanos()) / 1_000_000;
        let time = json!({
            "at": self.position.as_secs_f64(), "length": self.recorded.index.length().as_secs_f64(),
            "date": u64::try_from(date).unwrap_or(u64::MAX),
        });
        for component in plans.components.iter().map(|plan| &plan.component) {
            let gates = gates_of(component, plans, &snapshot, &troubles, now);
            let parameters = self.recorded.parameters.get(component).into_iter().flatten().collect::<Vec<_>>();
            let value = json!({"activity": "recorded", "parameters": parameters, "gates": gates});
            values.insert(format!("component {component}"), value);
        }
        values.insert("time".to_owned(), time);
        values.insert("problems".to_owned(), json!(self.recorded.notes));
        self.board.show(values);
    }

    /// The rates of all gates at the position, as far as they were recorded.
    fn snapshot(&self) -> Snapshot {
        let components = &self.recorded.plans.components;
        let row = |plan: &Plan, gate: &GatePlan| {
            let name = format!("{}.{}", plan.component, gate.name);
            let peers = gate.connections.iter().map(|it| format!("{}.{}", it.peer_component, it.peer_gate));
            let connections = peers.map(|peer| ConnectionRow { peer, connected: Some(true) }).collect();
            GateRow {
                component: plan.component.clone(),
                gate: gate.name.clone(),
                kind: gate.kind,
                payload: gate.payload.to_string(),
                codec: gate.codec.clone(),
                // Who of several senders has sent something is not recorded.
                rate: (!matches!(gate.kind, GateKind::Push | GateKind::Req)).then(|| self.rate(&name)).flatten(),
                figures: None,
                connections,
            }
        };
        let gates = components.iter().flat_map(|plan| plan.gates.iter().map(move |gate| row(plan, gate)));
        Snapshot { system: self.recorded.plans.system.clone(), components: Vec::new(), gates: gates.collect() }
    }

    /// Messages or requests per second; `None` if the gate was not recorded.
    fn rate(&self, gate: &str) -> Option<f64> {
        let channels = self.recorded.channels_of(gate);
        let counted = channels.iter().filter(|&&it| self.recorded.index.channels()[it].topic.part != Part::Reply);
        let count = counted.map(|&channel| self.recent[channel].len()).sum::<usize>();
        let window = WINDOW.min(self.position).max(Duration::from_millis(1));
        (!channels.is_empty()).then(|| count as f64 / window.as_secs_f64())
    }
}

fn message_of(recorded: &Recorded, TimedMessage { message, .. }: TimedMessage) -> Message {
    let kind = match recorded.index.channels()[message.channel].topic.part {
        Part::Message => ObservedKind::Message,
        Part::Request => ObservedKind::Request,
        Part::Reply => ObservedKind::Reply,
    };
    let number = u64::from(message.sequence);
    Message { kind, sequence: number, call: number, sent_ns: message.sent_ns, payload: message.payload }
}
