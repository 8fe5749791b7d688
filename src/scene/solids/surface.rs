//! The sides of primitives as the GPU evaluates them: each in coordinates of its own.
//!
//! ```text
//!   x ──to_own──▶ primitive ──axes, centre, 1 / size──▶ local      squares · p² + 2 linear z + constant
//!                    quadric: eigenvectors ┘                       torus of major radius 1
//! ```

use crate::abi;
use crate::math::eigen;
use crate::model::{Carrier, Primitive, Quadric, Shape};
use glam::{DAffine3, DMat3, DVec3};

/// The shape of a surface other than a plane, in coordinates of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Surface {
    /// Columns of the map from model directions.
    pub to_local: [[f32; 3]; 3],
    pub is_torus: bool,
    pub squares: [f32; 3],
    pub linear: f32,
    pub constant: f32,
}

impl Surface {
    /// As shaders read it: `surface_at` of `glsl/include/solids.glsl`.
    pub(crate) fn texels(&self) -> [[f32; 4]; 4] {
        let with = |[x, y, z]: [f32; 3], w| [x, y, z, w];
        let [x, y, z] = self.to_local;
        let kind = if self.is_torus { abi::SURFACE_TORUS } else { abi::SURFACE_QUADRIC };
        [with(x, kind as f32), with(y, self.linear), with(z, self.constant), with(self.squares, 0.0)]
    }

    fn placed(self, to_local: DMat3) -> Self {
        Self { to_local: to_local.to_cols_array_2d().map(|c| c.map(|x| x as f32)), ..self }
    }
}

/// A surface that one or more sides of leaves share.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Placed {
    Plane {
        /// Unit normal.
        normal: DVec3,
        /// A point of the plane.
        at: DVec3,
    },
    Round {
        surface: Surface,
        /// Origin of its own coordinates, in model coordinates.
        centre: DVec3,
    },
}

impl Placed {
    /// Its place relative to the eye, as shaders read it; for a plane the normal and the distance along it.
    pub(crate) fn seen_from(&self, eye: DVec3) -> [f32; 4] {
        match *self {
            Self::Plane { normal, at } => {
                let n = normal.as_vec3();
                // the distance is along the rounded normal, so the plane stays in place
                n.extend(n.as_dvec3().dot(at - eye) as f32).to_array()
            }
            Self::Round { centre, .. } => (centre - eye).as_vec3().extend(0.0).to_array(),
        }
    }

    pub(super) fn surface(&self) -> Option<Surface> {
        match *self {
            Self::Plane { .. } => None,
            Self::Round { surface, .. } => Some(surface),
        }
    }

    /// The plane `own · x = offset` of a primitive, given in its own coordinates; `own` points out.
    fn plane(to_own: DAffine3, own: DVec3, offset: f64, near: DVec3) -> Self {
        let gradient = to_own.matrix3.transpose() * own;
        let normal = gradient.normalize();
        let distance = (own.dot(to_own.transform_point3(near)) - offset) / gradient.length();
        Self::Plane { normal, at: near - distance * normal }
    }

    /// A surface around `centre` in the primitive's coordinates, scaled down by `size`.
    fn round(p: &Primitive, to_own: DAffine3, centre: DVec3, size: f64, surface: Surface) -> Self {
        let to_local = to_own.matrix3 * (1.0 / size);
        Self::Round { surface: surface.placed(to_local), centre: p.transform.transform_point3(centre) }
    }

    /// A quadric with at least one term of second order, or with no terms but the constant.
    fn quadric(p: &Primitive, to_own: DAffine3, q: &Quadric, near: DVec3) -> Self {
        let Local { axes, centre, size, surface } = Local::new(q, to_own.transform_point3(near));
        let to_local = axes.transpose() * to_own.matrix3 * (1.0 / size);
        Self::Round { surface: surface.placed(to_local), centre: p.transform.transform_point3(centre) }
    }
}

fn quadric(squares: [f64; 3], linear: f64, constant: f64) -> Surface {
    Surface {
        squares: squares.map(|x| x as f32),
        linear: linear as f32,
        constant: constant as f32,
        ..Default::default()
    }
}

/// A surface with no point inside.
pub(super) fn nowhere(centre: DVec3) -> Placed {
    Placed::Round { surface: quadric([0.0; 3], 0.0, 1.0), centre }
}

/// A second-order coefficient below this share of the largest is taken as a rounded 0. The centre computed from it
/// would be meaningless.
const NULL: f64 = 1e-9;
/// Below this share, the z axis keeps its linear term: the centre may be far away although the surface is near.
const FLAT: f64 = 1e-3;

/// A quadric in its own axes.
struct Local {
    /// Columns: the axes.
    axes: DMat3,
    centre: DVec3,
    size: f64,
    surface: Surface,
}

