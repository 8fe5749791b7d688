//! Parity of the passes `solid_rects` and `solid_fold`, both exact; and the fold compared with evaluation of the
//! solids' trees.

use super::Random;
use super::harness::{Gpu, Mismatch, same};
use crate::abi::{Counters, EXIT_FALSE, EXIT_TRUE, Frame, Leaf, TILE_LEAF_GATE, TileLeaf};
use crate::csg::{Blist, Builder, Op, Tree};
use crate::frame::solids::solid_fold;
use crate::frame::solids::solid_rects;
use crate::frame::solids::solid_squares;
use crate::model::{Camera, Model, Primitive, Projection, Shape, Solid};
use crate::picture::SceneSettings;
use crate::scene::{SceneData, seen_by};
use crate::twin;
use glam::{DAffine3, DVec2, DVec3};

/// A tree of `count` leaves over `count` primitives, with all operations.
fn random_tree(random: &mut Random, count: u32) -> Tree {
    let mut b = Builder::new();
    let mut open: Vec<u32> = (0..count).map(|p| b.leaf(p)).collect();
    let all = [Op::Union, Op::Intersection, Op::Difference, Op::Union, Op::Intersection, Op::SymmetricDifference];
    while open.len() > 1 {
        let i = random.integer(0, open.len() as u32 - 2) as usize;
        // a symmetric difference doubles the part below it
        let ops = if open.len() + 4 > count as usize { &all[..] } else { &all[..5] };
        let op = random.pick(ops);
        let right = open.remove(i + 1);
        open[i] = b.pair(op, open[i], right);
        if random.integer(0, 5) == 0 {
            open[i] = b.complement(open[i]);
        }
    }
    b.finish(open[0]).unwrap()
}

/// Balls, some of them unbounded half-spaces.
fn random_solid(random: &mut Random, count: u32) -> Solid {
    let mut place = || DVec3::from_array(std::array::from_fn(|_| random.range(-10.0, 10.0)));
    let places: Vec<DVec3> = (0..count).map(|_| place()).collect();
    let primitive = |(i, at): (usize, &DVec3)| Primitive {
        shape: match i % 9 {
            8 => Shape::HalfSpace { normal: DVec3::Z, offset: 1.0 },
            _ => Shape::Sphere { radius: 0.5 + 0.2 * (i % 5) as f64 },
        },
        transform: DAffine3::from_translation(*at),
        colour: [1.0; 4],
        id: i as u32 + 1,
    };
    let tree = random_tree(random, count);
    Solid::new(places.iter().enumerate().map(primitive).collect(), tree).unwrap()
}

fn leaves_of(solid: &Solid) -> SceneData {
    SceneData::new(&Model { solids: vec![solid.clone()], ..Model::default() }, SceneSettings::default()).unwrap()
}

/// Random tiles: each has a probability of its own for showing a leaf.
fn random_tiles(random: &mut Random, leaves: u32, tiles: u32) -> (Vec<u32>, Vec<TileLeaf>) {
    let (mut starts, mut all) = (vec![0], Vec::new());
    for _ in 0..tiles {
        let chance = random.range(0.0, 1.0);
        let seen = (0..leaves).filter(|_| random.range(0.0, 1.0) < chance).collect::<Vec<_>>();
        all.extend(seen.into_iter().map(|leaf| TileLeaf { leaf, ..TileLeaf::default() }));
        starts.push(all.len() as u32);
    }
    (starts, all)
}

/// The end of a walk through one tile for a point in some primitives, and the number of gates on the way.
fn walk(tile_leaves: &[TileLeaf], entry: u32, inside: impl Fn(u32) -> bool) -> (bool, usize) {
    let (mut at, mut gates) = (entry, 0);
    while let Some(here) = tile_leaves.get(at as usize) {
        gates += usize::from(here.leaf & TILE_LEAF_GATE != 0);
        at = if inside(here.leaf & !TILE_LEAF_GATE) { here.in_exit } else { here.out_exit };
    }
    (at == EXIT_TRUE, gates)
}

