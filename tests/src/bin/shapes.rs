//! Plays `sensor` or `viewer`, built from one of several schemas: `shapes original|swapped|extended|renamed COMPONENT`.

use scl_tests::{Commands, say, say_result};
use std::process::ExitCode;
use std::time::Duration;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let (variant, component) = (arguments.next().unwrap_or_default(), arguments.next().unwrap_or_default());
    match (variant.as_str(), component.as_str()) {
        ("original", "sensor") => original::sensor::main(),
        ("original", _) => original::viewer::main(),
        ("swapped", "sensor") => swapped::sensor::main(),
        ("swapped", _) => swapped::viewer::main(),
        ("extended", "sensor") => extended::sensor::main(),
        ("extended", _) => extended::viewer::main(),
        (_, "sensor") => renamed::sensor::main(),
        _ => renamed::viewer::main(),
    }
}

/// The milliseconds of `ready MILLISECONDS`.
fn timeout(words: &[String]) -> Duration {
    Duration::from_millis(words[1].parse().unwrap_or_default())
}

/// The two programs of one topology. `#[scl::main]` also sets up the log.
macro_rules! variant {
    ($name:ident, $topology:literal, $message:ident { $($field:ident: $value:literal)? }) => {
        mod $name {
            scl::topology!($topology);

            pub(crate) mod sensor {
                use super::{Sensor, nav::$message};
                use crate::{Commands, say, say_result, timeout};

                #[scl::main]
                pub(crate) async fn main(mut sensor: Sensor) -> scl::Result<()> {
                    say("open");
                    let position = $message { lat: 52.5, lon: 13.4, $($field: $value)? };
                    let mut commands = Commands::listen();
                    while let Some(words) = commands.next().await {
                        match words[0].as_str() {
                            "ready" => say_result(sensor.ready(timeout(&words)).await, |()| "ready".to_owned()),
                            "publish" => say_result(sensor.position.send(&position).await, |()| "published".to_owned()),
                            "push" => say_result(sensor.jobs.send(&position).await, |()| "pushed".to_owned()),
                            _ => say_result(sensor.question.call(&position).await, |p| format!("{} {}", p.lat, p.lon)),
                        }
                    }
                    Ok(())
                }
            }

            pub(crate) mod viewer {
                use super::Viewer;
                use crate::{Commands, say, say_result, timeout};

                #[scl::main]
                pub(crate) async fn main(mut viewer: Viewer) -> scl::Result<()> {
                    say("open");
                    let mut commands = Commands::listen();
                    while let Some(words) = commands.next().await {
                        match words[0].as_str() {
                            "ready" => say_result(viewer.ready(timeout(&words)).await, |()| "ready".to_owned()),
                            "receive" => say_result(viewer.position.recv().await, |p| format!("{} {}", p.lat, p.lon)),
                            "pull" => say_result(viewer.jobs.recv().await, |p| format!("{} {}", p.lat, p.lon)),
                            _ => {
                                let request = viewer.answer.recv().await?;
                                let echo = request.message().clone();
                                say_result(request.reply(&echo), |()| "served".to_owned());
                            }
                        }
                    }
                    Ok(())
                }
            }
        }
    };
}

variant!(original, "topologies/shapes/original.yaml", Position {});
variant!(swapped, "topologies/shapes/swapped.yaml", Position {});
variant!(extended, "topologies/shapes/extended.yaml", Position { altitude: 34.0 });
variant!(renamed, "topologies/shapes/renamed.yaml", Location {});
