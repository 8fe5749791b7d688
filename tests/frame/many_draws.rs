//! Scenes of more draws than one rendering takes: what earlier renderings have drawn stays.

use crate::shapes;
use crate::support::{assert_silent, plain, watched_for};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use selvedge::construct::extrude;
use selvedge::model::{Camera, Face, Model, Projection, SurfaceKind};
use selvedge::picture::{FrameSettings, Levels, Outputs, TrimWay};
use selvedge::spline::BSpline;

/// Tiles along a side; each is a unit wide.
const TILES: u32 = 64;
/// Pixels of a tile, along a side.
const PIXELS: u32 = 2;
/// With 17 by 17 vertices a tile, all tiles have a million: llvmpipe, which takes 3,775 in a draw, gets 313 draws.
const LEVEL: u32 = 16;

/// A tile, and the same with trims that leave the surface's own border out.
fn tiles() -> [Face; 2] {
    let end = |x: f64| DVec4::new(x, 0.0, 0.0, 1.0);
    let side = BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![end(0.0), end(1.0)]).expect("a side");
    let tile = shapes::face(1, SurfaceKind::Plane, extrude(&side, DVec3::Y).expect("a tile"));
    let inner = shapes::rectangle(DVec2::splat(0.1), DVec2::splat(0.9));
    [tile.clone(), Face { loops: vec![inner], ..tile }]
}

#[test]
fn each_pixel_sees_its_tile() {
    let half = 0.5 * f64::from(TILES);
    let camera = Camera {
        eye: DVec3::new(half, half, 5.0),
        target: DVec3::new(half, half, 0.0),
        up: DVec3::Y,
        projection: Projection::Orthographic { height: f64::from(TILES) },
        depth_range: (1.0, 10.0),
        size: (TILES * PIXELS, TILES * PIXELS),
    };
    let outputs = Outputs { instance: true, ..Outputs::default() };
    let settings = FrameSettings { levels: Levels::Fixed(LEVEL), ..FrameSettings::default() };
    let expected = |pixel: u32| {
        let (x, y) = (pixel % camera.size.0 / PIXELS, pixel / camera.size.0 / PIXELS);
        (TILES - 1 - y) * TILES + x + 1 // numbered from 1
    };
    for (name, face) in ["plain", "trimmed"].into_iter().zip(tiles()) {
        let mut model = Model { instances: Vec::new(), ..shapes::one(name, false, vec![face]) };
        for nth in 0..TILES * TILES {
            let place = DVec3::new((nth % TILES).into(), (nth / TILES).into(), 0.0);
            model.instances.push(shapes::placed(DAffine3::from_translation(place), None));
        }
        let mut renderer = watched_for(outputs, &model, plain(TrimWay::Exact));
        let picture = renderer.render(&camera, &settings, outputs).unwrap();
        assert_eq!(picture.stats.triangles, u64::from(TILES * TILES * 2 * LEVEL * LEVEL), "{name}");
        let wrong: Vec<u32> =
            (0..).zip(&picture.instance).filter(|(pixel, seen)| **seen != expected(*pixel)).map(|(p, _)| p).collect();
        assert!(wrong.is_empty(), "{name}: {} pixels, the first {:?}", wrong.len(), wrong.first());
        assert_silent(renderer);
    }
}
