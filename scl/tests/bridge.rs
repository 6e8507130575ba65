//! Components of another host in this host's runtime folder, and the components that run here.
#![allow(clippy::unwrap_used)]

use crate::untyped::plan;
use bytes::Bytes;
use scl::bridge::{Change, Mirror, MirrorError, Presence, Profile};
use scl::plan::Plan;
use scl::runtime_dir::{Announcement, RuntimeDir, SystemDir};
use scl::transport::zeromq::ZeroMq;
use scl::transport::{Link, Peer, PeerKind, Transport, Window};
use scl::untyped::Component;
use scl::{OpenOptions, TransportKind};
use std::collections::VecDeque;
use std::future::poll_fn;
use std::path::Path;
use std::task::Poll;
use std::time::Duration;
use tempfile::TempDir;

const LONG: Duration = Duration::from_secs(300);
const WINDOW: Window = Window { messages: 4, bytes: 1 << 18 };

/// One host: a runtime folder.
struct Host {
    folder: TempDir,
    dir: SystemDir,
}

impl Host {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let dir = system_dir(folder.path());
        Self { folder, dir }
    }

    async fn open(&self, plan: &Plan) -> Component {
        Component::open_with(plan, OpenOptions::new().runtime_dir(self.folder.path())).await.unwrap()
    }

    fn mirror(&self, component: &str, profile: &Profile) -> Result<Mirror, MirrorError> {
        Mirror::open(&self.dir, component, "board", profile)
    }

    fn transport(&self) -> ZeroMq {
        ZeroMq::new(self.dir.clone(), TransportKind::Ipc)
    }
}

fn system_dir(folder: &Path) -> SystemDir {
    let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.into());
    RuntimeDir::locate(&variable).unwrap().system("untyped").unwrap()
}

/// What a component says of itself on its host, after the way to another one.
async fn profile(plan: &Plan) -> Profile {
    let host = Host::new();
    let _component = host.open(plan).await;
    Profile::from_bytes(Profile::read(&host.dir, &plan.component).unwrap().to_bytes()).unwrap()
}

#[tokio::test]
async fn a_component_talks_with_a_mirror_as_with_its_peer() {
    let host = Host::new();
    let mut controller = host.open(&plan("controller")).await;
    let error = controller.ready(Duration::ZERO).await.unwrap_err().to_string();
    assert!(error.contains("`sensor.measurements`") && error.contains("is not running"), "{error}");

    let mirror = host.mirror("sensor", &profile(&plan("sensor")).await).unwrap();
    let announcement = Announcement::read(&host.dir, "sensor").unwrap();
    assert_eq!(announcement.host.as_deref(), Some("board"));
    assert_eq!(
        (announcement.pid, announcement.plan),
        (std::process::id(), Some(Plan { schema: None, ..plan("sensor") }))
    );
    let error = controller.ready(Duration::ZERO).await.unwrap_err().to_string();
    assert!(error.contains("is running on host `board` but not connected"), "{error}");

    let transport = host.transport();
    let endpoint = mirror.publishing("measurements", ("controller", "sensor")).unwrap();
    assert!(endpoint.lossless);
    let mut publisher = transport.publish(&endpoint).unwrap();
    let Peer { kind, mut link } = poll_fn(|cx| publisher.poll_peer(cx)).await;
    assert_eq!(kind, PeerKind::Component);
    let mut queue: VecDeque<_> = [Bytes::from_static(b"[1.0]").into()].into();
    let mut subscriber = controller.subscriber("sensor").unwrap();
    let received = tokio::select! {
        received = subscriber.recv() => received.unwrap(),
        () = drive(&mut *link, &mut queue) => unreachable!(),
    };
    assert_eq!(received, "[1.0]");
}

