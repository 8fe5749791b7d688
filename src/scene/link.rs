//! Links untrimmed faces' sides that coincide, so that both faces are drawn with the same vertices.
//!
//! ```text
//!    one to one                one to several: halves of it, and their halves
//!    ┌─────┐┌─────┐            ┌─────────┐┌──┐      a link's curve is cut at the ends of all its sides; each piece
//!    │     ││     │            │         │├──┤      belongs to one side, its *owner*; all sides along the piece
//!    │     ││     │            │         │├──┤      compute their vertices from the owner's control points
//!    └─────┘└─────┘            └─────────┘└──┘
//! ```
//!
//! Two sides coincide if their uploaded control points, weights included, are equal within a few roundings, in the same
//! or the reverse order. Corners of patches at borders are first made equal bit for bit, so every meeting point has one
//! number. A side that coincides with no other is halved by de Casteljau's algorithm, at most [`MOST_HALVINGS`] times,
//! and linked if every piece is the side of another patch. Several sides that coincide form one link. Sides with
//! different parametrisations or degrees are not linked, nor are sides that meet in parts other than halves.
//!
//! Cost: linear in the sides at borders.

use crate::abi::{BORDER_U0, BORDER_U1, BORDER_V0, BORDER_V1};
use crate::abi::{FACE_CLOSED_U, FACE_CLOSED_V, FACE_TRIMMED, Face, Link, Patch, Side};
use std::collections::HashMap;
use std::ops::Range;

/// Control points are equal if no coordinate differs by more than this share of the part's largest coordinate, and no
/// weight by more than this share of the largest weight: four roundings to single precision.
const SAME: f64 = 1.0 / (1 << 21) as f64;
/// Size of the grid's cells in which corners are looked up, in units of the distance at which corners are equal. It is
/// so large that most corners' neighbourhoods lie in one cell.
const CELL: f64 = 16.0;
/// A side has at most 4096 segments.
const MOST_HALVINGS: u32 = 12;
/// Most sides in one link: enough for a curve halved towards both ends, twice over.
const MOST_SIDES: usize = Link::MOST_SIDES as usize;

type Point = [f64; 4];

/// One side of a patch at a border: `u = 0`, `v = 0`, `u = 1`, `v = 1`.
#[derive(Clone, Debug)]
struct PatchSide {
    /// The patch's number times four, plus the side's.
    name: u32,
    /// Control points, from the lower parameter up.
    net: Vec<Point>,
    corners: (u32, u32),
}

/// The range of a side on its link's curve: from `start / 2^halvings`, `1 / 2^halvings` long.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    start: u32,
    halvings: u32,
    reversed: bool,
}

/// Sides that coincide over their whole length; the first is the owner.
struct Group {
    /// The sides, and whether each runs against the first.
    sides: Vec<(usize, bool)>,
    /// The group is a piece of another side.
    piece: bool,
    /// The pieces of its one side, if that is cut.
    pieces: Vec<(usize, Place)>,
}

/// Writes the links of the faces in `range` to `links[4 * patch + side]`; lengthens `links` if there are some. Makes
/// corners equal that are nearly equal. Returns whether every side of the untrimmed faces is linked, except for sides
/// that are points and seams within one face.
pub(super) fn link(
    faces: &[Face],
    range: Range<usize>,
    patches: &[Patch],
    points: &mut [[f32; 4]],
    links: &mut Vec<Link>,
) -> bool {
    let borders: Vec<Border> = borders(faces, range, patches).collect();
    let Some(mut corners) = Corners::new(&borders, patches, points) else { return true };
    // all corners are collected before any is welded, so the result does not depend on the order
    for border in &borders {
        corners.keep(border, &patches[border.patch], points);
    }
    for border in &borders {
        corners.weld(border, &patches[border.patch], points);
    }
    let sides: Vec<PatchSide> = borders
        .iter()
        .flat_map(|b| b.sides().filter_map(|side| b.side(side, &patches[b.patch], points, &corners)))
        .collect();
    let mut groups = Groups::new(&sides, &corners);
    groups.cut();
    for ring in groups.rings() {
        if links.len() < 4 * patches.len() {
            links.resize(4 * patches.len(), Link::default());
        }
        for (k, &(name, place, owner)) in ring.iter().enumerate() {
            let next = ring[(k + 1) % ring.len()].0;
            links[name as usize] = Link::new(next, (place.start, place.halvings), place.reversed, owner);
        }
    }
    sides.iter().all(|side| links.get(side.name as usize).is_some_and(Link::is_shared))
}

/// A patch that has open borders of its face.
struct Border {
    patch: usize,
    /// Bits of its open borders.
    open: u32,
}

