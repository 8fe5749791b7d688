//! A host's images, each by itself; and what crosses threads.

use super::{HeadlessDevice, HeadlessError, HeadlessOptions, HeadlessRenderer};
use crate::gpu::{Access, Device, Image, ImageInfo, LowerLimits, Pool, ReadBack, barrier};
use crate::model::{Camera, Model, Projection};
use crate::parity::{placed, untrimmed};
use crate::picture::{EdgeSettings, FrameSettings, Outputs, Picture, SceneSettings};
use crate::renderer::{Aovs, FrameInput, RenderError, Renderer, TargetFormats, Targets};
use crate::spline::Surface;
use ash::vk;
use glam::{DAffine3, DVec3, DVec4};

const SIZE: (u32, u32) = (64, 48);
const ALL: Outputs = Outputs { edge: true, part: true, instance: true, ..Outputs::ALL };

fn image(device: &Device, name: &str, format: vk::Format, texel: u64) -> (Image, ReadBack, u64) {
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let image = Image::new(device, &ImageInfo { name, size: SIZE, format, usage, pool: Pool::Transient }).unwrap();
    let bytes = u64::from(SIZE.0 * SIZE.1) * texel;
    (image, ReadBack::new(device, name, bytes).unwrap(), bytes)
}

/// The images of one frame of these outputs, in the order of their fields behind the colour; empty where there is none.
fn drawn(device: &HeadlessDevice, model: &Model, settings: SceneSettings, outputs: Outputs) -> Vec<Vec<u8>> {
    let gpu = device.device();
    let formats = TargetFormats { outputs, ..TargetFormats::new(vk::Format::R8G8B8A8_SRGB) };
    let mut renderer = Renderer::on(gpu, formats, 1).unwrap();
    renderer.upload_with(model, settings).unwrap();
    let Outputs { depth, face, uv, normal, edge, part, instance, .. } = outputs;
    let [of_depth, of_face, of_uv, of_normal] = Renderer::AOV_FORMATS;
    let number = Renderer::NUMBER_FORMAT;
    let named = [
        ("colour", true, formats.colour, 4),
        ("depth", depth, of_depth, 4),
        ("face", face, of_face, 4),
        ("uv", uv, of_uv, 8),
        ("normal", normal, of_normal, 16),
        ("edge", edge, number, 4),
        ("part", part, number, 4),
        ("instance", instance, number, 4),
    ];
    let made = named.map(|(name, wanted, format, texel)| wanted.then(|| image(gpu, name, format, texel)));
    let of = |k: usize| made[k].as_ref().map(|(image, ..)| image);
    let [depth, face, uv, normal] = [1, 2, 3, 4].map(of);
    let [edge, part, instance] = [5, 6, 7].map(of);
    let aovs = Aovs { depth, face, uv, normal, edge, part, instance };
    let targets = Targets { aovs, ..Targets::new(of(0).unwrap()) };
    let bounds = model.control_bounds();
    let camera = Camera::around(bounds, DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 0.6, SIZE);
    let input = FrameInput { camera: &camera, settings: FrameSettings::default(), slot: 0, targets };
    let there = || made.iter().flatten();
    while !renderer.report(0).unwrap().is_some_and(|report| report.complete) {
        let recorded = device.try_submit(|cmd| {
            let new = there().map(|(i, ..)| (i, Access::TRANSFER_READ.discarded(), Access::COLOUR_WRITE));
            barrier::images(cmd, &new.collect::<Vec<_>>());
            // SAFETY: recording; the submission is waited for.
            unsafe { renderer.record(cmd.raw(), &input) }?;
            let end = there().map(|(i, ..)| (i, Access::COLOUR_WRITE, Access::TRANSFER_READ));
            barrier::images(cmd, &end.collect::<Vec<_>>());
            there().for_each(|(i, read, _)| read.record_image(cmd, i, vk::ImageAspectFlags::COLOR));
            Ok::<_, RenderError>(())
        });
        recorded.unwrap().unwrap();
    }
    made.iter()
        .map(|made| made.as_ref().map_or_else(Vec::new, |(_, read, bytes)| read.values(*bytes as usize)))
        .collect()
}

