//! Everything that casts shadows, as triangles seen by the sun: operands, and placed parts.
//!
//! ```text
//!   operand that is a mesh ──────── as it is ──┐
//!   operand of spline faces ── within slack ──▶├─▶ Flat: a winding number decides, as for the solids' primitives
//!   placed mesh ─────────────────── as it is ──┐
//!   placed spline faces ────── within slack ──▶├─▶ Facet: shades the point if the ray to the sun meets it
//! ```
//!
//! Spline faces are flattened within a deviation that follows from the scene's size and the part's own, [`OF_SCENE`]
//! and [`OF_PART`]. If that takes more than [`MOST_TRIANGLES`], the deviation grows for all. A part that does not fit
//! even then casts no shadow and is counted.

use super::SunData;
use super::faces::{FacePlan, Near};
use crate::abi::{OWN_PLANE, SunFacet, SunTriangle};
use crate::model::{Bounds, Model, Part};
use crate::scene::instance::stretch;
use crate::scene::solids::{Operand, SolidData};
use glam::{DAffine3, DMat2, DVec2, DVec3};
use rayon::prelude::*;

/// Deviation of spline faces, as a share of the scene's diagonal: an eighth of a pixel in a picture that shows the
/// scene a thousand pixels wide.
const OF_SCENE: f64 = 1.0 / 8192.0;
/// Deviation as a share of the part's diagonal: a quarter of a pixel if the part is 256 pixels wide.
const OF_PART: f64 = 1.0 / 1024.0;
/// Most triangles of placed parts and of spline operands together: 48 bytes each, and their entries in lists. Triangles
/// of mesh operands are not counted, since a solid needs all of them.
const MOST_TRIANGLES: u64 = 1 << 20;
/// Factor by which the deviation grows if there are too many triangles, and how often it may grow.
const COARSER: f64 = 4.0;
const MOST_COARSER: u32 = 4;
/// Rounding of a position to single precision, as a share of the size of its part or operand.
const ROUNDING: f64 = 1.0 / 2_097_152.0;
/// The surface of a spline face's triangle: no number, since no visible point is known to lie on it.
const OF_SPLINE: u32 = OWN_PLANE | (OWN_PLANE - 2);

/// Everything that casts shadows.
#[derive(Default)]
pub(super) struct Casters {
    pub triangles: Vec<Flat>,
    pub facets: Vec<Facet>,
    /// For each placed part with facets: the middle of its box, in model coordinates.
    pub middles: Vec<DVec3>,
    /// Number of parts and operands that have too many triangles or are not finite.
    pub left_out: usize,
    /// Largest deviation of a spline face, in model units.
    pub deviation: f64,
}

/// A triangle of an operand, projected along the rays, in model units.
pub(super) struct Flat {
    pub corners: [DVec2; 3],
    /// The operand's middle, projected.
    centre: DVec2,
    /// Heights of the corners above the middle, towards the sun.
    heights: [f64; 3],
    operand: u32,
    surface: u32,
    /// Slack along the ray.
    slack: f64,
}

/// A triangle of a placed part, projected along the rays, in model units.
pub(super) struct Facet {
    /// Counter-clockwise, relative to the part's middle.
    corners: [DVec2; 3],
    heights: [f64; 3],
    /// Gradient of the height.
    slope: DVec2,
    /// Slack across the triangle's plane.
    slack: f64,
    part: u32,
}

/// The source of triangles: a part, or the faces of an operand.
struct Sheet<'a> {
    faces: Vec<FacePlan<'a>>,
    meshes: &'a [crate::model::Mesh],
}

/// A placed sheet.
struct Placed {
    sheet: usize,
    transform: DAffine3,
    /// Its box in the model.
    bounds: Bounds,
    /// Its deviation, in its own units.
    deviation: f64,
    /// If it is an operand: its number and the middle of its box.
    operand: Option<(u32, DVec3)>,
}

impl<'a> Sheet<'a> {
    fn of_part(part: &'a Part) -> Self {
        Self { faces: part.faces.par_iter().map(FacePlan::new).collect(), meshes: &part.meshes }
    }

    fn of_operand(operand: &'a Operand) -> Self {
        Self { faces: operand.faces().par_iter().map(FacePlan::new).collect(), meshes: &[] }
    }

    fn count(&self, deviation: f64) -> u64 {
        let meshes: u64 = self.meshes.iter().map(|m| m.triangles().len() as u64).sum();
        meshes + self.faces.iter().map(|face| face.count(deviation)).sum::<u64>()
    }

    fn triangles(&self, deviation: f64) -> Vec<Near> {
        let flat = |face: &FacePlan<'_>| {
            let mut all = Vec::new();
            face.triangles(deviation, &mut |near| all.push(near));
            all
        };
        let faces: Vec<Vec<Near>> = self.faces.par_iter().map(flat).collect();
        let exact = |[a, b, c]: [DVec3; 3]| Near { corners: [a, b, c], off: 0.0, cell: [a, b, c, c] };
        let meshes = self.meshes.iter().flat_map(|m| (0..m.triangles().len()).map(move |t| exact(m.corners(t))));
        faces.into_iter().flatten().chain(meshes).collect()
    }
}

