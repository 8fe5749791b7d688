//! Boolean solids with operands of meshes and spline parts, against the exact reference, every pixel.

use crate::shapes::{self, operands, solids};
use crate::solids::{faults, right_at};
use crate::support::{assert_identical, assert_silent, perspective, render, watched};
use glam::{DAffine3, DVec3};
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{SceneSettings, SolidWay};
use selvedge_check::{JudgeOptions, Tracer, judge};

/// Small, because the exact reference is slow for meshes and splines.
const SIZE: (u32, u32) = (96, 64);

#[test]
fn meshes() {
    right_at(SIZE, operands::meshes(), false);
}

#[test]
fn spline_parts() {
    right_at(SIZE, operands::splines(), false);
}

/// Near a silhouette fragments of a squeezed torus are interchanged, behind a near plane that cuts its box.
#[test]
fn a_squeezed_torus_in_a_mesh() {
    right_at(SIZE, vec![("a mesh less a torus", operands::squeezed_torus())], false);
}

#[test]
fn unclean_meshes() {
    right_at(SIZE, operands::unclean(), false);
}

/// A part that is inside out shows its near walls with every way, although nothing touches the mesh.
#[test]
fn meshes_that_are_partly_inside_out() {
    let mut renderer = watched(&Model::default());
    let mut wrong = Vec::new();
    for (name, model) in operands::partly_inside_out() {
        let tracer = Tracer::new(&model);
        let whole = perspective(&model, SIZE);
        // the near plane cuts the mesh
        let cutting = Camera { depth_range: (whole.eye.distance(whole.target), 50.0), ..whole };
        for way in SolidWay::ALL {
            renderer.upload_with(&model, SceneSettings { solids: *way, ..Default::default() }).unwrap();
            for camera in [whole, cutting] {
                // a far wall is the same face as the near one: normals distinguish them
                let fault = faults(&mut renderer, &tracer, &camera, false);
                wrong.extend(fault.map(|f| format!("{name}, by {}: {f}", way.name())));
            }
        }
    }
    assert_silent(renderer);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Open meshes are counted, and the rest of the picture is right.
#[test]
fn open_meshes_are_counted() {
    let open = operands::open_mesh();
    let whole = solids::solid("A-B", vec![operands::mesh(shapes::ball_mesh(2)), solids::ball(0.1, 0.0)]);
    let mut renderer = watched(&open);
    let camera = Camera { eye: DVec3::new(0.0, -9.0, 0.1), ..perspective(&open, SIZE) };
    let counted = render(&mut renderer, &camera).stats;
    assert!(counted.unpaired > 0 && counted.clamps == 0, "{counted:?}");
    renderer.upload(&whole).unwrap();
    let closed = render(&mut renderer, &perspective(&whole, SIZE)).stats;
    assert_eq!((closed.unpaired, closed.mended, closed.fragments > 0), (0, 0, true));
    assert_silent(renderer);
}

/// The eye inside operands, the near plane through them, the far plane before their ends.
#[test]
fn the_camera_stands_within_operands() {
    let rock = || operands::mesh(shapes::torus_mesh(24));
    let cases = [
        solids::solid("A-B", vec![solids::ball(6.0, 0.0), rock()]),
        solids::solid("AB", vec![operands::part(shapes::sphere()), solids::block([-1.0; 3], [1.0, 1.0, 0.4])]),
        solids::solid("A-B", vec![operands::part(shapes::sphere()), operands::part(shapes::cube())]),
    ];
    let mut renderer = watched(&Model::default());
    let mut wrong = Vec::new();
    for (k, model) in cases.iter().enumerate() {
        renderer.upload(model).unwrap();
        let tracer = Tracer::new(model);
        for (eye, near, far) in [(DVec3::new(3.0, 0.1, 0.2), 0.01, 30.0), (DVec3::new(-5.0, -7.0, 1.0), 6.0, 9.5)] {
            let (up, projection) = (DVec3::Z, Projection::Perspective { fov_y: 1.0 });
            let camera = Camera { eye, target: DVec3::ZERO, up, projection, depth_range: (near, far), size: SIZE };
            let picture = render(&mut renderer, &camera);
            let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
            let fault = j.wrong != 0 || picture.stats.clamps != 0;
            wrong.extend(fault.then(|| format!("{k} from {eye}: {} wrong, {:?}", j.wrong, j.mismatches.first())));
        }
    }
    assert_silent(renderer);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Meshes that nothing touches need no lists: seen from outside and from inside, mirrored, beside a solid that stays a
/// solid.
#[test]
fn isolated_meshes() {
    let rock = || operands::mesh(shapes::torus_mesh(24));
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 0.7, 1.2));
    let model = solids::solid(
        "A+B+(C-D)",
        vec![
            rock(),
            solids::moved(solids::at(9.0, 0.0, 1.0) * mirror, rock()),
            solids::moved(solids::at(4.0, 9.0, 0.0), operands::mesh(shapes::ball_mesh(2))),
            solids::moved(solids::at(4.0, 8.5, 0.0), solids::ball(0.7, 0.5)),
        ],
    );
    let tracer = Tracer::new(&model);
    let mut renderer = watched(&model);
    let (up, projection) = (DVec3::Z, Projection::Perspective { fov_y: 1.0 });
    let within = |eye: DVec3| Camera {
        eye,
        target: DVec3::new(4.0, 4.0, 0.0),
        up,
        projection,
        depth_range: (0.01, 50.0),
        size: SIZE,
    };
    let cameras = [perspective(&model, SIZE), within(DVec3::new(-3.0, 0.1, 0.1)), within(DVec3::new(6.0, 0.1, 1.0))];
    for (camera, sees) in cameras.iter().zip([3, 1, 1]) {
        let picture = render(&mut renderer, camera);
        let j = judge(&tracer, camera, &picture.images(), &JudgeOptions::default());
        assert_eq!((j.wrong, picture.stats.unpaired), (0, 0), "{}: {:?}", camera.eye, j.mismatches.first());
        let seen: std::collections::BTreeSet<u32> = picture.face.iter().copied().filter(|f| *f != 0).collect();
        assert!(seen.len() >= sees, "{seen:?}");
    }
    let crossings = render(&mut renderer, &cameras[0]).stats.fragments;
    // the ball is cut; of 6144 pixels the rocks cover most that are not background
    assert!((1..1000).contains(&crossings), "{crossings}");
    assert_silent(renderer);
}

