//! The face with many holes is what it says.

use selvedge::baselines::many_holes;
use selvedge::trim::LoopIndex;

#[test]
fn holes_are_apart_and_holes() {
    let model = many_holes(20);
    let face = &model.parts[0].faces[0];
    assert_eq!(face.loops.len(), 401);
    let index = LoopIndex::new(&face.loops);
    let outer = &face.loops[0];
    assert!(outer.signed_area() > 0.0);
    for (i, hole) in face.loops[1..].iter().enumerate() {
        assert!(hole.signed_area() < 0.0);
        let (lo, hi) = hole.bounds();
        assert!(!index.contains((lo + hi) * 0.5), "hole {i}");
        for other in &face.loops[i + 2..] {
            let (a, b) = other.bounds();
            assert!(lo.cmpgt(b).any() || hi.cmplt(a).any(), "two holes meet");
        }
    }
}

#[test]
fn parameters_are_lengths() {
    let point = many_holes(1).parts[0].faces[0].surface.jet(37.0, 81.0).point;
    assert!((point.x - 37.0).abs() < 1e-12 && (point.y - 81.0).abs() < 1e-12 && point.z.abs() < 3.0);
}