#[tokio::test]
async fn what_a_component_pushes_is_acknowledged_by_the_caller() {
    let host = Host::new();
    let mut sensor = host.open(&plan("sensor")).await;
    let mirror = host.mirror("controller", &profile(&plan("controller")).await).unwrap();
    let mut puller = host.transport().pull(&mirror.pulling("work", WINDOW).unwrap()).unwrap();
    let mut pusher = sensor.pusher("work").unwrap();
    pusher.send(&Bytes::from_static(b"[3.0]")).await.unwrap();
    assert_eq!(poll_fn(|cx| puller.poll_recv(cx)).await, "[3.0]");
    assert_eq!(pusher.peer_stats()[0].taken, 0, "not acknowledged yet");
    puller.acknowledge(1);
    poll_fn(|cx| {
        assert!(puller.poll_recv(cx).is_pending());
        cx.waker().wake_by_ref();
        if pusher.peer_stats()[0].taken == 1 { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
}

#[tokio::test]
async fn only_what_a_component_was_built_with_can_be_opened() {
    let host = Host::new();
    let mirror = host.mirror("sensor", &profile(&plan("sensor")).await).unwrap();
    let missing = mirror.publishing("raw", ("nobody", "raw")).unwrap_err();
    let expected = "component `sensor` was built without a connection of `raw` to `nobody.raw`; build all programs from \
                    the same topology";
    assert_eq!(missing.to_string(), expected);
    let missing = mirror.pulling("nothing", WINDOW).unwrap_err();
    assert!(missing.to_string().contains("was built without gate `nothing`"), "{missing}");
    assert!(mirror.replying("calibrate").is_ok());
    // The lock keeps the component from running twice.
    let open = Component::open_with(&plan("sensor"), OpenOptions::new().runtime_dir(host.folder.path())).await;
    let error = open.err().unwrap();
    let refused = std::error::Error::source(&error).unwrap().to_string();
    assert!(refused.starts_with("component `sensor` is already running in this process"), "{refused}");
}

async fn drive(link: &mut dyn Link, queue: &mut VecDeque<scl::transport::Frame>) {
    poll_fn(|cx| {
        let driven = link.drive(cx).unwrap();
        link.send_all(cx, Some(driven), queue, &mut |_| {});
        Poll::Pending
    })
    .await
}

#[tokio::test]
async fn a_component_that_runs_here_is_not_shown_as_one_of_another_host() {
    let (host, profile) = (Host::new(), profile(&plan("sensor")).await);
    let sensor = host.open(&plan("sensor")).await;
    let error = host.mirror("sensor", &profile).unwrap_err();
    assert!(matches!(error, MirrorError::RunsHere { .. }), "{error}");
    assert!(error.to_string().starts_with("component `sensor` runs on host `board`, and on this host as well"));
    drop(sensor);
    host.mirror("sensor", &profile).unwrap();
    let error = host.mirror("controller", &profile).unwrap_err();
    assert_eq!(error.to_string(), "host `board` announces component `controller` with the plan of `sensor`");
}

#[tokio::test]
async fn ready_explains_a_contract_that_differs_across_hosts() {
    let (host, mut other) = (Host::new(), plan("sensor"));
    let gate = other.gates.iter_mut().find(|gate| gate.name == "measurements").unwrap();
    gate.payload = scl::plan::Payload::Message("Other".to_owned());
    gate.contract = "zzzzzzzz".to_owned();
    for connection in &mut gate.connections {
        connection.endpoint = connection.endpoint.replace(&connection.contract, "zzzzzzzz");
        connection.contract = "zzzzzzzz".to_owned();
    }
    let _mirror = host.mirror("sensor", &profile(&other).await).unwrap();
    let controller = host.open(&plan("controller")).await;
    let error = controller.ready(Duration::ZERO).await.unwrap_err().to_string();
    let expected = "is running on host `board` but was built with type `Other` and codec `json`, this program expects \
                    `Values` and `json`";
    assert!(error.contains(expected), "{error}");
}

#[tokio::test]
async fn a_mirror_is_restored_when_the_folder_is_removed() {
    let (host, profile) = (Host::new(), profile(&plan("sensor")).await);
    let mirror = host.mirror("sensor", &profile).unwrap();
    let endpoint = mirror.publishing("raw", ("controller", "raw")).unwrap();
    let mut publisher = host.transport().publish(&endpoint).unwrap();
    let mut presence = Presence::new(host.dir.clone(), []);
    assert_eq!(presence.next().await, Change::Removed, "before the watch began");
    let mut subscriber = host.transport().subscribe(&scl::transport::Endpoint::new(endpoint.name.clone())).unwrap();
    let announcement = host.dir.folder().join("sensor.json");
    let removals: [&dyn Fn(); 2] =
        [&|| std::fs::remove_file(&announcement).unwrap(), &|| std::fs::remove_dir_all(host.dir.folder()).unwrap()];
    for remove in removals {
        remove();
        assert_eq!(presence.next().await, Change::Removed);
        mirror.restore().unwrap();
        assert!(announcement.exists());
    }
    // Its end listens again.
    poll_fn(|cx| {
        assert!(subscriber.poll_recv(cx).is_pending());
        publisher.poll_peer(cx)
    })
    .await;
    assert_eq!(Announcement::read(&host.dir, "sensor").unwrap().host.as_deref(), Some("board"));
    drop(mirror);
    assert_eq!(Announcement::read(&host.dir, "sensor"), None);
}

#[tokio::test]
async fn components_that_start_and_stop_are_reported() {
    let host = Host::new();
    let mut presence = Presence::new(host.dir.clone(), ["sensor".to_owned(), "controller".to_owned()]);
    let sensor = host.open(&plan("sensor")).await;
    assert_eq!(started(&mut presence).await, "sensor");
    let controller = host.open(&plan("controller")).await;
    assert_eq!(started(&mut presence).await, "controller");
    drop(sensor);
    assert_eq!(next(&mut presence).await, Change::Stopped { component: "sensor".to_owned() });
    // Neither one that is not watched nor a component of another host.
    let _logger = host.open(&plan("logger")).await;
    let mirror = host.mirror("sensor", &profile(&plan("sensor")).await).unwrap();
    drop(controller);
    assert_eq!(next(&mut presence).await, Change::Stopped { component: "controller".to_owned() });
    drop(mirror);
    // A quick restart is two changes.
    let sensor = host.open(&plan("sensor")).await;
    assert_eq!(started(&mut presence).await, "sensor");
    drop(sensor);
    let _sensor = host.open(&plan("sensor")).await;
    assert_eq!(next(&mut presence).await, Change::Stopped { component: "sensor".to_owned() });
    assert_eq!(started(&mut presence).await, "sensor");
}

/// The next change of components that run here.
async fn next(presence: &mut Presence) -> Change {
    loop {
        let change = tokio::time::timeout(LONG, presence.next()).await.unwrap();
        if change != Change::Removed {
            return change;
        }
    }
}

async fn started(presence: &mut Presence) -> String {
    let change = next(presence).await;
    let Change::Started { component, profile } = change else { panic!("{change:?}") };
    assert_eq!(profile.announcement().component, component);
    component
}

#[test]
fn a_killed_process_is_noticed() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        return run_until_killed(Path::new(&folder));
    }
    let host = Host::new();
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    runtime.block_on(async {
        let mut presence = Presence::new(host.dir.clone(), ["sensor".to_owned()]);
        for _ in 0..3 {
            let mut process = std::process::Command::new(std::env::current_exe().unwrap())
                .args(["--exact", "bridge::a_killed_process_is_noticed", "--nocapture"])
                .env(FOLDER, host.folder.path())
                .stdin(std::process::Stdio::piped())
                .spawn()
                .unwrap();
            assert_eq!(started(&mut presence).await, "sensor");
            process.kill().unwrap();
            process.wait().unwrap();
            assert_eq!(next(&mut presence).await, Change::Stopped { component: "sensor".to_owned() });
        }
    });
}

const FOLDER: &str = "SCL_TEST_BRIDGE_FOLDER";

fn run_until_killed(folder: &Path) {
    let options = OpenOptions::new().runtime_dir(folder);
    let _sensor = Component::open_blocking_with(&plan("sensor"), options).unwrap();
    // Until the test kills this process, or ends itself.
    std::io::stdin().lines().for_each(drop);
}
