//! Properties of runs: any events in any order, with a world that does what is asked for.

use super::super::ending::Ending;
use super::super::lifecycle::{Notice, StopReason};
use super::super::policy::{Restart, RestartLimit};
use super::*;
use proptest::prelude::*;
use std::time::Duration;

/// The processes of the components, as the operating system has them.
struct World {
    state: RunState,
    /// Whether each component has a process.
    alive: Vec<bool>,
    /// Whether each process was sent SIGKILL.
    killed: Vec<bool>,
    now: Time,
}

impl World {
    fn new(policies: Vec<Policy>, last: Option<usize>) -> Self {
        let count = policies.len();
        let state = RunState::new(policies, last, None);
        let mut world = Self { state, alive: vec![false; count], killed: vec![false; count], now: Time::ZERO };
        world.step(RunEvent::Time);
        world
    }

    fn step(&mut self, event: RunEvent) {
        // An exit without a process cannot be.
        if let RunEvent::One(index, Input::Exited(_)) = event {
            if !self.alive[index] {
                return;
            }
            self.alive[index] = false;
        }
        let was_stopping = self.state.stopping.is_some();
        let mut actions = self.state.step(self.now, event);
        while !actions.is_empty() {
            let (index, action) = actions.remove(0);
            match action {
                Action::Start if self.state.components()[index].state == State::Starting => {
                    assert!(!self.alive[index], "a second process");
                    assert!(!was_stopping, "a start while stopping");
                    (self.alive[index], self.killed[index]) = (true, false);
                    actions.extend(self.state.step(self.now, RunEvent::One(index, Input::Started)));
                }
                Action::Signal(signal) => self.killed[index] |= signal == Signal::KILL,
                _ => {}
            }
        }
        self.check();
    }

    fn check(&self) {
        for (component, &alive) in self.state.components().iter().zip(&self.alive) {
            let has_process = matches!(component.state, State::Running | State::Ready | State::Stopping { .. });
            assert_eq!(has_process, alive, "{component:?}");
            if let State::Stopping { reason: StopReason::Everything(_), .. } = component.state {
                assert!(self.state.stopping.is_some());
            }
        }
        if self.state.failed().is_some() {
            assert!(self.state.stopping.is_some(), "a failure stops all");
        }
        if self.state.stopping.is_some() {
            let is_ending = |state| matches!(state, State::Stopping { .. } | State::Ended(_));
            let components = || self.state.components().iter().enumerate();
            let others = || components().filter(|(index, _)| Some(*index) != self.state.last);
            assert!(others().all(|(_, it)| is_ending(it.state)), "all are being stopped");
            if others().all(|(_, it)| matches!(it.state, State::Ended(_))) {
                assert!(components().all(|(_, it)| is_ending(it.state)), "the last one too, when its turn has come");
            }
        }
    }

    /// Lets time pass until nothing is due; processes ignore everything but SIGKILL.
    fn run_to_the_end(&mut self) {
        self.step(RunEvent::Stop(Signal::TERM));
        for _ in 0..20 {
            for index in 0..self.alive.len() {
                if self.killed[index] {
                    self.step(RunEvent::One(index, Input::Exited(Ending::Killed(Signal::KILL.as_raw()))));
                }
            }
            let Some(due) = self.state.due() else { return };
            self.now = self.now.max(due);
            self.step(RunEvent::Time);
        }
        panic!("something is always due: {:?}", self.state);
    }
}

fn policy() -> impl Strategy<Value = Policy> {
    let restart = prop::sample::select(vec![Restart::Never, Restart::OnAbnormal, Restart::OnFailure, Restart::Always]);
    let limit = || prop::option::of((1..2000_u64).prop_map(Duration::from_millis));
    (restart, any::<bool>(), 0..4_usize, 0..3000_u64, limit(), limit()).prop_map(
        |(restart, essential, count, stop_within, ready_within, alive_within)| Policy {
            restart,
            delay: Policy::default().delay,
            limit: RestartLimit { count, within: Duration::from_secs(2) },
            essential,
            stop_within: Duration::from_millis(stop_within),
            ready_within,
            alive_within,
        },
    )
}

fn input() -> impl Strategy<Value = Input> {
    let status = Input::Notified(Notice::Status("busy".to_owned()));
    let notices = [Notice::Ready, Notice::Stopping, Notice::Alive].map(Input::Notified);
    let endings = [Ending::Exited(0), Ending::Exited(1), Ending::Killed(Signal::TERM.as_raw())].map(Input::Exited);
    let requests =
        [Input::Stop, Input::Restart, Input::Time, Input::LeaderEnded, Input::Refused(String::new()), status];
    prop::sample::select([notices.to_vec(), endings.to_vec(), requests.to_vec()].concat())
}

/// An event for one of three components, after some milliseconds; rarely one for all.
fn event() -> impl Strategy<Value = (u64, RunEvent)> {
    let one = (0..3_usize, input()).prop_map(|(index, input)| RunEvent::One(index, input));
    let event = prop_oneof![
        30 => one,
        10 => Just(RunEvent::Time),
        1 => Just(RunEvent::Stop(Signal::INT)),
        1 => Just(RunEvent::OutputLost),
    ];
    (0..1500_u64, event)
}

