//! Runs cases, and prints the shortest sequence of steps that fails.

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, FileFailurePersistence, RngSeed, TestCaseError, TestError, TestRunner};
use std::fmt;
use tokio::runtime::Builder;

/// A contradiction to the model.
pub(crate) type Outcome = Result<(), String>;

/// Cases that failed before and are run first. The file is created when a case fails.
const REGRESSIONS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/model/regressions.txt");

/// How many milliseconds the search for a shorter case may take.
const SHRINKING: u32 = 60_000;

/// Plays cases, each on a runtime of its own, so that nothing else happens there.
pub(crate) fn run<S: Strategy>(cases: u32, strategy: S, play: impl AsyncFn(&S::Value) -> Outcome)
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
    let failed = TestRunner::new(config).run(&strategy, |case| {
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(play(&case)).map_err(TestCaseError::fail)
    });
    match failed {
        Ok(()) => {}
        Err(TestError::Fail(reason, case)) => panic!("{reason}\nThe shortest case that fails:\n{case}"),
        Err(TestError::Abort(reason)) => panic!("{reason}"),
    }
}

/// Prints a list of steps, one per line.
pub(crate) fn list(f: &mut fmt::Formatter<'_>, steps: &[impl fmt::Debug]) -> fmt::Result {
    steps.iter().zip(1..).try_for_each(|(step, number)| writeln!(f, "{number:>4}. {step:?}"))
}
