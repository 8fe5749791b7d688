//! A patch seen by a camera, from a model in `f64` through the scene's single precision and the twin of pass `bound`.
//!
//! ```text
//!   ●───┬───┬───┬───●      every cell of the triangulation, cut by either diagonal, on a lattice of
//!   ├───┼───┼───┼───┤      halves or quarters: S exactly, T linear in space between the triangle's
//!   ├───┼───┼───┼───┤      vertices (what a rasteriser interpolates with perspective correction)
//!   ├───┼───┼───┼───┤
//!   ●───┴───┴───┴───●      deviation: |pixel(T) - pixel(S)| where T is in the picture
//! ```

use super::{Case, Random};
use crate::abi;
use crate::abi::Counters;
use crate::model::{Camera, Face, Instance, Model, Part, Projection, SurfaceKind};
use crate::scene::{Cuts, flattened};
use crate::spline::{Bezier, Control, Patch, Surface};
use crate::twin::MOST_SEGMENTS;
use crate::twin::bound::bound;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec2, DVec3, DVec4};
use std::f64::consts::TAU;

/// Cells along each side that are measured; of a finer triangulation, a random window.
const WINDOW: usize = 40;

/// What random patches are like.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kind {
    /// Smallest and largest degree.
    pub degrees: (u32, u32),
    /// Largest ratio of weights, one of these.
    pub ratios: &'static [f64],
    /// Promise in pixels, one of these; a twelfth is the tessellation's.
    pub tolerances: &'static [f64],
}

/// What is linear between the vertices of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Emit {
    /// The point in space, as the engine has it.
    Point,
    /// The homogeneous point, its weight not divided out: another triangulation of rational patches, whose vertices are
    /// the same.
    Homogeneous,
}

/// A patch seen by a camera, and what pass `bound` makes of it.
pub(crate) struct Trial {
    pub patch: Patch,
    pub frame: abi::Frame,
    /// Part to homogeneous pixels.
    pub to_pixels: DMat4,
    /// What pass `bound` asks for; 0 where nothing can be seen.
    pub tau: [usize; 2],
}

/// What the lattice shows.
#[derive(Clone, Copy, Default)]
pub(crate) struct Deviation {
    /// The largest in pixels where the triangle is in the picture.
    pub px: f64,
    /// The same with what it is off in depth, by the same number of pixels a unit.
    pub space_px: f64,
    /// Points compared.
    pub points: usize,
    /// Every cell was measured and is in the picture.
    pub whole: bool,
}

impl Trial {
    pub(crate) fn random(seed: u64, kind: Kind) -> Self {
        let r = &mut Random::new(seed);
        let surface = random_surface(r, kind);
        let transform = random_transform(r);
        let model = placed(surface.clone(), transform);
        let bounds = model.bounds();
        let radius = bounds.diagonal() / 2.0;
        let direction = random_rotation(r) * DVec3::Z;
        let distance = radius * r.range(0.6f64.ln(), 12f64.ln()).exp();
        let aside = random_rotation(r) * DVec3::X * (radius * r.range(0.0, 0.6));
        let size = (r.integer(200, 2000), r.integer(200, 2000));
        let projection = match r.integer(0, 7) {
            0 => Projection::Orthographic { height: radius * r.range(0.5, 4.0) },
            _ => Projection::Perspective { fov_y: r.range(0.2, 1.6) },
        };
        let eye = bounds.centre() + direction * distance;
        let depth_range = (distance * r.range(0.02, 0.3), distance + 3.0 * radius);
        let up = random_rotation(r) * DVec3::Y;
        let camera = Camera { eye, target: bounds.centre() + aside, up, projection, depth_range, size };
        // the scene cuts curved surfaces into flatter patches: one stands for all
        let mut trials = Self::of_model(&model, &camera, r.pick(kind.tolerances));
        trials.swap_remove(0)
    }

