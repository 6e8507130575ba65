//! The texts of deadlocks, and that the proposed way out works.

use super::RULE;
use crate::advice::apply;
use crate::check::testing::{codes, example, problems, rule_example};
use expect_test::expect;

/// Components `name | gates`, then connections.
fn file(components: &[(&str, &str)], connections: &str) -> String {
    let gates = |gates: &str| gates.split("; ").map(|gate| format!("      - {gate}\n")).collect::<String>();
    let component = |(name, list): &(&str, &str)| format!("  - name: {name}\n    gates:\n{}", gates(list));
    let components: String = components.iter().map(component).collect();
    let connections: String = connections.split("; ").map(|ends| format!("  - [{ends}]\n")).collect();
    format!("components:\n{components}connections:\n{connections}")
}

fn publishers() -> String {
    let gates = |name| format!("{name}_out: {{pub: T, backpressure: true}}; {name}_in: {{sub: T, when_full: wait}}");
    file(&[("a", &gates("a")), ("b", &gates("b"))], "a.a_out, b.b_in; b.b_out, a.a_in")
}

fn answered_with_a_push() -> String {
    let a = "ask: {req: A -> B}; results: {pull: T, when_full: wait}";
    let b = "answer: {rep: A -> B}; work: {push: T, backpressure: true}";
    file(&[("a", a), ("b", b)], "a.ask, b.answer; b.work, a.results")
}

fn shared_work() -> String {
    let gates = |name| format!("{name}_out: {{push: T, backpressure: true}}; {name}_in: {{pull: T, when_full: wait}}");
    let a = "work: {push: T, backpressure: true, share: true}; results: {pull: T, when_full: wait}";
    let connections = "a.work, b.b_in; a.work, c.c_in; b.b_out, a.results; c.c_out, a.results";
    file(&[("a", a), ("b", &gates("b")), ("c", &gates("c"))], connections)
}

