//! The seeds of the programs.

/// Returns the seed of a program's random numbers: another one for each component and each of its starts.
pub(crate) fn seed_of(simulation: u64, component: &str, start: u64) -> u64 {
    // FNV-1a, which will be the same in all releases.
    let bytes = simulation.to_le_bytes().into_iter().chain(start.to_le_bytes()).chain(component.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::seed_of;
    use std::collections::HashSet;

    #[test]
    fn seeds_differ_and_stay_the_same_in_all_releases() {
        let all = [seed_of(0, "a", 0), seed_of(1, "a", 0), seed_of(0, "b", 0), seed_of(0, "a", 1)];
        assert_eq!(all.into_iter().collect::<HashSet<_>>().len(), 4);
        assert_eq!(all[0], 0x4df9_ebff_d1f6_f2cc);
    }
}
