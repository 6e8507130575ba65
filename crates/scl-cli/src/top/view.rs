//! What the live display shows: the latest snapshot, the chosen gate, and what keys do.

use super::Order;
use super::rows::sort;
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use scl_observe::{GateRow, Snapshot};

/// What the display shows.
#[derive(Debug)]
pub(super) struct View {
    /// The latest snapshot, in the order of the topology file.
    latest: Snapshot,
    /// The same, as sorted by `order`.
    pub(super) snapshot: Snapshot,
    pub(super) order: Order,
    /// The chosen gate by its name, because its row moves.
    selected: Option<String>,
    /// Whether the connections of the chosen gate are shown.
    pub(super) details: bool,
    pub(super) paused: bool,
    pub(super) colours: bool,
}

/// What a key means for the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    Draw,
    Quit,
    Suspend,
    Nothing,
}

const ORDERS: [Order; 6] = [Order::Name, Order::Cpu, Order::Memory, Order::Rate, Order::Waiting, Order::Dropped];

impl View {
    pub(super) fn new(snapshot: Snapshot, order: Order, colours: bool) -> Self {
        let latest = snapshot.clone();
        let mut view = Self { latest, snapshot, order, selected: None, details: false, paused: false, colours };
        view.sort_by(order);
        view
    }

    /// Shows a new snapshot, unless the display is paused.
    pub(super) fn update(&mut self, snapshot: Snapshot) {
        if !self.paused {
            self.latest = snapshot;
            self.sort_by(self.order);
        }
    }

    /// The index of the chosen gate, if it is still there.
    pub(super) fn selected(&self) -> Option<usize> {
        let name = self.selected.as_ref()?;
        self.snapshot.gates.iter().position(|gate| gate.name() == *name)
    }

    /// The gate whose connections are shown.
    pub(super) fn detailed(&self) -> Option<&GateRow> {
        self.selected().filter(|_| self.details).map(|index| &self.snapshot.gates[index])
    }

    /// Handles a key.
    pub(super) fn press(&mut self, key: KeyEvent) -> Action {
        if key.kind == KeyEventKind::Release {
            return Action::Nothing;
        }
        if key.modifiers.contains(KeyModifiers::CONTROL) {
            return match key.code {
                KeyCode::Char('c') => Action::Quit,
                KeyCode::Char('z') => Action::Suspend,
                KeyCode::Char('l') => Action::Draw,
                _ => Action::Nothing,
            };
        }
        match key.code {
            KeyCode::Char('q') => return Action::Quit,
            KeyCode::Esc if self.details => self.details = false,
            KeyCode::Esc if self.selected.is_some() => self.selected = None,
            KeyCode::Esc => return Action::Quit,
            KeyCode::Down | KeyCode::Char('j') => self.move_by(1),
            KeyCode::Up | KeyCode::Char('k') => self.move_by(-1),
            KeyCode::PageDown => self.move_by(10),
            KeyCode::PageUp => self.move_by(-10),
            KeyCode::Home => self.move_by(isize::MIN),
            KeyCode::End => self.move_by(isize::MAX),
            KeyCode::Enter if self.selected().is_some() => self.details = !self.details,
            KeyCode::Enter => {
                self.move_by(1);
                self.details = true;
            }
            KeyCode::Char('s') => {
                let index = ORDERS.iter().position(|order| *order == self.order).unwrap_or(0);
                self.sort_by(ORDERS[(index + 1) % ORDERS.len()]);
            }
            KeyCode::Char(' ') => self.paused = !self.paused,
            _ => return Action::Nothing,
        }
        Action::Draw
    }

    fn sort_by(&mut self, order: Order) {
        self.order = order;
        self.snapshot = self.latest.clone();
        sort(&mut self.snapshot, order);
    }

    fn move_by(&mut self, rows: isize) {
        let Some(last) = self.snapshot.gates.len().checked_sub(1) else { return };
        let index = match self.selected() {
            Some(index) => index.saturating_add_signed(rows).min(last),
            None if rows > 1 => last,
            None => 0,
        };
        self.selected = Some(self.snapshot.gates[index].name());
    }
}
