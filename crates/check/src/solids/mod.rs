//! Boolean solids along a line, exactly: the reference of drawn solids.
//!
//! ```text
//!   A      ────┤▒▒▒▒▒▒▒▒▒▒▒▒├──────          each primitive: where the line crosses it
//!   B      ──────────┤▒▒▒▒▒▒├──────          all crossings in order, equal parameters as one group
//!   A - B  ────┤▒▒▒▒▒├─────────────          the tree before and after each group: a face where they differ
//! ```
//!
//! Faces on one carrier share its crossings bit for bit (see [`SurfaceTable`]), so coincident faces fall
//! into one group whatever the direction. Crossings of meshes and spline parts that lie nearer than
//! [`FALLBACK`] to the group before join it.
//!
//! A line that lies in a face is outside on the side where that face's value is 0. The owner of a face of the solid is
//! the first active primitive in its group: one that by itself changes the solid, before or after the rest. A
//! primitive with a leaf that adds it comes before one that is only subtracted; of two alike, the earlier one in the tree
//! comes first.

mod layers;
mod roots;
mod shell;
#[cfg(test)]
mod tests;

pub use layers::{Layer, LayerTracer};

use crate::csg::{Tree, TreeError};
use crate::model::{Bounds, Primitive, Solid, SurfaceTable};
use glam::DVec3;
use roots::Roots;
use shell::Shell;
use std::collections::HashMap;

/// Crossings this near, relative to the solid's size over the direction's length, are one where no surface table makes
/// them equal: a few roundings of a hit of the exact reference.
pub const FALLBACK: f64 = 1e-13;

/// A face of a solid, met by a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundary {
    /// Parameter along the line, in lengths of its direction.
    pub t: f64,
    /// From outside to inside.
    pub entering: bool,
    /// Index of the primitive that owns the face.
    pub primitive: u32,
    /// Its [`Primitive::id`].
    pub id: u32,
    /// Index of its surface in the [`SurfaceTable`], one for all faces that coincide; `None` on spline parts, and on
    /// meshes of parts.
    pub surface: Option<u32>,
    /// The point.
    pub point: DVec3,
    /// Unit normal, out of the solid; zero where the surface has none.
    pub normal: DVec3,
}

/// A line's way through a solid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// The line comes from inside an unbounded solid.
    pub inside_before: bool,
    /// All faces, in order of `t` from minus to plus infinity, entering and leaving in turn.
    pub boundaries: Vec<Boundary>,
    /// Meshes and parts that the line entered and never left, or the reverse: they are not closed.
    pub leaks: u32,
}

impl Trace {
    /// Whether the point at `t` is inside; on a face, as just behind it.
    pub fn inside(&self, t: f64) -> bool {
        let passed = self.boundaries.partition_point(|b| b.t <= t);
        self.inside_before != (passed % 2 == 1)
    }

    /// The first face entered at `start` or behind it.
    pub fn first(&self, start: f64) -> Option<Boundary> {
        self.boundaries.iter().find(|b| b.entering && b.t >= start).copied()
    }

    /// Parameter length inside the solid between `start` and `end`.
    pub fn thickness(&self, start: f64, end: f64) -> f64 {
        let stops = self.boundaries.iter().map(|b| b.t.clamp(start, end));
        let mut inside = self.inside_before;
        let (mut sum, mut before) = (0.0, start);
        for stop in stops.chain([end]) {
            if inside {
                sum += stop - before;
            }
            (inside, before) = (!inside, stop);
        }
        sum
    }
}

/// Which of a primitive's faces was crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Owner {
    Carrier(u32),
    Triangle(u32),
    Normal(DVec3),
}

/// A primitive's state changes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Crossing {
    t: f64,
    primitive: u32,
    owner: Owner,
}

/// A solid made ready for lines.
#[derive(Debug)]
pub struct SolidTracer {
    primitives: Vec<Primitive>,
    tree: Tree,
    table: SurfaceTable,
    shells: Vec<Option<Shell>>,
    /// For each primitive: whether it is subtracted everywhere, and its first leaf. The least owns a group.
    ranks: Vec<(bool, usize)>,
    /// Of the bounded primitives.
    bounds: Bounds,
    /// Its diagonal.
    size: f64,
    /// A ball around each primitive: a line that misses it crosses nothing.
    balls: Vec<(DVec3, f64)>,
}

