//! The sun's tiles.

use super::*;
use crate::csg::{Builder, Op};
use crate::model::{Primitive, Shape, Solid, SurfaceTable};
use crate::picture::SolidWay;
use crate::scene::solids::Lists;
use glam::DAffine3;

/// Numbers from a counter. Source: G. Marsaglia, Xorshift RNGs, 2003.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % n
    }
}

/// A random expression over balls side by side, some of them half-spaces.
fn solids(dice: &mut Dice, count: u32, ops: [Op; 4]) -> SolidData {
    let shape = |k: u32, unbounded: bool| match unbounded {
        true => Shape::HalfSpace { normal: DVec3::Y, offset: f64::from(k) },
        false => Shape::Sphere { radius: 0.7 },
    };
    let primitives = (0..count).map(|k| Primitive {
        shape: shape(k, dice.below(9) == 0),
        transform: DAffine3::from_translation(DVec3::new(f64::from(k % 4), f64::from(k / 4), 0.0)),
        colour: [1.0; 4],
        id: k + 1,
    });
    let primitives: Vec<Primitive> = primitives.collect();
    let mut b = Builder::new();
    let mut nodes: Vec<u32> = (0..count).map(|p| b.leaf(p)).collect();
    while nodes.len() > 1 {
        let left = nodes.swap_remove(dice.below(nodes.len() as u64) as usize);
        let right = nodes.swap_remove(dice.below(nodes.len() as u64) as usize);
        let op = ops[dice.below(4) as usize];
        nodes.push(b.pair(op, left, right));
    }
    let tree = b.finish(nodes[0]).unwrap();
    let solid = Solid::new(primitives, tree).unwrap();
    SolidData::new(&Lists::union(std::slice::from_ref(&solid)), SurfaceTable::ROUNDED, SolidWay::Events).unwrap()
}

/// The end of a walk that is inside the leaves of `inside` and outside all others.
fn walk(from: u32, exits: impl Fn(u32) -> (u32, u32, u32), inside: &[bool]) -> u32 {
    let mut at = from;
    while at < EXIT_FALSE {
        let (leaf, in_exit, out_exit) = exits(at);
        at = if inside[leaf as usize] { in_exit } else { out_exit };
    }
    at
}

/// In every tile, the walk over its list ends where the walk over all leaves does, whichever leaves of the list are
/// inside.
#[test]
fn a_tile_answers_as_the_whole_list_does() {
    let mut dice = Dice(7);
    let (mut short, mut ends) = (0, [0; 2]);
    for round in 0..200 {
        let data = solids(&mut dice, 2 + round % 24, [Op::Union, Op::Intersection, Op::Difference, Op::Union]);
        let sun = SunData::new(DVec3::new(0.2, 0.1, 1.0), &data, None);
        for tile in &sun.tiles {
            let list = &sun.leaves[tile.first as usize..tile.end as usize];
            short += usize::from(list.len() < data.leaves.len());
            for _ in 0..4 {
                let mut inside = vec![false; data.leaves.len()];
                list.iter().for_each(|l| inside[l.leaf as usize] = dice.below(2) == 0);
                let whole = |l: u32| (l, data.leaves[l as usize].in_exit, data.leaves[l as usize].out_exit);
                let folded = |i: u32| {
                    let l = sun.leaves[i as usize];
                    (l.leaf, l.in_exit, l.out_exit)
                };
                let end = walk(0, whole, &inside);
                assert_eq!(walk(tile.entry, folded, &inside), end, "round {round}");
                ends[usize::from(end == EXIT_TRUE)] += 1;
            }
        }
    }
    assert!(short > 1000 && ends.iter().all(|n| *n > 1000), "{short} lists are shorter, {ends:?}");
}

/// A leaf is in the tile of every point of its box. A point without a leaf belongs to a tile, too.
#[test]
fn a_leaf_is_in_the_tiles_that_its_box_reaches() {
    let mut dice = Dice(3);
    // in a union, no box is clipped
    let data = solids(&mut dice, 24, [Op::Union; 4]);
    let (eye, sun) = (DVec3::new(30.0, -20.0, 40.0), SunData::new(DVec3::new(-0.7, 0.4, 0.8), &data, None));
    let seen = sun.seen_from(eye);
    let row = |axis: [f32; 3], p: DVec3| DVec3::from(axis.map(f64::from)).dot(p);
    let mut met = 0;
    for (leaf, centre) in data.leaves.iter().zip(&data.leaf_centres) {
        for _ in 0..50 {
            let mut share = || dice.below(2001) as f64 / 1000.0 - 1.0;
            let (x, y, z) = (share(), share(), share());
            let half = DVec3::from(leaf.half_size.map(f64::from));
            let half = if half.is_finite() { half } else { DVec3::splat(100.0) };
            // relative to the eye, moved along the sun's ray
            let p = centre + half * DVec3::new(x, y, z) + sun.towards * 10.0 * share() - eye;
            let at = [row(seen.right, p) + f64::from(seen.eye[0]), row(seen.up, p) + f64::from(seen.eye[1])];
            let [x, y] = std::array::from_fn(|k| at[k].clamp(0.0, f64::from(sun.across[k] - 1)) as usize);
            let tile = sun.tiles[y * sun.across[0] as usize + x];
            let list = &sun.leaves[tile.first as usize..tile.end as usize];
            assert!(list.iter().any(|l| data.leaves[l.leaf as usize] == *leaf), "{at:?}");
            met += usize::from(at[0] > 0.0 && at[1] > 0.0);
        }
    }
    assert!(sun.tiles.len() > 16 && met > 500, "{} tiles, {met}", sun.tiles.len());
}

