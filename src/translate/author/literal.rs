//! Numbers as their author wrote them, in the form that other languages than GLSL accept.

/// Whether the text of an integer is hexadecimal.
pub(crate) fn is_hexadecimal(text: &str) -> bool {
    text.starts_with("0x") || text.starts_with("0X")
}

/// A float as written, with digits on both sides of its point; or its value, where other languages than GLSL
/// would not accept the text.
pub(crate) fn float(text: &str, value: f64) -> String {
    let text = text.trim_end_matches(['f', 'F']);
    let is_plain = text
        .chars()
        .all(|c| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-'));
    if !is_plain {
        return format!("{:?}", value as f32);
    }
    let (mantissa, exponent) = text.find(['e', 'E']).map_or((text, ""), |at| text.split_at(at));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let whole = whole.trim_start_matches('0');
    let whole = if whole.is_empty() { "0" } else { whole };
    let fraction = if fraction.is_empty() { "0" } else { fraction };
    format!("{whole}.{fraction}{exponent}")
}

#[cfg(test)]
mod tests {
    use super::float;

    #[test]
    fn a_float_has_digits_on_both_sides() {
        for (glsl, wgsl) in [
            ("1.", "1.0"),
            (".5", "0.5"),
            ("1e3", "1.0e3"),
            ("1.5f", "1.5"),
            ("00.10", "0.10"),
            ("2.E-3", "2.0E-3"),
        ] {
            assert_eq!(float(glsl, 0.0), wgsl);
        }
    }
}
