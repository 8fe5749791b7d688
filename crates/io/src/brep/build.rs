//! Builds one face: from a surface, edges in space and a tolerance to a trimmed spline surface.

use super::carrier::CarrierError;
use super::edge::EdgeCurve;
use super::fit::Fitter;
use super::lines::Lines;
use super::loops::{Limits, Loop};
use super::nest::{Directions, arrange, come_home};
use super::order;
use super::preimage::{tips_beside, widen_poles};
use super::rims::natural_border;
use super::strand::{Part, Strand};
use super::support::Support;
use super::{Boundary, BuildError, Edge, FaceGeometry};
use crate::model::{Bounds, EdgeRef, Face, TrimLoop};
use crate::spline::{Bezier, Control};
use crate::trim::{Crossing, crossing};
use glam::{DVec2, DVec3};
use std::rc::Rc;

/// A face, with the notes and errors of building it.
#[derive(Clone, Debug)]
pub struct BuiltFace {
    /// The face. Its carrier is tight around its loops (a B-spline is kept whole). In a face built from edges, each
    /// trim curve names its edge by the index in the list of edges.
    pub face: Face,
    /// What was repaired or is ambiguous, with lengths in mm.
    pub notes: Vec<String>,
    /// Largest distance in mm, on the surface, of a trim curve from the pre-image of its edge: the error of fitting,
    /// straightening and joining.
    pub deviation: f64,
    /// Largest distance in mm of an edge from the surface, as the source states both. No point of a trim curve is
    /// farther from its edge than `deviation + gap`.
    pub gap: f64,
    /// Loops of the source that the face lacks, and why: its holes are filled, or its borders missing.
    pub lost: Vec<String>,
}

/// Share of the tolerance that a fit may take, and a joint: each counts up to 1.25 times, the second along both axes.
const SHARE: f64 = 0.25;

/// Turns of a helical strip that a carrier may cover; only nonsense has more.
const MAX_TURNS: f64 = 1e4;

/// Builds the carrier and the trim loops of one face.
///
/// `tolerance` is the source's length tolerance in mm, clamped to between `1e-9` and `1e-5` of the face's diagonal.
/// Vertices and poles within it are the same. Trim curves, fitted or replaced by lines of constant parameter, follow
/// the pre-image of their edge to a hundredth of it. That target is at most `1e-7` of the diagonal, and at least `1e-9`
/// of it or a quarter of the tolerance, whichever is less. At `1e-7` a face 4000 pixels wide is right to half a pixel
/// when enlarged a thousand times, and a tighter fit would only follow the noise of most files. For an edge that does
/// not lie on the surface, its distance from the surface replaces the tolerance where it is larger.
///
/// # Errors
/// [`BuildError`] names the face or edge and the reason.
pub fn build_face(face: &FaceGeometry, edges: &[Edge], tolerance: f64) -> Result<BuiltFace, BuildError> {
    match build(face, edges, tolerance, false) {
        // edges that end beside a tip of the surface leave a rim open: let them end at the tip
        open @ Err(BuildError::OpenRim { .. }) => build(face, edges, tolerance, true).or(open),
        built => built,
    }
}

