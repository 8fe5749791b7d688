//! Nodes without children, in facets: their corners stand where OpenSCAD puts them.

use super::solid::Triangles;
use super::{Body, Region, Shape, file, text};
use crate::import::facets::triangulate;
use crate::import::scad::args::Args;
use crate::import::scad::frame::Made;
use crate::import::scad::{Fault, Reader, convex};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Segments of a circle; a ball has about half their square of corners.
const MOST_SEGMENTS: f64 = 10_000.0;
const MOST_BALL: f64 = 1000.0;

impl Reader<'_> {
    /// The shape of a leaf.
    pub(in crate::import::scad) fn facet_leaf(&mut self, args: &Args<'_>) -> Result<Made<Shape>, Fault> {
        let shape = match args.node {
            "square" | "circle" | "polygon" => Shape::Flat(self.facet_outline(args)?),
            "text" => {
                let (region, note) = text::text(args, text::installed())?;
                if let Some(note) = note {
                    self.warn("another font", args, || note);
                }
                Shape::Flat(region)
            }
            "import" | "surface" => {
                let (shape, notes) = file::read(args, self.files, &mut self.report.files_read)?;
                notes.into_iter().for_each(|note| self.warn("part of a file left out", args, || note));
                shape
            }
            _ => Shape::Solid(self.facet_body(args)?),
        };
        Ok(if shape.is_empty() { Made::Empty } else { Made::Is(shape) })
    }

    fn facet_outline(&mut self, args: &Args<'_>) -> Result<Region, Fault> {
        let (radius, size) = (args.number("r", 1.0)?, args.vector::<2>("size", 1.0)?);
        if !self.usable(args, &[radius, size[0], size[1]]) {
            return Ok(Region::default());
        }
        let outlines = match args.node {
            "circle" => vec![circle(args, radius, 0.0, MOST_SEGMENTS)?.into_iter().map(DVec3::truncate).collect()],
            "square" => {
                let size = DVec2::from_array(size);
                let min = if args.flag("center") { -0.5 * size } else { DVec2::ZERO };
                let max = min + size;
                vec![vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]]
            }
            _ => args.outlines()?,
        };
        Ok(Region::new(&outlines, true))
    }

    fn facet_body(&mut self, args: &Args<'_>) -> Result<Body, Fault> {
        let points = match args.node {
            "cube" => {
                let size = args.vector::<3>("size", 1.0)?;
                if !self.usable(args, &size) {
                    return Ok(Body::default());
                }
                let size = DVec3::from_array(size);
                let min = if args.flag("center") { -0.5 * size } else { DVec3::ZERO };
                let bit = |i: u32, k: u32| f64::from(i >> k & 1);
                (0..8).map(|i| min + size * DVec3::new(bit(i, 0), bit(i, 1), bit(i, 2))).collect()
            }
            "sphere" => {
                let radius = args.number("r", 1.0)?;
                if !self.usable(args, &[radius]) {
                    return Ok(Body::default());
                }
                let rings = ((args.segments(radius) + 1.0) / 2.0).floor();
                let mut all = Vec::new();
                for ring in 0..rings.min(MOST_BALL) as u32 {
                    let (s, c) = (PI * (f64::from(ring) + 0.5) / rings).sin_cos();
                    let (wide, n) = (radius * s, args.segments(radius));
                    all.extend(corners(args, n, wide, radius * c, MOST_BALL)?);
                }
                all
            }
            "cylinder" => {
                let r = args.number("r", 1.0)?;
                let (radii, height) = ([args.number("r1", r)?, args.number("r2", r)?], args.number("h", 1.0)?);
                if !self.usable(args, &[radii[0], radii[1], height]) {
                    return Ok(Body::default());
                }
                let base = if args.flag("center") { -0.5 * height } else { 0.0 };
                let n = args.segments(radii[0].max(radii[1]));
                let mut all = corners(args, n, radii[0], base, MOST_SEGMENTS)?;
                all.extend(corners(args, n, radii[1], base + height, MOST_SEGMENTS)?);
                all
            }
            "polyhedron" => return polyhedron(args),
            _ => return Err(args.fault("such a node is not known")),
        };
        Ok(Body::hull(&points))
    }
}

fn circle(args: &Args<'_>, radius: f64, z: f64, most: f64) -> Result<Vec<DVec3>, Fault> {
    corners(args, args.segments(radius), radius, z, most)
}

fn corners(args: &Args<'_>, segments: f64, radius: f64, z: f64, most: f64) -> Result<Vec<DVec3>, Fault> {
    if segments > most {
        return Err(args.fault(format!("{segments} segments, of which corners are needed")));
    }
    let at = |i: u32| (radius * DVec2::from_angle(TAU * f64::from(i) / segments)).extend(z);
    Ok((0..segments as u32).map(at).collect())
}

/// `polyhedron(points, faces)`: a cell where it is convex.
fn polyhedron(args: &Args<'_>) -> Result<Body, Fault> {
    let points: Vec<DVec3> = args.points("points")?.into_iter().map(DVec3::from_array).collect();
    let mut faces = args.indices("faces", points.len())?;
    faces.iter_mut().for_each(|f| f.reverse()); // clockwise from outside there
    faces.retain(|f| f.len() >= 3);
    if convex::closed(&faces).is_ok() && convex::planes(&points, &faces).is_some() {
        let used: Vec<DVec3> = faces.iter().flatten().map(|i| points[*i as usize]).collect();
        return Ok(Body::hull(&used));
    }
    let mut triangles = Vec::new();
    for face in &faces {
        let corners: Vec<DVec3> = face.iter().map(|i| points[*i as usize]).collect();
        triangles.extend(triangulate(&corners).into_iter().map(|t| t.map(|i| face[i as usize])));
    }
    Ok(Body::mesh(Triangles::welded(&points, triangles).outwards()))
}