/// More than 255 layers of one mesh in a pixel; all of them are subtracted from a block. The picture repeats.
#[test]
fn deep_meshes_repeat() {
    let model = solids::solid("A-B", vec![solids::block([-0.1; 3], [1.1; 3]), operands::mesh(operands::comb(150))]);
    let mut camera = perspective(&model, SIZE);
    camera.eye = DVec3::new(9.0, 0.5, 0.6);
    let mut renderer = watched(&model);
    let picture = render(&mut renderer, &camera);
    let tracer = Tracer::new(&model);
    let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
    assert_eq!((j.wrong, picture.stats.clamps, picture.stats.unpaired), (0, 0, 0), "{:?}", j.mismatches.first());
    // at least 300 walls in each of a hundred pixels
    assert!(picture.stats.fragments > 300 * 100, "{}", picture.stats.fragments);
    assert_identical(&picture, &render(&mut renderer, &camera), "again");
    assert_silent(renderer);
}

/// Equivalent expressions show the same faces at the same depths, bit for bit.
#[test]
fn equal_expressions_are_equal_pictures() {
    let one = |text: &str| {
        let rock = operands::mesh(shapes::torus_mesh(20));
        let mut model = solids::solid(text, vec![rock, operands::part(shapes::sphere()), solids::ball(1.3, 3.0)]);
        let solid = &model.solids[0];
        let same = solid.primitives().iter().map(|p| selvedge::model::Primitive { id: 1, ..p.clone() }).collect();
        model.solids = vec![selvedge::model::Solid::new(same, solid.tree().clone()).unwrap()];
        model
    };
    let first = one("A-(B+C)");
    let camera = perspective(&first, SIZE);
    let mut renderer = watched(&first);
    let picture = render(&mut renderer, &camera);
    assert!(picture.face.contains(&1));
    for text in ["(A-B)-C", "(A-C)-B", "A!B!C", "!(!A+(C+B))", "A-(A-(A-(B+C)))"] {
        renderer.upload(&one(text)).unwrap();
        let drawn = render(&mut renderer, &camera);
        let differ = drawn.depth.iter().zip(&picture.depth).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        assert_eq!((differ, drawn.face == picture.face), (0, true), "{text}");
    }
    assert_silent(renderer);
}

/// Tens of thousands of triangles in planes of their own, less three bores: by events and by layers. Each triangle
/// takes only its corners: 12 bytes, and half a vertex of 12.
#[test]
fn many_triangles() {
    let mut ripple = shapes::tetra();
    ripple.parts[0].meshes = vec![shapes::torus_mesh(130)];
    let triangles = ripple.parts[0].meshes[0].triangles().len() as u64;
    let bore = |x: f64, y: f64| solids::moved(solids::at(x, y, 0.0), solids::post(0.7, -4.0, 8.0));
    let across = solids::moved(solids::turned(0.0, 1.5, 0.3), solids::post(0.4, -5.0, 10.0));
    let model = solids::solid("A-(B+C+D)", vec![operands::part(ripple), bore(3.0, 0.0), bore(-1.8, -2.4), across]);
    right_at(SIZE, vec![("many triangles", model.clone())], false);
    let mut renderer = watched(&model);
    render(&mut renderer, &perspective(&model, SIZE));
    let of_scene = ["operand triangles", "operand positions", "operand planes", "solid surface", "solid sides"];
    let objects = renderer.object_bytes().into_iter();
    let bytes: u64 = objects.filter(|o| of_scene.iter().any(|name| o.0.starts_with(name))).map(|o| o.1).sum();
    assert!(bytes > 12 * triangles && bytes < 19 * triangles, "{bytes} bytes of {triangles} triangles");
    assert_silent(renderer);
}
