//! Subdivision surfaces against the schemes' rules, written again here for plain lists of polygons. Every vertex of a
//! refined mesh, in the limit, lies on the faces; sides are shared to the bit; invalid meshes are named.

use crate::EXACT;
use glam::DVec3;
use proptest::prelude::*;
use selvedge_geometry::construct::ConstructError;
use selvedge_geometry::construct::subdivide::{ControlMesh, Scheme, Subdivided, limits, subdivide};
use selvedge_geometry::model::Part;
use selvedge_geometry::spline::SurfacePatch;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// One step of a scheme, by its rules alone: no half-edges, no fans.
fn step(mesh: &ControlMesh, scheme: Scheme) -> ControlMesh {
    let quads = scheme == Scheme::CatmullClark;
    let mut edges: HashMap<[u32; 2], (u32, Vec<usize>)> = HashMap::new();
    let key = |a: u32, b: u32| [a.min(b), a.max(b)];
    let mut next = mesh.positions.len() as u32;
    for (f, face) in mesh.faces.iter().enumerate() {
        for k in 0..face.len() {
            let entry = edges.entry(key(face[k], face[(k + 1) % face.len()])).or_insert_with(|| {
                next += 1;
                (next - 1, Vec::new())
            });
            entry.1.push(f);
        }
    }
    let creases: Vec<[u32; 2]> = mesh.creases.iter().map(|c| key(c[0], c[1])).collect();
    let sharp = |e: &[u32; 2]| edges[e].1.len() == 1 || creases.contains(e);
    let at = |v: u32| mesh.positions[v as usize];
    let centre = |f: usize| mesh.faces[f].iter().map(|v| at(*v)).sum::<DVec3>() / mesh.faces[f].len() as f64;
    let mut positions = mesh.positions.clone();
    positions.resize(next as usize, DVec3::ZERO);
    for (e, (number, faces)) in &edges {
        let (a, b) = (at(e[0]), at(e[1]));
        positions[*number as usize] = if sharp(e) {
            (a + b) / 2.0
        } else if quads {
            (a + b + centre(faces[0]) + centre(faces[1])) / 4.0
        } else {
            let opposite = |f: usize| at(*mesh.faces[f].iter().find(|v| !e.contains(v)).unwrap());
            (3.0 * (a + b) + opposite(faces[0]) + opposite(faces[1])) / 8.0
        };
    }
    for v in 0..mesh.positions.len() as u32 {
        let around: Vec<[u32; 2]> = edges.keys().filter(|e| e.contains(&v)).copied().collect();
        let other = |e: &[u32; 2]| at(if e[0] == v { e[1] } else { e[0] });
        let hard: Vec<_> = around.iter().filter(|e| sharp(e)).collect();
        let faces: Vec<usize> = (0..mesh.faces.len()).filter(|f| mesh.faces[*f].contains(&v)).collect();
        let corner = hard.len() > 2 || (faces.len() == 1 && !mesh.creases.iter().any(|c| c.contains(&v)));
        let n = around.len() as f64;
        if corner || around.is_empty() {
            continue;
        }
        positions[v as usize] = if hard.len() == 2 {
            at(v) * 0.75 + (other(hard[0]) + other(hard[1])) / 8.0
        } else if quads {
            let f = faces.iter().map(|f| centre(*f)).sum::<DVec3>() / n;
            let r = around.iter().map(|e| (at(v) + other(e)) / 2.0).sum::<DVec3>() / n;
            (f + 2.0 * r + (n - 3.0) * at(v)) / n
        } else {
            let c = 3.0 / 8.0 + (TAU / n).cos() / 4.0;
            let beta = (5.0 / 8.0 - c * c) / n;
            at(v) * (1.0 - n * beta) + around.iter().map(other).sum::<DVec3>() * beta
        };
    }
    let mut faces = Vec::new();
    for face in &mesh.faces {
        let n = face.len();
        let middle = |k: usize| edges[&key(face[k], face[(k + 1) % n])].0;
        if quads {
            positions.push(face.iter().map(|v| at(*v)).sum::<DVec3>() / n as f64);
            let c = positions.len() as u32 - 1;
            faces.extend((0..n).map(|k| vec![face[k], middle(k), c, middle((k + n - 1) % n)]));
        } else {
            faces.extend((0..3).map(|k| vec![face[k], middle(k), middle((k + 2) % 3)]));
            faces.push((0..3).map(middle).collect());
        }
    }
    let split = |c: &[u32; 2]| {
        let m = edges[c].0;
        [[c[0], m], [m, c[1]]]
    };
    ControlMesh { creases: creases.iter().flat_map(split).collect(), positions, faces }
}

