//! Requests about the point at which the execution has stopped.

use std::io::Write;
use std::ops::Range;
use std::rc::Rc;

use serde_json::{Value as Json, json};
use toyproof_eval::TraceValue;
use toyproof_glsl::tree::{Input, Tree, Type, VariableId, VariableKind};

use super::{Answer, Loaded, Session, budget, to_value};
use crate::breakpoints::data_id;
use crate::code::visible;
use crate::protocol::reply::{Evaluated, Parts, Scope, StackFrame, Variable};
use crate::protocol::request::{
    DataBreakpointInfo, Evaluate, OfFrame, SourceArguments, StackTrace, Variables,
};
use crate::recording;
use crate::sources::Extent;
use crate::value::{self, Precision, Value};
use crate::watch::Watch;

/// The largest number of values whose parts a client can request at one stop.
const MAX_HANDLES: usize = 100_000;

/// The largest number of variables in one response.
const MAX_VARIABLES: usize = 10_000;

/// What the numbers of `variablesReference` mean at a stop.
#[derive(Default)]
pub(super) struct Handles {
    handles: Vec<Handle>,
}

impl Handles {
    pub(super) fn clear(&mut self) {
        self.handles.clear();
    }

    /// The number of a handle; 0 if there are too many.
    fn add(&mut self, handle: Handle) -> i64 {
        if self.handles.len() >= MAX_HANDLES {
            return 0;
        }
        self.handles.push(handle);
        self.handles.len() as i64
    }

    fn get(&self, number: i64) -> Result<Handle, String> {
        let index = usize::try_from(number)
            .ok()
            .and_then(|number| number.checked_sub(1));
        let handle = index.and_then(|index| self.handles.get(index));
        handle
            .cloned()
            .ok_or_else(|| "the variable belongs to an earlier stop".to_owned())
    }
}

