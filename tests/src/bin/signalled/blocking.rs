//! The program without async.

use crate::{Left, MOTORS_OFF, READY, argument, compute, number};
use scl_tests::say;
use std::thread;

#[scl::main]
pub(crate) fn main(mut left: Left) -> scl::Result<()> {
    match argument(2).as_str() {
        "send" => {
            say("running");
            for value in 0.. {
                left.values.send_blocking(&number(value))?;
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
            left.values_in.recv_blocking()?;
        }
        "pull" => {
            say("running");
            left.jobs_in.recv_blocking()?;
        }
        "call" => {
            say("running");
            loop {
                // A replier that is stopped first is no failure of this program.
                if let Err(error) = left.question.call_blocking(&number(1))
                    && matches!(error, scl::CallError::Blocking { .. })
                {
                    return Err(error.into());
                }
            }
        }
        "serve" => {
            say("running");
            let _unanswered = left.answer.recv_blocking()?;
        }
        "motors_off" => {
            left.ready_blocking(READY)?;
            say("running");
            for value in 0.. {
                if scl::is_stop_requested() {
                    break;
                }
                left.values.send_blocking(&number(value))?;
            }
            left.jobs.send_blocking(&number(MOTORS_OFF))?;
        }
        "motors_off_beside" => {
            left.ready_blocking(READY)?;
            let stop = thread::spawn(scl::stop_requested_blocking);
            // So that the request is handled from now on.
            scl::is_stop_requested();
            say("running");
            for value in 0.. {
                left.values.send_blocking(&number(value))?;
                if stop.is_finished() {
                    break;
                }
            }
            left.jobs.send_blocking(&number(MOTORS_OFF))?;
        }
        "ignore" => {
            scl::is_stop_requested();
            say("running");
            scl::stop_requested_blocking();
            say("stop requested");
            for value in 0.. {
                left.values.send_blocking(&number(value))?;
            }
        }
        "last_words" => {
            scl::is_stop_requested();
            say("running");
            scl::stop_requested_blocking();
            left.jobs.send_blocking(&number(MOTORS_OFF))?;
        }
        "ask_once" => {
            scl::is_stop_requested();
            say("running");
            for value in 0.. {
                left.values.send_blocking(&number(value))?;
            }
        }
        _ => compute(),
    }
    Ok(())
}
