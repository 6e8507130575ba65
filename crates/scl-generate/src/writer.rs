//! Text with indentation.

/// Collects the lines of a file.
#[derive(Default)]
pub(crate) struct Writer {
    text: String,
    depth: usize,
}

impl Writer {
    /// Adds a line, or each line of a text that has several.
    pub(crate) fn line(&mut self, text: impl AsRef<str>) {
        for line in text.as_ref().split('\n') {
            if !line.is_empty() {
                (0..self.depth).for_each(|_| self.text.push_str("    "));
                self.text.push_str(line);
            }
            self.text.push('\n');
        }
    }

    /// Adds an empty line.
    pub(crate) fn blank(&mut self) {
        self.text.push('\n');
    }

    /// Adds what `body` writes, one level deeper.
    pub(crate) fn indented(&mut self, body: impl FnOnce(&mut Self)) {
        self.depth += 1;
        body(self);
        self.depth -= 1;
    }

    /// Adds a line, an indented body, and a line.
    pub(crate) fn block(&mut self, open: impl AsRef<str>, close: &str, body: impl FnOnce(&mut Self)) {
        self.line(open);
        self.indented(body);
        self.line(close);
    }

    /// The text.
    pub(crate) fn finish(self) -> String {
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::Writer;

    #[test]
    fn blocks_are_indented_and_empty_lines_are_empty() {
        let mut out = Writer::default();
        out.block("{", "}", |out| {
            out.line("a\n\nb");
            out.blank();
            out.block("[", "]", |out| out.line("c"));
        });
        assert_eq!(out.finish(), "{\n    a\n\n    b\n\n    [\n        c\n    ]\n}\n");
    }
}
