//! Curves in which a plane cuts parts, against closed forms.

use glam::DVec3;
use selvedge_geometry::construct::shapes;
use selvedge_geometry::edges::CutCurve;
use selvedge_geometry::model::{Mesh, Part};

/// Pieces are fitted within 1e-8 of a part's diagonal; parts here are a few units large.
const REACH: f64 = 1e-7;

fn places(cuts: &[CutCurve]) -> impl Iterator<Item = DVec3> + '_ {
    let pieces = cuts.iter().flat_map(|cut| &cut.pieces);
    pieces.flat_map(|piece| (0..=16).map(|k| piece.point(f64::from(k) / 16.0)))
}

fn length(cuts: &[CutCurve]) -> f64 {
    let pieces = cuts.iter().flat_map(|cut| &cut.pieces);
    pieces
        .map(|piece| {
            (0..64)
                .map(|k| piece.point(f64::from(k) / 64.0).distance(piece.point(f64::from(k + 1) / 64.0)))
                .sum::<f64>()
        })
        .sum()
}

#[test]
fn a_ball_is_cut_in_a_circle() {
    let part = shapes::sphere(1.0).unwrap().part;
    let normal = DVec3::new(0.3, -0.5, 0.7).normalize();
    let cuts = part.cut(normal, 0.4);
    let radius = (1.0f64 - 0.16).sqrt();
    for p in places(&cuts) {
        assert!((normal.dot(p) - 0.4).abs() < REACH && (p.length() - 1.0).abs() < REACH, "{p}");
    }
    let around = length(&cuts);
    assert!((around - std::f64::consts::TAU * radius).abs() < 1e-3, "{around}");
    assert!(part.cut(normal, 1.1).is_empty());
}

/// The plane through the axis: sides of patches lie in it, and seams.
#[test]
fn sides_of_patches_in_the_plane_are_cuts() {
    let part = shapes::cylinder(1.0, 2.0).unwrap().part;
    for normal in [DVec3::X, DVec3::Y] {
        let cuts = part.cut(normal, 0.0);
        for x in [-1.0, 1.0] {
            let line = DVec3::new(normal.y * x, normal.x * x, 0.0);
            let on = |cut: &&CutCurve| places(std::slice::from_ref(*cut)).all(|p| p.with_z(0.0).distance(line) < REACH);
            let found: Vec<&CutCurve> = cuts.iter().filter(on).collect();
            assert!(
                found.iter().any(|cut| (length(std::slice::from_ref(cut)) - 2.0).abs() < REACH),
                "{normal}, {line}"
            );
        }
    }
}

#[test]
fn loops_end_the_cuts_of_their_faces() {
    let part = shapes::cylinder(1.0, 2.0).unwrap().part;
    let low = part.control_bounds().min.z;
    let cuts = part.cut(DVec3::X, 0.25);
    // two straight lines down the mantle, and one across each lid, as long as its chord
    let expected = 2.0 * 2.0 + 2.0 * 2.0 * (1.0f64 - 0.0625).sqrt();
    assert!((length(&cuts) - expected).abs() < REACH, "{} of {expected}", length(&cuts));
    for p in places(&cuts) {
        assert!((p.x - 0.25).abs() < REACH && p.y.abs() < 0.9683 && p.z > low - REACH, "{p}");
    }
}

#[test]
fn triangles_are_cut_in_straight_lines() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let mesh = Mesh::new(1, corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], vec![]).unwrap();
    let cuts = mesh.cut(DVec3::Z, 0.5);
    // a triangle with two sides of a half
    assert_eq!(cuts.len(), 3);
    assert!((length(&cuts) - (1.0 + 0.5f64.sqrt())).abs() < 1e-12);
    assert!(cuts.iter().all(|cut| cut.face.is_none()));
    let part = Part { meshes: vec![mesh], closed: true, ..Part::default() };
    assert_eq!(part.cut(DVec3::Z, 0.5).len(), 3);
}
