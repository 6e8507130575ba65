//! `scl watch`: what its page gets, with real components, over real sockets.

use crate::client::{Events, Watch, request};
use crate::rover::{COMPONENTS, Rover};
use serde_json::{Map, Value};

/// What a page knows: the latest value of each name.
struct Page {
    events: Events,
    known: Map<String, Value>,
}

impl Page {
    fn open(watch: &Watch) -> Self {
        Self { events: watch.events("view=0"), known: Map::new() }
    }

    /// Reads events until `condition` holds.
    fn wait_until(&mut self, condition: impl Fn(&Self) -> bool) {
        while !condition(self) {
            let Value::Object(changed) = self.events.next("state") else { panic!("a state is an object") };
            self.known.extend(changed);
        }
    }

    /// The state of a component in the picture.
    fn state(&self, component: &str) -> &str {
        let Some(picture) = self.known.get("picture") else { return "" };
        let marker = format!("\" data-component=\"{component}\"");
        let (before, _) = picture.as_str().unwrap().split_once(&marker).unwrap();
        let (_, part) = before.rsplit_once("data-part=\"").unwrap();
        self.known[part]["state"].as_str().unwrap()
    }

    fn text(&self, name: &str) -> String {
        self.known.get(name).map(Value::to_string).unwrap_or_default()
    }
}

/// A running system whose page shows that all its components run.
fn watched() -> (Rover, Watch, Page) {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let mut page = Page::open(&watch);
    page.wait_until(all_run);
    (rover, watch, page)
}

fn all_run(page: &Page) -> bool {
    COMPONENTS.iter().all(|component| page.state(component) == "running")
}

#[test]
fn a_killed_component_is_seen() {
    let (mut rover, _watch, mut page) = watched();
    assert_eq!(page.state("actuator"), "stopped");
    page.wait_until(|page| page.text("problems") == "[]");

    rover.kill("sensor");
    page.wait_until(|page| page.state("sensor") == "dead" && page.text("problems").contains("sensor was killed"));
    page.wait_until(|page| page.text("events").contains("was killed or has crashed"));

    rover.play(&["sensor"], |_| {});
    page.wait_until(|page| all_run(page) && page.text("problems") == "[]");
}

#[test]
fn a_system_that_vanishes_and_returns_is_followed() {
    let (mut rover, _watch, mut page) = watched();
    COMPONENTS.iter().for_each(|component| rover.stop(component));
    std::fs::remove_dir_all(rover.runtime_dir()).unwrap();
    page.wait_until(|page| COMPONENTS.iter().all(|component| page.state(component) == "stopped"));
    rover.play(&COMPONENTS, |_| {});
    page.wait_until(all_run);
}

#[test]
fn rows_and_edges_show_what_flows() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let mut page = Page::open(&watch);
    let flows = |page: &Page| page.known.iter().any(|(name, it)| name.starts_with("edge") && it["flow"] == "messages");
    let rates = |page: &Page| {
        let is_above = |rate: Option<f64>| rate.is_some_and(|rate| rate > 0.0);
        page.known.iter().any(|(name, it)| name.starts_with("row") && is_above(it["perSecond"].as_f64()))
    };
    page.wait_until(|page| flows(page) && rates(page));
}

#[test]
fn the_messages_of_a_gate_are_decoded_and_their_numbers_plotted() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let shown = watch.events("gate=sensor.measurements").next("gate");
    let field = shown["fields"][0].as_str().unwrap().to_owned();
    assert!(shown["text"].as_str().unwrap().contains(&field), "{shown}");
    let mut events = watch.events(&format!("gate=sensor.measurements&field={field}"));
    while events.next("gate")["points"].as_array().unwrap().is_empty() {}
    let calls = watch.events("gate=controller.commands").next("gate");
    assert!(["request", "reply"].contains(&calls["calls"][0]["kind"].as_str().unwrap()), "{calls}");
}

