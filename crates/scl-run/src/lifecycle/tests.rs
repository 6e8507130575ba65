//! Stories of one component: inputs with their times, and what is done. The properties are tested with all components
//! together, in `run_state`.

use super::*;
use std::time::Duration;

const EXIT_0: Input = Input::Exited(Ending::Exited(0));
const EXIT_3: Input = Input::Exited(Ending::Exited(3));

fn millis(time: u64) -> Time {
    Duration::from_millis(time)
}

fn restarting(restart: Restart) -> Policy {
    Policy { restart, ..Policy::default() }
}

fn watched() -> Policy {
    let limit = |time| Some(millis(time));
    Policy { ready_within: limit(5000), alive_within: limit(500), ..restarting(Restart::OnFailure) }
}

/// Starts a component and puts it through a story.
fn story(policy: Policy, inputs: &[(u64, Input)]) -> (Lifecycle, Vec<Action>) {
    let mut component = Lifecycle::new(policy);
    assert_eq!(component.step(Time::ZERO, Input::Time), [Action::Start]);
    assert_eq!(component.step(Time::ZERO, Input::Started), []);
    let actions = inputs.iter().flat_map(|(at, input)| component.step(millis(*at), input.clone())).collect();
    (component, actions)
}

#[track_caller]
fn check(policy: Policy, inputs: &[(u64, Input)], expected: &[Action], state: State) {
    let (component, actions) = story(policy, inputs);
    assert_eq!(actions, expected);
    assert_eq!(component.state, state);
}

fn report(text: &str) -> Action {
    Action::Report(text.to_owned())
}

fn end(code: i32, after: u64) -> Action {
    Action::ReportEnd(Ending::Exited(code), millis(after))
}

fn waiting(until: u64) -> State {
    State::Waiting { until: millis(until) }
}

#[test]
fn an_end_is_final_without_a_policy() {
    check(Policy::default(), &[(7, EXIT_0)], &[end(0, 7)], State::Ended(Verdict::InOrder));
    check(Policy::default(), &[(7, EXIT_3)], &[end(3, 7)], State::Ended(Verdict::Failed));
}

#[test]
fn the_policy_decides_which_end_is_followed_by_a_start() {
    let soon = report("restarting in 100ms");
    check(restarting(Restart::OnFailure), &[(7, EXIT_0)], &[end(0, 7)], State::Ended(Verdict::InOrder));
    check(restarting(Restart::OnFailure), &[(7, EXIT_3)], &[end(3, 7), soon.clone()], waiting(107));
    check(restarting(Restart::Always), &[(7, EXIT_0)], &[end(0, 7), soon.clone()], waiting(107));
    check(restarting(Restart::OnAbnormal), &[(7, EXIT_0)], &[end(0, 7)], State::Ended(Verdict::InOrder));
    check(restarting(Restart::OnAbnormal), &[(7, EXIT_3)], &[end(3, 7)], State::Ended(Verdict::Failed));
    let again = [(7, EXIT_3), (106, Input::Time), (107, Input::Time), (108, Input::Started), (208, EXIT_3)];
    let actions = [end(3, 7), soon, Action::Start, end(3, 100), report("restarting in 200ms")];
    check(restarting(Restart::OnFailure), &again, &actions, waiting(408));
}

#[test]
fn the_limit_of_restarts_ends_it() {
    let policy = Policy {
        limit: super::super::policy::RestartLimit { count: 1, within: millis(1000) },
        ..restarting(Restart::Always)
    };
    let inputs = [(0, EXIT_3), (100, Input::Time), (100, Input::Started), (100, EXIT_3)];
    let (component, actions) = story(policy, &inputs);
    assert_eq!(component.state, State::Ended(Verdict::Failed));
    assert_eq!(actions.last(), Some(&report("not restarted: the restart limit (1 in 1s) is reached")));
    assert_eq!(
        component.failure.as_deref(),
        Some("ended with exit code 3, and the restart limit (1 in 1s) is reached")
    );
    assert_eq!(component.restarts.total, 1);
}

#[test]
fn a_program_that_cannot_be_started_is_a_failure_like_others() {
    let mut component = Lifecycle::new(restarting(Restart::OnFailure));
    component.step(Time::ZERO, Input::Time);
    let actions = component.step(millis(1), Input::CannotStart("no memory".to_owned()));
    assert_eq!(actions, [report("cannot be started: no memory"), report("restarting in 100ms")]);
    assert_eq!(component.state, waiting(101));
}

#[test]
fn not_ready_in_time_is_a_failure_with_its_reason() {
    let status = Input::Notified(Notice::Status("waiting for `controller.commands`".to_owned()));
    let killed = Input::Exited(Ending::Killed(Signal::TERM.as_raw()));
    check(
        watched(),
        &[(10, status), (4999, Input::Time), (5000, Input::Time), (5100, killed)],
        &[
            report("not ready within 5s: waiting for `controller.commands`"),
            Action::Signal(Signal::TERM),
            Action::ReportEnd(Ending::Killed(Signal::TERM.as_raw()), millis(5100)),
            report("restarting in 100ms"),
        ],
        waiting(5200),
    );
    let (component, _) = story(watched(), &[(4000, Input::Notified(Notice::Ready))]);
    assert_eq!((component.state, component.due()), (State::Ready, Some(millis(4500))));
}

