//! SCL0409: an option value out of its range. Sets the options of every gate.

use super::draft::Draft;
use super::option_fit;
use crate::diagnostic::Severity;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::OptionModel;
use crate::rule::{Examples, Rule};
use crate::size::{self, SizeError};
use crate::topology::{GateKind, GateOptions, WhenFull};
use std::time::Duration;

/// SCL0409.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0409",
    severity: Severity::Error,
    title: "option value out of range",
    explanation: "The value is outside of what can work: a queue has 1 to 1,000,000 messages, a timeout is more than \
                  nothing and at most a day, `max_size` is 1B to 1GiB, because a message is held in memory as a whole. \
                  Correct it, or leave it out to get the default.",
    examples: Examples::Topology {
        bad: "components:
  - name: sensor
    gates:
      - measurements: {pub: Measurement, queue: 0}
",
        good: "components:
  - name: sensor
    gates:
      - measurements: {sub: Measurement, queue: 1}
",
    },
};

/// The longest queue, in messages. Memory is reserved for what a queue may hold, so a slip of the finger is refused.
const LONGEST_QUEUE: u32 = 1_000_000;

/// The longest wait for an answer: a day.
const LONGEST_TIMEOUT: Duration = Duration::from_secs(24 * 60 * 60);

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    for gate in &mut draft.gates {
        for option in &gate.model.options {
            match read(option, &mut gate.options) {
                Ok(()) => option_fit::check(gate.kind, option, problems),
                Err(range) => problems.push(report(gate.kind, option, range)),
            }
        }
    }
}

/// What the value must be, and what to do.
struct Range {
    rule: String,
    help: String,
    reason: Option<&'static str>,
}

/// Takes a value over. The parser has seen to its shape; only its range is in question.
fn read(option: &OptionModel, options: &mut GateOptions) -> Result<(), Range> {
    let value = option.value.value.as_str();
    match option.key.value.as_str() {
        "queue" => options.queue = queue(value)?,
        "max_size" => options.max_size = max_size(value)?,
        "timeout" => options.timeout = timeout(value)?,
        "when_full" => options.when_full = when_full(value),
        "backpressure" => options.backpressure = value == "true",
        "share" => options.share = value == "true",
        "unconnected" => options.unconnected_ok = value == "ok",
        _ => {}
    }
    Ok(())
}

fn queue(text: &str) -> Result<u32, Range> {
    let range = |rule: String| Range { rule, help: default("100"), reason: None };
    let digits = text.strip_prefix('+').unwrap_or(text);
    if text.starts_with('-') || digits.bytes().all(|digit| digit == b'0') {
        return Err(range("at least 1".to_owned()));
    }
    match digits.parse() {
        Ok(length) if length <= LONGEST_QUEUE => Ok(length),
        _ => Err(range(format!("at most {LONGEST_QUEUE}"))),
    }
}

fn timeout(text: &str) -> Result<Duration, Range> {
    let range = |rule: &str| Range { rule: rule.to_owned(), help: default("1s"), reason: None };
    let unit = text.find(|letter: char| letter.is_ascii_alphabetic()).unwrap_or(text.len());
    let number: f64 = text[..unit].trim().parse().unwrap_or(0.0);
    let seconds = match &text[unit..] {
        "us" => number / 1e6,
        "ms" => number / 1e3,
        _ => number,
    };
    if seconds > LONGEST_TIMEOUT.as_secs_f64() {
        return Err(range("at most a day, 86400s"));
    }
    // Less than a microsecond cannot be measured, so it counts as nothing.
    match Duration::try_from_secs_f64(seconds) {
        Ok(timeout) if timeout >= Duration::from_micros(1) => Ok(timeout),
        _ => Err(range("more than 0")),
    }
}

/// A word that the parser has refused stands for the default.
fn when_full(word: &str) -> WhenFull {
    WhenFull::ALL.into_iter().find(|known| known.word() == word).unwrap_or(GateOptions::default().when_full)
}