    /// Every patch of a model.
    pub(crate) fn of_model(model: &Model, camera: &Camera, tolerance_px: f64) -> Vec<Self> {
        let case = Case::new(model, camera, tolerance_px);
        let mut taus = bound(&case.frame, &case.scene(), &mut Counters::default()).into_iter();
        let faces = model.instances.iter().flat_map(|i| {
            let faces = &model.parts[i.part].faces;
            let cuts = Cuts::of(faces);
            faces.iter().map(move |f| (i, f, cuts.in_face(f)))
        });
        let mut all = Vec::new();
        for (instance, face, cuts) in faces {
            for piece in flattened(face.surface.patches(), cuts).patches {
                let tau = taus.next().expect("one an item");
                let tau = [tau & 0xffff, tau >> 16].map(|t| t as usize);
                let to_pixels = camera.pixel_matrix() * DMat4::from(instance.transform);
                all.push(Self { patch: piece.patch, frame: case.frame, to_pixels, tau });
            }
        }
        assert!(taus.next().is_none(), "one an item");
        all
    }

    pub(crate) fn rational(&self) -> bool {
        !self.patch.is_polynomial()
    }

    /// More segments would have been needed than a patch can have.
    pub(crate) fn clamped(&self) -> bool {
        self.tau.contains(&(MOST_SEGMENTS as usize))
    }

    /// Homogeneous pixels of `S`, with how far behind the near plane as third coordinate, at the lattice of `cells` cells from `first`.
    fn lattice(
        &self,
        tau: [usize; 2],
        first: [usize; 2],
        cells: [usize; 2],
        fineness: usize,
        emit: Emit,
    ) -> Vec<Vec<DVec4>> {
        let patch = &self.patch;
        let at = |axis: usize, i: usize| (first[axis] * fineness + i) as f64 / (tau[axis] * fineness) as f64;
        let rows: Vec<_> = (0..=patch.degree_v).map(|j| Bezier { points: patch.row(j).to_vec() }).collect();
        let column = |i: usize| {
            let across = Bezier { points: rows.iter().map(|row| row.homogeneous(at(0, i))).collect() };
            let point = |j: usize| {
                let p = across.homogeneous(at(1, j));
                let p = if emit == Emit::Point { p.point().extend(1.0) } else { p };
                let q = self.to_pixels * p;
                DVec4::new(q.x, q.y, q.z - f64::from(self.frame.near) * p.w, q.w)
            };
            (0..=cells[1] * fineness).map(point).collect()
        };
        (0..=cells[0] * fineness).map(column).collect()
    }

    /// In the picture, behind the near plane; nothing is behind the far one.
    fn seen(&self, q: DVec4) -> bool {
        let frame = &self.frame;
        let inside = |x: f64, size: f32| (0.0..=f64::from(size) * q.w).contains(&x);
        q.w > 0.0 && q.z >= 0.0 && inside(q.x, frame.size[0]) && inside(q.y, frame.size[1])
    }

    /// Compares the triangulation of `tau` segments with the surface, at `fineness` intervals along a side of a cell.
    pub(crate) fn measure(&self, tau: [usize; 2], fineness: usize, emit: Emit) -> Deviation {
        let r = &mut Random::new(tau[0] as u64);
        let cells = tau.map(|t| t.min(WINDOW));
        let first = [0, 1].map(|a| r.integer(0, (tau[a] - cells[a]) as u32) as usize);
        let s = self.lattice(tau, first, cells, fineness, emit);
        let mut most = Deviation { whole: cells == tau, ..Default::default() };
        for (i, j) in (0..cells[0]).flat_map(|i| (0..cells[1]).map(move |j| (i * fineness, j * fineness))) {
            let corners = [s[i][j], s[i + fineness][j], s[i][j + fineness], s[i + fineness][j + fineness]];
            for (a, b) in (0..=fineness).flat_map(|a| (0..=fineness).map(move |b| (a, b))) {
                let exact = s[i + a][j + b];
                for t in triangles_at(corners, a as f64 / fineness as f64, b as f64 / fineness as f64) {
                    if self.seen(t) && exact.w > 0.0 {
                        let (px, deep) = (pixel(t).distance(pixel(exact)), self.depth_px(t, exact));
                        most.px = most.px.max(px);
                        most.space_px = most.space_px.max(px.hypot(deep));
                        most.points += 1;
                    } else {
                        most.whole = false;
                    }
                }
            }
        }
        most
    }

    /// How far apart two points are in depth, in pixels there.
    fn depth_px(&self, t: DVec4, s: DVec4) -> f64 {
        let focal = f64::from(self.frame.focal);
        // in perspective w is the depth, of homogeneous points times a weight that only their vertices know
        if self.frame.perspective != 0 {
            focal * (t.w - s.w).abs() / s.w
        } else {
            focal * (t.z / t.w - s.z / s.w).abs()
        }
    }

