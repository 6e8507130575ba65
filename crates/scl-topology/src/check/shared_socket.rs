//! SCL0802: two connections with one socket. Other names cannot collide: only connections have `--` in their names, and
//! a gate's own sockets end with the contract of eight characters or with `.tap`. Only long names of connections that
//! are cut could be equal, if their fingerprints were equal by chance. So this rule asserts what
//! [`resolve`](crate::resolve) promises, and no file is known that it rejects.

use super::draft::Draft;
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::resolve::shortened;
use crate::topology::GateKind;
use std::collections::HashMap;

/// SCL0802.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0802",
    severity: Severity::Error,
    title: "two gates share one socket path",
    explanation: "Two connections would use the same socket. Socket names are unique, except that long names of \
                  connections are cut and end with a fingerprint; two fingerprints could be equal by chance. This \
                  check guards against that, and no file is known that it rejects. Shorten the names.",
    example: "",
};

pub(super) fn check(draft: &Draft<'_>, room: usize, problems: &mut Diagnostics) {
    let mut cut = Vec::new();
    for (link, source, sink) in draft.flows().filter(|&(_, source, _)| draft.gates[source].kind == Some(GateKind::Pub))
    {
        let length =
            [source, sink].map(|gate| draft.component_name(gate).len() + draft.gates[gate].model.name.value.len() + 2);
        if length[0] + length[1] > room {
            cut.push((shortened(&format!("{}--{}", draft.path(source), draft.path(sink)), room), link));
        }
    }
    for (name, first, second) in twins(cut) {
        let spans = [first, second].map(|link| draft.links[link].model.span);
        problems.push(
            RULE.at(format!("two connections would use the same socket `{name}`"), spans[1], "")
                .label(spans[0], "the other connection")
                .help("shorten the names of their gates"),
        );
    }
}

/// Returns each name that occurs again, with the numbers of its first and its later occurrence.
fn twins(names: Vec<(String, usize)>) -> Vec<(String, usize, usize)> {
    let mut first: HashMap<String, usize> = HashMap::new();
    let pairs = names.into_iter().map(|(name, number)| (*first.entry(name.clone()).or_insert(number), name, number));
    pairs.filter(|(first, _, number)| first != number).map(|(first, name, number)| (name, first, number)).collect()
}

#[cfg(test)]
mod tests {
    use super::twins;

    #[test]
    fn equal_names_are_found() {
        let name = str::to_owned;
        assert_eq!(twins(vec![(name("a"), 1), (name("b"), 2), (name("a"), 3)]), [(name("a"), 1, 3)]);
    }
}
