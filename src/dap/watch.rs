//! Expressions: they are copied into a text after the shader, which sets the variables to the values that
//! they have at a point of the recording, and is checked and evaluated like any shader. So an expression may
//! be any that the shader could have there, with calls of its functions.

use std::collections::HashSet;
use std::fmt::Write;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use toyproof_diagnostic::{Deadline, Diagnostic, File, Files, Severity};
use toyproof_eval::{EventKind, ExecutionTrace, Failure, Number, Settings, TraceSchema, TraceValue};
use toyproof_eval_native::Program;
use toyproof_glsl::tree::{FunctionId, Place, Scalar, StatementKind, Tree, Type, VariableId, VariableKind};
use toyproof_glsl::{self as glsl, ADDED_MAIN, Checked};

use crate::code::visible;
use crate::recording::{Point, Recording, StackFrame};
use crate::subject::Subject;
use crate::value::{Precision, Value, component_count, of_type};

/// The function that evaluates the expression, its result, and the number of the point.
const WATCH: &str = "tpWatch";
const RESULT: &str = "tpResult";
const CASE: &str = "tpCase";

/// The largest number of components of variables that an expression names, over all points.
const MAX_COMPONENTS: usize = 20_000;

/// The number of points for which one text is compiled.
const BATCH: usize = 64;

/// The longest expression, in bytes.
const MAX_BYTES: usize = 10_000;

/// The limits of an evaluation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Budget<'a> {
    pub(crate) deadline: Instant,
    pub(crate) interrupt: &'a AtomicBool,
}

/// Where an expression is evaluated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Context<'a> {
    pub(crate) subject: &'a Subject,
    pub(crate) recording: &'a Recording,
}

/// An expression that is checked in the scope of a place.
pub(crate) struct Watch<'a> {
    context: Context<'a>,
    expression: &'a str,
    /// The local variables that it may name.
    locals: Vec<VariableId>,
    /// The variables at global scope that it may read: all, if it calls a function.
    globals: Vec<VariableId>,
    ty: Type,
    type_name: String,
}

/// The values of an expression, with the tree that their type belongs to.
pub(crate) struct Evaluated {
    pub(crate) tree: Tree,
    pub(crate) values: Vec<Value>,
}

impl<'a> Watch<'a> {
    /// Checks an expression in a function, in the scope of a statement or condition.
    ///
    /// # Errors
    /// Why the expression is invalid.
    pub(crate) fn new(
        context: Context<'a>,
        function: FunctionId,
        step: Option<Place>,
        expression: &'a str,
    ) -> Result<Self, String> {
        if expression.len() > MAX_BYTES {
            return Err("the expression is too long".to_owned());
        }
        if expression.trim().is_empty() {
            return Err("the expression is empty".to_owned());
        }
        let tree = &context.subject.checked.tree;
        let scope = visible(tree, function, step);
        let scope = scope.into_iter();
        let scope: Vec<_> = scope
            .filter(|variable| component_count(tree, tree[*variable].ty) > 0)
            .collect();
        let names = names(expression);
        let is_named = |variable: &VariableId| names.contains(&*tree[*variable].name);
        let named: Vec<_> = scope.iter().copied().filter(is_named).collect();
        let mut functions = tree.functions.iter();
        let calls = functions.any(|(_, function)| names.contains(&*function.name));
        let globals = tree.global_variables().filter(|variable| {
            let is_global = matches!(tree[*variable].kind, VariableKind::Global | VariableKind::Output);
            is_global && component_count(tree, tree[*variable].ty) > 0 && (calls || is_named(variable))
        });
        let mut watch = Self {
            context,
            expression: expression.trim(),
            locals: named,
            globals: globals.collect(),
            ty: Type::Void,
            type_name: String::new(),
        };
        if let Err(error) = watch.find_type() {
            // A macro may name other variables.
            watch.locals = scope;
            watch.find_type().map_err(|_| error)?;
        }
        Ok(watch)
    }

    fn find_type(&mut self) -> Result<(), String> {
        let checked = self.check(&self.text("", &[]))?;
        self.ty = result_type(&checked.tree).ok_or("the text is not an expression")?;
        if component_count(&checked.tree, self.ty) == 0 {
            return Err("the expression has no value".to_owned());
        }
        self.type_name = checked.tree.declaration(RESULT, self.ty) + " = ";
        Ok(())
    }

    /// Whether the value is a `bool`.
    pub(crate) fn is_condition(&self) -> bool {
        self.ty == Type::BOOL
    }