/// A box of `n` quadrilaterals along each side.
fn cube() -> ControlMesh {
    let positions = (0..8).map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ControlMesh { positions, faces: faces.map(|f| f.to_vec()).to_vec(), creases: Vec::new() }
}

/// Two tips over a ring of `n` vertices: the tips have `n` neighbours, the ring's vertices 4.
fn bipyramid(n: u32) -> ControlMesh {
    let mut positions = vec![DVec3::Z, DVec3::NEG_Z];
    positions.extend((0..n).map(|k| {
        let (s, c) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
        DVec3::new(c, s, 0.0) * 1.3
    }));
    let side = |k: u32| [vec![0, 2 + k, 2 + (k + 1) % n], vec![1, 2 + (k + 1) % n, 2 + k]];
    ControlMesh { positions, faces: (0..n).flat_map(side).collect(), creases: Vec::new() }
}

/// A grid of quadrilaterals, or of triangles; closed both ways, it is a torus.
fn grid(n: u32, m: u32, closed: bool, triangles: bool) -> ControlMesh {
    let (w, h) = if closed { (n, m) } else { (n + 1, m + 1) };
    let at = |i: u32, j: u32| (j % h) * w + i % w;
    let point = |k: u32| {
        let (x, y) = (f64::from(k % w), f64::from(k / w));
        if closed {
            let ((s, c), (t, d)) = ((TAU * x / f64::from(w)).sin_cos(), (TAU * y / f64::from(h)).sin_cos());
            DVec3::new((3.0 + d) * c, (3.0 + d) * s, t)
        } else {
            DVec3::new(x, y, (x * 1.3).sin() * (y * 0.7).cos())
        }
    };
    let cell = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if triangles { vec![vec![a, b, d], vec![b, c, d]] } else { vec![vec![a, b, c, d]] }
    };
    let cells = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
    ControlMesh {
        positions: (0..w * h).map(point).collect(),
        faces: cells.flat_map(cell).collect(),
        creases: Vec::new(),
    }
}

/// `n` quadrilaterals, or triangles, around a vertex; not all the way round when `open`.
fn wheel(n: u32, open: bool, triangles: bool) -> ControlMesh {
    let span = if open { 4.0 / f64::from(n) } else { TAU / f64::from(n) };
    let ring = |k: f64, r: f64| DVec3::new((span * k).cos() * r, (span * k).sin() * r, 0.3 * (k * 1.7).sin() * r);
    let mut positions = vec![DVec3::Z * 0.2];
    let count = if open { n + 1 } else { n };
    positions.extend((0..count).map(|k| ring(f64::from(k), 1.0)));
    if !triangles {
        positions.extend((0..n).map(|k| ring(f64::from(k) + 0.5, 1.4)));
    }
    let spoke = |k: u32| 1 + if open { k } else { k % n };
    let face = |k: u32| {
        if triangles { vec![0, spoke(k), spoke(k + 1)] } else { vec![0, spoke(k), 1 + count + k, spoke(k + 1)] }
    };
    ControlMesh { positions, faces: (0..n).map(face).collect(), creases: Vec::new() }
}

