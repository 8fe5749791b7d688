//! Isolated meshes: operands of a union that touch no other operand. The union shows their triangles.
//!
//! ```text
//!     ┌──────┐     ┌───────┐       boxes of the union's operands:
//!     │ mesh │     │ A ┌───┼───┐     the mesh's touches no other ─▶ Isolated::meshes
//!     └──────┘     └───┼───┘mesh│                                    the others stay, Isolated::rest
//!                      └───────┘
//! ```
//!
//! *A ray enters the union first where it first enters an isolated mesh, or the union of the rest.* A ray enters a
//! closed surface that is oriented outwards and does not cross itself where a triangle faces the eye. So the nearest
//! such triangle is the result that a list of all crossings would give. This fails within a part that is inside out, or
//! that lies in the mesh twice. So a mesh whose triangles cross or touch, or that has a shell too many around another
//! (`self_intersection.rs`), does not count as isolated, nor does a mesh with two faces back to back, which bound nothing
//! (`orientation.rs`).

use super::operands::Operands;
use super::orientation::oriented_outwards;
use super::reach::{self, Boxes};
use super::{Primitive, Shape, Solid, SolidError, nearby::Nearby};
use crate::csg::Node;
use crate::model::{Bounds, Mesh};

/// Boxes nearer to each other than this share of the model's diagonal touch: far above the rounding of double
/// precision, far below a pixel of a picture of the model.
const TOUCHES: f64 = 1e-6;

/// Solids split into isolated meshes and the rest.
#[derive(Debug)]
pub struct Isolated {
    /// In model coordinates, with their primitives' numbers and colours; counter-clockwise from outside.
    pub meshes: Vec<Mesh>,
    /// The others.
    pub rest: Vec<Solid>,
}

impl Isolated {
    /// `None` where no mesh is isolated; `coincidence` is that of
    /// [`Model::coincidence`](crate::model::Model::coincidence).
    ///
    /// # Errors
    /// [`SolidError`] when an expression becomes too large.
    pub fn of(solids: &[Solid], coincidence: f64) -> Result<Option<Self>, SolidError> {
        let operands: Vec<Operands<'_>> = solids.iter().map(Operands::of).collect();
        let mut roots = vec![Vec::new(); solids.len()];
        let mut meshes = Vec::new();
        for (solid, root, primitive) in isolated_roots(solids, &operands, coincidence) {
            if let Some(mesh) = oriented_outwards(primitive, coincidence).and_then(|mesh| placed(primitive, &mesh)) {
                meshes.push(mesh);
                roots[solid].push(root);
            }
        }
        if meshes.is_empty() {
            return Ok(None);
        }
        let mut rest = Vec::with_capacity(solids.len());
        for ((solid, operands), roots) in solids.iter().zip(&operands).zip(&roots) {
            if roots.is_empty() {
                rest.push(solid.clone());
                continue;
            }
            let others: Vec<u32> = operands.roots().iter().copied().filter(|root| !roots.contains(root)).collect();
            if !others.is_empty() {
                rest.push(operands.union(&others)?);
            }
        }
        Ok(Some(Self { meshes, rest }))
    }
}

