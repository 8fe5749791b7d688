//! One face: its surface, its loops, and how far they are from the edges.
//!
//! ```text
//!   face ─▶ surface     spline, turned curve, or a plane, as large as its loops
//!        └▶ loops ─▶ coedges ─▶ p-curve in (u, v) ─▶ Bézier pieces ─chain─▶ TrimLoop
//!                           └─▶ edge ─▶ curve in space: distance of the p-curve's image from it
//! ```
//!
//! The parameter of a turned curve is an angle, in which its p-curves are stated. The decoder makes it a rational
//! spline, which has another parameter: [`Map`] leads from one to the other.

use super::joined;
use super::shape::Map;
use crate::brep::crossing_note;
use crate::import::chain::chain;
use crate::import::locate::nearest;
use crate::model::{Face, SurfaceKind, TrimLoop};
use crate::spline::{BSpline, Bezier, Control, PatchGrid, Surface};
use cadmpeg_ir::document::CadIr;
use cadmpeg_ir::geometry::nurbs::NurbsSurface;
use cadmpeg_ir::geometry::pcurve::{Pcurve, PcurveGeometry};
use cadmpeg_ir::geometry::{Curve, CurveGeometry, SolvedCurveGeometry, SolvedSurfaceGeometry, Surface as Carrier};
use cadmpeg_ir::geometry::{ProceduralSurface, ProceduralSurfaceDefinition};
use cadmpeg_ir::topology::{Coedge, Edge, Face as Stated, Loop, LoopBoundaryRole, Sense};
use glam::{DVec2, DVec3, DVec4};
use std::collections::HashMap;

/// The records of a file by name.
pub(super) struct Tables<'i> {
    faces: HashMap<&'i str, &'i Stated>,
    surfaces: HashMap<&'i str, &'i Carrier>,
    constructions: HashMap<&'i str, &'i ProceduralSurface>,
    loops: HashMap<&'i str, &'i Loop>,
    coedges: HashMap<&'i str, &'i Coedge>,
    pcurves: HashMap<&'i str, &'i Pcurve>,
    edges: HashMap<&'i str, &'i Edge>,
    curves: HashMap<&'i str, &'i Curve>,
}

/// The edge beside a trim, in space.
pub(super) enum Beside {
    Nothing,
    /// An edge without a curve that could be compared.
    Unknown,
    Curve(BSpline<DVec4>),
}

/// Curves in `(u, v)` end to end.
pub(super) type Outline = Vec<(BSpline<DVec3>, Beside)>;

/// A loop.
pub(super) struct Ring {
    pub curves: Outline,
    pub hole: bool,
}

/// A face, and the notes on it.
pub(super) struct Built {
    pub face: Face,
    pub notes: Vec<String>,
    /// Millimetres: largest distance of a trim's image from its edge, at the points that were compared.
    pub gap: f64,
}

/// Distance in millimetres up to which ends in space are one point: Rhino's own default tolerance is 0.001 to
/// 0.01 of a unit.
pub(super) const MEET: f64 = 0.01;

/// Points of a trim that are compared with its edge.
const COMPARED: usize = 5;

impl<'i> Tables<'i> {
    pub fn new(ir: &'i CadIr) -> Self {
        let m = &ir.model;
        Self {
            faces: m.faces.iter().map(|x| (x.id.as_str(), x)).collect(),
            surfaces: m.surfaces.iter().map(|x| (x.id.as_str(), x)).collect(),
            constructions: m.procedural_surfaces.iter().map(|x| (x.id.as_str(), x)).collect(),
            loops: m.loops.iter().map(|x| (x.id.as_str(), x)).collect(),
            coedges: m.coedges.iter().map(|x| (x.id.as_str(), x)).collect(),
            pcurves: m.pcurves.iter().map(|x| (x.id.as_str(), x)).collect(),
            edges: m.edges.iter().map(|x| (x.id.as_str(), x)).collect(),
            curves: m.curves.iter().map(|x| (x.id.as_str(), x)).collect(),
        }
    }

