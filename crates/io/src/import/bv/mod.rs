//! BezierView `.bv` files: patches and polyhedra, as SurfLab writes them.
//!
//! ```text
//!   group 3 name     colour and name of what follows
//!   5                kind of patch        1 polyhedron: vertices, facets that number them from 0
//!   1 2              degrees              3 triangle: deg, the row of v = 0 first
//!   -2 -2 0          control points       4 square of one degree  5 of two  8 rational: w x w y w z w
//!   …                                     9, 10 triangle and square with a field of normals
//! ```
//!
//! Squares: `deg_u + 1` rows of `deg_v + 1` points. Triangles become the part `u + v <= 1` of a surface of that degree
//! in both directions, see [`triangle_surface`]. The normals of kinds 9 and 10 serve the shading of BezierView; here
//! the surface's own are drawn, so the stated ones are skipped, and counted.
//!
//! The format has neither unit nor colours of its own: a group's number chooses one of [`PALETTE`]. A word where a
//! number should stand ends the reading, since the start of the next patch is then unknown.
//!
//! Source: X. Wu, *BezierViewer Data Format*, SurfLab, University of Florida, 2003.

mod words;

use super::parts::Stated;
use super::{Import, ImportError, ImportReport, Place, Warnings, facets, parts};
use crate::model::{Colour, Face, Mesh, SurfaceKind, TrimLoop};
use crate::spline::{Bezier, Surface, triangle_points, triangle_surface};
use glam::{DVec2, DVec3, DVec4};
use words::{Lost, Words};

/// Colours of groups, in linear light.
pub const PALETTE: [Colour; 8] = [
    [0.60, 0.60, 0.60, 1.0],
    [0.60, 0.07, 0.05, 1.0],
    [0.07, 0.40, 0.09, 1.0],
    [0.06, 0.16, 0.60, 1.0],
    [0.70, 0.45, 0.04, 1.0],
    [0.30, 0.08, 0.50, 1.0],
    [0.04, 0.45, 0.50, 1.0],
    [0.65, 0.22, 0.03, 1.0],
];

/// The text begins with a group.
pub(super) fn recognise(bytes: &[u8]) -> bool {
    let mut words = Words::new(&bytes[..bytes.len().min(1 << 10)]);
    matches!(words.word().as_deref(), Some("group" | "Group")) && words.number::<i64>("").is_ok()
}

/// Reads the text; `name` is the file's name in messages.
pub(super) fn read(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    let report = ImportReport { format: "BezierView".into(), ..ImportReport::default() };
    let mut reader = Reader {
        words: Words::new(bytes),
        warnings: Warnings::new(name),
        report,
        group: String::new(),
        colour: None,
        patches: 0,
        faces: Vec::new(),
        meshes: Vec::new(),
    };
    if let Err(lost) = reader.patches() {
        if reader.patches == 0 {
            return Err(ImportError::Nothing { file: name.to_owned(), format: "BezierView" });
        }
        let Lost { line, why } = lost;
        if reader.report.faces > reader.faces.len() {
            reader.faces.push((reader.group.clone(), Err((reader.patches, why.clone()))));
            reader.report.dropped.add(&why);
        }
        reader.warnings.push("the rest of the file left out", || Place::Line(line), || why);
    }
    let Reader { warnings, mut report, faces, meshes, .. } = reader;
    let model = parts::assemble(name, faces, meshes, &mut report);
    report.bodies = model.parts.len();
    report.occurrences = model.instances.iter().map(|i| i.name.clone()).filter(|n| !n.is_empty()).collect();
    let warnings = warnings.finish(&mut report);
    Ok(Import { model, warnings, report, ..Import::default() })
}

struct Reader<'t> {
    words: Words<'t>,
    warnings: Warnings,
    report: ImportReport,
    group: String,
    colour: Option<Colour>,
    /// Patches and polyhedra begun, the number of the last one.
    patches: u32,
    /// By the name of their group.
    faces: Vec<(String, Stated)>,
    meshes: Vec<(String, Mesh)>,
}

