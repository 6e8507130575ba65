//! Topologies in, exact routes out.

use super::*;
use crate::deployment::Host;
use scl_loader::{Request, load_bytes};

fn system(yaml: &str) -> SystemPlan {
    let loaded = load_bytes(&Request::new("rover.yaml"), yaml.as_bytes().to_vec());
    loaded.system_plan().unwrap_or_else(|| panic!("{:#?}", loaded.diagnostics))
}

fn deployment(hosts: &[(&str, &[&str])]) -> Deployment {
    let host = |(name, components): &(&str, &[&str])| Host {
        name: (*name).to_owned(),
        address: "127.0.0.1".to_owned(),
        port: 7447,
        components: components.iter().map(|it| (*it).to_owned()).collect(),
    };
    Deployment { hosts: hosts.iter().map(host).collect(), certificates: None, insecure: false }
}

fn end(host: &str, gate: Option<(&str, &str)>) -> RouteEnd {
    let (component, gate) = gate.map(|(component, gate)| (component.to_owned(), gate.to_owned())).unzip();
    RouteEnd { host: host.to_owned(), component, gate }
}

const PUBLISHED: Pattern = Pattern::Messages { listens_at_sender: true };
const PUSHED: Pattern = Pattern::Messages { listens_at_sender: false };

/// A route with the defaults of its options.
fn expected(pattern: Pattern, from: RouteEnd, to: RouteEnd, endpoint: &str, key: &str) -> Route {
    let contract = endpoint.rsplit('.').next().unwrap().to_owned();
    Route {
        pattern,
        from,
        to,
        endpoint: endpoint.to_owned(),
        key: format!("{key}/{contract}"),
        queue: 100,
        lossless: false,
        latched: false,
        max_size: 64 << 20,
    }
}

const PUBLISHING: &str = "
components:
  - name: sensor
    gates:
      - fix: {pub: nav.Fix, backpressure: true}
  - name: pilot
    gates:
      - gps: {sub: nav.Fix, queue: 1, max_size: 1KiB}
  - name: logger
    optional: true
    gates:
      - fix: {sub: nav.Fix, when_full: wait}
connections:
  - [sensor.fix, pilot.gps]
  - [logger.fix, sensor.fix]
";

#[test]
fn each_connection_of_a_publisher_is_a_route() {
    let hosts = deployment(&[("board", &["sensor"]), ("ground", &["pilot", "logger"])]);
    let publisher = || end("board", Some(("sensor", "fix")));
    let pilot = Route {
        queue: 1,
        max_size: 1024,
        ..expected(
            PUBLISHED,
            publisher(),
            end("ground", Some(("pilot", "gps"))),
            "sensor.fix--pilot.gps.xyiwox57",
            "scl/rover/sensor/fix/pilot/gps",
        )
    };
    let logger = Route {
        lossless: true,
        latched: false,
        ..expected(
            PUBLISHED,
            publisher(),
            end("ground", Some(("logger", "fix"))),
            "sensor.fix--logger.fix.xyiwox57",
            "scl/rover/sensor/fix/logger/fix",
        )
    };
    let all = routes(&system(PUBLISHING), &hosts, "board");
    assert_eq!(all, [pilot, logger]);
    assert_eq!(routes(&system(PUBLISHING), &hosts, "ground"), all);
}

#[test]
fn connections_within_a_host_and_those_of_others_are_not_routes() {
    let hosts = deployment(&[("board", &["sensor", "pilot"]), ("ground", &["logger"]), ("spare", &[])]);
    let keys =
        |host: &str| routes(&system(PUBLISHING), &hosts, host).into_iter().map(|route| route.key).collect::<Vec<_>>();
    assert_eq!(keys("board"), ["scl/rover/sensor/fix/logger/fix/xyiwox57"]);
    assert_eq!(keys("ground"), keys("board"));
    assert!(keys("spare").is_empty() && keys("unknown").is_empty());
}

