//! Closed surfaces of many faces without trims, which share their sides: limit surfaces of small cages.
//!
//! ```text
//!   cube      eight corners of 3 faces, two of which share a face: refined, and all rings equal
//!   box       corners of 3 faces among regular ones, whose rings meet them in halves of halves
//!   torus     regular: one bicubic patch a face, sides one to one
//!   tips      two corners of 3, 5 or 8 faces, of triangles, over a ring of ordinary ones
//!   fine      the box, eight times as near its limit: more rings
//!   triangles Loop's scheme: faces cut at a corner of their neighbours
//! ```

#![allow(dead_code)] // each test uses some of them

use glam::{DAffine3, DVec3};
use selvedge::construct::subdivide::{ControlMesh, Scheme, subdivide};
use selvedge::model::{Instance, Model};
use std::f64::consts::TAU;

/// A closed surface.
pub struct Closed {
    pub name: &'static str,
    pub model: Model,
}

fn mesh(positions: Vec<DVec3>, faces: Vec<Vec<u32>>) -> ControlMesh {
    ControlMesh { positions, faces, creases: Vec::new() }
}

/// Sides of length 2 around the origin, stretched a little so that coordinates are not round numbers.
fn cube() -> ControlMesh {
    let at = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - 1.0;
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    mesh((0..8).map(|i| at(i) * DVec3::new(1.0, 1.1, 0.9)).collect(), faces.map(|f| f.to_vec()).to_vec())
}

/// A box of `n` quadrilaterals along each side.
fn boxed(n: u32) -> ControlMesh {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    let mut number = |p: [u32; 3]| {
        let p = DVec3::new(1.0, 1.1, 0.9) * DVec3::from(p.map(f64::from));
        positions.iter().position(|q| *q == p).unwrap_or_else(|| {
            positions.push(p);
            positions.len() - 1
        }) as u32
    };
    for (axis, end) in [(0, 0), (0, n), (1, 0), (1, n), (2, 0), (2, n)] {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let corner = |(i, j): (u32, u32)| {
                let mut p = [end; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (i, j);
                p
            };
            let mut face = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|at| number(corner(at))).to_vec();
            if end == 0 {
                face.reverse();
            }
            faces.push(face);
        }
    }
    mesh(positions, faces)
}

fn torus(n: u32, m: u32) -> ControlMesh {
    let point = |k: u32| {
        let (s, c) = (TAU * f64::from(k % n) / f64::from(n)).sin_cos();
        let (t, d) = (TAU * f64::from(k / n) / f64::from(m)).sin_cos();
        DVec3::new((3.0 + d) * c, (3.0 + d) * s, t)
    };
    let at = |i: u32, j: u32| j % m * n + i % n;
    let cell = |k: u32| {
        let (i, j) = (k % n, k / n);
        vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    };
    mesh((0..n * m).map(point).collect(), (0..n * m).map(cell).collect())
}

fn tips(n: u32) -> ControlMesh {
    let mut positions = vec![DVec3::Z, DVec3::NEG_Z];
    positions.extend((0..n).map(|k| {
        let (s, c) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
        DVec3::new(c, s, 0.0) * 1.3
    }));
    let side = |k: u32| [vec![0, 2 + k, 2 + (k + 1) % n], vec![1, 2 + (k + 1) % n, 2 + k]];
    mesh(positions, (0..n).flat_map(side).collect())
}

/// The limit surface of a cage, within `tolerance`.
fn limit(name: &'static str, cage: &ControlMesh, scheme: Scheme, tolerance: f64) -> Closed {
    let part = subdivide(cage, scheme, tolerance).unwrap().part;
    assert!(part.closed && part.faces.len() > 1 && part.faces.iter().all(|f| f.loops.is_empty()));
    let placed = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: name.to_owned() };
    Closed { name, model: Model { parts: vec![part], instances: vec![placed], ..Model::default() } }
}

/// Corners of 3 faces among regular ones.
pub fn a_box() -> Closed {
    limit("box", &boxed(3), Scheme::CatmullClark, 4e-3)
}

pub fn tips_of_5() -> Closed {
    limit("tips of 5", &tips(5), Scheme::CatmullClark, 4e-3)
}

pub fn all() -> Vec<Closed> {
    let quads = Scheme::CatmullClark;
    vec![
        limit("cube", &cube(), quads, 4e-3),
        a_box(),
        limit("torus", &torus(5, 4), quads, 4e-3),
        limit("tips of 3", &tips(3), quads, 4e-3),
        tips_of_5(),
        limit("tips of 8", &tips(8), quads, 4e-3),
        limit("fine", &boxed(3), quads, 5e-4),
        limit("triangles", &tips(5), Scheme::Loop, 4e-3),
    ]
}