    /// The face of that name, numbered `id`.
    pub fn face(&self, name: &str, id: u32) -> Result<Built, String> {
        let face = self.faces.get(name).ok_or("no such face")?;
        let carrier = self.surfaces.get(face.surface.as_str()).ok_or("no surface")?;
        let geometry = carrier.geometry.solved().ok_or("a surface that is only described")?;
        let mut rings = Vec::new();
        for (at, ring) in face.loops.iter().enumerate() {
            let stated = self.loops.get(ring.as_str()).ok_or("no such loop")?;
            // the first loop is the outer one where no role says so
            let hole = match face.loops.role(ring) {
                LoopBoundaryRole::Inner => true,
                LoopBoundaryRole::Outer => false,
                LoopBoundaryRole::Unspecified => at > 0,
            };
            rings.push(Ring { curves: self.ring(stated)?, hole });
        }
        let all = rings.iter().flat_map(|ring| &ring.curves).flat_map(|(curve, _)| curve.points().iter());
        let (mut surface, mut kind, flipped) = spline_of(geometry, all.map(|p| p.point()))?;
        let construction =
            carrier.geometry.procedural_construction().and_then(|id| self.constructions.get(id.as_str()));
        if let Some(ProceduralSurfaceDefinition::Revolution(turned)) = construction.map(|c| c.definition()) {
            let (over, map) = by_angle(&surface, turned.angular_interval().endpoints(), *turned.transposed())?;
            surface = over;
            kind = SurfaceKind::Revolution;
            for (curve, _) in rings.iter_mut().flat_map(|ring| &mut ring.curves) {
                *curve = map.curve(&raised(curve)?)?;
            }
        }
        let same_sense = matches!(face.sense, Sense::Forward) != flipped;
        let colour = face.color.map(super::linear);
        built(Face { id, kind, surface, loops: Vec::new(), same_sense, colour }, &rings, Vec::new())
    }

    /// The curves of a loop in `(u, v)`, each run as the loop runs, with its edge.
    fn ring(&self, stated: &Loop) -> Result<Outline, String> {
        let mut ring = Vec::new();
        for coedge in stated.coedges() {
            let coedge = self.coedges.get(coedge.as_str()).ok_or("no such trim")?;
            let edge = || match self.edges.get(coedge.edge.as_str()) {
                None => Beside::Nothing,
                Some(edge) => self.edge_curve(edge).map_or(Beside::Unknown, Beside::Curve),
            };
            for used in &coedge.pcurves {
                let pcurve = self.pcurves.get(used.pcurve.as_str()).ok_or("no such curve in (u, v)")?;
                ring.extend(splines(&pcurve.geometry)?.into_iter().map(|piece| (piece, edge())));
            }
        }
        if ring.is_empty() { Err("a loop without curves in (u, v)".into()) } else { Ok(ring) }
    }

    fn edge_curve(&self, edge: &Edge) -> Option<BSpline<DVec4>> {
        let curve = self.curves.get(edge.curve()?.as_str())?;
        let CurveGeometry::Solved(SolvedCurveGeometry::Nurbs(nurbs)) = &curve.geometry else { return None };
        let weights = nurbs.weights();
        let weight = |i: usize| weights.as_ref().map_or(1.0, |w| w[i].get());
        let points = nurbs.control_points().into_iter().enumerate();
        let points = points.map(|(i, p)| {
            let p = p.get();
            DVec4::from_point(DVec3::new(p.x, p.y, p.z), weight(i))
        });
        joined::curve(nurbs.degree() as usize, nurbs.knots().as_slice().to_vec(), points.collect()).ok()
    }
}

/// `face` with its loops, closed, and their distance from the edges.
pub(super) fn built(mut face: Face, rings: &[Ring], mut notes: Vec<String>) -> Result<Built, String> {
    let grid = face.surface.patches();
    let mut gap = 0.0f64;
    for ring in rings {
        face.loops.push(close(ring, &grid, &mut notes)?);
        for (curve, edge) in &ring.curves {
            match edge {
                Beside::Curve(edge) => gap = gap.max(distance(curve, &grid, edge)),
                Beside::Unknown => notes.push("a trim whose edge has no spline to compare with".into()),
                Beside::Nothing => {}
            }
        }
    }
    notes.extend(crossing_note(&face.loops));
    Ok(Built { face, notes, gap })
}

