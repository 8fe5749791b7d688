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
use glam::{DVec2, DVec3, DVec4};

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

    /// (u, v) of the trim curve next to a point, in shares of the domain.
    fn place(&self, p: DVec3) -> Option<DVec2> {
        let place = self.track.place(&self.sheet, p)?;
        let ((u0, u1), (v0, v1)) = self.sheet.face.surface.domain();
        Some((place - DVec2::new(u0, v0)) / DVec2::new(u1 - u0, v1 - v0))
    }

    /// The texels of a piece.
    fn texels(&self, piece: &Bezier<DVec4>, of: &PartFaces<'_>) -> Option<[[f32; 4]; 2]> {
        let [a, b] = ENDS.map(|t| self.place(piece.point(t)));
        let (a, b) = (a?, b?);
        // loops have the face on their left
        let side = if self.used.forward { 1.0 } else { -1.0 };
        let within = side * (b - a).perp().normalize_or_zero() * WITHIN;
        let number = of.first_face + self.used.face;
        let face = of.faces.get(number)?;
        let first = face.first_patch as usize;
        let patches = of.patches.get(first..first + (face.count_u * face.count_v) as usize)?;
        let at = 0.5 * (a + b) + within;
        let holds = |patch: &abi::Patch| {
            let [u, v, width, height] = patch.domain.map(f64::from);
            let share = (at - DVec2::new(u, v)) / DVec2::new(width, height);
            patch.side() != Side::Outside && share.min_element() >= 0.0 && share.max_element() <= 1.0
        };
        let patch = patches.iter().position(holds)?;
        let is_number = number.max(patch) < MOST_NUMBER;
        let place = [a.x as f32, a.y as f32, b.x as f32, b.y as f32];
        is_number.then_some([[number as f32, patch as f32, side as f32, 0.0], place])
    }
}

/// Texels for the pieces of a smooth edge or a seam, as many for each: how many faces, and the texels of each piece.
pub(super) fn seeds(edge: &Edge, reach: f64, of: &PartFaces<'_>) -> (u32, Vec<Vec<[f32; 4]>>) {
    let most = abi::EDGE_MOST_SEEDS as usize;
    let mut count = 0;
    let mut texels = vec![Vec::new(); edge.curve.len()];
    for beside in edge.uses.iter().filter_map(|used| Beside::new(of.part, used, reach)).take(most) {
        let found: Option<Vec<_>> = edge.curve.iter().map(|span| beside.texels(&span.piece, of)).collect();
        let Some(found) = found else { continue };
        count += 1;
        texels.iter_mut().zip(found).for_each(|(all, own)| all.extend(own));
    }
    (count, texels)
}