#[test]
fn a_gate_without_messages_is_explained() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let shown = watch.events("gate=sensor.measurement").next("gate");
    assert!(shown["error"].as_str().unwrap().contains("`measurement`"), "{shown}");
    let answer = watch.get("/events?gate=sensor.measurements&field=a..b");
    assert_eq!(answer.status, 400);
    assert!(!answer.text().is_empty());
}

#[test]
fn only_the_whole_address_gives_access() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let status = |method: &str, target: &str, host: &str| request(&watch.address, method, target, host, "").status;
    let right = format!("/?token={}", watch.token);
    assert_eq!(status("GET", &right, &watch.address), 200);
    assert_eq!(status("GET", "/", &watch.address), 403);
    assert_eq!(status("GET", "/?token=0", &watch.address), 403);
    assert_eq!(status("GET", &right, "rebound.example"), 421);
    assert_eq!(status("POST", &right, &watch.address), 405);
    assert_eq!(status("GET", &format!("/other{}", &right[1..]), &watch.address), 404);
    assert_eq!(status("GET", "/events", &watch.address), 403);
}

#[test]
fn the_page_runs_only_its_own_script_and_loads_nothing_from_elsewhere() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let answer = watch.get("/");
    let policy = answer.headers.iter().find(|line| line.starts_with("content-security-policy:")).unwrap().clone();
    let nonce = policy.split_once("'nonce-").unwrap().1.split_once('\'').unwrap().0.to_owned();
    assert!(policy.contains("default-src 'none'") && policy.contains("connect-src 'self'"), "{policy}");
    assert!(!answer.headers.iter().any(|line| line.starts_with("access-control")));
    let page = answer.text();
    assert_eq!(page.matches("<script").count(), 1);
    assert!(page.contains(&format!("<script nonce=\"{nonce}\">")));
    assert!(!page.contains("http://") && !page.contains("https://"));
}

#[test]
fn pages_beyond_the_limit_are_refused_until_others_close() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let mut pages: Vec<Events> = (0..100).map(|_| watch.events("view=0")).collect();
    let answer = watch.get("/events?view=0");
    assert_eq!(answer.status, 503);
    assert!(answer.text().contains("too many pages"));
    // The first page still gets what changes.
    pages[0].next("state");
    pages[0].next("state");
    pages.truncate(50);
    while watch.get("/events?view=0").status != 200 {}
}

#[test]
fn a_component_with_500_gates_is_drawn() {
    let gates: String = (0..500).map(|number| format!("      - g{number}: pub\n")).collect();
    let rover = Rover::of(&format!("system: many\ncomponents:\n  - name: hub\n    gates:\n{gates}connections: []\n"));
    let watch = Watch::start(rover.scl(&["watch", "--system", "many"]));
    let mut page = Page::open(&watch);
    page.wait_until(|page| page.known.contains_key("picture"));
    let picture = page.known["picture"].as_str().unwrap();
    assert_eq!(picture.matches("data-gate=\"hub.g").count(), 500);
}

#[test]
fn a_still_picture_shows_this_moment() {
    let rover = Rover::start();
    let picture = rover.text(&["watch", "--svg"]);
    let block = |component: &str| {
        let (before, _) = picture.split_once(&format!("\" data-component=\"{component}\"")).unwrap();
        before.rsplit_once("<g class=\"block ").unwrap().1.split_once('"').unwrap().0.to_owned()
    };
    assert_eq!(block("sensor"), "state-running");
    assert_eq!(block("actuator"), "state-stopped");
}

#[test]
fn a_port_in_use_is_explained() {
    let rover = Rover::start();
    let watch = Watch::start(rover.scl(&["watch"]));
    let port = watch.address.rsplit_once(':').unwrap().1;
    let error = rover.error(&["watch", "--port", port], 2);
    assert!(error.contains(&format!("cannot listen at 127.0.0.1:{port}")), "{error}");
    assert!(error.contains("= help: choose another port"), "{error}");
}
