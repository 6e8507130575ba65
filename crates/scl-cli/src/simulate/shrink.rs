//! The smallest set of faults with which a simulation still fails.

/// Returns the numbers that are left when none can be left out any more. `still_fails` is asked with sorted numbers.
pub(super) fn smallest<E>(
    all: &[usize],
    mut still_fails: impl FnMut(&[usize]) -> Result<bool, E>,
) -> Result<Vec<usize>, E> {
    let mut left = all.to_vec();
    // Halves first, then quarters, and so on: most faults have nothing to do with it.
    let mut length = left.len();
    while length > 0 {
        let mut at = 0;
        while at < left.len() {
            let end = (at + length).min(left.len());
            let without: Vec<usize> = left[..at].iter().chain(&left[end..]).copied().collect();
            if still_fails(&without)? { left = without } else { at = end }
        }
        length /= 2;
    }
    Ok(left)
}

#[cfg(test)]
mod tests {
    use super::smallest;
    use std::convert::Infallible;

    fn fewest(count: usize, needed: &[usize]) -> (Vec<usize>, usize) {
        let all: Vec<usize> = (1..=count).collect();
        let mut asked = 0;
        let fails = |faults: &[usize]| -> Result<bool, Infallible> {
            asked += 1;
            assert!(faults.is_sorted());
            Ok(needed.iter().all(|number| faults.contains(number)))
        };
        (smallest(&all, fails).unwrap(), asked)
    }

    #[test]
    fn what_is_not_needed_is_left_out() {
        assert_eq!(fewest(8, &[3]).0, [3]);
        assert_eq!(fewest(9, &[1, 9]).0, [1, 9]);
        assert_eq!(fewest(5, &[]).0, [0_usize; 0]);
        assert_eq!(fewest(0, &[]).0, [0_usize; 0]);
        assert_eq!(fewest(3, &[1, 2, 3]).0, [1, 2, 3]);
        // One of a hundred is found in few steps.
        assert!(fewest(100, &[42]).1 < 20, "{}", fewest(100, &[42]).1);
    }
}