#[derive(Clone)]
enum Handle {
    Scope(ScopeKind, recording::StackFrame),
    /// A value with parts.
    Value(Rc<Named>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ScopeKind {
    Locals,
    Globals,
    Inputs,
    Outputs,
}

/// A value with what it belongs to.
struct Named {
    name: String,
    /// The expression of the value; `None` if there is none.
    path: Option<String>,
    value: Value,
    /// The first cell, if it is a variable or a part of one.
    first_cell: Option<u32>,
    /// The tree of the type, if it is not the shader's.
    tree: Option<Rc<Tree>>,
}

impl Named {
    fn cells(&self, tree: &Tree) -> Option<Range<u32>> {
        let count = value::component_count(tree, self.value.ty) as u32;
        self.first_cell.map(|first| first..first + count)
    }
}

impl<W: Write> Session<'_, W> {
    /// The functions that are being executed, innermost first.
    fn stack(&self) -> Result<Vec<recording::StackFrame>, String> {
        let loaded = self.loaded()?;
        let checked = &loaded.subject.checked;
        Ok(loaded
            .recording
            .stack(&checked.tree, checked.main_image, loaded.at))
    }

    /// The function with a number, or the innermost one.
    pub(super) fn frame(&self, id: Option<i64>) -> Result<recording::StackFrame, String> {
        let stack = self.stack()?;
        let index = id.map_or(Some(0), |id| {
            usize::try_from(id).ok().and_then(|id| id.checked_sub(1))
        });
        let frame = index.and_then(|index| stack.get(index));
        frame
            .copied()
            .ok_or_else(|| "the function is not being executed".to_owned())
    }

    pub(super) fn stack_trace(&self, arguments: &StackTrace) -> Answer {
        let loaded = self.loaded()?;
        let stack = self.stack()?;
        let (files, tree) = (&loaded.subject.files, &loaded.subject.checked.tree);
        let first = usize::try_from(arguments.start_frame).unwrap_or(0);
        let count = match usize::try_from(arguments.levels) {
            Ok(0) | Err(_) => usize::MAX,
            Ok(count) => count,
        };
        let frames = stack.iter().enumerate().skip(first).take(count);
        let frames = frames.map(|(index, frame)| {
            let at = Extent::of(files, frame.at.span);
            StackFrame {
                id: index as i64 + 1,
                name: tree[frame.function].name.clone(),
                source: loaded.sources.source(files.origin(frame.at.span).file),
                line: self.client.line(at.line),
                column: self.client.column(at.column),
                end_line: self.client.line(at.end_line),
                end_column: self.client.column(at.end_column),
                can_restart: true,
            }
        });
        let frames: Vec<_> = frames.collect();
        Ok(Some(json!({"stackFrames": frames, "totalFrames": stack.len()})))
    }

    pub(super) fn scopes(&mut self, arguments: &OfFrame) -> Answer {
        let frame = self.frame(Some(arguments.frame_id))?;
        let loaded = self.loaded_mut()?;
        let kinds = [
            ("Locals", ScopeKind::Locals),
            ("Globals", ScopeKind::Globals),
            ("Inputs", ScopeKind::Inputs),
            ("Outputs", ScopeKind::Outputs),
        ];
        let mut scopes = Vec::new();
        for (name, kind) in kinds {
            let variables = loaded.variables_of(kind, &frame).len();
            if variables > 0 || kind == ScopeKind::Locals {
                scopes.push(Scope {
                    name,
                    presentation_hint: (kind == ScopeKind::Locals).then_some("locals"),
                    variables_reference: loaded.handles.add(Handle::Scope(kind, frame)),
                    named_variables: variables,
                    expensive: false,
                });
            }
        }
        Ok(Some(json!({"scopes": scopes})))
    }

    pub(super) fn variables(&mut self, arguments: &Variables) -> Answer {
        let loaded = self.loaded_mut()?;
        let first = usize::try_from(arguments.start).unwrap_or(0);
        let count = match usize::try_from(arguments.count) {
            Ok(0) | Err(_) => MAX_VARIABLES,
            Ok(count) => count.min(MAX_VARIABLES),
        };
        let found = match loaded.handles.get(arguments.reference)? {
            Handle::Scope(kind, frame) => {
                let variables = loaded.variables_of(kind, &frame).into_iter();
                variables.skip(first).take(count).collect()
            }
            Handle::Value(whole) => loaded.parts_of(&whole, first, count),
        };
        let variables: Vec<_> = found.into_iter().map(|named| loaded.describe(named)).collect();
        Ok(Some(json!({"variables": variables})))
    }

    pub(super) fn evaluate(&mut self, arguments: &Evaluate) -> Answer {
        let frame = self.frame(arguments.frame_id)?;
        let loaded = self.loaded()?;
        let expression = arguments.expression.trim();
        let in_scope = [ScopeKind::Locals, ScopeKind::Globals].into_iter();
        let mut variables = in_scope.flat_map(|kind| loaded.variables_of(kind, &frame));
        let named = match variables.find(|named| named.name == expression) {
            Some(named) => Ok(named),
            None => self.watched(loaded, frame, expression),
        }?;
        let is_variable = matches!(arguments.context.as_deref(), Some("watch" | "variables"));
        let loaded = self.loaded_mut()?;
        let subject = Rc::clone(&loaded.subject);
        let shader = &subject.checked.tree;
        let tree = named.tree.clone();
        let tree = tree.as_deref().unwrap_or(shader);
        let evaluated = Evaluated {
            result: if is_variable {
                named.value.text(tree)
            } else {
                named.value.full_text(tree)
            },
            ty: tree.type_name(named.value.ty),
            parts: loaded.parts(named),
        };
        Ok(Some(to_value(&evaluated)))
    }

    /// The value of an expression that is not a variable.
    fn watched(
        &self,
        loaded: &Loaded,
        frame: recording::StackFrame,
        expression: &str,
    ) -> Result<Named, String> {
        let watch = Watch::new(loaded.context(), frame.function, frame.step, expression);
        let evaluated = watch.and_then(|watch| {
            let budget = budget(&loaded.subject, &self.control);
            watch.evaluate(&[(loaded.at, frame)], true, budget)
        });
        let evaluated = evaluated.map_err(|error| {
            format!(
                "{error} (an expression is any that the shader could have here without an assignment, such as \
                 `2.0 * length(p.xy)`, with calls of its functions)"
            )
        })?;
        let value = evaluated.values.into_iter().next();
        Ok(Named {
            name: expression.to_owned(),
            path: Some(format!("({expression})")),
            value: value.ok_or("time limit exceeded")?,
            first_cell: None,
            tree: Some(Rc::new(evaluated.tree)),
        })
    }

    pub(super) fn data_breakpoint_info(&self, arguments: &DataBreakpointInfo) -> Answer {
        let loaded = self.loaded()?;
        let tree = &loaded.subject.checked.tree;
        let handle = arguments.variables_reference.filter(|&number| number > 0);
        let handle = handle.map(|number| loaded.handles.get(number)).transpose()?;
        let variables = match handle {
            Some(Handle::Scope(kind, frame)) => loaded.variables_of(kind, &frame),
            Some(Handle::Value(whole)) => loaded.parts_of(&whole, 0, MAX_VARIABLES),
            None => {
                let frame = self.frame(arguments.frame_id)?;
                let in_scope = [ScopeKind::Locals, ScopeKind::Globals].into_iter();
                in_scope
                    .flat_map(|kind| loaded.variables_of(kind, &frame))
                    .collect()
            }
        };
        let found = variables.iter().find(|named| named.name == arguments.name);
        let cells = found.and_then(|named| named.cells(tree));
        Ok(Some(match cells {
            Some(cells) => json!({
                "dataId": data_id(&cells),
                "description": arguments.name,
                "accessTypes": ["write"],
                "canPersist": false,
            }),
            None => json!({"dataId": Json::Null, "description": "only variables of the shader are written"}),
        }))
    }

    pub(super) fn source(&self, arguments: &SourceArguments) -> Answer {
        let loaded = self.loaded()?;
        let by_number = loaded.sources.by_number(arguments.source_reference);
        let by_source = || loaded.sources.find(arguments.source.as_ref()?);
        let file = by_number.or_else(by_source).ok_or("there is no such source")?;
        let content = loaded.subject.files.get(file).text();
        Ok(Some(json!({"content": content, "mimeType": "text/x-glsl"})))
    }
}

impl Loaded {
    /// The variables of a scope.
    fn variables_of(&self, kind: ScopeKind, frame: &recording::StackFrame) -> Vec<Named> {
        let tree = &self.subject.checked.tree;
        match kind {
            ScopeKind::Locals => {
                let variables = visible(tree, frame.function, frame.step).into_iter();
                variables
                    .filter_map(|variable| self.variable(frame, variable))
                    .collect()
            }
            ScopeKind::Globals => {
                let is_kept = |kind| {
                    matches!(
                        kind,
                        VariableKind::Global | VariableKind::Const | VariableKind::Output
                    )
                };
                let variables = tree.global_variables().filter(|id| is_kept(tree[*id].kind));
                variables
                    .filter_map(|variable| self.variable(frame, variable))
                    .collect()
            }
            ScopeKind::Inputs => self.inputs(),
            ScopeKind::Outputs => self.outputs(),
        }
    }

