//! Running cases, and printing the shortest sequence of steps that fails.

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, FileFailurePersistence, RngSeed, TestCaseError, TestError, TestRunner};
use std::fmt;
use tokio::runtime::Builder;

/// What went against the model.
pub(crate) type Outcome = Result<(), String>;

/// The cases that failed once, which are tried first; made when one fails.
const REGRESSIONS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/model/regressions.txt");

/// How many milliseconds the search for a shorter case may take.
const SHRINKING: u32 = 60_000;

/// Plays cases, each on a runtime of its own, on which nothing happens but what the case does.
pub(crate) fn trial<S: Strategy>(cases: u32, of: S, play: impl AsyncFn(&S::Value) -> Outcome)
where
    S::Value: fmt::Display,
{
    let mut config = Config { max_shrink_iters: 4 * cases, max_shrink_time: SHRINKING, ..Config::default() };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = cases;
    }
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(0x5C1);
    }
    config.failure_persistence = Some(Box::new(FileFailurePersistence::Direct(REGRESSIONS)));
    let failed = TestRunner::new(config).run(&of, |case| {
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(play(&case)).map_err(TestCaseError::fail)
    });
    match failed {
        Ok(()) => {}
        Err(TestError::Fail(reason, case)) => panic!("{reason}\nThe shortest case that fails:\n{case}"),
        Err(TestError::Abort(reason)) => panic!("{reason}"),
    }
}

/// A list of steps, one a line.
pub(crate) fn list(f: &mut fmt::Formatter<'_>, steps: &[impl fmt::Debug]) -> fmt::Result {
    steps.iter().zip(1..).try_for_each(|(step, number)| writeln!(f, "{number:>4}. {step:?}"))
}
