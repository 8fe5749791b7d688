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

use super::super::{ExportError, ExportWarning, Item};
use super::text::{Id, List, Text};
use super::{Colours, style};
use crate::edges::{LOOSE, REACH, Sheet};
use crate::model::{Bounds, Edges, Face, Part};
use crate::spline::{BSpline, SplineError, arc};
use crate::trim::LoopIndex;
use glam::{DVec2, DVec3};
use std::io::Write;

/// Samples along each side of a patch, for the sign of a volume.
const SAMPLES: u32 = 8;

/// What a part became.
pub(super) struct Shape {
    pub items: Vec<Id>,
    pub solid: bool,
    /// Largest distance of a curve from the one it approximates, mm.
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
    let out = part.edges().map_err(|e| face_error((e.face, e.source)))?;
    for &(face, lost) in &out.lost {
        let (id, reach) = (part.faces[face].id, out.reach);
        let message = format!("face {id}: {lost} loops within {reach:e} mm of a point were left out");
        warnings.push(ExportWarning { item, message });
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
        let (degree, knots, points) = arc::assemble(&edge.curve);
        let space = BSpline::new(degree, knots, points).map_err(|e| face_error((edge.uses[0].face, e)))?;
        let (a, b) = space.domain();
        let curve = text.space_curve(&space)?;
        let mut flats = Vec::new();
        // more than two p-curves cannot be stated
        for used in edge.uses.iter().take(2) {
            let sheet = &sheets[used.face];
            let fault = |e| face_error((used.face, e));
            let mut flat = sheet.in_plane(&sheet.along(used, out.reach)).map_err(fault)?;
            flat = if used.forward { flat } else { flat.reversed() };
            flat = flat.over(a, b).map_err(fault)?;
            if let (Some([_, du, dv]), Some(frame)) = (sheet.plane, frames[used.face]) {
                flat = mapped(&flat, du, dv, frame).map_err(fault)?;
            }
            let flat = text.flat_curve(&flat)?;
            let definition = text.add(format_args!("DEFINITIONAL_REPRESENTATION('',({flat}),{plane})"))?;
            flats.push(text.add(format_args!("PCURVE('',{},{definition})", surfaces[used.face]))?);
        }
        let seam = edge.uses.get(1).is_some_and(|second| second.face == edge.uses[0].face);
        let kind = if seam { "SEAM_CURVE" } else { "SURFACE_CURVE" };
        let curve = text.add(format_args!("{kind}('',{curve},{},.CURVE_3D.)", List(&flats)))?;
        let [start, end] = edge.ends.map(|v| vertices[v]);
        edges.push(text.add(format_args!("EDGE_CURVE('',{start},{end},{curve},.T.)"))?);
    }
    let loops = loops(part.faces.len(), &out);
    let mut faces = Vec::new();
    for (i, face) in part.faces.iter().enumerate() {
        let mut bounds = Vec::new();
        for l in &loops[i] {
            let mut uses = Vec::new();
            for &(edge, forward) in l {
                uses.push(text.add(format_args!("ORIENTED_EDGE('',*,*,{},{})", edges[edge], flag(forward)))?);
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
            "{} of {} edges have not two faces within {:e} mm: written as an open shell",
            out.edges.iter().filter(|e| e.uses.len() != 2).count(),
            out.edges.len(),
            LOOSE * size
        );
        warnings.push(ExportWarning { item, message });
    } else if out.deviation > REACH * size {
        let message = format!("edges up to {:.1e} mm apart were joined", out.deviation);
        warnings.push(ExportWarning { item, message });
    }
    let solid = part.closed && closed;
    let items = shells(text, &part.name, &sheets, &out, &faces, solid)?;
    Ok(Shape { items, solid, deviation: out.deviation.max(1e-9 * size) })
}

/// The loops of each face: edges in order, and whether the loop runs along them.
fn loops(faces: usize, out: &Edges) -> Vec<Vec<Vec<(usize, bool)>>> {
    let uses = out.edges.iter().enumerate().flat_map(|(k, e)| e.uses.iter().map(move |u| (u, k)));
    let mut all: Vec<_> = uses.collect();
    all.sort_by(|(a, _), (b, _)| {
        (a.face, a.trim_loop).cmp(&(b.face, b.trim_loop)).then(a.range.0.total_cmp(&b.range.0))
    });
    let mut loops = vec![Vec::new(); faces];
    for same in all.chunk_by(|(a, _), (b, _)| (a.face, a.trim_loop) == (b.face, b.trim_loop)) {
        loops[same[0].0.face].push(same.iter().map(|(u, edge)| (*edge, u.forward)).collect());
    }
    loops
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
    out: &Edges,
    faces: &[Id],
    solid: bool,
) -> Result<Vec<Id>, ExportError> {
    let name = super::text::Quoted(name);
    let mut groups = Vec::new();
    for group in connected(faces.len(), out) {
        let ids: Vec<Id> = group.iter().map(|&f| faces[f]).collect();
        let closed = out.edges.iter().all(|e| e.uses.len() == 2 || !group.contains(&e.uses[0].face));
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
fn connected(count: usize, out: &Edges) -> Vec<Vec<usize>> {
    let mut up: Vec<usize> = (0..count).collect();
    fn root(up: &mut [usize], mut f: usize) -> usize {
        while up[f] != f {
            up[f] = up[up[f]];
            f = up[f];
        }
        f
    }
    for pair in out.edges.iter().flat_map(|e| e.uses.windows(2)) {
        let (a, b) = (root(&mut up, pair[0].face), root(&mut up, pair[1].face));
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
