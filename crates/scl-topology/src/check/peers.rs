//! How many peers a gate may have. SCL0511, a lint: a subscriber with several publishers. SCL0512: a requester with two
//! repliers. SCL0513: a pusher with several pullers that does not say that they share the work. SCL0710, a lint: a gate
//! with very many peers, each of which costs time and memory for each message.

use super::control;
use super::draft::Draft;
use super::split_gate::{self, Part};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::topology::GateKind;
use scl_text::list::listed;
use std::collections::HashSet;

/// SCL0511.
pub(crate) const SEVERAL_PUBLISHERS: Rule = Rule {
    code: "SCL0511",
    severity: Severity::Lint,
    title: "subscriber with several publishers",
    explanation: "Several publishers send to one subscribing gate, and their messages arrive mixed, in the order of \
                  arrival. That is allowed; the lint is for systems in which each gate has one source. The components \
                  of a kind count as one. If the publishers are implementations of one component, declare that \
                  component once and start one of the programs.",
    example: " components:
   - name: gps
     gates:
       - fix: pub
   - name: replay
     gates:
       - fix: pub
   - name: autopilot
     gates:
       - fix: sub
+      - replay_fix: sub
 connections:
   - [gps.fix, autopilot.fix]
-  - [replay.fix, autopilot.fix]
+  - [replay.fix, autopilot.replay_fix]
",
};

/// SCL0512.
pub(crate) const SEVERAL_REPLIERS: Rule = Rule {
    code: "SCL0512",
    severity: Severity::Error,
    title: "requester with two repliers",
    explanation: "A requester is connected to two repliers, and it is not defined which one answers; plain ZeroMQ \
                  would ask them in turn. Declare one `req` gate for each. The opposite is fine: many requesters of \
                  one replier.",
    example: " components:
   - name: ui
     gates:
       - commands: req
+      - camera_commands: req
   - name: autopilot
     gates:
       - commands: rep
   - name: camera
     gates:
       - commands: rep
 connections:
   - [ui.commands, autopilot.commands]
-  - [ui.commands, camera.commands]
+  - [ui.camera_commands, camera.commands]
",
};

/// SCL0513.
pub(crate) const SEVERAL_PULLERS: Rule = Rule {
    code: "SCL0513",
    severity: Severity::Error,
    title: "pusher with several pullers",
    explanation: "A `push` gate sends each message to one of its pullers, so several pullers each get only a part of \
                  the messages. If all of them need every message, use `pub` and `sub`; if they share the work, write \
                  `share: true`.",
    example: " components:
   - name: camera
     gates:
-      - frames: push
+      - frames: {push: , share: true}
   - name: detector
     gates:
       - frames: pull
   - name: recorder
     gates:
       - frames: pull
 connections:
   - [camera.frames, detector.frames]
   - [camera.frames, recorder.frames]
",
};

/// SCL0710.
pub(crate) const MANY_PEERS: Rule = Rule {
    code: "SCL0710",
    severity: Severity::Lint,
    title: "very many connections at one gate",
    explanation: "A gate has very many peers, and each costs time and memory for each message. The threshold is 32; `# \
                  scl: warn(SCL0710, 64)` turns the check on for the file and sets the threshold to 64.",
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

/// Default threshold of SCL0710: more peers than this are many. The file can set another one.
const MANY: u32 = 32;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let threshold = control::threshold(draft.model, &MANY_PEERS).unwrap_or(MANY);
    for (gate, links) in draft.links_by_gate().into_iter().enumerate() {
        let Some(kind) = draft.gates[gate].kind else { continue };
        match kind {
            _ if links.len() < 2 => {}
            GateKind::Sub if are_of_a_kind(draft, &links) => {}
            GateKind::Sub => problems.push(several_publishers(draft, gate, &links)),
            GateKind::Req => problems.push(several_repliers(draft, gate, &links)),
            GateKind::Push if !may_share(draft, gate) => problems.push(several_pullers(draft, gate, &links)),
            _ => {}
        }
        let count = links.len() as u32;
        if count > threshold {
            problems.push(many_peers(draft, gate, kind, count, threshold));
        }
    }
}

