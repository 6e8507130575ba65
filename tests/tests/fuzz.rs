//! The fuzz targets over generated input. What fuzzing finds becomes a case in `fuzz_round`.

use crate::programs::FUZZ_ROUND;
use scl_tests::Process;

#[test]
fn no_frame_harms_a_codec() {
    run("codecs");
}

#[test]
fn no_stranger_harms_an_end() {
    run("frames");
}

#[test]
fn the_decoder_reserves_memory_only_for_what_has_arrived() {
    run("decoder");
}

#[test]
fn a_component_opens_in_any_folder_or_names_the_obstacle() {
    run("runtime_folder");
}

fn run(target: &str) {
    let mut round = Process::start(FUZZ_ROUND, &[target], &[]);
    round.expect("done");
    assert!(round.wait_for_exit().status.success());
}