/// The meshes among the operands whose boxes touch no other operand's: solid, root and primitive.
fn isolated_roots<'a>(
    solids: &'a [Solid],
    operands: &[Operands<'_>],
    coincidence: f64,
) -> Vec<(usize, u32, &'a Primitive)> {
    let (mut boxes, mut candidates) = (Vec::new(), Vec::new());
    for (s, (solid, operands)) in solids.iter().zip(operands).enumerate() {
        let is_mesh = |root: u32| match solid.tree().nodes()[root as usize] {
            Node::Leaf(p) => Some(&solid.primitives()[p as usize]).filter(|p| matches!(p.shape, Shape::Mesh(_))),
            _ => None,
        };
        let of = reach::boxes(solid, Boxes::of, &[]);
        for &root in operands.roots() {
            match is_mesh(root) {
                Some(primitive) => candidates.push((s, root, primitive, of[root as usize].of)),
                None => boxes.push(of[root as usize].of),
            }
        }
    }
    let all = boxes.iter().copied().chain(candidates.iter().map(|c| c.3)).fold(Bounds::EMPTY, Bounds::union);
    if candidates.is_empty() || !all.diagonal().is_finite() {
        return Vec::new(); // an unbounded operand touches everything
    }
    let margin = coincidence.max(TOUCHES) * all.diagonal();
    boxes.retain(|b| !b.is_empty());
    candidates.retain(|c| !c.3.is_empty());
    let first = boxes.len() as u32;
    boxes.extend(candidates.iter().map(|c| Bounds { min: c.3.min - margin, max: c.3.max + margin }));
    let nearby = Nearby::new(boxes, margin);
    let mut touched = vec![false; candidates.len()];
    for i in 0..candidates.len() {
        nearby.before(first + i as u32, |other| {
            touched[i] = true;
            if let Some(other) = other.checked_sub(first) {
                touched[other as usize] = true;
            }
        });
    }
    let isolated = candidates.into_iter().zip(touched).filter(|(_, touched)| !touched);
    isolated.map(|((solid, root, primitive, _), _)| (solid, root, primitive)).collect()
}

/// The primitive's mesh in its solid's coordinates, counter-clockwise from outside.
fn placed(primitive: &Primitive, mesh: &Mesh) -> Option<Mesh> {
    let turn =
        |[a, b, c]: [u32; 3]| if primitive.transform.matrix3.determinant() < 0.0 { [a, c, b] } else { [a, b, c] };
    let positions = mesh.positions().iter().map(|p| primitive.transform.transform_point3(*p)).collect();
    let triangles = mesh.triangles().iter().map(|t| turn(*t)).collect();
    let mut placed = Mesh::new(primitive.id, positions, triangles, Vec::new()).ok()?;
    placed.colour = Some(primitive.colour);
    Some(placed)
}

#[cfg(test)]
mod tests {
    use super::super::orientation::{is_closed, six_volumes};
    use super::*;
    use crate::csg::parse;
    use crate::model::SurfaceTable;
    use glam::{DAffine3, DVec3};
    use std::sync::Arc;

    const TETRA: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn tetra(triangles: &[[u32; 3]], transform: DAffine3) -> Primitive {
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mesh = Mesh::new(1, corners, triangles.to_vec(), Vec::new()).unwrap();
        Primitive { shape: Shape::Mesh(Arc::new(mesh)), transform, colour: [0.25; 4], id: 7 }
    }

    fn at(x: f64) -> DAffine3 {
        DAffine3::from_translation(DVec3::X * x)
    }

    fn of(shape: Shape) -> Primitive {
        Primitive { shape, transform: DAffine3::IDENTITY, colour: [0.5; 4], id: 1 }
    }

    /// The number of isolated meshes, and of primitives in the rest.
    fn counts(expression: &str, primitives: Vec<Primitive>) -> (usize, usize) {
        counts_within(SurfaceTable::ROUNDED, expression, primitives)
    }

    fn counts_within(coincidence: f64, expression: &str, primitives: Vec<Primitive>) -> (usize, usize) {
        let solid = Solid::new(primitives, parse(expression).unwrap().tree).unwrap();
        let all = solid.primitives().len();
        let isolated = Isolated::of(&[solid], coincidence).unwrap();
        isolated.map_or((0, all), |l| (l.meshes.len(), l.rest.iter().map(|s| s.primitives().len()).sum()))
    }

