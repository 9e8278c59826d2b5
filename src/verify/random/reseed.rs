//! Rewrites a shader so that it uses other random numbers.
//!
//! GLSL has no random numbers: shaders hash the pixel's coordinates, the time or a counter. Hashes are
//! recognized by their operations: products with large integers, sums and exclusive ors with them; sines
//! multiplied by large factors; floats converted to bits. Adding an integer there yields other numbers with
//! the same distribution, and so does, for a hash of floats, moving the pixel by a thousandth of its size.
//! Integers that determine something else, such as a scene, may be changed as well: the caller must check
//! that only the noise changes ([`Reseeding::all`] returns several alternatives).

use std::collections::HashSet;
use std::time::Instant;

use toyproof_eval::{Places, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, Expr, ExprId, ExprKind, FunctionId, Scalar, Tree, Type, Value, walk,
};
use toyproof_image::{Frame, Image};

use super::pixel_dependence::PixelDependence;
use crate::bounds::MAX_ITERATIONS;

/// The smallest absolute value of an integer that is a constant of a hash.
const MIN_HASH_INTEGER: u32 = 1 << 16;

/// The smallest absolute value of a factor that turns a sine or a fraction into noise.
const MIN_NOISE_FACTOR: f64 = 20.0;

/// What a factor of noise grows by with each salt.
const FACTOR_STEP: f64 = 17.31;

/// The operations that are changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reseeding {
    /// Operations with large integers.
    integers: bool,
    /// Conversions of floats to unsigned integers.
    conversions: bool,
    /// Large factors of sines and fractions.
    fractions: bool,
}

impl Reseeding {
    /// The alternatives, in the order in which they are tried: all operations, each kind alone, and none, for
    /// which only the pixel's shift changes the numbers.
    pub(crate) fn all() -> [Self; 5] {
        let none = Self {
            integers: false,
            conversions: false,
            fractions: false,
        };
        [
            Self {
                integers: true,
                conversions: true,
                fractions: true,
            },
            Self {
                integers: true,
                ..none
            },
            Self {
                fractions: true,
                ..none
            },
            Self {
                conversions: true,
                ..none
            },
            none,
        ]
    }

    /// Returns the shader with other random numbers for each salt; with salt 0, it is unchanged.
    pub(crate) fn apply(self, checked: &Checked, salt: u32) -> Checked {
        let mut checked = checked.clone();
        let tree = &mut checked.tree;
        let ids: Vec<ExprId> = tree.exprs.ids().collect();
        for id in ids {
            self.change(tree, id, salt);
        }
        tree.clear_cached_values();
        checked
    }

    /// Evaluates the shader with other random numbers, at places that are shifted with it; `None` if a pixel
    /// runs too many loop iterations, or after the deadline.
    pub(crate) fn evaluate(
        self,
        checked: &Checked,
        salt: u32,
        frame: &Frame,
        places: &Places,
        deadline: Option<Instant>,
    ) -> Option<Image> {
        let program = Program::prepared(&self.apply(checked, salt), UndefinedPolicy::Plain).ok()?;
        let settings = Settings::<f64> {
            max_iterations: MAX_ITERATIONS,
            deadline,
            ..Settings::plain()
        };
        program
            .at(frame, &places.shifted(Self::shift(salt)), &settings)
            .ok()
    }

    /// Whether some of these operations compute with the position of the pixel, by the flow of data. A
    /// sampler that counts its numbers in each pixel alike does not, though a loop may take more of them in
    /// some pixels.
    pub(crate) fn depends_on_pixel(self, checked: &Checked) -> bool {
        let mut salted = checked.tree.clone();
        let mut is_changed = |id: ExprId| {
            let before = salted.exprs.len();
            self.change(&mut salted, id, 1);
            // A change adds expressions.
            salted.exprs.len() > before
        };
        let changed: Vec<ExprId> = checked.tree.exprs.ids().filter(|&id| is_changed(id)).collect();
        let dependence = PixelDependence::new(checked);
        // Without such operations, only the shift of the pixel yields other numbers.
        changed.is_empty() || changed.into_iter().any(|id| dependence.reaches(id))
    }

