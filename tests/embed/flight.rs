//! Two frames in flight while the host changes sizes, models and views.

use crate::host::{Host, SLOTS};
use crate::picture::renderer;
use crate::shapes;
use crate::targets::Targets;
use ash::vk;
use glam::{DAffine3, DVec2, DVec3};
use selvedge::model::{Camera, Colour, FaceError, LoopAt, Model, Projection};
use selvedge::picture::{FrameSettings, SceneSettings};
use selvedge::renderer::{EditError, FrameInput, RenderError, Renderer, Targets as Into};

const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;

/// Colours by which a pixel's model is recognised.
const RED: Colour = [0.8, 0.05, 0.05, 1.0];
const GREEN: Colour = [0.05, 0.8, 0.05, 1.0];
const BLUE: Colour = [0.05, 0.05, 0.8, 1.0];

fn painted(mut model: Model, colour: Colour) -> Model {
    model.instances[0].colour = Some(colour);
    model
}

fn record(host: &Host, renderer: &mut Renderer, slot: usize, targets: &Targets, camera: &Camera, tolerance_px: f64) {
    let cmd = host.begin(slot);
    targets.draw(host, cmd, [0.0, 0.0, 0.0, 1.0], &[]);
    targets.hand_over(host, cmd);
    let settings = FrameSettings { tolerance_px, background: None, ..FrameSettings::default() };
    let into = Into { depth: Some(&targets.depth), ..Into::new(&targets.colour) };
    // SAFETY: recording; `begin` waited for the slot's frame before.
    unsafe { renderer.record(cmd, &FrameInput { camera, settings, slot, targets: into }) }.unwrap();
    targets.read_back(host, cmd);
    host.submit(slot);
}

fn from_the_front(size: (u32, u32)) -> Camera {
    let projection = Projection::Perspective { fov_y: 0.4 };
    let (eye, target, up) = (DVec3::new(0.0, -40.0, 0.0), DVec3::ZERO, DVec3::Z);
    Camera { eye, target, up, projection, depth_range: (1.0, 100.0), size }
}

/// Asserts that each frame shows its model as an upload of that model does.
fn assert_uploaded(
    host: &Host,
    targets: &Targets,
    camera: &Camera,
    seen: &[(Vec<[u8; 4]>, Vec<f32>)],
    models: impl IntoIterator<Item = Model>,
) {
    let mut models = models.into_iter();
    let mut fresh: Option<Renderer> = None;
    for (frame, seen) in seen.iter().enumerate() {
        let model = models.next().expect("a model for each frame");
        let fresh = fresh.get_or_insert_with(|| renderer(host, &model, FORMAT));
        fresh.upload(&model).unwrap();
        record(host, fresh, 0, targets, camera, 0.5);
        host.wait(0);
        assert!(*seen == targets.values(), "frame {frame}");
    }
}

/// Asserts that `channel` is the strongest at the centre of a frame's picture.
fn assert_centre(frame: usize, targets: &Targets, channel: usize) {
    let (colour, _) = targets.values();
    let (width, height) = targets.size;
    let c = colour[(height / 2 * width + width / 2) as usize];
    let strongest = (0..3).max_by_key(|i| c[*i]).unwrap();
    assert_eq!(strongest, channel, "frame {frame} has {c:?} in its middle");
}

