//! Breakpoints. All executions of a line are recorded, so the stops at which a breakpoint holds are known as
//! soon as it is set.

use toyproof_diagnostic::plural;

use crate::protocol::reply;
use crate::protocol::request::{DataBreakpoint, FunctionBreakpoint, SourceBreakpoint};
use crate::recording::{Line, Point, StackFrame};
use crate::sources::Sources;
use crate::watch::{Budget, Context, Watch};

/// The largest number of times that a log point is shown in one continuation.
const MAX_LOGGED: usize = 1000;

/// What a client requested.
#[derive(Debug, Clone)]
pub(crate) enum Spec {
    Line(reply::Source, SourceBreakpoint),
    Function(FunctionBreakpoint),
    Data(DataBreakpoint),
}

/// A breakpoint.
#[derive(Debug)]
pub(crate) struct Breakpoint {
    pub(crate) id: i64,
    pub(crate) spec: Spec,
    /// The stops at which it holds, in order.
    pub(crate) stops: Vec<usize>,
    /// What is shown instead of stopping, if it is a log point.
    pub(crate) log: Option<LogMessage>,
}

/// Where a breakpoint is, or why it cannot be set.
pub(crate) struct Resolution {
    pub(crate) stops: Vec<usize>,
    pub(crate) log: Option<LogMessage>,
    pub(crate) line: Option<Line>,
    pub(crate) is_verified: bool,
    pub(crate) message: Option<String>,
}

impl Resolution {
    fn refused(message: impl Into<String>) -> Self {
        Self {
            stops: Vec::new(),
            log: None,
            line: None,
            is_verified: false,
            message: Some(message.into()),
        }
    }
}

impl Spec {
    fn condition(&self) -> Option<&str> {
        let condition = match self {
            Self::Line(_, of) => &of.condition,
            Self::Function(of) => &of.condition,
            Self::Data(of) => &of.condition,
        };
        condition.as_deref().filter(|text| !text.trim().is_empty())
    }

    fn hit_condition(&self) -> Option<&str> {
        let condition = match self {
            Self::Line(_, of) => &of.hit_condition,
            Self::Function(of) => &of.hit_condition,
            Self::Data(of) => &of.hit_condition,
        };
        condition.as_deref().filter(|text| !text.trim().is_empty())
    }

    /// Finds the stops at which it holds; its line counts from 1.
    pub(crate) fn resolve(&self, context: Context<'_>, sources: &Sources, budget: Budget<'_>) -> Resolution {
        let found = self.place(context, sources);
        let (stops, line) = match found {
            Ok(found) => found,
            Err(message) => return Resolution::refused(message),
        };
        let executed = stops.len();
        let log = match self {
            Self::Line(_, SourceBreakpoint { log_message, .. }) => log_message
                .as_deref()
                .filter(|text| !text.is_empty())
                .map(LogMessage::parse),
            _ => None,
        };
        let mut resolution = Resolution {
            stops,
            log,
            line,
            is_verified: true,
            message: None,
        };
        if executed == 0 {
            resolution.message = Some("this is not executed in the pixel".to_owned());
        }
        if let Some(condition) = self.condition() {
            match holds(context, condition, &resolution.stops, budget) {
                Ok((stops, tested)) => {
                    resolution.stops = stops;
                    if tested < executed {
                        resolution.message = Some(format!(
                            "within the time limit, the condition was evaluated at the first {tested} of {executed} \
                             times"
                        ));
                    }
                }
                Err(message) => return Resolution::refused(format!("the condition: {message}")),
            }
        }
        if let Some(condition) = self.hit_condition() {
            match HitCondition::parse(condition) {
                Ok(condition) => {
                    let numbered = (1..).zip(std::mem::take(&mut resolution.stops));
                    let held = numbered.filter(|&(number, _)| condition.holds(number));
                    resolution.stops = held.map(|(_, stop)| stop).collect();
                }
                Err(message) => return Resolution::refused(message),
            }
        }
        if resolution.stops.is_empty() && executed > 0 {
            let times = plural(executed as u64, "time", "times");
            resolution.message = Some(format!(
                "this is executed {executed} {times} in the pixel, but the condition never holds"
            ));
        }
        resolution
    }

