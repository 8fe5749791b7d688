//! Boolean solids that are hard for other renderers, every pixel against the exact reference: cases beyond `solids` and
//! `operands`.

use crate::cages;
use crate::shapes::operands;
use crate::shapes::solids::{self, at, ball, block, moved, post, ring, turned};
use crate::solids::right_at;
use crate::support::{assert_silent, perspective, render, watched};
use glam::DVec3;
use selvedge::csg::{Builder, Op};
use selvedge::model::{Camera, Mesh, Model, Primitive, Projection, Quadric, Shape, Solid};
use selvedge::picture::{SceneSettings, SolidWay};
use selvedge_check::{JudgeOptions, Tracer, judge};
use std::sync::Arc;

const SIZE: (u32, u32) = (120, 80);

/// A plate less `n` holes of the shape D, each the product of a cylinder and a block, flush on both sides: as a
/// sum of products 2^n terms.
fn d_holes(n: u32) -> Model {
    let mut b = Builder::new();
    let mut all = vec![block([-2.0, -2.0, 0.0], [3.0 * f64::from(n.div_ceil(5)), 14.0, 1.0])];
    let mut root = b.leaf(0);
    for k in 0..n {
        let place = at(3.0 * f64::from(k / 5), 3.0 * f64::from(k % 5), 0.0);
        all.push(moved(place, post(1.0, 0.0, 1.0)));
        all.push(moved(place, block([0.0, -1.0, 0.0], [1.0, 1.0, 1.0])));
        let (disc, half) = (b.leaf(2 * k + 1), b.leaf(2 * k + 2));
        let hole = b.pair(Op::Intersection, disc, half);
        root = b.pair(Op::Difference, root, hole);
    }
    (1..).zip(&mut all).for_each(|(id, p)| p.id = id);
    Model { solids: vec![Solid::new(all, b.finish(root).unwrap()).unwrap()], ..Model::default() }
}

/// The product of `factors` unions of `terms` balls each: as a sum of products `terms^factors` of them.
fn product_of_unions(factors: u32, terms: u32) -> Model {
    let mut b = Builder::new();
    let mut all = Vec::new();
    let mut unions = Vec::new();
    for f in 0..factors {
        let leaves: Vec<u32> = (0..terms)
            .map(|t| {
                let (s, c) = (f64::from(t) * 0.9 + f64::from(f) * 0.3).sin_cos();
                let place = at(0.9 * c, 0.9 * s, 0.12 * f64::from(t) - 0.4 + 0.1 * f64::from(f));
                all.push(moved(place, ball(0.55, 0.0)));
                b.leaf(all.len() as u32 - 1)
            })
            .collect();
        unions.push(b.fold(Op::Union, leaves));
    }
    let root = b.fold(Op::Intersection, unions);
    (1..).zip(&mut all).for_each(|(id, p)| p.id = id);
    Model { solids: vec![Solid::new(all, b.finish(root).unwrap()).unwrap()], ..Model::default() }
}

#[test]
fn d_holes_and_products_of_unions() {
    let cases = vec![
        ("9 D-holes", d_holes(9)),
        ("50 D-holes", d_holes(50)),
        ("a product of three unions of 8", product_of_unions(3, 8)),
        ("a product of five unions of 16", product_of_unions(5, 16)),
    ];
    right_at(SIZE, cases, false);
}

/// A prism of `n` sides of circumradius 1, from z = 0 to 1.
fn prism(n: u32) -> Mesh {
    let corner = |k: u32, z: f64| {
        let (s, c) = (std::f64::consts::TAU * f64::from(k) / f64::from(n)).sin_cos();
        DVec3::new(c, s, z)
    };
    let positions: Vec<DVec3> = (0..n).map(|k| corner(k, 0.0)).chain((0..n).map(|k| corner(k, 1.0))).collect();
    let side = |k: u32| {
        let next = (k + 1) % n;
        [[k, next, n + next], [k, n + next, n + k]]
    };
    let caps = (1..n - 1).flat_map(|k| [[0, k + 1, k], [n, n + k, n + k + 1]]);
    Mesh::new(1, positions, (0..n).flat_map(side).chain(caps).collect(), vec![]).unwrap()
}

/// The same cylinder in facets, turned by half a facet: ends coincide, sides cross in slivers.
#[test]
fn the_same_cylinder_in_other_facets() {
    let one = || operands::mesh(prism(24));
    let turned_half = || moved(turned(0.0, 0.0, std::f64::consts::PI / 24.0), one());
    let whole = || moved(turned(0.0, 0.0, std::f64::consts::TAU / 24.0), one());
    let cases = vec![
        ("both", solids::solid("A+B", vec![one(), turned_half()])),
        ("in both", solids::solid("AB", vec![one(), turned_half()])),
        (
            "a bore in other facets",
            solids::solid("C-B", vec![one(), turned_half(), block([-2.0, -2.0, 0.0], [2.0, 2.0, 1.0])]),
        ),
        ("turned by a whole facet", solids::solid("AB", vec![one(), whole()])),
    ];
    right_at((96, 64), cases, false);
}