/// Balls are larger than their primitives by this, relative to centre and radius: above the rounding of a
/// line's distance.
const BALL: f64 = 1e-9;

impl SolidTracer {
    /// Prepares a solid; `tolerance` is that of [`SurfaceTable::new`].
    ///
    /// # Errors
    /// [`TreeError`] when the positive form is too large.
    pub fn new(solid: &Solid, tolerance: f64) -> Result<Self, TreeError> {
        let primitives = solid.primitives().to_vec();
        let mut ranks = vec![(true, usize::MAX); primitives.len()];
        let list = crate::csg::Blist::new(solid.tree())?;
        for (place, entry) in list.entries().iter().enumerate() {
            let rank = &mut ranks[entry.primitive() as usize];
            *rank = (rank.0 && entry.negative(), rank.1.min(place));
        }
        let boxes = primitives.iter().map(Primitive::bounds).filter(|b| b.diagonal().is_finite());
        let bounds = boxes.filter(|b| !b.is_empty()).fold(Bounds::EMPTY, Bounds::union);
        let ball = |p: &Primitive| {
            let b = p.bounds();
            let radius = 0.5 * b.diagonal() * (1.0 + BALL) + BALL * b.centre().length();
            if radius.is_finite() { (b.centre(), radius) } else { (DVec3::ZERO, f64::INFINITY) }
        };
        Ok(Self {
            balls: primitives.iter().map(ball).collect(),
            table: SurfaceTable::new(solid, tolerance),
            shells: primitives.iter().map(Shell::new).collect(),
            tree: solid.tree().clone(),
            primitives,
            ranks,
            size: bounds.diagonal(),
            bounds,
        })
    }

    /// The primitives, by index.
    pub fn primitives(&self) -> &[Primitive] {
        &self.primitives
    }

    /// A box around the bounded primitives.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// All faces along the line `origin + t direction`. Linear in the primitives; a direction of length 0 or
    /// one that is not finite meets nothing.
    pub fn trace(&self, origin: DVec3, direction: DVec3) -> Trace {
        let speed = direction.length();
        if !(speed > 0.0 && speed.is_finite() && origin.is_finite()) {
            return Trace::default();
        }
        let (crossings, state, leaks) = self.sorted_crossings(origin, direction);
        Trace { leaks, ..self.through(&self.tree, 0, &crossings, state, (origin, direction)) }
    }

    /// The way through one tree, whose leaves name primitives from `first` on.
    fn through(
        &self,
        tree: &Tree,
        first: u32,
        crossings: &[Crossing],
        mut state: Vec<bool>,
        (origin, direction): (DVec3, DVec3),
    ) -> Trace {
        let speed = direction.length();
        // a primitive that the line does not cross keeps its state: a smaller tree
        let mut crossed = vec![false; state.len()];
        crossings.iter().for_each(|c| crossed[c.primitive as usize] = true);
        let at = |p: u32| (first + p) as usize;
        let tree = tree.fold(|p| (!crossed[at(p)]).then(|| state[at(p)]));
        let mut inside = tree.contains(|p| state[at(p)]);
        let mut trace = Trace { inside_before: inside, ..Trace::default() };
        let same = FALLBACK * self.size / speed;
        let mut rest = crossings;
        while let Some(nearest) = rest.first() {
            let count = rest.iter().take_while(|c| self.one_place(nearest, c, same)).count();
            let (group, behind) = rest.split_at(count);
            rest = behind;
            let before = state.clone();
            group.iter().for_each(|c| state[c.primitive as usize] ^= true);
            let after = tree.contains(|p| state[at(p)]);
            if after != inside {
                let owner = self.owner((&tree, first), group, &before, &state, inside);
                trace.boundaries.push(self.boundary(&owner, origin, direction, after));
                inside = after;
            }
        }
        trace
    }

    fn one_place(&self, first: &Crossing, c: &Crossing, same: f64) -> bool {
        let exact = |c: &Crossing| self.shells[c.primitive as usize].is_none();
        c.t == first.t || !(exact(first) && exact(c)) && c.t - first.t <= same
    }