/// A tile's list gives the same result as the tree in which the absent primitives are empty.
#[test]
fn a_folded_list_is_the_folded_tree() {
    let mut random = Random::new(11);
    let (mut inside_count, mut gate_count) = (0, 0);
    for _ in 0..300 {
        let count = random.integer(1, 24);
        let solid = random_solid(&mut random, count);
        let leaves = leaves_of(&solid).solids.leaves;
        let primitive = |leaf: u32| leaves[leaf as usize].id - 1;
        // a tile shows all leaves of a primitive or none
        let absent: Vec<bool> = (0..count).map(|_| random.integer(0, 2) == 0).collect();
        let present = (0..leaves.len() as u32).filter(|leaf| !absent[primitive(*leaf) as usize]);
        let mut tile_leaves: Vec<TileLeaf> = present.map(|leaf| TileLeaf { leaf, ..TileLeaf::default() }).collect();
        let starts = [0, tile_leaves.len() as u32];
        let entry = twin::solid_fold::solid_fold(&leaves, u32::MAX, &starts, &mut tile_leaves)[0];
        let folded = solid.tree().fold(|p| absent[p as usize].then_some(false));
        let list = Blist::new(&folded).unwrap();
        let gates = tile_leaves.iter().filter(|here| here.leaf & TILE_LEAF_GATE != 0).count();
        gate_count += gates;
        for _ in 0..40 {
            let within: Vec<bool> = absent.iter().map(|a| !a && random.integer(0, 1) == 0).collect();
            let expected = solid.tree().contains(|p| within[p as usize]);
            assert_eq!(list.contains(|p| within[p as usize]), expected);
            let (ends_inside, passed) = walk(&tile_leaves, entry, |leaf| within[primitive(leaf) as usize]);
            assert_eq!(ends_inside, expected, "{solid:?}");
            assert!(!expected || passed == gates, "{passed} of {gates} gates: {solid:?}");
            inside_count += u32::from(expected);
        }
    }
    assert!((2000..10_000).contains(&inside_count), "{inside_count} of 12000");
    assert!(gate_count > 300, "{gate_count} gates");
}

fn fold_on_gpu(
    gpu: &Gpu,
    given: &[Leaf],
    expected: &[Leaf],
    followed: [u32; 2], // there, here
    starts: &[u32],
    tile_leaves: &[TileLeaf],
) -> Result<(), Mismatch> {
    let tiles = starts.len() as u32 - 1;
    // as many tiles as the picture has across, one down
    let frame = Frame {
        size: [(tiles * 16) as f32, 9.0],
        band_height: 16,
        leaf_count: given.len() as u32,
        tile_leaf_capacity: tile_leaves.len() as u32,
        followed_leaf: followed[0],
        ..Frame::default()
    };
    let frames = gpu.upload("frame", &[frame]);
    let leaves = gpu.upload("leaves", given);
    let tile_starts = gpu.upload("tile starts", starts);
    let wired = gpu.upload("tile leaves", tile_leaves);
    let entries = gpu.upload("tile entries", &vec![7u32; tiles as usize]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let pass = solid_fold::SolidFold::new(gpu.device()).unwrap();
    let bindings = solid_fold::Bindings {
        frame: &frames,
        leaves: &leaves,
        tile_starts: &tile_starts,
        tile_leaves: &wired,
        tile_entries: &entries,
        counters: &counters,
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, tiles));
    let mut twin = tile_leaves.to_vec();
    let twin_entries = twin::solid_fold::solid_fold(expected, followed[1], starts, &mut twin);
    same("counters", &gpu.read(&counters, 1), &[Counters::default()])?;
    same("tile leaves", &gpu.read(&wired, twin.len()), &twin)?;
    same("tile entries", &gpu.read(&entries, tiles as usize), &twin_entries)
}

