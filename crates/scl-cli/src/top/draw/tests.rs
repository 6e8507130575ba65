//! The display at several sizes, as text.

use super::*;
use crate::top::view::Action;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use expect_test::{Expect, expect};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use scl::plan::GateKind;
use scl::runtime_dir::{ConnectionFigures, GateFigures};
use scl_observe::{ComponentRow, ConnectionRow, Snapshot};
use std::time::Duration;

fn component(name: &str, activity: Activity, pid: u32, processor: f64) -> ComponentRow {
    let since = Some(Duration::from_secs(3 * u64::from(pid)));
    let memory = Some(u64::from(pid) << 15);
    ComponentRow {
        name: name.to_owned(),
        activity,
        pid: Some(pid),
        processor: Some(processor),
        memory,
        since,
        parameters: Vec::new(),
    }
}

fn gate(component: &str, gate: &str, kind: GateKind, rate: f64, peers: &[(&str, bool)]) -> GateRow {
    let mut figures = GateFigures::default();
    (figures.sent, figures.waiting) = ((rate * 100.0) as u64, rate as u64 / 10);
    figures.peers = peers.iter().filter(|(_, connected)| *connected).count() as u64;
    figures.dropped_oldest = u64::from(figures.peers == 0) * 7;
    let connection = |taken| {
        let mut connection = ConnectionFigures::default();
        connection.taken = taken;
        connection
    };
    figures.connections = peers.iter().map(|(_, connected)| connection(u64::from(*connected) * 5)).collect();
    GateRow {
        component: component.to_owned(),
        gate: gate.to_owned(),
        kind,
        payload: "rover.Measurement".to_owned(),
        codec: "protobuf".to_owned(),
        rate: Some(rate),
        figures: Some(figures),
        connections: peers
            .iter()
            .map(|(peer, connected)| ConnectionRow { peer: (*peer).to_owned(), connected: Some(*connected) })
            .collect(),
    }
}

fn snapshot() -> Snapshot {
    let stopped = ComponentRow {
        activity: Activity::Stopped,
        pid: None,
        processor: None,
        memory: None,
        since: None,
        ..component("viewer", Activity::Ready, 1, 0.0)
    };
    let components = vec![
        component("controller", Activity::Ready, 120, 0.021),
        component("logger", Activity::Hangs(Duration::from_secs(5)), 121, 0.0),
        component("sensor", Activity::Waiting, 122, 1.5),
        stopped,
    ];
    let peers = [("controller.sensor", true), ("viewer.measurements", false)];
    let gates = vec![
        gate("controller", "commands", GateKind::Rep, 1.0, &[("user_interface.commands", true)]),
        gate("sensor", "measurements", GateKind::Pub, 1000.0, &peers),
        gate("sensor", "image", GateKind::Pub, 25.04, &[("viewer.image", false)]),
    ];
    Snapshot { system: "rover".to_owned(), components, gates }
}

fn view(colours: bool) -> View {
    View::new(snapshot(), Order::Name, colours)
}

fn drawn(view: &View, width: u16, height: u16) -> Buffer {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(frame, view)).unwrap();
    terminal.backend().buffer().clone()
}

fn text(buffer: &Buffer) -> String {
    let rows = buffer.content().chunks(usize::from(buffer.area.width));
    let line = |row: &[ratatui::buffer::Cell]| row.iter().map(|cell| cell.symbol()).collect::<String>();
    rows.map(|row| format!("{}\n", line(row).trim_end())).collect()
}

#[track_caller]
fn check(view: &View, width: u16, height: u16, expected: &Expect) {
    expected.assert_eq(&text(&drawn(view, width, height)));
}

fn press(view: &mut View, key: KeyCode) -> Action {
    view.press(KeyEvent::new(key, KeyModifiers::NONE))
}