#[test]
fn a_component_on_no_host_has_no_routes() {
    let hosts = deployment(&[("board", &["sensor"]), ("ground", &["logger"])]);
    let routes = routes(&system(PUBLISHING), &hosts, "board");
    assert_eq!(routes.iter().map(|route| route.to.component.as_deref()).collect::<Vec<_>>(), [Some("logger")]);
}

const PUSHING: &str = "
components:
  - name: camera
    gates:
      - jobs: {push: Job, share: true, backpressure: true}
  - name: planner
    gates:
      - jobs: {push: Job, backpressure: true}
  - name: archive
    gates:
      - jobs: {push: Job, backpressure: true}
  - name: worker
    gates:
      - jobs: {pull: Job, when_full: wait, queue: 7}
  - name: helper
    gates:
      - jobs: {pull: Job}
connections:
  - [planner.jobs, worker.jobs]
  - [camera.jobs, worker.jobs]
  - [camera.jobs, helper.jobs]
  - [archive.jobs, worker.jobs]
";

#[test]
fn the_pushers_of_a_host_share_a_route_to_each_puller() {
    let hosts =
        deployment(&[("board", &["camera", "planner"]), ("ground", &["worker", "helper"]), ("office", &["archive"])]);
    let worker = |host: &str| Route {
        queue: 7,
        lossless: true,
        latched: false,
        ..expected(
            PUSHED,
            end(host, None),
            end("ground", Some(("worker", "jobs"))),
            "worker.jobs.evzugcn6",
            &format!("scl/rover/host:{host}/push/worker/jobs"),
        )
    };
    let helper = expected(
        PUSHED,
        end("board", None),
        end("ground", Some(("helper", "jobs"))),
        "helper.jobs.evzugcn6",
        "scl/rover/host:board/push/helper/jobs",
    );
    let system = system(PUSHING);
    assert_eq!(routes(&system, &hosts, "board"), [worker("board"), helper.clone()]);
    assert_eq!(routes(&system, &hosts, "office"), [worker("office")]);
    assert_eq!(routes(&system, &hosts, "ground"), [worker("board"), helper, worker("office")]);
}

const REQUESTING: &str = "
components:
  - name: display
    gates:
      - ask: {req: A -> B, max_size: 4KiB}
  - name: tablet
    gates:
      - ask: {req: A -> B, max_size: 8KiB}
  - name: pilot
    gates:
      - orders: {rep: A -> B, max_size: 1KiB}
connections:
  - [display.ask, pilot.orders]
  - [tablet.ask, pilot.orders]
";

#[test]
fn the_requesters_of_a_host_share_a_route() {
    let hosts = deployment(&[("ground", &["display", "tablet"]), ("board", &["pilot"])]);
    let route = Route {
        max_size: 8 << 10,
        ..expected(
            Pattern::Requests,
            end("ground", None),
            end("board", Some(("pilot", "orders"))),
            "pilot.orders.yrvcf33f",
            "scl/rover/host:ground/req/pilot/orders",
        )
    };
    for host in ["ground", "board"] {
        assert_eq!(routes(&system(REQUESTING), &hosts, host), std::slice::from_ref(&route), "{host}");
    }
}

#[test]
fn every_host_computes_the_same_routes() {
    let hosts = deployment(&[("a", &["camera"]), ("b", &["planner", "worker"]), ("c", &["archive", "helper"])]);
    let system = system(PUSHING);
    let between = |host: &str, one: &str, other: &str| {
        let ends = [one, other];
        let mut routes = routes(&system, &hosts, host);
        routes.retain(|it| ends.contains(&it.from.host.as_str()) && ends.contains(&it.to.host.as_str()));
        routes
    };
    for (one, other) in [("a", "b"), ("a", "c"), ("b", "c")] {
        assert_eq!(between(one, one, other), between(other, one, other), "{one} {other}");
        assert!(!between(one, one, other).is_empty());
    }
}
