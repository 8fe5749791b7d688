//! Parity of the pass `operand_sort`: exact, for complete and for damaged rays; and tests of its rules.

use super::Random;
use super::harness::{Gpu, Mismatch, same};
use crate::abi::{Counters, FRAGMENT_LEAVES, FRAGMENT_PATCH, FRAGMENT_SKIRT, Fragment, Frame, Leaf};
use crate::frame::solids::operand_sort::{Bindings, OperandSort};
use crate::twin::operand_sort::{BoundaryOperands, operand_sort};

const WIDTH: u32 = 70;
/// Height of the band, which is not the first one: three rows of tiles.
const HEIGHT: u32 = 37;
const TOP: u32 = 48;

/// Boundary operands 0 and 1 are meshes, 2 and 3 have faces; the near plane cuts 1 and 3, the far plane 3.
struct Case {
    frame: Frame,
    leaves: Vec<Leaf>,
    centres: Vec<[f32; 3]>,
    operand_leaves: Vec<u32>,
    starts: Vec<u32>,
    fragments: Vec<Fragment>,
}

fn case(random: &mut Random, most: u32) -> Case {
    let boxes = [(50.0, 10.0), (10.0, 12.0), (40.0, 20.0), (50.0, 60.0)];
    let leaves = boxes.map(|(_, half)| Leaf { half_size: [half; 3], ..Leaf::default() }).to_vec();
    let centres = boxes.map(|(z, _)| [3.0, -2.0, z]).to_vec();
    let (mut starts, mut fragments) = (vec![0], Vec::new());
    for _ in 0..WIDTH * HEIGHT {
        for _ in 0..random.integer(0, most) {
            let operand = random.integer(0, 3);
            let mut bits = if random.integer(0, 1) == 0 { FRAGMENT_LEAVES } else { 0 };
            if operand > 1 {
                bits |= FRAGMENT_PATCH | if random.integer(0, 2) == 0 { FRAGMENT_SKIRT } else { 0 };
            }
            // few depths, so that some are equal
            let depth = 1.0 + random.integer(0, 40) as f32;
            fragments.push(Fragment {
                operand: operand | bits,
                depth,
                what: random.integer(0, 9),
                uv: random.integer(0, 9),
            });
        }
        starts.push(fragments.len() as u32);
    }
    let frame = Frame {
        size: [WIDTH as f32, (TOP + HEIGHT) as f32],
        band_top: TOP,
        band_height: 64,
        near: 0.5,
        far: 100.0,
        forward: [0.0, 0.0, 1.0],
        fragment_capacity: fragments.len() as u32,
        ..Frame::default()
    };
    Case { frame, leaves, centres, operand_leaves: vec![0, 1, 2, 3], starts, fragments }
}

/// The fragments that stay, pixel by pixel.
fn kept(starts: &[u32], counts: &[u32], fragments: &[Fragment]) -> Vec<Fragment> {
    let pixel = |(s, c): (&u32, &u32)| fragments[*s as usize..(*s + *c) as usize].to_vec();
    starts.iter().zip(counts).filter(|(_, c)| **c > 0).flat_map(pixel).collect()
}

fn compare(gpu: &Gpu, given: &Case, expected: &Case) -> Result<(), Mismatch> {
    let frame = gpu.upload("frame", &[given.frame]);
    let leaves = gpu.upload("leaves", &given.leaves);
    let leaf_centres = gpu.upload("centres", &given.centres);
    let operand_leaves = gpu.upload("operand leaves", &given.operand_leaves);
    let starts = gpu.upload("starts", &given.starts);
    let counts = gpu.upload("counts", &vec![0u32; given.starts.len() - 1]);
    let fragments = gpu.upload("fragments", &given.fragments);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let pass = OperandSort::new(gpu.device()).unwrap();
    let bindings = Bindings {
        frame: &frame,
        leaves: &leaves,
        leaf_centres: &leaf_centres,
        operand_leaves: &operand_leaves,
        starts: &starts,
        counts: &counts,
        fragments: &fragments,
        counters: &counters,
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, 0..WIDTH, 0..HEIGHT));
    let c = expected;
    let boundary_operands =
        BoundaryOperands { leaves: &c.leaves, centres: &c.centres, operand_leaves: &c.operand_leaves };
    let (mut twin, mut twin_counters) = (c.fragments.clone(), Counters::default());
    let twin_counts = operand_sort(&c.frame, boundary_operands, &c.starts, &mut twin, &mut twin_counters);
    let gpu_counts = gpu.read(&counts, twin_counts.len());
    same("counts", &gpu_counts, &twin_counts)?;
    let found = gpu.read(&fragments, twin.len());
    same("fragments", &kept(&c.starts, &gpu_counts, &found), &kept(&c.starts, &twin_counts, &twin))?;
    same("counters", &gpu.read(&counters, 1), &[twin_counters])
}

