//! The two types of a `req` or `rep` gate in the notation of other languages.

/// Words that stand before or between two types.
const WORDS: [&str; 11] =
    ["returns", "return", "to", "and", "stream", "repeated", "rpc", "yields", "gives", "then", "into"];

/// Two types with something else than `->` between them.
pub(super) struct Odd {
    /// What stands there.
    pub(super) mark: String,
    /// The types with `->` between them, in the most likely order first.
    pub(super) ways: Vec<String>,
    /// The reply is marked as a stream of replies.
    pub(super) is_stream: bool,
}

/// Something between two types that stands for `->`: `A => B`, `A -&gt; B`, `(A) returns (B)`, `A, B`. In `B f(A)` and
/// `B <- A` the reply comes first.
pub(super) fn odd_arrow(payload: &str) -> Option<Odd> {
    let text = payload.replace("&gt;", ">").replace("&lt;", "<");
    let is_right = text.split("->").count() == 2 && text.split("->").all(|part| is_type(part.trim()));
    let is_generic = text.contains('<') && text.ends_with('>') && !text.contains("->");
    if is_right && text == payload || is_generic {
        return None;
    }
    let words: Vec<&str> = words_of(&text).filter(|word| !WORDS.contains(word)).collect();
    let [request, reply] = match words.as_slice() {
        [request, reply] => [*request, *reply],
        [only] => glued(only)?,
        _ => return None,
    };
    if !is_type(request) || !is_type(reply) {
        return None;
    }
    let end = payload.find(request)? + request.len();
    let between = payload.get(end..payload.rfind(reply)?)?.trim_matches([' ', '(', ')', ',']);
    let mark = if between.is_empty() { payload.get(end..)?.trim().chars().next().map(String::from) } else { None };
    let mark = mark.filter(|mark| mark == ",").unwrap_or_else(|| between.to_owned());
    let is_call = !payload.starts_with('(') && mark.is_empty() && payload.ends_with(')');
    let mut ways = vec![format!("{request} -> {reply}")];
    if is_call || matches!(mark.as_str(), "<-" | "<=" | "<--" | "←" | "⇐") {
        ways.insert(0, format!("{reply} -> {request}"));
    }
    let is_stream = words_of(&text).any(|word| matches!(word, "stream" | "repeated"));
    Some(Odd { mark, ways, is_stream })
}

fn words_of(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|letter: char| !is_part(letter)).map(|word| word.trim_matches([':', '/']));
    words.filter(|word| !word.is_empty())
}

/// `rover.Command/rover.Status`: two names with a dot each.
fn glued(word: &str) -> Option<[&str; 2]> {
    let (request, reply) = word.split_once(['/', ':'])?;
    [request, reply].iter().all(|name| name.contains('.') && !name.contains(['/', ':'])).then_some([request, reply])
}

fn is_part(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || matches!(letter, '_' | '.' | ':' | '/')
}

fn is_type(word: &str) -> bool {
    word.starts_with(|letter: char| letter.is_ascii_alphabetic()) && word.chars().all(is_part)
}

#[cfg(test)]
mod tests {
    use super::odd_arrow;

    #[test]
    fn two_types_in_other_notations_are_an_exchange() {
        let texts = [
            "a.A => a.B",
            "a.A -&gt; a.B",
            "(a.A) returns (a.B)",
            "A, B",
            "A -< B",
            "A B",
            "A to B",
            "(A) -> (B)",
            "a.A/a.B",
            "a.A:a.B",
            "rpc (A) returns (stream B)",
            "A → B",
            "A | B",
        ];
        for text in texts {
            let meant = odd_arrow(text).map(|odd| odd.ways.join(", ").replace("a.", ""));
            assert_eq!(meant.as_deref(), Some("A -> B"), "{text}");
            assert_eq!(odd_arrow(text).map(|odd| odd.is_stream), Some(text.contains("stream")), "{text}");
        }
        for text in ["A -> B", "A", "a.A", "Map<K, V>", "a::A", "pkg/msg/A", "A -> B -> C", "A ->", ""] {
            assert!(odd_arrow(text).is_none(), "{text}");
        }
        for text in ["a.B (a.A)", "a.B(a.A)", "a.B <- a.A"] {
            let meant = odd_arrow(text).map(|odd| odd.ways.join(", ").replace("a.", ""));
            assert_eq!(meant.as_deref(), Some("A -> B, B -> A"), "{text}");
        }
    }
}