fn max_size(text: &str) -> Result<u64, Range> {
    let range = |rule: String, reason| {
        let help = default(&size::text(GateOptions::default().max_size));
        Range { rule, help, reason: Some(reason) }
    };
    match size::parse(text) {
        Ok(bytes @ 1..=GateOptions::LARGEST_MAX_SIZE) => Ok(bytes),
        Ok(0) | Err(SizeError::Negative | SizeError::Malformed) => {
            Err(range("at least 1B".to_owned(), "a gate with this limit would accept empty messages only"))
        }
        Ok(_) | Err(SizeError::TooLarge) => {
            let rule = format!("at most {}", size::text(GateOptions::LARGEST_MAX_SIZE));
            Err(range(rule, "a message is held in memory as a whole; send larger data in several messages"))
        }
    }
}

fn default(value: &str) -> String {
    format!("leave it out to get the default, {value}")
}

fn report(kind: Option<GateKind>, option: &OptionModel, range: Range) -> Diagnostic {
    let headline = format!("`{}` must be {}", option.key.value, range.rule);
    let mut found = RULE.at(headline, option.value.span, "").help(range.help);
    if let Some(reason) = range.reason {
        found = found.note(reason);
    }
    // Who mends the value should not have to come back for the place.
    match option_fit::misfit(kind, &option.key.value) {
        Some(rule) => found.note(rule),
        None => found,
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn option_value_out_of_range() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0409] `queue` must be at least 1
             --> topology.yaml:4:49
              |
            4 |       - measurements: {pub: Measurement, queue: 0}
              |                                                 ^
              |
              = help: leave it out to get the default, 100
              = note: each receiver says how many messages may wait for it; `queue` is for `sub` and `pull`
        "#]],
        );
    }

    #[test]
    fn ranges_have_two_ends() {
        let gates = [
            "sub: T, queue: 1",
            "sub: T, queue: -3",
            "sub: T, queue: 1000000",
            "sub: T, queue: 1000001",
            "sub: T, queue: 99999999999999999999",
            "rep: A -> B, max_size: 1B",
            "rep: A -> B, max_size: 0B",
            "pull: T, max_size: -1MiB",
            "req: A -> B, max_size: 1024MiB",
            "sub: T, max_size: 1025MiB",
            "sub: T, max_size: 99999999999999999999GiB",
            "req: A -> B, timeout: 0s",
            "req: A -> B, timeout: 1us",
            "req: A -> B, timeout: -1s",
            "req: A -> B, timeout: 86401s",
        ];
        let advice = |gate: &str| {
            advice(&format!("components:\n  - name: a\n    gates:\n      - x: {{{gate}, unconnected: ok}}\n"))
        };
        let told: String = gates.iter().map(|gate| format!("{gate}: {}\n", advice(gate))).collect();
        expect![[r#"
            sub: T, queue: 1: 
            sub: T, queue: -3: SCL0409 `queue` must be at least 1 [leave it out to get the default, 100]
            sub: T, queue: 1000000: 
            sub: T, queue: 1000001: SCL0409 `queue` must be at most 1000000 [leave it out to get the default, 100]
            sub: T, queue: 99999999999999999999: SCL0409 `queue` must be at most 1000000 [leave it out to get the default, 100]
            rep: A -> B, max_size: 1B: 
            rep: A -> B, max_size: 0B: SCL0409 `max_size` must be at least 1B [leave it out to get the default, 64MiB]
            pull: T, max_size: -1MiB: SCL0409 `max_size` must be at least 1B [leave it out to get the default, 64MiB]
            req: A -> B, max_size: 1024MiB: 
            sub: T, max_size: 1025MiB: SCL0409 `max_size` must be at most 1GiB [leave it out to get the default, 64MiB]
            sub: T, max_size: 99999999999999999999GiB: SCL0409 `max_size` must be at most 1GiB [leave it out to get the default, 64MiB]
            req: A -> B, timeout: 0s: SCL0409 `timeout` must be more than 0 [leave it out to get the default, 1s]
            req: A -> B, timeout: 1us: 
            req: A -> B, timeout: -1s: SCL0409 `timeout` must be more than 0 [leave it out to get the default, 1s]
            req: A -> B, timeout: 86401s: SCL0409 `timeout` must be at most a day, 86400s [leave it out to get the default, 1s]
        "#]].assert_eq(&told);
    }
}
