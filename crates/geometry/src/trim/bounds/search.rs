//! The largest height of placed faces and meshes, by branch and bound.
//!
//! ```text
//!   body ──▶ face ──┬─▶ run of trim curves ──▶ its halves …                    the heap, the highest bound first
//!     │             │     └─▶ piece over one patch ──▶ in space ──▶ its halves …
//!     │             └─▶ cell ──▶ its patch ──┬─▶ its halves, inside or across the loops …
//!     └────▶ mesh                            └─▶ its four sides ──▶ their halves …
//! ```
//!
//! Patches of a face that is nowhere higher than its trim curves ([`Carried::is_ruled`]) are searched only if a piece is
//! left out, because the face is not beside it at the places where that is tested.

use super::carried::{Carried, Piece, Reached};
use super::curves::Link;
use super::height::{Height, ROUNDING, Up, quotient};
use crate::model::{Bounds, Face, Mesh};
use crate::trim::RectSide;
use glam::{DAffine3, DVec2, DVec3};
use std::cell::OnceCell;
use std::cmp::{Ordering, Reverse};
use std::collections::{BinaryHeap, HashMap, HashSet};

/// Steps of one search; after them each candidate counts as high as its bound.
const MOST_STEPS: usize = 1 << 16;
/// Halvings of a curve or patch; after them it counts as high as its bound.
const MOST_HALVINGS: u32 = 96;

/// Faces and meshes that are placed together.
pub(super) struct Body<'a> {
    faces: Vec<Item<'a>>,
    meshes: Vec<(&'a Mesh, Bounds)>,
    /// Box of all control points and vertices.
    pub around: Bounds,
}

/// A face, and what searches prepare of it when they need it.
struct Item<'a> {
    face: &'a Face,
    /// Box of all control points.
    around: Bounds,
    reached: OnceCell<Reached>,
    carried: OnceCell<Carried<'a>>,
}

impl<'a> Body<'a> {
    pub fn new(faces: &'a [Face], meshes: &'a [Mesh]) -> Self {
        let item = |face: &'a Face| {
            let (min, max) = face.surface.bounds();
            Item { face, around: Bounds { min, max }, reached: OnceCell::new(), carried: OnceCell::new() }
        };
        let faces: Vec<_> = faces.iter().map(item).collect();
        let meshes: Vec<_> = meshes.iter().map(|mesh| (mesh, mesh.bounds())).filter(|m| !m.1.is_empty()).collect();
        let around =
            faces.iter().map(|f| f.around).chain(meshes.iter().map(|m| m.1)).fold(Bounds::EMPTY, Bounds::union);
        Self { faces, meshes, around }
    }

    fn reached(&self, face: usize) -> &Reached {
        let Item { face, reached, .. } = &self.faces[face];
        reached.get_or_init(|| Reached::new(face))
    }

    fn carried(&self, face: usize) -> &Carried<'a> {
        let item = &self.faces[face];
        item.carried.get_or_init(|| Carried::new(item.face, self.reached(face)))
    }
}

/// What searches have prepared.
#[cfg(test)]
#[derive(Debug, Default)]
pub(super) struct Work {
    pub faces: usize,
    pub patches: usize,
    pub pieces_tested: usize,
    pub pieces_in_space: usize,
}

#[cfg(test)]
impl Body<'_> {
    pub fn work(&self) -> Work {
        self.faces.iter().filter_map(|item| item.carried.get()).fold(Work::default(), |all, carried| Work {
            faces: all.faces + 1,
            patches: all.patches + carried.hulls.len(),
            pieces_tested: all.pieces_tested + carried.pieces_done().0,
            pieces_in_space: all.pieces_in_space + carried.pieces_done().1,
        })
    }
}

/// How far from the truth a search may end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// For faces that have equations.
    pub analytic: f64,
    /// For other faces; no less.
    pub other: f64,
}

/// A candidate for the highest point.
struct Candidate {
    upper: f64,
    placed: usize,
    what: What,
}

enum What {
    Body,
    Face(usize),
    Mesh(usize),
    /// A node of a face's trim curves.
    Run {
        face: usize,
        node: usize,
    },
    /// A piece of a trim curve.
    Piece {
        face: usize,
        curve: usize,
        piece: usize,
        bound: Bound,
    },
    /// A part of such a piece.
    Curve {
        face: usize,
        height: Box<Height>,
        halvings: u32,
    },
    /// A knot span of a face's surface, as high as its control points.
    Cell {
        face: usize,
        cell: usize,
    },
    /// A rectangle of a face's domain within one patch, or a line of it.
    Area(Box<Area>),
}

