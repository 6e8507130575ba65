//! What a value of the wrong form may mean: numbers, durations and sizes as other formats and other people write them.

mod parameter;
mod product;

pub use parameter::meant_values;

use crate::grammar::Shape;
use crate::habits;
use crate::suggest::similar;
use crate::yaml::{Node, NodeKind};
use product::product;
use scl_text::{duration, rate, size};
use std::time::Duration;

/// The values that may be meant, and whether the only one certainly is.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Meant {
    pub(super) values: Vec<String>,
    pub(super) is_certain: bool,
}

/// The seconds of units of time that a topology does not have.
const OTHER_UNITS: [(f64, &[&str]); 3] = [
    (1e-9, &["ns", "nsec", "nanosec", "nanosecs", "nanos", "nanosecond", "nanoseconds"]),
    (86_400.0, &["d", "day", "days"]),
    (604_800.0, &["w", "week", "weeks"]),
];

const NUMBERS: [&str; 13] =
    ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"];

/// The number from which a wait without a unit is rather in milliseconds than in seconds.
const MANY: u64 = 100;

/// What a value may mean; `key` is the option or key that has it.
pub(super) fn meant(key: &str, value: &Node, shape: Shape) -> Meant {
    match &value.kind {
        NodeKind::Scalar { text, .. } => of_text(key, text.trim(), shape),
        NodeKind::Sequence { items } => {
            // One of several, or one in brackets.
            let fits = |item: &Node| item.text().filter(|text| shape.fits(text, item.is_plain())).map(str::to_owned);
            Meant { values: items.iter().filter_map(fits).take(3).collect(), is_certain: false }
        }
        NodeKind::Mapping { entries } if matches!(shape, Shape::Duration { .. }) => {
            let part = |(unit, number): &(Node, Node)| seconds(number.text()?, unit.text()?);
            let parts: Option<Vec<f64>> = entries.iter().map(part).collect();
            Meant { values: parts.and_then(total).into_iter().collect(), is_certain: true }
        }
        _ => Meant::default(),
    }
}

fn of_text(key: &str, text: &str, shape: Shape) -> Meant {
    // `<16>` is a value in the notation of a device tree, or of a form that is to be filled in.
    let text = text.strip_prefix('<').and_then(|text| text.strip_suffix('>')).unwrap_or(text);
    match (shape, product(text)) {
        (Shape::Number { .. } | Shape::Duration { .. }, Some(product)) => return of_text(key, &product, shape),
        (Shape::Size { .. }, Some(product)) => return Meant { values: vec![bytes(&product, text)], is_certain: true },
        _ => {}
    }
    let (values, is_certain) = match shape {
        Shape::Number { .. } => numbers(text),
        Shape::Duration { .. } => durations(text),
        Shape::Rate { .. } => (rate::meant(text).or_else(|| rate::of_period(text)).into_iter().collect(), true),
        Shape::Size { .. } => sizes(text),
        Shape::Boolean => match habits::boolean(text) {
            Some(word) => (vec![word.to_owned()], true),
            // The number of those that share.
            None if key == "share" && text.parse().is_ok_and(|number: u32| number > 1) => {
                (vec!["true".to_owned()], false)
            }
            None => words(key, text, &["true", "false"]),
        },
        Shape::Word(known) => words(key, text, &known.iter().map(|known| known.word).collect::<Vec<_>>()),
        _ => (Vec::new(), false),
    };
    Meant { values, is_certain }
}

/// The result of a product as a size: without a unit, it is a number of bytes.
fn bytes(product: &str, written: &str) -> String {
    match product.parse::<u64>() {
        Ok(bytes) if bytes % (1 << 20) == 0 || written.contains("1024") => size::text(bytes),
        Ok(bytes) => format!("{bytes}B"),
        Err(_) => size::suggestions(product).into_iter().next().unwrap_or_else(|| product.to_owned()),
    }
}

/// The known word in another spelling, the one for a word of another tool, or similar ones.
fn words(key: &str, text: &str, known: &[&str]) -> (Vec<String>, bool) {
    let compact = habits::compact(text);
    if let Some(word) = known.iter().find(|word| habits::compact(word) == compact) {
        return (vec![(*word).to_owned()], true);
    }
    let ways = match habits::of_value(key, text) {
        Some(habit) => habit.ways.to_vec(),
        None => similar(&text.to_lowercase(), known.iter().copied()),
    };
    (ways.into_iter().map(str::to_owned).collect(), false)
}

