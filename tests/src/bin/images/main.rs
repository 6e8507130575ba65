//! Plays a component of `images.yaml` and follows commands: `images camera`, `images viewer` or `images worker`.

mod camera;
mod order;
mod picture;
mod viewer;
mod worker;

use picture::Picture;
use scl_tests::say_error;
use std::process::ExitCode;

scl::topology!("topologies/images.yaml");

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    if let Err(error) = scl::host::start_log() {
        say_error(error);
    }
    let result = match std::env::args().nth(1).unwrap_or_default().as_str() {
        "camera" => camera::play().await,
        "viewer" => viewer::play().await,
        "worker" => worker::play().await,
        other => Err(scl::Error::message(format!("there is no component `{other}`"))),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Also for tests that read no more answers.
            eprintln!("{error:?}");
            say_error(error);
            ExitCode::FAILURE
        }
    }
}