/// `beside`: edges that end beside a tip of the surface count as ending at it.
fn build(face: &FaceGeometry, edges: &[Edge], tolerance: f64, beside: bool) -> Result<BuiltFace, BuildError> {
    let tolerance = if tolerance > 0.0 && tolerance.is_finite() { tolerance } else { 1e-6 };
    let mut notes = Vec::new();
    let mut uses = edge_uses(face, edges)?;
    let size = uses.iter().flatten().fold(Bounds::EMPTY, |all, e| all.union(e.bounds)).diagonal();
    let eps = if size > 0.0 { tolerance.clamp(1e-9 * size, 1e-5 * size) } else { tolerance };
    let named = |reason| BuildError::Surface { face: face.id, reason };
    let mut support = Support::new(&face.surface, eps).map_err(named)?;
    if size > 0.0 {
        // what is fitted and what is moved together stay within the tolerance, where rounding lets them
        let share = (SHARE * tolerance).max(1e-12 * size);
        support.target = (1e-2 * tolerance).clamp(share.min(1e-9 * size), 1e-7 * size);
        support.pull = (10.0 * support.target).min(share);
        support.noise = 1e-7 * size;
    }
    uses.iter_mut().for_each(|bound| bound.retain(|e| e.length > support.target));
    widen_poles(&mut support, &uses, (face.id, size), &mut notes);
    if beside {
        tips_beside(&mut support, &uses, (face.id, size), &mut notes);
    }
    let mut lost = lost(face, edges, &uses, &support);
    support.allow(uses.iter().flatten().map(|e| e.node_count).sum());
    let limits = Limits { face: face.id, size };

    let vertices: Vec<usize> = face
        .bounds
        .iter()
        .filter_map(|b| match b {
            Boundary::Vertex(p) => support.pole_at(*p, 50.0 * eps),
            Boundary::Edges(_) | Boundary::Natural => None,
        })
        .collect();
    let mut loops = Vec::new();
    let mut lines = Lines::default();
    let mut hint = None;
    let mut ambiguous = face.ambiguous;
    for bound in uses {
        let mut strands = Vec::new();
        let (bound, turned) = order::sort(bound, face.id, eps, &mut notes);
        ambiguous |= turned;
        for edge in bound {
            let more = Strand::of_edge(&support, &Rc::new(edge), hint, &mut lines);
            hint = more.last().map(|s| s.end).or(hint);
            strands.extend(more);
        }
        if !strands.is_empty() {
            loops.push(Loop::close(&support, strands, limits, &mut notes)?);
        }
    }
    let natural = face.bounds.contains(&Boundary::Natural);
    if natural || (loops.is_empty() && support.window.is_some()) {
        let border = natural_border(&support, &loops).ok_or(BuildError::Unbounded { face: face.id })?;
        loops.extend(border);
    }
    let gap = gaps(&loops, eps, size, &mut notes);
    if loops.is_empty() && !lost.is_empty() {
        return Err(BuildError::EmptyLoop { face: face.id });
    }
    if loops.is_empty() {
        return whole(face, &support, notes);
    }
    let directions = if ambiguous { Directions::Ambiguous(&mut notes) } else { Directions::Sound };
    let loops = arrange(&support, loops, &vertices, limits, directions)?;
    let (loops, range) = come_home(&support, loops);
    if !(0..2).all(|i| range[i].1 > range[i].0 && (range[i].1 - range[i].0).is_finite()) {
        return Err(BuildError::NoArea { face: face.id });
    }
    let turns = |i: usize| support.periods[i].map_or(0.0, |period| (range[i].1 - range[i].0) / period);
    if turns(0).max(turns(1)) > MAX_TURNS {
        return Err(BuildError::Winding { face: face.id, u: turns(0) as i32, v: turns(1) as i32 });
    }
    let carrier = support.carrier(range).map_err(|e| carrier_error(face.id, e))?;
    let fitter = Fitter { support: &support, carrier: &carrier };
    let mut deviation: f64 = 0.0;
    let mut trims = Vec::new();
    // joints are equal up to rounding; sides a period apart too
    let snap = DVec2::new(range[0].1 - range[0].0, range[1].1 - range[1].0) * 1e-7;
    for l in &loops {
        let mut curves: Vec<(Bezier<DVec3>, Option<EdgeRef>)> = Vec::new();
        for strand in &l.strands {
            let fitted = fitter.curves(strand);
            deviation = deviation.max(fitted.deviation);
            let edge = strand.part.as_ref().map(Part::edge);
            curves.extend(fitted.curves.into_iter().map(|c| (c, edge)));
        }
        curves.retain(|(c, _)| c.degree() > 1 || c.points[0].point() != c.points[1].point());
        let (curves, edges) = curves.into_iter().unzip();
        let trim = TrimLoop::new(curves, snap).and_then(|trim| trim.with_edges(edges));
        let trim = trim.map_err(|source| BuildError::Loop { face: face.id, source })?;
        if trim.signed_area().abs() <= 1e-12 * (range[0].1 - range[0].0) * (range[1].1 - range[1].0) {
            lost.push(format!("face #{}: a loop without area was left out", face.id));
            continue;
        }
        trims.push(trim);
    }
    if trims.is_empty() {
        return Err(BuildError::NoArea { face: face.id });
    }
    notes.extend(crossing_note(&trims).map(|note| format!("face #{}: {note}", face.id)));
    if support.exhausted() {
        notes.push(format!("face #{}: its edges are followed loosely, so far are they from its surface", face.id));
    }
    let face = Face {
        id: face.id,
        kind: support.kind(),
        surface: carrier.surface,
        loops: trims,
        same_sense: face.same_sense,
        colour: None,
    };
    Ok(BuiltFace { face, notes, deviation, gap, lost })
}

