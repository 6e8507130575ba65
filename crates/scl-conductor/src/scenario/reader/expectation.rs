//! Reads what must hold.

use super::super::conditions::{Expectation, Expected, check, messages_of};
use super::super::rules::{EXPECTATION, EXPECTED};
use super::{Entries, Reader};
use crate::routes::full_name;
use scl_terminal::{Problem, quoted_list};
use scl_topology::yaml::Node;
use scl_value::Condition;

impl Reader<'_> {
    pub(super) fn expectation(&mut self, node: &Node) -> Option<Expectation> {
        let entries = self.entries(node, "an expectation", &EXPECTATION)?;
        let (key, value) = self.one(&entries, "an expectation", &EXPECTED)?;
        self.report_useless(&entries, "by", &["eventually"]);
        self.report_useless(&entries, "code", &["exit"]);
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
            gates.map(|gate| full_name(&plan.component, &gate.name))
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
            check(&condition, self.system, gate)?;
            Ok(condition)
        });
        checked.inspect_err(|problem| self.report(problem.clone(), node.span)).ok()
    }
}
