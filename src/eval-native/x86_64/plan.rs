//! Planning: which steps are lifted into regions, and which change the control flow of a whole batch.

use toyproof_eval::native::{Location, LoweredCode, Operation, Predicate, Step, Target, ValueDef};

/// How a step is executed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    /// Not at all.
    Nothing,
    /// Executed in a region.
    Vector,
    /// Executed on scalars, before the region around the step.
    Scalar,
    /// Executed by the step's handler, before the region around the step.
    ScalarCall,
    /// Executed on scalars, in its place, since the step changes a variable.
    ScalarStore,
    /// Executed by the step's handler, in its place.
    Call,
    /// Executed at the end of a region: where the mask is empty for the whole batch, control jumps.
    Branch,
    /// Executed by jumps and counters.
    Control,
}

impl Class {
    /// Whether a step of this class ends a region.
    pub(super) fn is_barrier(self) -> bool {
        matches!(
            self,
            Self::ScalarStore | Self::Call | Self::Branch | Self::Control
        )
    }
}

/// The plan of a program.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) classes: Vec<Class>,
    /// The end of the guard that follows a step in a region.
    pub(super) guards: Vec<Option<Target>>,
    /// Whether control jumps to a step.
    pub(super) targets: Vec<bool>,
}

/// The largest number of guards within each other.
const MAX_HEIGHT: u32 = 16;

/// A jump whose target lies ahead.
struct OpenJump {
    at: usize,
    target: usize,
    /// Whether a step on the way ends a region.
    is_split: bool,
    /// The number of guards within each other on the way.
    height: u32,
}

/// Plans a program; none if it records traces.
pub(super) fn plan(lowered: &LoweredCode) -> Option<Plan> {
    let steps = &lowered.linear.steps;
    let mut plan = Plan {
        classes: vec![Class::Nothing; steps.len()],
        guards: vec![None; steps.len()],
        targets: vec![false; steps.len() + 1],
    };
    for &(first, _) in &lowered.linear.loops {
        plan.targets[first as usize] = true;
    }
    // Values that are computed in the location of the variable that they are stored to.
    let mut stored = vec![false; lowered.function.defs.len()];
    for ((step, _), &is_elided) in steps.iter().zip(&lowered.locations.elided) {
        if let Step::Store { value, .. } = *step {
            stored[value.0 as usize] |= is_elided;
        }
    }
    let mut open: Vec<OpenJump> = Vec::new();
    for at in 0..=steps.len() {
        while let Some(last) = open.pop_if(|last| last.target <= at) {
            plan.close(&last, open.last_mut(), lowered);
        }
        let Some((step, _)) = steps.get(at) else { break };
        if lowered.locations.elided[at] {
            continue;
        }
        let class = classify(step, &stored, lowered)?;
        plan.classes[at] = class;
        match *step {
            Step::Split { if_empty, .. } | Step::Remove { if_empty, .. } | Step::JumpIfEmpty(if_empty) => {
                let target = if_empty as usize;
                if open.last().is_some_and(|last| last.target < target) {
                    return None;
                }
                open.push(OpenJump {
                    at,
                    target,
                    is_split: false,
                    height: 0,
                });
            }
            Step::Jump(to) | Step::JumpIf { to, .. } => plan.targets[to as usize] = true,
            _ => {}
        }
        if class.is_barrier()
            && let Some(last) = open.last_mut()
        {
            last.is_split = true;
        }
    }
    plan.is_consistent().then_some(plan)
}

impl Plan {
    /// Decides on a jump, all of whose way is planned.
    fn close(&mut self, jump: &OpenJump, around: Option<&mut OpenJump>, lowered: &LoweredCode) {
        let is_split_step = matches!(lowered.linear.steps[jump.at].0, Step::Split { .. });
        let too_high = jump.height >= MAX_HEIGHT;
        let is_branch = jump.is_split || (too_high && is_split_step);
        if is_branch {
            self.classes[jump.at] = Class::Branch;
            self.targets[jump.target] = true;
        } else if !too_high && jump.target > jump.at + 1 {
            self.guards[jump.at] = Some(jump.target as Target);
        }
        if let Some(around) = around {
            around.is_split |= is_branch;
            let own = u32::from(self.guards[jump.at].is_some());
            around.height = around.height.max(jump.height.min(MAX_HEIGHT - 1) + own);
        }
    }

    /// Whether no jump leads into a guard.
    fn is_consistent(&self) -> bool {
        let mut before = vec![0; self.targets.len() + 1];
        for (at, &target) in self.targets.iter().enumerate() {
            before[at + 1] = before[at] + u32::from(target);
        }
        let mut guards = self.guards.iter().enumerate();
        guards.all(|(at, until)| until.is_none_or(|until| before[at + 1] == before[until as usize]))
    }
}

/// Returns how a step is executed, if no jump over it is split; none if there is no way.
fn classify(step: &Step, stored: &[bool], lowered: &LoweredCode) -> Option<Class> {
    let (function, locations) = (&lowered.function, &lowered.locations);
    Some(match *step {
        Step::Compute(value) => {
            let is_row = matches!(locations.value(value), Some(Location::Row(_)));
            let is_scalar = matches!(locations.value(value), Some(Location::Scalar(_)));
            // A variable must keep its value until the region before has read it.
            let changes_variable = is_scalar && stored[value.0 as usize];
            match function.def(value) {
                // A scalar has no neighbors in its vector.
                ValueDef::Operation(Operation::DFdx | Operation::DFdy, _) if changes_variable => Class::Call,
                ValueDef::Operation(Operation::DFdx | Operation::DFdy, _) if is_scalar => Class::ScalarCall,
                ValueDef::Operation(operation, _) if changes_variable && has_vector_form(operation) => {
                    Class::ScalarStore
                }
                _ if changes_variable => Class::Call,
                ValueDef::Operation(operation, _) if is_row && has_vector_form(operation) => Class::Vector,
                ValueDef::Operation(operation, _) if is_scalar && has_vector_form(operation) => Class::Scalar,
                ValueDef::Load(_) if is_row => Class::Vector,
                ValueDef::Load(_) if is_scalar => Class::Scalar,
                _ if is_scalar => Class::ScalarCall,
                _ => Class::Call,
            }
        }
        Step::Store { cell, .. } => match locations.cell(cell) {
            Some(Location::Row(_)) => Class::Vector,
            Some(Location::Scalar(_)) => Class::ScalarStore,
            None => Class::Call,
        },
        Step::Check {
            predicate: Predicate::PartialQuad,
            ..
        }
        | Step::StoreAt { .. } => Class::Call,
        Step::Check { .. }
        | Step::Split { .. }
        | Step::Copy { .. }
        | Step::Remove { .. }
        | Step::JumpIfEmpty(_) => Class::Vector,
        Step::Jump(_) | Step::JumpIf { .. } | Step::Iterate(_) => Class::Control,
        Step::Trace { .. } | Step::Count(_) => return None,
    })
}

/// Whether an operation has a form on vector registers.
fn has_vector_form(operation: Operation) -> bool {
    use Operation as O;
    !matches!(
        operation,
        O::Sin
            | O::Cos
            | O::Tan
            | O::Asin
            | O::Acos
            | O::Atan
            | O::Atan2
            | O::Sinh
            | O::Cosh
            | O::Tanh
            | O::Asinh
            | O::Acosh
            | O::Atanh
            | O::Exp
            | O::Exp2
            | O::Log
            | O::Log2
            | O::Pow
            | O::PackHalf
            | O::UnpackLow
            | O::UnpackHigh
            | O::DivInt
            | O::DivUint
            | O::RemInt
            | O::RemUint
    )
}