/// Whether all peers are one gate of the components of a kind, which `each` connects on purpose.
fn are_of_a_kind(draft: &Draft<'_>, links: &[(usize, usize)]) -> bool {
    links.windows(2).all(|pair| draft.shared(pair[0].1) == draft.shared(pair[1].1))
}

/// Whether pullers share the work of a gate, as far as its options could be read.
fn may_share(draft: &Draft<'_>, gate: usize) -> bool {
    draft.gates[gate].options.share || draft.gates[gate].model.options_unread
}

fn several_publishers(draft: &Draft<'_>, gate: usize, links: &[(usize, usize)]) -> Diagnostic {
    let path = draft.path(gate);
    let headline = format!("gate `{path}` subscribes to several publishers");
    let (first_owner, second_owner) = (draft.component_name(links[0].1), draft.component_name(links[1].1));
    let name = &draft.gates[gate].model.name.value;
    let extra = format!("{second_owner}_{name}");
    let help = format!("declare a second gate: `- {extra}: sub`");
    let parts = [(name.clone(), &links[..1]), (extra, &links[1..])];
    let parts = parts.map(|(name, links)| Part { name, links: links.iter().map(|&(link, _)| link).collect() });
    let found = with_peers(&SEVERAL_PUBLISHERS, headline, draft, links, "publisher");
    split_gate::suggest(draft, found, gate, &parts, help)
        .help(format!(
            "if `{first_owner}` and `{second_owner}` are two implementations of one component, declare one component and \
             start either program"
        ))
        .note("messages of all its publishers arrive at this gate, in the order of arrival")
}

fn several_repliers(draft: &Draft<'_>, gate: usize, links: &[(usize, usize)]) -> Diagnostic {
    let count = match links.len() {
        2 => "two".to_owned(),
        more => more.to_string(),
    };
    let headline = format!("gate `{}` asks {count} repliers", draft.path(gate));
    let owners: HashSet<&str> = links.iter().map(|&(_, replier)| draft.component_name(replier)).collect();
    let part = |&(link, replier): &(usize, usize)| {
        // Two gates of one component differ in their own names.
        let of = if owners.len() == links.len() { gate } else { replier };
        let name = format!("{}_{}", draft.component_name(replier), draft.gates[of].model.name.value);
        Part { name, links: vec![link] }
    };
    let parts: Vec<Part> = links.iter().map(part).collect();
    let help = format!("declare one `req` gate for each replier: {}", listed(parts.iter().map(|part| &part.name)));
    let found = with_peers(&SEVERAL_REPLIERS, headline, draft, links, "replier");
    split_gate::suggest(draft, found, gate, &parts, help)
        .help("or keep only one of these connections")
        .note(format!("with {count} repliers it is not defined who answers (ZeroMQ would alternate between them)"))
        .note("many requesters of one replier are allowed")
}

fn several_pullers(draft: &Draft<'_>, gate: usize, links: &[(usize, usize)]) -> Diagnostic {
    let (count, each) = match links.len() {
        2 => ("two components".to_owned(), "both need"),
        more => (format!("{more} gates"), "each of them needs"),
    };
    let path = draft.path(gate);
    let headline = format!("gate `{path}` pushes to {count}, so each of them gets only a part of the messages");
    let share = draft.with_option(gate, "share", "true");
    let written = draft.entry_with(gate, std::slice::from_ref(&share));
    let shared = written.unwrap_or_else(|| format!("share: true` at `{path}"));
    let pullers = links.iter().map(|&(_, puller)| draft.with_kind(puller, GateKind::Sub, None));
    let published: Option<Vec<Vec<Edit>>> =
        std::iter::once(draft.with_kind(gate, GateKind::Pub, None)).chain(pullers).collect();
    let found = with_peers(&SEVERAL_PULLERS, headline, draft, links, "receiver")
        .suggest(format!("if they share the work, write `{shared}`"), [share]);
    let pullers: Vec<String> = links.iter().map(|&(_, puller)| draft.path(puller)).collect();
    let kinds = format!("make `{path}` a `pub` gate, and each of {} a `sub` gate", listed(&pullers));
    let help = format!("if {each} every message, {kinds}");
    match published {
        Some(edits) => found.suggest(help, edits.concat()),
        None => found.help(help),
    }
    .note("many pushers into one `pull` gate are allowed")
}

