//! Numbers as people read them.

/// A number in as many digits as tell an f32 from its neighbours, if it is a `single`; else in ten.
#[must_use]
pub fn digits(value: f64, single: bool) -> String {
    match value {
        _ if value.is_nan() => "NaN".to_owned(),
        f64::INFINITY => "inf".to_owned(),
        f64::NEG_INFINITY => "-inf".to_owned(),
        _ if single => shortest(value as f32),
        _ => ten_digits(value),
    }
}

/// Beyond these powers of ten numbers are written with an exponent.
fn is_plain(value: f64) -> bool {
    value == 0.0 || (1e-5..1e9).contains(&value.abs())
}

fn shortest(value: f32) -> String {
    if is_plain(f64::from(value)) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

fn ten_digits(value: f64) -> String {
    let scientific = format!("{value:.9e}");
    let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    if is_plain(value) {
        // Rounded to ten digits first, so that the shortest form of what is left has no more.
        return format!("{}", scientific.parse::<f64>().unwrap_or(value));
    }
    format!(
        "{}e{exponent}",
        digits.trim_end_matches('0').trim_end_matches('.')
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_people_read_them() {
        let single = |value: f64| digits(value, true);
        let double = |value: f64| digits(value, false);
        assert_eq!(single(f64::from(0.1f32)), "0.1");
        assert_eq!(single(-36.0), "-36");
        assert_eq!(single(f64::from(1.5e-20f32)), "1.5e-20");
        assert_eq!(single(f64::NAN), "NaN");
        assert_eq!(double(1.0 / 3.0), "0.3333333333");
        assert_eq!(double(-2.0), "-2");
        assert_eq!(double(1e-7 / 3.0), "3.333333333e-8");
        assert_eq!(double(1e30), "1e30");
        assert_eq!(double(f64::NEG_INFINITY), "-inf");
    }
}