fn shaken(mut mesh: ControlMesh, by: &[f64]) -> ControlMesh {
    for (k, p) in mesh.positions.iter_mut().enumerate() {
        let of = |i: usize| by[(3 * k + i) % by.len()];
        *p += DVec3::new(of(0), of(1), of(2)) * 0.15;
    }
    mesh
}

fn size(mesh: &ControlMesh) -> f64 {
    let all = mesh.positions.iter();
    let (low, high) = all.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    low.distance(high)
}

/// Distance of `x` from a patch: from the best of a grid of points on, by Gauss and Newton.
fn distance(p: &SurfacePatch, x: DVec3) -> f64 {
    let off = |u: f64, v: f64| p.patch.point(u, v).distance(x);
    let grid = (0..=8).flat_map(|j| (0..=8).map(move |i| (f64::from(i) / 8.0, f64::from(j) / 8.0)));
    let (mut u, mut v) = grid.min_by(|a, b| off(a.0, a.1).total_cmp(&off(b.0, b.1))).unwrap();
    let mut best = off(u, v);
    for _ in 0..30 {
        let jet = p.patch.jet(u, v);
        let r = x - jet.point;
        let (a, b, c) = (jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.dv.dot(jet.dv));
        let damp = 1e-12 * (a + c);
        let det = (a + damp) * (c + damp) - b * b;
        let (e, f) = (jet.du.dot(r), jet.dv.dot(r));
        u = (u + (e * (c + damp) - f * b) / det).clamp(0.0, 1.0);
        v = (v + (f * (a + damp) - e * b) / det).clamp(0.0, 1.0);
        best = best.min(off(u, v));
    }
    best
}

fn patches(part: &Part) -> Vec<(SurfacePatch, DVec3, DVec3)> {
    let all = part.faces.iter().flat_map(|f| f.surface.patches().patches);
    all.map(|p| {
        let (low, high) = p.patch.bounds();
        (p, low, high)
    })
    .collect()
}

/// Limits of the vertices of a refined mesh lie on the faces, within the stated bound.
fn lies_on_the_limit(mesh: &ControlMesh, scheme: Scheme, made: &Subdivided, steps: usize) {
    let fine = (0..steps).fold(mesh.clone(), |m, _| step(&m, scheme));
    let reach = made.deviation + EXACT * size(mesh);
    let all = patches(&made.part);
    for limit in limits(&fine, scheme).unwrap().into_iter().flatten() {
        let x = limit.point;
        let near = all.iter().filter(|(_, low, high)| x.cmpge(low - reach).all() && x.cmple(high + reach).all());
        let mut best = f64::INFINITY;
        for (p, ..) in near {
            best = best.min(distance(p, x));
            if best <= reach {
                break;
            }
        }
        assert!(best <= reach, "{x} is {best:e} off, beyond {:e}", made.deviation);
    }
}

/// Bézier points of a side, as bits, in the order in which they are smaller.
fn bits(side: &[DVec3]) -> Vec<[u64; 3]> {
    let forward: Vec<_> = side.iter().map(|p| (*p + 0.0).to_array().map(f64::to_bits)).collect();
    let backward: Vec<_> = forward.iter().rev().copied().collect();
    forward.min(backward)
}

fn halves(side: &[DVec3]) -> [Vec<DVec3>; 2] {
    let (mut rest, mut low, mut high) = (side.to_vec(), Vec::new(), Vec::new());
    while let (Some(first), Some(last)) = (rest.first().copied(), rest.last().copied()) {
        low.push(first);
        high.insert(0, last);
        rest = rest.windows(2).map(|w| (w[0] + w[1]) * 0.5).collect();
    }
    [low, high]
}

/// A side is one of those that are open, or its halves are.
fn met(side: &[DVec3], open: &mut HashMap<Vec<[u64; 3]>, Vec<DVec3>>, depth: u32) -> bool {
    open.remove(&bits(side)).is_some() || (depth > 0 && halves(side).iter().all(|half| met(half, open, depth - 1)))
}

