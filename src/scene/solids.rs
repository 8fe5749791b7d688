//! Boolean solids turned into what the GPU keeps: switches, and the surfaces around their primitives.
//!
//! ```text
//!   solids ──one tree: their union──▶ Blist ──▶ Leaf per switch ──▶ LeafSurface per side ──▶ Surface
//!                                                                                        (shared where
//!   cylinder:  round side (quadric) ∩ below the top ∩ above the bottom                    sides coincide)
//! ```
//!
//! A surface is stored in coordinates of its own, of about the size of 1, so single precision suffices;
//! where it is stays in `f64` and is given relative to the eye every frame.

use super::face::pack_colour;
use crate::abi;
use crate::csg::{Blist, Builder, Node, Op, Tree, TreeError};
use crate::model::{Primitive, Shape, Solid};
use glam::{DAffine3, DMat3, DVec3};

/// The arrays that the GPU gets, and the centres that change with the eye.
#[derive(Clone, Debug, Default)]
pub(crate) struct SolidData {
    pub leaves: Vec<abi::Leaf>,
    pub leaf_surfaces: Vec<abi::LeafSurface>,
    pub surfaces: Vec<abi::Surface>,
    /// Middle of each leaf's box, model coordinates.
    pub leaf_centres: Vec<DVec3>,
    /// Origin of each surface's own coordinates, in model coordinates.
    pub surface_centres: Vec<DVec3>,
}

/// Why a solid is not drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what each field is
pub enum UndrawnSolid {
    /// An operand that has no equations.
    #[error("solid {solid}, primitive {primitive}: a {kind} as operand is not drawn")]
    Operand { solid: usize, primitive: u32, kind: &'static str },
    /// The expression is too large.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

/// A surface where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    surface: abi::Surface,
    centre: DVec3,
}

/// A side of a primitive: the surface, and whether the primitive is where its function is positive.
type Side = (Placed, bool);

impl SolidData {
    /// The union of all `solids`.
    pub(crate) fn new(solids: &[Solid]) -> Result<Self, UndrawnSolid> {
        let mut data = Self::default();
        let (tree, primitives) = union(solids)?;
        let list = Blist::new(&tree)?;
        let middle = middle_of(solids);
        let mut sides: Vec<Vec<Side>> = Vec::with_capacity(primitives.len());
        for (i, (solid, p)) in primitives.iter().enumerate() {
            sides.push(sides_of(p, middle).map_err(|kind| UndrawnSolid::Operand {
                solid: *solid,
                primitive: i as u32,
                kind,
            })?);
        }
        let exits = list.entries().iter().enumerate().map(|(i, entry)| {
            let (t, f) = entry.exits(i as u32);
            let (in_exit, out_exit) = if entry.negative() { (f, t) } else { (t, f) };
            let exit = |to: u32| match to.checked_sub(list.outside()) {
                None => to,
                Some(0) => abi::EXIT_FALSE,
                Some(_) => abi::EXIT_TRUE,
            };
            (entry, exit(in_exit), exit(out_exit))
        });
        let mut shared = std::collections::HashMap::new();
        for (entry, in_exit, out_exit) in exits {
            let (_, primitive) = &primitives[entry.primitive() as usize];
            let bounds = primitive.bounds();
            let bounded = bounds.min.is_finite() && bounds.max.is_finite();
            let (centre, half) = match bounded {
                true if !bounds.is_empty() => (bounds.centre(), (bounds.max - bounds.min) * 0.5),
                true => (middle, DVec3::ZERO),
                false => (middle, DVec3::INFINITY),
            };
            let mut flags = 0;
            flags |= if bounded { 0 } else { abi::LEAF_UNBOUNDED };
            flags |= if entry.negative() { abi::LEAF_NEGATIVE } else { 0 };
            let leaf = data.leaves.len() as u32;
            let first = data.leaf_surfaces.len() as u32;
            for (placed, negated) in &sides[entry.primitive() as usize] {
                let next = data.surfaces.len() as u32;
                let surface = *shared.entry(placed.key()).or_insert(next);
                if surface == next {
                    data.surfaces.push(placed.surface);
                    data.surface_centres.push(placed.centre);
                }
                data.leaf_surfaces.push(abi::LeafSurface { surface: surface << 1 | u32::from(*negated), leaf });
            }
            data.leaf_centres.push(centre);
            data.leaves.push(abi::Leaf {
                half_size: half.as_vec3().to_array().map(f32::next_up),
                first,
                count: data.leaf_surfaces.len() as u32 - first,
                colour: pack_colour(primitive.colour),
                id: primitive.id,
                in_exit,
                out_exit,
                flags,
                ..Default::default()
            });
        }
        number_exits(&mut data.leaves);
        Ok(data)
    }

