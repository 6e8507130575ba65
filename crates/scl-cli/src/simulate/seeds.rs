//! `scl simulate --seeds`: which seeds fail, and with which faults.

use super::process::{Process, folder};
use super::report::Report;
use super::shrink::smallest;
use super::{ChosenFaults, SimulateArguments};
use scl_terminal::{Align, Problem, Table, print_err, print_out};
use std::ops::RangeInclusive;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

/// A seed with which something expected did not happen.
struct Failing {
    seed: u64,
    report: Report,
}

impl Failing {
    /// The faults, as `--faults` takes them.
    fn faults(&self) -> String {
        ChosenFaults(self.report.faults.iter().map(|(number, _)| *number).collect()).text()
    }
}

/// Simulates with each of these seeds. Prints those that fail, each with the fewest faults with which it still fails.
pub(super) fn simulate_seeds(
    mut seeds: RangeInclusive<u64>,
    arguments: &SimulateArguments,
) -> Result<ExitCode, Problem> {
    let folder = folder()?;
    let count = seeds.end() - seeds.start() + 1;
    let mut failing = Vec::new();
    // The first simulation builds the programs, and shows what keeps a simulation from starting.
    if let Some(seed) = seeds.next() {
        failing.extend(simulate_one(seed, None, 0, false, folder.path())?);
    }
    let left = Mutex::new(seeds);
    let next = || left.lock().ok().and_then(|mut seeds| seeds.next());
    let stopped = AtomicBool::new(false);
    let work = |processor: usize| -> Result<Vec<Failing>, Problem> {
        let mut found = Vec::new();
        while !stopped.load(Ordering::Relaxed)
            && let Some(seed) = next()
        {
            let simulated = simulate_one(seed, None, processor, true, folder.path());
            found.extend(simulated.inspect_err(|_| stopped.store(true, Ordering::Relaxed))?);
        }
        Ok(found)
    };
    let found: Result<Vec<Vec<Failing>>, Problem> = thread::scope(|threads| {
        let jobs: Vec<_> = (0..arguments.jobs.get()).map(|number| threads.spawn(move || work(number))).collect();
        let finish =
            |job: thread::ScopedJoinHandle<'_, _>| job.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        jobs.into_iter().map(finish).collect()
    });
    failing.extend(found?.into_iter().flatten());
    failing.sort_by_key(|it| it.seed);
    for it in &mut failing {
        shrink(it, folder.path())?;
    }
    print(&failing);
    print_err(&format!("scl: {count} seeds, {} failed\n", failing.len()));
    Ok(if failing.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Simulates with a seed; returns how it failed, if it did.
fn simulate_one(
    seed: u64,
    faults: Option<ChosenFaults>,
    processor: usize,
    is_built: bool,
    folder: &Path,
) -> Result<Option<Failing>, Problem> {
    let file = folder.join(format!("{seed}-{processor}.json"));
    let process = Process { seed: Some(seed), faults, report: Some(&file), processor, is_built, ..Process::default() };
    let code = process.run_to_end()?;
    if code == 0 {
        return Ok(None);
    }
    let could_not = || {
        Problem::new(format!("the simulation with seed {seed} could not start, or not go on"))
            .help(format!("`scl simulate --seed {seed}` with the same arguments shows why"))
    };
    Report::read(&file).map(|report| Some(Failing { seed, report })).ok_or_else(could_not)
}

/// Leaves out faults as long as the simulation still fails in the same way.
fn shrink(failing: &mut Failing, folder: &Path) -> Result<(), Problem> {
    let (seed, first) = (failing.seed, failing.report.failures.first().cloned());
    let all: Vec<usize> = failing.report.faults.iter().map(|(number, _)| *number).collect();
    let still_fails = |faults: &[usize]| -> Result<bool, Problem> {
        let simulated = simulate_one(seed, Some(ChosenFaults(faults.to_vec())), 0, true, folder)?;
        Ok(simulated.is_some_and(|it| it.report.failures.first() == first.as_ref()))
    };
    let fewest = smallest(&all, still_fails)?;
    failing.report.faults.retain(|(number, _)| fewest.contains(number));
    Ok(())
}

fn print(failing: &[Failing]) {
    if failing.is_empty() {
        return;
    }
    let mut table = Table::new([("SEED", Align::Right), ("FAULTS", Align::Left), ("FAILED", Align::Left)]);
    for it in failing {
        table.row([it.seed.to_string(), it.faults(), it.report.failures.join("; ")]);
    }
    print_out(&table.text());
    for it in failing {
        let (seed, faults) = (it.seed, it.faults());
        print_out(&format!("\nseed {seed} fails with the arguments `--seed {seed} --faults {faults}`:\n"));
        let happened = it.report.faults.iter().map(|(_, text)| text);
        happened.chain(&it.report.failures).for_each(|text| print_out(&format!("  {text}\n")));
    }
}
