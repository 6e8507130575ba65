//! SCL0710, a lint: a gate with very many peers. Each of them costs time and memory for each message.

use super::control;
use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::topology::GateKind;

/// SCL0710.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0710",
    severity: Severity::Lint,
    title: "very many connections at one gate",
    explanation: "A gate has very many peers, and each costs time and memory for each message. The threshold is 32; `# \
                  scl: warn(SCL0710, 64)` turns the check on for the file and sets another.",
    example: "-# scl: warn(SCL0710, 1)
+# scl: warn(SCL0710, 64)
 components:
   - name: sensor
     gates:
       - measurements: pub
   - name: display
     gates:
       - values: sub
       - history: sub
 connections:
   - [sensor.measurements, display.values]
   - [sensor.measurements, display.history]
",
};

/// More peers than this are many, unless the file says another number.
const MANY: u32 = 32;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let threshold = control::threshold(draft.model, &RULE).unwrap_or(MANY);
    let mut peers = vec![0_u32; draft.gates.len()];
    for (_, source, sink) in draft.flows() {
        peers[source] += 1;
        peers[sink] += 1;
    }
    for (gate, &count) in peers.iter().enumerate().filter(|&(_, &count)| count > threshold) {
        problems.extend(draft.gates[gate].kind.map(|kind| report(draft, gate, kind, count, threshold)));
    }
}

fn report(draft: &Draft<'_>, gate: usize, kind: GateKind, count: u32, threshold: u32) -> Diagnostic {
    let (peers, label) = match kind {
        GateKind::Pub => ("subscribers", format!("each message is written {count} times")),
        GateKind::Push => ("pullers", format!("the work is shared by {count}")),
        GateKind::Sub => ("publishers", format!("the messages of {count} gates arrive here")),
        GateKind::Pull => ("pushers", format!("the work of {count} gates arrives here")),
        GateKind::Rep => ("requesters", format!("{count} gates wait for its answers")),
        GateKind::Req => ("repliers", String::new()),
    };
    let headline = format!("gate `{}` has {count} {peers}", draft.path(gate));
    let double = threshold.saturating_mul(2);
    RULE.at(headline, draft.gates[gate].model.name.span, label)
        .note(format!("threshold: {threshold}; set it with `# scl: warn(SCL0710, {double})`"))
}

#[cfg(test)]
mod tests {
    use crate::check::testing::problems;

    fn found(subscribers: usize, first_line: &str) -> Vec<String> {
        let mut yaml = format!("{first_line}\ncomponents:\n  - name: hub\n    gates:\n      - x: pub\n");
        (0..subscribers).for_each(|at| yaml.push_str(&format!("  - name: c{at}\n    gates:\n      - x: sub\n")));
        yaml.push_str("connections:\n");
        (0..subscribers).for_each(|at| yaml.push_str(&format!("  - [hub.x, c{at}.x]\n")));
        let (found, _) = problems(&yaml, None);
        found
            .iter()
            .filter(|found| found.code() == "SCL0710")
            .map(|found| format!("{:?} {}", found.severity, found.message))
            .collect()
    }

    #[test]
    fn the_threshold_is_the_files() {
        assert_eq!(found(32, "#"), [""; 0]);
        assert_eq!(found(33, "#"), ["Lint gate `hub.x` has 33 subscribers"]);
        assert_eq!(found(33, "# scl: warn(SCL0710)"), ["Warning gate `hub.x` has 33 subscribers"]);
        assert_eq!(found(33, "# scl: warn(SCL0710, 33)"), [""; 0]);
        assert_eq!(found(4, "# scl: warn(SCL0710, 3)"), ["Warning gate `hub.x` has 4 subscribers"]);
    }
}
