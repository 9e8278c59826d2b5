//! What is said of a call that no overload takes.

use toyproof_diagnostic::Diagnostic;

use super::{Checker, liberal_conversion, signature};
use crate::codes::Code;
use crate::tree::{BuiltIn, ExprId, FunctionId, Place, Type};

/// How many overloads are listed.
const MAX_LISTED: usize = 6;

impl Checker<'_> {
    /// Tells that none of an author's overloads takes the arguments.
    pub(super) fn no_overload(
        &mut self,
        overloads: &[FunctionId],
        arguments: &[ExprId],
        name_at: Place,
        at: Place,
    ) -> ExprId {
        let name = self.tree[overloads[0]].name.clone();
        let types = self.types(arguments);
        let all: Vec<Vec<Type>> = overloads
            .iter()
            .map(|&function| {
                let parameters = self.tree[function].parameters.iter();
                parameters.map(|&parameter| self.tree[parameter].ty).collect()
            })
            .collect();
        let fitting = all
            .iter()
            .zip(overloads)
            .filter(|(wanted, _)| wanted.len() == types.len());
        let closest = fitting.min_by_key(|(wanted, _)| cost(&types, wanted));
        let declared = self.tree[*closest.map_or(&overloads[0], |(_, function)| function)].at;
        let counts: Vec<_> = all.iter().map(Vec::len).collect();
        let closest = closest.map(|(wanted, _)| wanted.as_slice());
        let mut diagnostic = self.misfit(&name, arguments, closest, &counts, name_at);
        if overloads.len() == 1 {
            diagnostic = diagnostic.related(
                declared.span,
                format!("`{}` is declared here", self.form(&name, &all[0])),
            );
        } else {
            let forms: Vec<_> = all
                .iter()
                .take(MAX_LISTED)
                .map(|wanted| format!("`{}`", self.form(&name, wanted)))
                .collect();
            diagnostic = diagnostic.note(format!("there are {}", forms.join(", ")));
        }
        self.refuse_with(diagnostic, at)
    }

    /// Tells that no form of a built-in function takes the arguments.
    pub(super) fn no_signature(
        &mut self,
        function: BuiltIn,
        arguments: &[ExprId],
        name_at: Place,
        at: Place,
    ) -> ExprId {
        let types = self.types(arguments);
        let candidates = signature::candidates(function, &types);
        let closest = candidates.iter().min_by_key(|wanted| cost(&types, wanted));
        let counts = signature::counts(function);
        let diagnostic = self.misfit(
            function.name(),
            arguments,
            closest.map(Vec::as_slice),
            &counts,
            name_at,
        );
        self.refuse_with(diagnostic, at)
    }

    /// What does not fit: the number of arguments, or those that differ from the closest overload's parameters.
    fn misfit(
        &self,
        name: &str,
        arguments: &[ExprId],
        closest: Option<&[Type]>,
        counts: &[usize],
        name_at: Place,
    ) -> Diagnostic {
        let types = self.types(arguments);
        let given = self.form(name, &types);
        let Some(wanted) = closest else {
            if counts.contains(&types.len()) {
                return Code::NoOverload.at(name_at, format!("no function `{given}`"));
            }
            let message = format!(
                "`{name}` takes {} and is given {}",
                plural(&listed(counts), "argument"),
                types.len()
            );
            return Code::NoOverload.at(name_at, message);
        };
        let message = format!(
            "no function `{given}`; did you mean `{}`?",
            self.form(name, wanted)
        );
        let misfits = arguments
            .iter()
            .zip(wanted)
            .filter(|&(&argument, &wanted)| self.ty(argument) != wanted);
        misfits.fold(
            Code::NoOverload.at(name_at, message),
            |diagnostic, (&argument, &wanted)| self.related_mend(diagnostic, argument, wanted),
        )
    }

    /// `name(type, type)`.
    fn form(&self, name: &str, types: &[Type]) -> String {
        let types: Vec<_> = types.iter().map(|&ty| self.tree.type_name(ty)).collect();
        format!("{name}({})", types.join(", "))
    }
}

/// How far arguments are from parameters of the same number: a conversion is closer than another type.
fn cost(given: &[Type], wanted: &[Type]) -> usize {
    let one = |(&given, &wanted): (&Type, &Type)| match () {
        () if given == wanted => 0,
        () if liberal_conversion(given, wanted) => 1,
        () if liberal_conversion(wanted, given) => 2,
        () => 4,
    };
    given.iter().zip(wanted).map(one).sum()
}

/// `1`, `1 or 2`, `1, 2 or 4`.
fn listed(counts: &[usize]) -> String {
    let mut counts = counts.to_vec();
    counts.sort_unstable();
    counts.dedup();
    let words: Vec<_> = counts.iter().map(usize::to_string).collect();
    match &words[..] {
        [head @ .., last] if !head.is_empty() => format!("{} or {last}", head.join(", ")),
        words => words.concat(),
    }
}

fn plural(count: &str, noun: &str) -> String {
    match count {
        "1" => format!("1 {noun}"),
        "0" => format!("no {noun}s"),
        _ => format!("{count} {noun}s"),
    }
}