/// The spline of a curve in `(u, v)`. Rounding may tear a curve that is joined of several.
fn splines(geometry: &PcurveGeometry) -> Result<Vec<BSpline<DVec3>>, String> {
    let PcurveGeometry::Nurbs { nurbs } = geometry else { return Err("a curve in (u, v) that is no spline".into()) };
    let rows = nurbs.pole_rows();
    let weights = rows.weights();
    let weight = |i: usize| weights.as_ref().map_or(1.0, |w| w[i]);
    let points = rows.raw_points().into_iter().enumerate();
    let points = points.map(|(i, p)| DVec3::from_point(DVec2::new(p.u, p.v), weight(i))).collect();
    BSpline::pieces(nurbs.degree() as usize, nurbs.knots().as_slice().to_vec(), points).map_err(|e| e.to_string())
}

/// The surface, and whether its stated normal is against `S_u x S_v`.
fn spline_of(
    geometry: &SolvedSurfaceGeometry,
    trims: impl Iterator<Item = DVec2>,
) -> Result<(Surface, SurfaceKind, bool), String> {
    match geometry {
        SolvedSurfaceGeometry::Nurbs(nurbs) => Ok((tensor(nurbs)?, SurfaceKind::BSpline, nurbs.normal_reversed())),
        SolvedSurfaceGeometry::Plane(plane) => {
            let (lo, hi) = trims.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
            let vector = |v: cadmpeg_ir::math::Vector3| DVec3::new(v.x, v.y, v.z);
            let o = plane.origin().get();
            let z = vector((*plane.frame().axis()).into());
            let x = vector((*plane.frame().reference()).into());
            let y = z.cross(x);
            let at = |u: f64, v: f64| (DVec3::new(o.x, o.y, o.z) + x * u + y * v).extend(1.0);
            let points = vec![at(lo.x, lo.y), at(hi.x, lo.y), at(lo.x, hi.y), at(hi.x, hi.y)];
            let surface = Surface::new((1, 1), vec![lo.x, lo.x, hi.x, hi.x], vec![lo.y, lo.y, hi.y, hi.y], points);
            Ok((surface.map_err(|e| e.to_string())?, SurfaceKind::Plane, false))
        }
        _ => Err("a surface of another kind than spline and plane".into()),
    }
}

/// A turned curve over its angle instead of a parameter that is linear in it, and how angles become its parameters.
fn by_angle(surface: &Surface, [from, to]: [f64; 2], along_v: bool) -> Result<(Surface, Map), String> {
    let (along_u, other) = surface.knots();
    let (domain_u, domain_v) = surface.domain();
    let (knots, (low, high)) = if along_v { (other, domain_v) } else { (along_u, domain_u) };
    let angle = |t: &f64| if *t == high { to } else { from + (t - low) / (high - low) * (to - from) };
    let turned: Vec<f64> = knots.iter().map(angle).collect();
    let mut angles = turned.clone();
    angles.dedup();
    let knots = if along_v { (along_u.to_vec(), turned) } else { (turned, other.to_vec()) };
    let surface = Surface::new(surface.degrees(), knots.0, knots.1, surface.points().to_vec());
    Ok((surface.map_err(|e| e.to_string())?, Map::Angle { along_v, from: [low, high], angles }))
}

/// A curve in `(u, v)` as one in space, at height 0.
fn raised(curve: &BSpline<DVec3>) -> Result<BSpline<DVec4>, String> {
    let points = curve.points().iter().map(|p| DVec4::new(p.x, p.y, 0.0, p.z)).collect();
    BSpline::new(curve.degree(), curve.knots().to_vec(), points).map_err(|e| e.to_string())
}

