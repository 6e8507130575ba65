//! Values as systemd reads them: `systemd.syntax(7)`, `systemd.time(7)`.

use std::path::Path;
use std::time::Duration;

/// Quotes a word for a command line or `Environment=`. In a command line, `$` is escaped, because it would start a
/// variable.
pub(super) fn quoted(word: &str, in_command: bool) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-:=,+@".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    let escaped: String = word.chars().map(|letter| escaped(letter, in_command)).collect();
    format!("\"{escaped}\"")
}

fn escaped(letter: char, in_command: bool) -> String {
    match letter {
        '"' | '\\' => format!("\\{letter}"),
        '%' => "%%".to_owned(),
        '$' if in_command => "$$".to_owned(),
        letter if letter.is_ascii_control() => format!("\\x{:02x}", u32::from(letter)),
        letter => letter.to_string(),
    }
}

/// The `Environment=` line of a variable.
pub(super) fn environment((name, value): &(String, String)) -> String {
    format!("Environment={}\n", quoted(&format!("{name}={value}"), false))
}

/// A path as the whole value of a key, which is not quoted there.
pub(super) fn path(path: &Path) -> String {
    path.display().to_string().replace('%', "%%")
}

/// A time span in the largest unit in which it is a whole number.
pub(super) fn duration(time: Duration) -> String {
    match (time.as_micros(), time.as_millis(), time.as_secs()) {
        (micros, _, _) if micros % 1000 != 0 => format!("{micros}us"),
        (_, millis, _) if millis % 1000 != 0 => format!("{millis}ms"),
        (_, _, seconds) => format!("{seconds}s"),
    }
}