/// Large leaves in front of each other get larger tiles; a point and a line get a few, nothing gets none.
#[test]
fn lists_are_bounded() {
    let stack = |n: u32, half: [f32; 3]| SolidData {
        leaves: vec![
            Leaf {
                half_size: half,
                out_exit: EXIT_FALSE,
                in_exit: EXIT_TRUE,
                flags: LEAF_FALLS,
                ..Default::default()
            };
            n as usize
        ],
        leaf_centres: vec![DVec3::ONE; n as usize],
        followed: n,
        ..Default::default()
    };
    let sun = |data: &SolidData| SunData::new(DVec3::Z, data, None);
    let many = sun(&stack(20_000, [1.0; 3]));
    assert!(many.leaves.len() as u64 <= FEW_ENTRIES + ENTRIES_EACH * 20_000 && !many.tiles.is_empty());
    for half in [[0.0; 3], [1.0, 0.0, 0.0], [f32::MAX; 3], [1e-40; 3]] {
        let few = sun(&stack(3, half));
        assert!((1..=4 * 12).contains(&few.tiles.len()), "{half:?}: {}", few.tiles.len());
        assert!(few.seen_from(DVec3::ONE).right.iter().all(|x| x.is_finite()), "{half:?}");
    }
    assert!(!sun(&SolidData::default()).has_casters());
    // the largest distance between finite numbers
    let far = [DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX)];
    let apart = sun(&SolidData { leaf_centres: far.to_vec(), ..stack(2, [1.0; 3]) });
    assert_eq!((apart.across, apart.leaves.len()), ([1; 2], 2));
}

/// Too many triangles make the deviation larger, then leave casters out; casters that fit are present. Non-finite ones
/// are left out.
#[test]
fn triangles_are_bounded() {
    use crate::model::{Face, Instance, Part, SurfaceKind};
    use crate::spline::Surface;
    let height = [0.0, 1.0, -1.0, 0.3, 1.0, 2.0, 0.0, -1.0, -1.0, 0.0, -3.0, 1.0, 0.5, -1.0, 1.0, 0.0];
    let points = (0..16).zip(height).map(|(k, z)| glam::DVec4::new(f64::from(k % 4), f64::from(k / 4), z, 1.0));
    let knots = [vec![0.0; 4], vec![1.0; 4]].concat();
    let surface = Surface::new((3, 3), knots.clone(), knots, points.collect()).unwrap();
    let face = Face { id: 1, kind: SurfaceKind::BSpline, surface, loops: vec![], same_sense: true, colour: None };
    let part = Part { faces: vec![face], ..Part::default() };
    let copies = |count: u32, scale: f64| {
        let at = |k: u32| DVec3::new(f64::from(k % 300), f64::from(k / 300), 0.0) * 5.0;
        let to = |k: u32| DAffine3::from_translation(at(k)) * DAffine3::from_scale(DVec3::splat(scale));
        let instance = |k: u32| Instance { part: 0, transform: to(k), colour: None, name: String::new() };
        Model { parts: vec![part.clone()], instances: (0..count).map(instance).collect(), ..Model::default() }
    };
    let sun = |m: &Model| SunData::new(DVec3::new(0.3, 0.2, 1.0), &SolidData::default(), Some(m));
    let one = sun(&copies(1, 1.0));
    let size = copies(1, 1.0).control_bounds().diagonal();
    assert!(
        one.left_out == 0 && one.deviation > 0.2 * size / 8192.0 && one.deviation <= size / 8192.0,
        "{}",
        one.deviation
    );
    let some = sun(&copies(3000, 1.0));
    assert!(some.left_out == 0 && some.deviation > 2.0 * one.deviation, "{}", some.deviation);
    let many = sun(&copies(90_000, 1.0));
    assert!(many.left_out > 1000 && many.left_out < 89_000, "{}", many.left_out);
    for data in [&one, &some, &many] {
        assert!((1000..=1 << 20).contains(&data.facets.len()), "{}", data.facets.len());
    }
    for bad in [f64::NAN, f64::INFINITY, 0.0] {
        let none = sun(&copies(2, bad));
        assert!(none.facets.is_empty() && none.tiles.is_empty(), "{bad}");
    }
}
