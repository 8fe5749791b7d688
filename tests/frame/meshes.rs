//! Meshes against the exact reference, every pixel, and against closed forms.

use crate::shapes;
use crate::support::{assert_silent, orthographic, perspective, render, watched};
use glam::{DAffine3, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Mesh, Model};
use selvedge_check::{JudgeOptions, Judgement, Tracer, judge};

const SIZE: (u32, u32) = (320, 240);
/// Error of a flat normal in single precision: corners are off by 2^-24 of the part's size, and the triangles here are
/// at least a hundredth of that.
const NORMAL_DEG: f64 = 2e-3;

/// Draws from above and from a low angle, in both projections. Every pixel's boundary is within half a pixel, and no
/// depth is wrong.
fn keeps_the_promise(model: &Model, normal_deg: f64) -> Vec<Judgement> {
    let tracer = Tracer::new(model);
    let mut renderer = watched(model);
    let low = |camera: Camera| {
        let from = DVec3::new(-1.2, -1.0, 0.35).normalize();
        let eye = camera.target + from * camera.eye.distance(camera.target);
        Camera { eye, ..camera }
    };
    let (a, b) = (perspective(model, SIZE), orthographic(model, SIZE));
    let judged = [a, low(a), b, low(b)].map(|camera| is_right(&tracer, &mut renderer, &camera, normal_deg));
    assert_silent(renderer);
    judged.to_vec()
}

fn is_right(tracer: &Tracer, renderer: &mut HeadlessRenderer, camera: &Camera, normal_deg: f64) -> Judgement {
    let picture = render(renderer, camera);
    let j = judge(tracer, camera, &picture.images(), &JudgeOptions::default());
    assert_eq!((j.sampled, j.wrong, j.given_up), (u64::from(SIZE.0 * SIZE.1), 0, 0), "{:?}", j.mismatches);
    assert!(j.agree + j.ties > j.sampled * 99 / 100, "only {} pixels agree", j.agree);
    assert!(j.normal_deg.count > 1000 && j.normal_deg.worst < normal_deg, "{:?}", j.normal_deg);
    j
}

#[test]
fn a_tetrahedron() {
    keeps_the_promise(&shapes::tetra(), NORMAL_DEG);
}

#[test]
fn a_mesh_placed_twice_once_mirrored() {
    keeps_the_promise(&shapes::facets(), NORMAL_DEG);
}

#[test]
fn a_mesh_that_cuts_into_a_trimmed_cylinder() {
    keeps_the_promise(&shapes::beside(), 0.1);
}

#[test]
fn a_mesh_that_cuts_into_a_whole_sphere() {
    keeps_the_promise(&shapes::globe(), 0.1);
}

#[test]
fn trimmed_solids_and_shells_before_meshes() {
    keeps_the_promise(&shapes::floor(), 0.1);
}

/// Where the torus hides itself by less than the rasteriser's 1/256 pixel, a normal may be the other sheet's, so the
/// mean is tested. Most triangles are smaller than a pixel.
#[test]
fn a_closed_mesh_of_200_000_triangles() {
    let judged = keeps_the_promise(&shapes::whole_mesh("torus", shapes::torus_mesh(316)), 180.0);
    assert!(judged.iter().all(|j| j.normal_deg.mean < NORMAL_DEG), "{judged:?}");
}

#[test]
fn normals_between_corners() {
    // packed normals are off by 0.0037 degrees
    keeps_the_promise(&shapes::ball(), 0.01);
}

/// The near plane passes through the middle, the far one behind it: the inside and its end are visible.
#[test]
fn a_mesh_that_the_near_and_the_far_plane_cut() {
    let model = shapes::whole_mesh("torus", shapes::torus_mesh(24));
    let (tracer, mut renderer) = (Tracer::new(&model), watched(&model));
    for camera in [perspective(&model, SIZE), orthographic(&model, SIZE)] {
        let middle = camera.eye.distance(camera.target);
        let camera = Camera { depth_range: (middle, middle + 2.5), ..camera };
        is_right(&tracer, &mut renderer, &camera, NORMAL_DEG);
    }
    assert_silent(renderer);
}

/// Features of 1e-3 at 1e6, by the vertices and by the instance: the model itself rounds them by 1e-7.
#[test]
fn a_small_mesh_a_million_away() {
    let torus = shapes::torus_mesh(24);
    let half = DVec3::splat(5e5);
    let far = torus.positions().iter().map(|p| *p * 1e-3 + half).collect();
    let mut model = shapes::whole_mesh("far", Mesh::new(1, far, torus.triangles().to_vec(), vec![]).unwrap());
    model.instances[0].transform = DAffine3::from_translation(half);
    let (tracer, mut renderer) = (Tracer::new(&model), watched(&model));
    is_right(&tracer, &mut renderer, &perspective(&model, SIZE), 0.01);
    assert_silent(renderer);
}
