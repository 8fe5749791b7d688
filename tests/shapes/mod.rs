//! Small exact models with names: each has one thing that is hard for renderers.
//!
//! ```text
//!   sphere     poles, where a side of a patch is one point      torus    closed both ways
//!   cylinder   trimmed by its own seam, as CAD files have it    plate    a plane with a round hole
//!   cube       six planes that meet only where they are trimmed, half of them inside out
//!   wave       polynomial, bicubic                              ripple   polynomial, degrees 6 and 5
//!   pair       one part placed twice
//!   far_away   features of 1e-3 at a distance of 1e6            mirrored a part turned inside out
//!   tetra      one closed mesh                                facets   it placed twice, once mirrored
//!   beside     a mesh that cuts into a trimmed face           globe    and into one without trims
//!   floor      solids and shells before meshes                ball     a mesh with normals
//!   touching   a front just before another solid's back   empty    nothing at all
//!   ledges     walls that rise a third of a pixel above one another
//!   stair      plates whose sides have no trims, beside trimmed tops and bottoms
//! ```
//!
//! Circles are quadratic arcs of a quarter turn with weights 1, 1/√2, 1 (Piegl and Tiller, *The NURBS Book*, 1997,
//! section 7.3), so every shape is exact; [`circle_at`] gives a point's parameter.

#![allow(dead_code)] // each test binary uses some of them

pub mod borders;
mod meshes;
pub mod operands;
pub mod solids;

pub use meshes::*;

use glam::{DAffine3, DMat3, DVec2, DVec3, DVec4};
use selvedge::model::{Colour, Face, Instance, Model, Part, SurfaceKind, TrimLoop};
use selvedge::spline::{Bezier, Control, Surface};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_8, SQRT_2};

/// Radius of [`sphere`], around the origin.
pub const SPHERE_RADIUS: f64 = 3.0;
/// Radii of [`torus`], around the z axis.
pub const TORUS_RADII: (f64, f64) = (3.0, 1.0);
/// Radius and height of [`cylinder`], from the origin up the z axis.
pub const CYLINDER: (f64, f64) = (1.5, 4.0);
/// Half the side of [`plate`] in the plane z = 0.
pub const PLATE_HALF: f64 = 3.0;
/// Centre and radius of the hole in [`plate`].
pub const PLATE_HOLE: (DVec2, f64) = (DVec2::new(0.5, 0.25), 1.25);
/// Half the edge of [`cube`], around the origin.
pub const CUBE_HALF: f64 = 1.0;

/// Depth of the strip below the face in [`touching`].
pub const TOUCHING_GAP: f64 = 0.003;
/// Half its width.
pub const TOUCHING_STRIP: f64 = 0.375;

/// Half the width of the one of [`touching_at_its_end`].
pub const TOUCHING_END: f64 = 0.75;

/// Tops of the walls of [`ledges`], face 1 to 4, nearest first.
pub const LEDGES: [f64; 4] = [0.0, 0.31, 0.75, 8.0];

/// A model and what a scene of it must not contain.
pub struct Shape {
    pub name: &'static str,
    pub model: Model,
    /// Some face has loops.
    pub trimmed: bool,
    /// Some surface has unequal weights.
    pub rational: bool,
}

/// Every shape.
pub fn all() -> Vec<Shape> {
    let shape = |name, model, trimmed, rational| Shape { name, model, trimmed, rational };
    vec![
        shape("sphere", sphere(), false, true),
        shape("torus", torus(), false, true),
        shape("cylinder", cylinder(), true, true),
        shape("plate", plate(), true, false),
        shape("cube", cube(), true, false),
        shape("wave", wave(), false, false),
        shape("ripple", ripple(), false, false),
        shape("pair", pair(), true, false),
        shape("far_away", far_away(DVec3::splat(1e6)), true, true),
        shape("mirrored", mirrored(), true, true),
        shape("tetra", tetra(), false, false),
        shape("facets", facets(), false, false),
        shape("beside", beside(), true, true),
        shape("globe", globe(), false, true),
        shape("floor", floor(), true, false),
        shape("ball", ball(), false, false),
        shape("touching", touching(), true, false),
        shape("ledges", ledges(), true, false),
        shape("empty", empty(), false, false),
    ]
}

