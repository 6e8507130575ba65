//! Plays `left` or `right` of `twins.yaml` on a runtime of the test's choice, each gate in a task or thread of its own,
//! and follows commands: `twin COMPONENT RUNTIME [wait]`. With `wait`, the gates are used once all peers are connected.

mod in_tasks;
mod in_threads;

use scl::{Pub, Pull, Push, Rep, Req, Sub};
use scl_tests::{Commands, ranges, say};
use std::time::Duration;
use test::Number;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::task::LocalSet;

scl::topology!("topologies/twins.yaml");

const READY: Duration = Duration::from_secs(300);

fn main() -> scl::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [component, runtime, wait @ ..] = &arguments[..] else {
        return Err(scl::Error::message("usage: twin COMPONENT RUNTIME [wait]"));
    };
    if component == "left" { play::<Left>(runtime, !wait.is_empty()) } else { play::<Right>(runtime, !wait.is_empty()) }
}

fn play<C: Twin>(runtime: &str, wait: bool) -> scl::Result<()> {
    match runtime {
        "current_thread" => Builder::new_current_thread().enable_all().build()?.block_on(play_in_tasks::<C>(wait)),
        "local_set" => LocalSet::new()
            .block_on(&Builder::new_current_thread().enable_all().build()?, play_in_local_tasks::<C>(wait)),
        "blocking" => {
            let component = C::open_blocking()?;
            say("open");
            if wait {
                component.ready_blocking()?;
                say("ready");
            }
            let controls = in_threads::start(component.into_gates());
            Builder::new_current_thread().build()?.block_on(controls.follow());
            Ok(())
        }
        "threads_beside_async" => multi_thread(2)?.block_on(async {
            let gates = open::<C>(wait).await?;
            in_threads::start(gates).follow().await;
            Ok(())
        }),
        multi => multi_thread(multi.trim_start_matches("multi_thread_").parse()?)?.block_on(play_in_tasks::<C>(wait)),
    }
}

fn multi_thread(threads: usize) -> std::io::Result<Runtime> {
    Builder::new_multi_thread().worker_threads(threads).enable_all().build()
}

async fn play_in_tasks<C: Twin>(wait: bool) -> scl::Result<()> {
    // `open` and `ready` run in a task, so the component must be `Send`.
    let gates = tokio::spawn(open::<C>(wait)).await??;
    in_tasks::start(gates).follow().await;
    Ok(())
}

async fn play_in_local_tasks<C: Twin>(wait: bool) -> scl::Result<()> {
    let gates = tokio::task::spawn_local(open::<C>(wait)).await??;
    in_tasks::start_local(gates).follow().await;
    Ok(())
}

async fn open<C: Twin>(wait: bool) -> scl::Result<Gates> {
    let component = C::open().await?;
    say("open");
    if wait {
        component.ready().await?;
        say("ready");
    }
    Ok(component.into_gates())
}

/// The gates of either component.
struct Gates {
    values: Pub<Number>,
    values_in: Sub<Number>,
    jobs: Push<Number>,
    jobs_in: Pull<Number>,
    question: Req<Number, Number>,
    answer: Rep<Number, Number>,
}

/// What `Left` and `Right` have in common.
trait Twin: Send + Sync + Sized + 'static {
    fn open() -> impl Future<Output = Result<Self, scl::OpenError>> + Send;
    fn open_blocking() -> Result<Self, scl::OpenError>;
    fn ready(&self) -> impl Future<Output = Result<(), scl::NotReady>> + Send;
    fn ready_blocking(&self) -> scl::Result<()>;
    fn into_gates(self) -> Gates;
}

macro_rules! twin {
    ($component:ident) => {
        impl Twin for $component {
            fn open() -> impl Future<Output = Result<Self, scl::OpenError>> + Send {
                $component::open()
            }

            fn open_blocking() -> Result<Self, scl::OpenError> {
                $component::open_blocking()
            }

            fn ready(&self) -> impl Future<Output = Result<(), scl::NotReady>> + Send {
                self.ready(READY)
            }

            fn ready_blocking(&self) -> scl::Result<()> {
                self.ready_blocking(READY)
            }

            fn into_gates(self) -> Gates {
                let Self { values, values_in, jobs, jobs_in, question, answer, .. } = self;
                Gates { values, values_in, jobs, jobs_in, question, answer }
            }
        }
    };
}

twin!(Left);
twin!(Right);

type Orders = UnboundedReceiver<Vec<String>>;

/// What the gates' tasks or threads are controlled with.
struct Controls {
    values: UnboundedSender<Vec<String>>,
    jobs: UnboundedSender<Vec<String>>,
    question: UnboundedSender<Vec<String>>,
    /// Values received by the two receiving gates.
    values_in: UnboundedReceiver<u64>,
    jobs_in: UnboundedReceiver<u64>,
}

/// The other ends of [`Controls`].
struct Controlled {
    values: Orders,
    jobs: Orders,
    question: Orders,
    values_in: UnboundedSender<u64>,
    jobs_in: UnboundedSender<u64>,
}

impl Controls {
    fn new() -> (Self, Controlled) {
        let (values, values_orders) = unbounded_channel();
        let (jobs, jobs_orders) = unbounded_channel();
        let (question, question_orders) = unbounded_channel();
        let (values_received, values_in) = unbounded_channel();
        let (jobs_received, jobs_in) = unbounded_channel();
        let controlled = Controlled {
            values: values_orders,
            jobs: jobs_orders,
            question: question_orders,
            values_in: values_received,
            jobs_in: jobs_received,
        };
        (Self { values, jobs, question, values_in, jobs_in }, controlled)
    }

    /// Passes commands on until the test closes the input.
    async fn follow(mut self) {
        let mut commands = Commands::listen();
        while let Some(words) = commands.next().await {
            let last = number(&words, 1);
            let sent = match words.first().map_or("", String::as_str) {
                "publish" | "peers" => self.values.send(words),
                "push" => self.jobs.send(words),
                "call" => self.question.send(words),
                "values" => {
                    say(received_until(&mut self.values_in, |value| value == last).await);
                    Ok(())
                }
                "values_from" => {
                    say(received_until(&mut self.values_in, |value| value >= last).await);
                    Ok(())
                }
                "jobs" => {
                    say(received_until(&mut self.jobs_in, |value| value == last).await);
                    Ok(())
                }
                other => {
                    say(format!("unknown command `{other}`"));
                    Ok(())
                }
            };
            if sent.is_err() {
                say("error: the gate's task has ended");
            }
        }
    }
}

async fn received_until(received: &mut UnboundedReceiver<u64>, is_last: impl Fn(u64) -> bool) -> String {
    let mut values = Vec::new();
    while let Some(value) = received.recv().await {
        values.push(value);
        if is_last(value) {
            return ranges(&values);
        }
    }
    "error: the gate's task has ended".to_owned()
}

fn number(words: &[String], index: usize) -> u64 {
    words.get(index).and_then(|word| word.parse().ok()).unwrap_or_default()
}

/// The messages of `publish FROM TO [PADDING]` and `push FROM TO [PADDING]`.
fn messages(words: &[String]) -> impl Iterator<Item = Number> {
    let padding = number(words, 3) as usize;
    (number(words, 1)..number(words, 2)).map(move |value| Number { value, padding: vec![7; padding] })
}

fn doubled(request: &Number) -> Number {
    Number { value: request.value * 2, padding: Vec::new() }
}