fn tensor(nurbs: &NurbsSurface) -> Result<Surface, String> {
    let (count_u, count_v) = (nurbs.u_count(), nurbs.v_count());
    let point = |i: usize, j: usize| {
        let p = nurbs.pole(i, j)?.get();
        Some(DVec4::from_point(DVec3::new(p.x, p.y, p.z), nurbs.weight(i, j).map_or(1.0, |w| w.get())))
    };
    let net = (0..count_v).flat_map(|j| (0..count_u).map(move |i| (i, j)));
    let net = net.map(|(i, j)| point(i, j)).collect::<Option<Vec<_>>>().ok_or("a control net with holes")?;
    let knots = |k: &cadmpeg_ir::geometry::nurbs::KnotVector| k.as_slice().to_vec();
    let degrees = (nurbs.u_degree() as usize, nurbs.v_degree() as usize);
    joined::surface(degrees, (knots(nurbs.u_knots()), knots(nurbs.v_knots())), net).map_err(|e| e.to_string())
}

/// The loop; gaps are closed where the ends are one point in space.
fn close(ring: &Ring, grid: &PatchGrid, notes: &mut Vec<String>) -> Result<TrimLoop, String> {
    let curves = ring.curves.iter().flat_map(|(curve, _)| curve.beziers());
    let pieces: Vec<Bezier<DVec3>> = curves.map(|span| span.piece).collect();
    chain(&pieces, ring.hole, notes, |a, b, _| (grid.point(a.x, a.y) - grid.point(b.x, b.y)).length() <= MEET)
}

/// Largest distance of the image of a trim from the curve of its edge, at a few of its points.
fn distance(trim: &BSpline<DVec3>, grid: &PatchGrid, edge: &BSpline<DVec4>) -> f64 {
    let (a, b) = trim.domain();
    let at = |i: usize| trim.point(a + (b - a) * i as f64 / (COMPARED - 1) as f64);
    (0..COMPARED).map(at).map(|p| off(edge, grid.point(p.x, p.y))).fold(0.0, f64::max)
}

/// Distance of a point from a curve.
fn off(curve: &BSpline<DVec4>, p: DVec3) -> f64 {
    (curve.point(nearest(curve, p)) - p).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::arc::revolve;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Half a cylinder of radius 5 and height 2 over the parameters 3 to 5, and a helix that is a line in them.
    #[test]
    fn lines_on_a_turned_curve_are_helices() {
        let ends = [DVec4::new(5.0, 0.0, 0.0, 1.0), DVec4::new(5.0, 0.0, 2.0, 1.0)];
        let profile = (1, vec![0.0, 0.0, 1.0, 1.0], &ends[..]);
        let stated =
            revolve(profile, (DVec3::ZERO, DVec3::Z), &[3.0, 4.0, 5.0].map(|t| (t - 3.0) * FRAC_PI_2)).unwrap();
        let stretched = |k: &f64| 3.0 + k / FRAC_PI_2;
        let knots_u = stated.knots().0.iter().map(stretched).collect();
        let stated =
            Surface::new(stated.degrees(), knots_u, stated.knots().1.to_vec(), stated.points().to_vec()).unwrap();
        let line = |swap: bool| {
            let at = |u: f64, v: f64| if swap { DVec3::new(v, u, 1.0) } else { DVec3::new(u, v, 1.0) };
            BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![at(3.1, 0.1), at(4.7, 0.9)]).unwrap()
        };
        for (surface, along_v) in [(stated.clone(), false), (stated.transposed(), true)] {
            let (surface, map) = by_angle(&surface, [0.0, PI], along_v).unwrap();
            let grid = surface.patches();
            let helix = map.curve(&raised(&line(along_v)).unwrap()).unwrap();
            for k in 0..=64 {
                let share = f64::from(k) / 64.0;
                let p = helix.point(share);
                let point = grid.point(p.x, p.y);
                let angle = (0.1 + 1.6 * share) * FRAC_PI_2;
                let wanted = DVec3::new(5.0 * angle.cos(), 5.0 * angle.sin(), 2.0 * (0.1 + 0.8 * share));
                assert!(point.distance(wanted) < 1e-12, "{k}: {point}, not {wanted}");
            }
            // the spline's own parameter is another one
            let p = line(along_v).point(0.1);
            let own = stated.patches();
            let off = if along_v { own.point(p.y, p.x) } else { own.point(p.x, p.y) };
            assert!(off.distance(grid.point(helix.point(0.1).x, helix.point(0.1).y)) > 0.01);
        }
    }
}