impl Local {
    /// The quadric about a centre near `near`.
    fn new(q: &Quadric, near: DVec3) -> Self {
        let m = q.products * 0.5;
        let (values, vectors) =
            eigen::symmetric([[q.squares.x, m.x, m.z], [m.x, q.squares.y, m.y], [m.z, m.y, q.squares.z]]);
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| values[*b].abs().total_cmp(&values[*a].abs()));
        let mut axes = order.map(|k| DVec3::from_array(vectors[k]));
        let largest = values[order[0]].abs();
        let mut squares = order.map(|k| if values[k].abs() > NULL * largest { values[k] } else { 0.0 });
        if squares[1] == 0.0 {
            // a parabolic cylinder: the linear term lies along z
            let (b, c) = (q.linear.dot(axes[1]), q.linear.dot(axes[2]));
            let along = (axes[1] * b + axes[2] * c).normalize_or(axes[2]);
            (axes[1], axes[2]) = (along.cross(axes[0]), along);
        }
        let mut centre = DVec3::ZERO;
        for (k, axis) in axes.iter().enumerate() {
            let whole = squares[k] != 0.0 && (k < 2 || squares[k].abs() > FLAT * largest);
            let at = if whole { -0.5 * q.linear.dot(*axis) / squares[k] } else { near.dot(*axis) };
            centre += *axis * at;
        }
        let (value, slope) = (q.value(centre), q.gradient(centre).dot(axes[2]));
        let whole = squares[2] != 0.0 && squares[2].abs() > FLAT * largest;
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let size = (value.abs() / scale).sqrt();
        let size = if size > 0.0 && size.is_finite() { size } else { 1.0 };
        squares = squares.map(|s| s / scale);
        let linear = if whole { 0.0 } else { 0.5 * slope / (scale * size) };
        let surface = quadric(squares, linear, value / (scale * size * size));
        Self { axes: DMat3::from_cols(axes[0], axes[1], axes[2]), centre, size, surface }
    }
}

/// The plane of a primitive's triangle, given in the primitive's coordinates, with its point near `near`. `None` if the
/// primitive's transform is singular.
pub(super) fn of_triangle(p: &Primitive, corners: [DVec3; 3], near: DVec3) -> Option<Placed> {
    match Carrier::of_triangle(corners) {
        Carrier::Plane { normal, offset } => Some(Placed::plane(p.to_own()?, normal, offset, near)),
        Carrier::Quadric(_) | Carrier::Torus { .. } => unreachable!("a triangle's is a plane"),
    }
}

/// The sides of a primitive, in the order of [`Shape::carriers`]; planes get a point near `near`. Empty for parts and
/// for primitives without volume.
pub(super) fn sides_of(p: &Primitive, near: DVec3) -> Vec<Placed> {
    let Some(to_own) = p.to_own().filter(|_| !p.shape.bounds().is_empty()) else { return Vec::new() };
    let plane = |own: DVec3, offset: f64| Placed::plane(to_own, own, offset, near);
    let round = |centre: DVec3, size: f64, surface| Placed::round(p, to_own, centre, size, surface);
    let between = |side: Placed, height: f64| vec![side, plane(DVec3::NEG_Z, 0.0), plane(DVec3::Z, height)];
    match &p.shape {
        Shape::Sphere { radius } => vec![round(DVec3::ZERO, *radius, quadric([1.0; 3], 0.0, -1.0))],
        Shape::Cylinder { radius, height } => {
            between(round(DVec3::Z * (height * 0.5), *radius, quadric([1.0, 1.0, 0.0], 0.0, -1.0)), *height)
        }
        Shape::Cone { bottom, top, height } => {
            // x² + y² < (middle + slope z)², divided by the larger radius
            let size = bottom.max(*top);
            let (middle, slope) = ((bottom + top) * 0.5 / size, (top - bottom) / height);
            let surface = quadric([1.0, 1.0, -slope * slope], -middle * slope, -middle * middle);
            between(round(DVec3::Z * (height * 0.5), size, surface), *height)
        }
        Shape::Torus { major, minor } if *major > 0.0 => {
            let surface = Surface { is_torus: true, constant: (minor / major) as f32, ..Default::default() };
            vec![round(DVec3::ZERO, *major, surface)]
        }
        // without a major radius, the torus is a ball
        Shape::Torus { minor, .. } => vec![round(DVec3::ZERO, *minor, quadric([1.0; 3], 0.0, -1.0))],
        Shape::HalfSpace { .. } | Shape::Block { .. } | Shape::Quadric(_) | Shape::Mesh(_) => {
            let side = |carrier: &Carrier| match carrier {
                Carrier::Plane { normal, offset } => plane(*normal, *offset),
                Carrier::Quadric(q) => Placed::quadric(p, to_own, q, near),
                Carrier::Torus { .. } => unreachable!("no side of these shapes"),
            };
            p.shape.carriers().iter().map(side).collect()
        }
        Shape::Part(_) => Vec::new(),
    }
}
