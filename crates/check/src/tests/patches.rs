//! Free-form patches against a dense triangulation, and degenerate nets.

use super::shapes::*;
use crate::Tracer;
use crate::model::Camera;
use glam::{DAffine3, DVec2, DVec3, DVec4};

/// How many triangles of an `n` by `n` mesh of the patch cover the pixel position.
struct Mesh {
    n: usize,
    seen: Vec<DVec2>,
}

impl Mesh {
    fn new(model: &crate::model::Model, camera: &Camera, n: usize) -> Self {
        let grid = model.parts[0].faces[0].surface.patches();
        let at = |k: usize| k as f64 / n as f64;
        let seen = (0..=n)
            .flat_map(|j| (0..=n).map(move |i| (i, j)))
            .map(|(i, j)| camera.project(grid.point(at(i), at(j))).expect("in front of the eye").0)
            .collect();
        Self { n, seen }
    }

    fn layers(&self, p: DVec2) -> usize {
        let corner = |i: usize, j: usize| self.seen[j * (self.n + 1) + i] - p;
        let mut count = 0;
        for j in 0..self.n {
            for i in 0..self.n {
                let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)];
                for t in [[a, b, c], [d, c, b]] {
                    let side = |x: DVec2, y: DVec2| x.perp_dot(y) > 0.0;
                    let s = [side(t[0], t[1]), side(t[1], t[2]), side(t[2], t[0])];
                    count += usize::from(s[0] == s[1] && s[1] == s[2]);
                }
            }
        }
        count
    }
}

#[test]
fn random_patches_have_as_many_layers_as_their_meshes() {
    let camera = view(DVec3::new(0.5, 0.4, 4.0));
    let (mut compared, mut many) = (0, 0);
    for seed in 1..=24 {
        let mut random = noise(seed);
        let degrees = [(3, 3), (3, 3), (2, 4), (5, 1)][seed as usize % 4];
        let rational = seed % 3 == 0;
        let count = (degrees.0 + 1) * (degrees.1 + 1);
        let net = (0..count)
            .map(|_| {
                let w = if rational { 10f64.powf(random()) } else { 1.0 };
                DVec4::new(random() * w, random() * w, random() * w, w)
            })
            .collect();
        let model = single(patch(degrees, net));
        let tracer = Tracer::new(&model);
        let grid = model.parts[0].faces[0].surface.patches();
        let mesh = Mesh::new(&model, &camera, 160);
        for _ in 0..60 {
            let on = grid.point(0.5 + 0.5 * random(), 0.5 + 0.5 * random());
            let pixel = camera.project(on).expect("in front").0 + DVec2::new(random(), random());
            let hits = tracer.hits(&camera, pixel);
            for h in &hits {
                let (p, _) = camera.project(h.point).expect("in front");
                assert!((p - pixel).length() < 1e-11, "a hit lies on the ray");
            }
            // near a fold or the patch's own border the mesh is not the surface
            let cosine = |h: &crate::Hit| h.normal.dot(camera.ray(pixel).1).abs();
            let border = |h: &crate::Hit| h.uv.min(1.0 - h.uv).min_element() < 0.01;
            let layers = mesh.layers(pixel);
            if hits.iter().any(|h| cosine(h) < 0.15 || border(h)) {
                continue;
            }
            // the mesh may also hit a layer that the surface just misses, or lose one: compare around the pixel
            let steady = (0..8).all(|k| mesh.layers(pixel + DVec2::from_angle(f64::from(k)) * 0.4) == layers);
            if steady {
                assert_eq!(hits.len(), layers, "seed {seed}, pixel {pixel}");
                compared += 1;
                many += usize::from(layers > 1);
            }
        }
        assert_eq!(tracer.given_up(), 0, "seed {seed}");
    }
    assert!(compared > 300 && many > 50, "{compared} rays, {many} with several layers");
}