/// A note on loops that cross. Points within two loops, or within a hole alone, follow the non-zero rule.
pub fn crossing_note(loops: &[TrimLoop]) -> Option<String> {
    match crossing(loops) {
        Crossing::No => None,
        Crossing::At(p) => Some(format!("trim loops cross near ({:e}, {:e}) in (u, v)", p.x, p.y)),
        Crossing::Unknown => Some("too many trim curves lie beside each other to tell whether they cross".into()),
    }
}

/// The bounds that have no edge left. A bound at a pole is none of them: it says only that the face reaches the pole.
fn lost(face: &FaceGeometry, edges: &[Edge], uses: &[Vec<EdgeCurve>], support: &Support) -> Vec<String> {
    let lists = face.bounds.iter().filter_map(|b| match b {
        Boundary::Edges(list) => Some(list),
        Boundary::Vertex(_) | Boundary::Natural => None,
    });
    let at_pole = |list: &[(usize, bool)]| {
        let pole = |(index, _): &(usize, bool)| support.pole_at(edges[*index].start, 50.0 * support.eps);
        list.first().is_some_and(|first| pole(first).is_some() && list.iter().all(|e| pole(e) == pole(first)))
    };
    let empty = lists.zip(uses).filter(|(list, uses)| uses.is_empty() && !at_pole(list));
    let note = |(list, _): (&Vec<(usize, bool)>, _)| {
        let edge = list.first().map_or(String::new(), |(index, _)| format!(", edge #{},", edges[*index].id));
        format!("face #{}: a loop without length{edge} was left out", face.id)
    };
    empty.map(note).collect()
}

/// The edges of each bound, without those that have no length.
fn edge_uses(face: &FaceGeometry, edges: &[Edge]) -> Result<Vec<Vec<EdgeCurve>>, BuildError> {
    let lists = face.bounds.iter().filter_map(|b| match b {
        Boundary::Edges(list) => Some(list),
        Boundary::Vertex(_) | Boundary::Natural => None,
    });
    let ends = lists.flatten().filter_map(|(index, _)| edges.get(*index)).flat_map(|e| [e.start, e.end]);
    // rounding of the vertices' coordinates, before anything is known about the face
    let reach = ends.clone().map(DVec3::length).fold(0.0, f64::max);
    let rounding = 1e-12 * ends.fold(Bounds::EMPTY, Bounds::with).diagonal().max(1e-3 * reach);
    let of_bound = |bound: &Boundary| match bound {
        Boundary::Edges(list) => Some(EdgeCurve::of_bound(list, edges, face.id, rounding)),
        Boundary::Vertex(_) | Boundary::Natural => None,
    };
    face.bounds.iter().filter_map(of_bound).collect()
}

/// The largest distance of an edge from the surface; names edges that lie farther off than a sound
/// file's would.
fn gaps(loops: &[Loop], eps: f64, size: f64, notes: &mut Vec<String>) -> f64 {
    let limit = (50.0 * eps).min(1e-2 * size);
    let mut largest: f64 = 0.0;
    for part in loops.iter().flat_map(|l| &l.strands).filter_map(|s| s.part.as_ref()) {
        largest = largest.max(part.trace.gap);
        if part.trace.gap > limit {
            let (id, gap) = (part.trace.edge.id, part.trace.gap);
            notes.push(format!("edge #{id} lies {gap:.3e} mm off its surface"));
        }
    }
    largest
}

/// A closed surface without loops.
fn whole(face: &FaceGeometry, support: &Support, notes: Vec<String>) -> Result<BuiltFace, BuildError> {
    let spline = matches!(support.form, super::support::Form::Spline(_));
    let ([Some(u), Some(v)], true) = (support.natural, spline || support.is_closed()) else {
        return Err(BuildError::Unbounded { face: face.id });
    };
    let carrier = support.carrier([u, v]).map_err(|e| carrier_error(face.id, e))?;
    let face = Face {
        id: face.id,
        kind: support.kind(),
        surface: carrier.surface,
        loops: Vec::new(),
        same_sense: face.same_sense,
        colour: None,
    };
    Ok(BuiltFace { face, notes, deviation: 0.0, gap: 0.0, lost: Vec::new() })
}

fn carrier_error(face: u32, e: CarrierError) -> BuildError {
    match e {
        CarrierError::Seam => BuildError::Surface { face, reason: "its weights forbid moving the seam" },
        CarrierError::Spline(source) => BuildError::Carrier { face, source },
    }
}