/// Subdivision shells as operands, by their limit patches, which share sides: every ray that enters one leaves it.
#[test]
fn a_subdivision_shell_is_an_operand() {
    for closed in [cages::a_box(), cages::tips_of_5()] {
        let (part, bounds) = (Arc::new(closed.model.parts[0].clone()), closed.model.control_bounds());
        let shell = || solids::primitive(Shape::Part(part.clone()), glam::DAffine3::IDENTITY);
        let [a, b] = [bounds.centre(), bounds.centre() + bounds.diagonal() * 0.3];
        let (radius, corner) = (0.25 * bounds.diagonal(), bounds.centre().lerp(bounds.min, 0.3));
        let bite = || moved(glam::DAffine3::from_translation(b - DVec3::Z * 0.2), ball(radius, 0.0));
        let less = solids::solid("A-B", vec![shell(), bite()]);
        let mut renderer = watched(&less);
        for camera in [perspective(&less, (360, 240)), perspective(&less, (181, 127))] {
            let picture = render(&mut renderer, &camera);
            let stats = &picture.stats;
            assert!(stats.fragments > 5000, "{}: {} fragments", closed.name, stats.fragments);
            assert_eq!((stats.unpaired, stats.mended, stats.clamps), (0, 0, 0), "{}", closed.name);
        }
        assert_silent(renderer);
        let block = block(corner.to_array(), a.lerp(bounds.max, 1.1).to_array());
        right_at(
            (72, 48),
            vec![("less a ball", less), ("from a block", solids::solid("B-A", vec![shell(), block]))],
            false,
        );
    }
}

/// Tiles with reduced lists and tiles with all leaves give the same picture: the same solid from primitives with a box,
/// and from the same quadrics without one.
#[test]
fn leaving_out_what_a_tile_does_not_see_changes_nothing() {
    let row = |boxed: bool| {
        let sphere = Quadric { squares: DVec3::ONE, constant: -0.25, ..Quadric::default() };
        let shape = if boxed { Shape::Sphere { radius: 0.5 } } else { Shape::Quadric(sphere) };
        let hole = |i: u32| solids::primitive(shape.clone(), at(0.7 * f64::from(i % 6), 0.8 * f64::from(i / 6), 1.0));
        let plate = block([-1.0, -1.0, 0.0], [5.0, 5.0, 1.0]);
        solids::folded(Op::Difference, [plate].into_iter().chain((0..36).map(hole)).collect())
    };
    let (boxed, unboxed) = (row(true), row(false));
    let finite = |p: &Primitive| p.bounds().diagonal().is_finite();
    assert!(boxed.solids[0].primitives().iter().all(finite) && !unboxed.solids[0].primitives()[1..].iter().any(finite));
    let camera = perspective(&boxed, SIZE);
    let mut renderer = watched(&boxed);
    for way in SolidWay::ALL {
        let settings = SceneSettings { solids: *way, ..Default::default() };
        renderer.upload_with(&boxed, settings).unwrap();
        let pruned = render(&mut renderer, &camera);
        renderer.upload_with(&unboxed, settings).unwrap();
        let all = render(&mut renderer, &camera);
        let same = pruned.face == all.face && pruned.depth == all.depth && pruned.colour == all.colour;
        assert!(same, "by {}", way.name());
        assert_eq!((pruned.stats.clamps, all.stats.clamps), (0, 0), "by {}", way.name());
    }
    assert_silent(renderer);
}

/// A ray that meets the outer equator has a root of its quartic at the border of the sphere around the torus. From afar
/// rounding decided whether it was found: dots along the equator showed what lies behind.
#[test]
fn outer_equators_from_afar() {
    const TIMES: f64 = 100.0;
    let mut renderer = watched(&Model::default());
    for minor in [0.08, 0.3] {
        let model = solids::solid("A", vec![moved(turned(0.4, 0.3, 0.0), ring(1.0, minor))]);
        let near = perspective(&model, SIZE);
        let eye = near.target + TIMES * (near.eye - near.target);
        let away = eye.distance(near.target);
        let afar = Camera {
            eye,
            projection: Projection::Perspective { fov_y: 35f64.to_radians() / TIMES },
            depth_range: (away - 3.0, away + 3.0),
            ..near
        };
        renderer.upload(&model).unwrap();
        let picture = render(&mut renderer, &afar);
        let j = judge(&Tracer::new(&model), &afar, &picture.images(), &JudgeOptions::default());
        assert_eq!((j.wrong, j.given_up), (0, 0), "{minor}: {:?}", j.mismatches);
        assert!(j.depth_regular.px.count > 300, "{minor}: few pixels show the ring");
    }
    assert_silent(renderer);
}
