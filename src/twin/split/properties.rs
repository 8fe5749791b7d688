//! Properties of [`split`](super) on random faces.

use super::*;
use crate::abi::{Face, FaceInstance, Patch};
use crate::model::Camera;
use crate::parity::{Case, Random, cages};
use glam::DVec3;

/// A face of random factors with some patches out of sight, and the result of `split`.
struct Grid {
    face: Face,
    taus: Vec<u32>,
    sides: Vec<Side>,
    corner_lists: u32,
    out: Split,
}

impl Grid {
    fn new(random: &mut Random) -> Self {
        let closed = random.integer(0, 3);
        let face = Face {
            count_u: random.integer(1, 7),
            count_v: random.integer(1, 7),
            flags: closed, // the bits of FACE_CLOSED_U and FACE_CLOSED_V
            ..Default::default()
        };
        let patches = (face.count_u * face.count_v) as usize;
        let largest = random.pick(&[1, 3, 64, 65, 300, 4096]);
        let unseen = random.pick(&[0, 3, 9]);
        let taus: Vec<u32> = (0..patches)
            .map(|_| {
                let tau = [random.integer(1, largest), random.integer(1, largest)];
                if random.integer(0, 9) < unseen { 0 } else { tau[0] | tau[1] << 16 }
            })
            .collect();
        let any = [Side::Outside, Side::Inside, Side::Boundary];
        let sides: Vec<Side> = (0..patches).map(|_| random.pick(&any)).collect();
        let shape = |side: &Side| Patch { shape: Patch::pack_shape((1, 1), false, *side, 0), ..Default::default() };
        let shapes: Vec<Patch> = sides.iter().map(shape).collect();
        let corner_lists = random.integer(0, 2);
        let frame = Frame { listed_patch_instances: patches as u32, corner_lists, ..Default::default() };
        let scene = Scene {
            face_instances: &[FaceInstance::default()],
            faces: &[face],
            patches: &shapes,
            patch_instances: &vec![0; patches],
            ..Default::default()
        };
        let out = split(&frame, &scene, &taus);
        Self { face, taus, sides, corner_lists, out }
    }

    /// Index of the patch one step along `axis`, around a closed face; `None` at a border.
    fn next(&self, n: usize, axis: usize) -> Option<usize> {
        let (count, stride) = ([self.face.count_u, self.face.count_v], [1, self.face.count_u as usize]);
        let (count, stride) = (count[axis] as usize, stride[axis]);
        let at = n / stride % count;
        let closed = self.face.flags >> axis & 1 != 0;
        (at + 1 < count || closed).then(|| n - at * stride + (at + 1) % count * stride)
    }

    fn tau(&self, n: usize, axis: usize) -> u32 {
        self.taus[n] >> (16 * axis) & 0xffff
    }
}

fn unpack(packed: u32) -> [u32; 2] {
    [packed & 0xffff, packed >> 16]
}

/// Both patches at a side give it the same number of segments, at least as many as each needs. If one patch is out of
/// sight, the number is the drawn one's own.
#[test]
fn shared_sides_agree() {
    let mut random = Random::new(5);
    let mut shared = 0;
    for _ in 0..3000 {
        let g = Grid::new(&mut random);
        for n in 0..g.taus.len() {
            // the side v = 1 of one patch is the side v = 0 of the next along v: segments along u
            for (axis, edges) in [|f: &Factors| f.edge_u, |f: &Factors| f.edge_v].into_iter().enumerate() {
                let Some(next) = g.next(n, 1 - axis) else { continue };
                let (high, low) = (unpack(edges(&g.out.factors[n]))[1], unpack(edges(&g.out.factors[next]))[0]);
                if g.taus[n] == 0 || g.taus[next] == 0 {
                    continue;
                }
                assert_eq!(high, low, "patches {n}, {next} of {:?}: {:x?}", g.face, g.taus);
                assert!(high >= g.tau(n, axis).max(g.tau(next, axis)));
                shared += 1;
            }
        }
    }
    assert!(shared > 20_000, "{shared} sides");
}