/// A whole sphere; u turns around z, v rises from the south pole at -π/2.
pub fn sphere() -> Model {
    one("sphere", true, vec![face(1, SurfaceKind::Sphere, sphere_surface(SPHERE_RADIUS, DVec3::ZERO))])
}

/// A whole torus; u turns around z, v around the tube from its outermost circle.
pub fn torus() -> Model {
    let (major, minor) = TORUS_RADII;
    let tube = ring().map(|(a, b, w)| (major + minor * a, minor * b, w));
    let surface = revolved(2, ring_knots(), &tube, DVec3::ZERO);
    one("torus", true, vec![face(1, SurfaceKind::Torus, surface)])
}

/// The mantle of a cylinder, with the loop up one side of the seam and down the other.
pub fn cylinder() -> Model {
    let (radius, height) = CYLINDER;
    let surface =
        revolved(1, vec![0.0, 0.0, height, height], &[(radius, 0.0, 1.0), (radius, height, 1.0)], DVec3::ZERO);
    let seam = rectangle(DVec2::ZERO, DVec2::new(4.0 * FRAC_PI_2, height));
    one("cylinder", false, vec![Face { loops: vec![seam], ..face(1, SurfaceKind::Cylinder, surface) }])
}

/// A square plate with a round hole.
pub fn plate() -> Model {
    one("plate", false, vec![plate_face(1.0, DVec3::ZERO)])
}

/// A closed cube. Each plane reaches beyond its face by half; every other face has its surface
/// normal pointing inwards.
pub fn cube() -> Model {
    let sides = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let faces = (1..).zip(sides).map(|(id, outward)| {
        let same_sense = id % 2 == 0;
        let x = outward.any_orthonormal_vector();
        let y = if same_sense { outward.cross(x) } else { x.cross(outward) };
        let surface = plane(outward * CUBE_HALF, x, y, 1.5 * CUBE_HALF);
        let square = rectangle(DVec2::splat(-CUBE_HALF), DVec2::splat(CUBE_HALF));
        Face { loops: vec![square], same_sense, ..face(id, SurfaceKind::Plane, surface) }
    });
    one("cube", true, faces.collect())
}

/// One bicubic patch with a hill and a hollow.
pub fn wave() -> Model {
    one("wave", false, vec![face(1, SurfaceKind::BSpline, height_field((3, 3), wave_height))])
}

/// One patch of degrees 6 and 5 with several hills: no loop over control points ends early.
pub fn ripple() -> Model {
    one("ripple", false, vec![face(1, SurfaceKind::BSpline, height_field((6, 5), ripple_height))])
}

/// Height of control point (i, j) of [`wave`].
pub fn wave_height(i: usize, j: usize) -> f64 {
    [[0.0, 1.0, -1.0, 0.0], [1.0, 3.0, 0.0, -1.0], [-1.0, 0.0, -3.0, 1.0], [0.5, -1.0, 1.0, 0.0]][j][i]
}

/// Height of control point (i, j) of [`ripple`].
pub fn ripple_height(i: usize, j: usize) -> f64 {
    let checker = if (i / 2 + j / 2).is_multiple_of(2) { 1.5 } else { -1.5 };
    checker + 0.25 * (i as f64 - j as f64)
}

