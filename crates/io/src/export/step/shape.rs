//! A part as solids or shells.
//!
//! ```text
//!   MANIFOLD_SOLID_BREP ▶ CLOSED_SHELL ▶ ADVANCED_FACE ▶ FACE_BOUND ▶ EDGE_LOOP ▶ ORIENTED_EDGE
//!                                           │                                        │
//!                                        surface ◀── PCURVE ── SURFACE_CURVE ◀── EDGE_CURVE
//! ```
//!
//! Faces that share edges form a shell. A shell whose every edge has two faces is closed; in a part that bounds a
//! volume one of negative volume is a void of the smallest shell around it.

use super::super::boundary::Sheet;
use super::super::join::{Boundaries, Edge, join};
use super::super::{ExportError, ExportWarning, Item};
use super::text::{Id, List, Text};
use super::{Colours, style};
use crate::model::{Bounds, Face, Part};
use crate::spline::{BSpline, SplineError};
use crate::trim::LoopIndex;
use glam::{DVec2, DVec3};
use std::io::Write;

/// Points that are the same, in shares of the part's diagonal.
const JOIN: f64 = 1e-5;
/// The same for parts that bound a volume but whose edges do not meet, in turn.
const RETRIED: [f64; 2] = [1e-5, 4e-5];
/// Of those, how far apart edges may lie that nothing else meets: a few times what is found in sloppy files.
const LOOSE: f64 = 2e-4;
/// Aim of fitted curves, in shares of the part's diagonal.
const FIT: f64 = 1e-8;
/// Samples along each side of a patch, for the sign of a volume.
const SAMPLES: u32 = 8;

/// What a part became.
pub(super) struct Shape {
    pub items: Vec<Id>,
    pub solid: bool,
    /// Largest distance of a curve from what it stands for, mm.
    pub deviation: f64,
}