    /// The offset of pixels, in pixels: enough to change any hash of their coordinates, and nothing else.
    pub(crate) fn shift(salt: u32) -> [f64; 2] {
        // In both directions, so that its effect on edges averages out.
        let sign = if salt.is_multiple_of(2) { 1.0 } else { -1.0 };
        let step = f64::from(salt.div_ceil(2));
        [0.001_37 * sign * step, -0.000_91 * sign * step]
    }

    fn change(self, tree: &mut Tree, id: ExprId, salt: u32) {
        match tree[id].kind.clone() {
            ExprKind::Binary { op, left, right } => match op {
                BinaryOp::Multiply if self.integers && is_integer(tree, id) => {
                    // The constant is kept, since not every factor makes a good hash.
                    if is_large(tree, right) {
                        add(tree, left, salt);
                    } else if is_large(tree, left) {
                        add(tree, right, salt);
                    }
                }
                BinaryOp::Add | BinaryOp::BitXor if self.integers && is_integer(tree, id) => {
                    if let Some(large) = [left, right].into_iter().find(|&side| is_large(tree, side)) {
                        add(tree, large, salt);
                    }
                }
                BinaryOp::Multiply if self.fractions => {
                    for (noise, factor) in [(left, right), (right, left)] {
                        if is_noise(tree, noise) && is_factor(tree, factor) {
                            add(tree, factor, salt);
                        }
                    }
                }
                _ => {}
            },
            ExprKind::Assign {
                op: Some(op @ (BinaryOp::Add | BinaryOp::BitXor | BinaryOp::Multiply)),
                target,
                value,
            } if self.integers && is_integer(tree, id) && is_large(tree, value) => {
                if op != BinaryOp::Multiply {
                    add(tree, value, salt);
                } else if let ExprKind::Variable(_) = tree[target].kind {
                    // x *= c becomes x = (x + salt) * c.
                    let copy = tree[target].clone();
                    let ty = copy.ty;
                    let copy = tree.exprs.push(copy);
                    add(tree, copy, salt);
                    let product = tree.exprs.push(Expr {
                        kind: ExprKind::Binary {
                            op,
                            left: copy,
                            right: value,
                        },
                        ty,
                        constant: false,
                        at: tree[id].at,
                    });
                    tree[id].kind = ExprKind::Assign {
                        op: None,
                        target,
                        value: product,
                    };
                }
            }
            ExprKind::Construct {
                constructor: Constructor::Scalar | Constructor::Vector,
                arguments,
            } if self.conversions => {
                let is_float = |&argument: &ExprId| tree[argument].ty.scalar() == Some(Scalar::Float);
                let all_floats = arguments.iter().all(is_float);
                if tree[id].ty.scalar() == Some(Scalar::Uint) && all_floats && tree.value(id).is_none() {
                    add(tree, id, salt);
                }
            }
            ExprKind::BuiltIn {
                function: BuiltIn::FloatBitsToUint,
                ..
            } if self.conversions => add(tree, id, salt),
            _ => {}
        }
    }
}

/// Replaces an expression by its sum with a number that depends on the salt.
fn add(tree: &mut Tree, id: ExprId, salt: u32) {
    let Expr { ty, at, .. } = tree[id].clone();
    // Multiples of the golden ratio differ in all bits. Even, so that odd constants stay odd.
    let hash = salt.wrapping_mul(0x9E37_79B9) & !1;
    let value = match ty.scalar() {
        Some(Scalar::Uint) => Value::Uint(hash),
        // Below 2²⁰, so that hardly any constant overflows.
        Some(Scalar::Int) => Value::Int((hash >> 12).cast_signed() & !1),
        Some(Scalar::Float) => Value::Float(FACTOR_STEP * f64::from(salt)),
        _ => return,
    };
    let term = tree[id].clone();
    let left = tree.exprs.push(term);
    let right = tree.exprs.push(Expr {
        kind: ExprKind::Literal(value.into()),
        ty: value.ty(),
        constant: true,
        at,
    });
    tree[id] = Expr {
        kind: ExprKind::Binary {
            op: BinaryOp::Add,
            left,
            right,
        },
        ty,
        constant: false,
        at,
    };
}

