//! Qualifiers (§4.3–§4.7).

use super::{Parsed, Parser};
use crate::check::{Qualifiers, Storage};
use crate::codes::Code;
use crate::token::{Punctuator, TokenKind};
use crate::words::Keyword;

impl Parser<'_> {
    /// What stands before a type, in the order of §4.7: `invariant`, interpolation, layout, storage, precision.
    pub(super) fn qualifiers(&mut self) -> Parsed<Qualifiers> {
        let mut qualifiers = Qualifiers::default();
        let mut last = 0;
        loop {
            let at = self.token().at;
            let Some(keyword) = self.keyword() else {
                return Ok(qualifiers);
            };
            let rank = match keyword {
                Keyword::Invariant => 1,
                Keyword::Flat | Keyword::Smooth => 2,
                Keyword::Layout => 3,
                Keyword::Const | Keyword::Centroid => 4,
                Keyword::In | Keyword::Out | Keyword::InOut | Keyword::Uniform => 5,
                Keyword::Highp | Keyword::Mediump | Keyword::Lowp => 6,
                _ => return Ok(qualifiers),
            };
            self.next();
            if rank <= last {
                let message = format!("`{}` cannot stand after what is before it", keyword.text());
                self.check.report(Code::BadQualifier.at(at, message));
            }
            last = rank;
            match keyword {
                Keyword::Const => qualifiers.is_const = Some(at),
                Keyword::Uniform => qualifiers.storage = Some((Storage::Uniform, at)),
                Keyword::In => qualifiers.storage = Some((Storage::In, at)),
                Keyword::Out => qualifiers.storage = Some((Storage::Out, at)),
                Keyword::InOut => qualifiers.storage = Some((Storage::InOut, at)),
                Keyword::Highp | Keyword::Mediump | Keyword::Lowp => qualifiers.precision = Some(at),
                _ => qualifiers.interface.push((keyword, at)),
            }
            if keyword == Keyword::Layout {
                self.layout()?;
            }
        }
    }

    /// `(location = 0, …)`: read and not kept; nobody asks for it.
    fn layout(&mut self) -> Parsed<()> {
        self.expect(Punctuator::LeftParen)?;
        loop {
            let (name, at) = self.name()?;
            self.check.layout(name, at);
            if self.eat(Punctuator::Assign) && !matches!(self.next().kind, TokenKind::Number(_)) {
                self.at -= 1;
                return self.unexpected("an integer");
            }
            if !self.eat(Punctuator::Comma) {
                self.expect(Punctuator::RightParen)?;
                return Ok(());
            }
        }
    }
}
