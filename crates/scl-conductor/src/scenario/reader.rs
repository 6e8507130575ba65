//! Reads a scenario, and reports every mistake with its place and what to write.

use super::Scenario;
use super::conditions::{Expectation, Expected, messages_of};
use super::rules::{EXPECTATION, EXPECTED, FAULT, TOP, WHAT, WHEN};
use crate::faults::{FaultRule, What, When, Whom};
use crate::random::Between;
use scl_plan::SystemPlan;
use scl_terminal::{Problem, parse_duration, quoted_list};
use scl_topology::source::{SourceFile, Span};
use scl_topology::yaml::Node;
use scl_value::Condition;
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
        let takes = entries.get("takes").map(|node| self.takes(node)).unwrap_or_default();
        let faults = entries.get("faults").map(|node| self.list(node, "faults", Self::fault)).unwrap_or_default();
        let expected = entries.get("expect").map(|node| self.list(node, "expect", Self::expectation));
        Scenario { until, takes, faults, expectations: expected.unwrap_or_default() }
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

    fn takes(&mut self, node: &Node) -> Vec<(String, Between)> {
        let Some(entries) = node.entries() else {
            let help = "write the component and the time: `{controller: 2ms..5ms}`";
            self.report(Problem::new("`takes` is a mapping").help(help), node.span);
            return Vec::new();
        };
        let read = |(name, between): &(Node, Node)| Some((self.component(name)?, self.between(between)?));
        entries.iter().filter_map(read).collect()
    }

    fn component(&mut self, node: &Node) -> Option<String> {
        let name = node.text().unwrap_or_default();
        let names = || self.system.components.iter().map(|plan| plan.component.as_str());
        if names().any(|known| known == name) {
            return Some(name.to_owned());
        }
        let problem = Problem::new(format!("unknown component `{name}`")).did_you_mean(name, names());
        let problem = problem.note(format!("components: {}", quoted_list(names())));
        self.report(problem, node.span);
        None
    }

    fn components(&mut self, node: &Node) -> Vec<String> {
        match node.items() {
            Some(items) => items.iter().filter_map(|item| self.component(item)).collect(),
            None => self.component(node).into_iter().collect(),
        }
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

    fn fault(&mut self, node: &Node) -> Option<FaultRule> {
        let entries = self.entries(node, "a fault", &FAULT)?;
        let when = self.one(&entries, "a fault", &WHEN).and_then(|(key, value)| {
            let between = self.between(value)?;
            Some(if key == "at" { When::At(between) } else { self.every(between, &entries, value.span)? })
        });
        let what = self.one(&entries, "a fault", &WHAT).and_then(|(key, value)| {
            let what = if key == "kill" { What::Kill } else { What::Pause(self.pause(&entries)?) };
            Some((what, self.whom(&entries, value)?))
        });
        for (key, needs) in [("from", "every"), ("for", "pause")] {
            if entries.get(key).is_some() && entries.get(needs).is_none() {
                let problem = Problem::new(format!("`{key}` has no effect without `{needs}`"));
                self.report(problem.help(format!("leave out `{key}`")), entries.span);
            }
        }
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

    fn pause(&mut self, entries: &Entries<'_>) -> Option<Between> {
        if let Some(node) = entries.get("for") {
            return self.between(node);
        }
        self.report_missing(Problem::new("a pause has no end").help("write how long it is: `for: 2s`"), entries);
        None
    }

    fn whom(&mut self, entries: &Entries<'_>, node: &Node) -> Option<Whom> {
        let spared = entries.get("except");
        let except = spared.map(|node| self.components(node)).unwrap_or_default();
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
        Some(Whom::Each(self.components(node)))
    }

    fn expectation(&mut self, node: &Node) -> Option<Expectation> {
        let entries = self.entries(node, "an expectation", &EXPECTATION)?;
        let (key, value) = self.one(&entries, "an expectation", &EXPECTED)?;
        for (other, needs) in [("by", "eventually"), ("code", "exit")] {
            if entries.get(other).is_some() && key != needs {
                let problem = Problem::new(format!("`{other}` has no effect without `{needs}`"));
                self.report(problem.help(format!("leave out `{other}`")), entries.span);
            }
        }
        let place = self.source.place(node.span);
        if key == "exit" {
            let (component, code) = (self.component(value)?, self.code(&entries)?);
            return Some(Expectation { place, expected: Expected::Exit { component, code } });
        }
        let gate = self.gate(value)?;
        let condition = self.condition(&entries, &gate)?;
        let by = match entries.get("by") {
            Some(node) => Some(self.duration(node)?),
            None => None,
        };
        let expected = match key {
            "always" => Expected::Always { gate, condition },
            _ => Expected::Eventually { gate, condition, by },
        };
        Some(Expectation { place, expected })
    }

    fn code(&mut self, entries: &Entries<'_>) -> Option<u8> {
        let node = entries.get("code");
        let code = node.and_then(Node::text).and_then(|text| text.parse().ok());
        if code.is_none() {
            let problem = Problem::new("an exit code is a number from 0 to 255").help("write `code: 0`");
            self.report(problem, node.map_or(entries.span, |node| node.span));
        }
        code
    }

    /// A gate whose messages are recorded, as `component.gate`.
    fn gate(&mut self, node: &Node) -> Option<String> {
        let name = node.text().unwrap_or_default();
        let recorded = self.system.components.iter().flat_map(|plan| {
            let gates = plan.gates.iter().filter(|gate| gate.tap.is_some() && messages_of(gate).is_some());
            gates.map(|gate| format!("{}.{}", plan.component, gate.name))
        });
        let recorded: Vec<String> = recorded.collect();
        if recorded.iter().any(|known| known == name) {
            return Some(name.to_owned());
        }
        let names = || recorded.iter().map(String::as_str);
        let problem = Problem::new(format!("`{name}` is no gate whose messages are seen")).did_you_mean(name, names());
        let problem = problem.note(format!("`pub` and `pull` gates: {}", quoted_list(names())));
        self.report(problem, node.span);
        None
    }

    fn condition(&mut self, entries: &Entries<'_>, gate: &str) -> Option<Condition> {
        let Some(node) = entries.get("where") else {
            let problem = Problem::new("a condition is missing").help("write it as `where: 'speed > 1.5'`");
            self.report_missing(problem, entries);
            return None;
        };
        let checked = node.text().unwrap_or_default().parse::<Condition>().map_err(Problem::from);
        let checked = checked.and_then(|condition| {
            super::conditions::check(&condition, self.system, gate)?;
            Ok(condition)
        });
        checked.inspect_err(|problem| self.report(problem.clone(), node.span)).ok()
    }
}