proptest! {
    #[test]
    fn every_run_keeps_its_promises_and_can_be_ended(
        policies in prop::collection::vec(policy(), 3),
        last in prop::option::of(0..3_usize),
        events in prop::collection::vec(event(), 0..60),
    ) {
        let mut world = World::new(policies, last);
        for (pause, event) in events {
            world.now += Duration::from_millis(pause);
            world.step(event);
        }
        world.run_to_the_end();
        prop_assert!(world.state.is_over());
        prop_assert!(!world.alive.contains(&true));
    }

    #[test]
    fn restarts_never_exceed_their_limit(
        policy in policy(),
        pauses in prop::collection::vec(0..3000_u64, 0..40),
    ) {
        let limit = policy.limit;
        let mut world = World::new(vec![policy], None);
        let mut restarts = Vec::new();
        for pause in pauses {
            world.now += Duration::from_millis(pause);
            let before = world.state.components()[0].restarts.total;
            world.step(RunEvent::One(0, Input::Exited(Ending::Exited(1))));
            if world.state.components()[0].restarts.total > before {
                restarts.push(world.now);
            }
            world.step(RunEvent::Time);
        }
        for (index, start) in restarts.iter().enumerate() {
            let within = restarts[index..].iter().filter(|at| **at - *start < limit.within).count();
            prop_assert!(within <= limit.count, "{within} restarts, {limit:?}");
        }
    }
}

#[test]
fn a_failure_of_a_component_that_is_not_essential_stops_nothing() {
    let optional = Policy { essential: false, ..Policy::default() };
    let mut world = World::new(vec![optional, Policy::default()], None);
    world.step(RunEvent::One(0, Input::Exited(Ending::Exited(1))));
    assert_eq!((world.state.stopping, world.state.failed()), (None, None));
    world.step(RunEvent::One(1, Input::Exited(Ending::Exited(1))));
    assert_eq!((world.state.stopping, world.state.failed()), (Some(Signal::TERM), Some(1)));
}

fn always() -> Policy {
    Policy { restart: Restart::Always, essential: false, ..Policy::default() }
}

#[test]
fn the_last_one_is_stopped_when_all_others_have_ended() {
    let mut world = World::new(vec![always(), Policy::default(), Policy::default()], Some(0));
    world.step(RunEvent::Stop(Signal::INT));
    let exited = |index| RunEvent::One(index, Input::Exited(Ending::Exited(0)));
    let is_running = |world: &World| world.state.components()[0].state == State::Running;
    assert!(is_running(&world));
    world.step(exited(2));
    assert!(is_running(&world));
    world.step(exited(1));
    let told = StopReason::Everything(Signal::INT);
    assert!(matches!(world.state.components()[0].state, State::Stopping { reason, .. } if reason == told));
    world.step(exited(0));
    assert!(world.state.is_over() && world.state.failed().is_none());
}

#[test]
fn requests_kill_only_when_they_are_repeated_later() {
    let is_killed_after = |policy: Policy, first: RunEvent, millis: u64| {
        let mut world = World::new(vec![policy, Policy::default()], None);
        world.step(first);
        world.step(RunEvent::Stop(Signal::TERM));
        assert_eq!(world.killed, [false, false]);
        world.now += Duration::from_millis(millis);
        world.step(RunEvent::Stop(Signal::INT));
        world.killed[1]
    };
    let asked = || RunEvent::Stop(Signal::TERM);
    assert!(!is_killed_after(Policy::default(), asked(), 499));
    assert!(is_killed_after(Policy::default(), asked(), 500));
    // The others stop because one has failed: the first request is the one after that.
    let failed = || RunEvent::One(0, Input::Exited(Ending::Exited(3)));
    assert!(!is_killed_after(Policy::default(), failed(), 499));
    assert!(is_killed_after(Policy::default(), failed(), 500));
}

/// Somebody who stops `scl run` itself in between waits as long.
#[test]
fn a_pause_counts_between_two_requests() {
    let mut world = World::new(vec![Policy::default()], None);
    world.state.take_pause(Duration::from_secs(4));
    world.step(RunEvent::Stop(Signal::TERM));
    world.step(RunEvent::Stop(Signal::TERM));
    assert_eq!(world.killed, [false]);
    world.state.take_pause(Duration::from_secs(4));
    world.step(RunEvent::Stop(Signal::TERM));
    assert_eq!(world.killed, [true]);
}

#[test]
fn the_last_one_ends_with_the_others_but_runs_alone() {
    let exited = |index| RunEvent::One(index, Input::Exited(Ending::Exited(0)));
    let mut world = World::new(vec![always(), Policy::default()], Some(0));
    world.step(exited(1));
    assert!(matches!(world.state.components()[0].state, State::Stopping { .. }));
    let mut alone = World::new(vec![always()], Some(0));
    alone.step(RunEvent::Time);
    assert_eq!((alone.state.components()[0].state, alone.state.stopping), (State::Running, None));
    alone.step(RunEvent::Stop(Signal::TERM));
    assert!(matches!(alone.state.components()[0].state, State::Stopping { .. }));
}

#[test]
fn the_last_one_is_not_restarted_while_the_others_stop() {
    let mut world = World::new(vec![always(), Policy::default()], Some(0));
    world.step(RunEvent::Stop(Signal::TERM));
    world.step(RunEvent::One(0, Input::Exited(Ending::Killed(Signal::SEGV.as_raw()))));
    assert!(matches!(world.state.components()[0].state, State::Ended(_)));
    assert_eq!(world.state.failed(), None);
}
