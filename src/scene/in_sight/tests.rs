//! Culled parts and faces are nowhere in the picture, and visible ones are not culled: compared with pass `bound`,
//! patch by patch.

use super::drawn::rounding_beyond;
use super::*;
use crate::abi::{BORDER_U0, BORDER_U1, BORDER_V0, BORDER_V1, Counters, Side};
use crate::fixtures::{Case, Random};
use crate::model::{Face, Instance, Model, Projection, TrimLoop};
use crate::parity::{placed, untrimmed};
use crate::spline::{Bezier, Patch, Surface};
use crate::twin;
use glam::{DAffine3, DVec2};

/// A hill over the square `[-1, 1] x [-1, 1]`, of four patches.
fn hill() -> Model {
    placed(vec![untrimmed(hill_surface())], DAffine3::IDENTITY)
}

fn hill_surface() -> Surface {
    let knots = || vec![0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0];
    let at = |k: usize| [-1.0, -0.5, 0.5, 1.0][k];
    let height = |i: usize, j: usize| if (1..3).contains(&i) && (1..3).contains(&j) { 1.0 } else { 0.0 };
    let points = (0..4).flat_map(|j| (0..4).map(move |i| DVec4::new(at(i), at(j), height(i, j), 1.0)));
    Surface::new((2, 2), knots(), knots(), points.collect()).unwrap()
}

/// A quarter of a cylinder: one rational patch.
fn quarter() -> Surface {
    let arc = [(1.0, 0.0, 1.0), (1.0, 1.0, std::f64::consts::FRAC_1_SQRT_2), (0.0, 1.0, 1.0)];
    let points = [-1.0, 1.0].iter().flat_map(|&z| arc.map(|(x, y, w)| DVec4::new(x * w, y * w, z * w, w)));
    Surface::new((2, 1), vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0], points.collect()).unwrap()
}

/// The surface over `[0, 1] x [0, 1]` with a loop beside its borders, so that patches have skirts.
fn beside_its_borders(surface: Surface) -> Face {
    let corners = [(0.05, 0.05), (0.95, 0.05), (0.95, 0.95), (0.05, 0.95)].map(DVec2::from);
    let sides = (0..4).map(|k| Bezier::line(corners[k], corners[(k + 1) % 4])).collect();
    Face { loops: vec![TrimLoop::new(sides, DVec2::ZERO).unwrap()], ..untrimmed(surface) }
}

/// Some thousand hills of all sizes: around the eye, beside the picture, before the near plane and behind the far one.
fn hills(random: &mut Random) -> Model {
    let mut model = hill();
    model.instances = (0..3000)
        .map(|_| {
            let mut along = |reach: f64| random.range(-reach, reach);
            let place = DVec3::new(along(60.0), along(60.0), along(60.0));
            let turned = DAffine3::from_rotation_x(along(3.0)) * DAffine3::from_rotation_y(along(3.0));
            let scale = 10f64.powf(along(3.0));
            let transform = DAffine3::from_translation(place) * turned * DAffine3::from_scale(DVec3::splat(scale));
            Instance { part: 0, transform, colour: None, name: String::new() }
        })
        .collect();
    model
}

fn cameras() -> [Camera; 3] {
    let eye = DVec3::new(1.0, -20.0, 5.0);
    let perspective = Projection::Perspective { fov_y: 0.6 };
    let of = |eye, projection, depth_range| Camera {
        eye,
        target: DVec3::ZERO,
        up: DVec3::Z,
        projection,
        depth_range,
        size: (160, 120),
    };
    [
        of(eye, perspective, (0.1, 60.0)),
        of(DVec3::new(0.5, 0.5, 0.2), perspective, (2.0, 30.0)),
        of(eye, Projection::Orthographic { height: 30.0 }, (5.0, 50.0)),
    ]
}

