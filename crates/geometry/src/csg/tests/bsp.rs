//! Partitions: cells of lines, both conversions, order.

use super::random::{ALL, tree};
use crate::csg::{Bsp, BspNode, Builder, Op, Tree, Visit, most_cells};
use crate::math::random::Random;
use glam::DVec2;

/// Half-planes `n·x <= d`.
type Line = (DVec2, f64);

fn lines(n: u32, random: &mut Random) -> Vec<Line> {
    let line = |_| {
        let angle = random.range(0.0, std::f64::consts::TAU);
        (DVec2::from_angle(angle), random.range(-1.0, 1.0))
    };
    (0..n).map(line).collect()
}

/// Some point of a square of side 2e4 satisfies the decisions: clips it by each.
fn possible(lines: &[Line], decided: &[(u32, bool)]) -> bool {
    let mut polygon: Vec<DVec2> =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec2::new(x, y) * 1e4).to_vec();
    for (line, inside) in decided {
        let (n, d) = lines[*line as usize];
        let side = |p: DVec2| if *inside { n.dot(p) - d } else { d - n.dot(p) };
        let mut kept = Vec::new();
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            if side(a) <= 0.0 {
                kept.push(a);
            }
            if (side(a) <= 0.0) != (side(b) <= 0.0) {
                kept.push(a + (b - a) * (side(a) / (side(a) - side(b))));
            }
        }
        polygon = kept;
    }
    polygon.len() >= 3
}

/// Lines in general position: a symmetric difference of all keeps every cell apart.
#[test]
fn n_lines_make_one_and_n_times_n_plus_one_halves_cells() {
    assert_eq!((0..6).map(most_cells).collect::<Vec<_>>(), [1, 2, 4, 7, 11, 16]);
    let mut random = Random::new(31);
    for n in 1..=8 {
        let lines = lines(n, &mut random);
        let mut b = Builder::new();
        let all: Vec<u32> = (0..n).map(|p| b.leaf(p)).collect();
        let root = b.fold(Op::SymmetricDifference, all);
        let bsp = Bsp::new(&b.finish(root).unwrap(), 1000, |d| possible(&lines, d)).unwrap();
        let cells = bsp.nodes().iter().filter(|n| matches!(n, BspNode::Cell(_))).count();
        assert_eq!(cells as u64, most_cells(u64::from(n)));
    }
}

#[test]
fn points_agree_on_tree_partition_and_back() {
    let mut random = Random::new(32);
    for _ in 0..200 {
        let n = random.integer(1, 7);
        let lines = lines(n, &mut random);
        let tree = tree(&mut random, n, n, &ALL, 3);
        let bsp = Bsp::new(&tree, 10_000, |d| possible(&lines, d)).unwrap();
        let back = bsp.to_tree().unwrap();
        for _ in 0..50 {
            let p = DVec2::new(random.range(-2.0, 2.0), random.range(-2.0, 2.0));
            let inside = |i: u32| lines[i as usize].0.dot(p) <= lines[i as usize].1;
            let expected = tree.contains(inside);
            assert_eq!(bsp.contains(inside), expected);
            assert_eq!(back.contains(inside), expected);
        }
    }
}

/// On any segment to the viewpoint cells come in the order of the walk.
#[test]
fn back_to_front() {
    let mut random = Random::new(33);
    for _ in 0..100 {
        let lines = lines(6, &mut random);
        let tree = tree(&mut random, 6, 6, &[Op::SymmetricDifference], 3);
        let bsp = Bsp::new(&tree, 10_000, |d| possible(&lines, d)).unwrap();
        let inside = |p: DVec2| {
            let lines = &lines;
            move |i: u32| lines[i as usize].0.dot(p) <= lines[i as usize].1
        };
        let cell = |p: DVec2| {
            let mut at = 0;
            while let BspNode::Split { primitive, inside: yes, outside: no } = bsp.nodes()[at as usize] {
                at = if inside(p)(primitive) { yes } else { no };
            }
            at
        };
        let point = |random: &mut Random| DVec2::new(random.range(-2.0, 2.0), random.range(-2.0, 2.0));
        let eye = point(&mut random);
        let order = bsp.back_to_front(inside(eye));
        assert_eq!(order.len(), bsp.nodes().len());
        let place = |node: u32| order.iter().position(|v| *v == Visit::Cell(node)).unwrap();
        for _ in 0..20 {
            let far = point(&mut random);
            let places: Vec<_> = (0..=100).map(|i| place(cell(far.lerp(eye, f64::from(i) / 100.0)))).collect();
            assert!(places.is_sorted());
        }
    }
}

#[test]
fn too_many_cells_are_refused() {
    let mut b = Builder::new();
    let all: Vec<u32> = (0..40).map(|p| b.leaf(p)).collect();
    let root = b.fold(Op::SymmetricDifference, all);
    assert!(Bsp::new(&b.finish(root).unwrap(), 1000, |_| true).is_err());
    assert_eq!(Bsp::new(&Tree::constant(true), 1, |_| true).unwrap().nodes(), [BspNode::Cell(true)]);
}
