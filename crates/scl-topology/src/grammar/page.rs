//! The grammar as text for people: one entry for the terminal, all of it as the page `docs/topology.md`.

use super::queue_policy::POLICIES;
use super::{COMPONENT_KEYS, Codec, CodecRow, GateKind, GateOption, Key, KindRow, OPTIONS, SECTIONS, WhenFull, Word};
use scl_text::list::{all_of, quoted_list};
use scl_text::{duration, size};

/// A word of the grammar with its documentation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// The word as written in the file.
    pub word: &'static str,
    /// The kind of word, for example `option`.
    pub what: &'static str,
    /// What the word means, in one sentence.
    pub summary: &'static str,
    /// The full documentation, as Markdown, without a heading.
    pub text: String,
}

/// Every word of the grammar, in the order of the page.
pub fn entries() -> Vec<Entry> {
    let keys = |keys: &'static [Key], what| keys.iter().map(move |key| of_key(key, what));
    let mut all: Vec<Entry> = keys(&SECTIONS, "section").chain(keys(&COMPONENT_KEYS, "key of a component")).collect();
    all.extend(GateKind::ALL.map(of_kind));
    all.extend(OPTIONS.iter().map(of_option));
    all.extend(POLICIES.iter().map(of_policy));
    all.extend(Codec::BUILT_IN.iter().map(of_codec));
    all
}

/// Returns the documentation of a word of the grammar as Markdown, or `None` if the grammar does not have the word.
///
/// ```
/// use scl_topology::grammar::explain;
///
/// assert!(explain("queue").is_some_and(|text| text.starts_with("# queue (option)")));
/// assert_eq!(explain("que"), None);
/// ```
pub fn explain(word: &str) -> Option<String> {
    let found = entries().into_iter().filter(|entry| entry.word == word);
    let texts = found.map(|entry| format!("# {} ({})\n\n{}", entry.word, entry.what, without_references(&entry.text)));
    let texts: Vec<String> = texts.collect();
    (!texts.is_empty()).then(|| texts.join("\n"))
}

/// The reference page of the file format: `docs/topology.md`.
pub fn page() -> String {
    let option_entries: Vec<String> =
        OPTIONS.iter().map(|option| format!("### {}\n\n{}", option.key, of_option(option).text)).collect();
    let parts = [
        ("{sections}", key_table(&SECTIONS)),
        ("{component_keys}", key_table(&COMPONENT_KEYS)),
        ("{kinds}", kind_table()),
        ("{options}", option_table()),
        ("{option_entries}", option_entries.join("\n").trim_end().to_owned()),
        ("{policies}", policy_table()),
        ("{codecs}", codec_table()),
        ("{duration_units}", quoted_list(duration::UNITS.map(|(unit, _)| unit))),
        ("{size_units}", quoted_list(size::UNITS.map(|(unit, _)| unit))),
    ];
    parts.iter().fold(include_str!("page.md").to_owned(), |page, (mark, text)| page.replace(mark, text))
}

fn of_key(key: &'static Key, what: &'static str) -> Entry {
    let is_required = if key.is_required() { ", required" } else { "" };
    let default = if key.default.is_empty() { String::new() } else { format!(" Default: {}.", key.default) };
    let rest = if key.text.is_empty() { String::new() } else { format!("{}\n\n", key.text) };
    let facts = format!("Value: {}{is_required}.{default}", key.shape.values());
    let text = format!("{}\n\n{rest}{facts}\n\n```yaml\n{}```\n", key.summary, key.example);
    Entry { word: key.key, what, summary: key.summary, text }
}

fn of_kind(kind: GateKind) -> Entry {
    let row = KindRow::of(kind);
    let keys: Vec<&str> = OPTIONS.iter().filter(|option| option.fits(kind)).map(|option| option.key).collect();
    let other = kind.opposite().word();
    let text = format!(
        "{}\n\nIt connects to: {} Its options: {}. The other end is `{other}`.\n\n```yaml\n- example: {}\n- typed: {{{}: {}}}\n```\n",
        row.summary,
        row.peers,
        all_of(&keys),
        kind.word(),
        kind.word(),
        example_type(kind),
    );
    Entry { word: kind.word(), what: "kind of gate", summary: row.summary, text }
}

