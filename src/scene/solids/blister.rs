//! The data of way `blister` in addition to the leaves: labels for their Blist, and the order in which they are drawn.
//!
//! ```text
//!   expression ─positive, fewest labels─▶ Blist ─▶ Switch: leaf, name, next when within, next when not
//!                                 └─ covering set ─▶ the leaves of the first layer
//! ```

use super::SolidData;
use crate::abi::{LEAF_BOUNDARY, LEAF_NEGATIVE, LEAF_UNBOUNDED};
use crate::csg::{Blist, Convention, Labels, Tree, TreeError, covering_set};
use crate::model::{Bounds, Camera, Primitive, oriented_outwards};
use std::ops::Range;

/// The primitive that a switch tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    /// The leaf at this place of [`Blister::order`].
    Leaf(u32),
    /// The meshes of this operand.
    Operand(u32),
}

/// One step of the walk. Pixels with label `name` get label `within` if their point is inside the primitive, else
/// `without`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Switch {
    pub asked: Asked,
    pub name: u32,
    pub within: u32,
    pub without: u32,
}

/// A mesh of an operand, and the roles of the operand's leaves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct PeeledMesh {
    /// The operand that it bounds.
    pub operand: u32,
    /// The corners of its triangles.
    pub corners: Range<u32>,
    /// Some leaf adds the operand.
    pub adds: bool,
    /// Some leaf subtracts the operand.
    pub takes_away: bool,
    /// The operand belongs to the covering set.
    pub covers: bool,
}

/// The walk, and the leaves and meshes that are peeled.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Blister {
    pub switches: Vec<Switch>,
    /// The labels of the two results.
    pub inside: Option<u32>,
    pub outside: Option<u32>,
    /// Leaves with equations in the order of drawing: all of them, then those of the covering set.
    pub order: Vec<u32>,
    pub all: Range<u32>,
    pub cover: Range<u32>,
    /// Meshes of operands, in the order of their numbers.
    pub meshes: Vec<PeeledMesh>,
    /// A covering set was found.
    pub covered: bool,
    /// The box around all leaves, in model coordinates; `None` if a leaf is unbounded.
    pub bounds: Option<Bounds>,
}

impl Blister {
    /// For the leaves of `data`, whose expression is `tree` over `primitives`. `leaf_of` has the first leaf of each
    /// primitive, as it is and complemented.
    pub(super) fn new(
        data: &SolidData,
        tree: &Tree,
        primitives: &[Primitive],
        leaf_of: &[[Option<u32>; 2]],
    ) -> Result<Self, TreeError> {
        let positive = tree.positive()?;
        let positive = positive.with_fewest_labels(Convention::WhenUsed);
        let Labels { switches, inside, outside, count } = Blist::new(&positive)?.labels(Convention::WhenUsed);
        assert!(count <= MOST_LABELS, "a tree that fits in memory needs few labels");
        let leaf = |p: u32, negative| leaf_of[p as usize][usize::from(negative)].expect("every switch is a leaf");
        let leaves = &data.leaves;
        let has = |i: u32, flag: u32| leaves[i as usize].flags & flag != 0;
        let mut order = super::order::order(leaves, false);
        order.retain(|&i| !has(i, LEAF_BOUNDARY));
        let all = 0..order.len() as u32;
        let mut places = vec![0; leaves.len()];
        (0..).zip(&order).for_each(|(place, &i)| places[i as usize] = place);
        let switches = switches
            .iter()
            .map(|s| {
                let i = leaf(s.primitive, s.negative);
                let operand = has(i, LEAF_BOUNDARY);
                let asked =
                    if operand { Asked::Operand(leaves[i as usize].first) } else { Asked::Leaf(places[i as usize]) };
                let (within, without) = if s.negative { (s.when_out, s.when_in) } else { (s.when_in, s.when_out) };
                Switch { asked, name: s.name, within, without }
            })
            .collect();
        let cover = covering_set(&positive, |p| weight(&primitives[p as usize]));
        let covering: Vec<u32> = cover.iter().flatten().map(|&p| leaf(p, false)).collect();
        order.extend(covering.iter().filter(|&&i| !has(i, LEAF_BOUNDARY)));
        // for each operand: whether a leaf adds it, a leaf subtracts it, the covering set has it
        let mut roles = vec![[false; 3]; data.operand_leaves.len()];
        let boundary_operands = |i: &u32| has(*i, LEAF_BOUNDARY);
        for i in (0..leaves.len() as u32).filter(boundary_operands) {
            roles[leaves[i as usize].first as usize][usize::from(has(i, LEAF_NEGATIVE))] = true;
        }
        for &i in covering.iter().filter(|i| boundary_operands(i)) {
            roles[leaves[i as usize].first as usize][2] = true;
        }
        let meshes = data.operand_meshes.iter().zip(&data.operand_draws).map(|(mesh, corners)| {
            let [adds, takes_away, covers] = roles[mesh.operand as usize];
            PeeledMesh { operand: mesh.operand, corners: corners.clone(), adds, takes_away, covers }
        });
        let meshes = meshes.collect();
        let boxed = (0..data.leaves.len() as u32).all(|i| !has(i, LEAF_UNBOUNDED));
        let bounds = primitives.iter().map(Primitive::bounds).fold(Bounds::EMPTY, Bounds::union);
        Ok(Self {
            switches,
            inside,
            outside,
            cover: all.end..order.len() as u32,
            all,
            order,
            meshes,
            covered: cover.is_some(),
            bounds: boxed.then_some(bounds),
        })
    }