/// What is in sight, and the twin's segments of each patch instance: those with segments are in sight, each once.
fn nothing_is_lost(case: &Case, camera: &Camera) -> (InSight, Vec<u32>) {
    let beside_px = f64::from(case.frame.gap_radius_px) + 1.0;
    let reach = Reach { beside_px, beyond_px: case.frame.deviation_px.into() };
    let in_sight = case.data.in_sight(camera, reach);
    let taus = twin::bound::bound(&case.frame, &case.scene(), &mut Counters::default());
    let mut told = vec![false; taus.len()];
    for place in 0..in_sight.patch_instances {
        told[twin::in_sight::patch_instance_at(&in_sight.runs, place) as usize] = true;
    }
    let count = told.iter().filter(|told| **told).count();
    assert_eq!(count, in_sight.patch_instances as usize, "each patch instance once");
    let lost = taus.iter().zip(&told).filter(|(tau, told)| **tau != 0 && !**told).count();
    assert_eq!(lost, 0, "of {} in sight", in_sight.patch_instances);
    (in_sight, taus)
}

/// Five by five flat faces of 64 patches each, without loops. Their first corners are `apart` from each other, and each
/// has a side of 1.
fn sheets(apart: f64) -> Model {
    let knots = || [0].into_iter().chain(0..=8).chain([8]).map(f64::from).collect::<Vec<_>>();
    let face = |n: i32| {
        let corner = apart * DVec2::new((n % 5).into(), (n / 5).into());
        let points = (0..81_i32).map(|k| {
            let at = corner + DVec2::new((k % 9).into(), (k / 9).into()) / 8.0;
            DVec4::new(at.x, at.y, 0.0, 1.0)
        });
        untrimmed(Surface::new((1, 1), knots(), knots(), points.collect()).unwrap())
    };
    placed((0..25).map(face).collect(), DAffine3::IDENTITY)
}

/// Of parts that are partly in sight, whole groups of faces are left out.
#[test]
fn faces_that_are_left_out_pass_bound_would_leave_out() {
    let mut of_hills = hills(&mut Random::new(23));
    of_hills.instances.truncate(120);
    let model = Model { parts: sheets(1.5).parts, ..of_hills };
    for camera in cameras() {
        let case = Case::new(&model, &camera, 0.5);
        let (in_sight, _) = nothing_is_lost(&case, &camera);
        let of_parts: u32 = in_sight.parts.iter().map(|&n| case.data.boxes.placed[n as usize].count).sum();
        assert_eq!(in_sight.parts.len() * 1600, of_parts as usize);
        assert!(in_sight.patch_instances < of_parts / 4 * 3, "{} of {of_parts}", in_sight.patch_instances);
    }
}

/// Groups have whole faces and 256 patches or more, but for the last one. Where faces share sides, all are one group.
#[test]
fn a_part_is_divided_between_faces_that_share_no_side() {
    let counts = |model: &Model| {
        let data = Case::new(model, &cameras()[0], 0.5).data;
        let groups = data.boxes.groups_of(&data.boxes.placed[0]);
        (groups.iter().map(|group| (group.before, group.count)).collect::<Vec<_>>(), data.links.is_empty())
    };
    let apart = [(0, 256), (256, 256), (512, 256), (768, 256), (1024, 256), (1280, 256), (1536, 64)];
    assert_eq!(counts(&sheets(1.5)), (apart.to_vec(), true));
    assert_eq!(counts(&sheets(1.0)), (vec![(0, 1600)], false));
}

/// Copies of a part share its groups, and each has numbers of its own.
#[test]
fn groups_of_copies_have_numbers_of_their_own() {
    let mut model = sheets(1.5);
    model.instances.push(model.instances[0].clone());
    let camera =
        Camera { eye: DVec3::new(3.5, 3.5, 40.0), target: DVec3::new(3.5, 3.5, 0.0), up: DVec3::Y, ..cameras()[0] };
    let data = Case::new(&model, &camera, 0.5).data;
    assert_eq!((data.boxes.groups.len(), data.placed_groups()), (7, 14));
    let in_sight = data.in_sight(&camera, Reach { beside_px: 1.0, beyond_px: 1.0 });
    assert_eq!((in_sight.parts, in_sight.patch_instances), (vec![0, 1], 3200));
    assert_eq!(in_sight.runs, [PatchRun { place: 0, patch_instance: 0 }]);
    let parts = data.parts_in_sight(None, &in_sight.groups);
    let numbers = |of: fn(&abi::PartInSight) -> u32| parts.iter().map(of).collect::<Vec<_>>();
    assert_eq!(numbers(|part| part.group), (0..14).collect::<Vec<_>>());
    let firsts: Vec<u32> = (0..14).map(|n| n / 7 * 1600 + n % 7 * 256).collect();
    assert_eq!(numbers(|part| part.first_patch_instance), firsts);
}

