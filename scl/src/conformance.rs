//! What SCL relies on, as tests that any transport and any codec can be put to.
//!
//! Each guarantee is a function that panics, with a text that says what was expected, when it does not hold. The
//! transports and codecs of this crate pass the same functions. Nothing here measures time; what never happens is
//! given up after [`PATIENCE`], so that a test ends with a text instead of hanging.
//!
//! | what | all of it | one by one |
//! |---|---|---|
//! | a transport | [`transport_conformance!`](crate::transport_conformance) | [`transport`] |
//! | a codec | [`codec::all`] | [`codec`] |

pub mod codec;
pub mod transport;

use std::time::Duration;
use tokio::runtime::Builder;

/// How long a guarantee may take before it counts as not kept: 60 s, where the slowest takes about one.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Runs a test on a current-thread runtime, and again on one with two threads.
///
/// # Panics
/// When the test does, or is not done after [`PATIENCE`].
pub fn run<F: Future<Output = ()>>(guarantee: &str, test: impl Fn() -> F) {
    run_on_one_thread(guarantee, &test);
    run_on(Builder::new_multi_thread().worker_threads(2), guarantee, &test);
}

/// Runs a test on a current-thread runtime alone.
///
/// # Panics
/// When the test does, or is not done after [`PATIENCE`].
pub fn run_on_one_thread<F: Future<Output = ()>>(guarantee: &str, test: impl Fn() -> F) {
    run_on(&mut Builder::new_current_thread(), guarantee, &test);
}

fn run_on<F: Future<Output = ()>>(builder: &mut Builder, guarantee: &str, test: &impl Fn() -> F) {
    let built = builder.enable_all().build();
    let runtime = built.unwrap_or_else(|error| panic!("no runtime to test with: {error}"));
    let done = runtime.block_on(async { tokio::time::timeout(PATIENCE, test()).await });
    assert!(done.is_ok(), "`{guarantee}` waits in vain on {runtime:?}");
}

/// Makes a `#[test]` of each guarantee in [`conformance::transport`](crate::conformance::transport).
///
/// The expression makes a fresh place for each test: a [`Transport`](crate::transport::Transport), and a value that is
/// dropped after the test, such as its folder.
///
/// ```
/// mod memory {
///     scl::transport_conformance!((scl::transport::memory::Memory::new(), ()));
/// }
/// ```
///
/// A transport that is not made for runtimes of several threads says `one_thread` before the expression.
#[macro_export]
macro_rules! transport_conformance {
    ($fresh:expr) => {
        $crate::transport_conformance! { @all run $fresh }
    };
    (one_thread $fresh:expr) => {
        $crate::transport_conformance! { @all run_on_one_thread $fresh }
    };
    (@all $run:ident $fresh:expr) => {
        $crate::transport_conformance! { @tests $run $fresh;
            keeps_order carries_every_size gives_back_what_nobody_takes reports_a_late_peer serves_the_next_receiver
            serves_the_next_sender stops_and_resumes serves_every_pusher keeps_what_is_flushed frees_its_endpoint
            finds_the_peer_that_stays lets_go_of_who_came_early stays_quiet_when_idle
            answers_who_asked_in_any_order numbers_old_answers carries_requests_of_every_size
            gives_back_what_nobody_answers tells_of_a_lost_replier finds_the_replier_that_stays survives_a_lost_requester
        }
    };
    (@tests $run:ident $fresh:expr; $($guarantee:ident)*) => {$(
        #[test]
        fn $guarantee() {
            $crate::conformance::$run(stringify!($guarantee), || async {
                let (transport, _kept) = $fresh;
                $crate::conformance::transport::$guarantee(&transport).await;
            });
        }
    )*};
}