/// A polynomial patch over the square `[0, 3] x [0, 3]`: the control points stand evenly, so that
/// x = 3 u and y = 3 v, with u and v in `[0, 1]`.
fn height_field((n, m): (usize, usize), height: fn(usize, usize) -> f64) -> Surface {
    let at = |k: usize, degree: usize| 3.0 * k as f64 / degree as f64;
    let net = (0..=m).flat_map(|j| (0..=n).map(move |i| DVec4::new(at(i, n), at(j, m), height(i, j), 1.0)));
    let knots = |degree| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    Surface::new((n, m), knots(n), knots(m), net.collect()).expect("a polynomial patch")
}

/// A face without loops: a bicubic sheet of `n` by `n` patches with hills, over a square from `corner` on.
pub fn sheet(id: u32, corner: DVec3, side: f64, n: usize) -> Face {
    let knots = || [vec![0.0; 4], (1..n).map(|k| k as f64).collect(), vec![n as f64; 4]].concat();
    let at = |k: usize| side * k as f64 / (n + 2) as f64;
    let points = (0..(n + 3) * (n + 3)).map(|k| {
        let (i, j) = (k % (n + 3), k / (n + 3));
        let height = 0.05 * ((7 * i + 3 * j) % 5) as f64;
        (corner + DVec3::new(at(i), at(j), height)).extend(1.0)
    });
    let surface = Surface::new((3, 3), knots(), knots(), points.collect()).expect("a sheet");
    face(id, SurfaceKind::BSpline, surface)
}

/// The plate twice: lying, and standing above it in another colour.
pub fn pair() -> Model {
    let upright = DAffine3::from_mat3_translation(DMat3::from_rotation_x(FRAC_PI_2), DVec3::new(0.0, 0.0, 3.5));
    let mut model = plate();
    model.instances = vec![placed(DAffine3::IDENTITY, None), placed(upright, Some([0.8, 0.1, 0.1, 1.0]))];
    model
}

/// A plate of 2e-3 with a hole, and a ball beside it, both around `offset`: the control points
/// themselves are that far away.
pub fn far_away(offset: DVec3) -> Model {
    let ball = sphere_surface(4e-4, offset + DVec3::new(-5e-4, -5e-4, 4e-4));
    let small = 1e-3 / PLATE_HALF;
    one("far away", false, vec![plate_face(small, offset), face(2, SurfaceKind::Sphere, ball)])
}

/// The cylinder and a plate as one part, mirrored in x.
pub fn mirrored() -> Model {
    let mut model = cylinder();
    model.parts[0].faces.push(Face { id: 2, ..plate_face(1.0, DVec3::ZERO) });
    model.instances[0].transform = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    model
}

/// Face 1 of a solid, a square that faces up, and [`TOUCHING_GAP`] below it face 2 of another solid, a strip along y
/// that faces down. Files have such faces where solids cut into each other, or where a face has the wrong orientation.
pub fn touching() -> Model {
    let strip = level(2, (-TOUCHING_STRIP, TOUCHING_STRIP), -TOUCHING_GAP);
    two_parts([vec![level(1, (-PLATE_HALF, PLATE_HALF), 0.0)], vec![strip]])
}

/// The same with face 1 ending together with the strip, at x = [`TOUCHING_END`]; the strip's solid has a floor below
/// both, 3.
pub fn touching_at_its_end() -> Model {
    let strip = level(2, (-TOUCHING_END, TOUCHING_END), -TOUCHING_GAP);
    let floor = level(3, (-PLATE_HALF, PLATE_HALF), -0.3);
    two_parts([vec![level(1, (-PLATE_HALF, TOUCHING_END), 0.0)], vec![strip, floor]])
}

/// A rectangle from one x to another; face 2 faces down.
fn level(id: u32, (from, to): (f64, f64), z: f64) -> Face {
    Face {
        loops: vec![rectangle(DVec2::new(from, -PLATE_HALF), DVec2::new(to, PLATE_HALF))],
        same_sense: id != 2,
        ..face(id, SurfaceKind::Plane, plane(DVec3::Z * z, DVec3::X, DVec3::Y, 1.5 * PLATE_HALF))
    }
}