/// The box around a transformed box.
fn moved(bounds: Bounds, transform: DAffine3) -> Bounds {
    bounds.corners().map(|c| transform.transform_point3(c)).into_iter().fold(Bounds::EMPTY, Bounds::with)
}

impl Casters {
    /// The casters of the solids, and of the parts of `model`, all of which are drawn and uncut.
    pub fn new(sun: &SunData, solids: &SolidData, model: Option<&Model>) -> Self {
        let mut all = Self::default();
        let mut sheets = Vec::new();
        let mut placed = Vec::new();
        for operand in operands(solids).filter(|operand| !operand.faces().is_empty()) {
            let (transform, bounds) = (operand.primitive.transform, operand.primitive.bounds());
            let middle = solids.leaf_centres[solids.operand_leaves[operand.number as usize] as usize];
            let number = Some((operand.number, middle));
            placed.push(Placed { sheet: sheets.len(), transform, bounds, deviation: 0.0, operand: number });
            sheets.push(Sheet::of_operand(operand));
        }
        let mut known: Vec<Option<(usize, Bounds)>> = vec![None; model.map_or(0, |m| m.parts.len())];
        for instance in model.into_iter().flat_map(|m| &m.instances) {
            let part = &model.expect("it has instances").parts[instance.part];
            let (sheet, bounds) = *known[instance.part].get_or_insert_with(|| {
                sheets.push(Sheet::of_part(part));
                (sheets.len() - 1, part.control_bounds())
            });
            if !bounds.is_empty() {
                let transform = instance.transform;
                let bounds = moved(bounds, transform);
                placed.push(Placed { sheet, transform, bounds, deviation: 0.0, operand: None });
            }
        }
        if !placed.is_empty() {
            all.flatten(sun, &sheets, placed, size_of(solids));
        }
        all.triangles.extend(sun.of_meshes(solids));
        all
    }

    fn flatten(&mut self, sun: &SunData, sheets: &[Sheet<'_>], mut placed: Vec<Placed>, scene: Bounds) {
        let whole = placed.iter().fold(scene, |all, p| all.union(p.bounds)).diagonal();
        // a sheet is flattened once, for its largest copy
        let mut finest = vec![f64::INFINITY; sheets.len()];
        for p in &placed {
            let wanted = (OF_SCENE * whole).min(OF_PART * p.bounds.diagonal()) / stretch(p.transform.matrix3);
            finest[p.sheet] = finest[p.sheet].min(wanted);
        }
        placed.retain(|p| {
            let sane = finest[p.sheet] > 0.0 && finest[p.sheet].is_finite() && p.transform.is_finite();
            self.left_out += usize::from(!sane);
            sane
        });
        let counts = |coarser: f64| -> Vec<u64> {
            sheets.par_iter().zip(&finest).map(|(sheet, finest)| sheet.count(finest * coarser)).collect()
        };
        let mut coarser = 1.0;
        let mut each = counts(coarser);
        for _ in 0..MOST_COARSER {
            if placed.iter().map(|p| each[p.sheet]).sum::<u64>() <= MOST_TRIANGLES {
                break;
            }
            coarser *= COARSER;
            each = counts(coarser);
        }
        let mut room = MOST_TRIANGLES;
        placed.retain(|p| {
            let fits = each[p.sheet] <= room;
            room -= if fits { each[p.sheet] } else { 0 };
            self.left_out += usize::from(!fits);
            fits
        });
        placed.iter_mut().for_each(|p| p.deviation = finest[p.sheet] * coarser);
        placed.sort_by_key(|p| p.sheet);
        for same in placed.chunk_by(|a, b| a.sheet == b.sheet) {
            let triangles = sheets[same[0].sheet].triangles(same[0].deviation);
            same.iter().for_each(|p| self.place(sun, p, &triangles));
        }
    }

    fn place(&mut self, sun: &SunData, placed: &Placed, triangles: &[Near]) {
        let scale = stretch(placed.transform.matrix3);
        let rounding = ROUNDING * placed.bounds.diagonal();
        let middle = placed.operand.map_or(placed.bounds.centre(), |(_, middle)| middle);
        let part = self.middles.len() as u32;
        for Near { corners, off, cell } in triangles {
            let corners = corners.map(|p| placed.transform.transform_point3(p) - middle);
            let (flat, heights) = (corners.map(|p| sun.flat(p)), corners.map(|p| sun.towards.dot(p)));
            self.deviation = self.deviation.max(off * scale);
            let slack = 2.0 * off * scale + rounding;
            if let Some((operand, _)) = placed.operand {
                let centre = sun.flat(middle);
                let corners = flat.map(|p| p + centre);
                // a cell is more than twice as large as its deviation, and the face falls in it by no more than this
                let high = if *off > 0.0 {
                    let ends = cell.map(|p| sun.towards.dot(placed.transform.transform_vector3(p)));
                    let most = ends.into_iter().fold(f64::NEG_INFINITY, f64::max);
                    2.0 * (most - ends.into_iter().fold(f64::INFINITY, f64::min))
                } else {
                    f64::INFINITY
                };
                // slack along the ray
                let slack = (slack * steep(flat, heights)).min(high + slack);
                self.triangles.push(Flat { corners, centre, heights, operand, surface: OF_SPLINE, slack });
            } else {
                self.facets.extend(Facet::new(flat, heights, slack, part));
            }
        }
        if placed.operand.is_none() {
            self.middles.push(middle);
        }
    }
}

/// The operands without equations in the union that casts shadows.
pub(super) fn operands(solids: &SolidData) -> impl Iterator<Item = &Operand> {
    solids.operands.iter().filter(|o| solids.operand_leaves[o.number as usize] < solids.followed)
}

/// Gradient of the height over a triangle; not finite if the triangle contains the sun's direction.
fn slope_of([a, b, c]: [DVec2; 3], heights: [f64; 3]) -> DVec2 {
    let rises = DVec2::new(heights[1] - heights[0], heights[2] - heights[0]);
    DMat2::from_cols(b - a, c - a).transpose().inverse() * rises
}

/// Factor from a length across the triangle's plane to a length along the ray.
fn steep(corners: [DVec2; 3], heights: [f64; 3]) -> f64 {
    (1.0 + slope_of(corners, heights).length_squared()).sqrt()
}

/// The box around all bounded leaves of the solids that cast shadows.
fn size_of(solids: &SolidData) -> Bounds {
    let leaves = solids.leaves.iter().zip(&solids.leaf_centres).take(solids.followed as usize);
    let ends = leaves.filter_map(|(leaf, centre)| {
        let half = DVec3::from(leaf.half_size.map(f64::from));
        half.is_finite().then(|| Bounds { min: centre - half, max: centre + half })
    });
    ends.fold(Bounds::EMPTY, Bounds::union)
}

impl Facet {
    /// `None` if the triangle contains the sun's direction: it covers nothing.
    fn new(flat: [DVec2; 3], heights: [f64; 3], slack: f64, part: u32) -> Option<Self> {
        let clockwise = (flat[1] - flat[0]).perp_dot(flat[2] - flat[0]) < 0.0;
        let slope = slope_of(flat, heights);
        if !(slope.as_vec2().is_finite() && slope.length_squared() < f64::from(f32::MAX)) {
            return None;
        }
        let turned = |[a, b, c]: [DVec2; 3]| if clockwise { [a, c, b] } else { [a, b, c] };
        Some(Self { corners: turned(flat), heights, slope, slack, part })
    }