/// Any choice of images: each is the same as among all of them.
#[test]
fn each_image_stands_by_itself() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/bracket.step");
    let mut model = selvedge_io::import::open(&path).unwrap().model;
    let device = HeadlessDevice::new(&HeadlessOptions { validation: true, ..Default::default() }).unwrap();
    let one = |k: usize| Outputs {
        depth: k == 0,
        face: k == 1,
        uv: k == 2,
        normal: k == 3,
        edge: k == 4,
        part: k == 5,
        instance: k == 6,
        thickness: false,
    };
    let settings = SceneSettings { edges: Some(EdgeSettings::default()), ..SceneSettings::default() };
    for is_clear in [false, true] {
        if is_clear {
            model.instances[0].colour = Some([0.1, 0.2, 0.9, 0.5]);
        }
        // a scene whose pipelines the others share while it lives
        let formats = TargetFormats { outputs: ALL, ..TargetFormats::new(vk::Format::R8G8B8A8_SRGB) };
        let mut shared = Renderer::on(device.device(), formats, 1).unwrap();
        shared.upload_with(&model, settings).unwrap();
        let all = drawn(&device, &model, settings, ALL);
        let some = Outputs { face: true, normal: true, instance: true, ..Outputs::default() };
        let singles = if is_clear { 1..2 } else { 0..7 };
        for outputs in singles.map(one).chain([some]) {
            let own = drawn(&device, &model, settings, outputs);
            for (k, (own, all)) in own.iter().zip(&all).enumerate() {
                assert!(own.is_empty() || own == all, "image {k} of {outputs:?}, seen through: {is_clear}");
            }
            let wanted = outputs.has_points() || outputs.has_numbers();
            assert_eq!(own[1..].iter().any(|image| !image.is_empty()), wanted);
        }
    }
    let messages = device.shutdown();
    assert!(messages.is_empty(), "{messages:?}");
}

/// 128 bicubic patches that are many pixels tall. Each has several sub-patches; a first frame has room for one each,
/// and 256 more.
fn tall() -> Model {
    let height = [[0.0, 1.0, -1.0, 0.0], [1.0, 3.0, 0.0, -1.0], [-1.0, 0.0, -3.0, 1.0], [0.5, -1.0, 1.0, 0.0]];
    let at = |i: usize, j: usize| DVec4::new(i as f64, j as f64, 20.0 * height[j][i], 1.0);
    let points = (0..4).flat_map(|j| (0..4).map(move |i| at(i, j))).collect();
    let knots = || [vec![0.0; 4], vec![1.0; 4]].concat();
    let surface = Surface::new((3, 3), knots(), knots(), points).unwrap();
    let mut model = placed(vec![untrimmed(surface)], DAffine3::IDENTITY);
    let one = model.instances[0].clone();
    let beside = |k: u32| DAffine3::from_translation(DVec3::new(0.01 * f64::from(k), 0.0, 0.0));
    model.instances.extend((1..128).map(|k| crate::model::Instance { transform: beside(k), ..one.clone() }));
    model
}

/// A frame without room counts its lists and draws no patch. The frame that has room draws the picture.
#[test]
fn no_picture_is_drawn_twice() {
    let (model, device) =
        (tall(), HeadlessDevice::new(&HeadlessOptions { validation: true, ..Default::default() }).unwrap());
    let format = vk::Format::R8G8B8A8_SRGB;
    let mut renderer = Renderer::on(device.device(), TargetFormats::new(format), 1).unwrap();
    renderer.upload(&model).unwrap();
    let target = image(device.device(), "colour", format, 4).0;
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, SIZE);
    let camera = Camera { projection: Projection::Orthographic { height: 3.2 }, ..above };
    // so coarse that each patch is just divided: finer ones have more triangles, and the same lack of room
    let settings = FrameSettings { tolerance_px: 0.4, ..FrameSettings::default() };
    let input = FrameInput { camera: &camera, settings, slot: 0, targets: Targets::new(&target) };
    let mut frame = || {
        let recorded = device.try_submit(|cmd| {
            let new = (&target, Access::COLOUR_WRITE.discarded(), Access::COLOUR_WRITE);
            barrier::images(cmd, &[new]);
            // SAFETY: recording; the submission is waited for.
            unsafe { renderer.record(cmd.raw(), &input) }
        });
        recorded.unwrap().unwrap();
        let report = renderer.report(0).unwrap().unwrap();
        (report.complete, report.stats.triangles > 0, report.stats.sub_patches > 384)
    };
    let mut frames = vec![frame()];
    while frames.len() < 4 && !frames[frames.len() - 1].0 {
        frames.push(frame());
    }
    let last = frames.pop().unwrap();
    assert!(last == (true, true, true) && !frames.is_empty(), "{frames:?}, {last:?}");
    assert!(frames.iter().all(|frame| *frame == (false, false, true)), "{frames:?}");
    drop((renderer, target));
    let messages = device.shutdown();
    assert!(messages.is_empty(), "{messages:?}");
}