impl Reader<'_> {
    fn patches(&mut self) -> Result<(), Lost> {
        loop {
            let line = self.words.line();
            let Some(word) = self.words.word() else { break };
            if word.eq_ignore_ascii_case("group") {
                let number: i64 = self.words.number("the number of a colour")?;
                self.colour = Some(PALETTE[number.rem_euclid(PALETTE.len() as i64) as usize]);
                self.group = self.words.word().unwrap_or_default();
                // the rest of the line may say how finely the viewer subdivides the group
                self.words.skip_line();
                continue;
            }
            let kind: u32 = word.parse().map_err(|_| Lost { line, why: format!("{word:.20} is no kind of patch") })?;
            if !matches!(kind, 1 | 3 | 4 | 5 | 8 | 9 | 10) {
                return Err(Lost { line, why: format!("{kind} is no kind of patch") });
            }
            self.patches += 1;
            if kind == 1 { self.polyhedron(line)? } else { self.patch(kind, line)? }
        }
        if self.patches == 0 { Err(Lost { line: 1, why: "no patch".into() }) } else { Ok(()) }
    }

    fn patch(&mut self, kind: u32, line: usize) -> Result<(), Lost> {
        self.report.faces += 1;
        let triangle = matches!(kind, 3 | 9);
        let u: usize = self.words.number("a degree")?;
        let v = if matches!(kind, 3 | 4 | 9) { u } else { self.words.number("a degree")? };
        let normals = match kind {
            9 => Some((self.words.number("a degree")?, 0)),
            10 => Some((self.words.number("a degree")?, self.words.number("a degree")?)),
            _ => None,
        };
        let count = |u: usize, v: usize| match triangle {
            // far more than there are words, rather than too few
            true if u < 1 << 16 => triangle_points(u),
            true => usize::MAX,
            false => u.saturating_add(1).saturating_mul(v.saturating_add(1)),
        };
        let points = self.points(count(u, v), if kind == 8 { 4 } else { 3 })?;
        if let Some((nu, nv)) = normals {
            self.points(count(nu, nv), 3)?;
            self.warnings.push("normals not used", || Place::Line(line), || format!("a field of degree {nu}"));
        }
        let surface = if triangle {
            triangle_surface(u, &points)
        } else {
            let knots = |n: usize| [[0.0].repeat(n.min(MAX) + 1), [1.0].repeat(n.min(MAX) + 1)].concat();
            let net = (0..=v).flat_map(|j| (0..=u).map(move |i| (i, j))).map(|(i, j)| points[i * (v + 1) + j]);
            Surface::new((u, v), knots(u), knots(v), net.collect())
        };
        match surface {
            Ok(surface) => {
                let corners = [DVec2::ZERO, DVec2::X, DVec2::Y];
                let sides = (0..3).map(|i| Bezier::line(corners[i], corners[(i + 1) % 3]));
                let whole = || TrimLoop::new(sides.collect(), DVec2::ZERO).expect("three sides are closed");
                let loops = if triangle { vec![whole()] } else { Vec::new() };
                let (id, kind, colour) = (self.patches, SurfaceKind::BSpline, self.colour);
                let face = Face { id, kind, surface, loops, same_sense: true, colour };
                self.faces.push((self.group.clone(), Ok((face, Vec::new()))));
            }
            Err(error) => {
                let why = error.to_string();
                self.report.dropped.add(&why);
                self.faces.push((self.group.clone(), Err((self.patches, why.clone()))));
                self.warnings.push("face left out", || Place::Line(line), || why);
            }
        }
        Ok(())
    }

    /// Points of three numbers, or of four with the weight last.
    fn points(&mut self, count: usize, numbers: usize) -> Result<Vec<DVec4>, Lost> {
        let mut points = Vec::new();
        for _ in 0..count {
            let mut p = DVec4::ONE;
            for k in 0..numbers {
                p[k] = self.words.number("a number")?;
            }
            points.push(p);
        }
        Ok(points)
    }

    fn polyhedron(&mut self, line: usize) -> Result<(), Lost> {
        let (vertices, facets): (usize, usize) =
            (self.words.number("the number of vertices")?, self.words.number("the number of facets")?);
        let points: Vec<DVec3> = self.points(vertices, 3)?.into_iter().map(DVec4::truncate).collect();
        let mut triangles = Vec::new();
        for _ in 0..facets {
            let line = self.words.line();
            let sides: usize = self.words.number("the number of corners")?;
            let mut corners: Vec<u32> = Vec::new();
            for _ in 0..sides {
                corners.push(self.words.number("the number of a vertex")?);
            }
            let bad = corners.iter().find(|&&c| points.get(c as usize).is_none_or(|p| !p.is_finite()));
            let why = match bad {
                Some(c) if (*c as usize) < vertices => Some(format!("vertex {c} is not finite")),
                Some(c) => Some(format!("vertex {c} of {vertices}")),
                None if sides < 3 => Some(format!("{sides} corners")),
                None if sides > facets::MAX_CORNERS => {
                    Some(format!("{sides} corners, more than {}", facets::MAX_CORNERS))
                }
                None => None,
            };
            if let Some(why) = why {
                self.warnings.push("polygon left out", || Place::Line(line), || why);
                continue;
            }
            let places: Vec<DVec3> = corners.iter().map(|&c| points[c as usize]).collect();
            triangles.extend(facets::triangulate(&places).into_iter().map(|t| t.map(|i| corners[i as usize])));
        }
        // a vertex that is not finite is in no triangle that is kept
        let points = points.into_iter().map(|p| if p.is_finite() { p } else { DVec3::ZERO }).collect();
        match Mesh::new(self.patches, points, triangles, Vec::new()) {
            Ok(mut mesh) => {
                mesh.colour = self.colour;
                self.meshes.push((self.group.clone(), mesh));
            }
            Err(error) => self.warnings.push("polygons left out", || Place::Line(line), || error.to_string()),
        }
        Ok(())
    }
}

/// Degree up to which knots are made; a surface of a higher one is an error all the same.
const MAX: usize = 64;

#[cfg(test)]
mod tests;
