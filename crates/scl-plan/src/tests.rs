//! Plans as text: both directions, damaged texts, and what errors say.

use crate::parameter::tests::one_of_each_form;
use crate::{
    ConnectionPlan, GateKind, GateOptions, GatePlan, KindPlan, Payload, Plan, PlanError, Schema, SystemPlan, WhenFull,
};
use expect_test::expect;
use proptest::prelude::*;
use std::time::Duration;

fn connection(peer_component: &str, peer_gate: &str, endpoint: &str) -> ConnectionPlan {
    ConnectionPlan {
        peer_component: peer_component.to_owned(),
        peer_gate: peer_gate.to_owned(),
        endpoint: endpoint.to_owned(),
        contract: "hl75aqsl".to_owned(),
        required: true,
        queue: 1,
        when_full: WhenFull::Wait,
        max_size: 67_108_864,
        max_age: None,
    }
}

fn gate(kind: GateKind, connections: Vec<ConnectionPlan>) -> GatePlan {
    let name = format!("{}_gate", kind.word());
    GatePlan {
        kind,
        payload: match kind.exchanges() {
            true => Payload::Exchange { request: "rover.Command".to_owned(), reply: "rover.Status".to_owned() },
            false => Payload::Message("rover.Measurement".to_owned()),
        },
        codec: "protobuf".to_owned(),
        declared_at: "rover.yaml:5:9".to_owned(),
        endpoint: kind.shares_endpoint().then(|| format!("controller.{name}.hl75aqsl")),
        tap: kind.listens().then(|| format!("controller.{name}.tap")),
        contract: "hl75aqsl".to_owned(),
        options: GateOptions { max_size: 1024, timeout: Duration::from_millis(1500), ..GateOptions::DEFAULT },
        connections,
        name,
    }
}

/// All kinds, parameters, a schema, and names that JSON has to escape.
fn rover() -> SystemPlan {
    let link = || vec![connection("sensor", "measurements", "sensor.measurements--it.hl75aqsl")];
    let schema = Schema { hash: "1a2b".to_owned(), descriptors: [0, 255, 7, 10].into() };
    let plan = |component: &str, gates| Plan {
        system: "rover".to_owned(),
        component: component.to_owned(),
        declared_at: "C:\\rover \"1\".yaml:2:5".to_owned(),
        schema: Some(schema.clone()),
        parameters: Vec::new(),
        gates,
    };
    let mut bytes = gate(GateKind::Pub, Vec::new());
    (bytes.name, bytes.payload, bytes.codec) = ("raw_bytes".to_owned(), Payload::Bytes, "raw".to_owned());
    let all = GateKind::ALL.map(|kind| gate(kind, link())).into_iter().chain([bytes]).collect();
    let twin = Plan { parameters: one_of_each_form(), ..plan("twin", Vec::new()) };
    let clock = Plan { schema: None, component: "clock".to_owned(), ..twin.clone() };
    SystemPlan { system: "rover".to_owned(), components: vec![plan("controller", all), twin, clock], kinds: Vec::new() }
}

/// The same with a kind of two components.
fn with_a_kind() -> SystemPlan {
    let components = ["twin", "clock"].map(str::to_owned).into();
    SystemPlan { kinds: vec![KindPlan { name: "idler".to_owned(), components }], ..rover() }
}