    /// The smallest factors in the ratio of `tau` whose deviation, by `of`, is within the budget, as that of `tau` is.
    pub(crate) fn smallest(
        &self,
        tau: [usize; 2],
        fineness: usize,
        emit: Emit,
        of: impl Fn(Deviation) -> f64,
    ) -> [usize; 2] {
        let most = tau[0].max(tau[1]);
        let scaled = |part: usize| tau.map(|t| (t * part).div_ceil(most));
        let (mut low, mut high) = (0, most); // `high` suffices
        while high - low > 1 {
            let middle = (low + high) / 2;
            let kept = of(self.measure(scaled(middle), fineness, emit)) <= self.allowed();
            if kept { high = middle } else { low = middle }
        }
        scaled(high)
    }

    /// The deviation allowed; across the near plane, with the factor that the derivation of pass `bound` states.
    pub(crate) fn allowed(&self) -> f64 {
        let frame = &self.frame;
        let deviation = f64::from(frame.deviation_px);
        let points = self.patch.points.iter().map(|p| (self.to_pixels * p.point().extend(1.0)).z);
        let crosses = frame.perspective != 0 && points.fold(f64::INFINITY, f64::min) < f64::from(frame.near);
        if crosses { deviation / (1.0 - deviation / f64::from(frame.focal)) } else { deviation }
    }
}

fn pixel(q: DVec4) -> DVec2 {
    DVec2::new(q.x, q.y) / q.w
}

/// The point of the cell's triangles at `(s, t)`, for one diagonal and for the other.
fn triangles_at([a, b, c, d]: [DVec4; 4], s: f64, t: f64) -> [DVec4; 2] {
    let rising = if t <= s { a + (b - a) * s + (d - b) * t } else { a + (c - a) * t + (d - c) * s };
    let falling =
        if s + t <= 1.0 { a + (b - a) * s + (c - a) * t } else { d + (c - d) * (1.0 - s) + (b - d) * (1.0 - t) };
    [rising, falling]
}

/// Nets from nearly flat to wild; every third without weights.
fn random_surface(r: &mut Random, kind: Kind) -> Surface {
    let rational = r.integer(0, 2) > 0;
    let (lo, hi) = kind.degrees;
    let (n, k) = (r.integer(lo, hi) as usize, r.integer(lo, hi) as usize);
    let (noise, ratio) = (r.pick(&[0.05, 0.3, 1.0]), r.pick(kind.ratios));
    let mut point = |i: usize, j: usize| {
        let on_plane = DVec3::new(i as f64 / n as f64, j as f64 / k as f64, 0.0);
        let off = [0; 3].map(|_| r.range(-noise, noise));
        let weight = if rational { ratio.powf(r.range(0.0, 1.0)) } else { 1.0 };
        DVec4::from_point(on_plane + DVec3::from(off), weight)
    };
    let points = (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| point(i, j)).collect();
    let knots = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    Surface::new((n, k), knots(n), knots(k), points).expect("a Bézier patch")
}

fn placed(surface: Surface, transform: DAffine3) -> Model {
    let face = Face { id: 1, kind: SurfaceKind::BSpline, surface, loops: Vec::new(), same_sense: true, colour: None };
    let instance = Instance { part: 0, transform, colour: None, name: String::new() };
    Model { parts: vec![Part { faces: vec![face], ..Part::default() }], instances: vec![instance], ..Model::default() }
}

fn random_rotation(r: &mut Random) -> DQuat {
    let (a, b, c) = (r.range(0.0, 1.0), r.range(0.0, TAU), r.range(0.0, TAU));
    let (s, t) = ((1.0 - a).sqrt(), a.sqrt());
    DQuat::from_xyzw(s * b.sin(), s * b.cos(), t * c.sin(), t * c.cos()) // K. Shoemake, 1992
}

/// Turned, moved, and as often stretched unevenly or mirrored as not.
fn random_transform(r: &mut Random) -> DAffine3 {
    let scale = if r.integer(0, 1) == 0 { DVec3::splat(r.range(0.5, 20.0)) } else { DVec3::new(2.0, -0.5, 1.0) };
    let linear = DMat3::from_quat(random_rotation(r)) * DMat3::from_diagonal(scale);
    DAffine3 { matrix3: linear, translation: DVec3::new(r.range(-9.0, 9.0), 3.0, r.range(-9.0, 9.0)) }
}
