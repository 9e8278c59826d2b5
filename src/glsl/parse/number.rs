//! Numbers as written (§4.1.3, §4.1.4).

use crate::codes::Code;
use crate::tree::{Literal, Value};

/// What a number stands for; or why it stands for nothing.
pub(super) fn literal(text: &str) -> Result<Literal, (Code, String)> {
    let value = if is_float(text) {
        float(text)
    } else {
        integer(text)
    };
    Ok(Literal {
        text: text.into(),
        value: value?,
    })
}

fn is_float(text: &str) -> bool {
    let hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    !hexadecimal && text.contains(['.', 'e', 'E'])
}

fn float(text: &str) -> Result<Value, (Code, String)> {
    let digits = text.strip_suffix(['f', 'F']).unwrap_or(text);
    // What Rust reads beyond GLSL's floats (`inf`, `1`) does not come here. Too large a number is infinity, as in WebGL.
    match digits.parse() {
        Ok(value) => Ok(Value::Float(value)),
        Err(_) => Err((Code::BadNumber, format!("`{text}` is no number"))),
    }
}

fn integer(text: &str) -> Result<Value, (Code, String)> {
    let (digits, unsigned) = match text.strip_suffix(['u', 'U']) {
        Some(digits) => (digits, true),
        None => (text, false),
    };
    let (digits, radix) = match digits.strip_prefix("0x").or(digits.strip_prefix("0X")) {
        Some(digits) => (digits, 16),
        None if digits.len() > 1 && digits.starts_with('0') => (&digits[1..], 8),
        None => (digits, 10),
    };
    if digits.is_empty() || !digits.chars().all(|c| c.is_digit(radix)) {
        let message = if digits
            .strip_suffix(['f', 'F'])
            .is_some_and(|rest| rest.parse::<u64>().is_ok())
        {
            let number = text.trim_end_matches(['f', 'F']);
            format!("`{text}` needs a point to be a `float`: write `{number}.0`")
        } else if radix == 8 && digits.chars().all(|c| c.is_ascii_digit()) {
            let number = text.trim_start_matches('0');
            format!("`{text}` begins with 0, which makes it octal: write `{number}`")
        } else {
            format!("`{text}` is no number")
        };
        return Err((Code::BadNumber, message));
    }
    match u32::from_str_radix(digits, radix) {
        // An `int` is its bits: 0xFFFFFFFF is −1 (§4.1.3).
        Ok(bits) if unsigned => Ok(Value::Uint(bits)),
        Ok(bits) => Ok(Value::Int(bits.cast_signed())),
        Err(_) => Err((Code::NumberRange, format!("`{text}` does not fit 32 bits"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers() {
        let cases = [
            ("0", Some(Value::Int(0))),
            ("010", Some(Value::Int(8))),
            ("0x1F", Some(Value::Int(31))),
            ("0XfU", Some(Value::Uint(15))),
            ("4294967295", Some(Value::Int(-1))),
            ("2147483648u", Some(Value::Uint(1 << 31))),
            (".5", Some(Value::Float(0.5))),
            ("1.", Some(Value::Float(1.0))),
            ("1e3", Some(Value::Float(1000.0))),
            ("1.5E-1f", Some(Value::Float(0.15))),
            ("1e999", Some(Value::Float(f64::INFINITY))),
            ("4294967296", None),
            ("08", None),
            ("0x", None),
            ("1f", None),
            ("1.xx", None),
            ("1..", None),
            ("1e", None),
            ("1.0u", None),
        ];
        for (text, value) in cases {
            assert_eq!(literal(text).ok().map(|literal| literal.value), value, "{text}");
        }
    }
}
