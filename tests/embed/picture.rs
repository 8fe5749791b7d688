//! The renderer's picture in the host's: what it hides, what hides it, and what it leaves unchanged.

use crate::host::Host;
use crate::shapes;
use crate::targets::{DEPTH_FORMAT, Targets};
use ash::vk;
use glam::{DVec2, DVec3};
use selvedge::gpu::HostDevice;
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{FrameSettings, Samples, SceneSettings, Smooth};
use selvedge::renderer::{FrameInput, Renderer, TargetFormats, Targets as Into};

pub const SIZE: (u32, u32) = (120, 90);
const HOST_BLUE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];
const BLUE: [u8; 4] = [0, 0, 255, 255];
/// Depth of the host's middle box, through the sphere.
const WALL: f64 = 9.0;

/// The renderer on the host's device; the model is uploaded.
pub fn renderer(host: &Host, model: &Model, colour: vk::Format) -> Renderer {
    renderer_on(host.lend(), model, colour)
}

/// The same on the device of a host that lives longer than the renderer.
pub fn renderer_on(lent: HostDevice, model: &Model, colour: vk::Format) -> Renderer {
    let formats = TargetFormats { depth: Some(DEPTH_FORMAT), ..TargetFormats::new(colour) };
    // SAFETY: the host's device meets the requirements and outlives the renderer.
    let mut renderer = unsafe { Renderer::new(lent, formats, crate::host::SLOTS) }.unwrap();
    renderer.upload(model).unwrap();
    renderer
}

/// A camera 10 away from the sphere.
pub fn camera() -> Camera {
    Camera {
        eye: DVec3::new(0.0, -10.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 0.8 },
        depth_range: (1.0, 20.0),
        size: SIZE,
    }
}

fn parallel() -> Camera {
    Camera { projection: Projection::Orthographic { height: 7.0 }, ..camera() }
}

/// As `TargetFormats::depth` says.
fn reversed(camera: &Camera, z: f64) -> f64 {
    let (near, far) = camera.depth_range;
    let perspective = matches!(camera.projection, Projection::Perspective { .. });
    (far - z) / (far - near) * if perspective { near / z } else { 1.0 }
}

/// Depth of the sphere's front along the ray through a point of the picture.
fn front(camera: &Camera, pixel: DVec2) -> Option<f64> {
    let (eye, ray) = camera.ray(pixel);
    let half = eye.dot(ray);
    let squared = half * half - eye.length_squared() + shapes::SPHERE_RADIUS * shapes::SPHERE_RADIUS;
    (squared >= 0.0).then(|| (-half - squared.sqrt()) * ray.y + eye.y + 10.0)
}

/// The host's picture with the sphere in it; the host's overlay on top.
pub fn draw(host: &Host, renderer: &mut Renderer, targets: &Targets, camera: &Camera, background: Option<[f32; 4]>) {
    let cmd = host.begin(0);
    let third = SIZE.0 / 3;
    let wall = reversed(camera, WALL) as f32;
    targets.draw(host, cmd, HOST_BLUE, &[(third, third, wall), (2 * third, third, 1.0)]);
    targets.hand_over(host, cmd);
    let settings = FrameSettings { background, ..FrameSettings::default() };
    let into = Into { depth: Some(&targets.depth), ..Into::new(&targets.colour) };
    // SAFETY: recording; the slot's frame was waited for.
    unsafe { renderer.record(cmd, &FrameInput { camera, settings, slot: 0, targets: into }) }.unwrap();
    targets.overlay(host, cmd, 8, [1.0, 0.0, 0.0, 1.0]);
    targets.read_back(host, cmd);
    host.submit(0);
    host.wait(0);
    assert!(renderer.report(0).unwrap().unwrap().complete);
}

