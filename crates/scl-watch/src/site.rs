//! What all pages of one server share: the system, and a board for each way to draw it.

use crate::board::Board;
use crate::happenings::Happenings;
use crate::live::{Troubles, enliven, figures_of};
use crate::picture::{Picture, VARIANTS};
use crate::plans::plans_of;
use crate::problems::problems_of;
use scl_diagram::{Layout, Options, diagram_of, draw};
use scl_observe::{ComponentRow, GateRow, Snapshot, System, Watch};
use scl_plan::SystemPlan;
use serde_json::{Value, json};
use std::time::{Duration, Instant};
use tokio::sync::Notify;
use tokio::time::{MissedTickBehavior, interval};

/// The time between two looks at the system.
const PERIOD: Duration = Duration::from_millis(250);

/// The time over which rates are measured: components write their figures four times in it.
pub(crate) const WINDOW: Duration = Duration::from_secs(2);

/// What all pages of a server share.
pub(crate) struct Site {
    pub(crate) system: System,
    file: Option<SystemPlan>,
    boards: [Board; VARIANTS.len()],
    opened: Notify,
}

impl Site {
    /// A site for this system, with what its topology file says about components that do not run.
    pub(crate) fn new(system: System, file: Option<SystemPlan>) -> Self {
        Self { system, file, boards: std::array::from_fn(|_| Board::new()), opened: Notify::new() }
    }

    /// The board of a way to draw the system. It shows something as long as somebody watches it.
    pub(crate) fn board(&self, variant: usize) -> &Board {
        let board = &self.boards[variant];
        self.opened.notify_one();
        board
    }

    /// Looks at the system four times a second, as long as somebody watches.
    pub(crate) async fn look(&self) -> ! {
        let mut look = Look::new(self);
        let mut due = interval(PERIOD);
        due.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            if self.boards.iter().all(|board| board.watchers() == 0) {
                self.opened.notified().await;
                continue;
            }
            due.tick().await;
            look.show();
        }
    }
}

/// The looks at a system, one after the other.
pub(crate) struct Look<'s> {
    site: &'s Site,
    watch: Watch,
    troubles: Troubles,
    happenings: Happenings,
    plans: SystemPlan,
    pictures: [Picture; VARIANTS.len()],
}

impl<'s> Look<'s> {
    pub(crate) fn new(site: &'s Site) -> Self {
        let plans = SystemPlan { system: String::new(), components: Vec::new(), kinds: Vec::new() };
        Self {
            site,
            watch: Watch::with_window(site.system.clone(), WINDOW),
            troubles: Troubles::default(),
            happenings: Happenings::default(),
            plans,
            pictures: std::array::from_fn(Picture::new),
        }
    }

    /// Looks once, and shows it on all boards that somebody watches.
    fn show(&mut self) {
        let (snapshot, now) = self.look();
        let problems = problems_of(&self.plans, &snapshot, &self.troubles, now);
        let events = self.happenings.to_json();
        for variant in 0..VARIANTS.len() {
            if self.site.boards[variant].watchers() > 0 {
                let plans = &self.plans;
                let mut values = self.pictures[variant].values(plans, |diagram| {
                    enliven(diagram, plans, &snapshot, &self.troubles, now);
                });
                values.insert("problems".to_owned(), json!(problems));
                values.insert("events".to_owned(), events.clone());
                values.extend(
                    snapshot
                        .components
                        .iter()
                        .map(|row| (format!("component {}", row.name), self.details(row, &snapshot, now))),
                );
                self.site.boards[variant].show(values);
            }
        }
    }

    /// Takes a snapshot, and reads the plans again if another component has announced one.
    pub(crate) fn look(&mut self) -> (Snapshot, Instant) {
        let now = Instant::now();
        let components = self.site.system.components();
        let snapshot = self.watch.look_at(&components);
        self.troubles.learn(&snapshot, now);
        self.happenings.learn(&snapshot, &self.troubles);
        let plans = plans_of(&self.site.system, &components, self.site.file.as_ref());
        if plans != self.plans {
            self.plans = plans;
            self.pictures.iter_mut().for_each(Picture::forget);
        }
        (snapshot, now)
    }

    /// The picture, as it is now.
    pub(crate) fn picture(&mut self, options: Options) -> String {
        let (snapshot, now) = self.look();
        let mut diagram = diagram_of(&self.plans, options);
        enliven(&mut diagram, &self.plans, &snapshot, &self.troubles, now);
        draw(&diagram, &Layout::of(&diagram))
    }

    /// What the page shows of a component that is clicked at.
    fn details(&self, row: &ComponentRow, snapshot: &Snapshot, now: Instant) -> Value {
        let gates = gates_of(&row.name, &self.plans, snapshot, &self.troubles, now);
        json!({
            "activity": row.activity.word(), "pid": row.pid, "processor": row.processor, "memory": row.memory,
            "since": row.since.map(|since| since.as_secs()), "parameters": row.parameters, "gates": gates,
        })
    }
}

/// What the page shows of the gates of a component that is clicked at.
pub(crate) fn gates_of(
    component: &str,
    plans: &SystemPlan,
    snapshot: &Snapshot,
    troubles: &Troubles,
    now: Instant,
) -> Vec<Value> {
    let gate = |row: &GateRow| {
        let name = row.name();
        let figures = figures_of(plans, component, Some(row), troubles.of(&name), now);
        json!({
            "name": name, "kind": row.kind.word(), "rate": figures.rate, "trouble": figures.trouble,
            "bad": figures.is_bad,
        })
    };
    snapshot.gates.iter().filter(|row| row.component == component).map(gate).collect()
}
