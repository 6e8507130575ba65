//! A light scan of the raw text for quotes, comments and brackets, which continues where the parser stops.

use std::ops::Range;

/// Where the quotes, comments and brackets of a text are, as far as can be said without its structure.
#[derive(Debug, Default)]
pub(in crate::parse) struct Scan {
    /// Each comment from its `#` to the end of the line, in order.
    pub(in crate::parse) comments: Vec<Range<usize>>,
    /// Each quoted text with its quotes, in order; the last one may lack its end.
    pub(in crate::parse) quoted: Vec<Range<usize>>,
    /// The opening quote that nothing closes.
    pub(in crate::parse) open_quote: Option<usize>,
    /// The brackets that nothing closes, the outermost first.
    pub(in crate::parse) open_brackets: Vec<usize>,
}

impl Scan {
    /// Whether a byte lies in a comment or in quotes.
    pub(in crate::parse) fn is_free_text(&self, at: usize) -> bool {
        contains(&self.comments, at) || contains(&self.quoted, at)
    }

    /// Whether a byte lies in quotes.
    pub(in crate::parse) fn is_quoted(&self, at: usize) -> bool {
        contains(&self.quoted, at)
    }
}

/// Puts spaces in the place of whole characters.
pub(in crate::parse) fn blank(text: &mut String, ranges: impl IntoIterator<Item = Range<usize>>) {
    let mut bytes = std::mem::take(text).into_bytes();
    ranges.into_iter().for_each(|range| bytes[range].fill(b' '));
    // Only whole characters became spaces, so the text is still valid UTF-8.
    *text = String::from_utf8_lossy(&bytes).into_owned();
}

fn contains(ranges: &[Range<usize>], at: usize) -> bool {
    let next = ranges.partition_point(|range| range.start <= at);
    next > 0 && ranges[next - 1].contains(&at)
}

/// Reads a whole text once.
pub(in crate::parse) fn scan(text: &str) -> Scan {
    let bytes = text.as_bytes();
    let mut scan = Scan::default();
    let mut at = 0;
    // Whether a value can start here. Inside a plain word, a quote is an ordinary character.
    let mut fresh = true;
    while let Some(&byte) = bytes.get(at) {
        let end = match byte {
            b'#' if is_after_space(bytes, at) => {
                let end = line_end(bytes, at);
                scan.comments.push(at..end);
                end
            }
            b'"' | b'\'' if fresh => read_quoted(bytes, at, &mut scan),
            _ => at + 1,
        };
        let in_flow = !scan.open_brackets.is_empty();
        match byte {
            b'[' | b'{' if fresh || in_flow => scan.open_brackets.push(at),
            b']' | b'}' if in_flow => drop(scan.open_brackets.pop()),
            _ => {}
        }
        fresh = match byte {
            b' ' | b'\t' => fresh || at > 0 && matches!(bytes[at - 1], b':' | b'-' | b',' | b'?'),
            b'\n' | b'\r' => true,
            b'[' | b'{' | b',' => fresh || in_flow,
            // After a quoted key in brackets, the value may follow the colon without a space.
            b':' => in_flow && at > 0 && matches!(bytes[at - 1], b'"' | b'\''),
            _ => false,
        };
        at = end;
    }
    scan
}

fn read_quoted(bytes: &[u8], start: usize, scan: &mut Scan) -> usize {
    let quote = bytes[start];
    let mut at = start + 1;
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'\\' if quote == b'"' => at += 1,
            b'\'' if quote == b'\'' && bytes.get(at + 1) == Some(&b'\'') => at += 1,
            _ if byte == quote => {
                scan.quoted.push(start..at + 1);
                return at + 1;
            }
            _ => {}
        }
        at += 1;
    }
    scan.quoted.push(start..bytes.len());
    scan.open_quote = Some(start);
    bytes.len()
}

fn is_after_space(bytes: &[u8], at: usize) -> bool {
    at == 0 || matches!(bytes[at - 1], b' ' | b'\t' | b'\n' | b'\r')
}

fn line_end(bytes: &[u8], at: usize) -> usize {
    bytes[at..].iter().position(|byte| matches!(byte, b'\n' | b'\r')).map_or(bytes.len(), |found| at + found)
}

#[cfg(test)]
mod tests {
    use super::scan;

    #[test]
    fn quotes_comments_and_brackets() {
        let text = "a: 'it''s' # c \"\nb: [\"x\\\"]\", {y: don't}]\n# [\nc: e#f [\nd: [";
        let found = scan(text);
        let slices = |ranges: &[std::ops::Range<usize>]| -> Vec<String> {
            ranges.iter().map(|range| text[range.clone()].to_owned()).collect()
        };
        assert_eq!(slices(&found.comments), ["# c \"", "# ["]);
        assert_eq!(slices(&found.quoted), ["'it''s'", "\"x\\\"]\""]);
        assert_eq!(found.open_brackets, [text.len() - 1]);
        assert_eq!(found.open_quote, None);
    }

    #[test]
    fn an_open_quote_runs_to_the_end() {
        let found = scan("a: \"b\nc: d\n");
        assert_eq!(found.open_quote, Some(3));
    }
}