    /// Whether a ray may start inside the solid or inside a primitive.
    pub(crate) fn may_be_cut(&self, camera: &Camera) -> bool {
        let Some(bounds) = self.bounds else { return true };
        let half = (bounds.max - bounds.min) * 0.5;
        let (_, _, forward) = camera.axes();
        let nearest = forward.dot(bounds.centre() - camera.eye) - forward.abs().dot(half);
        !bounds.is_empty() && nearest < camera.depth_range.0
    }
}

/// Labels are less than the bit that locks a pixel.
const MOST_LABELS: u32 = 64;

/// The size of a primitive: half its box's surface, to which the area of its projection is proportional on average.
fn weight(primitive: &Primitive) -> f64 {
    let bounds = primitive.bounds();
    if bounds.is_empty() {
        return 0.0;
    }
    let size = bounds.max - bounds.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// Whether every mesh operand is oriented: rays enter it through triangles that face them and leave through the others.
pub(super) fn face_outward(data: &SolidData, coincidence: f64) -> bool {
    data.operands.iter().all(|operand| oriented_outwards(&operand.primitive, coincidence).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Mesh, Shape, Solid, SurfaceTable};
    use crate::picture::SolidWay;
    use crate::scene::solids::Lists;
    use glam::{DAffine3, DVec3};
    use std::sync::Arc;

    const CORNERS: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const OUTWARD: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn blister(triangles: Vec<[u32; 3]>) -> Option<Blister> {
        let mesh = Mesh::new(1, CORNERS.map(DVec3::from).to_vec(), triangles, Vec::new()).unwrap();
        let (shape, transform) = (Shape::Mesh(Arc::new(mesh)), DAffine3::IDENTITY);
        let primitive = Primitive { id: 1, colour: [0.5; 4], shape, transform };
        SolidData::new(&Lists::union(&[Solid::of(primitive).unwrap()]), SurfaceTable::ROUNDED, SolidWay::Blister)
            .unwrap()
            .blister
    }

    #[test]
    fn meshes_that_face_outward_are_peeled() {
        assert!(blister(OUTWARD.to_vec()).is_some());
        let [a, b, c, d] = OUTWARD;
        let inverted = OUTWARD.map(|[a, b, c]| [a, c, b]);
        assert!(blister(inverted.to_vec()).is_none());
        assert!(blister(vec![a, b, c, d, a, b, c, d]).is_none(), "doubled");
        assert!(blister(vec![a, b, c]).is_none(), "open");
        assert!(blister(vec![a, b, c, [1, 3, 2]]).is_none(), "one turned over");
    }

    #[test]
    fn a_near_plane_beside_everything_cuts_nothing() {
        let b = blister(OUTWARD.to_vec()).unwrap();
        let look = |eye: f64, near: f64| Camera {
            eye: DVec3::new(eye, 0.3, 0.3),
            target: DVec3::new(eye - 1.0, 0.3, 0.3),
            up: DVec3::Z,
            projection: crate::model::Projection::Perspective { fov_y: 0.6 },
            depth_range: (near, 50.0),
            size: (8, 8),
        };
        // the box ends at x = 1
        assert!(!b.may_be_cut(&look(3.0, 1.9)) && b.may_be_cut(&look(3.0, 2.1)));
        assert!(b.may_be_cut(&look(0.5, 0.1)) && b.may_be_cut(&look(-3.0, 0.1)));
        assert!(Blister { bounds: None, ..b }.may_be_cut(&look(3.0, 0.1)), "without a box");
    }
}