#[test]
fn the_format_is_this() {
    let SystemPlan { system, mut components, .. } = rover();
    components[0].gates = vec![gate(GateKind::Rep, vec![connection("panel", "ask", "controller.rep_gate.hl75aqsl")])];
    components.truncate(1);
    expect![[r#"
        {
          "version": 1,
          "system": "rover",
          "components": [
            {
              "name": "controller",
              "declared_at": "C:\\rover \"1\".yaml:2:5",
              "schema": "1a2b",
              "gates": [
                {
                  "name": "rep_gate",
                  "kind": "rep",
                  "payload": {
                    "request": "rover.Command",
                    "reply": "rover.Status"
                  },
                  "codec": "protobuf",
                  "declared_at": "rover.yaml:5:9",
                  "endpoint": "controller.rep_gate.hl75aqsl",
                  "tap": "controller.rep_gate.tap",
                  "contract": "hl75aqsl",
                  "max_size": 1024,
                  "queue": 100,
                  "when_full": "drop_oldest",
                  "backpressure": false,
                  "latched": false,
                  "timeout_ns": 1500000000,
                  "in_flight": 1,
                  "undecodable": "skip",
                  "connections": [
                    {
                      "peer_component": "panel",
                      "peer_gate": "ask",
                      "endpoint": "controller.rep_gate.hl75aqsl",
                      "contract": "hl75aqsl",
                      "required": true,
                      "queue": 1,
                      "when_full": "wait",
                      "max_size": 67108864
                    }
                  ]
                }
              ]
            }
          ],
          "schemas": {
            "1a2b": "AP8HCg=="
          }
        }
    "#]]
    .assert_eq(&SystemPlan { system, components, kinds: Vec::new() }.to_json());
}

#[test]
fn kinds_are_named_with_their_components() {
    let text = with_a_kind().to_json();
    let start = "{\n  \"version\": 1,\n  \"system\": \"rover\",\n  \"kinds\": [\n    {\n      \"name\": \"idler\",\n      \
                 \"components\": [\n        \"twin\",\n        \"clock\"\n      ]\n    }\n  ],\n  \"components\": [\n";
    assert!(text.starts_with(start), "{text}");
    assert_eq!(SystemPlan::from_json(&text).unwrap(), with_a_kind());
}

#[test]
fn a_kind_whose_components_do_not_fit_is_refused() {
    let refused = |change: fn(&mut SystemPlan)| {
        let mut system = with_a_kind();
        change(&mut system);
        format!("{}\n", SystemPlan::from_json(&system.to_json()).unwrap_err())
    };
    let told = [
        refused(|system| system.kinds[0].components.clear()),
        refused(|system| system.kinds[0].components.push("clok".to_owned())),
        refused(|system| system.kinds[0].components.push("clock".to_owned())),
        refused(|system| system.kinds[0].components.push("controller".to_owned())),
        refused(|system| system.kinds[0].name = "controller".to_owned()),
        refused(|system| system.kinds.push(system.kinds[0].clone())),
        error("\"gates\": [", "\"kinds\": [], \"gates\": ["),
    ];
    expect![[r#"
        kind `idler` has no components
        kind `idler` has `clok`, which is not among the components
        kind `idler` has `clock` twice, or together with another kind
        kind `idler` has `controller`, which differs from its first component in gates or parameters
        kind `controller` has the name of a component
        kind `idler` is declared twice
        unknown field `kinds` in `components[0]`"#]]
    .assert_eq(&told.concat());
}

#[test]
fn the_part_of_a_plan_is_a_component_or_a_kind() {
    let system = with_a_kind();
    let names = |part: &SystemPlan| part.components.iter().map(|it| it.component.clone()).collect::<Vec<_>>();
    let kind = system.part("idler").unwrap();
    assert_eq!((names(&kind), &kind.kinds), (vec!["twin".to_owned(), "clock".to_owned()], &system.kinds));
    let component = system.part("clock").unwrap();
    assert_eq!((names(&component), component.kinds.len()), (vec!["clock".to_owned()], 0));
    assert_eq!(system.component_or_first("idler").unwrap().component, "twin");
    let told = ["idler", "idlr", "clok"].map(|name| system.component(name).unwrap_err().to_string());
    let start = "system `rover` has no component";
    assert_eq!(
        told[0],
        format!("{start} `idler`, but a kind of this name: name one of its components, `twin` or `clock`")
    );
    assert_eq!(told[1], format!("{start} `idlr`; did you mean `idler`?"));
    assert_eq!(told[2], format!("{start} `clok`; did you mean `clock`?"));
}

#[test]
fn plans_come_back_from_their_text() {
    let system = rover();
    assert_eq!(SystemPlan::from_json(&system.to_json()).unwrap(), system);
    for plan in &system.components {
        assert_eq!(Plan::from_json(&plan.to_json()).unwrap(), *plan);
    }
}

#[test]
fn times_between_messages_come_back_from_their_text() {
    let mut system = rover();
    let options = &mut system.components[0].gates[0].options;
    (options.period, options.deadline) = (Some(Duration::from_millis(10)), Some(Duration::from_secs(24 * 60 * 60)));
    let text = system.to_json();
    assert_eq!(text.matches("\"period_ns\": 10000000").count(), 1, "{text}");
    assert_eq!(text.matches("\"deadline_ns\": 86400000000000").count(), 1, "{text}");
    assert_eq!(SystemPlan::from_json(&text).unwrap(), system);
}

#[test]
fn an_option_that_is_missing_has_its_default() {
    let text = rover().to_json();
    let older = text.replace("\"in_flight\": 1,", "").replace("\"undecodable\": \"skip\",", "");
    assert!(older.len() < text.len());
    assert_eq!(SystemPlan::from_json(&older).unwrap(), rover());
}

#[test]
fn one_component_is_not_several() {
    let text = rover().to_json();
    let error = Plan::from_json(&text).unwrap_err().to_string();
    assert!(error.contains("3 components where one is expected"), "{error}");
    let none = SystemPlan { components: Vec::new(), ..rover() };
    assert!(matches!(Plan::from_json(&none.to_json()), Err(PlanError::NotOneComponent { count: 0 })));
}

/// The error of the example after one replacement.
fn error(from: &str, to: &str) -> String {
    let text = rover().to_json();
    assert!(text.contains(from), "{from}");
    SystemPlan::from_json(&text.replacen(from, to, 1)).unwrap_err().to_string()
}

#[test]
fn errors_say_what_is_wrong_and_where() {
    let cases = [
        ("\"version\": 1,", "\"version\": 2,"),
        ("\"version\": 1,", "\"version\": \"1\","),
        ("\"version\": 1,", ""),
        ("\"version\": 1,", "\"version\": 1, \"verson\": 1,"),
        ("\"system\": \"rover\",", ""),
        ("\"codec\": \"protobuf\",", ""),
        ("\"queue\": 100", "\"queue\": 100, \"queu\": 1"),
        ("\"queue\": 100", "\"queue\": 4294967296"),
        ("\"queue\": 100", "\"queue\": -1"),
        ("\"queue\": 100", "\"queue\": 0"),
        ("\"queue\": 100", "\"queue\": 1.5"),
        ("\"kind\": \"pub\"", "\"kind\": \"publisher\""),
        ("\"kind\": \"pub\"", "\"kind\": \"rep\""),
        ("\"kind\": \"pub\"", "\"kind\": \"sub\""),
        ("\"backpressure\": false", "\"backpressure\": \"a text so long that nobody wants to read all of it again\""),
        ("\"endpoint\": null", "\"endpoint\": 7"),
        ("\"message\": \"rover.Measurement\"", "\"request\": \"rover.Measurement\""),
        ("\"message\": \"rover.Measurement\"", ""),
        ("\"undecodable\": \"skip\"", "\"undecodable\": \"ignore\""),
        ("\"in_flight\": 1", "\"in_flight\": 0"),
        ("\"timeout_ns\": 1500000000", "\"timeout_ns\": 0"),
        ("\"timeout_ns\": 1500000000", "\"timeout_ns\": 18446744073709551615"),
        ("\"in_flight\": 1", "\"in_flight\": 1, \"period_ns\": 0"),
        ("\"in_flight\": 1", "\"in_flight\": 1, \"deadline_ns\": 86400000000001"),
        ("\"schema\": \"1a2b\"", "\"schema\": \"1a2c\""),
        ("\"AP8HCg==\"", "\"AP8HCg=\""),
        ("\"name\": \"sub_gate\"", "\"name\": \"pub_gate\""),
        ("\"name\": \"twin\"", "\"name\": \"clock\""),
        ("\"name\": \"twin\"", "\"name\": \"\""),
        ("\"peer_gate\": \"measurements\"", "\"peer_gate\": [1]"),
        ("\"gates\": [", "\"gates\": 5, \"nodes\": ["),
    ];
    let told: String = cases.iter().map(|(from, to)| format!("{}\n", error(from, to))).collect();
    expect![[r#"
        this plan has version 2 of the format, but this program reads version 1; write it again with `scl plan` from this release
        `version` must be a whole number, but it is "1"
        field `version` is missing in the document
        unknown field `verson` in the document; did you mean `version`?
        field `system` is missing in the document
        field `codec` is missing in `components[0].gates[0]`
        unknown field `queu` in `components[0].gates[0]`; did you mean `queue`?
        `components[0].gates[0].queue` must be a whole number from 0 to 4294967295, but it is 4294967296
        `components[0].gates[0].queue` must be a whole number from 0 to 4294967295, but it is -1
        gate `controller.pub_gate` has a queue of 0 messages
        `components[0].gates[0].queue` must be a whole number from 0 to 4294967295, but it is 1.5
        `components[0].gates[0].kind` must be one of `pub`, `sub`, `req`, `rep`, `push`, `pull`, but it is "publisher"
        gate `controller.pub_gate` is a `rep` gate, which cannot carry `rover.Measurement`
        gate `controller.pub_gate` has a tap, which only `pub`, `rep` and `pull` gates have
        `components[0].gates[0].backpressure` must be true or false, but it is "a text so long that nobody wants to rea...
        `components[0].gates[0].endpoint` must be a text or null, but it is 7
        field `reply` is missing in `components[0].gates[0].payload`
        `components[0].gates[0].payload` must be null, or an object with `message`, or one with `request` and `reply`, but it is {}
        `components[0].gates[0].undecodable` must be one of `skip`, `fail`, but it is "ignore"
        gate `controller.pub_gate` allows no call to be in progress
        gate `controller.pub_gate` has a timeout of zero or of more than a day
        gate `controller.pub_gate` has a timeout of zero or of more than a day
        gate `controller.pub_gate` has a period, a deadline or a greatest age of zero or of more than a day
        gate `controller.pub_gate` has a period, a deadline or a greatest age of zero or of more than a day
        `components[0].schema` refers to `1a2c`, which is not in `schemas`
        `schemas.1a2b` must be bytes in Base64, but it is "AP8HCg="
        gate `controller.pub_gate` is declared twice
        component `clock` is declared twice
        a component has no name
        `components[0].gates[0].connections[0].peer_gate` must be a text, but it is [1]
        unknown field `nodes` in `components[0]`
    "#]]
    .assert_eq(&told);
}

#[test]
fn values_of_another_type_are_refused() {
    for text in ["null", "[]", "7", "\"rover\"", "true"] {
        let error = SystemPlan::from_json(text).unwrap_err().to_string();
        assert_eq!(error, format!("`the document` must be an object, but it is {text}"));
    }
}

#[test]
fn a_text_that_ends_early_is_an_error() {
    let text = rover().to_json();
    let whole = text.trim_end().len();
    for (end, _) in text.char_indices().filter(|&(end, _)| end < whole) {
        assert!(matches!(SystemPlan::from_json(&text[..end]), Err(PlanError::Syntax(_))), "{end}");
    }
}

proptest! {
    /// Whatever a damaged text is read as, it comes back as the same, and nothing panics.
    #[test]
    fn damaged_texts_are_plans_or_errors(at in 0_usize..12_000, length in 0_usize..12, filling in "[\\PC\n]{0,6}") {
        let mut bytes = rover().to_json().into_bytes();
        let start = at % bytes.len();
        let end = (start + length).min(bytes.len());
        bytes.splice(start..end, filling.bytes());
        let text = String::from_utf8_lossy(&bytes);
        match SystemPlan::from_json(&text) {
            Ok(plan) => prop_assert_eq!(SystemPlan::from_json(&plan.to_json()).unwrap(), plan),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    #[test]
    fn any_text_is_a_plan_or_an_error(text in "\\PC*") {
        let _ = SystemPlan::from_json(&text);
    }
}

#[test]
fn a_counterpart_has_the_other_ends() {
    let mut plan = rover().components.swap_remove(0);
    for kind in GateKind::ALL {
        plan.gates.push(GatePlan { name: format!("lonely_{}", kind.word()), ..gate(kind, Vec::new()) });
    }
    let counterpart = plan.counterpart();
    let described = counterpart.gates.iter().map(|gate| {
        let links: String = gate.connections.iter().map(|link| format!(" -> {}", link.endpoint)).collect();
        let tap = gate.tap.as_deref().unwrap_or("-");
        let endpoint = gate.endpoint.as_deref().unwrap_or("-");
        format!("{} {} {endpoint} {tap}{links}\n", gate.name, gate.kind.word())
    });
    expect![[r#"
        pub_gate sub - - -> sensor.measurements--it.hl75aqsl
        sub_gate pub - controller.sub_gate.peer -> sensor.measurements--it.hl75aqsl
        req_gate rep sensor.measurements--it.hl75aqsl controller.req_gate.peer -> sensor.measurements--it.hl75aqsl
        rep_gate req - - -> sensor.measurements--it.hl75aqsl
        push_gate pull sensor.measurements--it.hl75aqsl controller.push_gate.peer -> sensor.measurements--it.hl75aqsl
        pull_gate push - - -> sensor.measurements--it.hl75aqsl
        raw_bytes sub - -
        lonely_pub sub - -
        lonely_sub pub - controller.lonely_sub.peer
        lonely_req rep controller.lonely_req.unconnected controller.lonely_req.peer
        lonely_rep req - - -> controller.rep_gate.hl75aqsl
        lonely_push pull controller.lonely_push.unconnected controller.lonely_push.peer
        lonely_pull push - - -> controller.pull_gate.hl75aqsl
    "#]]
    .assert_eq(&described.collect::<String>());
    counterpart.validate().unwrap();
}