/// The patches at open borders of untrimmed faces.
fn borders<'a>(faces: &'a [Face], range: Range<usize>, patches: &'a [Patch]) -> impl Iterator<Item = Border> + 'a {
    faces[range].iter().flat_map(move |face| {
        let first = face.first_patch as usize;
        let of_face = &patches[first..first + (face.count_u * face.count_v) as usize];
        let whole = face.flags & FACE_TRIMMED == 0 && of_face.iter().all(|p| p.side() == Side::Inside);
        let closed = |flag: u32, bits: u32| if face.flags & flag != 0 { bits } else { 0 };
        let closed = closed(FACE_CLOSED_U, BORDER_U0 | BORDER_U1) | closed(FACE_CLOSED_V, BORDER_V0 | BORDER_V1);
        let of_face = if whole { of_face } else { &[] };
        of_face.iter().enumerate().filter_map(move |(n, p)| {
            let open = p.borders() & !closed;
            (open != 0).then_some(Border { patch: first + n, open })
        })
    })
}

impl Border {
    /// Border bits in the order of sides.
    const BITS: [u32; 4] = [BORDER_U0, BORDER_V0, BORDER_U1, BORDER_V1];

    fn sides(&self) -> impl Iterator<Item = usize> {
        let open = self.open;
        (0..4).filter(move |side| open & Self::BITS[*side] != 0)
    }

    /// Indices of a side's control points.
    fn net(side: usize, patch: &Patch) -> impl Iterator<Item = usize> {
        let (n, k) = patch.degrees();
        let (from, step, degree) = [(0, n + 1, k), (0, 1, n), (n, n + 1, k), (k * (n + 1), 1, n)][side];
        (0..=degree).map(move |i| patch.first as usize + from + i * step)
    }

    /// Indices of the control points at the ends of its open sides.
    fn corners(&self, patch: &Patch) -> impl Iterator<Item = usize> {
        let ends = |side| {
            let mut net = Self::net(side, patch);
            [net.next(), net.last()]
        };
        self.sides().flat_map(ends).flatten()
    }

    /// The side; `None` if it is a point.
    fn side(&self, side: usize, patch: &Patch, points: &[[f32; 4]], corners: &Corners) -> Option<PatchSide> {
        let net: Vec<Point> = Self::net(side, patch).map(|at| points[at].map(f64::from)).collect();
        let at = |p: &Point| [p[0] / p[3], p[1] / p[3], p[2] / p[3]];
        let first = at(&net[0]);
        if net.iter().map(at).all(|p| (0..3).all(|k| (p[k] - first[k]).abs() <= corners.same)) {
            return None;
        }
        let ends = (corners.find(&net[0])?, corners.find(&net[net.len() - 1])?);
        (ends.0 != ends.1).then_some(PatchSide { name: (4 * self.patch + side) as u32, net, corners: ends })
    }
}

/// The distinct corners of patches at borders.
struct Corners {
    same: f64,
    same_weight: f64,
    /// The last corner added to each cell; each corner has the one added before it to the same cell.
    cells: HashMap<[i32; 3], u32>,
    all: Vec<(Point, Option<u32>)>,
}

impl Corners {
    /// `None` if there are no borders with finite points.
    fn new(borders: &[Border], patches: &[Patch], points: &[[f32; 4]]) -> Option<Self> {
        let nets = borders.iter().flat_map(|b| b.sides().flat_map(|side| Border::net(side, &patches[b.patch])));
        let (mut size, mut weight) = (0.0f32, 0.0f32);
        for p in nets.map(|at| points[at]) {
            size = p[..3].iter().fold(size, |m, x| m.max(x.abs()));
            weight = weight.max(p[3].abs());
        }
        let same = SAME * f64::from(size);
        (size > 0.0 && size.is_finite() && weight.is_finite()).then(|| Self {
            same,
            same_weight: SAME * f64::from(weight),
            cells: HashMap::new(),
            all: Vec::new(),
        })
    }

    fn same(&self, a: &Point, b: &Point) -> bool {
        let apart = |k: usize| (a[k] - b[k]).abs();
        (0..3).all(|k| apart(k) <= self.same) && apart(3) <= self.same_weight
    }

    fn cell(&self, x: f64) -> i32 {
        (x / (CELL * self.same)).floor() as i32
    }

    fn find(&self, p: &Point) -> Option<u32> {
        let range = |k: usize| self.cell(p[k] - self.same)..=self.cell(p[k] + self.same);
        for x in range(0) {
            for y in range(1) {
                for z in range(2) {
                    let mut at = self.cells.get(&[x, y, z]).copied();
                    while let Some(n) = at {
                        let (corner, next) = &self.all[n as usize];
                        if self.same(corner, p) {
                            return Some(n);
                        }
                        at = *next;
                    }
                }
            }
        }
        None
    }

    /// Adds a patch's corners at open borders, except those nearly equal to a corner that is present.
    fn keep(&mut self, border: &Border, patch: &Patch, points: &[[f32; 4]]) {
        for at in border.corners(patch) {
            let p = points[at].map(f64::from);
            if self.find(&p).is_none() {
                let cell = [p[0], p[1], p[2]].map(|x| self.cell(x));
                let next = self.cells.insert(cell, self.all.len() as u32);
                self.all.push((p, next));
            }
        }
    }

    /// Makes a patch's corners at open borders equal, bit for bit, to the corners that were added.
    fn weld(&self, border: &Border, patch: &Patch, points: &mut [[f32; 4]]) {
        for at in border.corners(patch) {
            if let Some(n) = self.find(&points[at].map(f64::from)) {
                points[at] = self.all[n as usize].0.map(|x| x as f32);
            }
        }
    }
}

