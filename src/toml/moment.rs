//! Dates with a time and an offset from UTC.

use toml::Spanned;
use toml::de::DeValue;
use toml::value::{Datetime, Offset};
use toyproof_diagnostic::Date;

use crate::value::{Mismatch, Value, describe};

/// A moment, as a file states it: `2026-03-01T23:59:00+01:00`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Moment {
    /// The seconds since 1970-01-01 00:00 UTC.
    pub seconds: i64,
    /// How far the clock of its place is ahead of UTC, in seconds.
    pub offset: i64,
}

impl Moment {
    /// None without a date, a time or an offset.
    fn from_datetime(value: &Datetime) -> Option<Self> {
        let (date, time) = (value.date?, value.time?);
        let offset = match value.offset? {
            Offset::Z => 0,
            Offset::Custom { minutes } => 60 * i64::from(minutes),
        };
        let date = Date {
            year: date.year.into(),
            month: date.month.into(),
            day: date.day.into(),
        };
        let [hour, minute, second] = [time.hour, time.minute, time.second.unwrap_or_default()].map(i64::from);
        Some(Self {
            seconds: 86_400 * date.days_since_1970() + 3600 * hour + 60 * minute + second - offset,
            offset,
        })
    }
}

impl Value for Moment {
    const EXPECTED: &'static str = "a date and a time with the offset from UTC";
    const EXAMPLE: &'static str = "2026-03-01T23:59:00+01:00";

    fn read(value: &Spanned<DeValue>) -> Result<Self, Mismatch> {
        let found = match value.get_ref() {
            DeValue::Datetime(datetime) => match Self::from_datetime(datetime) {
                Some(moment) => return Ok(moment),
                None if datetime.time.is_none() => "a date without a time".to_owned(),
                None if datetime.date.is_none() => "a time without a date".to_owned(),
                None => "a date and a time without an offset".to_owned(),
            },
            other => describe(other),
        };
        Err(Mismatch::new(value, found))
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{Code, File, Files};

    use super::*;
    use crate::{Format, read};

    static FORMAT: Format = Format {
        form_code: Code::SceneSyntax,
        value_code: Code::SceneValue,
        aliases: &[],
    };

    fn moment(text: &str) -> Result<Moment, String> {
        let mut files = Files::default();
        let file = files.add(File::new("a.toml", format!("at = {text}")));
        let read = read(&FORMAT, &files, file, |table| table.required::<Moment>("at"));
        read.map(|moment| moment.unwrap().value)
            .map_err(|errors| errors.to_string())
    }

    #[test]
    fn moments_are_counted_from_1970() {
        for (text, seconds) in [
            ("1970-01-01T00:00:00Z", 0),
            ("1969-12-31T23:59:59Z", -1),
            ("2000-02-29T12:34:00Z", 951_827_640),
            ("2026-03-01T23:59:00+01:00", 1_772_405_940),
            ("2026-03-01T22:59:00Z", 1_772_405_940),
            ("2026-03-01T12:29:00-10:30", 1_772_405_940),
        ] {
            assert_eq!(moment(text).unwrap().seconds, seconds, "{text}");
        }
        assert_eq!(moment("2026-03-01T23:59:00+01:00").unwrap().offset, 3600);
    }

    #[test]
    fn a_moment_needs_an_offset() {
        for (text, found) in [
            ("2026-03-01T23:59:00", "a date and a time without an offset"),
            ("2026-03-01", "a date without a time"),
            ("23:59:00", "a time without a date"),
            ("\"2026-03-01T23:59:00Z\"", "a string"),
        ] {
            let error = moment(text).unwrap_err();
            let expected = format!(
                "a.toml:1:6: error[E0501]: `at` must be a date and a time with the offset from UTC, found {found}"
            );
            assert!(error.starts_with(&expected), "{error}");
        }
    }
}