/// A scene of more bytes than staging memory holds is copied by several frames, with one frame in flight or two. They
/// draw the background, and all of them together hold no more staging memory than there may be.
#[test]
fn a_large_scene_is_copied_in_pieces() {
    const MOST: u64 = 2048;
    // a driver pads a buffer by no more
    const PADDING: u64 = 256;
    let (model, format) = (tall(), vk::Format::R8G8B8A8_SRGB);
    let camera = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, SIZE);
    let few = LowerLimits { staging: Some(MOST), ..LowerLimits::NONE };
    let mut pictures = Vec::new();
    for (lower, slots) in [(LowerLimits::NONE, 1), (few, 1), (few, 2)] {
        let options = HeadlessOptions { validation: true, ..Default::default() };
        let device = HeadlessDevice::limited(&options, lower).unwrap();
        let mut renderer = Renderer::on(device.device(), TargetFormats::new(format), slots).unwrap();
        renderer.upload(&model).unwrap();
        let (target, read, bytes) = image(device.device(), "colour", format, 4);
        let mut waited = Vec::new();
        for frame in 0.. {
            let (slot, targets) = (frame % slots, Targets::new(&target));
            let input = FrameInput { camera: &camera, settings: FrameSettings::default(), slot, targets };
            let recorded = device.try_submit(|cmd| {
                barrier::images(cmd, &[(&target, Access::TRANSFER_READ.discarded(), Access::COLOUR_WRITE)]);
                // SAFETY: recording; the submission is waited for.
                unsafe { renderer.record(cmd.raw(), &input) }?;
                barrier::images(cmd, &[(&target, Access::COLOUR_WRITE, Access::TRANSFER_READ)]);
                read.record_image(cmd, &target, vk::ImageAspectFlags::COLOR);
                Ok::<_, RenderError>(())
            });
            recorded.unwrap().unwrap();
            let held: u64 = device.device().pool_bytes().iter().filter(|(p, _)| *p == Pool::Staging).map(|p| p.1).sum();
            assert!(
                lower == LowerLimits::NONE || held <= MOST + PADDING * slots as u64,
                "{held} bytes in {slots} slots"
            );
            let report = renderer.report(slot).unwrap().unwrap();
            let seen: Vec<u8> = read.values(bytes as usize);
            match report.waiting {
                Some(left) => {
                    waited.push(left);
                    assert!(!report.complete && seen.iter().all(|byte| *byte == 255), "frame {frame}: no background");
                }
                None if report.complete => {
                    assert!(seen.iter().any(|byte| *byte != 255), "nothing is seen");
                    pictures.push(seen);
                    break;
                }
                None => {}
            }
            assert!(frame < 100, "{waited:?} bytes waited");
        }
        let frames = if lower == LowerLimits::NONE { 0..=0 } else { 3..=50 };
        assert!(frames.contains(&waited.len()), "{waited:?} bytes waited");
        assert!(waited.windows(2).all(|two| two[0] - two[1] == MOST / slots as u64), "{waited:?}");
        drop((renderer, target, read));
        let messages = device.shutdown();
        assert!(messages.is_empty(), "{messages:?}");
    }
    assert!(pictures[1] == pictures[0] && pictures[2] == pictures[0], "another picture in pieces");
}

#[test]
fn what_hosts_hold_crosses_threads() {
    fn crosses<T: Send + Sync>() {}
    crosses::<Renderer>();
    crosses::<Image>();
    crosses::<Model>();
    crosses::<Camera>();
    crosses::<RenderError>();
    crosses::<HeadlessRenderer>();
    crosses::<HeadlessError>();
    crosses::<Picture>();
}