    /// A variable with its value at this point.
    fn variable(&self, frame: &recording::StackFrame, variable: VariableId) -> Option<Named> {
        let tree = &self.subject.checked.tree;
        let cells = self.recording.cells(frame.call, variable)?;
        let first_cell = Some(cells.start).filter(|_| !cells.is_empty());
        let [single, double] = self.recording.values(cells, self.at);
        let name = tree[variable].name.clone();
        first_cell.map(|_| Named {
            path: Some(name.clone()),
            name,
            value: Value {
                ty: tree[variable].ty,
                single,
                double,
            },
            first_cell,
            tree: None,
        })
    }

    /// What the shader reads of the host's inputs, and the values of its uniforms.
    fn inputs(&self) -> Vec<Named> {
        let (checked, frame) = (&self.subject.checked, &self.subject.frame);
        let tree = &checked.tree;
        let constant = |name: &str, ty: Type, values: Vec<TraceValue>| Named {
            name: name.to_owned(),
            path: Some(name.to_owned()),
            value: Value {
                ty,
                double: values.clone(),
                single: values,
            },
            first_cell: None,
            tree: None,
        };
        let inputs = tree
            .variables
            .iter()
            .filter_map(|(_, variable)| match variable.kind {
                VariableKind::Input(input) if checked.reads(input) => Some((variable, input)),
                _ => None,
            });
        let inputs = inputs.map(|(variable, input)| {
            let components = 0..value::component_count(tree, variable.ty);
            let component = |at| match input {
                Input::Frame => TraceValue::Word(frame.frame.cast_unsigned()),
                _ => TraceValue::Float(f64::from(frame.component(input, at))),
            };
            constant(&variable.name, variable.ty, components.map(component).collect())
        });
        let uniforms = checked.declared_uniforms().filter_map(|(name, ty, values)| {
            let scalars = tree.scalars(ty);
            let values = scalars.iter().enumerate().map(|(at, scalar)| {
                let value = values?.get(at).copied().unwrap_or_default();
                Some(match scalar {
                    toyproof_glsl::tree::Scalar::Float => TraceValue::Float(value),
                    toyproof_glsl::tree::Scalar::Uint => TraceValue::Word(value as u32),
                    _ => TraceValue::Word((value as i32).cast_unsigned()),
                })
            });
            let values: Vec<_> = values.collect::<Option<_>>()?;
            (!values.is_empty()).then(|| constant(name, ty, values))
        });
        inputs.chain(uniforms).collect()
    }