#[test]
fn what_is_left_out_pass_bound_would_leave_out() {
    let model = hills(&mut Random::new(11));
    for camera in cameras() {
        let case = Case::new(&model, &camera, 0.5);
        let (in_sight, taus) = nothing_is_lost(&case, &camera);
        // the margins are thin: a hill that does not surround the eye is seldom in sight without a patch in sight; a
        // hill around the eye may be
        let of_part = case.data.boxes.placed[0].count as usize;
        let is_small = |n: usize| case.data.placements[n].matrix3.determinant().abs() < 1000.0;
        let seen = |of_part: &[u32]| of_part.iter().any(|tau| *tau != 0);
        let parts = taus.chunks(of_part).enumerate().filter(|(n, part)| is_small(*n) && seen(part)).count();
        let told = in_sight.parts.iter().filter(|n| is_small(**n as usize)).count();
        assert!(parts > 5 && told < 2 * parts, "{parts} seen, {told} in sight");
    }
}

#[test]
fn what_is_hidden_is_out_of_sight_and_what_moves_is_where_it_is() {
    let mut model = hill();
    let camera = cameras()[0];
    model.instances = [0.0, 500.0, 0.0]
        .map(|x| Instance {
            part: 0,
            transform: DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)),
            colour: None,
            name: String::new(),
        })
        .to_vec();
    let mut data = Case::new(&model, &camera, 0.5).data;
    let in_sight = |data: &SceneData| data.in_sight(&camera, Reach { beside_px: 1.0, beyond_px: 1.0 });
    assert_eq!(in_sight(&data).parts, [0, 2]);
    let n = data.boxes.placed[0].count;
    let run = |place, patch_instance| PatchRun { place, patch_instance };
    assert_eq!((in_sight(&data).runs, in_sight(&data).patch_instances), (vec![run(0, 0), run(n, 2 * n)], 2 * n));
    data.hidden = vec![true, false, false];
    assert_eq!((in_sight(&data).parts, in_sight(&data).runs), (vec![2], vec![run(0, 2 * n)]));
    data.placements[1] = data.placements[2];
    assert_eq!((in_sight(&data).parts, in_sight(&data).runs), (vec![1, 2], vec![run(0, n)]));
    data.hidden = vec![true; 3];
    assert_eq!(in_sight(&data), InSight::default());
}

/// The surface is continued beyond the borders as far as skirts reach, and sampled.
#[test]
fn nothing_is_drawn_beside_the_rectangle_or_before_the_depth() {
    let model = hills(&mut Random::new(5));
    let faces = [hill_surface(), quarter()].map(beside_its_borders).to_vec();
    let model = Model { parts: placed(faces, DAffine3::IDENTITY).parts, ..model };
    let (mut checked, mut beyond) = (0, 0);
    for camera in cameras() {
        let data = Case::new(&model, &camera, 0.5).data;
        assert!(data.hides_parts());
        let drawn: Vec<_> = data.patches.iter().filter(|patch| patch.side() != Side::Outside).collect();
        assert!(drawn.iter().any(|patch| has_skirts(patch)), "no patch has skirts");
        let in_sight = data.in_sight(&camera, Reach { beside_px: 1.0, beyond_px: 1.0 });
        let parts = data.parts_in_sight(Some(&camera), &in_sight.groups);
        for (part, at) in parts.iter().zip(&in_sight.groups).filter(|(part, _)| part.depth < 1.0) {
            checked += 1;
            let own = data.boxes.placed[at.part as usize].patches;
            let rows = camera.pixel_matrix() * DMat4::from(data.placements[at.part as usize]);
            let [left, top, right, bottom] =
                [part.low & 0xffff, part.low >> 16, part.high & 0xffff, part.high >> 16].map(f64::from);
            for point in drawn.iter().flat_map(|patch| continued(&data, patch)) {
                beyond += usize::from(((point - own.centre).abs() - own.half).max_element() > 0.01);
                let q = rows * point.extend(1.0);
                let (x, y) = ((q.x / q.w).floor(), (q.y / q.w).floor());
                let [width, height] = [camera.size.0, camera.size.1].map(f64::from);
                let is_in_picture = x >= 0.0 && y >= 0.0 && x < width && y < height;
                let is_in_rectangle = x >= left && x <= right && y >= top && y <= bottom;
                assert!(!is_in_picture || is_in_rectangle, "({x}, {y}) beside {part:?}");
                let (near, far) = camera.depth_range;
                let scale = if camera.is_perspective() { near / q.z } else { 1.0 };
                let reversed = (far - q.z) / (far - near) * scale;
                assert!(q.z > near && reversed <= f64::from(part.depth), "{reversed} before {part:?}");
            }
        }
    }
    assert!(checked > 30 && beyond > 1000, "{checked} parts, {beyond} points beyond the boxes of their patches");
}