#[test]
fn a_patch_of_high_degree_and_wild_weights() {
    // degree 15: a bump whose weights range over 1e6; every pixel's hits project back onto it
    let mut random = noise(5);
    let net = (0..256)
        .map(|k| {
            let (x, y) = (f64::from(k % 16) / 7.5 - 1.0, f64::from(k / 16) / 7.5 - 1.0);
            let w = 1000f64.powf(random());
            DVec4::new(x * w, y * w, 0.3 * random() * w, w)
        })
        .collect();
    let tracer = Tracer::new(&single(patch((15, 15), net)));
    let camera = view(DVec3::new(0.5, 0.4, 4.0));
    let mut seen = 0;
    for k in 0..400 {
        let pixel = DVec2::new(30.0 + f64::from(k % 20) * 2.03, 22.0 + f64::from(k / 20) * 1.87);
        let hits = tracer.hits(&camera, pixel);
        // the net is a graph over x and y but for its weights, which may fold it: an odd number of hits
        seen += hits.len() % 2;
        for h in &hits {
            assert!((camera.project(h.point).expect("in front").0 - pixel).length() < 1e-10);
        }
    }
    assert!(seen > 380, "{seen} of 400 rays through the middle meet it an odd number of times");
    assert_eq!(tracer.given_up(), 0);
}

#[test]
fn neighbours_lose_no_ray_between_them() {
    // a sheet of parallelograms, a flat and a bent cubic one, each over 5 by 5 patches; rays through the
    // knots and leaf borders
    for (degree, bump) in [(1, 0.0), (3, 0.0), (3, 0.3)] {
        let n = 5 + degree;
        let knots: Vec<f64> = (0..n + degree + 1).map(|k| k.clamp(degree, n) as f64 - degree as f64).collect();
        let points = (0..n * n)
            .map(|k| {
                let (x, y) = ((k % n) as f64 - 3.5, (k / n) as f64 - 3.5);
                DVec4::new(x * 0.3, y * 0.31, bump * (x * 1.3).sin() * (y * 0.9).cos(), 1.0)
            })
            .collect();
        let sheet = crate::spline::Surface::new((degree, degree), knots.clone(), knots, points).unwrap();
        let grid = sheet.patches();
        let tracer = Tracer::new(&single(sheet));
        for j in 1..80 {
            for i in 1..80 {
                let through = grid.point(f64::from(i) / 16.0, f64::from(j) / 16.0);
                let hits = tracer.hits(&aimed(through, DVec3::new(0.1, 0.2, -1.0)), MIDDLE);
                assert_eq!(hits.len(), 1, "degree {degree}, bump {bump}, {i}, {j}: {hits:#?}");
                assert!((hits[0].point - through).length() < 1e-14);
            }
        }
    }
}

#[test]
fn sheets_without_area_are_not_seen_and_not_searched_for_ever() {
    let camera = aimed(DVec3::ZERO, DVec3::X);
    // edge-on: a plane, a bent sheet inside a plane, and one collapsed to a line
    let bent = |scale: f64| {
        let points = (0..16)
            .map(|k| {
                let (x, y) = (f64::from(k % 4) - 1.4, f64::from(k / 4) - 1.3);
                DVec4::new(x + 0.2 * y * y, (y + 0.1 * x * x) * scale, 0.0, 1.0)
            })
            .collect();
        patch((3, 3), points)
    };
    for sheet in [rectangle(DVec3::new(-1.0, -1.0, 0.0), DVec3::X * 2.0, DVec3::Y * 2.0), bent(1.0), bent(0.0)] {
        let tracer = Tracer::new(&single(sheet));
        assert!(tracer.hits(&camera, MIDDLE).is_empty());
        assert_eq!(tracer.given_up(), 0);
    }
    let empty = Tracer::new(&model(vec![], &[DAffine3::IDENTITY]));
    assert!(empty.first(&camera, MIDDLE).is_none());
    let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0));
    assert!(Tracer::new(&model(vec![face(1, sphere(), vec![])], &[flat])).first(&camera, MIDDLE).is_none());
}