/// Sides of faces that no other face has, bit for bit, whole or cut in halves.
fn unshared(part: &Part) -> usize {
    let mut open: HashMap<Vec<[u64; 3]>, Vec<DVec3>> = HashMap::new();
    let toggle = |open: &mut HashMap<_, _>, side: Vec<DVec3>| {
        if side.iter().any(|p| *p != side[0]) && open.remove(&bits(&side)).is_none() {
            open.insert(bits(&side), side);
        }
    };
    for face in &part.faces {
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        for p in face.surface.patches().patches {
            let (n, m) = (p.patch.degree_u, p.patch.degree_v);
            let at = |i: usize, j: usize| p.patch.points[j * (n + 1) + i].truncate();
            let row = |j: usize| (0..=n).map(|i| at(i, j)).collect::<Vec<_>>();
            let column = |i: usize| (0..=m).map(|j| at(i, j)).collect::<Vec<_>>();
            for (on, side) in
                [(p.v.0 == v0, row(0)), (p.v.1 == v1, row(m)), (p.u.0 == u0, column(0)), (p.u.1 == u1, column(n))]
            {
                if on {
                    toggle(&mut open, side);
                }
            }
        }
    }
    // an unshared whole side may lie beside its halves, which were sides of their own
    let mut left: Vec<Vec<DVec3>> = open.values().cloned().collect();
    left.sort_by(|a, b| b[0].distance(b[b.len() - 1]).total_cmp(&a[0].distance(a[a.len() - 1])));
    for side in left {
        if open.contains_key(&bits(&side)) {
            let mut rest = open.clone();
            rest.remove(&bits(&side));
            if halves(&side).iter().all(|half| met(half, &mut rest, 25)) {
                open = rest;
            }
        }
    }
    open.len()
}

fn all_right(mesh: &ControlMesh, scheme: Scheme, tolerance: f64, steps: usize) -> Subdivided {
    let made = subdivide(mesh, scheme, tolerance).unwrap();
    assert!(made.deviation <= tolerance);
    lies_on_the_limit(mesh, scheme, &made, steps);
    if made.part.closed {
        assert_eq!(unshared(&made.part), 0);
    }
    made
}

proptest! {
    #![proptest_config(crate::cases(3))]

    #[test]
    fn catmull_clark_meets_its_bound(by in prop::collection::vec(-1.0..1.0f64, 40), n in 3u32..9, tolerance in 1e-6..1e-3f64) {
        let made = all_right(&shaken(cube(), &by), Scheme::CatmullClark, tolerance, 3);
        prop_assert!(made.part.closed && made.irregular == 8 && made.steps == 1);
        // triangles have corners of 3, tips of n
        all_right(&shaken(bipyramid(n), &by), Scheme::CatmullClark, tolerance, 3);
        for open in [false, true] {
            let made = all_right(&shaken(wheel(n, open, false), &by), Scheme::CatmullClark, tolerance, 3);
            prop_assert!(!made.part.closed);
        }
    }

    #[test]
    fn loop_meets_its_bound(by in prop::collection::vec(-1.0..1.0f64, 40), n in 3u32..9, tolerance in 1e-6..1e-3f64) {
        all_right(&shaken(bipyramid(n), &by), Scheme::Loop, tolerance, 2);
        for open in [false, true] {
            all_right(&shaken(wheel(n, open, true), &by), Scheme::Loop, tolerance, 2);
        }
    }

    /// Limits do not move when the mesh is refined, and refined vertices come nearer to them.
    #[test]
    fn limits_are_limits(by in prop::collection::vec(-1.0..1.0f64, 40), n in 3u32..9) {
        let quads = step(&shaken(bipyramid(n), &by), Scheme::CatmullClark);
        for (mesh, scheme) in [(quads, Scheme::CatmullClark), (shaken(bipyramid(n), &by), Scheme::Loop)] {
            let (fine, finer) = (step(&mesh, scheme), step(&step(&mesh, scheme), scheme));
            let before = limits(&mesh, scheme).unwrap();
            let after = limits(&fine, scheme).unwrap();
            for (k, limit) in before.iter().enumerate() {
                let (a, b) = (limit.unwrap(), after[k].unwrap());
                prop_assert!(a.point.distance(b.point) <= EXACT);
                prop_assert!(a.normal.unwrap().distance(b.normal.unwrap()) <= 1e-10);
                let [far, near] = [mesh.positions[k], finer.positions[k]].map(|p| p.distance(a.point));
                prop_assert!(near <= 0.5 * far + EXACT, "{near} after {far}");
            }
        }
    }
}