#[test]
fn it_stands_among_what_the_host_drew() {
    let host = Host::new();
    let mut renderer = renderer(&host, &shapes::sphere(), vk::Format::R8G8B8A8_UNORM);
    let targets = Targets::new(&host, SIZE, vk::Format::R8G8B8A8_UNORM);
    for (samples, camera) in [
        (Samples::One, camera()),
        (Samples::One, parallel()),
        (Samples::Four, camera()),
        (Samples::Eight, parallel()),
        (Samples::One, camera()),
    ] {
        renderer.upload_with(&shapes::sphere(), SceneSettings { samples, ..Default::default() }).unwrap();
        draw(&host, &mut renderer, &targets, &camera, None);
        let (colour, depth) = targets.values();
        let (mut seen, mut hidden) = (0, 0);
        for (i, (x, y)) in (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y))).enumerate() {
            if x < 8 && y < 8 {
                assert_eq!(colour[i], [255, 0, 0, 255], "the overlay at {x}, {y}");
                continue;
            }
            let host_depth = [0.0, reversed(&camera, WALL), 1.0][(3 * x / SIZE.0) as usize];
            let wins = |dx: f64, dy: f64| {
                let z = front(&camera, DVec2::new(f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy));
                z.map(|z| reversed(&camera, z)).filter(|d| *d >= host_depth)
            };
            let centre = wins(0.0, 0.0);
            // borders may be half a pixel off
            let around = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(dx, dy)| wins(dx, dy));
            if around.iter().any(|a| a.is_some() != centre.is_some()) {
                continue;
            }
            if let Some(d) = centre {
                assert_ne!(colour[i], BLUE, "the sphere at {x}, {y}");
                // at a pixel from the outline, a hundredth of a pixel changes the depth by less than this
                assert!((f64::from(depth[i]) - d).abs() < 1e-4, "depth {} at {x}, {y}, not {d}", depth[i]);
                seen += 1;
            } else {
                assert_eq!(colour[i], BLUE, "the host's picture at {x}, {y}");
                assert_eq!(depth[i], host_depth as f32, "the host's depth at {x}, {y}");
                hidden += 1;
            }
        }
        assert!(seen > 1500 && hidden > 4000, "{seen} pixels of the sphere, {hidden} of the host");
    }
    // the renderer first, then the images it drew into: neither owns the other
    drop(renderer);
    targets.destroy(&host);
    assert_eq!(host.shutdown(), [""; 0]);
}

/// A background covers the host's picture and depth, and is encoded once: by the format or by the renderer. Linear 0.5,
/// 0.25 and 0.125 are 187.5, 136.9 and 99.2 in sRGB (IEC 61966-2-1); a device may round the encoding by 0.6 (Vulkan,
/// section on fixed-point conversion).
#[test]
fn a_background_is_encoded_once() {
    for format in [vk::Format::R8G8B8A8_UNORM, vk::Format::R8G8B8A8_SRGB] {
        let host = Host::new();
        let mut renderer = renderer(&host, &shapes::sphere(), format);
        let targets = Targets::new(&host, SIZE, format);
        for samples in [Samples::One, Samples::Eight] {
            renderer.upload_with(&shapes::sphere(), SceneSettings { samples, ..Default::default() }).unwrap();
            draw(&host, &mut renderer, &targets, &camera(), Some([0.5, 0.25, 0.125, 1.0]));
            let (colour, depth) = targets.values();
            let corner = (SIZE.0 * SIZE.1 - 1) as usize;
            let [r, g, b, a] = colour[corner];
            assert!(r.abs_diff(188) <= 1 && g.abs_diff(137) <= 1 && b.abs_diff(99) <= 1, "{format:?}: {r}, {g}, {b}");
            assert_eq!((a, depth[corner]), (255, 0.0), "{format:?}");
        }
        targets.destroy(&host);
        drop(renderer);
        assert_eq!(host.shutdown(), [""; 0]);
    }
}

/// Smooth borders let the host's picture through. If that has one colour, and the target's format blends in linear
/// light, the result equals the picture with this colour as background, up to two roundings to eight bits.
#[test]
fn smooth_trims_blend_with_what_the_host_drew() {
    let host = Host::new();
    let format = vk::Format::R8G8B8A8_SRGB;
    let mut renderer = renderer(&host, &shapes::plate(), format);
    let smooth = SceneSettings { smooth: Smooth::Trims, ..Default::default() };
    renderer.upload_with(&shapes::plate(), smooth).unwrap();
    let targets = Targets::new(&host, SIZE, format);
    let camera = Camera { eye: DVec3::new(1.0, -2.0, 10.0), up: DVec3::Y, ..camera() };
    let [kept, before_blue] = [None, Some(HOST_BLUE)].map(|background| {
        draw(&host, &mut renderer, &targets, &camera, background);
        targets.values().0
    });
    let mut mixed = 0;
    // the host's boxes begin at a third of the width
    for i in (0..kept.len()).filter(|i| (*i as u32 % SIZE.0) < SIZE.0 / 3) {
        let (a, b) = (kept[i], before_blue[i]);
        assert!((0..4).all(|k| a[k].abs_diff(b[k]) <= 2), "pixel {i}: {a:?}, not {b:?}");
        mixed += usize::from(a != BLUE && a[2] > a[0].saturating_add(20));
    }
    assert!(mixed > 10, "{mixed} pixels are mixed");
    targets.destroy(&host);
    drop(renderer);
    assert_eq!(host.shutdown(), [""; 0]);
}

