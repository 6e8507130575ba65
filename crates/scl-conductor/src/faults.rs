//! The faults of a scenario, each with its time and its component.

use crate::random::{Between, Random};
use crate::seed::seed_of;
use std::fmt;
use std::time::Duration;

/// A fault as a scenario describes it: it may happen often, to one of several components.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FaultRule {
    pub(crate) when: When,
    pub(crate) what: What,
    pub(crate) whom: Whom,
}

/// When faults happen.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum When {
    /// Once.
    At(Between),
    /// Again and again, first after such a time.
    Every { between: Between, from: Duration },
}

/// What happens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum What {
    /// The process is killed.
    Kill,
    /// The process does not run for a while.
    Pause(Between),
    /// Nothing passes the connections for a while.
    Cut(Between),
}

/// To which components it happens; a cut also to single gates.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Whom {
    /// To each of them at the same time.
    Each(Vec<String>),
    /// To one of them.
    Any(Vec<String>),
}

/// A fault that happens once, to one component or gate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Its number in the simulation, from 1.
    pub number: usize,
    /// When it happens.
    pub at: Duration,
    /// To which component, or to which gate, as `component.gate`.
    pub target: String,
    /// What it does.
    pub effect: Effect,
}

/// What a fault does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// The component's process is killed.
    Kill,
    /// The component does not run for this long.
    Pause(Duration),
    /// Nothing passes the connections of the component or gate for this long.
    Cut(Duration),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (number, at, target) = (self.number, self.at.as_secs_f64(), &self.target);
        write!(f, "fault {number}, at {at:.6} s: ")?;
        match self.effect {
            Effect::Kill => write!(f, "`{target}` is killed"),
            Effect::Pause(pause) => write!(f, "`{target}` does not run for {:.6} s", pause.as_secs_f64()),
            Effect::Cut(cut) => write!(f, "the connections of `{target}` are cut for {:.6} s", cut.as_secs_f64()),
        }
    }
}

/// Returns the faults of a simulation up to its end, in the order of their times. They depend on the seed alone, so
/// that one can be left out and the others stay the same.
pub(crate) fn faults(rules: &[FaultRule], seed: u64, until: Duration) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (index, rule) in rules.iter().enumerate() {
        let mut random = Random::new(seed_of(seed, "faults", index as u64));
        let mut happens = |at: Duration, random: &mut Random| {
            let targets = match &rule.whom {
                Whom::Each(all) => all.as_slice(),
                Whom::Any(all) => {
                    let one = random.below(all.len().max(1) as u64) as usize;
                    all.get(one..=one).unwrap_or_default()
                }
            };
            let effect = match rule.what {
                What::Kill => Effect::Kill,
                What::Pause(between) => Effect::Pause(random.between(between)),
                What::Cut(between) => Effect::Cut(random.between(between)),
            };
            let one = |target: &String| Fault { number: 0, at, target: target.clone(), effect };
            faults.extend(targets.iter().map(one));
        };
        match rule.when {
            When::At(between) => {
                let at = random.between(between);
                happens(at, &mut random);
            }
            When::Every { between, from } => {
                let mut at = from + random.between(between);
                while at < until {
                    happens(at, &mut random);
                    at += random.between(between);
                }
            }
        }
    }
    faults.retain(|fault| fault.at < until);
    faults.sort_by_key(|fault| fault.at);
    faults.iter_mut().enumerate().for_each(|(index, fault)| fault.number = index + 1);
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn between(least: u32, most: u32) -> Between {
        Between { least: least * SECOND, most: most * SECOND }
    }

    #[test]
    fn faults_depend_on_the_seed_alone_and_come_in_order() {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let rules = [
            FaultRule {
                when: When::Every { between: between(5, 20), from: 10 * SECOND },
                what: What::Kill,
                whom: Whom::Any(names(&["a", "b"])),
            },
            FaultRule {
                when: When::At(between(40, 40)),
                what: What::Pause(between(2, 2)),
                whom: Whom::Each(names(&["c", "d"])),
            },
            FaultRule { when: When::At(between(900, 900)), what: What::Kill, whom: Whom::Each(names(&["late"])) },
        ];
        let found = faults(&rules, 7, 100 * SECOND);
        assert_eq!(found, faults(&rules, 7, 100 * SECOND));
        assert_ne!(found, faults(&rules, 8, 100 * SECOND));
        assert!(found.is_sorted_by_key(|fault| fault.at));
        assert!(found.iter().map(|fault| fault.number).eq(1..=found.len()));
        let paused: Vec<&Fault> = found.iter().filter(|fault| fault.effect == Effect::Pause(2 * SECOND)).collect();
        assert_eq!(paused.len(), 2);
        assert!(paused.iter().all(|fault| fault.at == 40 * SECOND));
        let killed: Vec<&Fault> = found.iter().filter(|fault| fault.effect == Effect::Kill).collect();
        assert!((4..=18).contains(&killed.len()), "{found:?}");
        assert!(killed.iter().all(|fault| fault.at >= 15 * SECOND && "ab".contains(&*fault.target)), "{found:?}");
        // A rule that is added changes no other.
        assert_eq!(faults(&rules[..1], 7, 100 * SECOND).len(), killed.len());
    }
}
