//! The types of values.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeInteger, DeValue};

/// A value that does not have the expected type.
#[derive(Debug)]
pub struct Mismatch {
    /// The place.
    pub(super) bytes: Range<usize>,
    /// A description of the value that was found.
    pub(super) found: String,
    /// Whether it would be right without its quotes.
    pub(super) is_number_in_quotes: bool,
}

impl Mismatch {
    /// A value, and what it is instead.
    pub(super) fn new(value: &Spanned<DeValue>, found: String) -> Self {
        Self {
            found,
            ..Self::from_value(value)
        }
    }

    fn from_value(value: &Spanned<DeValue>) -> Self {
        Self {
            bytes: value.span(),
            found: describe(value.get_ref()),
            is_number_in_quotes: false,
        }
    }

    fn from_number(value: &Spanned<DeValue>) -> Self {
        let text = value.get_ref().as_str();
        Self {
            is_number_in_quotes: text.is_some_and(|text| text.parse::<f64>().is_ok()),
            ..Self::from_value(value)
        }
    }
}

/// Describes the type of a value: "a string".
pub(super) fn describe(value: &DeValue) -> String {
    match value {
        DeValue::String(_) => "a string".to_owned(),
        DeValue::Integer(integer) => integer.to_string(),
        DeValue::Float(float) => float.to_string(),
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(values) => match values.len() {
            0 => "an empty list".to_owned(),
            1 => "a list of 1 value".to_owned(),
            count => format!("a list of {count} values"),
        },
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// A type of values in a file.
pub trait Value: Sized {
    /// The name of the type in messages.
    const EXPECTED: &'static str;
    /// A value as it is written.
    const EXAMPLE: &'static str;

    /// Reads a value of this type.
    ///
    /// # Errors
    /// If it has another type.
    fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch>;
}

impl Value for f64 {
    const EXPECTED: &'static str = "a number";
    const EXAMPLE: &'static str = "1.0";

    fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
        let number = match value.get_ref() {
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
            DeValue::Integer(integer) => integer_value(integer).map(|number| number as f64),
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        };
        number.ok_or_else(|| Mismatch::from_number(value))
    }
}

impl Value for i64 {
    const EXPECTED: &'static str = "an integer";
    const EXAMPLE: &'static str = "1";

    fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
        let number = match value.get_ref() {
            DeValue::Integer(integer) => integer_value(integer),
            _ => None,
        };
        number.ok_or_else(|| Mismatch::from_number(value))
    }
}

/// Returns the value of an integer; the nearest one if it has more than 64 bits.
fn integer_value(integer: &DeInteger) -> Option<i64> {
    let digits = integer.as_str();
    match i64::from_str_radix(digits, integer.radix()) {
        Ok(value) => Some(value),
        Err(error) => match error.kind() {
            std::num::IntErrorKind::PosOverflow => Some(i64::MAX),
            std::num::IntErrorKind::NegOverflow => Some(i64::MIN),
            _ => None,
        },
    }
}

impl Value for bool {
    const EXPECTED: &'static str = "`true` or `false`";
    const EXAMPLE: &'static str = "true";

    fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
        value
            .get_ref()
            .as_bool()
            .ok_or_else(|| Mismatch::from_value(value))
    }
}

impl Value for String {
    const EXPECTED: &'static str = "a string";
    const EXAMPLE: &'static str = "\"name\"";

    fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
        let text = value.get_ref().as_str().map(str::to_owned);
        text.ok_or_else(|| Mismatch::from_value(value))
    }
}

/// A string and the bytes of its place.
impl Value for (String, Range<usize>) {
    const EXPECTED: &'static str = String::EXPECTED;
    const EXAMPLE: &'static str = String::EXAMPLE;

    fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
        Ok((String::read(value)?, value.span()))
    }
}

/// A number, a Boolean, or a list of these: a value whose type the file does not determine.
#[derive(Debug, Clone, PartialEq)]
pub enum Literal {
    /// A number.
    Number {
        /// The number.
        value: f64,
        /// Whether it is written as an integer.
        is_integer: bool,
    },
    /// `true` or `false`.
    Boolean(bool),
    /// A list.
    List(Vec<Literal>),
}

impl Literal {
    /// All numbers in it, in order; 1 and 0 for `true` and `false`.
    #[must_use]
    pub fn components(&self) -> Vec<f64> {
        match self {
            Self::Number { value, .. } => vec![*value],
            Self::Boolean(value) => vec![f64::from(*value)],
            Self::List(literals) => literals.iter().flat_map(Self::components).collect(),
        }
    }
}

impl Value for Literal {
    const EXPECTED: &'static str = "a number, `true`, `false` or a list of these";
    const EXAMPLE: &'static str = "1.0";

    fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
        match value.get_ref() {
            DeValue::Integer(_) | DeValue::Float(_) => Ok(Self::Number {
                value: f64::read(value)?,
                is_integer: matches!(value.get_ref(), DeValue::Integer(_)),
            }),
            DeValue::Boolean(value) => Ok(Self::Boolean(*value)),
            // The parser limits the nesting.
            DeValue::Array(values) => values
                .iter()
                .map(Self::read)
                .collect::<Result<_, _>>()
                .map(Self::List),
            _ => Err(Mismatch::from_number(value)),
        }
    }
}

macro_rules! lists_of_any_length {
    ($($element:ty: $expected:literal, $example:literal;)*) => {$(
        impl Value for Vec<$element> {
            const EXPECTED: &'static str = $expected;
            const EXAMPLE: &'static str = $example;

            fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
                match value.get_ref() {
                    DeValue::Array(values) => values.iter().map(<$element>::read).collect(),
                    _ => Err(Mismatch::from_value(value)),
                }
            }
        }
    )*};
}

lists_of_any_length! {
    f64: "a list of numbers", "[1.0, 2.0]";
    String: "a list of strings", "[\"name\"]";
    (String, Range<usize>): "a list of strings", "[\"name\"]";
    Literal: "a list of values", "[[0.0, 0.0, 4.0], 1.5]";
}

/// Reads a list of exactly `N` values.
fn list<T: Value + Copy, const N: usize>(value: &Spanned<DeValue>, unit: T) -> Result<[T; N], Mismatch> {
    let DeValue::Array(values) = value.get_ref() else {
        return Err(Mismatch::from_value(value));
    };
    if values.len() != N {
        return Err(Mismatch::new(value, values.len().to_string()));
    }
    let mut all = [unit; N];
    for (into, value) in all.iter_mut().zip(values.iter()) {
        *into = T::read(value)?;
    }
    Ok(all)
}

macro_rules! lists {
    ($($element:ty, $count:literal: $expected:literal, $example:literal;)*) => {$(
        impl Value for [$element; $count] {
            const EXPECTED: &'static str = $expected;
            const EXAMPLE: &'static str = $example;

            fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
                list(value, Default::default())
            }
        }
    )*};
}

lists! {
    f64, 2: "two numbers", "[0.0, 1.0]";
    f64, 3: "three numbers", "[1.0, 1.0, 1.0]";
    i64, 2: "two integers", "[640, 360]";
    i64, 3: "three integers", "[8, 8, 8]";
}