#[test]
fn fold_parity() {
    let gpu = Gpu::new();
    let mut random = Random::new(5);
    for count in [1, 2, 9, 40, 200] {
        let leaves = leaves_of(&random_solid(&mut random, count)).solids.leaves;
        let (starts, tile_leaves) = random_tiles(&mut random, leaves.len() as u32, 150);
        let none = [u32::MAX; 2];
        fold_on_gpu(&gpu, &leaves, &leaves, none, &starts, &tile_leaves).unwrap();
        // one wrong exit is reported
        if count == 40 {
            let mut other = leaves.clone();
            other[0].in_exit = EXIT_TRUE - (EXIT_TRUE - other[0].in_exit).min(1);
            other[0].out_exit = other[0].in_exit;
            let mismatch = fold_on_gpu(&gpu, &other, &leaves, none, &starts, &tile_leaves).unwrap_err();
            assert_eq!(mismatch.buffer, "tile leaves");
        }
    }
    // a union, followed by items; each tile marks their starts
    let opaque = random_solid(&mut random, 7);
    let clear = [3, 12].map(|count| {
        let solid = random_solid(&mut random, count);
        let glass = |p: &Primitive| Primitive { colour: [0.5; 4], ..p.clone() };
        Solid::new(solid.primitives().iter().map(glass).collect(), solid.tree().clone()).unwrap()
    });
    let model = Model { solids: [vec![opaque], clear.to_vec()].concat(), ..Model::default() };
    let data = SceneData::new(&model, SceneSettings::default()).unwrap().solids;
    assert!(data.followed > 0 && data.is_followed());
    let (starts, tile_leaves) = random_tiles(&mut random, data.leaves.len() as u32, 150);
    let followed = [data.followed; 2];
    fold_on_gpu(&gpu, &data.leaves, &data.leaves, followed, &starts, &tile_leaves).unwrap();
    let other = [data.followed, u32::MAX];
    let unmarked = fold_on_gpu(&gpu, &data.leaves, &data.leaves, other, &starts, &tile_leaves).unwrap_err();
    assert_eq!(unmarked.buffer, "tile leaves");
    gpu.finish();
}

/// 600 balls with a hole in each, and a cut through all of them: a tile without holes, a tile without the cut either,
/// and a tile with everything. A search from one end alone would use up a driver's whole loop.
#[test]
fn long_lists_are_folded() {
    const BALLS: u32 = 600;
    let mut b = Builder::new();
    let drilled: Vec<u32> = (0..BALLS)
        .map(|n| {
            let [ball, hole] = [2 * n, 2 * n + 1].map(|p| b.leaf(p));
            b.pair(Op::Difference, ball, hole)
        })
        .collect();
    let balls = b.fold(Op::Union, drilled);
    let cut = b.leaf(2 * BALLS);
    let root = b.pair(Op::Difference, balls, cut);
    let primitive = |n: u32| Primitive {
        shape: Shape::Sphere { radius: 0.4 },
        transform: DAffine3::from_translation(DVec3::X * f64::from(n)),
        colour: [1.0; 4],
        id: n,
    };
    let leaves = leaves_of(&Solid::new((0..=2 * BALLS).map(primitive).collect(), b.finish(root).unwrap()).unwrap());
    let leaves = leaves.solids.leaves;
    let tile = |sees: &dyn Fn(u32) -> bool| {
        let seen = (0..leaves.len() as u32).filter(|leaf| sees(leaves[*leaf as usize].id));
        seen.map(|leaf| TileLeaf { leaf, ..TileLeaf::default() }).collect::<Vec<_>>()
    };
    let tiles = [tile(&|id| id % 2 == 0), tile(&|id| id % 2 == 0 && id < 2 * BALLS), tile(&|_| true)];
    let mut starts = vec![0];
    starts.extend(tiles.iter().scan(0, |end, list| {
        *end += list.len() as u32;
        Some(*end)
    }));
    let gpu = Gpu::new();
    fold_on_gpu(&gpu, &leaves, &leaves, [u32::MAX; 2], &starts, &tiles.concat()).unwrap();
    gpu.finish();
}

