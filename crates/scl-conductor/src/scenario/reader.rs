//! Reads a scenario, and reports every mistake with its place and what to write.

mod delays;
mod expectation;
mod fault;

use super::Scenario;
use super::rules::TOP;
use crate::random::Between;
use crate::routes::{full_name, routes};
use scl_plan::{GatePlan, Plan, SystemPlan};
use scl_terminal::{Problem, parse_duration, quoted_list};
use scl_text::gate_name::split;
use scl_text::list::either;
use scl_topology::source::{SourceFile, Span};
use scl_topology::yaml::Node;
use std::time::Duration;

/// Walks the values and collects the problems.
pub(super) struct Reader<'a> {
    source: &'a SourceFile,
    system: &'a SystemPlan,
    pub(super) problems: Vec<Problem>,
}

/// The entries of a mapping by their keys.
struct Entries<'n> {
    span: Span,
    list: Vec<(&'n str, &'n Node)>,
    /// Whether there is an unknown key, which may be one that seems to be missing, misspelt.
    damaged: bool,
}

impl<'n> Entries<'n> {
    fn get(&self, key: &str) -> Option<&'n Node> {
        self.list.iter().find(|(name, _)| *name == key).map(|(_, value)| *value)
    }
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a SourceFile, system: &'a SystemPlan) -> Self {
        Self { source, system, problems: Vec::new() }
    }

    pub(super) fn scenario(&mut self, root: &Node) -> Scenario {
        let Some(entries) = self.entries(root, "a scenario", &TOP) else { return Scenario::default() };
        let until = entries.get("until").and_then(|node| self.duration(node));
        let delays = entries.get("delays").map(|node| self.delays(node)).unwrap_or_default();
        let takes = entries.get("takes").map(|node| self.takes(node)).unwrap_or_default();
        let faults = entries.get("faults").map(|node| self.list(node, "faults", Self::fault)).unwrap_or_default();
        let expected = entries.get("expect").map(|node| self.list(node, "expect", Self::expectation));
        let routes = routes(self.system, &delays, &faults);
        Scenario { until, takes, faults, routes, expectations: expected.unwrap_or_default() }
    }

    fn report(&mut self, problem: Problem, span: Span) {
        self.problems.push(problem.at(self.source.place(span)));
    }

    /// The entries of a mapping; other keys than these are reported.
    fn entries<'n>(&mut self, node: &'n Node, owner: &str, allowed: &[&str]) -> Option<Entries<'n>> {
        let Some(entries) = node.entries() else {
            let help = format!("write the keys {}", quoted_list(allowed));
            self.report(Problem::new(format!("{owner} is a mapping")).help(help), node.span);
            return None;
        };
        let (mut list, mut damaged): (Vec<(&str, &Node)>, bool) = (Vec::new(), false);
        for (key, value) in entries {
            let name = key.text().unwrap_or_default();
            if !allowed.contains(&name) {
                damaged = true;
                let problem = Problem::new(format!("unknown key `{name}` in {owner}"));
                let problem = problem.did_you_mean(name, allowed.iter().copied());
                self.report(problem.note(format!("keys: {}", quoted_list(allowed))), key.span);
            } else if list.iter().any(|(known, _)| *known == name) {
                self.report(Problem::new(format!("`{name}` occurs twice in {owner}")).help("keep one"), key.span);
            } else {
                list.push((name, value));
            }
        }
        Some(Entries { span: node.span, list, damaged })
    }

    /// Reports that a key is missing, unless there is an unknown key, which may be that one misspelt.
    fn report_missing(&mut self, problem: Problem, entries: &Entries<'_>) {
        if !entries.damaged {
            self.report(problem, entries.span);
        }
    }

    /// Reports a key that has an effect only beside one of others.
    fn report_useless(&mut self, entries: &Entries<'_>, key: &str, needs: &[&str]) {
        if entries.get(key).is_some() && needs.iter().all(|needed| entries.get(needed).is_none()) {
            let problem = Problem::new(format!("`{key}` has no effect without {}", either(needs)));
            self.report(problem.help(format!("leave out `{key}`")), entries.span);
        }
    }

    fn list<T>(&mut self, node: &Node, key: &str, read: impl Fn(&mut Self, &Node) -> Option<T>) -> Vec<T> {
        if let Some(items) = node.items() {
            return items.iter().filter_map(|item| read(self, item)).collect();
        }
        if !node.is_null() {
            self.report(Problem::new(format!("`{key}` is a list")).help("begin each item with `- `"), node.span);
        }
        Vec::new()
    }

    fn duration(&mut self, node: &Node) -> Option<Duration> {
        match node.text().map_or_else(|| Err("it is no time".to_owned()), parse_duration) {
            Ok(duration) => Some(duration),
            Err(reason) => {
                self.report(Problem::new(reason).help("write a number and a unit: `80ms`, `1.5s`"), node.span);
                None
            }
        }
    }

    /// A time, or the shortest and the longest one: `80ms..120ms`.
    fn between(&mut self, node: &Node) -> Option<Between> {
        let text = node.text().unwrap_or_default();
        let (least, most) = text.split_once("..").unwrap_or((text, text));
        match (parse_duration(least.trim()), parse_duration(most.trim())) {
            (Ok(least), Ok(most)) if least <= most => Some(Between { least, most }),
            (Ok(_), Ok(_)) => {
                let text = format!("`{text}` ends before it begins");
                self.report(Problem::new(text).help(format!("write `{}..{}`", most.trim(), least.trim())), node.span);
                None
            }
            (Err(reason), _) | (_, Err(reason)) => {
                let help = "write a time, or the shortest and the longest one: `80ms..120ms`";
                self.report(Problem::new(reason).help(help), node.span);
                None
            }
        }
    }

    fn component(&mut self, node: &Node) -> Option<String> {
        let name = node.text().unwrap_or_default();
        self.plan_of(name, node.span).map(|plan| plan.component.clone())
    }

    fn plan_of(&mut self, component: &str, span: Span) -> Option<&'a Plan> {
        let found = self.system.component(component).ok();
        if found.is_none() {
            let names = || self.system.components.iter().map(|plan| plan.component.as_str());
            let problem = Problem::new(format!("unknown component `{component}`")).did_you_mean(component, names());
            self.report(problem.note(format!("components: {}", quoted_list(names()))), span);
        }
        found
    }

    /// The gate of this name, as `component.gate`.
    fn gate_of(&mut self, name: &str, span: Span) -> Option<&'a GatePlan> {
        let Some((component, gate)) = split(name) else {
            let problem = Problem::new(format!("`{name}` is no gate"));
            self.report(problem.help("write a gate as `component.gate`, or all of a component as `component.*`"), span);
            return None;
        };
        let plan = self.plan_of(component, span)?;
        let found = plan.gate(gate);
        if found.is_none() {
            let names: Vec<String> = plan.gates.iter().map(|gate| full_name(component, &gate.name)).collect();
            let problem = Problem::new(format!("unknown gate `{name}`"));
            let problem = problem.did_you_mean(name, names.iter().map(String::as_str));
            self.report(problem.note(format!("gates: {}", quoted_list(names))), span);
        }
        found
    }

    /// The one entry whose key is among `keys`.
    fn one<'n>(&mut self, entries: &Entries<'n>, owner: &str, keys: &[&str]) -> Option<(&'n str, &'n Node)> {
        let found: Vec<_> = entries.list.iter().filter(|(name, _)| keys.contains(name)).collect();
        if let [one] = found.as_slice() {
            return Some(**one);
        }
        let text = if found.is_empty() { "has none" } else { "has several" };
        let problem = Problem::new(format!("{owner} has one of {}, and this one {text}", quoted_list(keys)));
        self.report_missing(problem.help("see docs/simulate.md"), entries);
        None
    }
}