    /// The values in f32, and in f64 if `both`, with the variables of each frame at its point. Fewer than
    /// the points, if the budget is used up.
    ///
    /// # Errors
    /// Why the expression cannot be evaluated.
    pub(crate) fn evaluate(
        &self,
        points: &[(Point, StackFrame)],
        both: bool,
        budget: Budget<'_>,
    ) -> Result<Evaluated, String> {
        let tree = &self.context.subject.checked.tree;
        let variables = self.locals.iter().chain(&self.globals);
        let each: usize = variables.map(|&id| component_count(tree, tree[id].ty)).sum();
        if each > MAX_COMPONENTS {
            return Err("the variables of the expression are too large".to_owned());
        }
        let batch = (MAX_COMPONENTS / each.max(1)).clamp(1, BATCH);
        let mut evaluated = Evaluated {
            tree: Tree::default(),
            values: Vec::new(),
        };
        for points in points.chunks(batch) {
            let (singles, tree) = self.run(points, Precision::Single, budget)?;
            let doubles = if both {
                self.run(points, Precision::Double, budget)?.0
            } else {
                singles.clone()
            };
            let ty = result_type(&tree).unwrap_or(self.ty);
            let values = singles.into_iter().zip(doubles);
            let values = values.map(|(single, double)| Value { ty, single, double });
            evaluated.values.extend(values);
            evaluated.tree = tree;
            if Instant::now() >= budget.deadline {
                break;
            }
        }
        Ok(evaluated)
    }

    /// The components of the values in one number type.
    fn run(
        &self,
        points: &[(Point, StackFrame)],
        precision: Precision,
        budget: Budget<'_>,
    ) -> Result<(Vec<Vec<TraceValue>>, Tree), String> {
        let cases: Vec<String> = points
            .iter()
            .map(|(point, frame)| self.assignments(*point, frame, precision))
            .collect();
        let checked = self.check(&self.text(&self.type_name, &cases))?;
        let limit = budget.deadline.saturating_duration_since(Instant::now());
        let program = Program::within(&checked, limit).map_err(|refusal| refusal.to_string())?;
        let values = match precision {
            Precision::Single => self.trace::<f32>(&program, budget),
            Precision::Double => self.trace::<f64>(&program, budget),
        }?;
        if values.len() != points.len() {
            return Err("the expression has no value here".to_owned());
        }
        Ok((values, checked.tree))
    }

    /// The results of a program, one for each case.
    fn trace<N: Number>(
        &self,
        program: &Program,
        budget: Budget<'_>,
    ) -> Result<Vec<Vec<TraceValue>>, String> {
        let settings = Settings::<N> {
            deadline: Some(budget.deadline),
            interrupt: Some(budget.interrupt),
            ..Settings::default()
        };
        let subject = self.context.subject;
        let failed = |failure: Failure| failure.to_string();
        let debugger = program.step_debugger(&subject.frame, settings);
        let debugger = debugger.map_err(failed)?;
        let trace = debugger.trace(subject.pixel, None).map_err(failed)?;
        if trace.is_cut {
            return Err("the expression runs for too long".to_owned());
        }
        Ok(results(debugger.schema(), &program.checked().tree, &trace))
    }

    fn check(&self, text: &str) -> Result<Checked, String> {
        let subject = self.context.subject;
        let options = glsl::Options {
            calls_added_main: true,
            deadline: Deadline::after(subject.timeout),
            ..subject.checked.options()
        };
        let mut files = Files::default();
        let file = files.add(File::new("<expression>", text));
        glsl::check(&files, file, &options).map_err(|errors| {
            let errors: Vec<Diagnostic> = errors.into();
            let error = errors
                .iter()
                .find(|error| error.severity == Severity::Error)
                .or(errors.first());
            error.map_or_else(|| "invalid expression".to_owned(), |error| error.message.clone())
        })
    }

    /// The shader with the function that evaluates the expression after it, for each case with what sets
    /// the variables.
    fn text(&self, declaration: &str, cases: &[String]) -> String {
        let tree = &self.context.subject.checked.tree;
        let mut text = format!("{}\nvoid {WATCH}(", self.context.subject.text());
        for (at, &variable) in self.locals.iter().enumerate() {
            text += if at == 0 { "" } else { ", " };
            let variable = &tree[variable];
            let _ = write!(text, "const in {}", tree.declaration(&variable.name, variable.ty));
        }
        // The expression may end in a comment.
        let _ = write!(
            text,
            ") {{\n    {declaration}(\n{}\n);\n}}\nvoid {ADDED_MAIN}(out vec4 tpColor, in vec2 tpPlace) {{\n    \
             tpColor = vec4(0.0);\n    for (int {CASE} = 0; {CASE} < {}; {CASE}++) {{\n",
            self.expression,
            cases.len()
        );
        for (at, &variable) in self.locals.iter().enumerate() {
            let declaration = tree.declaration(&local(at), tree[variable].ty);
            let _ = writeln!(text, "        {declaration};");
        }
        for (at, case) in cases.iter().enumerate() {
            let _ = writeln!(text, "        if ({CASE} == {at}) {{\n{case}        }}");
        }
        let arguments = (0..self.locals.len()).map(local).collect::<Vec<_>>();
        let _ = writeln!(text, "        {WATCH}({});\n    }}\n}}", arguments.join(", "));
        text
    }