/// Writes one part.
pub(super) fn shape<W: Write>(
    text: &mut Text<W>,
    part: &Part,
    item: Item,
    colours: &mut Colours,
    warnings: &mut Vec<ExportWarning>,
) -> Result<Shape, ExportError> {
    let sheets: Vec<Sheet> = part.faces.iter().map(Sheet::new).collect();
    let size = part.faces.iter().map(Face::control_bounds).fold(Bounds::EMPTY, Bounds::union).diagonal();
    let face_error =
        |(face, source): (usize, SplineError)| ExportError::Face { item, face: part.faces[face].id, source };
    let mut out = join(&sheets, JOIN * size, FIT * size).map_err(face_error)?;
    for reach in if part.closed { &RETRIED[..] } else { &[] } {
        if out.closed() {
            break;
        }
        let mut other = join(&sheets, reach * size, FIT * size).map_err(face_error)?;
        other.mend(LOOSE * size);
        // a reach that swallows a loop is too wide
        let same = out.loops.iter().zip(&other.loops).all(|(a, b)| a.len() == b.len());
        if same && other.single() < out.single() {
            out = other;
        }
    }
    for (sheet, kept) in sheets.iter().zip(&out.loops) {
        let lost = sheet.face.loops.len().saturating_sub(kept.len());
        if lost > 0 {
            let message =
                format!("face {}: {lost} loops within {:e} mm of a point were left out", sheet.face.id, JOIN * size);
            warnings.push(ExportWarning { item, message });
        }
    }
    let frames: Vec<Option<[DVec3; 3]>> = sheets.iter().map(|s| s.plane.map(frame)).collect();
    let mut surfaces = Vec::new();
    for (sheet, frame) in sheets.iter().zip(&frames) {
        surfaces.push(match (sheet.plane, frame) {
            (Some([origin, ..]), Some([x, _, z])) => {
                let at = text.placement(origin, *z, *x)?;
                text.add(format_args!("PLANE('',{at})"))?
            }
            _ => text.surface(&sheet.face.surface)?,
        });
    }
    let mut vertices = Vec::new();
    for p in &out.vertices {
        let p = text.point(*p)?;
        vertices.push(text.add(format_args!("VERTEX_POINT('',{p})"))?);
    }
    let plane = text.add(format_args!(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()REPRESENTATION_CONTEXT('',''))"
    ))?;
    let mut edges = Vec::new();
    for edge in &out.edges {
        let first = &out.stretches[edge.first];
        let (a, b) = first.both.space.domain();
        let curve = text.space_curve(&first.both.space)?;
        let opposite = out.opposite(edge);
        let mut flats = Vec::new();
        for s in [Some(edge.first), edge.second].into_iter().flatten() {
            let s_face = out.stretches[s].face;
            let mut flat = out.stretches[s].both.flat.clone();
            if s != edge.first {
                flat = if opposite { flat.reversed() } else { flat };
                flat = flat.over(a, b).map_err(|e| face_error((s_face, e)))?;
            }
            if let (Some([_, du, dv]), Some(frame)) = (sheets[s_face].plane, frames[s_face]) {
                flat = mapped(&flat, du, dv, frame).map_err(|e| face_error((s_face, e)))?;
            }
            let flat = text.flat_curve(&flat)?;
            let definition = text.add(format_args!("DEFINITIONAL_REPRESENTATION('',({flat}),{plane})"))?;
            flats.push(text.add(format_args!("PCURVE('',{},{definition})", surfaces[s_face]))?);
        }
        let seam = edge.second.is_some_and(|s| out.stretches[s].face == first.face);
        let kind = if seam { "SEAM_CURVE" } else { "SURFACE_CURVE" };
        let curve = text.add(format_args!("{kind}('',{curve},{},.CURVE_3D.)", List(&flats)))?;
        let [start, end] = first.ends.map(|v| vertices[v]);
        edges.push(text.add(format_args!("EDGE_CURVE('',{start},{end},{curve},.T.)"))?);
    }
    let mut faces = Vec::new();
    for (i, face) in part.faces.iter().enumerate() {
        let mut bounds = Vec::new();
        for l in &out.loops[i] {
            let mut uses = Vec::new();
            for &s in l {
                let e = out.edge_of[s];
                let forward = out.edges[e].first == s || !out.opposite(&out.edges[e]);
                uses.push(text.add(format_args!("ORIENTED_EDGE('',*,*,{},{})", edges[e], flag(forward)))?);
            }
            let chain = text.add(format_args!("EDGE_LOOP('',{})", List(&uses)))?;
            // loops run about the surface's normal, bounds about the face's
            bounds.push(text.add(format_args!("FACE_BOUND('',{chain},{})", flag(face.same_sense)))?);
        }
        let (bounds, sense) = (List(&bounds), flag(face.same_sense));
        let id = text.add(format_args!("ADVANCED_FACE('',{bounds},{},{sense})", surfaces[i]))?;
        faces.push(id);
        if let Some(colour) = face.colour {
            style(text, colours, id, colour)?;
        }
    }
    let closed = out.closed();
    if part.closed && !closed {
        let message = format!(
            "{} of {} edges have one face only within {:e} mm: written as an open shell",
            out.single(),
            out.edges.len(),
            LOOSE * size
        );
        warnings.push(ExportWarning { item, message });
    } else if out.deviation > JOIN * size {
        let message = format!("edges up to {:.1e} mm apart were joined", out.deviation);
        warnings.push(ExportWarning { item, message });
    }
    let solid = part.closed && closed;
    let items = shells(text, &part.name, &sheets, &out, &faces, solid)?;
    Ok(Shape { items, solid, deviation: out.deviation.max(1e-9 * size) })
}

fn flag(yes: bool) -> &'static str {
    if yes { ".T." } else { ".F." }
}

/// Unit x, y and z axes of the plane with derivatives `a` and `b`.
fn frame([_, a, b]: [DVec3; 3]) -> [DVec3; 3] {
    let (x, z) = (a.normalize(), a.cross(b).normalize());
    [x, z.cross(x), z]
}

/// A curve in `(u, v)` as one in the plane's own lengths.
fn mapped(c: &BSpline<DVec3>, a: DVec3, b: DVec3, [x, y, _]: [DVec3; 3]) -> Result<BSpline<DVec3>, SplineError> {
    let map = |p: &DVec3| (DVec2::new(a.dot(x), a.dot(y)) * p.x + DVec2::new(b.dot(x), b.dot(y)) * p.y).extend(p.z);
    BSpline::new(c.degree(), c.knots().to_vec(), c.points().iter().map(map).collect())
}

