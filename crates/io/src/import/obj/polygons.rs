//! Polygons, by way of tobj, to triangle meshes.
//!
//! ```text
//!   v vn f l     ──checked, numbers made absolute──▶ text ──tobj──▶ vertices of each look
//!   o g usemtl   ──▶ Look, one mesh each             ──facets::triangulate──▶ Mesh
//! ```
//!
//! tobj gives up a file at its first bad index, so it gets good statements only: the others have their warning here,
//! with their line. A polygon without normals gets one of its own, the zero vector, which later becomes the normal of
//! each triangle.

use super::index;
use crate::import::facets::{MAX_CORNERS, triangulate};
use crate::model::{Colour, Mesh};
use glam::{DVec3, DVec4};
use std::collections::HashMap;
use std::fmt::Write;

/// The object, group and material that a run of polygons shares.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Look {
    /// Name of the object.
    pub object: String,
    /// Name of the group, in which the polygons make one mesh for each colour.
    pub group: String,
    /// Name of the material.
    pub material: String,
    /// Its colour.
    pub colour: Option<Colour>,
}

/// The polygons so far.
#[derive(Default)]
pub(super) struct Polygons {
    text: String,
    normals: Vec<bool>,
    looks: Vec<Look>,
    /// Places in `looks`, by object, group and material.
    places: HashMap<[String; 3], usize>,
    /// The look of the last polygon.
    current: Option<usize>,
    /// Polygons of at least three corners.
    pub count: usize,
}

impl Polygons {
    /// A vertex, which polygons take without its weight; one that is not finite keeps its number.
    pub fn vertex(&mut self, p: DVec4) {
        let p = if p.is_finite() { p } else { DVec4::ZERO };
        let _ = writeln!(self.text, "v {} {} {}", p.x, p.y, p.z);
    }

    /// A normal; `None` keeps the number of one that could not be read.
    pub fn normal(&mut self, n: Option<DVec3>) {
        if self.normals.is_empty() {
            self.text.push_str("vn 0 0 0\n");
            self.normals.push(false);
        }
        self.normals.push(n.is_some());
        let n = n.unwrap_or_default();
        let _ = writeln!(self.text, "vn {} {} {}", n.x, n.y, n.z);
    }

    /// A polygon: `v`, `v/vt`, `v//vn` or `v/vt/vn` for each corner. True when its normals were left out.
    pub fn polygon<'t>(
        &mut self,
        corners: impl Iterator<Item = &'t str>,
        vertices: &[DVec4],
        look: &Look,
    ) -> Result<bool, String> {
        let normal_count = self.normals.len().saturating_sub(1);
        let mut list = Vec::new();
        let mut smooth = normal_count > 0;
        let mut lost = false;
        for corner in corners {
            let mut parts = corner.split('/');
            let v = index(parts.next().unwrap_or_default(), vertices.len(), "vertex")?;
            if !vertices[v].is_finite() {
                return Err(format!("vertex {} could not be read", v + 1));
            }
            let vn = parts.nth(1).filter(|t| !t.is_empty()).map(|t| index(t, normal_count, "normal"));
            match vn {
                Some(Ok(n)) if self.normals[n + 1] => list.push((v + 1, n + 2)),
                other => {
                    lost |= other.is_some();
                    smooth = false;
                    list.push((v + 1, 0));
                }
            }
        }
        match list.len() {
            ..3 => return Err(format!("{} corners", list.len())),
            n if n > MAX_CORNERS => return Err(format!("{n} corners, more than {MAX_CORNERS}")),
            _ => self.count += 1,
        }
        if self.current.is_none_or(|at| self.looks[at] != *look) {
            let names = [&look.object, &look.group, &look.material].map(String::clone);
            let at = *self.places.entry(names).or_insert(self.looks.len());
            if at == self.looks.len() {
                self.looks.push(look.clone());
            }
            self.current = Some(at);
            let _ = writeln!(self.text, "o {at}");
        }
        self.text.push('f');
        for (v, n) in list {
            let _ = match (smooth, normal_count) {
                (true, _) => write!(self.text, " {v}//{n}"),
                (false, 0) => write!(self.text, " {v}"),
                (false, _) => write!(self.text, " {v}//1"),
            };
        }
        self.text.push('\n');
        Ok(lost)
    }

    /// The meshes, each with its look, in the order of their first polygon; numbers start at `first_id`.
    pub fn meshes(self, first_id: u32) -> Result<Vec<(Look, Mesh)>, String> {
        let options =
            tobj::LoadOptions { triangulate: false, ignore_points: true, ignore_lines: true, single_index: false };
        let mut text = self.text.as_bytes();
        let none = |_: &std::path::Path| Ok((Vec::new(), Default::default()));
        let (models, _) = tobj::load_obj_buf(&mut text, &options, none).map_err(|e| e.to_string())?;
        let mut shapes: Vec<Shape> = self.looks.iter().map(|_| Shape::default()).collect();
        for model in models.into_iter().filter(|m| !m.mesh.indices.is_empty()) {
            let at = model.name.parse::<usize>().ok().filter(|&i| i < shapes.len());
            shapes[at.ok_or("a look that is not there")?].add(&model.mesh)?;
        }
        (self.looks.into_iter().zip(shapes))
            .zip(first_id..)
            .map(|((look, shape), id)| {
                let normals = if shape.smooth { shape.normals } else { Vec::new() };
                let mut mesh = Mesh::new(id, shape.positions, shape.triangles, normals).map_err(|e| e.to_string())?;
                mesh.colour = look.colour;
                Ok((look, mesh))
            })
            .collect()
    }
}

/// Triangles of one look.
#[derive(Default)]
struct Shape {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[DVec3; 3]>,
    /// At least one polygon has normals.
    smooth: bool,
}

impl Shape {
    fn add(&mut self, mesh: &tobj::Mesh) -> Result<(), String> {
        let first = u32::try_from(self.positions.len()).map_err(|_| "too many vertices")?;
        let positions: Vec<DVec3> = mesh.positions.chunks_exact(3).map(DVec3::from_slice).collect();
        let normals: Vec<DVec3> = mesh.normals.chunks_exact(3).map(DVec3::from_slice).collect();
        // without arities every polygon is a triangle
        let arities = mesh.face_arities.iter().map(|&n| n as usize).chain(std::iter::repeat(3));
        let mut from = 0;
        for arity in arities {
            let Some(polygon) = mesh.indices.get(from..from + arity) else { break };
            let corners: Vec<DVec3> = polygon.iter().map(|&i| positions[i as usize]).collect();
            for t in triangulate(&corners) {
                let [a, b, c] = t.map(|i| corners[i as usize]);
                let given = mesh.normal_indices.get(from..from + arity);
                let given = given.map(|given| t.map(|i| normals[given[i as usize] as usize]));
                let given = given.filter(|n| n.iter().any(|n| *n != DVec3::ZERO));
                self.smooth |= given.is_some();
                self.normals.push(given.unwrap_or([(b - a).cross(c - a); 3]));
                self.triangles.push(t.map(|i| first + polygon[i as usize]));
            }
            from += arity;
        }
        self.positions.extend(positions);
        Ok(())
    }
}