fn two_parts([a, b]: [Vec<Face>; 2]) -> Model {
    let mut model = one("touching", true, a);
    model.parts.extend(one("strip", true, b).parts);
    model.instances.push(Instance { part: 1, ..placed(DAffine3::IDENTITY, None) });
    model
}

/// Walls of solids that face -y, one behind the other, faces 1 to 4, each a little higher than the one before; and the
/// back of the nearest, 5, which ends where its front does.
pub fn ledges() -> Model {
    let wall = |id: u32, top: f64, y: f64| Face {
        loops: vec![rectangle(DVec2::splat(-8.0), DVec2::new(8.0, top))],
        same_sense: id != 5,
        ..face(id, SurfaceKind::Plane, plane(DVec3::Y * y, DVec3::X, DVec3::Z, 12.0))
    };
    let fronts = (1..).zip(LEDGES).map(|(id, top)| wall(id, top, 2.0 * f64::from(id)));
    one("ledges", true, fronts.chain([wall(5, LEDGES[0], 3.0)]).collect())
}

/// Twenty-four treads around the z axis, as of a spiral stair. Top and bottom, faces 1 and 2, are trimmed; the sides, 3
/// to 6, are bilinear and end where their surfaces end.
pub fn stair() -> Model {
    let corners = [(6.0, -3.0), (44.0, -9.0), (44.0, 9.0), (6.0, 3.0)].map(|(x, y)| DVec2::new(x, y));
    let side = |i: usize| (corners[i], corners[(i + 1) % 4]);
    let outline = || closed((0..4).map(|i| Bezier::line(side(i).0, side(i).1)).collect());
    let level = |id: u32, z: f64| Face {
        loops: vec![outline()],
        same_sense: id == 1,
        ..face(id, SurfaceKind::Plane, plane(DVec3::Z * z, DVec3::X, DVec3::Y, 50.0))
    };
    let wall = |i: usize| {
        let (a, b) = side(i);
        let points = [a.extend(0.0), b.extend(0.0), a.extend(3.0), b.extend(3.0)].map(|p| p.extend(1.0));
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let surface = Surface::new((1, 1), knots.clone(), knots, points.to_vec()).expect("a quadrilateral");
        face(3 + i as u32, SurfaceKind::Plane, surface)
    };
    let mut model = one("stair", true, [level(1, 3.0), level(2, 0.0)].into_iter().chain((0..4).map(wall)).collect());
    let step = |k: i32| {
        DAffine3::from_translation(DVec3::Z * 4.5 * f64::from(k)) * DAffine3::from_rotation_z(f64::from(k) * FRAC_PI_8)
    };
    model.instances = (0..24).map(|k| placed(step(k), None)).collect();
    model
}

/// No part and no instance.
pub fn empty() -> Model {
    Model::default()
}

/// `(x, y)` on the unit circle where a turn by these arcs has parameter `x` in `[-π/2, 2π]`: `(s² +
/// √2 s t, √2 s t + t²) / (s² + √2 s t + t²)` with `t` in `[0, 1]` over a quarter and `s = 1 - t`.
/// The angle is `x` at multiples of π/4, and nearly so between.
pub fn circle_at(x: f64) -> (f64, f64) {
    let quarter = (x / FRAC_PI_2).floor().clamp(-1.0, 3.0);
    let t = x / FRAC_PI_2 - quarter;
    let s = 1.0 - t;
    let between = SQRT_2 * s * t;
    let weight = s * s + between + t * t;
    let (a, b) = ((s * s + between) / weight, (between + t * t) / weight);
    match quarter as i32 {
        -1 => (b, -a),
        0 => (a, b),
        1 => (-b, a),
        2 => (-a, -b),
        _ => (b, -a),
    }
}