/// Splits are powers of two, and so are factors that differ. Every side and the interior are multiples of the splits,
/// within the hardware's factor. Each patch gets at least the segments that it needs. Counts match the draws, and each
/// patch is a member of one list.
#[test]
fn sub_patches_are_within_the_hardware_s_factor() {
    let mut random = Random::new(6);
    let mut by_corners = 0;
    for _ in 0..3000 {
        let g = Grid::new(&mut random);
        for (n, f) in g.out.factors.iter().enumerate() {
            let (splits, inner) = (unpack(f.splits), unpack(f.inner));
            let mut most = [0; 2];
            for (axis, edges) in [f.edge_u, f.edge_v].map(unpack).into_iter().enumerate() {
                let splits = splits[axis];
                assert!(splits.is_power_of_two() && splits <= MAX_SPLIT);
                for segments in [edges[0], edges[1], inner[axis]] {
                    assert!(segments % splits == 0 && segments / splits <= MAX_FACTOR, "{f:x?} of {:x?}", g.taus);
                    most[axis] = most[axis].max(segments / splits);
                    assert!(segments >= g.tau(n, axis));
                }
                assert!(inner[axis] >= 1 && inner[axis] < 2 * g.tau(n, axis).max(splits), "no finer than asked");
                let even = [edges[0], edges[1]] == [inner[axis]; 2];
                let powers = [edges[0], edges[1], inner[axis]].iter().all(|x| x.is_power_of_two());
                assert!(even || powers, "a side of another factor is joined by powers of two");
            }
            let of_list = |counts: &[u32], list: u32| counts[list as usize * g.taus.len() + n];
            let total = |counts: &[u32]| (0..2 + g.corner_lists).map(|list| of_list(counts, list)).sum::<u32>();
            let drawn = if g.taus[n] == 0 { 0 } else { splits[0] * splits[1] };
            let plain = g.sides[n] == Side::Inside;
            let has_list = g.corner_lists > u32::from(!plain);
            let one_cell = has_list && (splits, most) == ([1, 1], [1, 1]);
            let list = u32::from(!plain) + if one_cell { 2 } else { 0 };
            assert_eq!((total(&g.out.sub_patch_counts), of_list(&g.out.sub_patch_counts, list)), (drawn, drawn));
            let vertices = if one_cell { 6 } else { vertices(most) };
            assert_eq!(total(&g.out.vertex_counts), drawn * vertices);
            by_corners += u32::from(one_cell && drawn > 0);
        }
    }
    assert!(by_corners > 300, "{by_corners} patches drawn by their corners");
}

/// Sides of faces on one curve get the same number of segments of it, each at least as many as it needs, up to the most
/// that a patch's sub-patches can have.
#[test]
fn sides_that_faces_share_agree() {
    let model = cages::a_box().model;
    let camera = Camera::around(model.bounds(), DVec3::ONE, DVec3::Z, 0.6, (64, 64));
    let case = Case::new(&model, &camera, 0.5);
    let (scene, mut random) = (case.scene(), Random::new(7));
    for (largest, unseen) in [(1, 0), (1, 5), (3, 3), (20, 0), (64, 3), (300, 1), (4096, 1)] {
        let taus: Vec<u32> = (0..scene.patch_instances.len())
            .map(|_| {
                let tau = random.integer(1, largest) | random.integer(1, largest) << 16;
                if random.integer(0, 9) < unseen { 0 } else { tau }
            })
            .collect();
        let out = split(&case.frame, &scene, &taus);
        let (mut shared, mut short) = (0, 0);
        for side in (0..scene.links.len() as u32).filter(|side| scene.links[*side as usize].is_shared()) {
            // segments of the whole curve, for a drawn side that others may share
            let of_curve = |side: u32| {
                let (patch_instance, axis) = ((side / 4) as usize, axis_of(side % 4) as usize);
                let f = out.factors[patch_instance];
                let n = unpack([f.edge_u, f.edge_v][axis])[(side % 4 / 2) as usize];
                let splits = unpack(f.splits)[axis];
                if taus[patch_instance] != 0 {
                    assert!(
                        n >= taus[patch_instance] >> (16 * axis) & 0xffff
                            && n.is_multiple_of(splits)
                            && n / splits <= MAX_FACTOR
                    );
                }
                let full = n == MAX_FACTOR * splits;
                (taus[patch_instance] != 0).then_some((n << scene.links[side as usize].halvings(), full))
            };
            let next = scene.links[side as usize].next;
            let (Some((a, a_full)), Some((b, b_full))) = (of_curve(side), of_curve(next)) else { continue };
            shared += 1;
            if a != b {
                assert!(a_full || b_full, "sides {side}, {next}: {a} and {b} segments");
                short += 1;
            }
        }
        assert!(shared > 100, "{shared} sides");
        assert!(short == 0 || largest > 20, "{short} of {shared} with factors up to {largest}");
    }
}

/// Number of vertices of a quad with equal segments, by the specification. Source: Vulkan 1.3, 23.7 Quad Tessellation.
fn tessellated(inner: [u32; 2], outer: [u32; 4]) -> u32 {
    if inner == [1; 2] && outer == [1; 4] {
        return 4;
    }
    let [m, n] = inner.map(|n| n.max(2)); // one counts as slightly more, and is rounded up
    (m - 1) * (n - 1) + outer.iter().sum::<u32>()
}

/// Draws are limited by the driver's most vertices: no sub-patch makes more than were counted.
#[test]
fn no_sub_patch_makes_more_vertices_than_are_counted() {
    const LEVELS: [u32; 5] = [1, 2, 3, 16, 64];
    let pairs = || LEVELS.into_iter().flat_map(|a| LEVELS.map(|b| [a, b]));
    for inner in pairs() {
        for sides_u in pairs() {
            for sides_v in pairs() {
                let most = [(inner[0], sides_u), (inner[1], sides_v)].map(|(n, [low, high])| n.max(low).max(high));
                let made = tessellated(inner, [sides_v[0], sides_u[0], sides_v[1], sides_u[1]]);
                assert!(made <= vertices(most), "{inner:?}, {sides_u:?}, {sides_v:?}: {made} of {}", vertices(most));
            }
        }
    }
    assert_eq!([[1, 1], [64, 1], [64, 64]].map(vertices), [4, 195, 4225]);
}
