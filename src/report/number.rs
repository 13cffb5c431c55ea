//! Numbers as a reader wants them.

/// The power of ten of a number written with so many decimals.
fn exponent(value: f64, decimals: usize) -> i32 {
    let text = format!("{value:.decimals$e}");
    text.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(0)
}

/// Three significant digits.
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let power = exponent(value, 2);
    if (-3..6).contains(&power) {
        let decimals = usize::try_from(2 - power).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        format!("{value:.2e}")
    }
}

/// Three significant digits and a sign.
pub fn signed(value: f64) -> String {
    let text = short(value);
    if value > 0.0 { format!("+{text}") } else { text }
}

/// "5.76 ± 0.05": to the error's first digit; three significant digits if there is no error.
pub fn with_error(value: f64, error: f64) -> String {
    if !(error > 0.0 && error.is_finite()) {
        return short(value);
    }
    let decimals = usize::try_from(-exponent(error, 0)).unwrap_or(0);
    format!("{value:.decimals$} ± {error:.decimals$}")
}

/// "20.1 to 34", or "100" where both are alike.
pub fn range(low: f64, high: f64) -> String {
    let one = |v: f64| {
        let text = format!("{v:.1}");
        text.strip_suffix(".0").unwrap_or(&text).to_owned()
    };
    if one(low) == one(high) { one(low) } else { format!("{} to {}", one(low), one(high)) }
}

/// "a, b and c".
pub fn list(words: &[String], last: &str) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., end] => format!("{} {last} {end}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [51.04, 0.0298, 3e-7, 123_456.0, 0.0].map(short),
            ["51.0", "0.0298", "3.00e-7", "123456", "0"]
        );
        assert_eq!(with_error(50.952, 0.664), "51.0 ± 0.7");
        assert_eq!(with_error(32716.3, 96.2), "32716 ± 96");
        assert_eq!(with_error(9.51, f64::NAN), "9.51");
        assert_eq!([range(99.99, 100.0), range(20.04, 34.16)], ["100", "20 to 34.2"]);
        assert_eq!(list(&["a", "b", "c"].map(str::to_owned), "and"), "a, b and c");
    }
}
