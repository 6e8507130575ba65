//! What a wrong value probably means: other spellings, and the words of other tools.

mod times;

use super::forms::{limit, priority, restart_delay, restart_limit};
use super::keys::{Form, form_of};
use super::value::{flag, number, port, processors, texts};
use super::words::{bare, flow_word};
use scl_terminal::closest_name;
use scl_text::duration;
use scl_text::suggest::boolean;
use scl_topology::yaml::Node;
use times::{delay_range, time};

pub(super) use times::limit_of_restarts;

/// What may be meant by a wrong value.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Likely {
    /// The values to write, the most probable first.
    pub(super) values: Vec<String>,
    /// Whether the value can have meant nothing else.
    pub(super) is_certain: bool,
}

impl Likely {
    fn certain(value: Option<String>) -> Self {
        Self { is_certain: value.is_some(), values: value.into_iter().collect() }
    }

    fn possible(values: impl IntoIterator<Item = String>) -> Self {
        Self { values: values.into_iter().collect(), is_certain: false }
    }
}

/// The largest processor number in a range, so that a slip does not make a list of thousands.
const LARGEST_PROCESSOR: usize = 1023;

/// Words of other tools for values: the key, the words without case and marks, and the value here.
const WORDS: &[(&str, &[&str], &str)] = &[
    ("restart", &["no", "false", "off", "none", "onlyonce"], "never"),
    ("restart", &["true", "yes", "on", "unlessstopped", "any", "forever"], "always"),
    ("restart", &["unexpected", "onerror", "onfail"], "on_failure"),
    ("restart", &["onabort", "onwatchdog", "oncrash"], "on_abnormal"),
    ("input", &["true", "yes", "on", "tty", "stdin", "inherit", "console"], "terminal"),
    ("input", &["false", "no", "off", "null", "none", "devnull"], "empty"),
    ("transport", &["unix", "uds", "domain", "local", "socket"], "ipc"),
    ("transport", &["sharedmemory", "sharedmem", "shmem", "iceoryx", "iceoryx2", "zerocopy"], "shm"),
    ("transport", &["network", "ethernet", "tcpip"], "tcp"),
];

/// Whether a value has the form that a key needs.
pub(super) fn fits(key: &str, value: &Node) -> bool {
    let text = || value.text().unwrap_or_default().trim();
    match form_of(key) {
        Form::Word(words) => words.contains(&text()),
        Form::Duration if key == "stop_within" => duration::parse(text()).is_ok(),
        Form::Duration => limit(text()).is_some(),
        Form::DelayRange => restart_delay(text()).is_some(),
        Form::RestartLimit => restart_limit(text()).is_some(),
        Form::Flag => flag(value).is_some(),
        Form::Processors => processors(value).is_some(),
        Form::Priority => priority(text()).is_some(),
        Form::Port => port(value).is_some(),
        Form::Other(_) if matches!(key, "environment" | "parameters" | "components" | "hosts" | "profiles") => {
            value.entries().is_some() || key == "components" && texts(value).is_some()
        }
        Form::Count => number(value).is_some_and(|number| number > 0),
        Form::Other(_) => true,
    }
}