    /// `None` without leaves, else whether some surface is a torus.
    pub(crate) fn kinds(&self) -> Option<bool> {
        (!self.leaves.is_empty()).then(|| self.surfaces.iter().any(|s| s.kind == abi::SURFACE_TORUS))
    }

    /// What frames need once the GPU has the rest.
    pub(crate) fn centres_only(self) -> Self {
        let Self { leaf_centres, surface_centres, .. } = self;
        Self { leaf_centres, surface_centres, ..Self::default() }
    }
}

/// One tree over the primitives of all solids, each with the index of its solid.
fn union(solids: &[Solid]) -> Result<(Tree, Vec<(usize, &Primitive)>), TreeError> {
    let mut builder = Builder::new();
    let mut primitives = Vec::new();
    let mut roots = Vec::with_capacity(solids.len());
    for (i, solid) in solids.iter().enumerate() {
        let first = primitives.len() as u32;
        primitives.extend(solid.primitives().iter().map(|p| (i, p)));
        let mut map = Vec::with_capacity(solid.tree().nodes().len());
        for node in solid.tree().nodes() {
            map.push(match *node {
                Node::Constant(_) => builder.push(*node),
                Node::Leaf(p) => builder.leaf(first + p),
                Node::Complement(a) => builder.complement(map[a as usize]),
                Node::Pair(op, a, b) => builder.pair(op, map[a as usize], map[b as usize]),
            });
        }
        roots.extend(map.last());
    }
    let root = builder.fold(Op::Union, roots);
    Ok((builder.finish(root)?, primitives))
}

/// A point near everything that is bounded.
fn middle_of(solids: &[Solid]) -> DVec3 {
    let all = solids.iter().map(Solid::bounds).filter(|b| b.min.is_finite() && b.max.is_finite());
    let all = all.fold(crate::model::Bounds::EMPTY, crate::model::Bounds::union);
    if all.is_empty() { DVec3::ZERO } else { all.centre() }
}

/// Numbers the leaves so that the leaves whose chain of out-exits passes a leaf are a range, and marks
/// where the chains end. Exits lead forward.
fn number_exits(leaves: &mut [abi::Leaf]) {
    let mut size = vec![1u32; leaves.len()];
    for i in 0..leaves.len() {
        let out = leaves[i].out_exit;
        if out < abi::EXIT_FALSE {
            size[out as usize] += size[i];
        }
    }
    // parents stand behind their children, so they are numbered first; `next` is the first number free
    // below each leaf, and below the two ends
    let mut next = vec![0u32; leaves.len()];
    let mut ends = 0;
    for i in (0..leaves.len()).rev() {
        let out = leaves[i].out_exit;
        let free = if out < abi::EXIT_FALSE { &mut next[out as usize] } else { &mut ends };
        let pre = *free;
        *free += size[i];
        next[i] = pre + 1;
        let falls = match out {
            abi::EXIT_FALSE => abi::LEAF_FALLS,
            abi::EXIT_TRUE => 0,
            _ => leaves[out as usize].flags & abi::LEAF_FALLS,
        };
        let leaf = &mut leaves[i];
        (leaf.pre, leaf.end) = (pre, pre + size[i]);
        leaf.flags |= falls;
    }
}

impl Placed {
    /// Equal for equal surfaces.
    fn key(&self) -> Vec<u64> {
        let bits = bytemuck::bytes_of(&self.surface)
            .chunks(4)
            .map(|w| u64::from(u32::from_le_bytes([w[0], w[1], w[2], w[3]])));
        bits.chain(self.centre.to_array().map(f64::to_bits)).collect()
    }

