//! The judge on regular surface: a tenth of a pixel of depth and a hundredth of a degree, and no verdict where a face
//! ends beside the pixel. The picture is the true one, changed on purpose.

use crate::shapes::borders;
use crate::support::perspective;
use glam::{DQuat, Vec3};

use selvedge_check::{EXACT_DEPTH_PX, EXACT_NORMAL_DEG, Exactness, JudgeOptions, Tracer, judge};

const SIZE: (u32, u32) = (160, 120);

#[test]
fn what_is_not_exact_is_told_where_the_surface_is_regular() {
    let model = borders::drum(1.5, 4.0);
    let (tracer, camera) = (Tracer::new(&model), perspective(&model, SIZE));
    let truth = tracer.picture(&camera, &|_| {});
    let exact =
        |picture: &selvedge_check::Picture| judge(&tracer, &camera, &picture.images(), &JudgeOptions::default()).exact;
    let before = exact(&truth);
    assert_eq!(before.beyond, 0);
    assert!(before.depth_px.count > 1000 && before.depth_px.worst < 1e-4, "{before:?}");

    // the flat end: surrounded by itself, and at its border
    let w = SIZE.0 as usize;
    let beside = |i: usize, face: u32| [i - 1, i + 1, i - w, i + w].iter().all(|&k| truth.face[k] == face);
    let of_end = |i: &usize| truth.face[*i] == 2;
    let within = (3 * w..truth.face.len() - 3 * w)
        .filter(of_end)
        .find(|&i| (i - 2..=i + 2).all(|k| truth.face[k] == 2 && beside(k, 2)))
        .expect("the end is in view");
    let border = (w..truth.face.len() - w).filter(of_end).find(|&i| truth.face[i - 1] == 0).expect("its border, too");
    let pixel = |i: usize| truth.depth[i] * 2.0 * (17.5f32).to_radians().tan() / SIZE.1 as f32;
    let deeper = |i: usize, px: f64| {
        let mut picture = truth.clone();
        picture.depth[i] += pixel(i) * px as f32;
        exact(&picture)
    };
    let turned = |i: usize, degrees: f64| {
        let mut picture = truth.clone();
        let normal = Vec3::from(picture.normal[i]).as_dvec3();
        let turn = DQuat::from_axis_angle(normal.any_orthonormal_vector(), degrees.to_radians());
        picture.normal[i] = (turn * normal).as_vec3().to_array();
        exact(&picture)
    };
    let counts = |e: Exactness| (e.depth_px.count - before.depth_px.count, e.beyond, e.irregular - before.irregular);
    assert_eq!(counts(deeper(within, 0.9 * EXACT_DEPTH_PX)), (0, 0, 0));
    assert_eq!(counts(turned(within, 0.9 * EXACT_NORMAL_DEG)), (0, 0, 0));
    let (depth, normal) = (deeper(within, 1.5 * EXACT_DEPTH_PX), turned(within, 1.5 * EXACT_NORMAL_DEG));
    assert_eq!((counts(depth), counts(normal)), ((0, 1, 0), (0, 1, 0)));
    assert!((depth.depth_px.worst / EXACT_DEPTH_PX - 1.5).abs() < 1e-3, "{depth:?}");
    assert!((normal.normal_deg.worst / EXACT_NORMAL_DEG - 1.5).abs() < 1e-2, "{normal:?}");
    // beside another face there is no verdict
    let end = deeper(border, 1.5 * EXACT_DEPTH_PX);
    assert_eq!((end.depth_px.count + 1, end.beyond), (before.depth_px.count, 0));
    assert_eq!(end.irregular, before.irregular + 1);
}