/// What a piece is as high as.
#[derive(Clone, Copy)]
enum Bound {
    /// The control points of its cell.
    Cell,
    /// The part of the patch under its box.
    Part,
    /// Its control points in space.
    Space,
}

struct Area {
    face: usize,
    height: Height,
    lo: DVec2,
    hi: DVec2,
    /// No trim curve is in it.
    inside: bool,
    /// A whole patch, whose sides come with it.
    whole: bool,
    halvings: u32,
}

impl What {
    /// The order among equal bounds: what is nearest to a point of the model, which raises the mark, is first. Areas
    /// need a test against the loops. The parts of a run have smaller numbers than it.
    fn rank(&self) -> (u8, Reverse<usize>) {
        match self {
            Self::Area(_) | Self::Cell { .. } => (0, Reverse(0)),
            Self::Body | Self::Face(_) | Self::Mesh(_) => (1, Reverse(0)),
            Self::Run { node, .. } => (2, Reverse(*node)),
            Self::Piece { .. } | Self::Curve { .. } => (3, Reverse(0)),
        }
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Candidate {}
impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper).then(self.what.rank().cmp(&other.what.rank()))
    }
}

/// A face of a placed body.
#[derive(Clone, Copy)]
struct On<'c, 'a> {
    placed: usize,
    up: Up,
    face: usize,
    carried: &'c Carried<'a>,
}

/// The search along one direction.
pub(super) struct Search<'s, 'a> {
    bodies: &'s [Body<'a>],
    /// For each placed body, its upward direction and its number.
    placed: Vec<(Up, usize)>,
    heap: BinaryHeap<Candidate>,
    /// Placed bodies and faces: ruled ones whose patches are candidates, too, since a piece was left out.
    inside: HashSet<(usize, usize)>,
    /// The height of the highest point that certainly belongs to the model.
    low: f64,
    /// The largest bound of candidates that were not examined to the end.
    unsure: f64,
    /// Rounding of heights.
    rounding: f64,
    steps: usize,
}