    /// The plane `own · x = offset` of a primitive, given in its own coordinates; `own` points out.
    fn plane(to_own: DAffine3, own: DVec3, offset: f64, near: DVec3) -> Self {
        let gradient = to_own.matrix3.transpose() * own;
        let normal = gradient.normalize();
        let distance = (own.dot(to_own.transform_point3(near)) - offset) / gradient.length();
        let to_local = DMat3::from_cols(DVec3::Z * normal.x, DVec3::Z * normal.y, DVec3::Z * normal.z);
        let surface = abi::Surface {
            to_local: columns(to_local),
            kind: abi::SURFACE_PLANE,
            squares: [0.0; 3],
            linear: 0.5,
            constant: 0.0,
        };
        Self { surface, centre: near - distance * normal }
    }

    /// A surface about `centre` in the primitive's own coordinates, which are shrunk by `size`.
    fn round(p: &Primitive, to_own: DAffine3, centre: DVec3, size: f64, surface: abi::Surface) -> Self {
        let to_local = to_own.matrix3 * (1.0 / size);
        Self {
            surface: abi::Surface { to_local: columns(to_local), ..surface },
            centre: p.transform.transform_point3(centre),
        }
    }
}

fn columns(m: DMat3) -> [[f32; 3]; 3] {
    m.to_cols_array_2d().map(|c| c.map(|x| x as f32))
}

fn quadric(squares: [f64; 3], linear: f64, constant: f64) -> abi::Surface {
    abi::Surface {
        kind: abi::SURFACE_QUADRIC,
        squares: squares.map(|x| x as f32),
        linear: linear as f32,
        constant: constant as f32,
        ..Default::default()
    }
}

/// The sides of a primitive; planes get a point close to `near`. A primitive without volume is the
/// inside of no point: a ball of radius 0. The error is the kind of operand that has no equations.
fn sides_of(p: &Primitive, near: DVec3) -> Result<Vec<Side>, &'static str> {
    let empty = || vec![(Placed { surface: quadric([0.0; 3], 0.0, 1.0), centre: near }, false)];
    let Some(to_own) = p.to_own() else { return Ok(empty()) };
    if p.shape.bounds().is_empty() {
        return Ok(empty());
    }
    let plane = |own: DVec3, offset: f64| (Placed::plane(to_own, own, offset, near), false);
    let slab = |height: f64| [plane(DVec3::NEG_Z, 0.0), plane(DVec3::Z, height)];
    let round = |centre: DVec3, size: f64, surface| (Placed::round(p, to_own, centre, size, surface), false);
    Ok(match p.shape {
        Shape::HalfSpace { normal, offset } => vec![plane(normal, offset)],
        Shape::Block { min, max } => {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            axes.into_iter().flat_map(|a| [plane(-a, -a.dot(min)), plane(a, a.dot(max))]).collect()
        }
        Shape::Sphere { radius } => vec![round(DVec3::ZERO, radius, quadric([1.0; 3], 0.0, -1.0))],
        Shape::Cylinder { radius, height } => {
            let side = round(DVec3::Z * (height * 0.5), radius, quadric([1.0, 1.0, 0.0], 0.0, -1.0));
            [side].into_iter().chain(slab(height)).collect()
        }
        Shape::Cone { bottom, top, height } => {
            // x² + y² < (middle + slope z)², all over the larger radius
            let size = bottom.max(top);
            let (middle, slope) = ((bottom + top) * 0.5 / size, (top - bottom) / height);
            let surface = quadric([1.0, 1.0, -slope * slope], -middle * slope, -middle * middle);
            [round(DVec3::Z * (height * 0.5), size, surface)].into_iter().chain(slab(height)).collect()
        }
        Shape::Torus { major, minor } => {
            // without a circle to run around, the tube is a ball
            let surface = match major > 0.0 {
                true => {
                    abi::Surface { kind: abi::SURFACE_TORUS, constant: (minor / major) as f32, ..Default::default() }
                }
                false => quadric([1.0; 3], 0.0, -1.0),
            };
            vec![round(DVec3::ZERO, if major > 0.0 { major } else { minor }, surface)]
        }
        Shape::Quadric(_) => return Err("general quadric"),
        Shape::Mesh(_) => return Err("mesh"),
        Shape::Part(_) => return Err("spline solid"),
    })
}
