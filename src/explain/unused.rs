//! The inputs and functions that a reference shader uses and another shader leaves unused.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use toyproof_diagnostic::Span;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprKind, VariableKind};
use toyproof_verify::random::reachable_expressions;

/// The inputs and functions that a reference uses and a shader does not.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Unused {
    /// The names of the inputs and uniforms that only the reference reads, such as `iMouse`.
    pub inputs: Vec<String>,
    /// The names of functions that the shader defines and never calls, each with the first call of a function
    /// of this name in the reference.
    pub functions: Vec<(String, Span)>,
}

impl Unused {
    /// Compares all passes of a shader with those of its reference, as far as they are executed.
    #[must_use]
    pub fn new(shader: &[&Checked], reference: &[&Checked]) -> Self {
        let (own, expected) = (Uses::new(shader), Uses::new(reference));
        let missing = expected.inputs.difference(&own.inputs);
        let mut inputs: Vec<String> = missing.map(|kind| name(*kind, shader)).collect();
        inputs.extend(
            expected
                .values
                .difference(&own.values)
                .map(|&name| name.to_owned()),
        );
        inputs.sort_unstable();
        let is_uncalled = |name: &str| own.defined.contains(name) && !own.calls.contains_key(name);
        let calls = expected.calls.into_iter().filter(|(name, _)| is_uncalled(name));
        let mut functions: Vec<_> = calls.collect();
        functions.sort_by_key(|(_, call)| call.order());
        let functions = functions.into_iter().map(|(name, call)| (name, call.span));
        Self {
            inputs,
            functions: functions.collect(),
        }
    }
}

/// The name of an input in the dialect of a shader, which may not declare it.
fn name(kind: VariableKind, shader: &[&Checked]) -> String {
    let of_host = match (kind, shader.first()) {
        (VariableKind::Input(input), Some(checked)) => checked.dialect.name_of(input),
        _ => None,
    };
    let mut variables = shader.iter().flat_map(|checked| checked.tree.variables.iter());
    let found = variables.find(|(_, variable)| variable.kind == kind);
    let own = found.map_or_else(String::new, |(_, variable)| variable.name.clone());
    of_host.map_or(own, str::to_owned)
}

/// The inputs and functions that the passes of a shader use.
#[derive(Default)]
struct Uses<'a> {
    inputs: HashSet<VariableKind>,
    /// The uniforms of the author, whose values are constants.
    values: BTreeSet<&'a str>,
    /// Called functions, each with its first call.
    calls: BTreeMap<String, Call>,
    /// Functions with a body.
    defined: BTreeSet<String>,
}

/// A call in a pass.
#[derive(Clone, Copy)]
struct Call {
    /// The number of the pass.
    pass: usize,
    span: Span,
}

impl Call {
    /// Orders calls by the passes, which are separate files, and by their places.
    fn order(self) -> (usize, u32) {
        (self.pass, self.span.start)
    }
}

impl<'a> Uses<'a> {
    fn new(passes: &[&'a Checked]) -> Self {
        let mut uses = Self::default();
        for (pass, checked) in passes.iter().enumerate() {
            let tree = &checked.tree;
            let values = checked.values_read.iter();
            uses.values.extend(values.map(|&variable| &*tree[variable].name));
            for expr in reachable_expressions(tree, checked.main_image) {
                match tree[expr].kind {
                    ExprKind::Variable(variable) if tree[variable].kind.is_input() => {
                        uses.inputs.insert(tree[variable].kind);
                    }
                    ExprKind::Call { function, .. } => {
                        let span = tree[expr].at.span;
                        let call = Call { pass, span };
                        let first = uses.calls.entry(tree[function].name.clone()).or_insert(call);
                        if call.order() < first.order() {
                            *first = call;
                        }
                    }
                    _ => {}
                }
            }
            let functions = tree.functions.iter().map(|(_, function)| function);
            let defined = functions.filter(|function| function.body.is_some());
            uses.defined.extend(defined.map(|function| function.name.clone()));
        }
        uses
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    fn checked(text: &str) -> Checked {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        toyproof_glsl::check(&files, file, &Default::default()).unwrap()
    }

    fn unused(shader: &str, reference: &str) -> (Vec<String>, Vec<String>) {
        let (shader, reference) = (checked(shader), checked(reference));
        let Unused { inputs, functions } = Unused::new(&[&shader], &[&reference]);
        (inputs, functions.into_iter().map(|(name, _)| name).collect())
    }

    #[test]
    fn inputs_that_only_the_reference_reads_are_named() {
        let reference = "float wave(float x) { return sin(x + iTime); }
            void mainImage(out vec4 c, in vec2 p) {
                c = vec4(wave(p.x)) * texture(iChannel2, p / iResolution.xy) * iMouse.x * float(iFrame);
            }";
        let inputs = |shader: &str| unused(shader, reference).0;
        let still = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, 0.0, 1.0); }";
        assert_eq!(inputs(still), ["iChannel2", "iFrame", "iMouse", "iTime"]);
        // Reading an input in a function that is never called does not count.
        let dead = format!("float wave() {{ return iTime; }} {still}");
        assert_eq!(inputs(&dead), ["iChannel2", "iFrame", "iMouse", "iTime"]);
        assert!(inputs(reference).is_empty());
        assert!(unused(reference, still).0.is_empty());
    }

    #[test]
    fn calls_are_in_the_order_of_the_passes() {
        let image = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }";
        let padding = " ".repeat(200);
        let with = |names: [&str; 2], calls: &str, before: &str| {
            let define = |name: &str| format!("float {name}(float x) {{ return x; }}");
            format!(
                "{before}{}{} void mainImage(out vec4 c, in vec2 p) {{ c = vec4({calls}); }}",
                define(names[0]),
                define(names[1])
            )
        };
        // The calls of the first pass have the larger offsets.
        let first = with(["sky", "fog"], "sky(p.x)", &padding);
        let second = with(["fog", "sky"], "fog(p.x) * sky(p.x)", "");
        let shader = checked(&with(["fog", "sky"], "0.0", ""));
        let (first, second) = (checked(&first), checked(&second));
        let Unused { functions, .. } = Unused::new(&[&shader, &checked(image)], &[&first, &second]);
        let names: Vec<_> = functions.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["sky", "fog"]);
        assert!(functions[0].1.start > 200);
    }

    #[test]
    fn a_function_that_only_the_reference_calls_is_named() {
        let with = |call: &str| {
            format!(
                "float shadow(vec2 p) {{ return p.x; }} float sky(vec2 p) {{ return p.y; }}
                 void mainImage(out vec4 c, in vec2 p) {{ c = vec4({call}); }}"
            )
        };
        let functions = |shader: &str, reference: &str| unused(&with(shader), &with(reference)).1;
        assert_eq!(functions("sky(p)", "sky(p) * shadow(p)"), ["shadow"]);
        assert!(functions("sky(p) * shadow(p)", "sky(p)").is_empty());
        // A shader without the function has other reasons to be wrong.
        let other = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); }";
        assert!(unused(other, &with("shadow(p)")).1.is_empty());
    }
}