    /// The stops at the requested place, and its line.
    fn place(&self, context: Context<'_>, sources: &Sources) -> Result<(Vec<usize>, Option<Line>), String> {
        let stops = context.recording.stops();
        match self {
            Self::Line(source, breakpoint) => {
                let file = sources
                    .find(source)
                    .ok_or("the shader that is debugged does not include this file")?;
                let line = usize::try_from(breakpoint.line).unwrap_or_default();
                let line = sources
                    .line_with_code(Line { file, line })
                    .ok_or("there is no code at or after this line")?;
                let indexed = stops.iter().enumerate();
                let found = indexed.filter(|(_, stop)| !stop.is_return && stop.line == line);
                Ok((found.map(|(at, _)| at).collect(), Some(line)))
            }
            Self::Function(breakpoint) => {
                let tree = &context.subject.checked.tree;
                let name = breakpoint.name.trim();
                let mut functions = tree.functions.iter();
                let Some((_, function)) = functions.find(|(_, function)| function.name == name) else {
                    return Err(format!("the shader has no function `{name}`"));
                };
                let line = Line::of(&context.subject.files, function.at);
                let mut last = None;
                let mut found = Vec::new();
                for (at, stop) in stops.iter().enumerate() {
                    // Invocations are numbered in the order in which they begin.
                    let is_first = last.is_none_or(|last| stop.invocation > last);
                    last = last.max(Some(stop.invocation));
                    let function = context.recording.invocation(stop.invocation).function;
                    if is_first && tree[function].name == name {
                        found.push(at);
                    }
                }
                Ok((found, Some(line)))
            }
            Self::Data(breakpoint) => {
                let cells = parse_data_id(&breakpoint.data_id).ok_or("the variable is not known")?;
                Ok((context.recording.writes(cells), None))
            }
        }
    }
}

/// The identification of cells in the protocol.
pub(crate) fn data_id(cells: &std::ops::Range<u32>) -> String {
    format!("cells {}-{}", cells.start, cells.end)
}

fn parse_data_id(text: &str) -> Option<std::ops::Range<u32>> {
    /// No variable has more components.
    const MAX_CELLS: u32 = 1 << 20;
    let (start, end) = text.strip_prefix("cells ")?.split_once('-')?;
    let (start, end) = (start.parse().ok()?, end.parse().ok()?);
    (start < end && end <= MAX_CELLS).then_some(start..end)
}

/// The stops at which a condition is true, and the number of stops at which it was evaluated.
fn holds(
    context: Context<'_>,
    condition: &str,
    stops: &[usize],
    budget: Budget<'_>,
) -> Result<(Vec<usize>, usize), String> {
    let mut held = Vec::new();
    let mut tested = 0;
    // A line may have statements of several functions; consecutive stops mostly have the same one.
    let place = |stop: &usize| context.recording.stops()[*stop].place;
    for group in stops.chunk_by(|a, b| place(a) == place(b)) {
        let points = frames(context, group);
        let Some((_, frame)) = points.first() else {
            continue;
        };
        let watch = Watch::new(context, frame.function, frame.step, condition)?;
        if !watch.is_condition() {
            return Err("it is not of type `bool`".to_owned());
        }
        let evaluated = watch.evaluate(&points, false, budget)?;
        let is_true = |value: &crate::value::Value| {
            let first = value.single.first();
            first.is_some_and(|value| !matches!(value, toyproof_eval::TraceValue::Word(0)))
        };
        let values = evaluated.values.iter().zip(group);
        held.extend(values.filter(|(value, _)| is_true(value)).map(|(_, stop)| *stop));
        tested += evaluated.values.len();
        if evaluated.values.len() < group.len() {
            break;
        }
    }
    Ok((held, tested))
}

/// The innermost function at each of some stops.
fn frames(context: Context<'_>, stops: &[usize]) -> Vec<(Point, StackFrame)> {
    let frame = |&stop: &usize| {
        (
            Point(stop),
            context.recording.frame(&context.recording.stops()[stop]),
        )
    };
    stops.iter().map(frame).collect()
}

/// The times at which a breakpoint holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum HitCondition {
    Equal(u64),
    AtLeast(u64),
    AtMost(u64),
    Multiple(u64),
}

impl HitCondition {
    fn parse(text: &str) -> Result<Self, String> {
        let expected = || {
            format!(
                "expected a number of times: `3`, `>= 3`, `> 3`, `<= 3`, `< 3`, or `% 3` for each third time; found `{}`",
                text.trim()
            )
        };
        let text = text.trim();
        let digits = text.trim_start_matches(['=', '>', '<', '%']);
        let number: u64 = digits.trim().parse().map_err(|_| expected())?;
        Ok(match &text[..text.len() - digits.len()] {
            "" | "=" | "==" => Self::Equal(number),
            ">=" => Self::AtLeast(number),
            ">" => Self::AtLeast(number.saturating_add(1)),
            "<=" => Self::AtMost(number),
            "<" => Self::AtMost(number.saturating_sub(1)),
            "%" if number > 0 => Self::Multiple(number),
            _ => return Err(expected()),
        })
    }

