//! Which sides are linked: small cases by hand, and closed surfaces all around.

use super::super::SceneData;
use super::*;
use crate::model::Model;
use crate::parity::{cages, placed, untrimmed};
use crate::picture::SceneSettings;
use crate::spline::Surface;
use glam::{DAffine3, DVec3, DVec4};

/// A patch through a net of `(n + 1) x (k + 1)` points.
fn patch(n: usize, k: usize, point: impl Fn(f64, f64) -> DVec3) -> Surface {
    let at = |i: usize, j: usize| point(i as f64 / n as f64, j as f64 / k as f64).extend(1.0);
    let knots = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    let net: Vec<DVec4> = (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| at(i, j)).collect();
    Surface::new((n, k), knots(n), knots(k), net).unwrap()
}

fn scene(surfaces: Vec<Surface>) -> SceneData {
    SceneData::new(&placed(surfaces.into_iter().map(untrimmed).collect(), DAffine3::IDENTITY), SceneSettings::default())
        .unwrap()
}

/// The sides of a side's link, starting with itself.
fn ring(data: &SceneData, side: u32) -> Vec<u32> {
    let mut all = vec![side];
    while let Some(&last) = all.last() {
        let link = data.links[last as usize];
        if !link.is_shared() || link.next == side {
            break;
        }
        all.push(link.next);
        assert!(all.len() <= MOST_SIDES, "a ring without an end");
    }
    all
}

fn net(data: &SceneData, side: u32) -> Vec<Point> {
    Border::net(side as usize % 4, &data.patches[side as usize / 4]).map(|at| data.points[at].map(f64::from)).collect()
}

fn point(mut net: Vec<Point>, t: f64) -> DVec3 {
    while net.len() > 1 {
        net = net.windows(2).map(|w| std::array::from_fn(|k| w[0][k] * (1.0 - t) + w[1][k] * t)).collect();
    }
    let [x, y, z, w] = net[0];
    DVec3::new(x, y, z) / w
}

/// As `linked_point` of `glsl/include/link.glsl`: the owner of the link's curve at `x` along a side, and the parameter
/// there.
fn of_owner(data: &SceneData, side: u32, x: f64) -> (u32, f64) {
    let of = |side: u32| {
        let place = data.links[side as usize].place;
        (f64::from(place & 0x1fff), f64::from(1u32 << (place >> 13 & 15)), place >> 17 & 1 != 0, place >> 18 & 1 != 0)
    };
    let (start, parts, reversed, _) = of(side);
    let t = (start + if reversed { 1.0 - x } else { x }) / parts;
    let owners = ring(data, side).into_iter().filter_map(|owner| {
        let (start, parts, reversed, owns) = of(owner);
        let y = t * parts - start;
        (owns && (0.0..=1.0).contains(&y)).then_some((owner, if reversed { 1.0 - y } else { y }))
    });
    owners.min_by(|a, b| a.0.cmp(&b.0)).expect("every piece has an owner")
}

/// Squares side by side, for all eight orientations of their parameters.
#[test]
fn a_side_is_found_however_its_neighbour_lies() {
    let one = || patch(2, 2, |u, v| DVec3::new(u - 1.0, v, 0.05 * v * v));
    for turn in 0..8 {
        let other = patch(2, 2, |u, v| {
            let (u, v) = if turn & 1 != 0 { (v, u) } else { (u, v) };
            let (u, v) = (if turn & 2 != 0 { 1.0 - u } else { u }, if turn & 4 != 0 { 1.0 - v } else { v });
            DVec3::new(u, v, 0.05 * v * v)
        });
        let data = scene(vec![one(), other]);
        let side = (turn & 1) + (turn & 2);
        assert_eq!(ring(&data, 2), [2, 4 + side], "turned by {turn}");
        assert_eq!(data.links.iter().filter(|l| l.is_shared()).count(), 2);
        for x in [0.0, 0.25, 1.0] {
            let reversed = turn & 4 != 0;
            assert_eq!(of_owner(&data, 4 + side, x), (2, if reversed { 1.0 - x } else { x }), "turned by {turn}");
        }
    }
}