fn of_option(option: &'static GateOption) -> Entry {
    let kinds: Vec<&str> = option.kinds.iter().map(|kind| kind.word()).collect();
    let default = option.default().map_or(String::new(), |default| format!(" Default: `{default}`."));
    let examples: String = option.examples.iter().map(|example| format!("- {example}\n")).collect();
    let text = format!(
        "{}\n\n{}\n\nGates: {}. Value: {}.{default}\n\n```yaml\n{examples}```\n",
        option.summary,
        option.text,
        all_of(&kinds),
        option.shape.values(),
    );
    Entry { word: option.key, what: "option", summary: option.summary, text }
}

fn of_policy(policy: &'static Word) -> Entry {
    let text = format!(
        "A full queue {}.\n\n{}\n\n```yaml\n- samples: {{sub: Sample, when_full: {}}}\n```\n",
        policy.summary, policy.text, policy.word
    );
    Entry { word: policy.word, what: "value of `when_full`", summary: policy.summary, text }
}

fn of_codec(row: &'static CodecRow) -> Entry {
    let feature = if row.is_default_feature { ", on by default" } else { "" };
    let text = format!(
        "{}\n\nMessages: {} Cargo feature of the crate `scl`: `{}`{feature}.\n\n```yaml\n- attitude: {{pub: Attitude, codec: {}}}\n```\n",
        row.summary, row.messages, row.word, row.word
    );
    Entry { word: row.word, what: "codec", summary: row.summary, text }
}

fn key_table(keys: &[Key]) -> String {
    let rows = keys.iter().map(|key| {
        let default = if key.is_required() { "required" } else { key.default };
        let meaning = format!("{} {}", key.summary, key.text);
        row(&[&format!("`{}`", key.key), &key.shape.values(), default, meaning.trim_end()])
    });
    table(&["key", "value", "default", "meaning"], rows)
}

fn kind_table() -> String {
    let rows = GateKind::ALL.into_iter().map(|kind| {
        let facts = KindRow::of(kind);
        let [word, other] = [kind.word(), kind.opposite().word()].map(|word| format!("`{word}`"));
        row(&[&word, &other, facts.summary, facts.peers])
    });
    table(&["kind", "other end", "what it does", "connects to"], rows)
}

fn option_table() -> String {
    let rows = OPTIONS.iter().map(|option| {
        let key = option.key;
        let is_for_all = option.kinds.len() == GateKind::ALL.len();
        let words = option.kinds.iter().map(|kind| kind.word());
        let kinds = if is_for_all { "all".to_owned() } else { quoted_list(words) };
        let default = option.default().map_or(String::new(), |default| format!("`{default}`"));
        row(&[&format!("[`{key}`](#{key})"), &kinds, &option.shape.values(), &default, option.summary])
    });
    table(&["option", "gates", "value", "default", "meaning"], rows)
}

fn policy_table() -> String {
    let rows = POLICIES.iter().map(|policy| {
        let is_default = if policy.word == WhenFull::default().word() { " (default)" } else { "" };
        row(&[&format!("`{}`{is_default}", policy.word), policy.summary, policy.text])
    });
    table(&["`when_full`", "a full queue", "when to choose it"], rows)
}

fn codec_table() -> String {
    let rows = Codec::BUILT_IN.iter().map(|codec| {
        let mark = if codec.is_default_feature { " *" } else { "" };
        row(&[&format!("`{}`{mark}", codec.word), codec.messages, codec.summary])
    });
    table(&["codec and feature", "messages", "when to choose it"], rows)
}

fn table(head: &[&str], rows: impl Iterator<Item = String>) -> String {
    let rows: Vec<String> = rows.collect();
    format!("{}\n|{}\n{}", row(head), "---|".repeat(head.len()), rows.join("\n"))
}

fn row(cells: &[&str]) -> String {
    let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
    format!("| {} |", cells.join(" | ").replace("  ", " "))
}

fn example_type(kind: GateKind) -> &'static str {
    if kind.exchanges() { "Request -> Reply" } else { "Message" }
}

/// Markdown without the sentences that refer to other parts of the page, `See [codecs](#codecs).`
pub fn without_references(markdown: &str) -> String {
    let mut out = String::new();
    let mut rest = markdown;
    while let Some((before, reference)) = rest.split_once("See [") {
        out.push_str(before.trim_end_matches(' '));
        rest = reference.split_once(").").map_or("", |(_, after)| after);
    }
    out + rest
}

#[cfg(test)]
mod tests;