impl<'s, 'a> Search<'s, 'a> {
    /// Of bodies by their numbers, as placed.
    pub fn new(bodies: &'s [Body<'a>], placements: &[(usize, DAffine3)], direction: DVec3) -> Self {
        // of bodies with the same rotation the highest
        let mut highest: HashMap<(usize, [u64; 3]), Up> = HashMap::new();
        for &(body, transform) in placements {
            let along = transform.matrix3.transpose() * direction + 0.0; // no -0
            let up = Up { along, offset: direction.dot(transform.translation) };
            let known = highest.entry((body, along.to_array().map(f64::to_bits))).or_insert(up);
            known.offset = known.offset.max(up.offset);
        }
        let mut placed: Vec<(Up, usize)> = highest.into_iter().map(|((body, _), up)| (up, body)).collect();
        placed.sort_by(|a, b| a.1.cmp(&b.1).then(a.0.offset.total_cmp(&b.0.offset)));
        let upper = |(up, body): &(Up, usize)| up.of_box(bodies[*body].around);
        let size = placed.iter().map(|(up, body)| {
            let around = bodies[*body].around;
            up.along.abs().dot(around.min.abs().max(around.max.abs())) + up.offset.abs()
        });
        let rounding = ROUNDING * size.fold(0.0, f64::max);
        let candidates = placed.iter().enumerate();
        let heap = candidates.map(|(n, p)| Candidate { upper: upper(p), placed: n, what: What::Body }).collect();
        let (low, unsure) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        Self { bodies, placed, heap, inside: HashSet::new(), low, unsure, rounding, steps: 0 }
    }

    /// The largest height, or less by the tolerance; more where the allowed work does not suffice. Negative infinity
    /// where there is nothing.
    pub fn refine(&mut self, tolerance: Tolerance) -> f64 {
        while let Some(top) = self.heap.peek() {
            // NaN reaches no farther
            let reaches_farther = top.upper > self.low + tolerance.analytic + self.rounding;
            if !reaches_farther {
                break;
            }
            if self.steps >= MOST_STEPS {
                self.unsure = self.unsure.max(top.upper);
                break;
            }
            let Some(top) = self.heap.pop() else { break };
            if top.upper > self.low + self.allowed(&top, tolerance) + self.rounding {
                self.steps += 1;
                self.expand(top);
            }
        }
        self.low.max(self.unsure)
    }

    /// The highest point found.
    pub fn low(&self) -> f64 {
        self.low
    }

    fn allowed(&self, of: &Candidate, tolerance: Tolerance) -> f64 {
        let face = match &of.what {
            What::Body | What::Mesh(_) => return tolerance.analytic,
            What::Face(face)
            | What::Run { face, .. }
            | What::Piece { face, .. }
            | What::Curve { face, .. }
            | What::Cell { face, .. } => *face,
            What::Area(area) => area.face,
        };
        if self.bodies[self.placed[of.placed].1].faces[face].face.kind.is_elementary() {
            tolerance.analytic
        } else {
            tolerance.other
        }
    }

    fn push(&mut self, placed: usize, upper: f64, what: What) {
        if upper > self.low {
            self.heap.push(Candidate { upper, placed, what });
        }
    }

    fn find(&mut self, height: f64) {
        self.low = self.low.max(height);
    }

    fn expand(&mut self, Candidate { upper, placed, what }: Candidate) {
        let bodies = self.bodies;
        let (up, body) = self.placed[placed];
        let body = &bodies[body];
        let on = |face: usize| On { placed, up, face, carried: body.carried(face) };
        match what {
            What::Body => {
                self.heap.reserve(body.faces.len());
                for (i, item) in body.faces.iter().enumerate() {
                    self.push(placed, up.of_box(item.around), What::Face(i));
                }
                for (i, (_, around)) in body.meshes.iter().enumerate() {
                    self.push(placed, up.of_box(*around), What::Mesh(i));
                }
            }
            What::Mesh(mesh) => {
                let mesh = body.meshes[mesh].0;
                let corners = mesh.triangles().iter().flatten().map(|&v| up.of_point(mesh.positions()[v as usize]));
                self.find(corners.fold(f64::NEG_INFINITY, f64::max));
            }
            What::Face(face) => {
                let least = up.of_box(body.reached(face).hull);
                if least < upper {
                    self.push(placed, least, What::Face(face));
                } else {
                    self.face(on(face), upper);
                }
            }
            What::Run { face, node } => {
                let on = on(face);
                match on.carried.curves.nodes[node].link {
                    Link::Pair(a, b) => [a, b].into_iter().for_each(|node| self.run(on, upper, node)),
                    Link::Curve(curve) => self.pieces(on, upper, curve),
                }
            }
            What::Piece { face, curve, piece, bound: Bound::Cell } => {
                let upper = body.carried(face).upper_of_piece(curve, piece, up).min(upper);
                self.push(placed, upper, What::Piece { face, curve, piece, bound: Bound::Part });
            }
            What::Piece { face, curve, piece, bound: Bound::Part } => self.in_space(on(face), upper, curve, piece),
            What::Piece { face, curve, piece, bound: Bound::Space } => {
                // the test beside the curve costs more than its bound, so that only the highest pieces are tested
                let carried = body.carried(face);
                if carried.is_beside(curve, piece) {
                    self.curve(placed, upper, face, up.of_curve(carried.in_space(curve, piece)), 0);
                } else if carried.is_ruled && self.inside.insert((placed, face)) {
                    self.cells(on(face), f64::INFINITY);
                }
            }
            What::Curve { face, height, halvings } => self.curve(placed, upper, face, *height, halvings),
            What::Cell { face, cell } => {
                let carried = body.carried(face);
                let (lo, hi) = carried.rectangle(cell);
                let side = carried.classify(lo, hi);
                if side != RectSide::Outside {
                    let height = up.of_patch(carried.patch(cell));
                    let (upper, inside) = (height.upper().min(upper), side == RectSide::Inside);
                    let area = Area { face, height, lo, hi, inside, whole: true, halvings: 0 };
                    self.push(placed, upper, What::Area(Box::new(area)));
                }
            }
            What::Area(area) => {
                let carried = body.carried(area.face);
                self.area(placed, upper, *area, carried);
            }
        }
    }

    fn curve(&mut self, placed: usize, upper: f64, face: usize, height: Height, halvings: u32) {
        let ends = [height.at(0, 0), height.at(height.n, 0)].map(quotient);
        ends.into_iter().for_each(|end| self.find(end));
        if self.is_done(upper, height.lower(), &height, halvings) {
            return;
        }
        for half in height.halves_u() {
            let upper = half.upper().min(upper);
            self.push(placed, upper, What::Curve { face, height: Box::new(half), halvings: halvings + 1 });
        }
    }

    fn face(&mut self, on: On<'_, 'a>, upper: f64) {
        if let Some(root) = on.carried.curves.root {
            self.push(on.placed, upper, What::Run { face: on.face, node: root });
        }
        if !on.carried.is_ruled {
            self.cells(on, upper);
        }
    }

    fn cells(&mut self, On { placed, up, face, carried }: On<'_, 'a>, upper: f64) {
        for (cell, hull) in carried.hulls.iter().enumerate() {
            self.push(placed, up.of_box(*hull).min(upper), What::Cell { face, cell });
        }
    }

    fn run(&mut self, On { placed, up, face, carried }: On<'_, 'a>, upper: f64, node: usize) {
        let upper = carried.upper_of(node, up, self.low).min(upper);
        self.push(placed, upper, What::Run { face, node });
    }

    fn pieces(&mut self, on: On<'_, 'a>, upper: f64, curve: usize) {
        let On { placed, up, face, carried } = on;
        match carried.pieces(curve) {
            // as high as its run
            [_] => self.in_space(on, upper, curve, 0),
            all => {
                for (piece, Piece { cell, .. }) in all.iter().enumerate() {
                    let upper = up.of_box(carried.hulls[*cell]).min(upper);
                    self.push(placed, upper, What::Piece { face, curve, piece, bound: Bound::Cell });
                }
            }
        }
    }

    fn in_space(&mut self, On { placed, up, face, carried }: On<'_, 'a>, upper: f64, curve: usize, piece: usize) {
        let upper = up.upper_of(carried.in_space(curve, piece)).min(upper);
        self.push(placed, upper, What::Piece { face, curve, piece, bound: Bound::Space });
    }

    fn area(&mut self, placed: usize, upper: f64, area: Area, carried: &Carried<'_>) {
        let Area { face, height, lo, hi, inside, whole, halvings } = area;
        for (i, j) in [(0, 0), (height.n, 0), (0, height.k), (height.n, height.k)] {
            let top = quotient(height.at(i, j));
            let corner = DVec2::new(if i == 0 { lo.x } else { hi.x }, if j == 0 { lo.y } else { hi.y });
            if top > self.low && (inside || carried.holds(corner)) {
                self.find(top);
            }
        }
        if whole {
            // where patches meet, and at the domain's border, it may be highest without being level
            for last in [false, true] {
                let (u, v) = if last { (hi.x, hi.y) } else { (lo.x, lo.y) };
                let along_v = (height.side_u(last), DVec2::new(u, lo.y), DVec2::new(u, hi.y));
                let along_u = (height.side_v(last), DVec2::new(lo.x, v), DVec2::new(hi.x, v));
                for (height, lo, hi) in [along_v, along_u] {
                    let area = Area { face, height, lo, hi, inside, whole: false, halvings };
                    self.push(placed, area.height.upper(), What::Area(Box::new(area)));
                }
            }
        }
        let lower = height.lower();
        if self.is_done(upper, lower, &height, halvings) {
            return;
        }
        // a level area is as high as its corners, if they are in the face, or as the trim curves in it: all are
        // candidates too
        if !inside && upper - lower <= self.rounding {
            return;
        }
        let side = if inside { RectSide::Inside } else { carried.classify(lo, hi) };
        if side == RectSide::Outside {
            return;
        }
        let inside = side == RectSide::Inside;
        let (middle, halvings) = (0.5 * (lo + hi), halvings + 1);
        let (halves, first_hi, second_lo) =
            if height.n == 0 || height.k > 0 && height.is_steeper_in_v(self.low.max(lower)) {
                (height.halves_v(), DVec2::new(hi.x, middle.y), DVec2::new(lo.x, middle.y))
            } else {
                (height.halves_u(), DVec2::new(middle.x, hi.y), DVec2::new(middle.x, lo.y))
            };
        for (height, (lo, hi)) in halves.into_iter().zip([(lo, first_hi), (second_lo, hi)]) {
            let upper = height.upper().min(upper);
            let area = Area { face, height, lo, hi, inside, whole: false, halvings };
            self.push(placed, upper, What::Area(Box::new(area)));
        }
    }

    /// Whether the candidate holds nothing higher than the mark, its ends and sides apart; or is too small to be
    /// halved.
    fn is_done(&mut self, upper: f64, lower: f64, height: &Height, halvings: u32) -> bool {
        let from = self.low.max(lower);
        if upper <= self.low || from.is_finite() && upper.is_finite() && !height.may_turn(from, upper) {
            return true;
        }
        if halvings >= MOST_HALVINGS {
            self.unsure = self.unsure.max(upper);
            return true;
        }
        false
    }
}
