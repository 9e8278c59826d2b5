//! Generates candidates: the edits that undo common mistakes, at every place of a shader.

mod donor;
mod expression;
mod insertion;
mod name;
mod number;
mod plausibility;
mod statement;
mod structure;
mod transformation;
mod writer;

pub(super) use self::donor::{Donor, assignment_candidates, candidates as donor_candidates, donors};
pub(super) use self::number::Constants;
pub(super) use self::structure::{TextEdit, edits as structural_edits};
use self::writer::Writer;
use super::edit::Candidate;
use super::shader::Shader;

/// The candidates for the sites and statements of a shader in that order, the most suspicious first.
pub(super) fn candidates(
    shader: &Shader,
    constants: &Constants,
    sites: &[usize],
    statements: &[usize],
) -> Vec<Candidate> {
    let mut writer = Writer::new(shader, constants);
    for &site in sites {
        if writer.all.len() >= MAX_CANDIDATES {
            break;
        }
        writer.site(site);
    }
    let of_sites = writer.all.len();
    for &statement in statements {
        if writer.all.len() >= of_sites + MAX_CANDIDATES {
            break;
        }
        writer.statement(statement);
    }
    plausibility::adjust(shader, constants, &mut writer.all);
    writer.all.into_iter().flat_map(Candidate::by_cost).collect()
}

/// The largest number of candidates for sites, and for statements: a shader may be large.
const MAX_CANDIDATES: usize = 40_000;
