//! Bad input at every listening and every dialling end of a program.
//!
//! Each attack hits all ends of the twin `left`. During and after it, `left` stays idle and its memory bounded, and
//! then exchanges messages of every kind with a good peer.

mod attacks;
mod end;
mod witness;

use end::End;
use witness::{withstands, withstands_with_descriptors};

#[test]
fn random_bytes_before_a_greeting() {
    withstands(attacks::random_bytes);
}

#[test]
fn random_bytes_after_a_handshake() {
    withstands(attacks::random_bytes_after_a_handshake);
}

#[test]
fn random_small_frames_after_a_handshake() {
    withstands(attacks::random_small_frames);
}

#[test]
fn greetings_that_arrive_byte_by_byte() {
    withstands(attacks::slow_greeting);
}

#[test]
fn greetings_that_stop_half_way() {
    withstands(attacks::half_a_greeting);
}

#[test]
fn everything_in_one_write() {
    withstands(attacks::everything_at_once);
}

#[test]
fn frames_from_16_gib_to_2_to_the_64() {
    withstands(attacks::enormous_frames);
}

#[test]
fn enormous_frames_in_place_of_ready() {
    withstands(attacks::enormous_ready);
}

#[test]
fn one_byte_more_than_the_limit() {
    withstands(attacks::one_byte_too_long);
}

#[test]
fn a_frame_that_never_ends() {
    withstands(attacks::unfinished_frame);
}

#[test]
fn a_message_that_never_ends() {
    withstands(attacks::endless_message);
}

#[test]
fn malformed_ready_commands() {
    withstands(attacks::malformed_ready);
}

#[test]
fn malformed_and_unknown_commands() {
    withstands(attacks::odd_commands);
}

#[test]
fn thousands_of_peers_that_break_off_after_the_handshake() {
    withstands(attacks::breaking_off);
}

#[test]
fn heartbeats_whose_answers_are_read() {
    withstands(attacks::heartbeats);
}

#[test]
fn heartbeats_whose_answers_are_not_read() {
    withstands(attacks::heartbeats_without_reading);
}

#[test]
fn other_protocols() {
    withstands(attacks::other_protocols_and_versions);
}

#[test]
fn wrong_mechanisms_and_socket_types() {
    withstands(attacks::wrong_mechanisms_and_types);
}

#[test]
fn a_million_subscriptions() {
    withstands(attacks::a_million_subscriptions);
}

#[test]
fn an_impostor_that_misuses_the_extension() {
    withstands(attacks::misused_extension);
}

#[test]
fn ten_thousand_silent_connections() {
    withstands_with_descriptors(256, false, |end| {
        attacks::silent_connections(end, if end.name == End::CROWDED { 10_000 } else { 500 })
    });
}

#[test]
fn ten_thousand_silent_connections_after_a_handshake() {
    withstands_with_descriptors(256, true, |end| {
        attacks::silent_connections_after_a_handshake(end, if end.name == End::CROWDED { 10_000 } else { 500 })
    });
}

/// The promise: connections of one gate that use up all descriptors do not keep the others from their peers.
#[test]
fn as_many_connections_as_there_are_descriptors() {
    withstands_with_descriptors(256, true, attacks::all_descriptors);
}