#[test]
fn halves_and_quarters_are_found_and_thirds_are_not() {
    let curve = |v: f64| DVec3::new(0.0, v, 0.02 * v * v);
    let beside = |from: f64, to: f64| patch(1, 2, move |u, v| arc(from, to, v) + DVec3::X * u);
    // control points of the parabola over [from, to], by blossoming
    fn arc(a: f64, b: f64, v: f64) -> DVec3 {
        let (s, t) = if v == 0.0 {
            (a, a)
        } else if v == 1.0 {
            (b, b)
        } else {
            (a, b)
        };
        DVec3::new(0.0, (s + t) / 2.0, 0.02 * s * t)
    }
    let whole = || patch(1, 2, |u, v| arc(0.0, 1.0, v) - DVec3::X * u);
    assert!(arc(0.0, 1.0, 1.0) == curve(1.0));
    let data = scene(vec![whole(), beside(0.0, 0.5), beside(0.5, 0.75), beside(0.75, 1.0)]);
    assert_eq!(ring(&data, 0).len(), 4);
    assert_eq!(of_owner(&data, 0, 0.25), (4, 0.5));
    assert_eq!(of_owner(&data, 0, 0.875), (12, 0.5));
    assert_eq!(data.links[4].halvings() + data.links[8].halvings() + data.links[12].halvings(), 5);
    let third = 1.0 / 3.0;
    let others = scene(vec![whole(), beside(0.0, third), beside(third, 1.0)]);
    assert!([0, 4, 8].iter().all(|&side| others.links.get(side).is_none_or(|l| !l.is_shared())), "not in halves");
    let open = scene(vec![whole(), beside(0.0, 0.5)]);
    assert!(open.links.is_empty(), "half of it has no neighbour");
}

#[test]
fn three_faces_at_a_side_are_one_ring() {
    let leaf = |k: f64| patch(1, 1, move |u, v| DVec3::new(u * k.cos(), u * k.sin(), v));
    let data = scene(vec![leaf(0.0), leaf(1.0), leaf(2.0)]);
    let mut sides = ring(&data, 0);
    sides.sort_unstable();
    assert_eq!(sides, [0, 4, 8]);
    assert!([0, 4, 8].iter().all(|&side| of_owner(&data, side, 0.3) == (0, 0.3)));
}

#[test]
fn what_shares_no_side_has_no_links() {
    let plate = |z: f64| patch(1, 1, move |u, v| DVec3::new(u, v, z));
    assert!(scene(vec![plate(0.0)]).links.is_empty());
    assert!(scene(vec![plate(0.0), plate(1.0)]).links.is_empty());
    // another degree: the points are the same, the control points are not
    let square = |degree: usize| patch(degree, degree, |u, v| DVec3::new(u * degree as f64 - 1.0, v, 0.0));
    assert!(scene(vec![square(1), square(2)]).links.is_empty());
}

/// Number of shared sides of a model's first part. Asserts that no border is left over.
fn linked_all_round(name: &str, model: &Model) -> (usize, u32) {
    let data = SceneData::new(model, SceneSettings::default()).unwrap();
    let size = data.points.iter().flatten().fold(0.0f32, |m, x| m.max(x.abs()));
    let slack = 4.0 * SAME * f64::from(size);
    let all = borders(&data.faces, 0..data.faces.len(), &data.patches);
    let (mut sides, mut deepest, mut ends) = (0, 0, HashMap::new());
    for side in all.flat_map(|b| b.sides().map(move |side| (4 * b.patch + side) as u32).collect::<Vec<_>>()) {
        let own = net(&data, side);
        let (first, last) = (own[0], own[own.len() - 1]);
        for p in [first, last] {
            let here: &mut Vec<Point> =
                ends.entry([0, 1, 2].map(|k| (p[k] / slack / 64.0).round() as i64)).or_default();
            let near = |q: &&Point| (0..3).all(|k| (p[k] - q[k]).abs() <= slack / 4.0);
            if let Some(q) = here.iter().find(near) {
                assert_eq!(*q, p, "{name}: a corner has two numbers");
            } else {
                here.push(p);
            }
        }
        let point_of = |p: &Point| DVec3::new(p[0], p[1], p[2]) / p[3];
        if own.iter().all(|p| point_of(p).distance(point_of(&first)) <= slack / 4.0) {
            continue; // a pole
        }
        assert!(data.links[side as usize].is_shared(), "{name}: side {side} is alone");
        sides += 1;
        deepest = deepest.max(data.links[side as usize].halvings());
        for x in [0.0, 0.125, 0.5, 0.75, 1.0] {
            let (owner, y) = of_owner(&data, side, x);
            let apart = point(own.clone(), x).distance(point(net(&data, owner), y));
            assert!(apart <= slack, "{name}: side {side} is {apart} from its owner at {x}");
        }
    }
    (sides, deepest)
}

#[test]
fn closed_surfaces_are_linked_all_round() {
    let found: Vec<_> = cages::all().iter().map(|c| (c.name, linked_all_round(c.name, &c.model))).collect();
    let of_box = found.iter().find(|(name, _)| *name == "box").unwrap().1.1;
    for (name, (sides, deepest)) in found {
        assert!(sides > 50, "{name}: {sides} sides");
        let cut = match name {
            "cube" | "torus" => deepest == 0,
            "fine" => deepest > of_box,
            _ => deepest > 0,
        };
        assert!(cut, "{name}: halved {deepest} times");
    }
}
