//! Shapes with flat sides: frusta and balls of few segments, and polyhedra.
//!
//! ```text
//!   cylinder($fn = 6)   box of its height * six half-spaces      convex    box * one half-space a face
//!   sphere($fn = 6)     box * its facets                         others    a closed mesh
//!   with more than 100 planes: a closed mesh
//! ```
//!
//! Vertices stand where OpenSCAD puts them: at angles `360° i / n`, rings of a ball at `180° (i + ½) / rings`
//! without a vertex at the poles.

use super::Fault;
use super::args::Args;
use crate::import::facets::triangulate;
use crate::import::solid::{Assembly, Placed, Plane, around};
use crate::model::{Bounds, Mesh, Shape};
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Faces of a convex polyhedron times its vertices: beyond, it stays a mesh.
const MOST_TESTS: usize = 10_000_000;
/// Planes beyond which a convex part is a mesh: its half-spaces would cost each ray more than its triangles do.
pub(super) const MOST_PLANES: usize = 100;
/// Distance from a plane that is rounding, relative to the size: numbers carry six digits.
const ROUNDING: f64 = 4e-6;

/// A frustum about z from `z = 0`, its corners on circles of the two radii.
pub(super) fn frustum(to: &mut Assembly, placed: &Placed, [bottom, top]: [f64; 2], height: f64, n: u32) -> u32 {
    if n as usize > MOST_PLANES
        && let Some(mesh) = lathe(to, placed, &[(bottom, 0.0), (top, height)], n)
    {
        return mesh;
    }
    let step = TAU / f64::from(n);
    let middle = (0.5 * step).cos();
    let slope = if height > 0.0 { (top - bottom) / height } else { 0.0 };
    let planes: Vec<Plane> = (0..n)
        .map(|i| {
            let (s, c) = (step * (f64::from(i) + 0.5)).sin_cos();
            (DVec3::new(c, s, -slope * middle), bottom * middle)
        })
        .collect();
    let wide = 2.0 * bottom.max(top);
    let within = Bounds { min: DVec3::new(-wide, -wide, 0.0), max: DVec3::new(wide, wide, height) };
    to.half_spaces(within, &planes, placed)
}

/// A ball of facets.
pub(super) fn ball(to: &mut Assembly, placed: &Placed, radius: f64, n: u32) -> u32 {
    let rings = n.div_ceil(2);
    let at = |ring: u32| {
        let (s, c) = (PI * (f64::from(ring) + 0.5) / f64::from(rings)).sin_cos();
        (radius * s, radius * c)
    };
    let upwards: Vec<_> = (0..rings).rev().map(at).collect();
    if (rings as usize - 1) * n as usize > MOST_PLANES
        && let Some(mesh) = lathe(to, placed, &upwards, n)
    {
        return mesh;
    }
    let step = TAU / f64::from(n);
    let middle = (0.5 * step).cos();
    let mut planes = Vec::new();
    for ring in 1..rings {
        let ((r0, z0), (r1, z1)) = (at(ring - 1), at(ring));
        let (out, up) = (z0 - z1, (r1 - r0) * middle); // normal of the side in the plane of its middle
        planes.extend((0..n).map(|i| {
            let (s, c) = (step * (f64::from(i) + 0.5)).sin_cos();
            (DVec3::new(out * c, out * s, up), out * r0 * middle + up * z0)
        }));
    }
    let (wide, high) = (2.0 * radius, at(0).1);
    let within = Bounds { min: DVec3::new(-wide, -wide, -high), max: DVec3::new(wide, wide, high) };
    to.half_spaces(within, &planes, placed)
}

