//! Values that are calculated: `1920*1080*3`, `64 << 20`, `2 * time.Second`.

/// The result of a product, a shift or a power of whole numbers, with the unit that one of its factors may have. `None`
/// for other texts.
pub(super) fn product(text: &str) -> Option<String> {
    let text = text.strip_prefix('(').and_then(|text| text.strip_suffix(')')).unwrap_or(text);
    let binary = |mark: &str| {
        let (one, two) = text.split_once(mark)?;
        Some((one.trim().parse::<u64>().ok()?, two.trim().parse::<u32>().ok()?))
    };
    if let Some((number, bits)) = binary("<<") {
        return 2_u64.checked_pow(bits)?.checked_mul(number).map(|number| number.to_string());
    }
    if let Some((base, power)) = binary("**") {
        return base.checked_pow(power).map(|number| number.to_string());
    }
    let is_grid = text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'x') && !text.starts_with("0x");
    let factors = || text.split(|mark: char| matches!(mark, '*' | '×') || is_grid && mark == 'x').map(str::trim);
    if factors().nth(1).is_none() || factors().any(str::is_empty) {
        return None;
    }
    let (mut number, mut unit) = (1_u64, "");
    for factor in factors() {
        let (digits, word) =
            factor.split_at(factor.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(factor.len()));
        number = number.checked_mul(if digits.is_empty() { 1 } else { digits.parse().ok()? })?;
        if !word.is_empty() {
            let word = word.trim_start().rsplit('.').next().filter(|word| word.chars().all(char::is_alphabetic))?;
            if !std::mem::replace(&mut unit, word).is_empty() {
                return None;
            }
        }
    }
    Some(format!("{number}{unit}"))
}

#[cfg(test)]
mod tests {
    use super::product;

    #[test]
    fn products_have_one_unit_at_most() {
        let texts = ["1920*1080*3", "640x480", "(2 * 8)", "64 << 20", "2**10", "5 * time.Second", "2*30s", "4 × 2"];
        let results = texts.map(|text| product(text).unwrap_or_default());
        assert_eq!(results, ["6220800", "307200", "16", "67108864", "1024", "5Second", "60s", "8"]);
        for text in
            ["16", "0x10", "2s*3s", "*latest", "2*", "8 MiB", "max", "4.5*2", "99999999999*99999999999", "1<<99"]
        {
            assert_eq!(product(text), None, "{text}");
        }
    }
}
