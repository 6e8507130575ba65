//! Gives the programs their turns, and moves the time.

use crate::faults::{Effect, Fault};
use crate::network::Network;
use crate::participant::{Beginning, Participant, Said};
use crate::patience::{is_debugged, never_waits};
use crate::processor::use_one_processor;
use crate::random::{Between, Random};
use crate::scenario::Scenario;
use crate::seed::seed_of;
use crate::speed::Speed;
use rustix::event::{Timespec, epoll};
use rustix::io::Errno;
use scl_record::format::SIMULATION_START;
use scl_run::{Pause, Seat};
use scl_terminal::{Problem, print_err};
use std::collections::{HashMap, VecDeque};
use std::fs;
use std::io;
use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The library that programs load.
const LIBRARY: &[u8] = include_bytes!(env!("SCL_SIM_LIBRARY"));
/// How often to look outside while nothing happens in the simulation.
const LOOK: Duration = Duration::from_millis(20);

/// How to simulate.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Where random numbers come from.
    pub seed: u64,
    /// What the wall clock shows at the start, since 1970; in whole seconds.
    pub start: Duration,
    /// How many seconds of simulated time may pass in a second; as many as possible if `None`.
    pub speed: Option<f64>,
    /// How long in real time a program may run without waiting.
    pub patience: Duration,
    /// How many turns programs may have before time passes.
    pub most_turns: u64,
    /// Which of the allowed processors all programs share, counted from the last.
    pub processor: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: 0,
            start: SIMULATION_START,
            speed: None,
            patience: Duration::from_secs(30),
            most_turns: 1_000_000,
            processor: 0,
        }
    }
}

/// Gives the programs of a system their turns.
///
/// Of several that can go on, the one after the last that had a turn comes first, in the order of the names of their
/// components; the recorder comes before all of them.
#[derive(Debug)]
pub struct Conductor {
    options: Options,
    library: PathBuf,
    now: Duration,
    speed: Speed,
    /// In the order in which they have turns.
    participants: Vec<Participant>,
    /// The index of the one behind the last that had a turn.
    behind_last: usize,
    /// How often each component has been started.
    starts: HashMap<String, u64>,
    /// What they wait for, each with the number of its process.
    ready: OwnedFd,
    /// The process that runs, and since when.
    running: Option<(usize, Instant)>,
    turns: u64,
    /// Number of turns since time has last passed.
    turns_now: u64,
    /// When the first program was started.
    began: Option<Instant>,
    /// How long components take to go on, and where that time comes from.
    takes: HashMap<String, (Between, Random)>,
    /// What is to go wrong.
    faults: VecDeque<Fault>,
    /// The connections that do not carry everything at once.
    network: Network,
    /// Processes that were killed. Nobody else has a turn before their ends: what others see of them comes in no order.
    killed: VecDeque<usize>,
}

impl Conductor {
    /// Creates a conductor whose library is kept in a folder, which must exist as long as programs are started.
    /// Programs and messages take as long as the scenario says, and these of its faults happen.
    ///
    /// # Errors
    ///
    /// If the library cannot be written, or the operating system refuses an epoll descriptor.
    pub fn new(options: Options, scenario: &Scenario, faults: Vec<Fault>, folder: &Path) -> io::Result<Self> {
        debug_assert!(faults.is_sorted_by_key(|fault| fault.at), "they happen in this order");
        let library = folder.join("libscl_sim.so");
        fs::write(&library, LIBRARY)?;
        let (seed, speed) = (options.seed, Speed::new(options.speed));
        let network = Network::new(seed, scenario.routes.clone())?;
        let takes = scenario.takes.iter().map(|(component, between)| {
            (component.clone(), (*between, Random::new(seed_of(seed, component, u64::MAX))))
        });
        Ok(Self {
            options,
            library,
            now: Duration::ZERO,
            speed,
            participants: Vec::new(),
            behind_last: 0,
            starts: HashMap::new(),
            ready: epoll::create(epoll::CreateFlags::CLOEXEC)?,
            running: None,
            turns: 0,
            turns_now: 0,
            began: None,
            takes: takes.collect(),
            faults: faults.into(),
            network,
            killed: VecDeque::new(),
        })
    }

    /// Returns how long the simulation has taken, in real time.
    pub fn took(&self) -> Duration {
        self.began.map_or(Duration::ZERO, |began| began.elapsed())
    }