/// Twelve frames, alternating between the slots; only the next use of a slot waits.
#[test]
fn sizes_and_models_change_in_flight() {
    let host = Host::new();
    let models = [
        painted(shapes::sphere(), RED),
        // trimmed, with more buffers
        painted(shapes::cube(), GREEN),
        painted(shapes::sphere(), BLUE),
    ];
    // an odd and an even number of frames between the changes: either slot may be the last recorded
    let model_at = |frame: usize| [0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 2][frame];
    let size_at = |frame: usize| if (2..6).contains(&frame) { (96, 64) } else { (160, 120) };
    let mut renderer = renderer(&host, &models[0], FORMAT);
    let mut slots: [Option<(usize, Targets)>; SLOTS] = [None, None];
    let seen = |slot: &Option<(usize, Targets)>| {
        if let Some((frame, targets)) = slot {
            assert_centre(*frame, targets, model_at(*frame));
        }
    };
    for frame in 0..12 {
        if frame > 0 && model_at(frame) != model_at(frame - 1) {
            renderer.upload(&models[model_at(frame)]).unwrap();
        }
        let slot = frame % SLOTS;
        host.wait(slot);
        seen(&slots[slot]);
        let size = size_at(frame);
        let targets = match slots[slot].take() {
            Some((_, targets)) if targets.size == size => targets,
            old => {
                if let Some((_, targets)) = old {
                    targets.destroy(&host);
                }
                Targets::new(&host, size, FORMAT)
            }
        };
        let model = &models[model_at(frame)];
        let from = DVec3::new((frame as f64).cos(), (frame as f64).sin(), 0.5);
        let camera = Camera::around(model.control_bounds(), from, DVec3::Z, 0.6, size);
        record(&host, &mut renderer, slot, &targets, &camera, 0.5);
        slots[slot] = Some((frame, targets));
    }
    // a model that no frame will draw
    renderer.upload(&models[0]).unwrap();
    for (slot, last) in slots.iter().enumerate() {
        host.wait(slot);
        seen(last);
    }
    drop(renderer);
    slots.into_iter().flatten().for_each(|(_, targets)| targets.destroy(&host));
    assert_eq!(host.shutdown(), [""; 0]);
}

/// Two views of one upload in one command buffer, each with a slot, a camera and settings of its own: each shows what
/// it shows alone. With equal sizes the second uses the buffers of the first.
#[test]
fn two_views_in_one_command_buffer() {
    let host = Host::new();
    let model = painted(shapes::cube(), GREEN);
    for sizes in [[(160, 120), (160, 120)], [(160, 120), (96, 64)]] {
        let mut renderer = renderer(&host, &model, FORMAT);
        let from = [DVec3::new(1.0, -2.0, 0.7), DVec3::new(-1.0, 0.3, 0.4)];
        let view = |nth: usize| Camera::around(model.control_bounds(), from[nth], DVec3::Z, 0.6, sizes[nth]);
        let (cameras, tolerances) = ([view(0), view(1)], [0.5, 0.25]);
        let targets = sizes.map(|size| Targets::new(&host, size, FORMAT));
        // the first rounds may lack room
        for _ in 0..4 {
            let cmd = host.begin(0);
            for slot in [0, 1] {
                let targets = &targets[slot];
                targets.draw(&host, cmd, [0.0, 0.0, 0.0, 1.0], &[]);
                targets.hand_over(&host, cmd);
                let tolerance_px = tolerances[slot];
                let settings = FrameSettings { tolerance_px, background: None, ..FrameSettings::default() };
                let into = Into { depth: Some(&targets.depth), ..Into::new(&targets.colour) };
                let input = FrameInput { camera: &cameras[slot], settings, slot, targets: into };
                // SAFETY: recording; the fence of slot 0 is that of both frames.
                unsafe { renderer.record(cmd, &input) }.unwrap();
                targets.read_back(&host, cmd);
            }
            host.submit(0);
            host.wait(0);
        }
        for slot in [0, 1] {
            assert!(renderer.report(slot).unwrap().unwrap().complete, "view {slot} of {sizes:?}");
            let together = targets[slot].values();
            assert_centre(slot, &targets[slot], 1);
            let mut alone = crate::picture::renderer(&host, &model, FORMAT);
            for _ in 0..2 {
                record(&host, &mut alone, 0, &targets[slot], &cameras[slot], tolerances[slot]);
                host.wait(0);
            }
            assert!(together == targets[slot].values(), "view {slot} of {sizes:?}");
        }
        drop(renderer);
        targets.into_iter().for_each(|targets| targets.destroy(&host));
    }
    assert_eq!(host.shutdown(), [""; 0]);
}