    /// The color as it is now and at the end, and that of the reference.
    fn outputs(&self) -> Vec<Named> {
        let checked = &self.subject.checked;
        let tree = &checked.tree;
        let vec3 = Type::vector(toyproof_glsl::tree::Scalar::Float, 3);
        let color = tree[checked.main_image].parameters.first();
        let main = recording::StackFrame {
            invocation: 0,
            call: None,
            function: checked.main_image,
            at: tree[checked.main_image].at,
            step: None,
        };
        let now = color.and_then(|&color| self.variable(&main, color));
        let floats = |color: [f64; 3]| color.map(TraceValue::Float).to_vec();
        let named = |name: &str, single: [f64; 3], double: [f64; 3]| Named {
            name: name.to_owned(),
            path: None,
            value: Value {
                ty: vec3,
                single: floats(single),
                double: floats(double),
            },
            first_cell: None,
            tree: None,
        };
        let last = match self.recording.colors {
            [Some(single), Some(double)] => Some(named("color of the pixel", single, double)),
            _ => None,
        };
        let expected = self
            .subject
            .expected
            .map(|color| named("color of the reference", color, color));
        now.into_iter().chain(last).chain(expected).collect()
    }

    /// Some of the parts of a value.
    fn parts_of(&self, whole: &Named, first: usize, count: usize) -> Vec<Named> {
        let tree = whole.tree.as_deref().unwrap_or(&self.subject.checked.tree);
        let parts = whole.value.parts(tree, first, count).into_iter();
        let parts = parts.map(|part| {
            let separator = if whole.value.is_indexed() { "" } else { "." };
            Named {
                path: whole
                    .path
                    .as_ref()
                    .map(|path| format!("{path}{separator}{}", part.name)),
                name: part.name,
                value: part.value,
                first_cell: whole.first_cell.map(|first| first + part.offset as u32),
                tree: whole.tree.clone(),
            }
        });
        parts.collect()
    }

    /// A value as the protocol describes it.
    fn describe(&mut self, named: Named) -> Variable {
        let subject = Rc::clone(&self.subject);
        let own = named.tree.clone();
        let tree = own.as_deref().unwrap_or(&subject.checked.tree);
        Variable {
            name: named.name.clone(),
            value: match named.first_cell {
                // The expected color is one of double precision.
                None if named.path.is_none() && named.value.single == named.value.double => {
                    value::text(tree, named.value.ty, &named.value.double, Precision::Double)
                }
                _ => named.value.text(tree),
            },
            ty: tree.type_name(named.value.ty),
            evaluate_name: named.path.clone(),
            parts: self.parts(named),
        }
    }

    /// The numbers with which a client requests the parts of a value.
    fn parts(&mut self, named: Named) -> Parts {
        let tree = named.tree.as_deref().unwrap_or(&self.subject.checked.tree);
        let count = named.value.part_count(tree);
        if count == 0 {
            return Parts::default();
        }
        let is_indexed = named.value.is_indexed();
        Parts {
            variables_reference: self.handles.add(Handle::Value(Rc::new(named))),
            named_variables: (!is_indexed).then_some(count),
            indexed_variables: is_indexed.then_some(count),
        }
    }
}
