//! The program with async.

use crate::{Left, MOTORS_OFF, READY, argument, compute, number};
use scl_tests::say;

#[scl::main]
pub(crate) async fn main(mut left: Left) -> scl::Result<()> {
    match argument(2).as_str() {
        "send" => {
            say("running");
            for value in 0.. {
                left.values.send(&number(value)).await?;
            }
        }
        "try_send" => {
            say("running");
            for value in 0.. {
                left.values.try_send(&number(value))?;
            }
        }
        "receive" => {
            say("running");
            left.values_in.recv().await?;
        }
        "pull" => {
            say("running");
            left.jobs_in.recv().await?;
        }
        "call" => {
            say("running");
            loop {
                // A replier that is stopped first is no failure of this program.
                let _lost = left.question.call(&number(1)).await;
            }
        }
        "serve" => {
            say("running");
            let _unanswered = left.answer.recv().await?;
        }
        "motors_off" => {
            left.ready(READY).await?;
            say("running");
            tokio::select! {
                result = send_forever(&mut left) => return result,
                () = scl::stop_requested() => {}
            }
            left.jobs.send(&number(MOTORS_OFF)).await?;
        }
        "motors_off_beside" => {
            left.ready(READY).await?;
            let stop = tokio::spawn(scl::stop_requested());
            say("running");
            for value in 0.. {
                left.values.send(&number(value)).await?;
                if stop.is_finished() {
                    break;
                }
            }
            left.jobs.send(&number(MOTORS_OFF)).await?;
        }
        "ignore" => {
            let stop = scl::stop_requested();
            say("running");
            stop.await;
            say("stop requested");
            send_forever(&mut left).await?;
        }
        "last_words" => {
            let stop = scl::stop_requested();
            say("running");
            stop.await;
            left.jobs.send(&number(MOTORS_OFF)).await?;
        }
        "ask_once" => {
            let _never_polled = scl::stop_requested();
            say("running");
            send_forever(&mut left).await?;
        }
        _ => compute(),
    }
    Ok(())
}

async fn send_forever(left: &mut Left) -> scl::Result<()> {
    for value in 0.. {
        left.values.send(&number(value)).await?;
    }
    Ok(())
}