/// A list so long that a driver may end the loop over it is either right or counted as a clamp.
#[test]
fn a_list_of_too_many_is_told_of() {
    let count = 70_000;
    let last = |i: u32| if i + 1 < count { i + 1 } else { EXIT_FALSE };
    let leaf =
        |i: u32| Leaf { in_exit: EXIT_TRUE, out_exit: last(i), pre: count - 1 - i, end: count, ..Leaf::default() };
    let leaves: Vec<Leaf> = (0..count).map(leaf).collect();
    let tile: Vec<TileLeaf> = (0..count).map(|leaf| TileLeaf { leaf, ..TileLeaf::default() }).collect();
    let gpu = Gpu::new();
    if let Err(mismatch) = fold_on_gpu(&gpu, &leaves, &leaves, [u32::MAX; 2], &[0, count], &tile) {
        assert_eq!(mismatch.buffer, "counters");
    }
    gpu.finish();
}

fn squares_on_gpu(
    gpu: &Gpu,
    tiles: [u32; 2],
    band: std::ops::Range<u32>,
    given: &[u32],
    expected: &[u32],
) -> Result<(), Mismatch> {
    let size = [(tiles[0] * 16 - 3) as f32, (tiles[1] * 16 - 9) as f32];
    let (band_top, band_height) = (16 * band.start, 16 * (band.end - band.start));
    let frame = Frame { size, band_top, band_height, ..Frame::default() };
    let (frame, entries) = (gpu.upload("frame", &[frame]), gpu.upload("tile entries", given));
    let squares = gpu.upload("tile squares", &vec![99u32; given.len()]);
    let pass = solid_squares::SolidSquares::new(gpu.device()).unwrap();
    let bindings = solid_squares::Bindings { frame: &frame, tile_entries: &entries, tile_squares: &squares };
    let (first, end) = (band.start * tiles[0], band.end * tiles[0]);
    gpu.run(|cmd| pass.record(cmd, &bindings, end - first));
    let mut twin = vec![99; given.len()];
    let found = twin::squares::solid_squares(tiles, band, expected);
    twin[first as usize..end as usize].copy_from_slice(&found);
    same("tile squares", &gpu.read(&squares, given.len()), &twin)
}

#[test]
fn squares_parity() {
    let gpu = Gpu::new();
    let mut random = Random::new(11);
    let tiles = [21, 13];
    let sees = |random: &mut Random| if random.range(0.0, 1.0) < 0.97 { 5 } else { EXIT_FALSE };
    let entries: Vec<u32> = (0..tiles[0] * tiles[1]).map(|_| sees(&mut random)).collect();
    for band in [0..13, 0..5, 5..11, 11..13] {
        squares_on_gpu(&gpu, tiles, band, &entries, &entries).unwrap();
    }
    let mut other = entries.clone();
    other[40] = if other[40] == EXIT_FALSE { 5 } else { EXIT_FALSE };
    squares_on_gpu(&gpu, tiles, 0..13, &entries, &other).unwrap_err();
    gpu.finish();
}

fn rects_on_gpu(gpu: &Gpu, frame: &Frame, leaves: &[Leaf], centres: &[[f32; 3]], off: f32) -> Result<(), Mismatch> {
    let moved: Vec<[f32; 3]> = centres.iter().map(|c| [c[0] + off, c[1], c[2]]).collect();
    let frames = gpu.upload("frame", &[*frame]);
    let gpu_leaves = gpu.upload("leaves", leaves);
    let gpu_centres = gpu.upload("centres", &moved);
    let rects = gpu.upload("rects", &vec![twin::solid_rects::NOWHERE; leaves.len()]);
    let pass = solid_rects::SolidRects::new(gpu.device()).unwrap();
    let bindings = solid_rects::Bindings { frame: &frames, leaves: &gpu_leaves, centres: &gpu_centres, rects: &rects };
    gpu.run(|cmd| pass.record(cmd, &bindings, leaves.len() as u32));
    let twin = twin::solid_rects::solid_rects(frame, leaves, centres);
    same("rects", &gpu.read(&rects, leaves.len()), &twin)
}