/// Groups of coinciding sides, looked up by their corners.
struct Groups<'a> {
    sides: &'a [PatchSide],
    corners: &'a Corners,
    all: Vec<Group>,
    /// The last group between two corners, the lower one first; `before` has the group before each.
    between: HashMap<(u32, u32), usize>,
    before: Vec<Option<usize>>,
}

impl<'a> Groups<'a> {
    fn new(sides: &'a [PatchSide], corners: &'a Corners) -> Self {
        let mut groups =
            Self { sides, corners, all: Vec::new(), between: HashMap::with_capacity(sides.len()), before: Vec::new() };
        for (n, side) in sides.iter().enumerate() {
            match groups.find(&side.net, side.corners) {
                Some((group, reversed)) if groups.all[group].sides.len() < MOST_SIDES => {
                    groups.all[group].sides.push((n, reversed));
                }
                Some(_) => {}
                None => {
                    groups.before.push(groups.between.insert(ordered(side.corners), groups.all.len()));
                    groups.all.push(Group { sides: vec![(n, false)], piece: false, pieces: Vec::new() });
                }
            }
        }
        groups
    }

    /// The group whose first side has this net, and whether the net runs against that side.
    fn find(&self, net: &[Point], corners: (u32, u32)) -> Option<(usize, bool)> {
        let mut at = self.between.get(&ordered(corners)).copied();
        while let Some(group) = at {
            let first = &self.sides[self.all[group].sides[0].0];
            let reversed = first.corners.0 != corners.0;
            let same = |(n, p): (usize, &Point)| {
                let n = if reversed { net.len() - 1 - n } else { n };
                self.corners.same(p, &first.net[n])
            };
            if first.net.len() == net.len() && net.iter().enumerate().all(same) {
                return Some((group, reversed));
            }
            at = self.before[group];
        }
        None
    }

    /// Finds pieces for sides that coincide with no other.
    fn cut(&mut self) {
        for group in 0..self.all.len() {
            let alone = |g: &Group| g.sides.len() == 1 && !g.piece;
            if alone(&self.all[group])
                && let Some(pieces) = self.pieces(group)
            {
                pieces.iter().for_each(|(piece, _)| self.all[*piece].piece = true);
                self.all[group].pieces = pieces;
            }
        }
    }

    /// The groups that make up the group's one side.
    fn pieces(&self, group: usize) -> Option<Vec<(usize, Place)>> {
        let side = &self.sides[self.all[group].sides[0].0];
        let mut rest = vec![(side.net.clone(), side.corners, Place::default())];
        let mut pieces = Vec::new();
        let mut sides = 1;
        while let Some((net, ends, place)) = rest.pop() {
            let found = self.find(&net, ends).filter(|(found, _)| *found != group);
            if let Some((found, reversed)) = found {
                let piece = &self.all[found];
                sides += piece.sides.len();
                if piece.piece || !piece.pieces.is_empty() || sides > MOST_SIDES {
                    return None;
                }
                pieces.push((found, Place { reversed, ..place }));
                continue;
            }
            if place.halvings == MOST_HALVINGS {
                return None;
            }
            let [low, high] = halves(&net);
            let middle = self.corners.find(&high[0]).filter(|m| *m != ends.0 && *m != ends.1)?;
            let half = |n: u32| Place { start: 2 * place.start + n, halvings: place.halvings + 1, ..place };
            rest.push((low, (ends.0, middle), half(0)));
            rest.push((high, (middle, ends.1), half(1)));
        }
        Some(pieces)
    }

    /// The sides of each link: name, place, and whether it is the owner of its piece.
    fn rings(&self) -> impl Iterator<Item = Vec<(u32, Place, bool)>> {
        self.all.iter().filter(|g| !g.piece && g.sides.len() + g.pieces.len() > 1).map(|group| {
            let sides = |group: &Group, place: Place, owned: bool| {
                let side = |(n, (side, against)): (usize, &(usize, bool))| {
                    let place = Place { reversed: place.reversed != *against, ..place };
                    (self.sides[*side].name, place, owned && n == 0)
                };
                group.sides.iter().enumerate().map(side).collect::<Vec<_>>()
            };
            let mut ring = sides(group, Place::default(), group.pieces.is_empty());
            ring.extend(group.pieces.iter().flat_map(|(piece, place)| sides(&self.all[*piece], *place, true)));
            ring
        })
    }
}

fn ordered((a, b): (u32, u32)) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// Halves of a curve by de Casteljau's algorithm.
fn halves(net: &[Point]) -> [Vec<Point>; 2] {
    let mut rest = net.to_vec();
    let (mut low, mut high) = (Vec::with_capacity(net.len()), Vec::with_capacity(net.len()));
    while let (Some(first), Some(last)) = (rest.first(), rest.last()) {
        low.push(*first);
        high.push(*last);
        rest = rest.windows(2).map(|w| std::array::from_fn(|k| (w[0][k] + w[1][k]) * 0.5)).collect();
    }
    high.reverse();
    [low, high]
}

#[cfg(test)]
mod tests;