/// Whole numbers: in quotes, with marks between the thousands, of base 16, 8 or 2, in words.
fn numbers(text: &str) -> (Vec<String>, bool) {
    let lower = text.to_lowercase();
    if let Some(number) = based(&lower).or_else(|| joined(&lower).parse().ok()) {
        return (vec![number.to_string()], true);
    }
    if let Some(number) = NUMBERS.iter().position(|word| *word == lower) {
        return (vec![number.to_string()], false);
    }
    let mut values: Vec<String> = thousands(&lower).into_iter().collect();
    // `5.0` and `1e3` are whole.
    let fraction = lower.parse::<f64>().ok().filter(|number| number.fract() == 0.0 && (0.0..1e9).contains(number));
    values.extend(fraction.map(|number| number.to_string()));
    let thousand = |suffix: char, factor: u64| Some(lower.strip_suffix(suffix)?.parse::<u32>().ok()? as u64 * factor);
    values.extend(thousand('k', 1000).or_else(|| thousand('m', 1_000_000)).map(|number| number.to_string()));
    values.dedup();
    (values, false)
}

/// `0x10`, `0o20`, `0b10000`.
fn based(text: &str) -> Option<u64> {
    let (prefix, digits) = text.split_at_checked(2)?;
    let base = match prefix {
        "0x" => 16,
        "0o" => 8,
        "0b" => 2,
        _ => return None,
    };
    u64::from_str_radix(&joined(digits), base).ok()
}

/// A number without the marks between its thousands that nothing else can be.
fn joined(text: &str) -> String {
    text.chars().filter(|letter| !matches!(letter, '_' | '\'' | ' ' | '\u{a0}' | '\u{202f}')).collect()
}

/// `1,000` and `1.000`: three digits after each mark.
fn thousands(text: &str) -> Option<String> {
    let mut groups = text.split([',', '.']);
    let first = groups.next().filter(|first| (1..=3).contains(&first.len()))?;
    let rest: Vec<&str> = groups.collect();
    let is_number = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let is_right =
        !rest.is_empty() && is_number(first) && rest.iter().all(|group| group.len() == 3 && is_number(group));
    is_right.then(|| format!("{first}{}", rest.concat()))
}

/// A number with its fraction after a dot.
fn decimal(number: &str) -> Option<String> {
    let number = joined(number).replacen(',', ".", 1);
    number.parse::<f64>().is_ok_and(f64::is_finite).then_some(number)
}

/// Durations: without a unit, with the units of other languages, of ISO 8601, of a PLC, of a clock.
fn durations(text: &str) -> (Vec<String>, bool) {
    let lower = text.to_lowercase();
    let lower = ["t#", "time#"].into_iter().find_map(|prefix| lower.strip_prefix(prefix)).unwrap_or(&lower);
    let lower = call(lower).unwrap_or_else(|| lower.to_owned());
    if let Ok(number) = joined(&lower).parse::<u64>() {
        let units = if number >= MANY { ["ms", "s"] } else { ["s", "ms"] };
        let values = units.into_iter().filter(|_| number > 0).map(|unit| format!("{number}{unit}"));
        return (values.collect(), false);
    }
    if let Some(number) = decimal(&lower).filter(|number| !number.starts_with(['-', '+'])) {
        let is_zero = number.trim_matches(['0', '.']).is_empty();
        return (if is_zero { Vec::new() } else { vec![format!("{number}s")] }, false);
    }
    let clock: Option<Vec<f64>> = lower.split(':').map(|part| part.parse().ok()).collect();
    if let Some(clock) = clock.filter(|clock| (2..=3).contains(&clock.len())) {
        let seconds = clock.iter().fold(0.0, |sum, part| sum * 60.0 + part);
        return (total(vec![seconds]).into_iter().collect(), clock.len() == 3);
    }
    if let Some(period) = rate::period(&lower).filter(|period| period.subsec_nanos() % 1000 == 0) {
        return (vec![duration::text(period)], false);
    }
    (with_units(lower.strip_prefix("pt").unwrap_or(&lower)).into_iter().collect(), true)
}

/// `K_MSEC(500)`, `Duration::from_millis(500)`, `timedelta(seconds=5)`: the number with its unit.
fn call(text: &str) -> Option<String> {
    let (function, number) = text.strip_suffix(')')?.split_once('(')?;
    let (unit, number) = number.rsplit_once('=').unwrap_or((function, number));
    Some(format!("{}{}", number.trim(), unit.trim().rsplit([':', '.', '_']).next()?))
}