/// Frames of a solid: eyes outside and inside, both projections.
fn frames(solid: &Solid) -> Vec<(Frame, Vec<[f32; 3]>)> {
    let data = leaves_of(solid);
    let mut all = Vec::new();
    for (eye, projection) in [
        (DVec3::new(30.0, -20.0, 15.0), Projection::Perspective { fov_y: 0.6 }),
        (DVec3::new(1.0, -2.0, 0.5), Projection::Perspective { fov_y: 1.4 }),
        (DVec3::new(30.0, -20.0, 15.0), Projection::Orthographic { height: 12.0 }),
        (
            DVec3::new(30.0, -20.0, 15.0),
            Projection::Pinhole { focal: DVec2::new(340.0, 310.0), principal: DVec2::new(60.25, 230.5) },
        ),
    ] {
        let size = (333, 211);
        let camera = Camera { eye, target: DVec3::ZERO, up: DVec3::Z, projection, depth_range: (0.5, 60.0), size };
        let (right, up, forward) = camera.axes();
        let frame = Frame {
            leaf_count: data.solids.leaves.len() as u32,
            right: right.as_vec3().to_array(),
            up: up.as_vec3().to_array(),
            forward: forward.as_vec3().to_array(),
            ..Frame::default()
        };
        let frame = seen_by(&camera, frame);
        all.push((frame, data.solids.leaf_centres.iter().map(|c| (*c - eye).as_vec3().to_array()).collect()));
    }
    all
}

#[test]
fn rects_parity() {
    let gpu = Gpu::new();
    let solid = random_solid(&mut Random::new(3), 300);
    let leaves = leaves_of(&solid).solids.leaves;
    for (frame, centres) in frames(&solid) {
        rects_on_gpu(&gpu, &frame, &leaves, &centres, 0.0).unwrap();
        assert_eq!(rects_on_gpu(&gpu, &frame, &leaves, &centres, 3.0).unwrap_err().buffer, "rects");
    }
    gpu.finish();
}

/// Every visible point of a ball is in one of the ball's tiles.
#[test]
fn rects_hold_what_they_are_around() {
    let solid = random_solid(&mut Random::new(3), 100);
    let leaves = leaves_of(&solid).solids.leaves;
    let mut random = Random::new(8);
    let mut tested = 0;
    for (frame, centres) in frames(&solid) {
        let rects = twin::solid_rects::solid_rects(&frame, &leaves, &centres);
        for ((leaf, centre), rect) in leaves.iter().zip(&centres).zip(rects) {
            for _ in 0..20 {
                let p: [f64; 3] = std::array::from_fn(|k| {
                    f64::from(centre[k]) + random.range(-1.0, 1.0) * f64::from(leaf.half_size[k].min(1e3))
                });
                let along = |axis: [f32; 3]| (0..3).map(|k| f64::from(axis[k]) * p[k]).sum::<f64>();
                let (x, y, z) = (along(frame.right), along(frame.up), along(frame.forward));
                let w = if frame.perspective != 0 { z } else { 1.0 };
                let (focal, middle) = (frame.focal_px.map(f64::from), frame.principal_px.map(f64::from));
                let at = [middle[0] + focal[0] * x / w, middle[1] - focal[1] * y / w];
                let in_depth = z > f64::from(frame.near) && z < f64::from(frame.far);
                if !in_depth || at[0] < 0.0 || at[1] < 0.0 || at[0] >= 333.0 || at[1] >= 211.0 {
                    continue;
                }
                let tile = at.map(|a| a as u32 / 16);
                assert!((0..2).all(|k| rect.first[k] <= tile[k] && tile[k] <= rect.last[k]), "{at:?} {rect:?}");
                tested += 1;
            }
        }
    }
    assert!(tested > 1000, "{tested}");
}
