//! Functions, declarations and statements.

use super::expr::{Expr, Level, Range};
use super::types::{BOOL, Base, FLOAT, INT, Scalar, Type, UINT};
use super::{Around, Function, Generator, MAX_WORK, Mode, Passing, Variable, dimension};

/// The maximum nesting depth of statements.
const MAX_DEPTH: usize = 4;

impl Generator<'_> {
    /// A global variable or constant.
    pub(super) fn global(&mut self) {
        let ty = self.ty();
        let constant = self.choices.chance(100);
        // Globals must not have the names of built-in functions and inputs.
        let name = format!("g{}", self.scopes.last().map_or(0, Vec::len));
        self.operands = 0;
        let value = self.within(Mode::Constant, |this| this.storable(ty));
        let word = if constant { "const " } else { "" };
        let initial = value.at(Level::Assignment);
        self.line(&format!("{word}{} = {initial};", declarator(ty, &name)));
        self.declare(Variable {
            name,
            ty,
            writable: !constant,
            constant,
            range: Range::VARIABLE,
        });
    }

    fn variable(&mut self, name: String, ty: Type, writable: bool) {
        self.declare(Variable {
            name,
            ty,
            writable,
            constant: false,
            range: Range::VARIABLE,
        });
    }

    pub(super) fn function(&mut self) {
        let result = (!self.choices.chance(60)).then(|| self.ty());
        let count = self.choices.below(4);
        let mut parameters = Vec::new();
        let mut words = Vec::new();
        let mut outputs = Vec::new();
        self.scopes.push(Vec::new());
        for _ in 0..count {
            let (word, passing) = self.choices.pick(&[
                ("", Passing::In),
                ("in ", Passing::In),
                ("const in ", Passing::In),
                ("inout ", Passing::InOut),
                ("out ", Passing::Out),
            ]);
            let ty = self.ty();
            let name = self.name();
            words.push(format!("{word}{}", declarator(ty, &name)));
            if passing == Passing::Out {
                outputs.push((name.clone(), ty));
            }
            self.variable(name, ty, word != "const in ");
            parameters.push((passing, ty));
        }
        // Overloads share a name.
        let types =
            |function: &Function| -> Vec<Type> { function.parameters.iter().map(|&(_, ty)| ty).collect() };
        let own: Vec<Type> = parameters.iter().map(|&(_, ty)| ty).collect();
        let same = |name: &str| {
            self.functions
                .iter()
                .any(|function| function.name == name && types(function) == own)
        };
        let mut number = 0;
        while same(&format!("f{number}")) {
            number += 1;
        }
        let name = format!("f{number}");
        let head = format!(
            "{} {name}({})",
            result.map_or_else(|| "void".to_owned(), Type::name),
            words.join(", ")
        );
        if self.choices.chance(30) {
            self.line(&format!("{head};"));
        }
        self.line(&format!("{head} {{"));
        self.result = result;
        self.work = 1;
        self.indent += 1;
        for (name, ty) in outputs {
            let value = self.first_value(ty);
            self.line(&format!("{name} = {value};"));
        }
        self.statements(6);
        if let Some(ty) = result {
            self.operands = 0;
            let value = self.storable(ty);
            self.line(&format!("return {};", value.text));
        }
        self.indent -= 1;
        self.line("}");
        self.scopes.pop();
        self.functions.push(Function {
            name,
            parameters,
            result,
            work: self.work,
        });
    }

    /// The initial value, which reads no variable that is not initialized yet.
    fn first_value(&mut self, ty: Type) -> String {
        self.operands = 0;
        let value = self.within(Mode::Constant, |this| this.storable(ty));
        value.at(Level::Assignment)
    }

    pub(super) fn main_image(&mut self) {
        self.scopes.push(Vec::new());
        let point = Type::of(Base::Vector(Scalar::Float, 2));
        self.variable("at".into(), point, true);
        self.line("void mainImage(out vec4 colour, in vec2 at) {");
        self.indent += 1;
        self.line("colour = vec4(0);");
        self.line("int column = int(at.x), row = int(at.y);");
        self.variable("column".into(), INT, true);
        self.variable("row".into(), INT, true);
        self.in_main = true;
        for function in self.functions.clone() {
            self.operands = 0;
            if let Some(call) = self.call(&function) {
                self.line(&format!("{};", call.text));
            }
        }
        self.statements(14);
        self.line("uint h = 1u;");
        let mut seen = Vec::new();
        let variables: Vec<_> = self.scopes[1..].iter().rev().flatten().cloned().collect();
        for Variable { name, ty, .. } in variables {
            if seen.contains(&name) {
                continue;
            }
            let part = self.digest(ty, &name);
            self.line(&format!("h = h * 31u + {part};"));
            seen.push(name);
        }
        self.line("colour = vec4(float(h & 0xffffu), float(h >> 16u), float(column), 1.0);");
        self.indent -= 1;
        self.line("}");
        self.scopes.pop();
    }

    fn statements(&mut self, most: usize) {
        let count = 1 + self.choices.below(most);
        for _ in 0..count {
            if self.choices.is_over() {
                break;
            }
            self.statement();
        }
    }

    /// Statements in braces. They may share the scope of the text before the brace.
    fn block(&mut self, before: &str, after: &str, shared: bool) {
        self.line(&format!("{before}{{"));
        if !shared {
            self.scopes.push(Vec::new());
        }
        self.indent += 1;
        self.statements(4);
        self.indent -= 1;
        if !shared {
            self.scopes.pop();
        }
        self.line(&format!("}}{after}"));
    }

    fn statement(&mut self) {
        self.operands = 0;
        let nested = self.indent > MAX_DEPTH;
        match self.choices.below(20) {
            0..=3 => self.declaration(),
            4..=7 => self.assignment(),
            8 => {
                let result = if self.choices.chance(128) {
                    None
                } else {
                    Some(self.ty())
                };
                if let Some(call) = self.called(result) {
                    self.line(&format!("{};", call.text));
                }
            }
            9 => {
                let ty = self.choices.pick(&[INT, UINT]);
                let change = self.changed(ty);
                self.line(&format!("{};", change.text));
            }
            10 => self.compound(),
            11..=13 if !nested => self.branch(),
            14 | 15 if !nested => self.counted(),
            16 if !nested => self.repeated(),
            17 if !nested => self.switch(),
            18 => self.jump(),
            _ if !nested => self.block("", "", false),
            _ => self.assignment(),
        }
    }

    fn declaration(&mut self) {
        let ty = self.ty();
        let constant = self.choices.chance(40);
        let apart = self.choices.chance(40);
        let mode = if constant { Mode::Constant } else { Mode::Any };
        let value = self.within(mode, |this| this.storable(ty));
        let name = self.name();
        let declared = declarator(ty, &name);
        let value = value.at(Level::Assignment);
        if constant {
            self.line(&format!("const {declared} = {value};"));
        } else if apart && !names(&value, &name) {
            self.line(&format!("{declared};"));
            self.line(&format!("{name} = {value};"));
        } else {
            self.line(&format!("{declared} = {value};"));
        }
        self.declare(Variable {
            name,
            ty,
            writable: !constant,
            constant,
            range: Range::VARIABLE,
        });
    }

    fn assignment(&mut self) {
        let ty = self.ty();
        let Some((_, place)) = self.place(ty, true, &[]) else {
            return;
        };
        let value = self.storable(ty);
        self.line(&format!("{} = {};", place.text, value.at(Level::Assignment)));
    }

    /// A compound assignment of floats, reduced to range immediately: so neither side may have side effects.
    fn compound(&mut self) {
        let ty = self.ty();
        let ty = if ty.is_float() { ty } else { FLOAT };
        if self.choices.chance(100) {
            return self.compound_anywhere(ty);
        }
        let Some(place) = self.steady_place(ty) else {
            return;
        };
        let (other, op) = match ty.base {
            Base::Matrix(columns, rows) if columns == rows && self.choices.chance(100) => (ty, "*="),
            Base::Vector(_, size) if self.choices.chance(80) => (Type::of(Base::Matrix(size, size)), "*="),
            _ => {
                let op = self.choices.pick(&["+=", "-=", "*="]);
                let op = if matches!(ty.base, Base::Matrix(..)) && op == "*=" {
                    "+="
                } else {
                    op
                };
                let other = if self.choices.chance(128) { FLOAT } else { ty };
                (other, op)
            }
        };
        let value = self.within(Mode::Pure, |this| this.storable(other));
        let wild = Expr::primary(place.as_str(), Range::new(1e5, 8));
        let back = self.tamed(ty, wild);
        self.line(&format!("{place} {op} {};", value.at(Level::Assignment)));
        self.line(&format!("{place} = {};", back.text));
    }

    /// A compound assignment of any part of a float variable, which is then reduced to range completely: both
    /// sides may have side effects.
    fn compound_anywhere(&mut self, ty: Type) {
        let Some((name, place)) = self.place(ty, true, &[]) else {
            return;
        };
        let variables = self.scopes.iter().rev().flat_map(|scope| scope.iter().rev());
        let Some(whole) = variables
            .filter(|variable| variable.name == name)
            .map(|variable| variable.ty)
            .next()
        else {
            return;
        };
        if !whole.is_float() {
            return;
        }
        let other = if self.choices.chance(128) { FLOAT } else { ty };
        let value = self.storable(other);
        let op = self.choices.pick(&["+=", "-="]);
        let back = self.tamed(whole, Expr::primary(name.as_str(), Range::new(1e5, 8)));
        self.line(&format!("{} {op} {};", place.text, value.at(Level::Assignment)));
        self.line(&format!("{name} = {};", back.text));
    }

    fn branch(&mut self) {
        let condition = self.expr(BOOL);
        self.block(&format!("if ({}) ", condition.text), "", false);
        while self.choices.chance(60) {
            self.operands = 0;
            let condition = self.expr(BOOL);
            self.block(&format!("else if ({}) ", condition.text), "", false);
        }
        if self.choices.chance(100) {
            self.block("else ", "", false);
        }
    }

    /// Generates statements that run `count` times as often.
    fn times(&mut self, count: u32, work: impl FnOnce(&mut Self)) {
        let (runs, around) = (self.runs, self.around);
        self.runs = runs * count;
        self.work = self.work.max(self.runs);
        self.around = Around {
            in_loop: true,
            in_switch: false,
        };
        work(self);
        (self.runs, self.around) = (runs, around);
    }

    /// A counting `for`; the body shares the scope of its header.
    fn counted(&mut self) {
        let count = 1 + self.choices.below(4) as u32;
        if self.runs * (count + 1) > MAX_WORK {
            return;
        }
        self.scopes.push(Vec::new());
        let name = self.name();
        let form = self.choices.below(7);
        self.variable(
            name.clone(),
            match form {
                3 => UINT,
                4 => FLOAT,
                _ => INT,
            },
            false,
        );
        let more = if self.choices.chance(60) {
            let condition = self.expr(BOOL);
            format!(" && {}", condition.at(Level::Equality))
        } else {
            String::new()
        };
        let head = match form {
            0 | 1 => format!("for (int {name} = 0; {name} < {count}{more}; {name}++) "),
            2 => format!("LOOP({name}, {count}) "),
            3 => format!("for (uint {name} = {count}u; {name} > 0u{more}; {name} -= 1u) "),
            4 => format!("for (float {name} = 0.; {name} < {count}.{more}; ++{name}) "),
            5 => {
                let step = self.changed(INT).at(Level::Assignment);
                format!("for (int {name} = 0, {name}_ = {count}; {name} < {name}_; {name}++, {step}) ")
            }
            _ => format!("for (int {name} = {count}; {name}-- > 0;) "),
        };
        self.times(count + 1, |this| this.block(&head, "", true));
        self.scopes.pop();
    }

    /// `while`, `do` and a `for` without a condition, each with its own counter. Some end after statements, and
    /// earlier for some pixels than for others.
    fn repeated(&mut self) {
        let count = 1 + self.choices.below(4) as u32;
        if self.runs * (count + 1) > MAX_WORK {
            return;
        }
        self.line("{");
        self.indent += 1;
        self.scopes.push(Vec::new());
        let name = self.name();
        self.line(&format!("int {name} = {count};"));
        self.variable(name.clone(), INT, false);
        let condition = self.expr(BOOL);
        self.times(count + 1, |this| match this.choices.below(6) {
            0 => {
                let more = condition.at(Level::Equality);
                this.block(&format!("while ({name}-- > 0 && {more}) "), "", false);
            }
            1 => this.block("do ", &format!(" while (--{name} > 0);"), false),
            2 => {
                this.scopes.push(Vec::new());
                this.variable("more".into(), BOOL, true);
                this.block(&format!("while (bool more = {name}-- > 0) "), "", true);
                this.scopes.pop();
            }
            3 => {
                let more = condition.at(Level::Equality);
                this.block("do ", &format!(" while (--{name} > 0 && {more});"), false);
            }
            form => {
                this.line("for (;;) {");
                this.indent += 1;
                this.scopes.push(Vec::new());
                let exit = format!("if ({name}-- <= 0) break;");
                if form == 4 {
                    this.line(&exit);
                    this.statements(4);
                } else {
                    // A `continue` would skip the exit.
                    this.around = Around {
                        in_loop: false,
                        in_switch: true,
                    };
                    this.block("", "", false);
                    this.line(&format!("if ({}) break;", condition.text));
                    this.line(&exit);
                }
                this.scopes.pop();
                this.indent -= 1;
                this.line("}");
            }
        });
        self.scopes.pop();
        self.indent -= 1;
        self.line("}");
    }

    fn switch(&mut self) {
        let unsigned = self.choices.chance(100);
        let (ty, suffix) = if unsigned { (UINT, "u") } else { (INT, "") };
        let selector = self.expr(ty);
        self.line(&format!("switch ({} & 3{suffix}) {{", selector.at(Level::And)));
        let around = self.around;
        self.around.in_switch = true;
        let cases = 1 + self.choices.below(4);
        let default = self.choices.below(5);
        for case in 0..cases {
            self.line(&format!("case {case}{suffix}:"));
            if case == default {
                self.line("default:");
            }
            self.block("", "", false);
            if !self.choices.chance(90) {
                self.line("break;");
            }
        }
        if default == 4 {
            self.line("default:");
            self.block("", "", false);
        }
        self.around = around;
        self.line("}");
    }

    fn jump(&mut self) {
        let mut jumps = Vec::new();
        if self.around.in_loop {
            jumps.push("continue".to_owned());
        }
        if self.around.in_loop || self.around.in_switch {
            jumps.push("break".to_owned());
        }
        match self.result.filter(|_| !self.in_main) {
            Some(ty) => {
                let value = self.storable(ty);
                jumps.push(format!("return {}", value.text));
            }
            None if !self.in_main => jumps.push("return".to_owned()),
            None if self.choices.chance(30) => jumps.push("discard".to_owned()),
            None => {}
        }
        if jumps.is_empty() {
            return;
        }
        let index = self.choices.below(jumps.len());
        let condition = self.expr(BOOL);
        self.line(&format!("if ({}) {};", condition.text, jumps[index]));
    }
}

/// Declares an array in either syntax.
fn declarator(ty: Type, name: &str) -> String {
    match ty.length {
        Some(_) if name.len().is_multiple_of(2) => format!("{} {name}", ty.name()),
        _ => format!("{} {name}{}", ty.base.name(), dimension(ty)),
    }
}

/// Returns whether a text contains a name.
fn names(text: &str, name: &str) -> bool {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .any(|word| word == name)
}
