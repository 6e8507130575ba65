//! Plays the sink of `six_kinds.yaml` with `#[scl::main]`: says that it runs, and waits to be ended.

use scl_tests::say;

scl::topology!("six_kinds.yaml", only = [sink]);

#[scl::main]
async fn main(_sink: Sink) -> scl::Result<()> {
    say("open");
    std::future::pending().await
}