/// Guesses what was meant by a value that the key does not accept.
pub(super) fn likely(key: &str, value: &Node) -> Likely {
    let form = form_of(key);
    if form == Form::Processors {
        if let Some(mask) = value.text().and_then(mask) {
            let processors: Vec<String> = (0..64).filter(|at| mask >> at & 1 == 1).map(|at| at.to_string()).collect();
            return Likely::possible([format!("[{}]", processors.join(", ")), mask.to_string()]);
        }
        let items = texts(value).or_else(|| Some(vec![value.text()?.to_owned()])).unwrap_or_default();
        let numbers: Option<Vec<usize>> =
            items.iter().map(|item| range(item)).collect::<Option<Vec<_>>>().map(|all| all.concat());
        let shown = |numbers: Vec<usize>| match numbers.as_slice() {
            [one] if value.items().is_none() => one.to_string(),
            all => format!("[{}]", all.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
        };
        return Likely::certain(numbers.filter(|numbers| !numbers.is_empty()).map(shown));
    }
    let joined =
        texts(value).filter(|items| items.len() == 1 || form == Form::DelayRange).map(|items| items.join(".."));
    let Some(text) = joined.or_else(|| value.text().map(|text| text.trim().to_owned())) else {
        return Likely::default();
    };
    let text = text.as_str();
    if form == Form::Other("a path") && value.items().is_some() {
        return Likely::certain(Some(flow_word(text)).filter(|_| !text.is_empty()));
    }
    match form {
        Form::Word(words) => word(key, text, words),
        Form::Flag => {
            let word = bare(text);
            Likely::certain(boolean(&word).or_else(|| closest_name(&word, ["true", "false"])).map(str::to_owned))
        }
        Form::Port => {
            let digits = text.trim_start_matches(|letter: char| !letter.is_ascii_digit()).split([':', '/']).next();
            let digits = digits.unwrap_or_default().replace(['_', ' '], "");
            Likely::certain(digits.parse::<u16>().ok().filter(|port| *port != 0).map(|port| port.to_string()))
        }
        Form::Count => Likely::certain(count(text).filter(|count| *count > 0).map(|count| count.to_string())),
        Form::Duration => time(text),
        Form::DelayRange => delay_range(text),
        Form::RestartLimit => limit_of_restarts(text),
        Form::Priority => {
            let number = text.rsplit(|letter: char| !letter.is_ascii_digit()).next().unwrap_or_default();
            let has_sign = text.starts_with('-');
            match number.parse::<u32>().ok().filter(|_| !has_sign) {
                Some(number @ 1..=99) => {
                    let is_other_policy = bare(text).starts_with(char::is_alphabetic) && !bare(text).contains("fifo");
                    let values = vec![format!("fifo:{number}")];
                    Likely { values, is_certain: !is_other_policy }
                }
                Some(100..) => Likely::possible(["fifo:99".to_owned()]),
                _ => Likely::default(),
            }
        }
        _ => Likely::default(),
    }
}

fn word(key: &str, text: &str, words: &'static [&'static str]) -> Likely {
    let bare_word = bare(text);
    let same = words.iter().find(|word| bare(word) == bare_word).copied();
    let other = || {
        let row = WORDS.iter().find(|(of, names, _)| *of == key && names.contains(&bare_word.as_str()));
        row.map(|(.., meant)| *meant)
    };
    // An address, as in `tcp://*:5555`, or a policy with a number, as in `on-failure:5`.
    let first = || {
        let head = text.split(':').next().filter(|head| head.len() < text.len())?;
        words.iter().find(|word| bare(word) == bare(head)).copied()
    };
    let near = || closest_name(&text.to_lowercase().replace(['-', ' '], "_"), words.iter().copied());
    match same.or_else(near).filter(|_| !bare_word.is_empty()) {
        Some(meant) => Likely::certain(Some(meant.to_owned())),
        None => Likely::possible(other().or_else(first).map(str::to_owned)),
    }
}

/// The processors of `2`, `2-3`, `2:3`, `0-3,6` or `0 2`.
fn range(text: &str) -> Option<Vec<usize>> {
    let mut numbers = Vec::new();
    let text =
        [" - ", " to ", "...", "..", ":"].into_iter().fold(text.to_owned(), |text, mark| text.replace(mark, "-"));
    for part in text.trim_matches(['[', ']', '{', '}']).split([',', ' ', ';']).filter(|part| !part.is_empty()) {
        let part = part.strip_prefix("cpu").or_else(|| part.strip_prefix("core")).unwrap_or(part);
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let (first, last) = (first.trim().parse::<usize>().ok()?, last.trim().parse::<usize>().ok()?);
        if first > last || last > LARGEST_PROCESSOR {
            return None;
        }
        numbers.extend(first..=last);
    }
    Some(numbers)
}

/// The processors of `taskset 0xC` and the like, as bits.
fn mask(text: &str) -> Option<u64> {
    let text = text.to_lowercase();
    let digits = text.strip_prefix("0x").map(|digits| (digits, 16)).or_else(|| Some((text.strip_prefix("0b")?, 2)));
    digits
        .and_then(|(digits, radix)| u64::from_str_radix(&digits.replace('_', ""), radix).ok())
        .filter(|mask| *mask > 0)
}

/// A number with separators or a factor: `4_096`, `64k`.
fn count(text: &str) -> Option<u64> {
    let text = text.to_lowercase().replace(['_', ' ', ',', '\''], "");
    let (digits, factor) = match text.strip_suffix('k') {
        Some(digits) => (digits, 1024),
        None => (text.as_str(), 1),
    };
    digits.parse::<u64>().ok()?.checked_mul(factor)
}

#[cfg(test)]
mod tests {
    use super::super::document::LaunchDocument;
    use expect_test::expect;

    /// The proposals for a value of a component's key.
    fn told(key: &str, value: &str) -> String {
        let text = format!("components:\n  a:\n    command: ls\n    {key}: {value}\n");
        let found = LaunchDocument::parse("launch.yaml", &text).check(None).1;
        let ways = found.iter().flat_map(|problem| problem.proposals()).map(|way| {
            let edits: Vec<&str> = way.edits.iter().map(|edit| edit.replacement.as_str()).collect();
            format!("{}{}", edits.join(" + "), if way.is_sure { "" } else { "?" })
        });
        let ways: Vec<String> = ways.collect();
        format!("{key}: {value} => {}\n", if ways.is_empty() { "-".to_owned() } else { ways.join(", ") })
    }

