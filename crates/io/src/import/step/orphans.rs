//! Entities of a damaged file that no list names any more.
//!
//! ```text
//!   representation ──▶ solid ──▶ shell ──▶ face        a file cut off after its faces has lost
//!        ✗               ✗         ✗        ●          everything that names them
//! ```
//!
//! Solids and surface models are drawn whether or not a representation lists them, unless a Boolean expression names
//! them. A shell is drawn by itself when nothing holds it, a face when no shell holds it, an expression or a primitive
//! when no expression holds it. Such orphans occur only in files that were cut short.

use super::body::{FACES, MODELS, SETS, SHELLS, SOLIDS};
use super::csg::EXPRESSIONS;
use super::entity::Entity;
use super::part21::File;
use super::primitive::{BOUNDED, PRIMITIVES};
use super::swept::SWEPT;
use std::collections::BTreeSet;

/// Entities that nothing names, in file order.
#[derive(Debug, Default)]
pub(super) struct Orphans {
    /// Solids, surface models and Boolean expressions.
    pub bodies: Vec<u32>,
    /// Shells.
    pub shells: Vec<u32>,
    /// Faces.
    pub faces: Vec<u32>,
}

impl Orphans {
    /// Everything drawable that neither stands in `listed` nor is part of another entity.
    pub fn find(file: &File<'_>, listed: &BTreeSet<u32>) -> Self {
        let shape = |kind: &str| {
            let named = [&SOLIDS[..], &MODELS[..], &SETS[..], &SHELLS[..], &FACES[2..], &SWEPT[..]];
            // solids of unsupported kinds hold their profiles all the same
            kind.ends_with("REPRESENTATION")
                || kind.ends_with("_SOLID")
                || named.iter().any(|names| names.contains(&kind))
        };
        let holding = held(file, shape);
        let operands = held(file, |kind| EXPRESSIONS.contains(&kind));
        let of = |kinds: &[&str]| {
            let all: BTreeSet<u32> = kinds.iter().flat_map(|k| file.of_kind(k)).collect();
            all.difference(listed).copied().collect::<Vec<u32>>()
        };
        let free = |ids: Vec<u32>| ids.into_iter().filter(|id| !holding.contains(id)).collect();
        let mut bodies = of(&[&SOLIDS[..], &MODELS[..], &SWEPT[..], &EXPRESSIONS[..], &PRIMITIVES[..BOUNDED]].concat());
        bodies.retain(|id| !operands.contains(id));
        // vertex shells hold no face, and a sub-set repeats faces of its parent
        Self { bodies, shells: free(of(&SHELLS[..5])), faces: free(of(&FACES[..2])) }
    }
}

/// The entities that entities of these kinds name.
fn held(file: &File<'_>, holds: impl Fn(&str) -> bool) -> BTreeSet<u32> {
    let holders = file.kinds().filter(|k| holds(k)).flat_map(|kind| file.of_kind(kind));
    holders.filter_map(|id| Entity::find(file, id).ok()).flat_map(Entity::references).collect()
}