    /// As [`Self::crossings`], in order.
    fn sorted_crossings(&self, origin: DVec3, direction: DVec3) -> (Vec<Crossing>, Vec<bool>, u32) {
        let (mut crossings, state, leaks) = self.crossings(origin, direction);
        crossings.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.primitive.cmp(&b.primitive)));
        (crossings, state, leaks)
    }

    /// Crossings of all primitives, their state before the first, and leaks.
    fn crossings(&self, o: DVec3, d: DVec3) -> (Vec<Crossing>, Vec<bool>, u32) {
        let mut found: HashMap<u32, Roots> = HashMap::new();
        let mut crossings = Vec::new();
        let mut state = vec![false; self.primitives.len()];
        let mut leaks = 0;
        let roots = |surface: u32| {
            let s = &self.table.surfaces()[surface as usize];
            Roots::new(&s.carrier, s.to_own.transform_point3(o), s.to_own.transform_vector3(d))
        };
        for (p, shell) in (0..).zip(&self.shells) {
            if let Some(shell) = shell {
                let mut plane = |s: u32| found.entry(s).or_insert_with(|| roots(s)).at.first().copied();
                leaks += u32::from(!shell.cross(p, &self.table, &mut plane, (o, d), &mut crossings));
                continue;
            }
            let faces = self.table.faces(p);
            let (centre, radius) = self.balls[p as usize];
            let foot = (centre - o).dot(d) / d.length_squared();
            let past = (o + d * foot).distance(centre) > radius + BALL * (centre - o).length();
            if faces.is_empty() || past {
                continue;
            }
            // the intersection of the insides of all faces
            let mut events: Vec<(f64, u32)> = Vec::new();
            let mut within: Vec<bool> = Vec::new();
            for (k, face) in (0..).zip(faces) {
                let roots = found.entry(face.surface).or_insert_with(|| roots(face.surface));
                within.push(roots.inside_before != face.flipped);
                events.extend(roots.at.iter().map(|t| (*t, k)));
            }
            events.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut inside = within.iter().all(|w| *w);
            state[p as usize] = inside;
            for group in events.chunk_by(|a, b| a.0 == b.0) {
                group.iter().for_each(|(_, k)| within[*k as usize] ^= true);
                let now = within.iter().all(|w| *w);
                if now != inside {
                    // a face that has just turned the way the primitive has
                    let owner = group.iter().find(|(_, k)| within[*k as usize] == now).unwrap_or(&group[0]);
                    crossings.push(Crossing { t: group[0].0, primitive: p, owner: Owner::Carrier(owner.1) });
                    inside = now;
                }
            }
        }
        (crossings, state, leaks)
    }

    /// The crossing of `group` that owns the face; see the module.
    fn owner(
        &self,
        (tree, first): (&Tree, u32),
        group: &[Crossing],
        before: &[bool],
        after: &[bool],
        inside: bool,
    ) -> Crossing {
        let rank = |c: &Crossing| self.ranks[c.primitive as usize];
        let active = |c: &Crossing| {
            let alone = |state: &[bool]| tree.contains(|p| state[(first + p) as usize] != (first + p == c.primitive));
            alone(before) != inside || alone(after) == inside
        };
        let toggled = |c: &&Crossing| before[c.primitive as usize] != after[c.primitive as usize];
        let least = |all: &mut dyn Iterator<Item = &Crossing>| all.min_by_key(|c| rank(c)).copied();
        least(&mut group.iter().filter(toggled).filter(|c| active(c)))
            .or_else(|| least(&mut group.iter().filter(toggled)))
            .unwrap_or(group[0])
    }

    fn boundary(&self, c: &Crossing, o: DVec3, d: DVec3, entering: bool) -> Boundary {
        let point = o + d * c.t;
        let face = |k: u32| self.table.faces(c.primitive).get(k as usize);
        let surface = match c.owner {
            Owner::Carrier(k) | Owner::Triangle(k) => face(k).map(|face| face.surface),
            Owner::Normal(_) => None,
        };
        let gradient = match (c.owner, surface) {
            (Owner::Normal(normal), _) => normal,
            (_, None) => DVec3::ZERO,
            (_, Some(surface)) => {
                let s = &self.table.surfaces()[surface as usize];
                let own = s.to_own.transform_point3(o) + s.to_own.transform_vector3(d) * c.t;
                s.to_own.matrix3.transpose() * s.carrier.gradient(own)
            }
        };
        let normal = gradient.normalize_or_zero();
        let outward = (normal.dot(d) < 0.0) == entering;
        Boundary {
            t: c.t,
            entering,
            primitive: c.primitive,
            id: self.primitives[c.primitive as usize].id,
            surface,
            point,
            normal: if outward { normal } else { -normal },
        }
    }
}