/// A sphere moves from left to right, one place a frame, while the other slot's frame is in flight. Each frame shows it
/// at its place when that frame was recorded, and an upload shows it at its place then.
#[test]
fn a_part_moves_while_frames_are_in_flight() {
    let host = Host::new();
    let mut model = painted(shapes::sphere(), RED);
    model.parts.extend(painted(shapes::cube(), GREEN).parts);
    model.instances.push(shapes::placed(DAffine3::from_translation(DVec3::new(0.0, 9.0, 0.0)), Some(GREEN)));
    model.instances[1].part = 1;
    let size = (120, 60);
    let camera = from_the_front(size);
    let place = |frame: usize| DAffine3::from_translation(DVec3::X * (2.5 * frame as f64 - 10.0));
    let targets = [(); SLOTS].map(|()| Targets::new(&host, size, FORMAT));
    let mut seen = Vec::new();
    let mut live = renderer(&host, &model, FORMAT);
    for frame in 0..9 {
        let slot = frame % SLOTS;
        host.wait(slot);
        if frame >= SLOTS {
            seen.push(targets[slot].values());
        }
        live.set_transform(0, place(frame)).unwrap();
        live.set_visible(1, frame % 3 != 1).unwrap();
        record(&host, &mut live, slot, &targets[slot], &camera, 0.5);
    }
    (9 - SLOTS..9).for_each(|frame| {
        host.wait(frame % SLOTS);
        seen.push(targets[frame % SLOTS].values());
    });
    drop(live);
    let models = (0..seen.len()).map(|frame| {
        let mut model = model.clone();
        model.instances[0].transform = place(frame);
        if frame % 3 == 1 {
            model.instances.pop();
        }
        model
    });
    assert_uploaded(&host, &targets[0], &camera, &seen, models);
    targets.into_iter().for_each(|targets| targets.destroy(&host));
    assert_eq!(host.shutdown(), [""; 0]);
}

/// A point of a plate's hole moves, one place a frame, while the other slot's frame is in flight: each frame has the
/// loop as it was when that frame was recorded, as an upload has it. Places that are none leave it.
#[test]
fn a_control_point_moves_while_frames_are_in_flight() {
    let host = Host::new();
    let model = shapes::plate();
    let at = LoopAt { part: 0, face: 0, trim_loop: 1 };
    let starts: Vec<DVec2> =
        model.parts[0].faces[0].loops[1].curves().map(|curve| curve.points[0].truncate() / curve.points[0].z).collect();
    let centre = starts.iter().sum::<DVec2>() / starts.len() as f64;
    let size = (120, 60);
    let camera = Camera { eye: DVec3::new(1.0, -2.0, 14.0), up: DVec3::Y, ..from_the_front(size) };
    let editable = SceneSettings { editable: true, ..SceneSettings::default() };
    let targets = [(); SLOTS].map(|()| Targets::new(&host, size, FORMAT));
    let (mut seen, mut models) = (Vec::new(), Vec::new());
    let mut live = renderer(&host, &model, FORMAT);
    assert_eq!(live.edit_trim(at, 0, 0, centre), Err(EditError::NotEditable));
    live.upload_with(&model, editable).unwrap();
    for frame in 0..7 {
        let slot = frame % SLOTS;
        host.wait(slot);
        if frame >= SLOTS {
            seen.push(targets[slot].values());
        }
        live.edit_trim(at, 0, 0, starts[0].lerp(centre, 0.1 * frame as f64)).unwrap();
        let none = EditError::Loop(FaceError::NoPoint { curve: 0, point: 99 });
        assert_eq!(live.edit_trim(at, 0, 99, centre), Err(none));
        assert!(matches!(live.edit_trim(at, 0, 0, DVec2::NAN), Err(EditError::Loop(FaceError::ControlPoint { .. }))));
        models.push((**live.model().unwrap()).clone());
        record(&host, &mut live, slot, &targets[slot], &camera, 0.5);
    }
    (7 - SLOTS..7).for_each(|frame| {
        host.wait(frame % SLOTS);
        seen.push(targets[frame % SLOTS].values());
    });
    drop(live);
    assert!(seen.windows(2).all(|pair| pair[0] != pair[1]), "the hole changes in each frame");
    let mut fresh = renderer(&host, &model, FORMAT);
    for (frame, (seen, model)) in seen.iter().zip(&models).enumerate() {
        fresh.upload_with(model, editable).unwrap();
        record(&host, &mut fresh, 0, &targets[0], &camera, 0.5);
        host.wait(0);
        assert!(*seen == targets[0].values(), "frame {frame}");
    }
    drop(fresh);
    targets.into_iter().for_each(|targets| targets.destroy(&host));
    assert_eq!(host.shutdown(), [""; 0]);
}

