//! Where curved faces begin beside smooth edges and seams: from there pass `edge_line` finds folds that are closer to
//! the edge than pixels are to each other.
//!
//! ```text
//!    plane  ════════●  smooth edge      pieces of the edge ─(u, v) beside both ends, on each curved face─▶ two texels
//!                    ╲                                      behind the piece's control points
//!              fillet │  fold
//! ```

use crate::abi::{self, Side};
use crate::edges::{Sheet, Track};
use crate::model::{Edge, EdgeUse, Part};
use crate::spline::Bezier;
use glam::{DVec2, DVec4};

/// Of a piece: near its ends.
const ENDS: [f64; 2] = [abi::SEED_END as f64, 1.0 - abi::SEED_END as f64];
/// Of the domain: so far within the face the patch is looked for.
const WITHIN: f64 = 1e-5;
/// Single precision has no odd integers beyond: numbers of faces and patches are stored as such.
const MOST_NUMBER: usize = 1 << 24;

/// The faces of a part in the scene's arrays.
pub(super) struct PartFaces<'a> {
    pub part: &'a Part,
    pub first_face: usize,
    /// Of the whole scene.
    pub faces: &'a [abi::Face],
    pub patches: &'a [abi::Patch],
}

/// A face in the scene's arrays, or a window of it in a deep zoom.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShownFace {
    pub number: usize,
    /// The parameters that it shows, along `u` and `v`.
    pub domain: ((f64, f64), (f64, f64)),
    /// The instance that places it; `None`: the one of the edge's pieces.
    pub instance: Option<u32>,
}

/// A curved face beside an edge.
struct Beside<'a> {
    sheet: Sheet<'a>,
    used: &'a EdgeUse,
    track: Track,
}

impl<'a> Beside<'a> {
    /// `None` of a plane.
    fn new(part: &'a Part, used: &'a EdgeUse, reach: f64) -> Option<Self> {
        let sheet = Sheet::new(&part.faces[used.face]);
        if sheet.plane.is_some() {
            return None;
        }
        let track = Track::new(&sheet, used, reach);
        Some(Self { sheet, used, track })
    }

    /// (u, v) of the trim curve next to a piece, near both of its ends.
    fn ends(&self, piece: &Bezier<DVec4>) -> Option<[DVec2; 2]> {
        let [a, b] = ENDS.map(|t| self.track.place(&self.sheet, piece.point(t)));
        Some([a?, b?])
    }

    /// The texels of a piece with these ends; `None` if the shown face has no patch there.
    fn texels(
        &self,
        ends: [DVec2; 2],
        shown: &ShownFace,
        (faces, patches): (&[abi::Face], &[abi::Patch]),
    ) -> Option<[[f32; 4]; 2]> {
        let ((u0, u1), (v0, v1)) = shown.domain;
        let [a, b] = ends.map(|place| (place - DVec2::new(u0, v0)) / DVec2::new(u1 - u0, v1 - v0));
        // loops have the face on their left
        let side = if self.used.forward { 1.0 } else { -1.0 };
        let within = side * (b - a).perp().normalize_or_zero() * WITHIN;
        let face = faces.get(shown.number)?;
        let first = face.first_patch as usize;
        let patches = patches.get(first..first + (face.count_u * face.count_v) as usize)?;
        let at = 0.5 * (a + b) + within;
        let holds = |patch: &abi::Patch| {
            let [u, v, width, height] = patch.domain.map(f64::from);
            let share = (at - DVec2::new(u, v)) / DVec2::new(width, height);
            patch.side() != Side::Outside && share.min_element() >= 0.0 && share.max_element() <= 1.0
        };
        let patch = patches.iter().position(holds)?;
        let placed = shown.instance.map_or(0, |instance| instance as usize + 1);
        let is_number = shown.number.max(patch).max(placed) < MOST_NUMBER;
        let place = [a.x as f32, a.y as f32, b.x as f32, b.y as f32];
        is_number.then_some([[shown.number as f32, patch as f32, side as f32, placed as f32], place])
    }
}

/// Texels for the pieces of a smooth edge or a seam, as many for each: how many faces, and the texels of each piece.
pub(super) fn seeds(edge: &Edge, reach: f64, of: &PartFaces<'_>) -> (u32, Vec<Vec<[f32; 4]>>) {
    let most = abi::EDGE_MOST_SEEDS as usize;
    let mut count = 0;
    let mut texels = vec![Vec::new(); edge.curve.len()];
    for beside in edge.uses.iter().filter_map(|used| Beside::new(of.part, used, reach)).take(most) {
        let number = of.first_face + beside.used.face;
        let shown = ShownFace { number, domain: beside.sheet.face.surface.domain(), instance: None };
        let of_piece = |piece: &Bezier<DVec4>| beside.texels(beside.ends(piece)?, &shown, (of.faces, of.patches));
        let found: Option<Vec<_>> = edge.curve.iter().map(|span| of_piece(&span.piece)).collect();
        let Some(found) = found else { continue };
        count += 1;
        texels.iter_mut().zip(found).for_each(|(all, own)| all.extend(own));
    }
    (count, texels)
}

/// The same for pieces in the view of a deep zoom, of each piece on its own: how many faces, and their texels. `shown`
/// has the windows of each face of the part.
pub(super) fn seeds_of_cut<'w>(
    (edge, part, reach): (&Edge, &Part, f64),
    pieces: &[Bezier<DVec4>],
    shown: impl Fn(usize) -> &'w [ShownFace],
    arrays: (&[abi::Face], &[abi::Patch]),
) -> Vec<(u32, Vec<[f32; 4]>)> {
    let most = abi::EDGE_MOST_SEEDS as usize;
    let beside = edge.uses.iter().filter_map(|used| Beside::new(part, used, reach)).take(most);
    let beside: Vec<Beside<'_>> = beside.collect();
    let of_piece = |piece: &Bezier<DVec4>| {
        let of_face = |beside: &Beside<'_>| {
            let ends = beside.ends(piece)?;
            shown(beside.used.face).iter().find_map(|shown| beside.texels(ends, shown, arrays))
        };
        let found: Vec<[[f32; 4]; 2]> = beside.iter().filter_map(of_face).collect();
        (found.len() as u32, found.into_flattened())
    };
    pieces.iter().map(of_piece).collect()
}
