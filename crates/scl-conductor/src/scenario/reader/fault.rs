//! Reads what goes wrong.

use super::super::rules::{FAULT, WHAT, WHEN};
use super::{Entries, Reader};
use crate::faults::{FaultRule, What, When, Whom};
use crate::random::Between;
use scl_terminal::Problem;
use scl_text::gate_name::component_and_gate;
use scl_topology::source::Span;
use scl_topology::yaml::Node;
use std::time::Duration;

impl Reader<'_> {
    pub(super) fn fault(&mut self, node: &Node) -> Option<FaultRule> {
        let entries = self.entries(node, "a fault", &FAULT)?;
        let when = self.one(&entries, "a fault", &WHEN).and_then(|(key, value)| {
            let between = self.between(value)?;
            Some(if key == "at" { When::At(between) } else { self.every(between, &entries, value.span)? })
        });
        let what = self.one(&entries, "a fault", &WHAT).and_then(|(key, value)| {
            let what = match key {
                "kill" => What::Kill,
                "pause" => What::Pause(self.length(key, &entries)?),
                _ => What::Cut(self.length(key, &entries)?),
            };
            Some((what, self.whom(&entries, key, value)?))
        });
        self.report_useless(&entries, "from", &["every"]);
        self.report_useless(&entries, "for", &["pause", "cut"]);
        let (when, (what, whom)) = when.zip(what)?;
        Some(FaultRule { when, what, whom })
    }

    fn every(&mut self, between: Between, entries: &Entries<'_>, span: Span) -> Option<When> {
        if between.most.is_zero() {
            let problem = Problem::new("a fault cannot happen all the time");
            self.report(problem.help("write the time from one to the next: `every: 5s..20s`"), span);
            return None;
        }
        let from = entries.get("from").map_or(Some(Duration::ZERO), |node| self.duration(node))?;
        // Faults without any time between them would never end.
        let between = Between { least: between.least.max(Duration::from_micros(1)).min(between.most), ..between };
        Some(When::Every { between, from })
    }

    fn length(&mut self, what: &str, entries: &Entries<'_>) -> Option<Between> {
        if let Some(node) = entries.get("for") {
            return self.between(node);
        }
        let problem = Problem::new(format!("a {what} has no end")).help("write how long it is: `for: 2s`");
        self.report_missing(problem, entries);
        None
    }

    fn whom(&mut self, entries: &Entries<'_>, what: &str, node: &Node) -> Option<Whom> {
        let spared = entries.get("except");
        let except = spared.map(|node| self.one_or_several(node, Self::component)).unwrap_or_default();
        if node.text() == Some("any") {
            let names = self.system.components.iter().map(|plan| plan.component.clone());
            let left: Vec<String> = names.filter(|name| !except.contains(name)).collect();
            if left.is_empty() {
                self.report(Problem::new("`except` leaves no component").help("name fewer"), entries.span);
            }
            return Some(Whom::Any(left)).filter(|_| !entries.list.is_empty());
        }
        if let Some(spared) = spared {
            let help = "name the components that it happens to, or write `any`";
            self.report(Problem::new("`except` has an effect only with `any`").help(help), spared.span);
        }
        Some(Whom::Each(self.one_or_several(node, if what == "cut" { Self::end } else { Self::component })))
    }

    /// A component, or a gate as `component.gate`.
    fn end(&mut self, node: &Node) -> Option<String> {
        let name = node.text().unwrap_or_default();
        match component_and_gate(name, |name| self.system.component(name).is_ok()) {
            (_, Some(_)) => self.gate_of(name, node.span).map(|_| name.to_owned()),
            (_, None) => self.component(node),
        }
    }

    fn one_or_several(&mut self, node: &Node, read: fn(&mut Self, &Node) -> Option<String>) -> Vec<String> {
        match node.items() {
            Some(items) => items.iter().filter_map(|item| read(self, item)).collect(),
            None => read(self, node).into_iter().collect(),
        }
    }
}
