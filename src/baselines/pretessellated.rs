//! Pretessellation: every trimmed face triangulated once, with a fixed deflection.
//!
//! ```text
//!   loops ──chords within the deflection──▶ constraints ┐
//!   grid inside the face, by the second derivatives ────┴▶ constrained Delaunay ──▶ inner triangles
//!                                                             ▲                         │
//!                                                             └── middles of triangles ◀┘
//!                                                                 that bulge too far
//! ```
//!
//! This is what CAD viewers do (Open CASCADE's `BRepMesh_IncrementalMesh` with a linear deflection). The constrained
//! Delaunay triangulation is `spade`'s. Neighbouring faces are triangulated separately, so their borders may be apart
//! by twice the deflection.

use crate::model::{Face, Mesh, Model, Part, TrimLoop};
use crate::spline::{Bezier, PatchGrid};
use crate::trim::LoopIndex;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use spade::{ConstrainedDelaunayTriangulation, InsertionError, Point2, Triangulation};

/// Most halvings of a curve: 2^20 chords a curve.
const MOST_HALVINGS: u32 = 20;
/// Most rounds that add the middles of bulging triangles. Each round divides a triangle's bulge by about three, and the
/// initial grid is nearly fine enough.
const MOST_ROUNDS: u32 = 8;
/// Most points of the grid along one side of a patch.
const MOST_STEPS: f64 = 4096.0;

/// Statistics of the triangulation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Triangulated {
    /// All triangles.
    pub triangles: usize,
    /// Triangles that still bulge beyond the deflection at their middle or at the middle of a side.
    pub beyond: usize,
    /// Faces that could not be triangulated, and are missing.
    pub missing: usize,
}

/// The model with each face replaced by a mesh with the face's number. `deflection` is the largest distance between a
/// chord or triangle and the surface, in model units; above 0.
pub fn pretessellated(model: &Model, deflection: f64) -> (Model, Triangulated) {
    let mut all = Triangulated::default();
    let parts = model.parts.iter().map(|part| {
        let made: Vec<_> = part.faces.par_iter().map(|face| triangulated(face, deflection)).collect();
        let mut meshes = part.meshes.clone();
        for (mesh, beyond) in made {
            match mesh {
                Some(mesh) => {
                    all.triangles += mesh.triangles().len();
                    meshes.push(mesh);
                }
                None => all.missing += 1,
            }
            all.beyond += beyond;
        }
        Part { name: part.name.clone(), faces: Vec::new(), meshes, closed: part.closed, ..Part::default() }
    });
    let parts = parts.collect();
    (Model { parts, ..model.clone() }, all)
}

type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// A face during triangulation: (u, v) is scaled so that its units are about as long as the model's.
struct Net<'a> {
    grid: &'a PatchGrid,
    scale: DVec2,
    cdt: Cdt,
}

/// One face as a mesh, and the number of its triangles that bulge.
fn triangulated(face: &Face, deflection: f64) -> (Option<Mesh>, usize) {
    let grid = face.surface.patches();
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let whole = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)].map(DVec2::from);
    let sides = || (0..4).map(|i| Bezier::line(whole[i], whole[(i + 1) % 4]));
    let loops: Vec<Vec<DVec2>> = if face.loops.is_empty() {
        vec![chords(&grid, sides(), deflection)]
    } else {
        face.loops.iter().map(|l| chords(&grid, l.curves(), deflection)).collect()
    };
    let middle = grid.jet(0.5 * (u0 + u1), 0.5 * (v0 + v1));
    let length = |x: f64| if x > 0.0 { x } else { 1.0 };
    let scale = DVec2::new(length(middle.du.length()), length(middle.dv.length()));
    let mut net = Net { grid: &grid, scale, cdt: Cdt::new() };
    let Ok(mesh) = net.fill(face, &loops, deflection) else { return (None, 0) };
    mesh
}

