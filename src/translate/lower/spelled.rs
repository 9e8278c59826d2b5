//! Programs of the elementary functions as the text of GLSL functions.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use toyproof_math::{Binary, Kind, Program, Step, StepId, Unary};

/// The body of a function that returns `results`, made into a value of the type `ty` if there are several.
pub(super) fn body(program: &Program, results: &[StepId], arguments: &[String], ty: &str) -> String {
    let mut writer = Writer {
        program,
        arguments,
        uses: uses(program, results),
        lines: String::new(),
    };
    let shared: Vec<StepId> = writer
        .uses
        .iter()
        .filter(|&(_, &uses)| uses > 1)
        .map(|(&id, _)| id)
        .collect();
    for id in shared {
        writer.declare(id);
    }
    let results: Vec<String> = results.iter().map(|&id| writer.operand(id)).collect();
    match &results[..] {
        [only] => format!("{}return {only};", writer.lines),
        several => format!("{}return {ty}({});", writer.lines, several.join(", ")),
    }
}

/// How often each step is built on.
fn uses(program: &Program, results: &[StepId]) -> BTreeMap<StepId, usize> {
    let mut uses = BTreeMap::new();
    let mut pending = results.to_vec();
    while let Some(id) = pending.pop() {
        let count = uses.entry(id).or_insert(0);
        *count += 1;
        if *count == 1 {
            pending.extend(program.step(id).0.operands());
        }
    }
    uses
}

struct Writer<'a> {
    program: &'a Program,
    arguments: &'a [String],
    uses: BTreeMap<StepId, usize>,
    lines: String,
}

impl Writer<'_> {
    /// Gives a name to a step that several build on.
    fn declare(&mut self, id: StepId) {
        let (step, kind) = self.program.step(id);
        if is_leaf(step) {
            return;
        }
        let ty = match kind {
            Kind::Float => "float",
            Kind::Bits => "uint",
            Kind::Truth => "bool",
        };
        let value = self.expression(step);
        let _ = write!(self.lines, "{ty} {} = {value};\n    ", name(id));
    }

    /// A step where another builds on it.
    fn operand(&self, id: StepId) -> String {
        let (step, _) = self.program.step(id);
        if self.uses[&id] > 1 && !is_leaf(step) {
            name(id)
        } else {
            self.expression(step)
        }
    }

    fn expression(&self, step: Step) -> String {
        match step {
            Step::Argument(index) => self.arguments[index].clone(),
            Step::Float(bits) => literal(f32::from_bits(bits)),
            Step::Bits(bits) => format!("{bits}u"),
            Step::Unary(operation, a) => {
                let a = self.operand(a);
                match operation {
                    Unary::Negate => format!("(-{a})"),
                    Unary::Sqrt => format!("sqrt({a})"),
                    Unary::Abs => format!("abs({a})"),
                    Unary::Floor => format!("floor({a})"),
                    Unary::ToBits => format!("floatBitsToUint({a})"),
                    Unary::FromBits => format!("uintBitsToFloat({a})"),
                    Unary::FromSigned => format!("float(int({a}))"),
                    Unary::Not => format!("(!{a})"),
                }
            }
            Step::Binary(operation, a, b) => {
                let is_truth = self.program.step(a).1 == Kind::Truth;
                let symbol = match operation {
                    Binary::Add => "+",
                    Binary::Subtract => "-",
                    Binary::Multiply => "*",
                    Binary::Divide => "/",
                    Binary::Less => "<",
                    Binary::And if is_truth => "&&",
                    Binary::And => "&",
                    Binary::Or if is_truth => "||",
                    Binary::Or => "|",
                    Binary::Left => "<<",
                    Binary::Right => ">>",
                };
                format!("({} {symbol} {})", self.operand(a), self.operand(b))
            }
            // `?:` would become branches.
            Step::Select(truth, yes, no) => {
                let [truth, yes, no] = [truth, yes, no].map(|id| self.operand(id));
                format!("mix({no}, {yes}, {truth})")
            }
        }
    }
}

fn is_leaf(step: Step) -> bool {
    matches!(step, Step::Argument(_) | Step::Float(_) | Step::Bits(_))
}

fn name(id: StepId) -> String {
    format!("toyproof_{id}")
}

/// A number that naga reads as that float.
fn literal(value: f32) -> String {
    if !value.is_finite() || value.abs() == f32::MAX {
        return format!("uintBitsToFloat({}u)", value.to_bits());
    }
    let text = format!("{value:?}");
    if value.is_sign_negative() {
        format!("({text})")
    } else {
        text
    }
}