    #[test]
    fn what_touches_nothing_is_lone() {
        let one = || tetra(&TETRA, DAffine3::IDENTITY);
        let ball = || of(Shape::Sphere { radius: 0.5 });
        assert_eq!(counts("A", vec![one()]), (1, 0));
        assert_eq!(counts("A+B", vec![one(), tetra(&TETRA, at(1.5))]), (2, 0));
        // so near that faces are one, or not
        let near = || vec![one(), tetra(&TETRA, at(1.0 + 1e-4))];
        assert_eq!(counts("A+B", near()), (2, 0));
        assert_eq!(counts_within(SurfaceTable::COARSEST, "A+B", near()), (0, 2));
        // boxes with a side in common, and within each other
        assert_eq!(counts("A+B", vec![one(), tetra(&TETRA, at(1.0))]), (0, 2));
        assert_eq!(counts("A+B", vec![one(), ball()]), (0, 2));
        assert_eq!(counts("A+B+C", vec![one(), ball(), tetra(&TETRA, at(2.0))]), (1, 2));
        // a box counts as far as its operand goes
        let wide = Shape::Block { min: DVec3::splat(-3.0), max: DVec3::new(-0.5, 3.0, 3.0) };
        let wider = Shape::Sphere { radius: 9.0 };
        assert_eq!(counts("A+BC", vec![one(), of(wide), of(wider)]), (1, 2));
    }

    #[test]
    fn what_is_cut_or_without_end_is_not() {
        let one = || tetra(&TETRA, DAffine3::IDENTITY);
        let far = || tetra(&TETRA, at(5.0));
        assert_eq!(counts("A-B", vec![one(), far()]), (0, 2));
        assert_eq!(counts("AB", vec![one(), far()]), (0, 2));
        assert_eq!(counts("A^B", vec![one(), far()]), (0, 2));
        assert_eq!(counts("A+!B", vec![one(), far()]), (0, 2));
        let plane = Shape::HalfSpace { normal: DVec3::X, offset: -9.0 };
        assert_eq!(counts("A+B", vec![one(), of(plane)]), (0, 2));
    }

    /// Open, inside out, with an edge of four triangles, with a fin, and flat.
    #[test]
    fn unclean_meshes_are_not() {
        let is_lone = |triangles: &[[u32; 3]]| counts("A", vec![tetra(triangles, DAffine3::IDENTITY)]).0 == 1;
        assert!(is_lone(&TETRA));
        assert!(!is_lone(&TETRA[1..]));
        assert!(!is_lone(&TETRA.map(|[a, b, c]| [a, c, b])));
        assert!(!is_lone(&[&TETRA[..], &TETRA[..]].concat()));
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].into_iter();
        let fin = [DVec3::X * 2.0, DVec3::X * 2.0 + DVec3::Y, DVec3::X * 2.0 + DVec3::Z];
        let triangles = [&TETRA[..], &[[4, 5, 6], [4, 6, 5]]].concat();
        let mesh = Mesh::new(1, corners.chain(fin).collect(), triangles, Vec::new()).unwrap();
        assert!(is_closed(&mesh));
        assert_eq!(counts("A", vec![of(Shape::Mesh(Arc::new(mesh)))]), (0, 1));
        let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(counts("A", vec![tetra(&TETRA, flat)]), (0, 1));
    }

    /// In model coordinates, with the primitive's number and colour, turned outwards though mirrored.
    #[test]
    fn meshes_are_placed() {
        let transform = at(4.0) * DAffine3::from_scale(DVec3::new(-2.0, 1.0, 1.0));
        let isolated =
            Isolated::of(&[Solid::of(tetra(&TETRA, transform)).unwrap()], SurfaceTable::ROUNDED).unwrap().unwrap();
        let mesh = &isolated.meshes[0];
        assert_eq!((mesh.id, mesh.colour), (7, Some([0.25; 4])));
        assert_eq!((mesh.bounds().min, mesh.bounds().max), (DVec3::X * 2.0, DVec3::new(4.0, 1.0, 1.0)));
        assert_eq!(six_volumes(mesh), 2.0);
    }
}
