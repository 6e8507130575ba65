//! Numbers for people: counts, bytes, rates and ages with few digits.

use std::time::Duration;

const SIZES: [(f64, &str); 4] =
    [(1024.0 * 1024.0 * 1024.0, "GiB"), (1024.0 * 1024.0, "MiB"), (1024.0, "KiB"), (1.0, "B")];

/// A number of bytes with three digits: `512 B`, `1.25 KiB`.
pub fn bytes_text(bytes: f64) -> String {
    let (unit, word) = SIZES.into_iter().find(|(unit, _)| bytes >= *unit).unwrap_or((1.0, "B"));
    if unit == 1.0 { format!("{bytes:.0} B") } else { format!("{} {word}", three_digits(bytes / unit)) }
}

/// A number with about three digits, at most two of them after the decimal point: `0.05`, `12.5`, `1000`.
pub fn three_digits(number: f64) -> String {
    match number {
        ..10.0 => format!("{number:.2}"),
        ..100.0 => format!("{number:.1}"),
        _ => format!("{number:.0}"),
    }
}

/// A duration or an age in its largest units: `0.5 s`, `12 s`, `3 min`, `2 h 5 min`, `4 d 1 h`.
pub fn age_text(age: Duration) -> String {
    let seconds = age.as_secs();
    let two = |large: u64, large_word, small: u64, small_word| match small {
        0 => format!("{large} {large_word}"),
        _ => format!("{large} {large_word} {small} {small_word}"),
    };
    match seconds {
        0..10 => format!("{:.1} s", age.as_secs_f64()),
        10..120 => format!("{seconds} s"),
        120..7200 => format!("{} min", seconds / 60),
        7200..172_800 => two(seconds / 3600, "h", seconds / 60 % 60, "min"),
        _ => two(seconds / 86_400, "d", seconds / 3600 % 24, "h"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_have_few_digits() {
        let bytes = [(0.0, "0 B"), (1023.0, "1023 B"), (1280.0, "1.25 KiB"), (20.0 * 1024.0 * 1024.0, "20.0 MiB")];
        bytes.into_iter().for_each(|(number, expected)| assert_eq!(bytes_text(number), expected));
        for (number, expected) in [(0.05, "0.05"), (12.54, "12.5"), (1000.4, "1000")] {
            assert_eq!(three_digits(number), expected);
        }
        let ages =
            [(500, "0.5 s"), (12_900, "12 s"), (185_000, "3 min"), (7_500_000, "2 h 5 min"), (349_200_000, "4 d 1 h")];
        ages.into_iter().for_each(|(age, expected)| assert_eq!(age_text(Duration::from_millis(age)), expected));
    }
}
