//! Plays the sink of `six_kinds.yaml` with `#[scl::main]` and waits until it is stopped.

use scl_tests::say;

scl::topology!("topologies/six_kinds.yaml", only = [sink]);

#[scl::main]
async fn main(_sink: Sink) -> scl::Result<()> {
    say("open");
    std::future::pending().await
}