/// A mesh of rings of `n` vertices about z; `profile`: radius and height of each, upwards. `None` where a coordinate is
/// not finite.
fn lathe(to: &mut Assembly, placed: &Placed, profile: &[(f64, f64)], n: u32) -> Option<u32> {
    let step = TAU / f64::from(n);
    let (mut points, mut firsts) = (Vec::new(), Vec::new());
    for &(radius, z) in profile {
        firsts.push(points.len() as u32);
        // a tip is one vertex
        let count = if radius > 0.0 { n } else { 1 };
        points.extend((0..count).map(|i| {
            let (s, c) = (step * f64::from(i)).sin_cos();
            DVec3::new(radius * c, radius * s, z)
        }));
    }
    let vertex = |ring: usize, i: u32| firsts[ring] + if profile[ring].0 > 0.0 { i % n } else { 0 };
    let last = profile.len() - 1;
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for i in 1..n.saturating_sub(1) {
        triangles.push([vertex(0, 0), vertex(0, i + 1), vertex(0, i)]);
        triangles.push([vertex(last, 0), vertex(last, i), vertex(last, i + 1)]);
    }
    for ring in 0..last {
        for i in 0..n {
            let [a, b] = [i, i + 1].map(|i| vertex(ring, i));
            let [c, d] = [i, i + 1].map(|i| vertex(ring + 1, i));
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    let mesh = Mesh::new(placed.id, points, triangles, Vec::new()).ok()?;
    Some(to.add(Shape::Mesh(Arc::new(mesh)), placed))
}

/// `polyhedron(points, faces)`: half-spaces where it is convex, else a mesh.
pub(super) fn polyhedron(to: &mut Assembly, placed: &Placed, args: &Args<'_>) -> Result<u32, Fault> {
    let points: Vec<DVec3> = args.points("points")?.into_iter().map(DVec3::from_array).collect();
    let mut faces = args.indices("faces", points.len())?;
    faces.iter_mut().for_each(|f| f.reverse()); // clockwise from outside there
    faces.retain(|f| f.len() >= 3);
    if faces.is_empty() {
        return Ok(to.nothing());
    }
    closed(&faces).map_err(|what| args.fault(what))?;
    if let Some(planes) = planes(&points, &faces).filter(|planes| planes.len() <= MOST_PLANES) {
        let corners = faces.iter().flatten().map(|i| points[*i as usize]);
        return Ok(to.half_spaces(around(corners), &planes, placed));
    }
    let cut = |f: &Vec<u32>| {
        let corners: Vec<DVec3> = f.iter().map(|i| points[*i as usize]).collect();
        triangulate(&corners).into_iter().map(|t| t.map(|i| f[i as usize])).collect::<Vec<_>>()
    };
    let triangles = faces.iter().flat_map(cut).collect();
    let mesh = Mesh::new(placed.id, points, triangles, Vec::new()).map_err(|e| args.fault(e))?;
    Ok(to.add(Shape::Mesh(Arc::new(mesh)), placed))
}

/// Whether faces that close are oriented inwards. The polyhedron is the same, but its author made a mistake.
pub(super) fn is_inverted(args: &Args<'_>) -> Result<bool, Fault> {
    let points: Vec<DVec3> = args.points("points")?.into_iter().map(DVec3::from_array).collect();
    let faces = args.indices("faces", points.len())?;
    let first = points.first().copied().unwrap_or_default();
    let at = |i: u32| points[i as usize] - first;
    let fan = |f: &Vec<u32>| (2..f.len()).map(|i| at(f[0]).dot(at(f[i - 1]).cross(at(f[i])))).sum::<f64>();
    // six times the volume; clockwise from outside there
    Ok(faces.iter().map(fan).sum::<f64>() > 0.0)
}

/// Whether every edge is run through once each way.
pub(super) fn closed(faces: &[Vec<u32>]) -> Result<(), &'static str> {
    let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
    for face in faces {
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            *balance.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    let whole = balance.values().all(|n| *n == 0);
    if whole { Ok(()) } else { Err("the faces do not close, so there is no inside") }
}

/// The planes of a convex polyhedron; `None` for others, and for those with very many faces and vertices.
pub(in crate::import) fn planes(points: &[DVec3], faces: &[Vec<u32>]) -> Option<Vec<Plane>> {
    // a vertex of many faces is one
    let mut used: Vec<u32> = faces.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let corners: Vec<DVec3> = used.into_iter().map(|i| points[i as usize]).collect();
    if faces.len() * corners.len() > MOST_TESTS {
        return None;
    }
    let size = corners.iter().copied().fold(Bounds::EMPTY, Bounds::with).diagonal();
    let mut all: Vec<Plane> = Vec::with_capacity(faces.len());
    let mut inverted = None;
    for face in faces {
        let first = points[face[0] as usize];
        let at = |i: usize| points[face[i % face.len()] as usize] - first;
        // M. E. Newell's normal: of the average plane of a polygon
        let normal = (0..face.len()).fold(DVec3::ZERO, |n, i| n + at(i).cross(at(i + 1)));
        let Some(normal) = normal.try_normalize() else { continue };
        let middle = face.iter().map(|i| points[*i as usize] - first).sum::<DVec3>() / face.len() as f64;
        let offset = normal.dot(first + middle);
        let heights = corners.iter().map(|p| normal.dot(*p) - offset);
        let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)));
        let turned = low > -ROUNDING * size;
        if (!turned && high > ROUNDING * size) || inverted.is_some_and(|i| i != turned) {
            return None;
        }
        inverted = Some(turned);
        let plane = if turned { (-normal, -offset) } else { (normal, offset) };
        // facets of one plane are one half-space
        let same = |p: &Plane| (p.0 - plane.0).length() < 1e-9 && (p.1 - plane.1).abs() < 1e-9 * size;
        if !all.iter().any(same) {
            all.push(plane);
        }
    }
    (all.len() >= 4).then_some(all)
}
