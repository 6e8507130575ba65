//! The ratio of a value to the baseline's.

/// A ratio, and how much it varies between the rounds of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ratio {
    pub(super) value: f64,
    /// The first and third quartile of the ratios of all rounds.
    pub(super) quartiles: Option<[f64; 2]>,
}

/// The ratio of `value` to `base`, or the median of the ratios of each round if both were measured in the same rounds.
///
/// Comparing within a round cancels what affects a whole round, such as a change of the clock rate.
pub(super) fn ratio(value: f64, base: f64, [rounds, base_rounds]: [&[f64]; 2]) -> Option<Ratio> {
    if rounds.is_empty() || rounds.len() != base_rounds.len() {
        let value = value / base;
        return value.is_finite().then_some(Ratio { value, quartiles: None });
    }
    let mut ratios: Vec<f64> = rounds.iter().zip(base_rounds).map(|(value, base)| value / base).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let quantile = |fraction: f64| ratios[(fraction * (ratios.len() - 1) as f64).round() as usize];
    let [first, value, third] = [0.25, 0.5, 0.75].map(quantile);
    value.is_finite().then_some(Ratio { value, quartiles: Some([first, third]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_are_compared_one_by_one() {
        let ratio_of = |rounds: &[f64], base: &[f64]| ratio(6.0, 4.0, [rounds, base]).unwrap();
        // The machine is twice as slow in the third round, and another process disturbs the last one.
        let paired = ratio_of(&[2.0, 3.0, 4.0, 2.0, 90.0], &[2.0, 2.0, 4.0, 2.0, 2.0]);
        assert_eq!(paired, Ratio { value: 1.0, quartiles: Some([1.0, 1.5]) });
        for rounds in [&[][..], &[1.0]] {
            assert_eq!(ratio_of(rounds, &[]), Ratio { value: 1.5, quartiles: None });
        }
        assert_eq!(ratio(1.0, 0.0, [&[], &[]]), None);
    }
}