/// `2 sec`, `1m30s`.
fn with_units(text: &str) -> Option<String> {
    let mut parts: Vec<(&str, &str)> = Vec::new();
    let mut rest = text.trim();
    while !rest.is_empty() {
        let (number, behind) = rest.split_at(rest.find(char::is_alphabetic)?);
        let end = behind.find(|letter: char| !letter.is_alphabetic()).unwrap_or(behind.len());
        let (unit, behind) = behind.split_at(end);
        parts.push((number.trim(), unit));
        rest = behind.trim_start();
    }
    if let [(number, unit)] = parts.as_slice() {
        let known = duration::unit(unit)?;
        return Some(format!("{}{known}", decimal(number)?)).filter(|text| duration::parse(text).is_ok());
    }
    total(parts.into_iter().map(|(number, unit)| seconds(number, unit)).collect::<Option<_>>()?)
}

fn seconds(number: &str, unit: &str) -> Option<f64> {
    let unit = unit.to_lowercase();
    let known = duration::unit(&unit).and_then(|known| duration::UNITS.iter().find(|(word, _)| *word == known));
    let other = || OTHER_UNITS.iter().find(|(_, words)| words.contains(&unit.as_str())).map(|(factor, _)| *factor);
    let factor = known.map(|(_, factor)| *factor).or_else(other)?;
    Some(decimal(number)?.parse::<f64>().ok()? * factor)
}

fn total(seconds: Vec<f64>) -> Option<String> {
    let sum = Duration::try_from_secs_f64(seconds.iter().sum()).ok()?;
    Some(duration::text(sum)).filter(|_| !sum.is_zero())
}

/// Sizes: without a unit, with other units, with marks between the thousands.
fn sizes(text: &str) -> (Vec<String>, bool) {
    if let Some(bytes) = based(&text.to_lowercase()) {
        return (size::suggestions(&bytes.to_string()), false);
    }
    let mut values = size::suggestions(&joined(text));
    let is_certain = !values.is_empty();
    let (number, unit) = text.split_at(text.find(char::is_alphabetic).unwrap_or(text.len()));
    if values.is_empty() {
        let numbers = [thousands(number.trim()), decimal(number)];
        values.extend(numbers.into_iter().flatten().flat_map(|number| size::suggestions(&format!("{number}{unit}"))));
    }
    values.dedup();
    (values, is_certain)
}

#[cfg(test)]
mod tests {
    use super::{durations, numbers, sizes};

    #[test]
    fn numbers_of_other_people_are_understood() {
        let told = |read: fn(&str) -> (Vec<String>, bool), texts: &[&str]| -> Vec<String> {
            texts.iter().map(|text| read(text).0.join(" ")).collect()
        };
        let texts = ["16", "0x10", "1_000", "1'000", "1 000", "1,000", "1.000", "5.0", "1e3", "2k", "two", "many", "-"];
        let numbers = told(numbers, &texts);
        assert_eq!(numbers, ["16", "16", "1000", "1000", "1000", "1000", "1000 1", "5", "1000", "2000", "2", "", ""]);
        let texts = [
            "2000", "5", "0", "0.1", "1,5s", "2 sec", "PT1.5S", "00:00:02", "1m30s", "500MS", "2d", "-1", "soon",
            "0.0", "200 Hz", "300Hz",
        ];
        let durations = told(durations, &texts);
        assert_eq!(durations.join(","), "2000ms 2000s,5s 5ms,,0.1s,1.5s,2s,1.5s,2s,90s,500ms,,,,,5ms,");
        let texts = ["8MB", "8_000_000", "1,5 MiB", "1,000 KB", "0x100000", "large"];
        let sizes = told(sizes, &texts);
        assert_eq!(sizes, ["8MiB", "8000000B", "1536KiB", "1000KiB 1KiB", "1048576B 1MiB", ""]);
    }

    #[test]
    fn durations_of_programs_are_understood() {
        let texts = ["T#500ms", "TIME#1m30s", "K_MSEC(500)", "Duration::from_secs(2)", "timedelta(minutes=1)"];
        assert_eq!(texts.map(|text| durations(text).0.concat()), ["500ms", "90s", "500ms", "2s", "1min"]);
    }
}
