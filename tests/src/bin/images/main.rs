//! Plays a component of `images.yaml` and follows commands: `images camera`, `images viewer`, `images keeper` or
//! `images worker`.

mod camera;
mod keeper;
mod order;
mod picture;
mod viewer;
mod worker;

use picture::Picture;
use scl_tests::say_error;
use std::process::ExitCode;
use tokio::runtime::Builder;

scl::topology!("topologies/images.yaml");

fn main() -> ExitCode {
    if let Err(error) = scl::host::start_log() {
        say_error(error);
    }
    let result = match std::env::args().nth(1).unwrap_or_default().as_str() {
        "camera" => run(camera::play()),
        "viewer" => run(viewer::play()),
        "worker" => run(worker::play()),
        "keeper" => keeper::play(),
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

fn run(component: impl Future<Output = scl::Result<()>>) -> scl::Result<()> {
    Builder::new_current_thread().enable_all().build()?.block_on(component)
}
