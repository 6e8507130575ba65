//! A recording, which panels play.

use crate::channels::{Messages, Sent};
use crate::companions::Descriptions;
use crate::listen::Listen;
use crate::source::Source;
use foxglove::WebSocketServerHandle;
use foxglove::websocket::{
    Capability, PlaybackCommand, PlaybackControlRequest, PlaybackState, PlaybackStatus, ServerListener,
};
use scl_record::recording::{Index, MessagesFrom, RecordedChannel, Recording, TimedMessage};
use scl_terminal::{Problem, print_err};
use scl_text::duration::nanoseconds;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use tokio::time::{MissedTickBehavior, interval};

/// The time between two steps.
const PERIOD: Duration = Duration::from_millis(20);
/// How often panels learn the time.
const TOLD: u32 = 5;

/// A server that plays a recording.
pub(crate) struct Playback {
    server: WebSocketServerHandle,
    index: Arc<Index>,
    /// In the order of the channels of the recording.
    sources: Vec<Source>,
    position: Arc<Mutex<Position>>,
}

/// Where it is, and how fast it goes on.
struct Position {
    index: Arc<Index>,
    at: Duration,
    speed: f32,
    plays: bool,
    /// Whether panels have gone elsewhere since the last step.
    has_jumped: bool,
}

struct Listener(Arc<Mutex<Position>>);

impl Playback {
    /// Reads the recording once, and starts the server.
    ///
    /// # Errors
    /// A file cannot be read or is damaged, or the server cannot listen.
    pub(crate) async fn start(
        listen: &Listen,
        recording: &Recording,
        descriptions: &Descriptions,
    ) -> Result<Self, Problem> {
        let index = Arc::new(Index::build(recording)?);
        let source = |it: &RecordedChannel| {
            let (codec, type_name) = (&*it.metadata.codec, it.metadata.type_name.as_deref());
            let messages = Messages { codec, type_name, descriptors: it.descriptors() };
            Source::new(&listen.context, it.topic.clone(), &messages, descriptions)
        };
        let sources = index.channels().iter().map(source).collect::<Result<Vec<_>, _>>()?;
        if let Some(missing) = descriptions.missing(sources.iter().map(|source| &source.topic)) {
            print_err(&format!("note: the recording has no messages for {missing}\n"));
        }
        let (at, speed, plays, has_jumped) = (Duration::ZERO, 1.0, false, true);
        let position = Arc::new(Mutex::new(Position { index: index.clone(), at, speed, plays, has_jumped }));
        let first = index.first_ns().unwrap_or(0);
        let server = listen
            .server()
            .name(format!("SCL {}", recording.name()))
            .capabilities([Capability::PlaybackControl, Capability::Time])
            .playback_time_range(first, first + nanoseconds(index.length()))
            .listener(Arc::new(Listener(position.clone())));
        let server = listen.start(server).await?;
        Ok(Self { server, index, sources, position })
    }

    pub(crate) fn port(&self) -> u16 {
        self.server.port()
    }

    /// Plays as panels ask, until the future is dropped.
    ///
    /// # Errors
    /// A file cannot be read any more.
    pub(crate) async fn run(self) -> Result<(), Problem> {
        let mut due = interval(PERIOD);
        due.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let (mut before, mut step) = (Instant::now(), 0_u32);
        let mut ahead: Option<Ahead> = None;
        loop {
            due.tick().await;
            let now = Instant::now();
            let (at, has_jumped, state) = lock(&self.position).step(now.duration_since(before));
            before = now;
            step = step.wrapping_add(1);
            if has_jumped {
                ahead = None;
            }
            let messages = match &mut ahead {
                Some(messages) => messages,
                None => ahead.insert(Ahead { from: self.index.messages_from(at)?, first: None }),
            };
            let first = self.index.first_ns().unwrap_or(0);
            while let Some(TimedMessage { at: time, message }) = messages.until(at)? {
                if let Some(source) = self.sources.get(message.channel) {
                    source.send(&Sent { payload: message.payload, time: first + nanoseconds(time) });
                }
            }
            if state.is_some() || step.is_multiple_of(TOLD) {
                self.server.broadcast_time(first + nanoseconds(at));
            }
            state.into_iter().for_each(|state| self.server.broadcast_playback_state(state));
        }
    }
}

/// The messages that were not played yet.
struct Ahead {
    from: MessagesFrom,
    /// The first message that is later.
    first: Option<TimedMessage>,
}

impl Ahead {
    fn until(&mut self, at: Duration) -> Result<Option<TimedMessage>, Problem> {
        let next = match self.first.take() {
            Some(next) => Some(next),
            None => self.from.read()?,
        };
        match next {
            Some(next) if next.at > at => {
                self.first = Some(next);
                Ok(None)
            }
            next => Ok(next),
        }
    }
}

impl Position {
    /// Goes on. Returns where it is, whether panels have gone elsewhere, and the state if it has ended.
    fn step(&mut self, passed: Duration) -> (Duration, bool, Option<PlaybackState>) {
        let length = self.index.length();
        let has_jumped = std::mem::take(&mut self.has_jumped);
        if self.plays {
            let passed = Duration::try_from_secs_f64(passed.as_secs_f64() * f64::from(self.speed));
            self.at = self.at.saturating_add(passed.unwrap_or_default()).min(length);
        }
        let has_ended = self.plays && self.at == length;
        self.plays &= !has_ended;
        (self.at, has_jumped, has_ended.then(|| self.state(None, false)))
    }

    fn state(&self, request_id: Option<String>, did_seek: bool) -> PlaybackState {
        let status = match (self.plays, self.at == self.index.length()) {
            (true, _) => PlaybackStatus::Playing,
            (false, true) => PlaybackStatus::Ended,
            (false, false) => PlaybackStatus::Paused,
        };
        let current_time = self.index.first_ns().unwrap_or(0) + nanoseconds(self.at);
        PlaybackState { status, current_time, playback_speed: self.speed, did_seek, request_id }
    }
}

impl ServerListener for Listener {
    fn on_playback_control_request(&self, request: PlaybackControlRequest) -> Option<PlaybackState> {
        let mut position = lock(&self.0);
        position.plays = matches!(request.playback_command, PlaybackCommand::Play);
        position.speed = request.playback_speed;
        if let Some(time) = request.seek_time {
            let at = Duration::from_nanos(time.saturating_sub(position.index.first_ns().unwrap_or(0)));
            position.at = at.min(position.index.length());
            position.has_jumped = true;
        }
        Some(position.state(Some(request.request_id), request.seek_time.is_some()))
    }
}

fn lock(position: &Mutex<Position>) -> std::sync::MutexGuard<'_, Position> {
    position.lock().unwrap_or_else(PoisonError::into_inner)
}