    #[test]
    fn other_spellings_of_values_are_understood() {
        let values: &[(&str, &[&str])] = &[
            (
                "stop_within",
                &[
                    "5",
                    "500",
                    "0,5s",
                    "1min 30s",
                    "1h30m",
                    "5 seconds",
                    "2 minutes",
                    "250 msec",
                    "1_000ms",
                    "3S",
                    "1d",
                    "soon",
                    "'7'",
                ],
            ),
            ("ready_within", &["0", "0s", "none", "infinity", "-1s", "20Hz", "1.5 kHz", "0Hz"]),
            ("restart", &["no", "true", "unless-stopped", "on-failure:5", "unexpected", "ON_FAILURE", "sometimes"]),
            (
                "restart_delay",
                &["5", "100ms-5s", "1-5s", "100ms to 5s", "[100ms, 5s]", "1s…5s", "5s..1s", "soon..later"],
            ),
            ("restart_limit", &["5", "5/1m", "5 per minute", "3 times in 10s", "5 in 60", "often"]),
            ("essential", &["yes", "'true'", "off", "1", "maybe"]),
            (
                "cpu",
                &["2-3", "0-1,4", "2 3", "'2'", "['2', 3]", "500m", "-1", "0-99999999", "all", "0x0C", "0b101", "0x0"],
            ),
            ("priority", &["80", "fifo 80", "SCHED_FIFO:80", "rr:10", "fifo:100", "-5", "high"]),
            ("descriptors", &["64k", "4_096", "'4096'", "unlimited", "0"]),
            ("input", &["true", "tty", "no", "file"]),
        ];
        let found: String =
            values.iter().flat_map(|(key, values)| values.iter().map(|value| told(key, value))).collect();
        expect![[r#"
            stop_within: 5 => 5s?
            stop_within: 500 => 500ms?, 500s?
            stop_within: 0,5s => 0.5s
            stop_within: 1min 30s => 90s
            stop_within: 1h30m => 90m
            stop_within: 5 seconds => 5s
            stop_within: 2 minutes => 2m
            stop_within: 250 msec => 250ms
            stop_within: 1_000ms => 1000ms
            stop_within: 3S => 3s
            stop_within: 1d => 24h
            stop_within: soon => -
            stop_within: '7' => 7s?
            ready_within: 0 => ?
            ready_within: 0s => ?
            ready_within: none => ?
            ready_within: infinity => ?
            ready_within: -1s => -
            ready_within: 20Hz => 50ms?
            ready_within: 1.5 kHz => 666us?
            ready_within: 0Hz => -
            restart: no => never?
            restart: true => always?
            restart: unless-stopped => always?
            restart: on-failure:5 => on_failure
            restart: unexpected => on_failure?
            restart: ON_FAILURE => on_failure
            restart: sometimes => -
            restart_delay: 5 => 5s?
            restart_delay: 100ms-5s => 100ms..5s
            restart_delay: 1-5s => 1s..5s
            restart_delay: 100ms to 5s => 100ms..5s
            restart_delay: [100ms, 5s] => 100ms..5s
            restart_delay: 1s…5s => 1s..5s
            restart_delay: 5s..1s => 1s..5s?, 5s?
            restart_delay: soon..later => -
            restart_limit: 5 => 5 in 1m?
            restart_limit: 5/1m => 5 in 1m
            restart_limit: 5 per minute => 5 in 1m
            restart_limit: 3 times in 10s => 3 in 10s
            restart_limit: 5 in 60 => 5 in 60s?
            restart_limit: often => -
            essential: yes => true
            essential: 'true' => true
            essential: off => false
            essential: 1 => true
            essential: maybe => -
            cpu: 2-3 => [2, 3]
            cpu: 0-1,4 => [0, 1, 4]
            cpu: 2 3 => [2, 3]
            cpu: '2' => 2
            cpu: ['2', 3] => [2, 3]
            cpu: 500m => -
            cpu: -1 => -
            cpu: 0-99999999 => -
            cpu: all => ?
            cpu: 0x0C => [2, 3]?, 12?
            cpu: 0b101 => [0, 2]?, 5?
            cpu: 0x0 => -
            priority: 80 => fifo:80
            priority: fifo 80 => fifo:80
            priority: SCHED_FIFO:80 => fifo:80
            priority: rr:10 => fifo:10?
            priority: fifo:100 => fifo:99?
            priority: -5 => -
            priority: high => -
            descriptors: 64k => 65536
            descriptors: 4_096 => 4096
            descriptors: '4096' => 4096
            descriptors: unlimited => -
            descriptors: 0 => -
            input: true => terminal?
            input: tty => terminal?
            input: no => empty?
            input: file => -
        "#]]
        .assert_eq(&found);
    }
}