    /// Returns how many turns the programs have had.
    pub fn turns(&self) -> u64 {
        self.turns
    }

    /// Waits up to `wait` for what programs wait for.
    fn look(&mut self, wait: Duration) -> Result<(), Problem> {
        let mut events = [MaybeUninit::<epoll::Event>::uninit(); 64];
        let wait =
            Timespec { tv_sec: wait.as_secs().try_into().unwrap_or(i64::MAX), tv_nsec: wait.subsec_nanos().into() };
        let (found, _) = match epoll::wait(&self.ready, &mut events, Some(&wait)) {
            Ok(found) => found,
            Err(Errno::INTR) => return Ok(()),
            Err(error) => return Err(failed("wait", error.into())),
        };
        for event in found {
            let process = event.data.u64();
            if let Some(it) = self.participants.iter_mut().find(|it| it.process as u64 == process) {
                it.is_ready = true;
            }
        }
        Ok(())
    }

    /// Lets those take their time for which something has just happened.
    fn begin_to_go_on(&mut self) {
        if self.takes.is_empty() {
            return;
        }
        let now = self.now;
        for it in self.participants.iter_mut().filter(|it| it.goes_on.is_none() && it.pid.is_some()) {
            if it.is_woken(now)
                && let Some((between, random)) = it.component.as_ref().and_then(|name| self.takes.get_mut(name))
            {
                it.goes_on = Some(now + random.between(*between));
            }
        }
    }

    /// Lets the faults happen whose time has come.
    fn let_happen(&mut self) {
        while let Some(fault) = self.faults.pop_front_if(|fault| fault.at <= self.now) {
            print_err(&format!("scl: {fault}\n"));
            let target = self.participants.iter_mut().find(|it| it.is(&fault.target));
            match (fault.effect, target) {
                (Effect::Cut(cut), _) => self.network.cut(&fault.target, self.now + cut),
                // Nothing happens to a component that does not run.
                (_, None) => {}
                (Effect::Pause(pause), Some(it)) => it.paused_until = self.now + pause,
                (Effect::Kill, Some(it)) => {
                    it.kill();
                    self.killed.push_back(it.process);
                }
            }
        }
    }

    /// Returns the index of the program that has the next turn.
    fn next(&self) -> Option<usize> {
        let wants = |it: &(usize, &Participant)| it.1.next_turn(self.now).is_some_and(|next| next <= self.now);
        let all = || self.participants.iter().enumerate();
        all().skip(self.behind_last).find(wants).or_else(|| all().find(wants)).map(|(index, _)| index)
    }

    fn give_turn(&mut self, index: usize) -> Result<(), Problem> {
        self.turns_now += 1;
        if self.turns_now > self.options.most_turns {
            return Err(self.endless());
        }
        let participant = &mut self.participants[index];
        // A new program says that it is there before its first turn.
        if participant.pid.is_some() {
            participant.give_turn(self.now);
            self.turns += 1;
        }
        (self.running, self.behind_last) = (Some((participant.process, Instant::now())), index + 1);
        Ok(())
    }

    /// Listens to the program that runs. Returns its process if it has ended.
    fn listen(&mut self, process: usize, since: Instant) -> Result<Option<usize>, Problem> {
        let Some(index) = self.participants.iter().position(|it| it.process == process) else {
            unreachable!("a program runs only while it takes part")
        };
        let participant = &mut self.participants[index];
        match participant.listen().map_err(|error| failed("hear of a program", error))? {
            Said::Waits(now) => {
                self.now = self.now.max(now);
                self.running = None;
                if participant.is_doomed {
                    participant.kill();
                    self.killed.push_back(process);
                }
            }
            Said::Connects(endpoint, socket) => {
                let joined = match &participant.component {
                    Some(component) => self.network.join(component, &endpoint, socket),
                    None => Ok(None),
                };
                participant.answer(joined.map_err(|error| failed("carry a connection", error))?);
            }
            Said::Nothing if since.elapsed() < self.options.patience || is_debugged(participant.pid) => {}
            Said::Nothing => return Err(never_waits(participant, self.now, self.options.patience)),
            Said::Ended => {
                self.participants.remove(index);
                if index < self.behind_last {
                    self.behind_last -= 1;
                }
                self.running = None;
                return Ok(Some(process));
            }
            Said::Nonsense => return Err(Problem::new(format!("{} says nonsense", participant.shown()))),
        }
        Ok(None)
    }

