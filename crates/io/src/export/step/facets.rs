//! A closed mesh as a solid of polygons.
//!
//! ```text
//!   FACETED_BREP ▶ CLOSED_SHELL ▶ FACE_SURFACE ▶ FACE_OUTER_BOUND ▶ POLY_LOOP ▶ CARTESIAN_POINT, shared
//!                                      │
//!                                      └▶ PLANE
//! ```

use super::text::{Id, List, Quoted, Text};
use crate::model::Mesh;
use glam::{DAffine3, DVec3};
use std::io::{self, Write};

/// Writes a mesh where `place` puts it. Triangles that name a vertex twice bound nothing and are not written; the
/// normals of corners have no place in the form.
pub(super) fn faceted<W: Write>(text: &mut Text<W>, name: &str, mesh: &Mesh, place: &DAffine3) -> io::Result<Id> {
    let positions: Vec<DVec3> = mesh.positions().iter().map(|p| place.transform_point3(*p)).collect();
    let mirrored = place.matrix3.determinant() < 0.0;
    let points: Vec<Id> = positions.iter().map(|p| text.point(*p)).collect::<Result<_, _>>()?;
    let mut faces = Vec::with_capacity(mesh.triangles().len());
    for &[a, b, c] in mesh.triangles() {
        if a == b || b == c || c == a {
            continue;
        }
        let corners = if mirrored { [a, c, b] } else { [a, b, c] }.map(|v| v as usize);
        let [p, q, r] = corners.map(|v| positions[v]);
        let x = (q - p).normalize_or(DVec3::X);
        let z = x.cross(r - p).normalize_or(x.any_orthonormal_vector());
        let loops = text.add(format_args!("POLY_LOOP('',{})", List(&corners.map(|v| points[v]))))?;
        let bound = text.add(format_args!("FACE_OUTER_BOUND('',{loops},.T.)"))?;
        let at = text.placement_at(points[corners[0]], z, x)?;
        let plane = text.add(format_args!("PLANE('',{at})"))?;
        faces.push(text.add(format_args!("FACE_SURFACE('',({bound}),{plane},.T.)"))?);
    }
    let shell = text.add(format_args!("CLOSED_SHELL('',{})", List(&faces)))?;
    text.add(format_args!("FACETED_BREP({},{shell})", Quoted(name)))
}