/// Whether no expression that runs can produce a random number: there is no hash and no texture.
pub(crate) fn is_deterministic(checked: &Checked) -> bool {
    let tree = &checked.tree;
    reachable_expressions(tree, checked.main_image)
        .into_iter()
        .all(|id| {
            let expr = &tree[id];
            let is_random = match &expr.kind {
                ExprKind::Binary { op, .. } | ExprKind::Assign { op: Some(op), .. } => matches!(
                    op,
                    BinaryOp::BitXor
                        | BinaryOp::BitAnd
                        | BinaryOp::BitOr
                        | BinaryOp::ShiftLeft
                        | BinaryOp::ShiftRight
                ),
                ExprKind::BuiltIn { function, .. } => {
                    matches!(
                        function,
                        BuiltIn::Fract | BuiltIn::FloatBitsToInt | BuiltIn::FloatBitsToUint
                    ) || function.name().starts_with("tex")
                }
                _ => false,
            };
            !is_random && expr.ty.scalar() != Some(Scalar::Uint)
        })
}

/// All expressions that `main` evaluates, and the initializers of the variables that they name.
#[must_use]
pub fn reachable_expressions(tree: &Tree, main: FunctionId) -> Vec<ExprId> {
    let (mut functions, mut variables) = (HashSet::new(), HashSet::new());
    let roots_of = |function: FunctionId| {
        let body = tree[function].body.as_ref();
        body.map_or_else(Vec::new, |body| walk::roots(tree, body))
    };
    let mut roots = roots_of(main);
    let mut all = Vec::new();
    while let Some(root) = roots.pop() {
        for id in tree.postorder(root) {
            match tree[id].kind {
                ExprKind::Call { function, .. } if functions.insert(function) => {
                    roots.extend(roots_of(function));
                }
                ExprKind::Variable(variable) if variables.insert(variable) => {
                    roots.extend(tree[variable].initializer);
                }
                _ => {}
            }
            all.push(id);
        }
    }
    all
}

fn is_integer(tree: &Tree, id: ExprId) -> bool {
    matches!(tree[id].ty.scalar(), Some(Scalar::Int | Scalar::Uint))
        && matches!(tree[id].ty, Type::Scalar(_) | Type::Vector(..))
}

/// Whether an expression is a constant of a hash.
fn is_large(tree: &Tree, id: ExprId) -> bool {
    let is_large = |&component: &Value| match component {
        Value::Int(value) => value.unsigned_abs() >= MIN_HASH_INTEGER,
        Value::Uint(value) => value >= MIN_HASH_INTEGER,
        _ => false,
    };
    has_components(tree, id, is_large)
}

/// Whether an expression is a sine or a fraction, which a large factor turns into noise.
fn is_noise(tree: &Tree, id: ExprId) -> bool {
    matches!(
        tree[id].kind,
        ExprKind::BuiltIn {
            function: BuiltIn::Sin | BuiltIn::Cos | BuiltIn::Fract,
            ..
        }
    )
}

fn is_factor(tree: &Tree, id: ExprId) -> bool {
    has_components(
        tree,
        id,
        |&component| matches!(component, Value::Float(value) if value.abs() >= MIN_NOISE_FACTOR),
    )
}