/// Faces in groups that share edges, as solids or as one surface model.
fn shells<W: Write>(
    text: &mut Text<W>,
    name: &str,
    sheets: &[Sheet],
    out: &Boundaries,
    faces: &[Id],
    solid: bool,
) -> Result<Vec<Id>, ExportError> {
    let name = super::text::Quoted(name);
    let mut groups = Vec::new();
    for group in connected(faces.len(), &out.edges, out) {
        let ids: Vec<Id> = group.iter().map(|&f| faces[f]).collect();
        let closed = out.edges.iter().all(|e| e.second.is_some() || !group.contains(&out.stretches[e.first].face));
        let kind = if closed { "CLOSED_SHELL" } else { "OPEN_SHELL" };
        let id = text.add(format_args!("{kind}('',{})", List(&ids)))?;
        let bounds = group.iter().map(|&f| sheets[f].face.control_bounds()).fold(Bounds::EMPTY, Bounds::union);
        let volume = group.iter().map(|&f| volume(&sheets[f], bounds.centre())).sum::<f64>();
        groups.push((id, bounds, volume, Vec::new()));
    }
    if !solid {
        let ids: Vec<Id> = groups.iter().map(|g| g.0).collect();
        return Ok(vec![text.add(format_args!("SHELL_BASED_SURFACE_MODEL({name},{})", List(&ids)))?]);
    }
    let (mut outer, voids): (Vec<_>, Vec<_>) = groups.into_iter().partition(|g| g.2 >= 0.0);
    for void in voids {
        let around = outer.iter_mut().filter(|o| {
            let slack = 1e-9 * o.1.diagonal();
            o.1.min.cmple(void.1.min + slack).all() && o.1.max.cmpge(void.1.max - slack).all()
        });
        match around.min_by(|a, b| a.1.diagonal().total_cmp(&b.1.diagonal())) {
            Some(shell) => shell.3.push(void.0),
            None => outer.push(void), // inside out: kept as it is
        }
    }
    let mut items = Vec::new();
    for (shell, _, _, voids) in outer {
        let mut turned = Vec::new();
        for v in voids {
            turned.push(text.add(format_args!("ORIENTED_CLOSED_SHELL('',*,{v},.T.)"))?);
        }
        items.push(if turned.is_empty() {
            text.add(format_args!("MANIFOLD_SOLID_BREP({name},{shell})"))?
        } else {
            text.add(format_args!("BREP_WITH_VOIDS({name},{shell},{})", List(&turned)))?
        });
    }
    Ok(items)
}

/// Groups of faces, each in order, by union over shared edges.
fn connected(count: usize, edges: &[Edge], out: &Boundaries) -> Vec<Vec<usize>> {
    let mut up: Vec<usize> = (0..count).collect();
    fn root(up: &mut [usize], mut f: usize) -> usize {
        while up[f] != f {
            up[f] = up[up[f]];
            f = up[f];
        }
        f
    }
    for e in edges {
        let Some(second) = e.second else { continue };
        let (a, b) = (root(&mut up, out.stretches[e.first].face), root(&mut up, out.stretches[second].face));
        let (a, b) = (a.min(b), a.max(b));
        up[b] = a;
    }
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); count];
    for f in 0..count {
        groups[root(&mut up, f)].push(f);
    }
    groups.retain(|g| !g.is_empty());
    groups
}

/// The face's share of the volume about `centre`, from samples: good for a sign.
fn volume(sheet: &Sheet, centre: DVec3) -> f64 {
    let index = LoopIndex::new(&sheet.face.loops);
    let mut sum = 0.0;
    for p in &sheet.grid.patches {
        for k in 0..SAMPLES * SAMPLES {
            let [s, t] = [k % SAMPLES, k / SAMPLES].map(|i| (f64::from(i) + 0.5) / f64::from(SAMPLES));
            let uv = DVec2::new(p.u.0 + (p.u.1 - p.u.0) * s, p.v.0 + (p.v.1 - p.v.0) * t);
            if sheet.face.loops.is_empty() || index.contains(uv) {
                let jet = p.patch.jet(s, t);
                sum += (jet.point - centre).dot(jet.du.cross(jet.dv));
            }
        }
    }
    if sheet.face.same_sense { sum } else { -sum }
}