/// Faces at an irregular vertex end in its limit, with its normal.
#[test]
fn caps_have_the_limit_normal() {
    for n in [3, 4, 5, 7, 8] {
        let quads = step(&step(&bipyramid(n), Scheme::CatmullClark), Scheme::CatmullClark);
        for (mesh, scheme) in [(quads, Scheme::CatmullClark), (step(&bipyramid(n), Scheme::Loop), Scheme::Loop)] {
            let made = subdivide(&mesh, scheme, 1e-4).unwrap();
            assert_eq!(made.steps, 0);
            let limits = limits(&mesh, scheme).unwrap();
            for limit in limits.iter().take(2).map(|l| l.unwrap()) {
                let mut met = 0;
                for face in &made.part.faces {
                    let jet = face.surface.jet(0.0, 0.0);
                    if jet.point.distance(limit.point) <= EXACT {
                        let normal = jet.du.cross(jet.dv).normalize();
                        assert!(normal.distance(limit.normal.unwrap()) <= 1e-9, "{scheme:?} {n}");
                        met += 1;
                    }
                }
                assert!(met >= if n == 4 || n == 6 { 1 } else { n as usize }, "{scheme:?} {n}: {met}");
            }
        }
    }
}

#[test]
fn regular_meshes_are_exact_and_one_face_each() {
    for (mesh, scheme) in [
        (grid(6, 5, true, false), Scheme::CatmullClark),
        (grid(4, 3, false, false), Scheme::CatmullClark),
        (grid(6, 5, true, true), Scheme::Loop),
    ] {
        let made = all_right(&mesh, scheme, 1e-9, 2);
        assert_eq!((made.deviation, made.irregular, made.steps), (0.0, 0, 0));
        assert_eq!(made.part.faces.len(), mesh.faces.len());
    }
    // the corners of a grid of triangles have one triangle and two
    let made = all_right(&grid(4, 3, false, true), Scheme::Loop, 1e-6, 2);
    assert_eq!(made.irregular, 2);
}

#[test]
fn creases_are_kept() {
    // the rim of a can: a closed crease; then an edge across the whole cube's side, and all edges of a corner
    let rim = ControlMesh { creases: vec![[4, 5], [5, 7], [7, 6], [6, 4]], ..cube() };
    let made = all_right(&rim, Scheme::CatmullClark, 1e-5, 2);
    assert!(made.part.closed);
    let corner =
        ControlMesh { creases: vec![[0, 1], [0, 2], [0, 4], [1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]], ..cube() };
    all_right(&corner, Scheme::CatmullClark, 1e-5, 2);
    let ring = (0..6).map(|k| [2 + k, 2 + (k + 1) % 6]).collect();
    let seam = ControlMesh { creases: ring, ..bipyramid(6) };
    let made = all_right(&seam, Scheme::Loop, 1e-5, 2);
    // the crease is a curve of both halves
    assert!(made.part.closed);
    let dart = ControlMesh { creases: vec![[0, 1]], ..cube() };
    let refused = subdivide(&dart, Scheme::CatmullClark, 1e-3);
    assert!(matches!(refused, Err(ConstructError::Vertex { vertex: 0, .. })), "{refused:?}");
}