/// A model of one part, placed once without a transform.
pub fn one(name: &str, closed: bool, faces: Vec<Face>) -> Model {
    Model {
        name: name.to_owned(),
        parts: vec![Part { name: name.to_owned(), faces, closed, ..Part::default() }],
        instances: vec![placed(DAffine3::IDENTITY, None)],
        unit: "mm".to_owned(),
        ..Model::default()
    }
}

/// The first part, placed.
pub fn placed(transform: DAffine3, colour: Option<Colour>) -> Instance {
    Instance { part: 0, transform, colour, name: String::new() }
}

pub fn face(id: u32, kind: SurfaceKind, surface: Surface) -> Face {
    Face { id, kind, surface, loops: Vec::new(), same_sense: true, colour: None }
}

fn plate_face(scale: f64, offset: DVec3) -> Face {
    let surface = plane(offset, DVec3::X * scale, DVec3::Y * scale, PLATE_HALF);
    let (centre, radius) = PLATE_HOLE;
    let outer = rectangle(DVec2::splat(-PLATE_HALF), DVec2::splat(PLATE_HALF));
    Face { loops: vec![outer, circle(centre, radius).reversed()], ..face(1, SurfaceKind::Plane, surface) }
}

/// `origin + u x + v y` for u and v within `half` of 0.
fn plane(origin: DVec3, x: DVec3, y: DVec3, half: f64) -> Surface {
    let knots = vec![-half, -half, half, half];
    let corners = [(-half, -half), (half, -half), (-half, half), (half, half)];
    let points = corners.map(|(u, v)| (origin + x * u + y * v).extend(1.0));
    Surface::new((1, 1), knots.clone(), knots, points.to_vec()).expect("a plane")
}

fn sphere_surface(radius: f64, centre: DVec3) -> Surface {
    let s = FRAC_1_SQRT_2;
    let meridian = [(0.0, -1.0, 1.0), (1.0, -1.0, s), (1.0, 0.0, 1.0), (1.0, 1.0, s), (0.0, 1.0, 1.0)];
    let h = FRAC_PI_2;
    let knots = vec![-h, -h, -h, 0.0, 0.0, h, h, h];
    revolved(2, knots, &meridian.map(|(r, z, w)| (radius * r, radius * z, w)), centre)
}

/// A profile of (distance from the axis, height, weight), turned once around z.
fn revolved(degree: usize, knots: Vec<f64>, profile: &[(f64, f64, f64)], offset: DVec3) -> Surface {
    let points = profile.iter().flat_map(|&(r, z, wv)| {
        ring().map(|(a, b, wu)| DVec4::from_point(offset + DVec3::new(a * r, b * r, z), wu * wv))
    });
    Surface::new((2, degree), ring_knots(), knots, points.collect()).expect("a surface of revolution")
}

/// The unit circle's control points and weights.
fn ring() -> [(f64, f64, f64); 9] {
    let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    std::array::from_fn(|i| {
        let (x, y) = corners[i];
        (f64::from(x), f64::from(y), if i % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 })
    })
}

/// Knots of [`ring`] over `[0, 2π]`.
fn ring_knots() -> Vec<f64> {
    [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].map(|quarter| f64::from(quarter) * FRAC_PI_2).to_vec()
}

/// A counter-clockwise rectangle.
pub fn rectangle(lo: DVec2, hi: DVec2) -> TrimLoop {
    let corners = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
    closed((0..4).map(|i| Bezier::line(corners[i], corners[(i + 1) % 4])).collect())
}

/// A counter-clockwise circle.
fn circle(centre: DVec2, radius: f64) -> TrimLoop {
    let points = ring().map(|(a, b, w)| DVec3::from_point(centre + radius * DVec2::new(a, b), w));
    closed((0..4).map(|i| Bezier { points: points[2 * i..2 * i + 3].to_vec() }).collect())
}

fn closed(curves: Vec<Bezier<DVec3>>) -> TrimLoop {
    TrimLoop::new(curves, DVec2::splat(1e-12)).expect("the shape is closed")
}