    /// Its box across the rays, with its slack.
    pub fn square(&self, middles: &[DVec2]) -> (DVec2, DVec2) {
        let [a, b, c] = self.corners;
        let (middle, margin) = (middles[self.part as usize], 0.5 * self.slack);
        (middle + a.min(b).min(c) - margin, middle + a.max(b).max(c) + margin)
    }

    /// The record that shaders read, in units of tiles.
    pub fn stored(&self, side: f64) -> SunFacet {
        let slope = self.slope * side;
        SunFacet {
            corners: self.corners.map(|p| (p / side).as_vec2().to_array()),
            plane: [self.heights[0] as f32, slope.x as f32, slope.y as f32],
            steep: (1.0 + self.slope.length_squared()).sqrt() as f32,
            slack: self.slack as f32,
            part: self.part,
        }
    }
}

impl Flat {
    /// The record that shaders read, in units of tiles, relative to the operand's middle.
    pub fn stored(&self, side: f64) -> SunTriangle {
        let corners = self.corners.map(|p| ((p - self.centre) / side).as_vec2().to_array());
        let heights = self.heights.map(|h| h as f32);
        let slack = if self.slack.is_nan() { f32::MAX } else { (self.slack as f32).min(f32::MAX) };
        SunTriangle { corners, heights, operand: self.operand, surface: self.surface, slack }
    }
}

impl SunData {
    /// The triangles of the union's mesh operands.
    fn of_meshes(&self, solids: &SolidData) -> Vec<Flat> {
        let mut all = Vec::new();
        for operand in operands(solids) {
            let middle = solids.leaf_centres[solids.operand_leaves[operand.number as usize] as usize];
            let centre = self.flat(middle);
            let meshes = operand.meshes.clone();
            for (mesh, corners) in solids.operand_meshes[meshes.clone()].iter().zip(&solids.operand_draws[meshes]) {
                let triangles = &solids.operand_triangles[corners.start as usize / 3..corners.end as usize / 3];
                for (number, triangle) in (mesh.first_triangle..).zip(triangles) {
                    let corners = triangle.map(|v| {
                        let own = DVec3::from(solids.operand_positions[v as usize].map(f64::from)) + operand.origin;
                        operand.primitive.transform.transform_point3(own)
                    });
                    all.push(Flat {
                        corners: corners.map(|p| self.flat(p)),
                        centre,
                        heights: corners.map(|p| self.towards.dot(p - middle)),
                        operand: operand.number,
                        surface: solids.plane_of(mesh, number).unwrap_or(OWN_PLANE | number),
                        slack: 0.0,
                    });
                }
            }
        }
        all
    }
}
