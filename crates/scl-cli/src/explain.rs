//! `scl explain`: what a code of the checker or a word of the topology file or the launch file means.

use crate::exit::COULD_NOT_DO;
use clap::Args;
#[cfg(feature = "run")]
use scl_run::launch_keys;
use scl_terminal::{print_err, print_out};
use scl_topology::catalogue::{self, ALL};
use scl_topology::diagnostic::{Rule, Severity};
use scl_topology::grammar::{self, Entry};
use scl_topology::suggest::similar;
use std::process::ExitCode;

/// Explain a code of the checker, or a word of the topology file or the launch file; without one, list them all.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl explain SCL0502
  scl explain 502        the same
  scl explain queue      an option; likewise sections, keys, kinds of gate, queue policies and codecs
  scl explain restart    a key of launch files
  scl explain | grep -i codec

Exit code: 0 explained, 2 there is no such code or word.")]
pub(crate) struct ExplainArguments {
    /// For example `SCL0502`, as it stands in brackets at the start of a problem, or `queue`.
    #[arg(value_name = "CODE|WORD")]
    word: Option<String>,
}

/// The body of `scl explain`.
pub(crate) fn explain(arguments: &ExplainArguments) -> ExitCode {
    let Some(written) = &arguments.word else {
        let entries = grammar::entries();
        let lines = all_rules().into_iter().map(line).chain(entries.iter().map(word_line));
        print_out(&lines.chain(launch_keys().iter().map(|(entry, _)| word_line(entry))).collect::<String>());
        return ExitCode::SUCCESS;
    };
    let code = full_code(written);
    let word = written.trim_matches([':', '`', ' ']).to_ascii_lowercase();
    let keys = launch_keys().into_iter().filter(|(key, _)| key.word == word).map(|(key, _)| key.text);
    let found: Vec<String> = explain_rule(&code).or_else(|| grammar::explain(&word)).into_iter().chain(keys).collect();
    match (!found.is_empty()).then(|| found.iter().map(|text| text.trim_end()).collect::<Vec<_>>().join("\n\n")) {
        Some(text) => {
            print_out(&format!("{}\n", text.trim_end()));
            ExitCode::SUCCESS
        }
        None if is_like_code(&code) => {
            print_err(&unknown(written, &code));
            ExitCode::from(COULD_NOT_DO)
        }
        None => {
            print_err(&unknown_word(written, &word));
            ExitCode::from(COULD_NOT_DO)
        }
    }
}

/// Whether a word looks like a code: it starts with `SCL` or contains a digit, unlike the words of the topology file.
fn is_like_code(code: &str) -> bool {
    code.starts_with("SCL") || code.bytes().any(|byte| byte.is_ascii_digit())
}

/// Returns the message that there is no such word, with similar words that may have been meant.
fn unknown_word(written: &str, word: &str) -> String {
    let mut text =
        format!("error: `{written}` is neither a code of the checker nor a word of the topology or the launch file\n");
    let (entries, keys) = (grammar::entries(), launch_keys());
    // Keys that other tools call by this word.
    let known = keys.iter().filter(|(_, also)| also.contains(&word)).map(|(key, _)| key.word);
    let entries: Vec<&Entry> = entries.iter().chain(keys.iter().map(|(key, _)| key)).collect();
    let words = entries.iter().map(|entry| entry.word);
    let mut likely: Vec<&str> = known.chain(similar(word, words)).collect();
    likely.dedup();
    for near in likely {
        let meanings = entries.iter().filter(|entry| entry.word == near).map(|entry| entry.what);
        let meanings: Vec<&str> = meanings.collect();
        text.push_str(&format!("  = help: a similar word exists: `{near}` ({})\n", meanings.join(", ")));
    }
    text + "  = help: `scl explain` lists all of them\n"
}

/// The rules about topologies, and those about launch files if this program reads such files.
pub(crate) fn all_rules() -> Vec<&'static Rule> {
    #[cfg(feature = "run")]
    let of_launch_files = scl_run::LAUNCH_RULES;
    #[cfg(not(feature = "run"))]
    let of_launch_files = &[][..];
    [&ALL[..], of_launch_files].concat()
}

/// The entry of a code, as Markdown; none if there is no such code.
pub(crate) fn explain_rule(code: &str) -> Option<String> {
    #[cfg(feature = "run")]
    let of_launch_files = scl_run::explain_launch_rule(code);
    #[cfg(not(feature = "run"))]
    let of_launch_files = None;
    catalogue::explain(code).or(of_launch_files)
}

/// Returns nothing: this build reads no launch files.
#[cfg(not(feature = "run"))]
fn launch_keys() -> Vec<(Entry, &'static [&'static str])> {
    Vec::new()
}

/// Normalizes a code: `scl0502`, `[SCL0502]`, `502` and `scl::SCL0502`, as editors show it, all become `SCL0502`.
pub(crate) fn full_code(written: &str) -> String {
    let word = written.trim_matches(['[', ']', ' ']).rsplit(':').next().unwrap_or_default().to_ascii_uppercase();
    let is_number = !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { format!("SCL{word:0>4}") } else { word }
}

/// Returns the message that there is no such code, with similar codes that may have been meant.
pub(crate) fn unknown(written: &str, code: &str) -> String {
    let mut text = format!("error: there is no check `{written}`\n");
    let rules = all_rules();
    let near = similar(code, rules.iter().map(|rule| rule.code));
    text.extend(near.iter().map(|near| format!("  = help: a similar code exists: `{near}`{}\n", titled(near))));
    text + "  = help: `scl explain` lists all of them\n"
}

fn titled(code: &str) -> String {
    all_rules().iter().find(|rule| rule.code == code).map_or_else(String::new, |rule| format!(", {}", rule.title))
}

/// `SCL0502  error  unknown gate`
fn line(rule: &Rule) -> String {
    let level = match rule.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Lint => "off",
    };
    format!("{}  {level:7}  {}\n", rule.code, rule.title)
}

/// `queue  option  How many messages may wait for this gate`
fn word_line(entry: &Entry) -> String {
    format!("{:12}  {:19}  {}\n", entry.word, entry.what, entry.summary)
}

#[cfg(test)]
mod tests {
    use super::full_code;

    #[test]
    fn codes_are_found_as_people_copy_them() {
        for written in ["SCL0502", "scl0502", "[SCL0502]", "502", "0502", "scl::SCL0502"] {
            assert_eq!(full_code(written), "SCL0502", "{written}");
        }
        for (written, code) in [("", ""), ("12345", "SCL12345"), ("unknown gate", "UNKNOWN GATE"), ("::", "")] {
            assert_eq!(full_code(written), code, "{written}");
        }
    }
}
