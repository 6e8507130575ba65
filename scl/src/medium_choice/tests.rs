//! Texts that are understood or refused, and which medium a connection gets.

use super::*;
use crate::spec::{GateKind, WhenFull};
use scl_plan::GateOptions;

const fn link(peer_component: &'static str, peer_gate: &'static str) -> LinkSpec {
    LinkSpec {
        peer_component,
        peer_gate,
        endpoint: "endpoint",
        contract: "00000000",
        required: true,
        queue: 10,
        when_full: WhenFull::DropOldest,
        max_size: 1 << 20,
    }
}

fn gate(name: &'static str, kind: GateKind, links: &'static [LinkSpec]) -> GateSpec {
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
        links,
    }
}

const FRAMES: &[LinkSpec] = &[link("viewer", "frames"), link("logger", "frames")];
const JOBS: &[LinkSpec] = &[link("viewer", "jobs"), link("logger", "jobs")];

fn camera() -> ComponentSpec {
    let gates = vec![gate("frames", GateKind::Pub, FRAMES), gate("jobs", GateKind::Pull, JOBS)];
    ComponentSpec {
        system: "rover",
        name: "camera",
        declared_at: "rover.yaml:1:1",
        gates: Box::leak(gates.into_boxed_slice()),
        schema: None,
    }
}

#[test]
fn texts_are_understood_or_refused_with_their_wrong_part() {
    let gates = |default, gates: &[(&str, Medium)]| {
        let of_gates = gates.iter().map(|(gate, medium)| ((*gate).to_owned(), *medium)).collect();
        Ok(MediumChoice { default, of_gates })
    };
    let cases = [
        ("ipc", gates(Medium::Ipc, &[])),
        ("shm", gates(Medium::Shm, &[])),
        ("tcp,camera.frames=shm", gates(Medium::Tcp, &[("camera.frames", Medium::Shm)])),
        (" ipc , a.b = shm,c.d=tcp", gates(Medium::Ipc, &[("a.b", Medium::Shm), ("c.d", Medium::Tcp)])),
        ("a.b=shm", gates(Medium::Ipc, &[("a.b", Medium::Shm)])),
        ("udp", Err("udp")),
        ("", Err("")),
        ("IPC", Err("IPC")),
        ("ipc,", Err("")),
        ("ipc,tcp", Err("tcp")),
        ("a.b=shm,tcp", Err("tcp")),
        ("ipc,a.b=udp", Err("a.b=udp")),
        ("ipc,a=shm", Err("a=shm")),
        ("ipc,a.b.c=shm", Err("a.b.c=shm")),
        ("ipc,.b=shm", Err(".b=shm")),
        ("ipc,a.=shm", Err("a.=shm")),
        ("ipc,a.b=shm=tcp", Err("a.b=shm=tcp")),
    ];
    for (text, expected) in cases {
        let found = text.parse::<MediumChoice>();
        let expected = expected.map_err(|part| MediumError { part: part.to_owned() });
        assert_eq!(found, expected, "{text}");
    }
    let error = "ipc,a=shm".parse::<MediumChoice>().unwrap_err().to_string();
    assert_eq!(error, format!("`a=shm` is not understood; expected {}", MediumChoice::EXPECTED));
}

#[test]
fn the_last_exception_for_either_end_counts() {
    let camera = camera();
    // The media of the connections to `viewer.frames` and `logger.frames`, of their tap, and of the `pull` gate and its tap.
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
        let choice: MediumChoice = text.parse().unwrap();
        let links = frames.links.iter().map(|link| choice.of_link(&camera, frames, link));
        let others = [choice.of_tap(&camera, frames), choice.of_gate(&camera, jobs), choice.of_tap(&camera, jobs)];
        let found: Vec<&str> = links.chain(others).map(Medium::word).collect();
        assert_eq!(found.join(" "), expected, "{text}");
    }
}

#[test]
fn gates_that_the_component_does_not_have_are_refused() {
    let refused =
        |text: &str| text.parse::<MediumChoice>().unwrap().check(&camera()).err().map(|error| error.to_string());
    for known in ["shm", "ipc,camera.frames=shm,camera.jobs=tcp", "ipc,viewer.other=shm,stranger.frames=shm"] {
        assert_eq!(refused(known), None, "{known}");
    }
    let text = "component `camera` has no gate `frame`, for which a transport is chosen (`camera.frame=shm`); \
                did you mean `frames`?";
    assert_eq!(refused("ipc,camera.jobs=tcp,camera.frame=shm").as_deref(), Some(text));
    let text = "component `camera` has no gate `x`, for which a transport is chosen (`camera.x=tcp`)";
    assert_eq!(refused("camera.x=tcp").as_deref(), Some(text));
}