/// A cube comes and goes, and so do two spheres beside it, while the other slot's frame is in flight: each frame has what
/// was there when it was recorded, as an upload has it.
#[test]
fn models_come_and_go_while_frames_are_in_flight() {
    let host = Host::new();
    let at = |mut model: Model, x: f64| {
        model.instances[0].transform = DAffine3::from_translation(DVec3::X * x);
        model
    };
    let base = painted(shapes::sphere(), RED);
    let [left, right] = [-9.0, 9.0].map(|x| at(painted(shapes::sphere(), GREEN), x));
    let cube = at(painted(shapes::cube(), GREEN), 4.0);
    let size = (120, 60);
    let camera = from_the_front(size);
    let targets = [(); SLOTS].map(|()| Targets::new(&host, size, FORMAT));
    let (mut seen, mut models, mut living) = (Vec::new(), Vec::new(), Vec::new());
    let mut live = renderer(&host, &base, FORMAT);
    for frame in 0..12 {
        let slot = frame % SLOTS;
        host.wait(slot);
        if frame >= SLOTS {
            assert!(live.report(slot).unwrap().unwrap().complete, "frame {frame}");
            seen.push(targets[slot].values());
        }
        match frame % 6 {
            1 => living.push(live.add(&cube).unwrap()),
            2 => living.extend([&left, &right].map(|model| live.add(model).unwrap())),
            4 => live.remove(living.remove(0)).unwrap(),
            5 => living.drain(..).for_each(|id| live.remove(id).unwrap()),
            _ => {}
        }
        models.push((**live.model().unwrap()).clone());
        record(&host, &mut live, slot, &targets[slot], &camera, 0.5);
    }
    (12 - SLOTS..12).for_each(|frame| {
        host.wait(frame % SLOTS);
        seen.push(targets[frame % SLOTS].values());
    });
    drop(live);
    for (frame, pair) in seen.windows(2).enumerate() {
        assert_eq!(pair[0] != pair[1], models[frame] != models[frame + 1], "frame {frame}");
    }
    assert_uploaded(&host, &targets[0], &camera, &seen, models);
    targets.into_iter().for_each(|targets| targets.destroy(&host));
    assert_eq!(host.shutdown(), [""; 0]);
}

/// A frame that never reaches the GPU has with it what would have been copied for a model: the next one loads all anew,
/// with a model that came meanwhile and has moved.
#[test]
fn a_discarded_frame_loses_no_model() {
    let host = Host::new();
    let base = painted(shapes::sphere(), RED);
    let cube = painted(shapes::cube(), GREEN);
    let size = (120, 60);
    let camera = from_the_front(size);
    let targets = Targets::new(&host, size, FORMAT);
    let mut live = renderer(&host, &base, FORMAT);
    record(&host, &mut live, 0, &targets, &camera, 0.5);
    host.wait(0);
    live.add(&cube).unwrap();
    record(&host, &mut live, 0, &targets, &camera, 0.5);
    host.wait(0);
    live.discard(0);
    let second = live.add(&cube).unwrap();
    let instance = live.instances_of(second).unwrap().start;
    live.set_transform(instance, DAffine3::from_translation(DVec3::X * 9.0)).unwrap();
    let third = live.add(&cube).unwrap();
    live.remove(third).unwrap();
    let seen = [(); 2].map(|()| {
        record(&host, &mut live, 0, &targets, &camera, 0.5);
        host.wait(0);
        targets.values()
    });
    let model = (**live.model().unwrap()).clone();
    assert_eq!(model.instances.len(), 3);
    drop(live);
    assert_uploaded(&host, &targets, &camera, &seen, [model.clone(), model]);
    targets.destroy(&host);
    assert_eq!(host.shutdown(), [""; 0]);
}