#[test]
#[should_panic(expected = "off, beyond")]
fn a_face_off_the_limit_is_seen() {
    let mut made = subdivide(&cube(), Scheme::CatmullClark, 1e-5).unwrap();
    let moved = glam::DAffine3::from_translation(DVec3::splat(1e-4));
    for face in &mut made.part.faces {
        face.surface = face.surface.transformed(&moved);
    }
    lies_on_the_limit(&cube(), Scheme::CatmullClark, &made, 2);
}

#[test]
fn a_side_off_by_one_bit_is_seen() {
    let mut made = subdivide(&cube(), Scheme::CatmullClark, 1e-3).unwrap();
    let s = &made.part.faces[0].surface;
    let mut points = s.points().to_vec();
    points[1].x += f64::EPSILON * points[1].x.abs().max(0.1);
    let (ku, kv) = s.knots();
    made.part.faces[0].surface =
        selvedge_geometry::spline::Surface::new(s.degrees(), ku.to_vec(), kv.to_vec(), points).unwrap();
    assert!(unshared(&made.part) > 0);
}

#[test]
fn what_is_no_control_mesh_is_named() {
    let refused = |mesh: ControlMesh, scheme: Scheme, words: &str| {
        let message = subdivide(&mesh, scheme, 1e-3).expect_err(words).to_string();
        assert!(message.contains(words), "{message} should say {words}");
    };
    let both = [Scheme::CatmullClark, Scheme::Loop];
    refused(cube(), Scheme::Loop, "face 0 of the mesh (from 0) is no triangle");
    for scheme in both {
        let mut mesh = bipyramid(5);
        mesh.positions[3].y = f64::NAN;
        refused(mesh, scheme, "vertex 3 of the mesh (from 0) is not a finite point");
        let mut mesh = bipyramid(5);
        mesh.faces.push(vec![0, 2, 1]);
        refused(mesh, scheme, "the edge between vertices 0 and 2");
        let mut mesh = bipyramid(5);
        mesh.faces[0].swap(0, 1);
        refused(mesh, scheme, "the same way");
        let mut mesh = bipyramid(5);
        mesh.faces[2] = vec![0, 99, 1];
        refused(mesh, scheme, "face 2 of the mesh (from 0) names a vertex that is not there");
        let mut mesh = bipyramid(5);
        mesh.faces[2] = vec![0, 1, 0];
        refused(mesh, scheme, "names a vertex twice");
        let mut mesh = bipyramid(5);
        mesh.faces[2] = vec![0, 1];
        refused(mesh, scheme, "fewer than 3 corners");
        refused(ControlMesh::default(), scheme, "0 faces of a control mesh");
        refused(ControlMesh { creases: vec![[0, 1]], ..bipyramid(5) }, scheme, "is a crease, but of no face");
        // two fans that meet in a vertex
        let mut mesh = wheel(3, true, true);
        let more = mesh.positions.len() as u32;
        mesh.positions.extend([DVec3::NEG_Z, DVec3::new(0.3, 0.1, -1.0)]);
        mesh.faces.push(vec![0, more, more + 1]);
        refused(mesh, scheme, "vertex 0 of the mesh (from 0) joins faces that share no edge");
        let flat = ControlMesh { positions: vec![DVec3::ONE; 3], faces: vec![vec![0, 1, 2]], creases: Vec::new() };
        refused(flat, scheme, "the control mesh has no length");
    }
    let bad = subdivide(&cube(), Scheme::CatmullClark, f64::NAN);
    assert!(matches!(bad, Err(ConstructError::Range { .. })));
    assert!(matches!(subdivide(&cube(), Scheme::CatmullClark, 1e-15), Err(ConstructError::Bound { .. })));
}
