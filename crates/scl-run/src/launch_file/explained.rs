//! The keys of launch files with their documentation, for `scl explain`.

use super::keys::{COMPONENT, GATEWAY, HOST, Key, TOP};

/// A key of launch files with its documentation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LaunchKey {
    /// As in the file.
    pub word: &'static str,
    /// Names that other tools use for it.
    pub also: &'static [&'static str],
    /// Where it stands: `key of a host`.
    pub what: &'static str,
    /// What it means, in one sentence.
    pub summary: &'static str,
    /// Everything there is to know, as Markdown.
    pub text: String,
}

/// Every key of launch files, in the order of the page.
pub fn launch_keys() -> Vec<LaunchKey> {
    let all = [
        (TOP, "key of a launch file"),
        (COMPONENT, "key of a program"),
        (HOST, "key of a host"),
        (GATEWAY, "key of `gateway`"),
    ];
    all.iter().flat_map(|(keys, what)| keys.iter().map(|key| explained(key, what))).collect()
}

fn explained(key: &Key, what: &'static str) -> LaunchKey {
    // Links lead to other parts of the page.
    let sentences = without_links(key.meaning);
    let summary = key.meaning.split(". ").next().unwrap_or_default().trim_end_matches('.');
    let meaning = sentences.split(" See ").next().unwrap_or_default();
    let defaults = if key.in_defaults { "It may also stand in `defaults`, for all programs.\n" } else { "" };
    let text = format!(
        "# {} ({what})\n\n{meaning}\n\nValue: {}\nDefault: {}\n{defaults}\nSee docs/launch.md.\n",
        key.name,
        without_links(&key.form.description()),
        without_links(key.default),
    );
    LaunchKey { word: key.name, also: key.also, what, summary, text }
}

/// `[Hosts](#hosts)` as `Hosts`.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('[') {
        let Some((name, after)) =
            after.split_once("](").and_then(|(name, after)| Some((name, after.split_once(')')?.1)))
        else {
            break;
        };
        plain.push_str(before);
        plain.push_str(name);
        rest = after;
    }
    plain + rest
}