#[test]
fn a_missed_sign_of_life_is_a_failure_once_it_was_ready() {
    let alive = |at| (at, Input::Notified(Notice::Alive));
    check(
        watched(),
        &[
            (10, Input::Notified(Notice::Ready)),
            alive(400),
            (899, Input::Time),
            (900, Input::Time),
            (5900, Input::Time),
        ],
        &[
            report("no sign of life for 500ms"),
            Action::Signal(Signal::ABORT),
            report("not stopped within 5s, killed"),
            Action::Signal(Signal::KILL),
        ],
        State::Stopping { reason: StopReason::Failed, kill_at: None },
    );
    let (component, actions) = story(watched(), &[(10, Input::Notified(Notice::Stopping)), (600, Input::Time)]);
    assert_eq!(actions, []);
    assert_eq!(component.due(), Some(millis(5010)));
}

#[test]
fn a_program_that_says_that_it_stops_ends_on_its_own_account() {
    let stopping = (10, Input::Notified(Notice::Stopping));
    check(watched(), &[stopping.clone(), (20, EXIT_0)], &[end(0, 20)], State::Ended(Verdict::InOrder));
    check(watched(), &[stopping, (20, EXIT_3)], &[end(3, 20), report("restarting in 100ms")], waiting(120));
}

#[test]
fn all_are_stopped_whatever_they_do() {
    let stop = |at| (at, Input::StopAll(Signal::INT));
    let signal = Action::Signal(Signal::INT);
    check(watched(), &[stop(10), (20, EXIT_0)], &[signal.clone(), end(0, 20)], State::Ended(Verdict::InOrder));
    check(watched(), &[stop(10), (20, EXIT_3)], &[signal, end(3, 20)], State::Ended(Verdict::Failed));
    let expected = [end(3, 5), report("restarting in 100ms")];
    check(watched(), &[(5, EXIT_3), stop(10)], &expected, State::Ended(Verdict::InOrder));
}

#[test]
fn a_request_stops_or_starts_one() {
    let term = Action::Signal(Signal::TERM);
    check(watched(), &[(1, Input::Stop), (2, EXIT_3)], &[term.clone(), end(3, 2)], State::Ended(Verdict::Stopped));
    check(watched(), &[(1, Input::Restart), (2, EXIT_3)], &[term.clone(), end(3, 2), Action::Start], State::Starting);
    check(
        watched(),
        &[(1, Input::Stop), (2, Input::Restart), (3, EXIT_0)],
        &[term.clone(), end(0, 3), Action::Start],
        State::Starting,
    );
    check(
        watched(),
        &[(1, Input::Restart), (2, Input::Stop), (3, EXIT_0)],
        &[term, end(0, 3)],
        State::Ended(Verdict::Stopped),
    );
    check(
        restarting(Restart::Never),
        &[(1, EXIT_3), (2, Input::Restart)],
        &[end(3, 1), Action::Start],
        State::Starting,
    );
}

#[test]
fn the_rest_of_a_program_whose_first_process_ended_is_told_once_and_waited_for() {
    let (ended, term) = ((10, Input::LeaderEnded), Action::Signal(Signal::TERM));
    check(watched(), &[ended.clone(), (20, EXIT_0)], &[term.clone(), end(0, 20)], State::Ended(Verdict::InOrder));
    check(
        watched(),
        &[ended.clone(), (20, EXIT_3)],
        &[term.clone(), end(3, 20), report("restarting in 100ms")],
        waiting(120),
    );
    let killed = [term.clone(), report("not stopped within 5s, killed"), Action::Signal(Signal::KILL), end(0, 5020)];
    check(watched(), &[ended.clone(), (5010, Input::Time), (5020, EXIT_0)], &killed, State::Ended(Verdict::InOrder));
    // A second signal would end a program of SCL at once.
    let stopped = [ended.clone(), (11, Input::StopAll(Signal::INT)), (20, EXIT_0)];
    check(watched(), &stopped, &[term.clone(), end(0, 20)], State::Ended(Verdict::InOrder));
    for (stop, signal) in [(Input::StopAll(Signal::INT), Signal::INT), (Input::Stop, Signal::TERM)] {
        let (component, actions) = story(watched(), &[(5, stop), ended.clone()]);
        assert_eq!(actions, [Action::Signal(signal)]);
        assert_eq!(component.due(), Some(millis(5005)), "waits for the rest");
    }
    let (_, actions) = story(watched(), &[(5, Input::Notified(Notice::Stopping)), ended, (11, Input::Stop)]);
    assert_eq!(actions, [term]);
}

#[test]
fn a_shell_says_by_its_exit_code_that_a_signal_ended_its_program() {
    let soon = report("restarting in 100ms");
    let exit = |code| [(7, Input::Exited(Ending::Exited(code)))];
    check(restarting(Restart::OnAbnormal), &exit(137), &[end(137, 7), soon], waiting(107));
    for code in [1, 127, 128, 200] {
        check(restarting(Restart::OnAbnormal), &exit(code), &[end(code, 7)], State::Ended(Verdict::Failed));
    }
}

#[test]
fn a_wrong_program_fails_for_good_and_is_given_time_to_say_so() {
    let refused = (10, Input::Refused("opens `gps`".to_owned()));
    let expected = [report("opens `gps`"), end(3, 20)];
    let (component, actions) = story(watched(), &[refused.clone(), (20, EXIT_3)]);
    assert_eq!((actions.as_slice(), component.state), (&expected[..], State::Ended(Verdict::Failed)));
    assert_eq!(component.failure.as_deref(), Some("opens `gps`"));
    let (component, actions) = story(watched(), &[refused, (5010, Input::Time)]);
    assert_eq!(actions[1..], [report("not stopped within 5s, killed"), Action::Signal(Signal::KILL)]);
    assert_eq!(component.failure.as_deref(), Some("opens `gps`"));
}