    /// The statements that set the variables to their values at a point.
    fn assignments(&self, point: Point, frame: &StackFrame, precision: Precision) -> String {
        let Context { subject, recording } = self.context;
        let tree = &subject.checked.tree;
        let locals = self.locals.iter().enumerate();
        let locals = locals.map(|(at, &variable)| (local(at), variable));
        let globals = self.globals.iter();
        let globals = globals.map(|&variable| (tree[variable].name.clone(), variable));
        let mut text = String::new();
        for (path, variable) in locals.chain(globals) {
            let Some(cells) = recording.cells(frame.call, variable) else {
                continue;
            };
            let [single, double] = recording.values(cells, point);
            let values = match precision {
                Precision::Single => single,
                Precision::Double => double,
            };
            assign(
                &mut text,
                tree,
                &path,
                tree[variable].ty,
                &mut values.iter().copied(),
                precision,
            );
        }
        text
    }
}

/// The variable that holds the value of a local variable.
fn local(at: usize) -> String {
    format!("tpLocal{at}")
}

/// Writes assignments of the scalars, vectors and matrices of a value.
fn assign(
    text: &mut String,
    tree: &Tree,
    path: &str,
    ty: Type,
    values: &mut dyn Iterator<Item = TraceValue>,
    precision: Precision,
) {
    match ty {
        Type::Struct(id) => {
            for member in &tree[id].members {
                assign(
                    text,
                    tree,
                    &format!("{path}.{}", member.name),
                    member.ty,
                    values,
                    precision,
                );
            }
        }
        Type::Array(id) => {
            let array = tree.array(id);
            for at in 0..array.size {
                assign(
                    text,
                    tree,
                    &format!("{path}[{at}]"),
                    array.element,
                    values,
                    precision,
                );
            }
        }
        _ => {
            let scalars = tree.scalars(ty).into_iter();
            let literals: Vec<_> = scalars
                .map(|scalar| literal(values.next().unwrap_or(TraceValue::Word(0)), scalar, precision))
                .collect();
            let name = tree.type_name(ty);
            let _ = writeln!(text, "            {path} = {name}({});", literals.join(", "));
        }
    }
}

/// A component as an expression.
fn literal(value: TraceValue, scalar: Scalar, precision: Precision) -> String {
    match (of_type(value, scalar), scalar) {
        (TraceValue::Float(value), _) if value.is_nan() => "(0.0 / 0.0)".to_owned(),
        (TraceValue::Float(value), _) if value.is_infinite() => {
            format!("({}1.0 / 0.0)", if value < 0.0 { "-" } else { "" })
        }
        (TraceValue::Float(value), _) => match precision {
            Precision::Single => format!("({:?})", value as f32),
            Precision::Double => format!("({value:?})"),
        },
        (TraceValue::Word(word), Scalar::Bool) => (word != 0).to_string(),
        (TraceValue::Word(word), Scalar::Uint) => format!("{word}u"),
        // The literal 2147483648 is too large.
        (TraceValue::Word(0x8000_0000), _) => "(-2147483647 - 1)".to_owned(),
        (TraceValue::Word(word), _) => format!("({})", word.cast_signed()),
    }
}

/// The identifiers of a text.
fn names(text: &str) -> HashSet<&str> {
    text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_')
        .filter(|name| !name.is_empty())
        .collect()
}

/// The type of the expression in the function that evaluates it.
fn result_type(tree: &Tree) -> Option<Type> {
    let (_, function) = tree
        .functions
        .iter()
        .find(|(_, function)| function.name == WATCH)?;
    match function.body.as_deref()?.last()?.kind {
        StatementKind::Expression(expr) => Some(tree[expr].ty),
        StatementKind::Declare(variable) => Some(tree[variable].ty),
        _ => None,
    }
}

/// The values that are written to the result.
fn results(schema: &TraceSchema, tree: &Tree, trace: &ExecutionTrace) -> Vec<Vec<TraceValue>> {
    let Some((result, _)) = tree
        .variables
        .iter()
        .find(|(_, variable)| variable.name == RESULT)
    else {
        return Vec::new();
    };
    let values = trace.events.iter().filter_map(|event| {
        let at = schema.event(event.event);
        let EventKind::Store(store) = at.kind else {
            return None;
        };
        let cells = schema.cells(at.call, result)?;
        let is_result = schema.store(store).cells.first() == Some(&cells.start);
        is_result.then(|| event.values.clone())
    });
    values.collect()
}
