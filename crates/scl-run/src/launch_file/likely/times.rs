//! Times, delays and limits of restarts in other spellings.

use super::super::forms::{limit, restart_delay, restart_limit};
use super::Likely;
use scl_text::{duration, rate};
use std::time::Duration;

/// The unit that a word means, and how many of it.
fn unit_of(word: &str) -> Option<(&'static str, u64)> {
    match word {
        "d" | "day" | "days" => Some(("h", 24)),
        _ => match duration::unit(word)? {
            "min" => Some(("m", 1)),
            unit => Some((unit, 1)),
        },
    }
}

/// A time in another spelling.
pub(super) fn time(text: &str) -> Likely {
    let plain = decimal(text);
    if let Ok(number) = plain.parse::<f64>() {
        // Most tools count in seconds; large numbers may be milliseconds.
        let units: &[&str] = if number >= 100.0 { &["ms", "s"] } else { &["s"] };
        let values = units.iter().map(|unit| format!("{plain}{unit}"));
        return Likely::possible(values.filter(|value| limit(value).is_some()));
    }
    if let Some(period) = rate::period(&plain) {
        return Likely::possible([duration::text(period)]);
    }
    let clock: Option<Vec<u64>> = text.split(':').map(|part| part.parse().ok()).collect();
    if let Some([hours, minutes, seconds]) = clock.as_deref() {
        let parts = [("h", hours), ("m", minutes), ("s", seconds)].into_iter().filter(|(_, number)| **number > 0);
        return Likely::certain(time_of(&parts.map(|(unit, number)| format!("{number}{unit}")).collect::<String>()));
    }
    let half = text.get(..text.len() / 2).filter(|half| text.ends_with(half));
    match half.and_then(time_of) {
        // Written twice.
        Some(once) => Likely::certain(Some(once)),
        None => Likely::certain(time_of(text).filter(|value| limit(value).is_some())),
    }
}

/// A time as this format writes it: one part as it is, several as their sum.
fn time_of(text: &str) -> Option<String> {
    let text = decimal(text).to_lowercase();
    let mut rest = text.trim();
    let mut parts = Vec::new();
    while !rest.is_empty() {
        let digits = rest.find(|letter: char| !letter.is_ascii_digit() && letter != '.').unwrap_or(rest.len());
        let (number, after) = rest.split_at(digits);
        let after = after.trim_start();
        let letters = after.find(|letter: char| !letter.is_alphabetic()).unwrap_or(after.len());
        let (unit, behind) = after.split_at(letters);
        let (unit, factor) = unit_of(unit)?;
        // A unit alone, as in `per minute`.
        let number = if number.is_empty() && parts.is_empty() { "1" } else { number };
        let number = match factor {
            1 => number.to_owned(),
            factor => number.parse::<u64>().ok()?.checked_mul(factor)?.to_string(),
        };
        if parts.iter().any(|part: &String| part.ends_with(unit)) {
            return None;
        }
        parts.push(format!("{number}{unit}"));
        rest = behind.trim_start_matches([' ', ',', '_']);
    }
    match parts.as_slice() {
        [] => None,
        [one] => duration::parse(one).ok().map(|_| one.clone()),
        several => {
            let parts = several.iter().map(|part| duration::parse(part).ok());
            let sum = parts.sum::<Option<Duration>>()?;
            let (seconds, is_whole) = (sum.as_secs(), sum.subsec_nanos() == 0);
            Some(match is_whole && seconds % 60 == 0 {
                true if seconds % 3600 == 0 => format!("{}h", seconds / 3600),
                true => format!("{}m", seconds / 60),
                false => duration::text(sum),
            })
        }
    }
}

/// Digits without separators, and with a decimal point.
fn decimal(text: &str) -> String {
    let is_comma = text.matches(',').count() == 1;
    text.replace('_', "").replace(',', if is_comma { "." } else { "," })
}

fn time_or_seconds(text: &str) -> Option<String> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(_) => duration::parse(&format!("{text}s")).ok().map(|_| format!("{text}s")),
        Err(_) => time_of(text),
    }
}

pub(super) fn delay_range(text: &str) -> Likely {
    let text = text.trim_matches(['[', ']', '(', ')']);
    let separators = ["...", "..=", "..", "…", " to ", "–", "-", "/", ";"];
    let Some((first, last)) = separators.iter().find_map(|separator| text.split_once(separator)) else {
        let is_number = text.parse::<f64>().is_ok();
        let meant = time_or_seconds(text);
        return if is_number { Likely::possible(meant) } else { Likely::certain(meant) };
    };
    // `1-5s`: the first has the unit of the last.
    let unit = last.trim_start_matches(|letter: char| letter.is_ascii_digit() || ". ".contains(letter));
    let first = if first.trim().parse::<f64>().is_ok() { format!("{}{unit}", first.trim()) } else { first.to_owned() };
    let (Some(first), Some(last)) = (time_or_seconds(&first), time_or_seconds(last)) else { return Likely::default() };
    let (meant, turned) = (format!("{first}..{last}"), format!("{last}..{first}"));
    match restart_delay(&meant) {
        Some(_) => Likely::certain(Some(meant)),
        // The second time is the shorter one.
        None => Likely::possible(restart_delay(&turned).map(|_| [turned, first]).into_iter().flatten()),
    }
}

pub(in super::super) fn limit_of_restarts(text: &str) -> Likely {
    let digits = text.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(text.len());
    let (count, rest) = text.split_at(digits);
    // Zero may mean no restart, or no limit.
    if count.bytes().all(|digit| digit == b'0') {
        return Likely::default();
    }
    let noise = ["times", "restarts", "within", "in", "per", "every", "an", "a", "one", "x", "/", ",", ";", ":", "@"];
    let mut within = rest.trim();
    while let Some(shorter) = noise.iter().find_map(|word| {
        let is_letter = word.chars().all(char::is_alphabetic);
        let after = within.strip_prefix(word)?;
        (!is_letter || after.is_empty() || after.starts_with([' ', '/'])).then_some(after)
    }) {
        within = shorter.trim_start();
    }
    if within.is_empty() {
        return Likely::possible([format!("{count} in 1m")]);
    }
    let meant = time_or_seconds(within).map(|within| format!("{count} in {within}"));
    let values: Vec<String> = meant.filter(|meant| restart_limit(meant).is_some()).into_iter().collect();
    Likely { is_certain: !values.is_empty() && within.contains(char::is_alphabetic), values }
}