#[test]
fn components_wait_for_each_other() {
    rule_example(
        &RULE,
        expect![[r#"
            error: [SCL0707] components wait for each other: `arbiter` -> `power` -> `arbiter`
              --> topology.yaml:11:5
               |
            11 |   - [arbiter.power, power.status]
               |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `arbiter` waits until `power` answers, at most 1s
            12 |   - [power.mission, arbiter.mission]
               |     -------------------------------- `power` waits until `arbiter` answers, at most 1s
               |
               = help: let `arbiter` publish what `power.mission` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req`
               = help: or let `power` publish what `arbiter.power` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: a request sent while answering one of the same circle is never answered, however long its timeout
        "#]],
    );
}

#[test]
fn full_queues() {
    example(
        "SCL0707",
        &publishers(),
        expect![[r#"
            error: [SCL0707] components wait for each other: `a` -> `b` -> `a`
              --> topology.yaml:11:5
               |
            11 |   - [a.a_out, b.b_in]
               |     ^^^^^^^^^^^^^^^^^ `a` waits while the queue of `b.b_in` is full
            12 |   - [b.b_out, a.a_in]
               |     ----------------- `b` waits while the queue of `a.a_in` is full
               |
               = help: let `a.a_in` drop messages: `when_full: drop_oldest`, and remove `backpressure` from `b.b_out`
               = help: or let `b.b_in` drop messages: `when_full: drop_oldest`, and remove `backpressure` from `a.a_out`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: once all of them wait, nothing moves any more
        "#]],
    );
}

#[test]
fn a_request_that_is_answered_with_a_push() {
    example(
        "SCL0707",
        &answered_with_a_push(),
        expect![[r#"
            error: [SCL0707] components wait for each other: `a` -> `b` -> `a`
              --> topology.yaml:11:5
               |
            11 |   - [a.ask, b.answer]
               |     ^^^^^^^^^^^^^^^^^ `a` waits until `b` answers, at most 1s
            12 |   - [b.work, a.results]
               |     ------------------- `b` waits while the queue of `a.results` is full
               |
               = help: let `a.results` drop messages: `when_full: drop_oldest`, and remove `backpressure` from `b.work`
               = help: or say how long the request may wait before it fails: `timeout` at `a.ask`
               = help: or let `b` publish what `a.ask` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: once all of them wait, nothing moves until a request fails after 1s
        "#]],
    );
}

#[test]
fn work_that_is_shared() {
    example(
        "SCL0707",
        &shared_work(),
        expect![[r#"
            error: [SCL0707] components wait for each other: `a`, `b`, `c`
              --> topology.yaml:15:5
               |
            15 |   - [a.work, b.b_in]
               |     ^^^^^^^^^^^^^^^^ `a` waits while the queue of `b.b_in` is full
            16 |   - [a.work, c.c_in]
               |     ---------------- `a` waits while the queue of `c.c_in` is full
            17 |   - [b.b_out, a.results]
               |     -------------------- `b` waits while the queue of `a.results` is full
            18 |   - [c.c_out, a.results]
               |     -------------------- `c` waits while the queue of `a.results` is full
               |
               = help: let `a.results` drop messages: `when_full: drop_oldest`, and remove `backpressure` from `b.b_out`, `c.c_out`
               = help: or let `c.c_in` drop messages: `when_full: drop_oldest`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: once all of them wait, nothing moves any more
               = note: a `push` gate that shares its work waits only while the queues of all its pullers are full
        "#]],
    );
}

#[test]
fn two_circles_with_a_common_connection() {
    let gates = "o: req; p: req; i: rep";
    let connections = "a.o, b.i; b.o, a.i; b.p, c.i; c.o, a.i";
    example(
        "SCL0707",
        &file(&[("a", gates), ("b", gates), ("c", "o: req; i: rep")], connections),
        expect![[r#"
            error: [SCL0707] components wait for each other: `a` -> `b` -> `a`
              --> topology.yaml:17:5
               |
            17 |   - [a.o, b.i]
               |     ^^^^^^^^^^ `a` waits until `b` answers, at most 1s
            18 |   - [b.o, a.i]
               |     ---------- `b` waits until `a` answers, at most 1s
               |
               = help: let `a` publish what `b.o` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req`
               = help: or let `b` publish what `a.o` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: a request sent while answering one of the same circle is never answered, however long its timeout

            error: [SCL0707] components wait for each other: `a` -> `b` -> `c` -> `a`
              --> topology.yaml:17:5
               |
            17 |   - [a.o, b.i]
               |     ^^^^^^^^^^ `a` waits until `b` answers, at most 1s
            18 |   - [b.o, a.i]
            19 |   - [b.p, c.i]
               |     ---------- `b` waits until `c` answers, at most 1s
            20 |   - [c.o, a.i]
               |     ---------- `c` waits until `a` answers, at most 1s
               |
               = help: let `a` publish what `c.o` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req`
               = help: or let `c` publish what `b.p` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req`
               = help: or let `b` publish what `a.o` asks for, if that is the same for each request: `pub` and `sub` instead of `rep` and `req`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: a request sent while answering one of the same circle is never answered, however long its timeout
        "#]],
    );
}

#[test]
fn a_circle_of_many() {
    let names: Vec<String> = (0..20).map(|at| format!("c{at}")).collect();
    let components: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "o: req; i: rep")).collect();
    let pairs: Vec<String> = (0..20).map(|at| format!("c{at}.o, c{}.i", (at + 1) % 20)).collect();
    let (found, _) = problems(&file(&components, &pairs.join("; ")), None);
    let found: Vec<_> = found.iter().filter(|found| found.rule == &RULE).collect();
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].secondary.len(), found[0].unlisted), (16, 3));
    expect!["components wait for each other: `c0` -> `c1` -> `c2` -> `c3` -> `c4` -> `c5` -> `c6` -> `c7` -> 12 more -> `c0`"].assert_eq(&found[0].message);
}

/// Does what the first proposal says.
fn with_the_way_out(yaml: &str) -> Option<String> {
    let (found, _) = problems(yaml, None);
    let found = found.into_iter().find(|found| found.rule == &RULE)?;
    let edits: Vec<_> = found.proposals().next()?.edits.iter().collect();
    apply(yaml, &edits)
}

#[test]
fn the_way_out_makes_a_file_clean() {
    let hub = |name| format!("{name}_out: {{pub: T, backpressure: true}}; {name}_in: {{sub: T, when_full: wait}}");
    let star = file(
        &[("a", &hub("a")), ("b", &hub("b")), ("c", &hub("c"))],
        "a.a_out, b.b_in; a.a_out, c.c_in; b.b_out, a.a_in; c.c_out, a.a_in",
    );
    for mut yaml in [publishers(), answered_with_a_push(), shared_work(), star] {
        assert!(codes(&yaml).contains(&"SCL0707"), "{yaml}");
        let mut steps = 0;
        while let Some(better) = with_the_way_out(&yaml) {
            (yaml, steps) = (better, steps + 1);
            assert!(steps <= 3, "{yaml}");
        }
        assert_eq!(codes(&yaml), [""; 0], "{yaml}");
    }
}
