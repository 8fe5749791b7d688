//! Triangles against closed forms, and rays aimed at their shared sides and vertices.

use super::shapes::*;
use crate::model::{Instance, Mesh, Model, Part};
use crate::{Hit, Tracer};
use glam::{DAffine3, DVec2, DVec3};

/// A model of one mesh, placed once.
fn placed(mesh: Mesh, transform: DAffine3) -> Model {
    Model {
        parts: vec![Part { meshes: vec![mesh], closed: true, ..Part::default() }],
        instances: vec![Instance { part: 0, transform, colour: None, name: String::new() }],
        ..Model::default()
    }
}

/// A closed surface around the origin: an octahedron whose triangles are cut into `4^levels`, the
/// vertices at distances between 0.7 and 1.3 that look random.
fn rock(levels: u32) -> Mesh {
    let mut points = vec![DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let mut triangles = vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        let quarters = |&[a, b, c]: &[u32; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.iter().flat_map(quarters).collect();
    }
    let mut noise = noise(7);
    let points = points.iter().map(|p| *p * (1.0 + 0.3 * noise())).collect();
    Mesh::new(9, points, triangles, vec![]).unwrap()
}

/// Every hit of the ray along the view axis.
fn hits(tracer: &Tracer, through: DVec3, direction: DVec3) -> Vec<Hit> {
    tracer.hits(&aimed(through, direction), MIDDLE)
}

/// Rays through points of sides and through vertices: the point itself is rounded to either side, yet
/// one of the triangles that share it is met there.
#[test]
fn no_ray_slips_between_triangles() {
    let mesh = rock(3);
    for transform in [DAffine3::IDENTITY, DAffine3::from_translation(DVec3::splat(3e3))] {
        let tracer = Tracer::new(&placed(mesh.clone(), transform));
        let mut noise = noise(11);
        let mut aimed_at = 0;
        for corners in (0..mesh.triangles().len()).map(|t| mesh.corners(t)) {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                for t in [0.0, 0.5, 0.5 + 0.5 * noise()] {
                    let through = transform.transform_point3(a + (b - a) * t);
                    // nearly towards the middle, which all triangles face: none is a silhouette there
                    let tilt = DVec3::new(noise(), noise(), noise()) * 0.01;
                    let all = hits(&tracer, through, transform.translation - through + tilt);
                    let lost = all.iter().all(|h| h.point.distance(through) > 1e-9);
                    assert!(!lost, "{through}: {all:?}");
                    aimed_at += 1;
                }
            }
        }
        assert_eq!(aimed_at, 9 * 8 * 64);
    }
}

/// A ray from outside that meets no side enters as often as it leaves. Möller and Trumbore's formula (*Fast, Minimum
/// Storage Ray/Triangle Intersection*, 1997) over all triangles finds the places.
#[test]
fn hits_are_those_of_every_triangle_by_itself() {
    let mesh = rock(3);
    let tracer = Tracer::new(&placed(mesh.clone(), DAffine3::IDENTITY));
    let mut noise = noise(5);
    let mut most = 0;
    for _ in 0..2000 {
        let (through, direction) = (DVec3::new(noise(), noise(), noise()), DVec3::new(noise(), noise(), noise()));
        let camera = aimed(through, direction);
        let (origin, ray) = camera.ray(MIDDLE);
        let meets = |t: usize| {
            let [a, b, c] = mesh.corners(t);
            let (p, from) = (ray.cross(c - a), origin - a);
            let (det, q) = ((b - a).dot(p), from.cross(b - a));
            let (u, v) = (from.dot(p) / det, ray.dot(q) / det);
            (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some(((c - a).dot(q) / det, DVec2::new(u, v)))
        };
        let mut expected: Vec<_> = (0..mesh.triangles().len()).filter_map(meets).collect();
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));
        let found = tracer.hits(&camera, MIDDLE);
        assert_eq!(found.len(), expected.len(), "{through} along {direction}");
        assert_eq!(found.len() % 2, 0);
        for (hit, (depth, uv)) in found.iter().zip(&expected) {
            // the slope of a triangle seen at 1e-4 of its area magnifies the rounding of 1e-15
            assert!((hit.depth - depth).abs() < 1e-10 && hit.uv.distance(*uv) < 1e-9, "{hit:?} {depth} {uv}");
            assert_eq!((hit.face, hit.face_index, hit.facet), (9, 0, true));
        }
        most = most.max(found.len());
    }
    assert!(most >= 4, "the rock is too smooth to hide itself");
}

/// The mean of the corners' normals where the weights are equal; a mirrored, squeezed copy turns them as
/// it turns tangent planes.
#[test]
fn normals_between_corners_and_of_a_mirrored_copy() {
    let corners = vec![DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 3.0];
    let normals = [DVec3::new(2.0, 0.0, 2.0), DVec3::new(0.0, 0.0, 0.5), DVec3::new(0.0, 1.0, 1.0)];
    let mesh = Mesh::new(4, corners.clone(), vec![[0, 1, 2]], vec![normals]).unwrap();
    let mean = normals.iter().map(|n| n.normalize()).sum::<DVec3>().normalize();
    let tracer = Tracer::new(&placed(mesh, DAffine3::IDENTITY));
    let hit = hits(&tracer, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.3, 0.2, -1.0))[0];
    assert!(hit.normal.distance(mean) < 1e-14 && hit.uv.distance(DVec2::splat(1.0 / 3.0)) < 1e-14, "{hit:?}");

    let flat = Mesh::new(4, corners, vec![[0, 1, 2]], vec![]).unwrap();
    // the plane z = 0 becomes z = x, its upper side the one towards -x
    let sheared = DAffine3::from_mat3(glam::DMat3::from_cols(DVec3::new(-1.0, 0.0, -1.0), DVec3::Y, DVec3::Z));
    let hit = hits(&Tracer::new(&placed(flat, sheared)), DVec3::new(-1.0, 1.0, -1.0), DVec3::new(0.1, 0.2, -1.0))[0];
    assert!(hit.normal.distance(DVec3::new(-1.0, 0.0, 1.0).normalize()) < 1e-14, "{hit:?}");
}

/// Two triangles on a common plane of which one is seen edge-on, and one without an area: neither is hit.
#[test]
fn what_covers_no_area_is_not_hit() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X * 0.5];
    let mesh = Mesh::new(1, corners, vec![[0, 1, 2], [0, 3, 1]], vec![]).unwrap();
    let tracer = Tracer::new(&placed(mesh, DAffine3::IDENTITY));
    assert!(hits(&tracer, DVec3::new(0.25, 0.25, 0.0), DVec3::X).is_empty());
    assert_eq!(hits(&tracer, DVec3::new(0.25, 0.0, 0.0), -DVec3::Z).len(), 1);
}