    /// When something happens next, if nothing else happens before.
    fn due(&self) -> Option<Duration> {
        let turns = self.participants.iter().filter_map(|it| it.next_turn(self.now));
        turns.chain(self.faults.front().map(|fault| fault.at)).chain(self.network.due()).min()
    }

    fn pass_time(&mut self, next: Duration) {
        debug_assert!(next >= self.now, "time does not go back");
        self.now = next;
        self.turns_now = 0;
        self.participants.iter_mut().for_each(|it| it.turns = 0);
    }

    fn endless(&self) -> Problem {
        let mut busy: Vec<&Participant> = self.participants.iter().collect();
        busy.sort_by_key(|it| std::cmp::Reverse(it.turns));
        let busy = busy.iter().filter(|it| it.turns > self.options.most_turns / 100);
        let busy: Vec<String> = busy.map(|it| format!("{} ({} times)", it.shown(), it.turns)).collect();
        let (time, busy) = (self.now.as_secs_f64(), busy.join(", "));
        Problem::new(format!("no time passes any more at {time:.6} s: the programs keep each other busy: {busy}")).help(
            "one of them has to wait, or to answer less than it is told; `--most-turns` lets them go on for longer",
        )
    }
}

impl scl_run::Conductor for Conductor {
    fn seat(&mut self, process: usize, component: Option<&str>) -> io::Result<Seat> {
        if self.began.is_none() {
            self.began = Some(Instant::now());
            use_one_processor(self.options.processor);
        }
        // The same whatever happens to the others.
        let starts = self.starts.entry(component.unwrap_or_default().to_owned()).or_default();
        let seed = seed_of(self.options.seed, component.unwrap_or_default(), *starts);
        *starts += 1;
        let beginning = Beginning { seed, start: self.options.start, tells_connections: self.network.is_of_use() };
        let (participant, inherited) = Participant::new(process, component, beginning)?;
        let data = epoll::EventData::new_u64(process as u64);
        epoll::add(&self.ready, &participant.watched, data, epoll::EventFlags::IN)?;
        // Its end, if it is killed while it waits.
        epoll::add(&self.ready, &participant.connection, data, epoll::EventFlags::RDHUP)?;
        let order = |it: &Participant| (it.component.clone(), it.process);
        let index = self.participants.partition_point(|it| order(it) < order(&participant));
        if index < self.behind_last {
            self.behind_last += 1;
        }
        self.participants.insert(index, participant);
        Ok(Seat { library: self.library.clone(), socket: inherited.socket, watched: inherited.watched })
    }

    fn now(&self) -> Duration {
        self.now
    }

    fn run(&mut self, until: Option<Duration>, has_arrived: &mut dyn FnMut() -> bool) -> Result<Pause, Problem> {
        loop {
            while let Some((process, since)) = self.running {
                if let Some(ended) = self.listen(process, since)? {
                    return Ok(Pause::Ended(ended));
                }
                if self.running.is_some() && has_arrived() {
                    return Ok(Pause::Arrived);
                }
            }
            if has_arrived() {
                return Ok(Pause::Arrived);
            }
            if until.is_some_and(|until| until <= self.now) {
                return Ok(Pause::Time);
            }
            self.let_happen();
            if let Some(killed) = self.killed.pop_front() {
                // It does nothing more in its turn, which shows its end.
                let index = self.participants.iter().position(|it| it.process == killed);
                index.map_or(Ok(()), |index| self.give_turn(index))?;
                continue;
            }
            self.network.carry(self.now).map_err(|error| failed("carry messages", error))?;
            self.look(Duration::ZERO)?;
            self.begin_to_go_on();
            if let Some(index) = self.next() {
                self.give_turn(index)?;
                continue;
            }
            // Nobody can go on before time has passed.
            let next = self.due().into_iter().chain(until).min();
            let wait = next.map_or(LOOK, |next| self.speed.wait(self.now, next).min(LOOK));
            match next {
                Some(next) if wait.is_zero() => self.pass_time(next),
                _ => self.look(wait)?,
            }
        }
    }

    fn killed(&mut self, process: usize) {
        self.killed.push_back(process);
    }

    fn signalled(&mut self, process: usize) {
        if let Some(it) = self.participants.iter_mut().find(|it| it.process == process) {
            it.is_signalled = true;
        }
    }
}

fn failed(what: &str, error: io::Error) -> Problem {
    Problem::new(format!("cannot {what}: {error}"))
}