#[test]
fn a_usual_terminal_shows_all_columns() {
    check(
        &view(true),
        80,
        16,
        &expect![[r#"
            rover  3 of 4 components running, 1 hang
            COMPONENT   STATE    PID     CPU       MEM  SINCE
            controller  ready    120    2.1%  3.75 MiB  6 min
            logger      hangs    121    0.0%  3.78 MiB  6 min
            sensor      waiting  122  150.0%  3.81 MiB  6 min
            viewer      stopped    -       -         -      -

            GATE                 KIND  RATE    SENT  RECEIVED  WAIT  DROP  LOST  PEERS
            controller.commands  rep   1.00     100         0     0     0     0    1/1
            sensor.measurements  pub   1000  100000         0   100     0     0    1/2
            sensor.image         pub   25.0    2504         0     2     7     0    0/1




            q quit  ↑↓ choose  Enter details  s sorted by name  space pause
        "#]],
    );
}

#[test]
fn narrow_terminals_leave_columns_out_and_shorten_names() {
    check(
        &view(true),
        50,
        12,
        &expect![[r#"
            rover  3 of 4 components running, 1 hang
            COMPONENT   STATE    PID     CPU       MEM  SINCE
            controller  ready    120    2.1%  3.75 MiB  6 min
            logger      hangs    121    0.0%  3.78 MiB  6 min
            sensor      waiting  122  150.0%  3.81 MiB  6 min
            viewer      stopped    -       -         -      -

            GATE                 KIND  RATE  WAIT  DROP  PEERS
            controller.commands  rep   1.00     0     0    1/1
            sensor.measurements  pub   1000   100     0    1/2
            sensor.image         pub   25.0     2     7    0/1
            q quit  ↑↓ choose  Enter details  s sorted by name
        "#]],
    );
    check(
        &view(true),
        30,
        12,
        &expect![[r#"
            rover  3 of 4 components runni
            COMPONENT   STATE       CPU
            controller  ready      2.1%
            logger      hangs      0.0%
            sensor      waiting  150.0%
            viewer      stopped       -

            GATE         RATE  DROP  PEERS
            controller…  1.00     0    1/1
            sensor.mea…  1000     0    1/2
            sensor.ima…  25.0     7    0/1
            q quit  ↑↓ choose  Enter detai
        "#]],
    );
}

#[test]
fn a_chosen_gate_shows_its_connections() {
    let mut view = view(true);
    assert_eq!(press(&mut view, KeyCode::Down), Action::Draw);
    press(&mut view, KeyCode::Down);
    press(&mut view, KeyCode::Enter);
    check(
        &view,
        80,
        18,
        &expect![[r#"
            rover  3 of 4 components running, 1 hang
            COMPONENT   STATE    PID     CPU       MEM  SINCE
            controller  ready    120    2.1%  3.75 MiB  6 min
            logger      hangs    121    0.0%  3.78 MiB  6 min
            sensor      waiting  122  150.0%  3.81 MiB  6 min
            viewer      stopped    -       -         -      -

            GATE                 KIND  RATE    SENT  RECEIVED  WAIT  DROP  LOST  PEERS
            controller.commands  rep   1.00     100         0     0     0     0    1/1
            sensor.measurements  pub   1000  100000         0   100     0     0    1/2
            sensor.image         pub   25.0    2504         0     2     7     0    0/1



            sensor.measurements  rover.Measurement  protobuf  0 B  rejected 0  undecodable 0
              controller.sensor  connected  taken 5  not yet 0  dropped 0  lost 0
              viewer.measurements  not connected  taken 0  not yet 0  dropped 0  lost 0
            q quit  ↑↓ choose  Enter details  s sorted by name  space pause
        "#]],
    );
}

#[test]
fn a_chosen_gate_shows_what_it_missed() {
    let mut snapshot = snapshot();
    let figures = snapshot.gates[0].figures.as_mut().unwrap();
    (figures.missed, figures.connections[0].missed) = (12, 3);
    let mut view = View::new(snapshot, Order::Name, false);
    press(&mut view, KeyCode::Enter);
    let shown = text(&drawn(&view, 100, 24));
    assert!(shown.contains("undecodable 0  missed 12\n"), "{shown}");
    assert!(shown.contains("lost 0  missed 3\n"), "{shown}");
}

#[test]
fn no_size_is_too_small() {
    let mut view = view(true);
    press(&mut view, KeyCode::Enter);
    for (width, height) in [(1, 1), (1, 50), (200, 1), (3, 4), (9, 9), (40, 5)] {
        drawn(&view, width, height);
    }
    view.update(Snapshot::default());
    drawn(&view, 80, 24);
}

#[test]
fn colours_mark_what_needs_attention_and_can_be_switched_off() {
    let coloured = |buffer: &Buffer| buffer.content().iter().filter(|cell| cell.fg != Color::Reset).count();
    // The states, peers that are missing, and dropped messages.
    let shown = drawn(&view(true), 80, 24);
    assert!(coloured(&shown) > "ready".len() + "hangs".len() + "waiting".len());
    assert_eq!(coloured(&drawn(&view(false), 80, 24)), 0);
    // Only the terminal's own background suits dark and light ones.
    assert!(shown.content().iter().all(|cell| cell.bg == Color::Reset));
}

#[test]
fn keys_choose_sort_pause_and_end() {
    let mut view = view(true);
    let first = |view: &View| (view.snapshot.components[0].name.clone(), view.snapshot.gates[0].gate.clone());
    let orders = [("sensor", "commands"), ("sensor", "commands"), ("controller", "measurements")];
    for (component, gate) in orders {
        press(&mut view, KeyCode::Char('s'));
        assert_eq!(first(&view), (component.to_owned(), gate.to_owned()), "{:?}", view.order);
    }
    press(&mut view, KeyCode::End);
    assert_eq!(view.selected(), Some(2));
    let chosen = view.snapshot.gates[2].name();
    // The choice follows its gate into another order.
    press(&mut view, KeyCode::Char('s'));
    press(&mut view, KeyCode::Char('s'));
    assert_eq!(view.selected().map(|index| view.snapshot.gates[index].name()), Some(chosen));
    press(&mut view, KeyCode::Char(' '));
    view.update(Snapshot::default());
    assert_eq!(view.snapshot.gates.len(), 3, "the display is paused");
    press(&mut view, KeyCode::Char(' '));
    view.update(Snapshot::default());
    assert_eq!((view.snapshot.gates.len(), view.selected()), (0, None));
    assert_eq!(press(&mut view, KeyCode::Down), Action::Draw);
    let control = |c| KeyEvent::new(KeyCode::Char(c), KeyModifiers::CONTROL);
    assert_eq!(view.press(control('c')), Action::Quit);
    assert_eq!(view.press(control('z')), Action::Suspend);
    assert_eq!(press(&mut view, KeyCode::Char('q')), Action::Quit);
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let mut view = view(true);
    view.update(Snapshot { system: "ro\u{1b}[31mver".to_owned(), ..snapshot() });
    assert!(text(&drawn(&view, 80, 24)).starts_with("ro\\u{1b}[31mver  "));
}