#[test]
fn parity() {
    for gpu in Gpu::all() {
        let mut random = Random::new(23);
        for most in [3, 12, 300] {
            let case = case(&mut random, most);
            compare(&gpu, &case, &case).unwrap();
            let less =
                Case { frame: Frame { fragment_capacity: case.frame.fragment_capacity / 2, ..case.frame }, ..case };
            compare(&gpu, &less, &less).unwrap();
        }
        // the count exceeds 32 bits: half of the pixels are marked, and the band
        let whole = case(&mut random, 3);
        let wraps = |(i, start): (usize, u32)| {
            if i >= whole.starts.len() / 2 { start.wrapping_sub(900) } else { start | 1 << 31 }
        };
        let starts = whole.starts.iter().copied().enumerate().map(wraps).collect();
        let wrapped = Case { starts, ..whole };
        compare(&gpu, &wrapped, &wrapped).unwrap();
        // a difference in one depth is reported
        let given = case(&mut Random::new(4), 6);
        let mut other = case(&mut Random::new(4), 6);
        other.fragments.iter_mut().for_each(|f| f.depth += if f.what == 3 { 7.0 } else { 0.0 });
        assert!(compare(&gpu, &other, &given).is_err());
        gpu.finish();
    }
}

fn fragment(bits: u32, depth: f32) -> Fragment {
    Fragment { operand: 2 | FRAGMENT_PATCH | bits, depth, ..Fragment::default() }
}

/// Depths that stay of one ray through operand 2, and the counters.
fn one(fragments: &[Fragment]) -> (Vec<f32>, u32, u32) {
    one_from(-99.0, fragments)
}

/// The same with a near plane; the operand's box is from 20 to 60.
fn one_from(near: f32, fragments: &[Fragment]) -> (Vec<f32>, u32, u32) {
    let c = case(&mut Random::new(1), 1);
    let boundary_operands =
        BoundaryOperands { leaves: &c.leaves, centres: &c.centres, operand_leaves: &c.operand_leaves };
    let (mut all, mut counters) = (fragments.to_vec(), Counters::default());
    let frame = Frame { fragment_capacity: 99, near, ..c.frame };
    let count = operand_sort(&frame, boundary_operands, &[0, all.len() as u32], &mut all, &mut counters)[0];
    (all[..count as usize].iter().map(|f| f.depth).collect(), counters.mended, counters.unpaired)
}

/// The rules for rays that pass between two faces.
#[test]
fn gaps_are_closed_by_skirts_alone() {
    let (enter, leave) = (|t| fragment(0, t), |t| fragment(FRAGMENT_LEAVES, t));
    let (skirt_in, skirt_out) = (|t| fragment(FRAGMENT_SKIRT, t), |t| fragment(FRAGMENT_SKIRT | FRAGMENT_LEAVES, t));
    // skirts beside a complete ray are ignored
    assert_eq!(one(&[skirt_in(1.0), enter(2.0), leave(5.0), skirt_out(6.0)]), (vec![2.0, 5.0], 0, 0));
    assert_eq!(one(&[leave(5.0), skirt_in(2.0)]), (vec![2.0, 5.0], 1, 0));
    assert_eq!(one(&[enter(2.0), skirt_out(4.0)]), (vec![2.0, 4.0], 1, 0));
    assert_eq!(one(&[enter(1.0), skirt_out(2.0), enter(3.0), leave(4.0)]), (vec![1.0, 2.0, 3.0, 4.0], 1, 0));
    // without a skirt: an entry stays, an exit is removed
    assert_eq!(one(&[enter(2.0)]), (vec![2.0], 0, 1));
    assert_eq!(one(&[leave(2.0), enter(3.0), leave(4.0)]), (vec![3.0, 4.0], 0, 1));
    // two faces that overlap at their border
    assert_eq!(one(&[enter(2.0), enter(2.1), leave(4.0)]), (vec![2.0, 4.0], 0, 0));
    assert_eq!(one(&[skirt_in(2.0), skirt_out(3.0)]), (vec![], 0, 0));
    // near a silhouette, two are interchanged
    assert_eq!(one(&[leave(1.0), enter(1.01), enter(3.0), leave(4.0)]), (vec![1.0, 1.01, 3.0, 4.0], 0, 0));
    // also if the ray may begin within: with as many exits as entries, it does not
    let cut = one_from(30.0, &[leave(31.0), enter(31.1), enter(33.0), leave(34.0)]);
    assert_eq!(cut, (vec![31.0, 31.1, 33.0, 34.0], 0, 0));
    assert_eq!(one_from(30.0, &[leave(31.0), enter(33.0), leave(34.0)]), (vec![31.0, 33.0, 34.0], 0, 0));
}
