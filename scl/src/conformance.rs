//! Tests of what SCL relies on, for any transport and any codec.
//!
//! Each guarantee is a function that panics if it does not hold and says what was expected. The transports and codecs
//! of this crate pass the same functions. Nothing here measures time; what does not happen within [`PATIENCE`] is
//! reported as a failure, so that a test never hangs.
//!
//! | for | all guarantees | single ones |
//! |---|---|---|
//! | a transport | [`transport_conformance!`](crate::transport_conformance) | [`transport`] |
//! | a codec | [`codec::all`] | [`codec`] |

pub mod codec;
pub mod transport;

use std::time::Duration;
use tokio::runtime::Builder;

/// How long a guarantee may take until it counts as broken: 300 s, where the slowest takes about one.
pub const PATIENCE: Duration = Duration::from_secs(300);

/// Runs a test on a current-thread runtime, and again on one with two worker threads.
///
/// # Panics
/// If the test panics, or is not done after [`PATIENCE`].
pub fn run<F: Future<Output = ()>>(guarantee: &str, test: impl Fn() -> F) {
    run_on(&mut Builder::new_current_thread(), guarantee, &test);
    run_on(Builder::new_multi_thread().worker_threads(2), guarantee, &test);
}

fn run_on<F: Future<Output = ()>>(builder: &mut Builder, guarantee: &str, test: &impl Fn() -> F) {
    let built = builder.enable_all().build();
    let runtime = built.unwrap_or_else(|error| panic!("cannot create a runtime for the test: {error}"));
    let done = runtime.block_on(async { tokio::time::timeout(PATIENCE, test()).await });
    assert!(done.is_ok(), "`{guarantee}` is not done after {PATIENCE:?} on {runtime:?}");
}

/// Makes a `#[test]` of each guarantee in [`conformance::transport`](crate::conformance::transport).
///
/// The expression is evaluated for each test. It returns a [`Transport`](crate::transport::Transport) without any ends,
/// and a value that is dropped after the test, such as the folder of its sockets.
///
/// | before the expression | for a transport that |
/// |---|---|
/// | nothing | declares all [`Guarantees`](crate::transport::Guarantees), and lends no memory |
/// | `lends;` | declares all of them, and whose links [lend memory](crate::transport::Link::loan) of 64 KiB and more |
/// | `only [Waiting, Requests];` | declares these, and lends no memory |
/// | `lends, only [Waiting];` | declares these, and lends memory |
///
/// One more test checks that the transport declares exactly the guarantees that are tested.
///
/// ```
/// mod memory {
///     scl::transport_conformance!(lends; (scl::transport::memory::Memory::new(), ()));
/// }
/// ```
#[macro_export]
macro_rules! transport_conformance {
    (lends, only [$($guarantee:ident),*]; $fresh:expr) => {
        $crate::transport_conformance! { @lending $fresh }
        $crate::transport_conformance! { @only [$($guarantee)*] $fresh }
    };
    (only [$($guarantee:ident),*]; $fresh:expr) => {
        $crate::transport_conformance! { @tests $fresh; lends_nothing }
        $crate::transport_conformance! { @only [$($guarantee)*] $fresh }
    };
    (lends; $fresh:expr) => {
        $crate::transport_conformance! { lends, only [Acknowledgement, Waiting, Freshness, Requests]; $fresh }
    };
    (@lending $fresh:expr) => {
        $crate::transport_conformance! { @tests $fresh;
            carries_loans returns_loans_that_it_refuses takes_dropped_loans_back copies_loans_of_a_lost_link
            leaves_loans_to_their_holder
        }
    };
    (@only [$($guarantee:ident)*] $fresh:expr) => {
        $crate::transport_conformance! { @tests $fresh;
            keeps_order carries_every_size never_delivers_an_oversized_message delivers_what_was_written
            serves_every_pusher
            waits_for_a_late_peer yields_each_peer_once serves_the_next_receiver serves_the_next_sender
            reconnects_after_a_dropped_link frees_its_endpoint finds_the_peer_that_stays releases_an_idle_connection
            counts_peers connects_only_if_the_check_passes connects_without_room
            keeps_subscribers_independent
            delivers_when_detached accepts_peers_when_detached delivers_after_its_runtime_has_ended
            moves_between_threads
        }
        $($crate::transport_conformance! { @guarantee $guarantee $fresh })*

        #[test]
        fn declares_what_is_tested() {
            $crate::conformance::run("declares_what_is_tested", || async {
                let (transport, _kept) = $fresh;
                let tested = [$($crate::transport::Guarantee::$guarantee),*];
                $crate::conformance::transport::declares(&transport, &tested);
            });
        }
    };
    (@guarantee Acknowledgement $fresh:expr) => {
        $crate::transport_conformance! { @tests $fresh; acknowledges_what_was_taken counts_what_was_not_taken tells_what_was_received }
    };
    (@guarantee Waiting $fresh:expr) => {
        $crate::transport_conformance! { @tests $fresh; stops_and_resumes tells_who_waits }
    };
    (@guarantee Freshness $fresh:expr) => {
        $crate::transport_conformance! { @tests $fresh;
            returns_the_newest_message catches_up_with_a_busy_sender catches_up_with_senders_that_answer_in_turn
            catches_up_without_a_runtime
        }
    };
    (@guarantee Requests $fresh:expr) => {
        $crate::transport_conformance! { @tests $fresh;
            stays_quiet_when_idle counts_requesters requests_only_if_the_check_passes
            replies_when_detached
            moves_requests_between_threads
            answers_in_any_order keeps_request_numbers carries_requests_of_every_size
            never_delivers_an_oversized_request refuses_requests_without_a_replier reports_a_lost_replier
            finds_the_replier_that_stays survives_a_lost_requester delivers_written_replies
        }
    };
    (@tests $fresh:expr; $($guarantee:ident)*) => {$(
        #[test]
        fn $guarantee() {
            $crate::conformance::run(stringify!($guarantee), || async {
                let (transport, _kept) = $fresh;
                $crate::conformance::transport::$guarantee(&transport).await;
            });
        }
    )*};
    ($fresh:expr) => {
        $crate::transport_conformance! { only [Acknowledgement, Waiting, Freshness, Requests]; $fresh }
    };
}
