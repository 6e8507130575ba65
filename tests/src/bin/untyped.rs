//! Plays `sensor` or `viewer` of a topology in `topologies/shapes` without generated code:
//! `untyped PLAN_FILE COMPONENT`.

use scl::plan::SystemPlan;
use scl::untyped::Component;
use scl_tests::{Commands, say, say_error, say_result};
use std::process::ExitCode;
use std::time::Duration;

/// What is in the bytes, of which only this program knows.
#[derive(Clone, PartialEq, prost::Message)]
struct Position {
    #[prost(double, tag = "1")]
    lat: f64,
    #[prost(double, tag = "2")]
    lon: f64,
}

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    match play().await {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say_error(error);
            ExitCode::FAILURE
        }
    }
}

async fn play() -> scl::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let (file, name) = (arguments.next().unwrap_or_default(), arguments.next().unwrap_or_default());
    let system = SystemPlan::from_json(&std::fs::read_to_string(file)?)?;
    let component = Component::open(system.component(&name)?).await?;
    say("open");
    if name == "sensor" { play_sensor(component).await } else { play_viewer(component).await }
}

async fn play_sensor(mut sensor: Component) -> scl::Result<()> {
    let mut position = sensor.publisher("position")?;
    let mut jobs = sensor.pusher("jobs")?;
    let mut question = sensor.requester("question")?;
    let bytes = prost::Message::encode_to_vec(&Position { lat: 52.5, lon: 13.4 }).into();
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        match words[0].as_str() {
            "ready" => say_result(sensor.ready(timeout(&words)).await, |()| "ready".to_owned()),
            "publish" => say_result(position.send(&bytes).await, |()| "published".to_owned()),
            "push" => say_result(jobs.send(&bytes).await, |()| "pushed".to_owned()),
            _ => say_result(question.call(&bytes).await, shown),
        }
    }
    Ok(())
}

async fn play_viewer(mut viewer: Component) -> scl::Result<()> {
    let mut position = viewer.subscriber("position")?;
    let mut jobs = viewer.puller("jobs")?;
    let mut questions = viewer.replier("answer")?;
    let mut commands = Commands::listen();
    while let Some(words) = commands.next().await {
        match words[0].as_str() {
            "ready" => say_result(viewer.ready(timeout(&words)).await, |()| "ready".to_owned()),
            "receive" => say_result(position.recv().await, shown),
            "pull" => say_result(jobs.recv().await, shown),
            _ => {
                let request = questions.recv().await?;
                let echo = request.message().clone();
                say_result(request.reply(&echo), |()| "served".to_owned());
            }
        }
    }
    Ok(())
}

/// The milliseconds of `ready MILLISECONDS`.
fn timeout(words: &[String]) -> Duration {
    Duration::from_millis(words[1].parse().unwrap_or_default())
}

fn shown(bytes: scl::bytes::Bytes) -> String {
    match <Position as prost::Message>::decode(bytes) {
        Ok(position) => format!("{} {}", position.lat, position.lon),
        Err(error) => error.to_string(),
    }
}
