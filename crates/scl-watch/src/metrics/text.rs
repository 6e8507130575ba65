//! The text format of Prometheus (<https://prometheus.io/docs/instrumenting/exposition_formats/>).

use std::borrow::Cow;
use std::fmt::Write as _;

/// Names and values of labels.
pub(super) type Labels<'t> = Vec<(&'static str, Cow<'t, str>)>;

/// What a figure is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// It only grows, until its component is restarted.
    Counter,
    /// It rises and falls.
    Gauge,
}

/// A text, as far as it is written.
#[derive(Default)]
pub(super) struct Text {
    text: String,
}

impl Text {
    /// Adds all samples of a figure; nothing if there are none.
    pub(super) fn family<'t>(
        &mut self,
        name: &str,
        kind: Kind,
        help: &str,
        samples: impl IntoIterator<Item = (Labels<'t>, f64)>,
    ) {
        let mut samples = samples.into_iter().peekable();
        if samples.peek().is_none() {
            return;
        }
        // Writing to a `String` cannot fail.
        _ = writeln!(self.text, "# HELP {name} {}\n# TYPE {name} {}", escape(help), kind.word());
        for (labels, value) in samples {
            let labels: Vec<String> =
                labels.iter().map(|(name, text)| format!("{name}=\"{}\"", escape(text))).collect();
            _ = writeln!(self.text, "{name}{{{}}} {value}", labels.join(","));
        }
    }

    pub(super) fn finish(self) -> String {
        self.text
    }
}

impl Kind {
    fn word(self) -> &'static str {
        match self {
            Self::Counter => "counter",
            Self::Gauge => "gauge",
        }
    }
}

fn escape(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n")
}

#[cfg(test)]
mod tests {
    use super::{Kind, Labels, Text};

    fn labels<const N: usize>(labels: [(&'static str, &'static str); N]) -> Labels<'static> {
        labels.map(|(name, text)| (name, text.into())).into()
    }

    #[test]
    fn a_family_is_its_help_its_type_and_its_samples() {
        let mut text = Text::default();
        text.family("x_total", Kind::Counter, "All \\ of it.", [(labels([("a", "1\"\n\\"), ("b", "")]), 1e15)]);
        text.family("nothing", Kind::Gauge, "Not there.", []);
        text.family("y", Kind::Gauge, "Some.", [(labels([("a", "ü")]), 0.25), (labels([("a", "v")]), 0.0)]);
        let expected = "\
# HELP x_total All \\\\ of it.
# TYPE x_total counter
x_total{a=\"1\\\"\\n\\\\\",b=\"\"} 1000000000000000
# HELP y Some.
# TYPE y gauge
y{a=\"ü\"} 0.25
y{a=\"v\"} 0
";
        assert_eq!(text.finish(), expected);
    }
}
