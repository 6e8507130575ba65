//! The camera: sends frames and pictures that it fills in place, or as bytes of its own.

use crate::Camera;
use crate::picture::fill;
use scl::PeerStats;
use scl::bytes::Bytes;
use scl_tests::{Commands, is_shared, say, say_result};
use std::time::Duration;

/// Too long for a socket, if there is shared memory.
const LONG: usize = 1 << 20;

pub(crate) async fn play() -> scl::Result<()> {
    let mut camera = Camera::open().await?;
    say("open");
    let mut commands = Commands::listen();
    let mut flows = false;
    while let Some(words) = commands.next().await {
        let number = |index: usize| words.get(index).and_then(|word| word.parse::<u64>().ok()).unwrap_or_default();
        let (from, to, length) = (number(1), number(2), number(3) as usize);
        match words.first().map_or("", String::as_str) {
            "ready" => say_result(camera.ready(Duration::from_secs(300)).await, |()| "ready".to_owned()),
            // Until the viewer's gates are connected, or not.
            "viewer" => {
                let wanted = words[1] == "here";
                while camera.frames.is_connected() != wanted {
                    camera.frames.peers_changed().await;
                }
                while camera.pictures.is_connected() != wanted {
                    camera.pictures.peers_changed().await;
                }
                say("viewer");
            }
            "worker" => {
                while camera.jobs.stats().peers != 1 {
                    camera.jobs.peers_changed().await;
                }
                say("worker");
            }
            // Sends a short frame, and says how many programs get it.
            "reach" => {
                let before = camera.frames.stats().sent;
                camera.frames.send(&frame(from, 9)).await?;
                say(camera.frames.stats().sent - before);
            }
            // Until shared memory is agreed on, which takes a moment longer than to be connected, and has no event.
            "lends" => {
                let is_shared = |camera: &mut Camera| match words[1].as_str() {
                    "frames" => camera.frames.loan_bytes(LONG).map(|frame| is_shared(&frame)),
                    "pictures" => camera.pictures.loan().map(|picture| is_shared(&picture.pixels)),
                    _ => camera.jobs.loan_bytes(LONG).map(|job| is_shared(&job)),
                };
                while !is_shared(&mut camera)? {
                    tokio::time::sleep(Duration::from_millis(1)).await;
                }
                say("lends");
            }
            // Frames that are filled where they are sent from.
            "lend" => {
                let mut shared = 0;
                for number in from..to {
                    let mut frame = camera.frames.loan_bytes(length)?;
                    fill(&mut frame, number);
                    shared += u64::from(is_shared(&frame));
                    frame.send().await?;
                }
                say(format!("{shared} shared"));
            }
            // Frames until the next command, whose numbers tell which program sends them.
            "stream" => {
                let mut number = u64::from(std::process::id()) << 32;
                let length = from as usize;
                while !commands.is_waiting() {
                    let mut frame = camera.frames.loan_bytes(length)?;
                    fill(&mut frame, number);
                    frame.send().await?;
                    say_once(&mut flows, camera.frames.is_connected());
                    number += 1;
                    tokio::task::yield_now().await;
                }
            }
            "send" => {
                for number in from..to {
                    camera.frames.send(&frame(number, length)).await?;
                }
                say("sent");
            }
            "draw" => {
                let mut shared = 0;
                for number in from..to {
                    let mut picture = camera.pictures.loan()?;
                    picture.draw(number);
                    shared += u64::from(is_shared(&picture.pixels));
                    picture.send().await?;
                }
                say(format!("{shared} shared"));
            }
            "push" => {
                for number in from..to {
                    camera.jobs.send(&frame(number, length)).await?;
                }
                say("pushed");
            }
            // Jobs until the next command.
            "push_stream" => {
                let mut number = u64::from(std::process::id()) << 32;
                let length = from as usize;
                while !commands.is_waiting() {
                    let mut job = camera.jobs.loan_bytes(length)?;
                    fill(&mut job, number);
                    // A worker that is gone must not keep this program from its commands.
                    tokio::select! {
                        sent = job.send() => {
                            sent?;
                            number += 1;
                            say_once(&mut flows, camera.jobs.stats().peers > 0);
                        }
                        () = commands.arrived() => {}
                    }
                }
            }
            // A loan that is neither sent nor dropped.
            "hold" => {
                let frame = camera.frames.loan_bytes(from as usize)?;
                say(format!("holds {}", u64::from(is_shared(&frame))));
                // `frame` borrows the gate, so it is held by a future that never ends.
                std::future::pending::<()>().await;
                drop(frame);
            }
            "frames" => say(account(&camera.frames.peer_stats()[0])),
            "jobs" => say(account(&camera.jobs.peer_stats()[0])),
            other => say(format!("unknown command `{other}`")),
        }
    }
    say_result(camera.close(Duration::from_secs(300)).await, |()| "closed".to_owned());
    Ok(())
}

/// Tells the test when messages flow.
fn say_once(flows: &mut bool, connected: bool) {
    if connected && !*flows {
        *flows = true;
        say("flows");
    }
}

fn frame(number: u64, length: usize) -> Bytes {
    let mut frame = vec![0; length];
    fill(&mut frame, number);
    frame.into()
}

/// Published, taken, dropped, lost, waiting.
fn account(peer: &PeerStats) -> String {
    let dropped = peer.dropped_oldest + peer.dropped_newest;
    format!("{} = {} + {dropped} + {} + {}", peer.published, peer.taken, peer.lost, peer.waiting)
}