/// A picture in a rectangle of larger targets equals the picture in whole targets, bit for bit: with a background, and
/// over the host's picture. Outside the rectangle the host's colour and depth stay.
#[test]
fn a_rectangle_of_a_larger_target_holds_the_same_picture() {
    let host = Host::new();
    let format = vk::Format::R8G8B8A8_UNORM;
    let mut renderer = renderer(&host, &shapes::plate(), format);
    let camera = Camera { eye: DVec3::new(1.0, -2.0, 10.0), up: DVec3::Y, ..camera() };
    let (x, y) = (37, 11);
    let large = (SIZE.0 + 60, SIZE.1 + 20);
    let wall = reversed(&camera, WALL) as f32;
    let draw = |renderer: &mut Renderer, targets: &Targets, left: u32, corner, background| {
        let cmd = host.begin(0);
        targets.draw(&host, cmd, HOST_BLUE, &[(left + SIZE.0 / 3, SIZE.0 / 3, wall)]);
        targets.hand_over(&host, cmd);
        let settings = FrameSettings { background, ..FrameSettings::default() };
        let into = Into { depth: Some(&targets.depth), corner, ..Into::new(&targets.colour) };
        // SAFETY: recording; the slot's frame was waited for.
        unsafe { renderer.record(cmd, &FrameInput { camera: &camera, settings, slot: 0, targets: into }) }.unwrap();
        targets.hand_over(&host, cmd);
        targets.read_back(&host, cmd);
        host.submit(0);
        host.wait(0);
        targets.values()
    };
    let (whole, part) = (Targets::new(&host, SIZE, format), Targets::new(&host, large, format));
    let made = |renderer: &Renderer| renderer.objects().iter().filter(|name| name.starts_with("viewport")).count();
    for samples in [Samples::One, Samples::Four] {
        renderer.upload_with(&shapes::plate(), SceneSettings { samples, ..Default::default() }).unwrap();
        for background in [None, Some([0.5, 0.25, 0.125, 1.0])] {
            let expected = draw(&mut renderer, &whole, 0, None, background);
            assert_eq!(made(&renderer), 0, "a whole target wants no images");
            let (colour, depth) = draw(&mut renderer, &part, x, Some((x, y)), background);
            assert_eq!(made(&renderer), 2);
            let (mut inside, mut plate) = (0, 0);
            for (i, (column, row)) in (0..large.1).flat_map(|row| (0..large.0).map(move |c| (c, row))).enumerate() {
                let within = (x..x + SIZE.0).contains(&column) && (y..y + SIZE.1).contains(&row);
                if within {
                    let k = ((row - y) * SIZE.0 + column - x) as usize;
                    assert_eq!((colour[i], depth[i].to_bits()), (expected.0[k], expected.1[k].to_bits()), "pixel {k}");
                    inside += 1;
                    plate += usize::from(colour[i] != BLUE && depth[i] > 0.0);
                } else {
                    let third = (x + SIZE.0 / 3..x + 2 * (SIZE.0 / 3)).contains(&column);
                    assert_eq!((colour[i], depth[i]), (BLUE, if third { wall } else { 0.0 }), "{column}, {row}");
                }
            }
            assert!(inside == SIZE.0 * SIZE.1 && plate > 1000, "{plate} pixels of the plate");
        }
    }
    for corner in [(61, 0), (0, 21), (u32::MAX, 0)] {
        let cmd = host.begin(0);
        let into = Into { depth: Some(&part.depth), corner: Some(corner), ..Into::new(&part.colour) };
        let input = FrameInput { camera: &camera, settings: FrameSettings::default(), slot: 0, targets: into };
        // SAFETY: recording; nothing is in flight.
        let refused = unsafe { renderer.record(cmd, &input) }.expect_err("beside the target").to_string();
        assert!(refused.contains("is not within it"), "{refused}");
        host.submit(0);
        host.wait(0);
    }
    drop(renderer);
    [whole, part].into_iter().for_each(|targets| targets.destroy(&host));
    assert_eq!(host.shutdown(), [""; 0]);
}