/// A view that needs more rows than the first table has: the report states it while a frame of the other slot is in
/// flight, and the next frame in the slot is complete.
#[test]
fn a_frame_without_room_says_so_and_the_next_is_whole() {
    without_room(16, (560, 420));
}

/// A frame that reuses such a table reports it, too.
#[test]
fn a_frame_that_keeps_what_had_no_room_says_so() {
    without_room(7, (960, 720));
}

/// `across` by `across` plates, enough for occlusion culling.
fn without_room(across: u32, size: (u32, u32)) {
    let host = Host::new();
    let mut model = shapes::plate();
    let place = |i: u32| DVec3::new(f64::from(i % across), f64::from(i / across), 0.0) * 7.0;
    let placed = |i| shapes::placed(DAffine3::from_translation(place(i)), Some(RED));
    model.instances = (0..across * across).map(placed).collect();
    let camera = Camera::around(model.control_bounds(), DVec3::new(0.1, -0.2, 1.0), DVec3::Y, 0.6, size);
    let mut renderer = renderer(&host, &model, FORMAT);
    // in an editable scene, patches are not split
    renderer.upload_with(&model, SceneSettings { editable: true, ..SceneSettings::default() }).unwrap();
    let targets = [(); SLOTS].map(|()| Targets::new(&host, size, FORMAT));
    assert_eq!(renderer.report(0).unwrap(), None, "no frame has been recorded");

    let (mut complete, mut kept) = (Vec::new(), Vec::new());
    for frame in 0..8 {
        let slot = frame % SLOTS;
        host.wait(slot);
        let report = renderer.report(slot).unwrap();
        kept.extend(report.iter().map(|report| report.stats.reused));
        complete.extend(report.map(|report| report.complete));
        record(&host, &mut renderer, slot, &targets[slot], &camera, 0.125);
    }
    // the first two were recorded before either could report; rows, then intercepts, may be too few
    assert_eq!(complete[..2], [false, false], "{complete:?}");
    assert!(complete.last().unwrap(), "{complete:?}");
    assert_eq!((kept[0], kept[1]), (false, across * across < 64), "{kept:?}");
    (0..SLOTS).for_each(|slot| host.wait(slot));
    let [a, b] = targets.each_ref().map(Targets::values);
    assert!(a == b, "two whole frames of one view differ");
    assert!(a.0.iter().filter(|c| c[0] > 100).count() > 30_000, "few pixels show the plates");

    drop(renderer);
    targets.into_iter().for_each(|targets| targets.destroy(&host));
    assert_eq!(host.shutdown(), [""; 0]);
}

/// An error reports a host's mistake before anything is recorded, and the command buffer can be used further.
#[test]
fn a_target_of_another_size_is_refused() {
    let host = Host::new();
    let model = painted(shapes::sphere(), RED);
    let mut renderer = renderer(&host, &model, FORMAT);
    let targets = Targets::new(&host, (32, 32), FORMAT);
    let camera = Camera::around(model.control_bounds(), DVec3::X, DVec3::Z, 0.6, (32, 31));
    let cmd = host.begin(0);
    let into = Into { depth: Some(&targets.depth), ..Into::new(&targets.colour) };
    let input = FrameInput { camera: &camera, settings: FrameSettings::default(), slot: 0, targets: into };
    // SAFETY: recording; nothing is in flight.
    match unsafe { renderer.record(cmd, &input) } {
        Err(RenderError::TargetSize { name, width: 32, height: 32 }) => assert_eq!(name, "host colour"),
        other => panic!("{other:?}"),
    }
    host.submit(0);
    host.wait(0);
    assert_eq!(renderer.report(0).unwrap(), None);
    drop(renderer);
    targets.destroy(&host);
    assert_eq!(host.shutdown(), [""; 0]);
}