fn has_skirts(patch: &abi::Patch) -> bool {
    patch.side() == Side::Boundary && patch.borders() != 0
}

/// Points of a patch, and of its surface beyond the borders with skirts.
fn continued(data: &SceneData, patch: &abi::Patch) -> Vec<DVec3> {
    let (degree_u, degree_v) = patch.degrees();
    let points = &data.points[patch.first as usize..][..(degree_u + 1) * (degree_v + 1)];
    let points = points.iter().map(|p| DVec4::from(p.map(f64::from))).collect();
    let surface = Patch { degree_u, degree_v, points };
    let reach = f64::from(twin::MAX_PUSH);
    let range = |[low, high]: [u32; 2]| {
        let beyond = |border: u32| if has_skirts(patch) && patch.borders() & border != 0 { reach } else { 0.0 };
        (-beyond(low), 1.0 + beyond(high))
    };
    let (u, v) = (range([BORDER_U0, BORDER_U1]), range([BORDER_V0, BORDER_V1]));
    let at = |(low, high): (f64, f64), k: usize| low + (high - low) * k as f64 / 8.0;
    (0..9).flat_map(|j| (0..9).map(move |i| (i, j))).map(|(i, j)| surface.point(at(u, i), at(v, j))).collect()
}

/// By de Casteljau's algorithm in single precision, in the corner between two continued borders.
#[test]
fn a_continued_surface_is_rounded_by_less_than_its_bound() {
    let mut random = Random::new(7);
    let mut most: f64 = 0.0;
    for _ in 0..50 {
        let mut coordinate = || f64::from(random.range(-1.0, 1.0) as f32);
        let points = (0..42).map(|_| DVec4::new(coordinate(), coordinate(), coordinate(), 1.0)).collect();
        let patch = Patch { degree_u: 6, degree_v: 5, points };
        let (u, v) = (1.0 + twin::MAX_PUSH, -twin::MAX_PUSH);
        let exact = patch.point(u.into(), v.into());
        let bound = rounding_beyond(&patch, BORDER_U1 | BORDER_V0);
        for axis in 0..3 {
            let rows = patch.points.chunks(7).map(|row| in_single(row.iter().map(|p| p[axis] as f32).collect(), u));
            let off = (f64::from(in_single(rows.collect(), v)) - exact[axis]).abs();
            assert!(off <= bound[axis], "{off} where the bound is {}", bound[axis]);
            most = most.max(off);
        }
        assert!(rounding_beyond(&patch, 0).max_element() < 1.1e-5, "the bound between the borders");
    }
    assert!(most > 2e-5, "{most}: terms as large as their sum would do");
}

fn in_single(mut values: Vec<f32>, t: f32) -> f32 {
    while values.len() > 1 {
        values = values.windows(2).map(|pair| (1.0 - t) * pair[0] + t * pair[1]).collect();
    }
    values[0]
}
