//! Reads what takes time: components, and messages on their way.

use super::Reader;
use crate::random::Between;
use crate::routes::{full_name, sends};
use scl_terminal::{Problem, quoted_list};
use scl_topology::yaml::Node;

impl Reader<'_> {
    pub(super) fn takes(&mut self, node: &Node) -> Vec<(String, Between)> {
        let example = "write the component and the time: `{controller: 2ms..5ms}`";
        self.times(node, "takes", example, |reader, name| Some(vec![reader.component(name)?]))
    }

    pub(super) fn delays(&mut self, node: &Node) -> Vec<(String, Between)> {
        let example = "write the gate and the time: `{sensor.values: 80ms..120ms}`";
        self.times(node, "delays", example, Self::sending_gates)
    }

    /// Times by names, of which each stands for one or several. A later one wins.
    fn times(
        &mut self,
        node: &Node,
        key: &str,
        example: &str,
        read: impl Fn(&mut Self, &Node) -> Option<Vec<String>>,
    ) -> Vec<(String, Between)> {
        let Some(entries) = node.entries() else {
            self.report(Problem::new(format!("`{key}` is a mapping")).help(example), node.span);
            return Vec::new();
        };
        let mut times: Vec<(String, Between)> = Vec::new();
        for (index, (name, between)) in entries.iter().enumerate() {
            if entries[..index].iter().any(|(earlier, _)| earlier.text() == name.text()) {
                let problem = Problem::new(format!("`{}` occurs twice in `{key}`", name.text().unwrap_or_default()));
                self.report(problem.help("keep one"), name.span);
                continue;
            }
            let (names, between) = (read(self, name), self.between(between));
            let Some((names, between)) = names.zip(between) else { continue };
            times.retain(|(earlier, _)| !names.contains(earlier));
            times.extend(names.into_iter().map(|name| (name, between)));
        }
        times
    }

    /// A gate that sends, or all of a component: `sensor.*`.
    fn sending_gates(&mut self, node: &Node) -> Option<Vec<String>> {
        let name = node.text().unwrap_or_default();
        if let Some(component) = name.strip_suffix(".*") {
            let plan = self.plan_of(component, node.span)?;
            let sending = plan.gates.iter().filter(|gate| sends(gate.kind));
            let names: Vec<String> = sending.map(|gate| full_name(component, &gate.name)).collect();
            if names.is_empty() {
                let problem =
                    Problem::new(format!("`{component}` sends nothing")).help("name the gates that send to it");
                self.report(problem, node.span);
            }
            return Some(names);
        }
        let gate = self.gate_of(name, node.span)?;
        if !sends(gate.kind) {
            let senders = gate.connections.iter().map(|it| full_name(&it.peer_component, &it.peer_gate));
            let problem = Problem::new(format!("`{name}` sends nothing"));
            let help = format!("name the gates that send to it: {}", quoted_list(senders));
            self.report(problem.help(help), node.span);
            return None;
        }
        Some(vec![name.to_owned()])
    }
}
