//! Texts that are understood or refused, and which transport a connection gets.

use super::*;
use crate::spec::{GateKind, WhenFull};
use scl_plan::GateOptions;

const fn connection(peer_component: &'static str, peer_gate: &'static str) -> ConnectionSpec {
    ConnectionSpec {
        peer_component,
        peer_gate,
        endpoint: "endpoint",
        contract: "00000000",
        required: true,
        queue: 10,
        when_full: WhenFull::DropOldest,
        max_size: 1 << 20,
        max_age: None,
    }
}

fn gate(name: &'static str, kind: GateKind, connections: &'static [ConnectionSpec]) -> GateSpec {
    GateSpec {
        name,
        kind,
        payload: "bytes",
        codec: "raw",
        declared_at: "rover.yaml:1:1",
        endpoint: "",
        tap: "tap",
        contract: "00000000",
        options: GateOptions::default(),
        connections,
    }
}

const FRAMES: &[ConnectionSpec] = &[connection("viewer", "frames"), connection("logger", "frames")];
const JOBS: &[ConnectionSpec] = &[connection("viewer", "jobs"), connection("logger", "jobs")];

fn camera() -> ComponentSpec {
    let gates = vec![gate("frames", GateKind::Pub, FRAMES), gate("jobs", GateKind::Pull, JOBS)];
    ComponentSpec {
        system: "rover",
        name: "camera",
        declared_at: "rover.yaml:1:1",
        parameters: &[],
        gates: Box::leak(gates.into_boxed_slice()),
        schema: None,
    }
}

#[test]
fn texts_are_understood_or_refused_with_their_wrong_part() {
    let gates = |default, gates: &[(&str, TransportKind)]| {
        let of_gates = gates.iter().map(|(gate, kind)| ((*gate).to_owned(), *kind)).collect();
        Ok(TransportChoice { default, of_gates })
    };
    let cases = [
        ("ipc", gates(TransportKind::Ipc, &[])),
        ("shm", gates(TransportKind::Shm, &[])),
        ("tcp,camera.frames=shm", gates(TransportKind::Tcp, &[("camera.frames", TransportKind::Shm)])),
        (
            " ipc , a.b = shm,c.d=tcp",
            gates(TransportKind::Ipc, &[("a.b", TransportKind::Shm), ("c.d", TransportKind::Tcp)]),
        ),
        ("a.b=shm", gates(TransportKind::Ipc, &[("a.b", TransportKind::Shm)])),
        ("a.b.c=shm", gates(TransportKind::Ipc, &[("a.b.c", TransportKind::Shm)])),
        ("udp", Err("udp")),
        ("", Err("")),
        ("IPC", Err("IPC")),
        ("ipc,", Err("")),
        ("ipc,tcp", Err("tcp")),
        ("a.b=shm,tcp", Err("tcp")),
        ("ipc,a.b=udp", Err("a.b=udp")),
        ("ipc,a=shm", Err("a=shm")),
        ("ipc,a..c=shm", Err("a..c=shm")),
        ("ipc,.b=shm", Err(".b=shm")),
        ("ipc,a.=shm", Err("a.=shm")),
        ("ipc,a.b=shm=tcp", Err("a.b=shm=tcp")),
    ];
    for (text, expected) in cases {
        let found = text.parse::<TransportChoice>();
        let expected = expected.map_err(|part| TransportChoiceError { part: part.to_owned() });
        assert_eq!(found, expected, "{text}");
    }
    let error = "ipc,a=shm".parse::<TransportChoice>().unwrap_err().to_string();
    assert_eq!(error, format!("`a=shm` is not understood; expected {}", TransportChoice::expected()));
}

#[test]
fn the_last_exception_for_either_end_counts() {
    let camera = camera();
    // The transports of the connections to `viewer.frames` and `logger.frames`, of their tap, and of the `pull` gate
    // and its tap.
    let cases = [
        ("tcp", "tcp tcp tcp tcp tcp"),
        ("ipc,camera.frames=shm", "shm shm shm ipc ipc"),
        ("ipc,viewer.frames=shm", "shm ipc ipc ipc ipc"),
        ("ipc,camera.frames=shm,logger.frames=tcp", "shm tcp shm ipc ipc"),
        ("ipc,logger.frames=tcp,camera.frames=shm", "shm shm shm ipc ipc"),
        ("shm,camera.jobs=ipc", "shm shm shm ipc ipc"),
        ("ipc,logger.jobs=shm", "ipc ipc ipc shm ipc"),
        ("ipc,logger.other=shm,stranger.frames=tcp", "ipc ipc ipc ipc ipc"),
    ];
    let [frames, jobs] = camera.gates else { unreachable!("two gates") };
    for (text, expected) in cases {
        let choice: TransportChoice = text.parse().unwrap();
        let connections =
            frames.connections.iter().map(|connection| choice.of(&camera, frames, std::slice::from_ref(connection)));
        let others = [
            choice.of(&camera, frames, &[]),
            choice.of(&camera, jobs, jobs.connections),
            choice.of(&camera, jobs, &[]),
        ];
        let found: Vec<&str> = connections.chain(others).map(TransportKind::word).collect();
        assert_eq!(found.join(" "), expected, "{text}");
    }
}

#[test]
fn gates_that_the_component_does_not_have_are_found() {
    let unknown = |text: &str| {
        let choice: TransportChoice = text.parse().unwrap();
        choice.unknown_gate(&camera()).map(|(gate, kind)| format!("{gate}={}", kind.word()))
    };
    for known in ["shm", "ipc,camera.frames=shm,camera.jobs=tcp", "ipc,viewer.other=shm,stranger.frames=shm"] {
        assert_eq!(unknown(known), None, "{known}");
    }
    assert_eq!(unknown("ipc,camera.jobs=tcp,camera.frame=shm").as_deref(), Some("frame=shm"));
    assert_eq!(unknown("camera.x=tcp").as_deref(), Some("x=tcp"));
}