    fn holds(self, number: u64) -> bool {
        match self {
            Self::Equal(other) => number == other,
            Self::AtLeast(least) => number >= least,
            Self::AtMost(most) => number <= most,
            Self::Multiple(of) => number.is_multiple_of(of),
        }
    }
}

/// The message of a log point: text with expressions in braces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LogMessage {
    parts: Vec<LogPart>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum LogPart {
    Text(String),
    Expression(String),
}

impl LogMessage {
    fn parse(text: &str) -> Self {
        let mut parts = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('{') {
            let Some((expression, behind)) = after.split_once('}') else {
                break;
            };
            parts.push(LogPart::Text(before.to_owned()));
            parts.push(LogPart::Expression(expression.to_owned()));
            rest = behind;
        }
        parts.push(LogPart::Text(rest.to_owned()));
        Self { parts }
    }

    /// The messages at some stops, and whether there are more.
    pub(crate) fn texts(
        &self,
        context: Context<'_>,
        stops: &[usize],
        budget: Budget<'_>,
    ) -> (Vec<(usize, String)>, bool) {
        let shown = &stops[..stops.len().min(MAX_LOGGED)];
        let place = |stop: &usize| context.recording.stops()[*stop].place;
        let mut texts = Vec::new();
        for group in shown.chunk_by(|a, b| place(a) == place(b)) {
            let mut lines = vec![String::new(); group.len()];
            for part in &self.parts {
                match part {
                    LogPart::Text(text) => lines.iter_mut().for_each(|line| *line += text),
                    LogPart::Expression(expression) => {
                        let values = texts_of(context, expression, group, budget);
                        let values = values.unwrap_or_else(|error| vec![format!("<{error}>"); group.len()]);
                        for (line, value) in lines.iter_mut().zip(values) {
                            *line += &value;
                        }
                    }
                }
            }
            texts.extend(group.iter().copied().zip(lines));
        }
        (texts, stops.len() > shown.len())
    }
}

/// The values of an expression at stops of one place, as texts.
fn texts_of(
    context: Context<'_>,
    expression: &str,
    stops: &[usize],
    budget: Budget<'_>,
) -> Result<Vec<String>, String> {
    let points = frames(context, stops);
    let Some((_, frame)) = points.first() else {
        return Ok(Vec::new());
    };
    let watch = Watch::new(context, frame.function, frame.step, expression)?;
    let evaluated = watch.evaluate(&points, true, budget)?;
    let texts = evaluated.values.iter().map(|value| value.text(&evaluated.tree));
    let mut texts: Vec<_> = texts.collect();
    texts.resize(stops.len(), "<time limit exceeded>".to_owned());
    Ok(texts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hit_conditions_select_times() {
        let times = |text: &str| {
            let condition = HitCondition::parse(text).unwrap();
            (1..=6)
                .filter(|&number| condition.holds(number))
                .collect::<Vec<_>>()
        };
        assert_eq!(times("3"), [3]);
        assert_eq!(times(" >= 5"), [5, 6]);
        assert_eq!(times(">5"), [6]);
        assert_eq!(times("< 3"), [1, 2]);
        assert_eq!(times("<=1"), [1]);
        assert_eq!(times("% 2"), [2, 4, 6]);
        for wrong in ["x", "", "3 4", "% 0", "=> 3", "-1"] {
            let error = HitCondition::parse(wrong).unwrap_err();
            assert!(error.starts_with("expected a number of times"), "{error}");
        }
    }

    #[test]
    fn log_messages_have_expressions_in_braces() {
        let parts = |text: &str| LogMessage::parse(text).parts;
        let text = |text: &str| LogPart::Text(text.to_owned());
        let expression = |text: &str| LogPart::Expression(text.to_owned());
        assert_eq!(parts("a {b.x} c"), [text("a "), expression("b.x"), text(" c")]);
        assert_eq!(parts("open { end"), [text("open { end")]);
    }

    #[test]
    fn cells_are_identified_by_a_text() {
        assert_eq!(parse_data_id(&data_id(&(3..7))), Some(3..7));
        for wrong in ["cells 7-3", "cells 0-4294967295", "cells", "cells a-b", ""] {
            assert_eq!(parse_data_id(wrong), None, "{wrong}");
        }
    }
}