/// An error at the second peer, with a label on each of the others.
fn with_peers(
    rule: &'static Rule,
    headline: String,
    draft: &Draft<'_>,
    links: &[(usize, usize)],
    noun: &str,
) -> Diagnostic {
    let words = ["first", "second", "third", "fourth", "fifth"];
    let word = |at: usize| words.get(at).copied().unwrap_or("another");
    let text = |at: usize| format!("{} {noun}", word(at));
    let place = |at: usize| draft.end_span(links[at].0, links[at].1);
    let others = (0..links.len()).filter(|&at| at != 1);
    rule.at(headline, place(1), text(1)).labels(others.map(|at| (place(at), text(at))))
}

fn many_peers(draft: &Draft<'_>, gate: usize, kind: GateKind, count: u32, threshold: u32) -> Diagnostic {
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
    MANY_PEERS
        .at(headline, draft.gates[gate].model.name.span, label)
        .note(format!("threshold: {threshold}; set it with `# scl: warn(SCL0710, {double})`"))
}

#[cfg(test)]
mod tests {
    use super::{SEVERAL_PUBLISHERS, SEVERAL_PULLERS, SEVERAL_REPLIERS};
    use crate::check::testing::{advice_with, problems, rule_example};
    use expect_test::expect;

    #[test]
    fn subscriber_with_several_publishers() {
        rule_example(
            &SEVERAL_PUBLISHERS,
            expect![[r#"
                warning: [SCL0511] gate `autopilot.fix` subscribes to several publishers
                  --> topology.yaml:13:6
                   |
                12 |   - [gps.fix, autopilot.fix]
                   |      ------- first publisher
                13 |   - [replay.fix, autopilot.fix]
                   |      ^^^^^^^^^^ second publisher
                   |
                   = help: declare a second gate: `- replay_fix: sub`
                   = help: if `gps` and `replay` are two implementations of one component, declare one component and start either program
                   = note: messages of all its publishers arrive at this gate, in the order of arrival
            "#]],
        );
    }

    #[test]
    fn components_of_a_kind_are_one_source() {
        let yaml = "\
kinds:
  - {name: motor, gates: [{state: pub}, {error: pub}]}
components:
  - {name: left, kind: motor}
  - {name: right, kind: motor}
  - {name: hub, gates: [{states: sub}, {all: sub}]}
connections:
  - [each motor.state, hub.states]
  - [each motor.error, hub.all]
  - [left.state, hub.all]
";
        expect!["gate `hub.all` subscribes to several publishers [declare a second gate: `- right_all: sub` | if `left` and `right` are two implementations of one component, declare one component and start either program]"].assert_eq(&advice_with(&SEVERAL_PUBLISHERS, yaml, &[]));
    }

    #[test]
    fn requester_with_two_repliers() {
        rule_example(
            &SEVERAL_REPLIERS,
            expect![[r#"
                error: [SCL0512] gate `ui.commands` asks two repliers
                  --> topology.yaml:13:19
                   |
                12 |   - [ui.commands, autopilot.commands]
                   |                   ------------------ first replier
                13 |   - [ui.commands, camera.commands]
                   |                   ^^^^^^^^^^^^^^^ second replier
                   |
                   = help: declare one `req` gate for each replier: `autopilot_commands`, `camera_commands`
                   = help: or keep only one of these connections
                   = note: with two repliers it is not defined who answers (ZeroMQ would alternate between them)
                   = note: many requesters of one replier are allowed
            "#]],
        );
    }

    #[test]
    fn push_pull_cardinality() {
        rule_example(
            &SEVERAL_PULLERS,
            expect![[r#"
                error: [SCL0513] gate `camera.frames` pushes to two components, so each of them gets only a part of the messages
                  --> topology.yaml:13:21
                   |
                12 |   - [camera.frames, detector.frames]
                   |                     --------------- first receiver
                13 |   - [camera.frames, recorder.frames]
                   |                     ^^^^^^^^^^^^^^^ second receiver
                   |
                   = help: if they share the work, write `frames: {push: , share: true}`
                   = help: if both need every message, make `camera.frames` a `pub` gate, and each of `detector.frames`, `recorder.frames` a `sub` gate
                   = note: many pushers into one `pull` gate are allowed
            "#]],
        );
    }

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