impl Net<'_> {
    fn fill(
        &mut self,
        face: &Face,
        loops: &[Vec<DVec2>],
        deflection: f64,
    ) -> Result<(Option<Mesh>, usize), InsertionError> {
        let mut corners = Vec::new();
        for points in loops {
            corners.push(points.iter().map(|&p| self.cdt.insert(self.point(p))).collect::<Result<Vec<_>, _>>()?);
        }
        for ring in &corners {
            for (k, &from) in ring.iter().enumerate() {
                let to = ring[(k + 1) % ring.len()];
                if from != to {
                    // chords of neighbouring loops may cross if the loops nearly touch
                    self.cdt.add_constraint_and_split(from, to, |p| p);
                }
            }
        }
        let polygons: Vec<TrimLoop> = loops.iter().filter_map(|points| polygon(points)).collect();
        let index = LoopIndex::new(&polygons);
        for p in inner(self.grid, deflection) {
            if index.contains(p) {
                self.cdt.insert(self.point(p))?;
            }
        }
        let mut beyond = Vec::new();
        for round in 0..=MOST_ROUNDS {
            beyond = self.bulging(&index, deflection);
            if beyond.is_empty() || round == MOST_ROUNDS {
                break;
            }
            for &p in &beyond {
                self.cdt.insert(self.point(p))?;
            }
        }
        Ok((self.mesh(face, &index), beyond.len()))
    }

    fn point(&self, p: DVec2) -> Point2<f64> {
        // spade rejects numbers so small that its predicates underflow
        let kept = |x: f64| if x.abs() < spade::MIN_ALLOWED_VALUE { 0.0 } else { x };
        Point2::new(kept(p.x * self.scale.x), kept(p.y * self.scale.y))
    }

    fn uv(&self, p: Point2<f64>) -> DVec2 {
        DVec2::new(p.x, p.y) / self.scale
    }

    /// The points to add for triangles that bulge beyond the deflection: the middle of a bulging inner side, or of the
    /// triangle. Sides at the border stay, because the neighbouring face would not get the new point.
    fn bulging(&self, index: &LoopIndex, deflection: f64) -> Vec<DVec2> {
        let at = |p: DVec2| self.grid.point(p.x, p.y);
        let mut cuts = Vec::new();
        for f in self.cdt.inner_faces() {
            let t = f.vertices().map(|v| self.uv(v.position()));
            let middle = (t[0] + t[1] + t[2]) / 3.0;
            if !index.contains(middle) {
                continue;
            }
            let corners = t.map(at);
            let flat = (corners[0] + corners[1] + corners[2]) / 3.0;
            let sides = f.adjacent_edges().into_iter().filter(|side| !side.is_constraint_edge());
            let bulge = |side: [DVec2; 2]| {
                let [a, b] = side;
                let half = 0.5 * (a + b);
                (half, at(half).distance(0.5 * (at(a) + at(b))))
            };
            let sides = sides.into_iter().map(|side| bulge(side.vertices().map(|v| self.uv(v.position()))));
            let inner = (middle, at(middle).distance(flat));
            let worst = sides.fold(inner, |worst, one| if one.1 > worst.1 { one } else { worst });
            if worst.1 > deflection {
                cuts.push(worst.0);
            }
        }
        cuts
    }

    fn mesh(&self, face: &Face, index: &LoopIndex) -> Option<Mesh> {
        let mut positions = Vec::with_capacity(self.cdt.num_vertices());
        let mut directions = Vec::with_capacity(self.cdt.num_vertices());
        let sense = if face.same_sense { 1.0 } else { -1.0 };
        for vertex in self.cdt.vertices() {
            let p = self.uv(vertex.position());
            let jet = self.grid.jet(p.x, p.y);
            positions.push(jet.point);
            directions.push(sense * jet.du.cross(jet.dv));
        }
        let mut triangles = Vec::new();
        let mut normals = Vec::new();
        for f in self.cdt.inner_faces() {
            let corners = f.vertices();
            let middle = corners.iter().map(|v| self.uv(v.position())).sum::<DVec2>() / 3.0;
            if !index.contains(middle) {
                continue;
            }
            let [a, b, c] = corners.map(|v| v.fix().index() as u32);
            let triangle = if face.same_sense { [a, b, c] } else { [a, c, b] };
            triangles.push(triangle);
            normals.push(triangle.map(|v| directions[v as usize]));
        }
        if triangles.is_empty() {
            return None;
        }
        let mut mesh = Mesh::new(face.id, positions, triangles, normals).ok()?;
        mesh.colour = face.colour;
        Some(mesh)
    }
}

/// The loop of these corners; `None` if there are fewer than three.
fn polygon(points: &[DVec2]) -> Option<TrimLoop> {
    let lines = (0..points.len()).map(|k| (points[k], points[(k + 1) % points.len()])).filter(|(a, b)| a != b);
    TrimLoop::new(lines.map(|(a, b)| Bezier::line(a, b)).collect(), DVec2::ZERO).ok()
}

/// Points along a chain of curves such that chords, on the surface, stay within `deflection` of the chain.
fn chords(grid: &PatchGrid, curves: impl Iterator<Item = Bezier<DVec3>>, deflection: f64) -> Vec<DVec2> {
    let mut points = Vec::new();
    for curve in curves {
        let at = |t: f64| {
            let p = curve.point(t);
            (t, p, grid.point(p.x, p.y))
        };
        points.push(curve.point(0.0));
        let mut open = vec![(at(0.0), at(1.0), 0)];
        while let Some((a, b, depth)) = open.pop() {
            let inner = [0.25, 0.5, 0.75].map(|s| at(a.0 + (b.0 - a.0) * s));
            let bulges = inner.iter().any(|c| from_line(c.2, a.2, b.2) > deflection);
            if bulges && depth < MOST_HALVINGS {
                open.push((inner[1], b, depth + 1));
                open.push((a, inner[1], depth + 1));
            } else if b.0 < 1.0 {
                points.push(b.1);
            }
        }
    }
    points.dedup();
    points
}

/// Distance from `p` to the line segment from `a` to `b`.
fn from_line(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let t = if along == DVec3::ZERO { 0.0 } else { ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
    p.distance(a + along * t)
}

/// A grid in each patch such that triangles between its points stay within the deflection:
/// `|S - triangle| <= (|S_uu| h_u² + 2 |S_uv| h_u h_v + |S_vv| h_v²) / 8`.
fn inner(grid: &PatchGrid, deflection: f64) -> Vec<DVec2> {
    let mut points = Vec::new();
    for p in &grid.patches {
        let b = p.patch.derivative_bound();
        let small = 1e-12 * (b.u + b.v);
        let steps = |bend: f64| {
            if bend <= small { 1.0 } else { (3.0 * bend / (8.0 * deflection)).sqrt().ceil().min(MOST_STEPS) }
        };
        let (mut nu, mut nv) = (steps(b.uu), steps(b.vv));
        let twist = if b.uv <= small { 0.0 } else { 6.0 * b.uv / (8.0 * deflection) };
        let finer = (twist / (nu * nv)).sqrt().max(1.0);
        (nu, nv) = ((nu * finer).ceil().min(MOST_STEPS), (nv * finer).ceil().min(MOST_STEPS));
        for j in 0..=nv as u32 {
            for i in 0..=nu as u32 {
                let (s, t) = (f64::from(i) / nu, f64::from(j) / nv);
                points.push(DVec2::new(p.u.0 + (p.u.1 - p.u.0) * s, p.v.0 + (p.v.1 - p.v.0) * t));
            }
        }
    }
    points
}
