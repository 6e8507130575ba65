//! Generated C at work: programs of two processes, and a peer that sends what is not a message.

use crate::c::Project;
use crate::fixture::{system, topology};
use rustix::process::Signal;
use scl::untyped::Component;
use scl_tests::{Compile, Process, System};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The program `kinds`, which fails if it leaks memory or reads a byte too far.
fn kinds(project: &Project) -> PathBuf {
    let program = project.path().join("kinds");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs/kinds.c");
    let generated = ["every_kind_scl.c", "every_kind.pb-c.c", "parts/part.pb-c.c"];
    let compile = Compile::c(source).option(format!("-I{}", project.path().display()));
    let compile = generated.iter().fold(compile, |compile, name| compile.source(project.path().join(name)));
    let options = ["-fsanitize=address,undefined", "-lprotobuf-c"];
    options.into_iter().fold(compile, Compile::option).program(&program);
    program
}

fn start(system: &System, program: &Path, component: &str) -> Process {
    system.start(program.to_str().unwrap(), &[component])
}

#[test]
fn two_programs_in_c_use_every_kind_of_gate() {
    let project = Project::of(&topology("every_kind.yaml"));
    let program = kinds(&project);
    let system = System::new();
    let mut right = start(&system, &program, "right");
    right.expect("open");
    let mut left = start(&system, &program, "left");
    for line in ["answer 1", "raw answer question", "json answer {\"state\":\"SOUND\"}"] {
        left.expect(line);
    }
    left.expect("the `Kinds__Value` to send is NULL");
    left.expect("the `Kinds__Value` to send is not initialized; assign its __INIT macro first");
    assert_eq!(left.wait_for_exit().code(), 0);
    let mut received: Vec<String> = (0..6).map(|_| right.next_line()).collect();
    received.sort();
    let expected = ["bytes job", "bytes raw", "part 48.5", "question 42", "raw question question", "value 42 1999"];
    assert_eq!(received, expected);
    right.signal(Signal::TERM);
    let exit = right.wait_for_exit();
    assert_eq!(exit.code(), 0, "{}", exit.text());
}

#[test]
fn what_is_not_a_message_is_told_with_names_and_counted() {
    let path = topology("every_kind.yaml");
    let project = Project::of(&path);
    let program = kinds(&project);
    let meeting = System::new();
    let mut right = start(&meeting, &program, "right");
    right.expect("open");
    let system = system(&path);
    let mut left = Component::open_blocking_with(&system.components[0].plan, meeting.options()).unwrap();
    let mut values = left.publisher("values").unwrap();
    left.ready_blocking(Duration::from_secs(300)).unwrap();
    values.send_blocking(&b"\xff\xff\xff".as_slice().into()).unwrap();
    right.expect(
        "gate `right-side.values` received an undecodable message from `left.values`: codec `protobuf` cannot decode \
         this message: it is not a `kinds.Value`",
    );
    right.expect("1 rejected");
    values.send_blocking(&b"\x08\x07".as_slice().into()).unwrap();
    right.expect("value 7 0");
}

/// protobuf-c itself would overflow the stack.
#[test]
fn deeply_nested_messages_are_undecodable() {
    let path = topology("every_kind.yaml");
    let project = Project::of(&path);
    let program = kinds(&project);
    let meeting = System::new();
    let mut right = start(&meeting, &program, "right");
    right.expect("open");
    let system = system(&path);
    let mut left = Component::open_blocking_with(&system.components[0].plan, meeting.options()).unwrap();
    let mut trees = left.pusher("trees").unwrap();
    left.ready_blocking(Duration::from_secs(300)).unwrap();
    let mut send = |bytes: Vec<u8>| trees.send_blocking(&bytes.into()).unwrap();
    send(nested(100));
    right.expect("tree 7 1");
    for depth in [101, 100_000] {
        send(nested(depth));
        right.expect("tree SCL_DECODE");
    }
    // Every wire type, an unknown field, and an entry of the map.
    send(vec![0x28, 7, 0x1d, 1, 2, 3, 4, 0x21, 1, 2, 3, 4, 5, 6, 7, 8, 0x7a, 1, 0xff, 0x12, 2, 0x0a, 0, 0x0a, 0]);
    right.expect("tree 7 1");
    for damaged in [&[0x0a, 2, 0x28][..], &[0x0a, 0xff], &[0x1d, 1], &[0x0b], &[0xff; 12]] {
        send(damaged.to_vec());
        right.expect("tree SCL_DECODE");
    }
}

/// A `Tree` with the number 7, in which trees are nested; it counts as 1 itself.
fn nested(depth: usize) -> Vec<u8> {
    let mut from_inside = Vec::new();
    for _ in 1..depth {
        // Written from its end, so that it takes linear time.
        from_inside.extend(varint(from_inside.len()).into_iter().rev());
        from_inside.push(0x0a);
    }
    from_inside.reverse();
    from_inside.extend([0x28, 7]);
    from_inside
}

fn varint(mut number: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    while number > 0x7f {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
    bytes
}
