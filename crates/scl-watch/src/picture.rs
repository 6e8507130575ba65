//! The picture of a system, as the values that pages show: the drawing once, and then what changes in it.

use scl_diagram::{Detail, Diagram, Flow, Layout, Options, diagram_of, draw};
use scl_plan::SystemPlan;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The ways to draw a system.
pub(crate) const VARIANTS: [Options; 4] = [
    Options { detail: None, everyone: false, stacks: true, live: true },
    Options { detail: Some(Detail::Gates), everyone: false, stacks: false, live: true },
    Options { detail: Some(Detail::Components), everyone: false, stacks: false, live: true },
    Options { detail: Some(Detail::Gates), everyone: true, stacks: false, live: true },
];

/// One way to draw a system. The layout is kept.
pub(crate) struct Picture {
    options: Options,
    drawn: Option<Drawn>,
}

struct Drawn {
    diagram: Diagram,
    /// The drawing without figures.
    drawing: String,
}

impl Picture {
    pub(crate) fn new(variant: usize) -> Self {
        Self { options: VARIANTS[variant], drawn: None }
    }

    /// Forgets the layout, because the plans have changed.
    pub(crate) fn forget(&mut self) {
        self.drawn = None;
    }

    /// The values of the picture, after `enliven` has written figures into the diagram.
    pub(crate) fn values(&mut self, plans: &SystemPlan, enliven: impl FnOnce(&mut Diagram)) -> BTreeMap<String, Value> {
        let drawn = self.drawn.get_or_insert_with(|| {
            let diagram = diagram_of(plans, self.options);
            let drawing = draw(&diagram, &Layout::of(&diagram));
            Drawn { diagram, drawing }
        });
        enliven(&mut drawn.diagram);
        let mut values = BTreeMap::from([("picture".to_owned(), json!(drawn.drawing))]);
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
