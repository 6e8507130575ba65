//! Names of the standard library mean something else where the macro is called.
#![allow(dead_code, non_camel_case_types)]
#![allow(deprecated, reason = "the file has a component without gates, on purpose")]

mod core {}
mod std {}
mod scl {}
mod prost {}

struct Result;
struct Option;
struct Vec;
struct String;
struct Ok;
struct Err;
struct Some;
struct Default;
struct Duration;
struct Bytes;
struct Message;
trait Sized {}
trait Component {}
trait Codec {}

wires::topology!("rover.yaml");

#[test]
fn structs_have_their_gates() {
    fn gates(controller: &Controller) -> usize {
        wires::Component::gates(controller).len()
    }
    assert_eq!(<Controller as wires::Component>::SPEC.gates.len(), 5);
    let _ = gates;
}