/// Whether an expression is a constant scalar, vector or matrix all of whose components satisfy `is_such`.
fn has_components(tree: &Tree, id: ExprId, is_such: impl Fn(&Value) -> bool) -> bool {
    tree.value(id).is_some_and(|constant| {
        let components = constant.components();
        !components.is_empty() && components.iter().all(is_such)
    })
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl as glsl;

    use super::*;

    fn render(checked: &Checked) -> Vec<f64> {
        let frame = Frame {
            size: [32, 32],
            ..Frame::default()
        };
        let program = Program::new(checked).unwrap();
        let rendered = program.render(&frame, &Settings::<f64>::default()).unwrap();
        (0..1024)
            .map(|at| rendered.framebuffer.get(at % 32, at / 32)[0])
            .collect()
    }

    fn checked(random: &str) -> Checked {
        let text = format!(
            "{random}\nvoid mainImage(out vec4 color, in vec2 p) {{ float u = random(p); color = vec4(u, p.x / 32.0, 0.0, 1.0); }}"
        );
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        glsl::check(&files, file, &glsl::Options::default()).unwrap()
    }

    /// Common hashes of the pixel's coordinates.
    const HASHES: [&str; 6] = [
        "uint pcg(uint v) { uint s = v * 747796405u + 2891336453u; uint w = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u; return (w >> 22u) ^ w; }
         float random(vec2 p) { return float(pcg(uint(p.x) + pcg(uint(p.y))) >> 8) / 16777216.0; }",
        "float random(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }",
        "float random(vec2 p) { uint s = uint(p.x) * 1973u + uint(p.y) * 9277u; s = (s ^ 61u) ^ (s >> 16u); s *= 9u; s = s ^ (s >> 4u);
         s *= 0x27d4eb2du; s = s ^ (s >> 15u); return float(s) / 4294967296.0; }",
        "float random(vec2 p) { uint s = uint(p.x) + 32u * uint(p.y) + 1u; s ^= s << 13u; s ^= s >> 17u; s ^= s << 5u; s ^= s << 13u; s ^= s >> 17u;
         s ^= s << 5u; return float(s >> 8) / 16777216.0; }",
        "float random(vec2 p) { vec3 q = fract(vec3(p.xyx) * 0.1031); q += dot(q, q.yzx + 33.33); return fract((q.x + q.y) * q.z); }",
        "float random(vec2 p) { int s = int(p.x) + int(p.y) * 32; for (int i = 0; i < 4; i++) s = s * 1103515245 + 12345;
         return float((s >> 8) & 0x7fff) / 32768.0; }",
    ];

    #[test]
    fn another_salt_yields_other_numbers_of_the_same_distribution() {
        for hash in HASHES {
            let checked = checked(hash);
            let unsalted = render(&checked);
            for salt in 1..5 {
                let salted = Reseeding::all()[0].apply(&checked, salt);
                let program = Program::new(&salted).unwrap();
                let [x, y] = Reseeding::shift(salt);
                let places = Places {
                    columns: (0..32).map(|at| f64::from(at) + 0.5 + x).collect(),
                    rows: (0..32).map(|at| f64::from(at) + 0.5 + y).collect(),
                };
                let frame = Frame {
                    size: [32, 32],
                    ..Frame::default()
                };
                let other = program.at(&frame, &places, &Settings::<f64>::default()).unwrap();
                let other: Vec<f64> = other.pixels().iter().map(|pixel| f64::from(pixel[0])).collect();
                let mean = other.iter().sum::<f64>() / 1024.0;
                // The standard deviation of the mean is 1/√12 over 32; a weak hash has a larger one.
                assert!((mean - 0.5).abs() < 0.06, "{mean} {hash}");
                let product = |a: &[f64], b: &[f64]| {
                    a.iter().zip(b).map(|(a, b)| (a - 0.5) * (b - 0.5)).sum::<f64>() / 1024.0 * 12.0
                };
                let covariance = product(&unsalted, &other);
                assert!(covariance.abs() < 0.5, "{covariance} salt {salt} {hash}");
            }
        }
    }

    #[test]
    fn random_numbers_in_uncalled_functions_are_ignored() {
        let unused = format!("{}\n", HASHES[0].replace("random", "unused"));
        for (random, is_without) in [
            ("float random(vec2 p) { return p.x * 0.01; }", true),
            ("float random(vec2 p) { return float(pcg(7u)); }", false),
        ] {
            let checked = checked(&format!("{unused}{random}"));
            assert_eq!(is_deterministic(&checked), is_without, "{random}");
        }
        let global = checked("const int BITS = 6 ^ 3;\nfloat random(vec2 p) { return p.x * float(BITS); }");
        assert!(!is_deterministic(&global));
    }

    #[test]
    fn a_counter_is_no_hash_of_the_position() {
        let depends = |random: &str| Reseeding::all()[0].depends_on_pixel(&checked(random));
        for hash in HASHES {
            assert!(depends(hash), "{hash}");
        }
        let counter = "uint state = 1u;
            float next() { state = state * 747796405u + 2891336453u; return float(state >> 8) / 16777216.0; }
            float random(vec2 p) { float sum = 0.0; for (int i = 0; i < int(p.x); i++) sum += next(); return sum / p.x; }";
        assert!(!depends(counter));
    }

    #[test]
    fn expressions_that_are_not_hashes_are_unchanged() {
        let checked = checked(
            "float random(vec2 p) { int i = int(p.x) * 3 + 7; return fract(p.x * 0.5) + float(i) * 0.001 + 100.0 * p.y; }",
        );
        let salted = Reseeding::all()[0].apply(&checked, 3);
        assert_eq!(render(&checked), render(&salted));
    }
}
