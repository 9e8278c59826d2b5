//! Which values of a shader depend on the position of the pixel, by the flow of data: not those that are only
//! assigned more often in some pixels.

use std::collections::HashSet;

use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    BuiltInVariable, Direction, ExprId, ExprKind, FunctionId, StatementKind, Tree, VariableId, VariableKind,
    walk,
};

/// The variables and the functions whose values depend on the position, in any call.
#[derive(Debug)]
pub(super) struct PixelDependence<'a> {
    tree: &'a Tree,
    variables: HashSet<VariableId>,
    functions: HashSet<FunctionId>,
}

impl<'a> PixelDependence<'a> {
    pub(super) fn new(checked: &'a Checked) -> Self {
        let tree = &checked.tree;
        let position = VariableKind::BuiltIn(BuiltInVariable::FragCoord);
        let built_in = tree
            .variables
            .iter()
            .filter(|(_, variable)| variable.kind == position);
        let built_in = built_in.map(|(id, _)| id);
        let mut dependence = Self {
            tree,
            // The second parameter of `mainImage` is the position.
            variables: tree[checked.main_image]
                .parameters
                .iter()
                .copied()
                .skip(1)
                .chain(built_in)
                .collect(),
            functions: HashSet::new(),
        };
        while dependence.spread() {}
        dependence
    }

    /// Whether an expression, or a part of it, depends on the position.
    pub(super) fn reaches(&self, root: ExprId) -> bool {
        self.dependent(root).contains(&root)
    }

    /// The dependent ones among an expression and its parts.
    fn dependent(&self, root: ExprId) -> HashSet<ExprId> {
        let tree = self.tree;
        let mut dependent = HashSet::new();
        for id in tree.postorder(root) {
            let is_dependent = match &tree[id].kind {
                ExprKind::Variable(variable) => self.variables.contains(variable),
                ExprKind::Call { function, .. } => self.functions.contains(function),
                // A condition selects a value, and is not a part of it.
                ExprKind::Conditional { yes, no, .. } => dependent.contains(yes) || dependent.contains(no),
                kind => {
                    let mut any = false;
                    kind.for_each_operand(|operand| any |= dependent.contains(&operand));
                    any
                }
            };
            if is_dependent {
                dependent.insert(id);
            }
        }
        dependent
    }

    /// Adds the values that depend directly on known ones, and returns whether there are new ones.
    fn spread(&mut self) -> bool {
        let tree = self.tree;
        let before = self.variables.len() + self.functions.len();
        for (id, variable) in tree.variables.iter() {
            if variable
                .initializer
                .is_some_and(|initializer| self.reaches(initializer))
            {
                self.variables.insert(id);
            }
        }
        for (id, function) in tree.functions.iter() {
            let Some(body) = &function.body else { continue };
            for root in walk::roots(tree, body) {
                let dependent = self.dependent(root);
                for at in tree.postorder(root) {
                    self.write(at, &dependent);
                }
            }
            walk::each(body, &mut |statement| {
                if let StatementKind::Return(Some(value)) = statement.kind
                    && self.reaches(value)
                {
                    self.functions.insert(id);
                }
            });
        }
        self.variables.len() + self.functions.len() > before
    }

    /// Adds the variables to which an expression writes dependent values.
    fn write(&mut self, at: ExprId, dependent: &HashSet<ExprId>) {
        let tree = self.tree;
        match &tree[at].kind {
            ExprKind::Assign { target, value, .. } if dependent.contains(value) => {
                self.variables.extend(tree.root_variable(*target));
            }
            ExprKind::Call { function, arguments } => {
                for (&parameter, argument) in tree[*function].parameters.iter().zip(arguments) {
                    let VariableKind::Parameter(direction) = tree[parameter].kind else {
                        continue;
                    };
                    if direction != Direction::Out && dependent.contains(argument) {
                        self.variables.insert(parameter);
                    }
                    if direction != Direction::In && self.variables.contains(&parameter) {
                        self.variables.extend(tree.root_variable(*argument));
                    }
                }
            }
            ExprKind::BuiltIn { function, arguments } => {
                if let Some(written) = function.out_parameter()
                    && arguments.iter().any(|argument| dependent.contains(argument))
                {
                    self.variables.extend(tree.root_variable(arguments[written]));
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl as glsl;

    use super::*;

    /// Whether the color depends on the position.
    fn color_depends(text: &str) -> bool {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
        let color = checked.tree[checked.main_image].parameters[0];
        PixelDependence::new(&checked).variables.contains(&color)
    }

    #[test]
    fn data_flows_through_calls_parameters_and_globals() {
        for text in [
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(p.x); }",
            "void mainImage(out vec4 c, in vec2 p) { c = gl_FragCoord; }",
            "float f(float x) { return x * 2.0; } void mainImage(out vec4 c, in vec2 p) { c = vec4(f(p.y)); }",
            "void f(inout float x, float y) { x += y; }
             void mainImage(out vec4 c, in vec2 p) { float x; f(x, p.y); c.x = x; }",
            "float g; float f() { return g; } void mainImage(out vec4 c, in vec2 p) { g = p.x; c = vec4(f()); }",
            "void mainImage(out vec4 c, in vec2 p) { float i; modf(p.x, i); c = vec4(i); }",
        ] {
            assert!(color_depends(text), "{text}");
        }
    }

    #[test]
    fn control_flow_is_no_flow_of_data() {
        for text in [
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }",
            "void mainImage(out vec4 c, in vec2 p) { c = p.x > 9.0 ? vec4(1) : vec4(0); }",
            "uint s = 7u; float next() { s = s * 747796405u + 1u; return float(s); }
             void mainImage(out vec4 c, in vec2 p) { for (int i = 0; i < int(p.x); i++) { c.x += next(); } }",
        ] {
            assert!(!color_depends(text), "{text}");
        }
    }
}
