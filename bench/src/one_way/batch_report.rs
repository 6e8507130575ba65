//! What a receiver reports about a batch.

/// The durations measured for a batch, in nanoseconds.
#[derive(Debug, PartialEq)]
pub(crate) struct BatchReport {
    /// From sending the first message to receiving the last one.
    pub(crate) span: u64,
    /// From sending to receiving, one per message if each message is timed.
    pub(crate) delays: Vec<u64>,
}

impl BatchReport {
    pub(crate) fn parse(line: &str) -> scl::Result<Self> {
        let mut numbers = line.split_ascii_whitespace().map(str::parse);
        let span = numbers.next().unwrap_or(Ok(0))?;
        Ok(Self { span, delays: numbers.collect::<Result<_, _>>()? })
    }

    pub(crate) fn to_line(&self) -> String {
        let delays = self.delays.iter().map(u64::to_string);
        std::iter::once(self.span.to_string()).chain(delays).collect::<Vec<_>>().join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_parsed_back() {
        for report in [BatchReport { span: 7, delays: vec![] }, BatchReport { span: 7, delays: vec![1, 2] }] {
            assert_eq!(BatchReport::parse(&report.to_line()).unwrap(), report);
        }
        assert!(BatchReport::parse("7 x").is_err());
    }
}
