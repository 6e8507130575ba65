//! Opens `left` of `twins.yaml` and drops it, in every way and place that is possible: `dropper WAY`. Prints `dropped`
//! when nothing is left of it.

use scl_tests::{say, wait_until};
use std::cell::RefCell;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;
use std::time::{Duration, Instant};
use test::Number;
use tokio::runtime::{Builder, Runtime};
use tokio::task::LocalSet;

scl::topology!("topologies/twins.yaml", only = [left]);

fn main() -> scl::Result<()> {
    // The first runtime of a process opens descriptors for signals that stay.
    drop(current_thread());
    let before = (threads(), descriptors());
    match std::env::args().nth(1).unwrap_or_default().as_str() {
        "inside_its_runtime" => current_thread().block_on(async { drop(open().await) }),
        "in_another_task" => multi_thread().block_on(async {
            let left = open().await;
            tokio::spawn(async { drop(left) }).await.expect("dropped");
        }),
        "in_a_blocking_task" => multi_thread().block_on(async {
            let left = open().await;
            tokio::task::spawn_blocking(|| drop(left)).await.expect("dropped");
        }),
        "in_a_thread" => multi_thread().block_on(async {
            let left = open().await;
            thread::spawn(|| drop(left)).join().expect("dropped");
        }),
        "inside_another_runtime" => {
            let runtime = multi_thread();
            let left = runtime.block_on(open());
            current_thread().block_on(async { drop(left) });
        }
        "while_its_runtime_stands_still" => {
            let runtime = current_thread();
            let left = runtime.block_on(open());
            drop(left);
        }
        "after_a_current_thread_runtime" => {
            let left = current_thread().block_on(open());
            drop(left);
        }
        "after_a_multi_thread_runtime" => {
            let left = multi_thread().block_on(open());
            drop(left);
        }
        "after_its_runtime_inside_another" => {
            let left = multi_thread().block_on(open());
            current_thread().block_on(async { drop(left) });
        }
        "with_a_current_thread_runtime" => {
            let runtime = current_thread();
            runtime.block_on(async { drop(tokio::spawn(keep(open().await))) });
        }
        "with_a_multi_thread_runtime" => {
            let runtime = multi_thread();
            runtime.block_on(async { drop(tokio::spawn(keep(open().await))) });
        }
        "with_a_runtime_in_the_background" => {
            let runtime = multi_thread();
            runtime.block_on(async { drop(tokio::spawn(keep(open().await))) });
            runtime.shutdown_background();
        }
        "with_a_local_set" => {
            let runtime = current_thread();
            let local = LocalSet::new();
            local.block_on(&runtime, async { drop(tokio::task::spawn_local(keep(open().await))) });
            drop(local);
        }
        "gate_by_gate" => multi_thread().block_on(async {
            let Left { values, jobs, answer, .. } = open().await;
            let dropped =
                [thread::spawn(|| drop(values)), thread::spawn(|| drop(jobs)), thread::spawn(|| drop(answer))];
            dropped.into_iter().for_each(|thread| thread.join().expect("dropped"));
        }),
        "by_a_panic" => {
            let unwound = catch_unwind(AssertUnwindSafe(|| {
                current_thread().block_on(async {
                    let _left = open().await;
                    std::panic::resume_unwind(Box::new("on purpose"));
                })
            }));
            assert!(unwound.is_err());
        }
        "at_the_end_of_a_thread" => {
            thread_local!(static KEPT: RefCell<Option<Left>> = const { RefCell::new(None) });
            let left = multi_thread().block_on(open());
            thread::spawn(|| KEPT.set(Some(left))).join().expect("ended");
        }
        "unused_after_its_runtime" => {
            let mut left = multi_thread().block_on(open());
            // Each of them may fail, but not panic or hang.
            let _ = left.values.try_send(&number(7));
            let _ = left.values.send_blocking(&number(8));
            let _ = left.jobs.try_send(&number(7));
            let _ = left.values_in.try_recv();
            let _ = left.values_in.latest();
            let _ = left.jobs_in.recv_timeout(Duration::from_millis(1));
            let _ = left.answer.try_recv();
            let _ = left.question.call_blocking(&number(7));
            let _ = (left.values.stats(), left.values_in.stats(), left.values.is_connected());
            drop(left);
        }
        "blocking" => drop(open_blocking()),
        "blocking_in_a_thread" => {
            let left = open_blocking();
            thread::spawn(|| drop(left)).join().expect("dropped");
        }
        "blocking_inside_a_runtime" => {
            let left = open_blocking();
            multi_thread().block_on(async { drop(left) });
        }
        "blocking_gate_by_gate" => {
            let Left { values, jobs, answer, .. } = open_blocking();
            let dropped =
                [thread::spawn(|| drop(values)), thread::spawn(|| drop(jobs)), thread::spawn(|| drop(answer))];
            dropped.into_iter().for_each(|thread| thread.join().expect("dropped"));
        }
        "at_any_moment" => at_any_moment(),
        other => return Err(scl::Error::message(format!("there is no way `{other}`"))),
    }
    wait_until("nothing is left of the component", || threads() <= before.0 && descriptors() <= before.1);
    say("dropped");
    // The test looks whether this program is idle now.
    let _end_of_the_test = std::io::stdin().lines().next();
    Ok(())
}

/// Drops the component some time after it was opened, while it sends and connects, each time a little later.
fn at_any_moment() {
    for delay in (0..100).map(|step| Duration::from_micros(step * 50)) {
        let runtime = multi_thread();
        let left = runtime.block_on(async {
            let mut left = Left::open().await.expect("open");
            let opened = Instant::now();
            while opened.elapsed() < delay {
                left.values.send(&number(1)).await.expect("sent");
                tokio::task::yield_now().await;
            }
            left
        });
        if delay.as_micros() % 100 == 0 {
            drop(runtime);
        }
        drop(left);
    }
}

async fn keep(left: Left) {
    std::future::pending::<()>().await;
    drop(left);
}

/// Sends something, so that there is something to hand over.
async fn open() -> Left {
    let mut left = Left::open().await.expect("open");
    for value in 0..10 {
        left.values.send(&number(value)).await.expect("sent");
        left.jobs.send(&number(value)).await.expect("pushed");
    }
    left
}

fn open_blocking() -> Left {
    let mut left = Left::open_blocking().expect("open");
    for value in 0..10 {
        left.values.send_blocking(&number(value)).expect("sent");
        left.jobs.send_blocking(&number(value)).expect("pushed");
    }
    left
}

fn current_thread() -> Runtime {
    Builder::new_current_thread().enable_all().build().expect("a runtime")
}

fn multi_thread() -> Runtime {
    Builder::new_multi_thread().worker_threads(2).enable_all().build().expect("a runtime")
}

fn threads() -> usize {
    count("/proc/self/task")
}

fn descriptors() -> usize {
    count("/proc/self/fd")
}

fn count(folder: &str) -> usize {
    fs::read_dir(folder).expect("a folder").count()
}

fn number(value: u64) -> Number {
    Number { value, padding: Vec::new() }
}
