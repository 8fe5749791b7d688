//! The walk through an assembly: one instance per path from a root to a body.
//!
//! The number of paths can be exponential in the size of the file, and a damaged file can contain
//! itself; both are cut off with a note.

use super::assembly::Assembly;
use super::body::Looks;
use super::geometry::Ledger;
use crate::import::guard::MAX_INSTANCES;
use crate::import::names;
use crate::model::Colour;
use glam::DAffine3;
use std::collections::HashSet;

/// One placed body.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    /// The body's number.
    pub body: u32,
    /// Body coordinates to model coordinates.
    pub transform: DAffine3,
    /// Its own colour, if the occurrence has one.
    pub colour: Option<Colour>,
    /// Names of the occurrences from the root, joined by `/`.
    pub name: String,
}

/// Largest number of groups visited: levels without a body of their own cost time but no instance.
const MAX_VISITS: usize = 8 * MAX_INSTANCES;

/// Deepest assembly.
const MAX_LEVELS: usize = 256;

impl Assembly {
    /// Every body once per path from a root, by the rule of `once`.
    pub fn walk(&self, looks: Looks<'_>, ledger: &Ledger<'_>) -> Vec<Placed> {
        let roots = self.roots();
        let mut walk = Walk {
            assembly: self,
            looks,
            ledger,
            trail: Vec::new(),
            placed: Vec::new(),
            visits: 0,
            visited: HashSet::new(),
            drawn: HashSet::new(),
            settled: HashSet::new(),
        };
        walk.from(&roots.products);
        walk.settled = walk.drawn.clone();
        walk.from(&roots.others);
        if walk.full() {
            let root = roots.products.first().or(roots.others.first()).copied().unwrap_or_default();
            ledger.note("occurrence left out", root, format!("all but the first {} instances", walk.placed.len()));
        }
        walk.placed
    }
}

struct Walk<'w> {
    assembly: &'w Assembly,
    looks: Looks<'w>,
    ledger: &'w Ledger<'w>,
    trail: Vec<u32>,
    placed: Vec<Placed>,
    visits: usize,
    /// Groups seen on any path.
    visited: HashSet<u32>,
    /// Bodies placed on any path.
    drawn: HashSet<u32>,
    /// Bodies among them that are not placed again.
    settled: HashSet<u32>,
}

impl Walk<'_> {
    /// Visits everything that earlier roots have not reached.
    fn from(&mut self, roots: &[u32]) {
        for root in roots {
            if !self.visited.contains(root) {
                self.visit(*root, DAffine3::IDENTITY, &mut Vec::new(), "");
            }
        }
    }

    fn full(&self) -> bool {
        self.placed.len() >= MAX_INSTANCES || self.visits >= MAX_VISITS
    }

    /// Counts a group that is nested too deep, and all below it, as seen: none of them is a root.
    fn pass_over(&mut self, id: u32) {
        let mut open = vec![id];
        while let Some(id) = open.pop() {
            if self.visited.insert(id) {
                let placements = self.assembly.groups.get(&id).into_iter().flat_map(|group| &group.placements);
                open.extend(placements.map(|placement| self.assembly.group(placement.child)));
            }
        }
    }

    fn visit(&mut self, id: u32, transform: DAffine3, path: &mut Vec<u32>, name: &str) {
        self.visits += 1;
        self.ledger.work(1);
        if self.trail.contains(&id) {
            self.ledger.note("occurrence left out", id, "the assembly contains itself");
            return;
        }
        if self.trail.len() >= MAX_LEVELS {
            self.ledger.note("occurrence left out", id, format!("it is nested deeper than {MAX_LEVELS} levels"));
            self.pass_over(id);
            return;
        }
        let Some(group) = self.assembly.groups.get(&id) else { return };
        self.trail.push(id);
        self.visited.insert(id);
        for &(body, listing) in &group.bodies {
            if self.full() {
                break;
            }
            if self.settled.contains(&body) || (self.trail.len() == 1 && self.drawn.contains(&body)) {
                self.ledger.ignore("further mentions of drawn bodies", 1);
                continue;
            }
            self.drawn.insert(body);
            if self.looks.presentation.hides_in(path, [body, listing]) {
                self.ledger.ignore("hidden occurrences", 1);
                continue;
            }
            let colour = self.looks.colours.of_path(path, [body, listing]);
            self.placed.push(Placed { body, transform, colour, name: name.to_owned() });
        }
        for placement in &group.placements {
            if self.full() {
                break;
            }
            let path_length = path.len();
            path.extend(&placement.ids);
            let name = names::path(name, &placement.name);
            self.visit(self.assembly.group(placement.child), transform * placement.transform, path, &name);
            path.truncate(path_length);
        }
        self.trail.pop();
    }
}
