//! What all pages of one server share: the system, and a board for each way to draw it.

use crate::board::Board;
use crate::happenings::Happenings;
use crate::live::{Troubles, enliven};
use crate::plans::plans_of;
use crate::problems::problems_of;
use scl_diagram::{Detail, Diagram, Flow, Layout, Options, diagram_of, draw};
use scl_observe::{Snapshot, System, Watch};
use scl_plan::SystemPlan;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};
use tokio::sync::Notify;
use tokio::time::{MissedTickBehavior, interval};

/// The time between two looks at the system.
const PERIOD: Duration = Duration::from_millis(250);

/// The time over which rates are measured: components write their figures four times in it.
const WINDOW: Duration = Duration::from_secs(2);

/// The ways to draw a system.
pub(crate) const VARIANTS: [Options; 4] = [
    Options { detail: None, everyone: false, live: true },
    Options { detail: Some(Detail::Gates), everyone: false, live: true },
    Options { detail: Some(Detail::Components), everyone: false, live: true },
    Options { detail: Some(Detail::Gates), everyone: true, live: true },
];

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
    drawn: [Option<Drawn>; VARIANTS.len()],
}

/// A diagram of the present plans.
struct Drawn {
    diagram: Diagram,
    picture: String,
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
            drawn: std::array::from_fn(|_| None),
        }
    }

    /// Looks once, and shows it on all boards that somebody watches.
    fn show(&mut self) {
        let (snapshot, now) = self.look();
        let problems = problems_of(&self.plans, &snapshot, &self.troubles, now);
        let events = self.happenings.to_json();
        for variant in 0..VARIANTS.len() {
            if self.site.boards[variant].watchers() > 0 {
                let mut values = self.draw(variant, &snapshot, now);
                values.insert("problems".to_owned(), json!(problems));
                values.insert("events".to_owned(), events.clone());
                values.extend(snapshot.components.iter().map(|row| (format!("component {}", row.name), details(row))));
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
            self.drawn = std::array::from_fn(|_| None);
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

    /// The values of a board: the picture without figures, and the figures.
    fn draw(&mut self, variant: usize, snapshot: &Snapshot, now: Instant) -> BTreeMap<String, Value> {
        let plans = &self.plans;
        let drawn = self.drawn[variant].get_or_insert_with(|| {
            let diagram = diagram_of(plans, VARIANTS[variant]);
            let picture = draw(&diagram, &Layout::of(&diagram));
            Drawn { diagram, picture }
        });
        enliven(&mut drawn.diagram, plans, snapshot, &self.troubles, now);
        let mut values = BTreeMap::from([("picture".to_owned(), json!(drawn.picture))]);
        for (index, block) in drawn.diagram.blocks.iter().enumerate() {
            values.insert(format!("block {index}"), json!({"state": block.state.map(|state| state.word())}));
            for (row, figures) in
                block.rows.iter().enumerate().filter_map(|(row, it)| Some((row, it.figures.as_ref()?)))
            {
                let value = json!({
                    "rate": figures.rate, "perSecond": figures.per_second, "filled": figures.filled,
                    "trouble": figures.trouble, "bad": figures.is_bad,
                });
                values.insert(format!("row {index} {row}"), value);
            }
        }
        for (index, edge) in drawn.diagram.edges.iter().enumerate() {
            let flow = edge.flow.unwrap_or(Flow::Idle);
            values.insert(format!("edge {index}"), json!({"flow": flow.word(), "width": flow.width()}));
        }
        values
    }
}

/// What the page shows of a component that is clicked at.
fn details(row: &scl_observe::ComponentRow) -> Value {
    json!({
        "activity": row.activity.word(), "pid": row.pid, "processor": row.processor, "memory": row.memory,
        "since": row.since.map(|since| since.as_secs()), "parameters": row.parameters,
    })
}
