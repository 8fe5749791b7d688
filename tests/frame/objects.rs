//! A scene makes only the buffers, images and pipelines that it needs.

use crate::shapes::Shape;
use crate::support::{assert_silent, perspective, watched_for, watched_with};
use crate::{cages, shapes};
use glam::{DAffine3, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Model, Part};
use selvedge::picture::{FrameSettings, Outputs, Samples, SceneSettings, SolidWay, TrimWay};

/// Pipelines of the trim table.
const TRIM_PASSES: [&str; 7] = ["density", "lines", "segments", "sizes", "cross", "sort", "scan add (counted)"];

/// Names of the objects that exist after one frame.
fn objects(model: &Model, outputs: Outputs) -> (HeadlessRenderer, Vec<String>) {
    objects_with(model, SceneSettings::default(), outputs)
}

fn objects_with(model: &Model, settings: SceneSettings, outputs: Outputs) -> (HeadlessRenderer, Vec<String>) {
    let mut renderer = watched_for(outputs, model, settings);
    renderer.render(&perspective(model, (64, 48)), &FrameSettings::default(), outputs).unwrap();
    let objects = renderer.objects();
    (renderer, objects)
}

fn is_of_trimming(name: &str) -> bool {
    name.starts_with("trim")
        || name.contains("(table")
        || name.contains("(exact")
        || name.starts_with("gap")
        || TRIM_PASSES.iter().any(|pass| name.starts_with(pass))
}

#[test]
fn only_a_trimmed_scene_has_what_its_way_to_trim_needs() {
    // the table's buffers, the scene's curves, and a pipeline for each pass
    has_what_it_needs(
        TrimWay::Table,
        &[
            "trim intercepts",
            "trim curves",
            "cross (count)",
            "scan add (counted)",
            "visibility (table",
            "gap fill (table",
        ],
        &["trim arcs", "visibility (exact", "gap fill (exact"],
    );
    has_what_it_needs(
        TrimWay::Exact,
        &["trim arcs", "visibility (exact", "gap fill (exact"],
        &[
            "trim intercepts",
            "trim curves",
            "cross",
            "scan add (c",
            "sort",
            "density",
            "visibility (table",
            "gap fill (table",
        ],
    );
}

fn has_what_it_needs(way: TrimWay, needed: &[&str], others: &[&str]) {
    let settings = SceneSettings { trim: way, ..SceneSettings::default() };
    let (trimmed, rest): (Vec<_>, Vec<_>) = shapes::all().into_iter().partition(|shape| shape.trimmed);
    // every other shape of either kind
    for shape in trimmed.iter().step_by(2).chain(rest.iter().step_by(2)) {
        let (renderer, objects) = objects_with(&shape.model, settings, Outputs::ALL);
        let of_trimming: Vec<_> = objects.iter().filter(|name| is_of_trimming(name)).collect();
        if shape.trimmed {
            let has = |start: &str| objects.iter().any(|name| name.starts_with(start));
            assert!(needed.iter().all(|start| has(start)), "{needed:?} in {}: {objects:?}", shape.name);
            assert!(!others.iter().any(|start| has(start)), "{others:?} in {}: {objects:?}", shape.name);
        } else {
            assert!(of_trimming.is_empty(), "{}: {of_trimming:?}", shape.name);
        }
        assert_silent(renderer);
    }
}

/// Of every shape, one scene, and one rule after the other for its objects.
#[test]
fn a_scene_has_only_what_its_parts_need() {
    for shape in shapes::all() {
        let (renderer, objects) = objects(&shape.model, Outputs::ALL);
        only_meshes_have_what_they_need(&shape, &objects);
        only_closed_parts_without_trims_have_cones(&shape, &objects);
        only_faces_that_share_sides_have_links(&shape, &objects);
        only_solids_have_what_they_need(&shape, &objects);
        only_a_rational_scene_has_rational_pipelines(&shape, &objects);
        assert_silent(renderer);
    }
}

/// Pipelines, buffers and the image of meshes exist only with meshes; the separate image only if faces are trimmed as
/// well.
fn only_meshes_have_what_they_need(shape: &Shape, objects: &[String]) {
    let needed = ["mesh", "meshes", "mesh instances", "mesh positions", "mesh triangles", "resolve (mesh)"];
    let has = shape.model.parts.iter().any(|p| !p.meshes.is_empty());
    let any = has || shape.model.parts.iter().any(|p| !p.faces.is_empty());
    assert_eq!(objects.iter().any(|o| o == "seen squares"), any, "{}: {objects:?}", shape.name);
    for name in needed {
        assert_eq!(objects.iter().any(|o| o == name), has, "{name} in {}: {objects:?}", shape.name);
    }
    assert_eq!(objects.iter().any(|o| o == "visibility without patches"), has && shape.trimmed, "{}", shape.name);
    assert_eq!(objects.iter().any(|o| o.contains("mesh")), has, "{}: {objects:?}", shape.name);
}

/// Cones of normals exist if a part is closed, none of its faces is trimmed, and all of their sides are linked.
fn only_closed_parts_without_trims_have_cones(shape: &Shape, objects: &[String]) {
    let has = objects.iter().any(|o| o == "patch cones");
    let may = |p: &Part| p.closed && !p.faces.is_empty() && p.faces.iter().all(|f| f.loops.is_empty());
    assert_eq!(has, shape.model.parts.iter().any(may), "{}: {objects:?}", shape.name);
}

/// Objects of sides that faces share.
fn of_links(objects: &[String]) -> Vec<&str> {
    objects.iter().map(String::as_str).filter(|o| o.contains("link") && !o.starts_with("staging")).collect()
}

fn only_faces_that_share_sides_have_links(shape: &Shape, objects: &[String]) {
    let may = shape.model.parts.iter().any(|p| p.faces.len() > 1);
    assert!(may || of_links(objects).is_empty(), "{}: {objects:?}", shape.name);
}

/// No shape has solids.
fn only_solids_have_what_they_need(shape: &Shape, objects: &[String]) {
    assert!(!objects.iter().any(|o| o.contains("solid") || o.contains("volume")), "{}: {objects:?}", shape.name);
}

fn only_a_rational_scene_has_rational_pipelines(shape: &Shape, objects: &[String]) {
    let rational = objects.iter().any(|name| name.contains("rational"));
    assert_eq!(rational, shape.rational, "{}: {objects:?}", shape.name);
}

/// Occlusion culling of whole parts exists only in scenes of many placed parts that have several patches each.
#[test]
fn only_a_scene_of_many_parts_has_occlusion_culling_of_parts() {
    let of_parts = [
        "part counts",
        "part runs",
        "cull parts",
        "cull early (all)",
        "parts in sight",
        "parts hidden before",
        "parts hidden now",
        "counts of parts",
        "starts of parts",
        "runs of listed parts",
        "dispatches of listed parts",
    ];
    let copies = |shape: Model, count: u32| {
        let place = |n: u32| DAffine3::from_translation(DVec3::X * 9.0 * f64::from(n));
        Model { instances: (0..count).map(|n| shapes::placed(place(n), None)).collect(), ..shape }
    };
    // a cube has six patches, a plate has one
    let cases = [(shapes::cube(), 127, false), (shapes::cube(), 128, true), (shapes::plate(), 300, false)];
    for (shape, count, is_asked) in cases {
        let (renderer, objects) = objects(&copies(shape, count), Outputs::ALL);
        let found: Vec<_> = of_parts.iter().filter(|name| objects.iter().any(|object| object == *name)).collect();
        assert_eq!(found.len(), if is_asked { of_parts.len() } else { 0 }, "{count}: {found:?}");
        assert_silent(renderer);
    }
}

/// Occlusion culling exists only in scenes with many patches.
#[test]
fn only_a_scene_of_many_patches_has_occlusion_culling() {
    let of_hiding = ["hidden patches", "farthest depths", "patches outside"];
    let passes = ["cull early", "depth pyramid", "cull late", "reset (draws)"];
    let is_of_hiding = |name: &str| of_hiding.contains(&name) || passes.contains(&name);
    // four treads have 24 patches, the whole stair 144
    let (mut few, many) = (shapes::stair(), shapes::stair());
    few.instances.truncate(4);
    few.instances[3].transform.translation.x += 1e4; // none of them is split
    let default = SceneSettings::default();
    let samples = SceneSettings { samples: Samples::Four, ..default };
    for (model, settings, is_used) in [(&few, default, false), (&many, default, true), (&many, samples, false)] {
        let (renderer, objects) = objects_with(model, settings, Outputs::default());
        let count = objects.iter().filter(|name| is_of_hiding(name)).count();
        assert_eq!(count, if is_used { of_hiding.len() + passes.len() } else { 0 }, "{objects:?}");
        let adds_up = objects.iter().any(|name| name == "resolve (background, samples)");
        assert_eq!(adds_up, settings == samples, "{objects:?}");
        assert_silent(renderer);
    }
}

/// The pipeline of patches that are drawn by their corners exists only in scenes of many patches.
#[test]
fn only_a_scene_of_many_patches_draws_some_by_their_corners() {
    let mut model = shapes::wave();
    let (mut renderer, _) = objects(&model, Outputs::ALL);
    let one = renderer.render(&perspective(&model, (16, 12)), &FrameSettings::default(), Outputs::ALL).unwrap();
    assert_silent(renderer);
    let most = (1 << 17) / one.stats.patches as usize;
    for (count, is_used) in [(most - 1, false), (most, true)] {
        let place = |i: usize| DAffine3::from_translation(DVec3::X * (10 * i) as f64);
        model.instances = (0..count).map(|i| shapes::placed(place(i), None)).collect();
        let (renderer, objects) = objects(&model, Outputs::ALL);
        let has = objects.iter().any(|name| name == "visibility (plain, polynomial, by corners)");
        assert_eq!(has, is_used, "{count} patches: {objects:?}");
        assert_silent(renderer);
    }
}

#[test]
fn faces_that_share_sides_have_links() {
    let (renderer, objects) = objects(&cages::a_box().model, Outputs::ALL);
    let found = of_links(&objects);
    for name in ["patch links", "split (linked)", "visibility (plain, polynomial, linked)"] {
        assert!(found.contains(&name), "{name}: {found:?}");
    }
    assert_eq!(found.len(), 3, "{found:?}");
    assert_silent(renderer);
}

/// A scene of solids alone has what they need, and nothing of patches, trims or meshes.
#[test]
fn a_scene_with_solids_has_what_they_need() {
    let needed = ["solid rects", "solid fold", "solid leaves", "solid sides", "solid surfaces", "resolve (solid)"];
    let (renderer, objects) = objects(&shapes::solids::holes(2), Outputs::ALL);
    for name in needed {
        assert!(objects.iter().any(|o| o.starts_with(name)), "{name}: {objects:?}");
    }
    assert!(!objects.iter().any(|name| is_of_trimming(name) || name.contains("mesh")), "{objects:?}");
    assert!(!objects.iter().any(|name| name == "visibility without patches"), "{objects:?}");
    let of_patches = ["bound", "split", "emit", "seen squares", "resolve (polynomial", "resolve (rational"];
    assert!(!objects.iter().any(|o| of_patches.iter().any(|name| o.starts_with(name))), "{objects:?}");
    assert!(!objects.iter().any(|o| o.starts_with("resolve (background")), "{objects:?}");
    assert_silent(renderer);
}

/// Each way to draw solids has its own passes and no others. With mesh operands, layers are peeled without tiles and
/// without a list of crossings.
#[test]
fn a_way_to_draw_solids_has_its_own_passes() {
    let of = |way: SolidWay, model: &Model| {
        let settings = SceneSettings { solids: way, ..Default::default() };
        let (renderer, objects) = objects_with(model, settings, Outputs::ALL);
        assert_silent(renderer);
        objects
    };
    let (equations, (_, mesh)) = (shapes::solids::holes(2), shapes::operands::meshes().swap_remove(1));
    let all = [SolidWay::Events, SolidWay::Cst, SolidWay::Blister];
    for (way, own) in all.into_iter().zip(["solid events", "solid cst", "blister"]) {
        let objects = of(way, &equations);
        let has = |what: &str| objects.iter().any(|o| o.starts_with(what));
        assert!(has(own) && has("solid tile leaves"), "{}: {objects:?}", way.name());
        let others = ["solid events", "solid cst", "blister"].into_iter().filter(|other| *other != own);
        assert!(others.into_iter().all(|other| !has(other)), "{}: {objects:?}", way.name());
    }
    let peeled = of(SolidWay::Blister, &mesh);
    let lacks = |what: &str| !peeled.iter().any(|o| o.starts_with(what));
    assert!(lacks("solid tile") && lacks("operand fragment") && lacks("operand sort"), "{peeled:?}");
    assert!(!lacks("blister peel (meshes)"), "{peeled:?}");
    assert!(!of(SolidWay::Events, &mesh).iter().any(|o| o.starts_with("blister")));
}

/// If a trim curve crosses every patch of a scene, there is no pipeline for untrimmed patches, and vice versa.
#[test]
fn a_kind_of_patch_that_no_face_has_gets_no_pipeline() {
    // so small in its scene that its patches are not split
    let mut plate = shapes::plate();
    plate.instances.push(shapes::placed(DAffine3::from_translation(1e4 * DVec3::X), None));
    for (model, has, lacks) in [(plate, "table", "plain"), (shapes::wave(), "plain", "table")] {
        let (renderer, objects) = objects(&model, Outputs::ALL);
        let drawing = |kind: &str| objects.iter().any(|name| name.starts_with(&format!("visibility ({kind}")));
        assert!(drawing(has) && !drawing(lacks), "{objects:?}");
        assert_silent(renderer);
    }
}

/// Trimmed faces of a solid that fills its scene have more patches than those of a solid that is small in it.
#[test]
fn large_faces_are_cut() {
    let mut tread = shapes::stair();
    tread.instances.truncate(1);
    let mut small = tread.clone();
    let mut far = small.instances[0].clone();
    far.transform.translation.x += 1e4;
    small.instances.push(far);
    let patches = |model: &Model| {
        let mut renderer = watched_with(model, SceneSettings::default());
        let camera = perspective(model, (64, 48));
        let picture = renderer.render(&camera, &FrameSettings::default(), Outputs::ALL).unwrap();
        assert_silent(renderer);
        picture.stats.patches
    };
    let (cut, whole) = (patches(&tread), patches(&small) / 2);
    assert!(cut > whole, "{cut} and {whole} patches");
}

#[test]
fn images_beside_the_colour_exist_when_asked_for() {
    let model = shapes::sphere();
    let (renderer, without) = objects(&model, Outputs::default());
    assert_silent(renderer);
    let (renderer, with) = objects(&model, Outputs { normal: true, ..Outputs::default() });
    assert_silent(renderer);
    for image in ["depth", "face", "uv", "normal"] {
        assert!(!without.iter().any(|name| name == image), "{without:?}");
        assert!(with.iter().any(|name| name == image), "{with:?}");
    }
}

/// Memory follows the scene: buffers of a replaced model are freed after their last frame.
#[test]
fn a_replaced_model_leaves_nothing_behind() {
    let (mut renderer, before) = objects(&shapes::wave(), Outputs::default());
    renderer.upload(&shapes::cube()).unwrap();
    let camera = perspective(&shapes::wave(), (64, 48));
    let draw = |renderer: &mut HeadlessRenderer| {
        renderer.render(&camera, &FrameSettings::default(), Outputs::default()).unwrap();
    };
    draw(&mut renderer);
    assert!(renderer.objects().iter().any(|name| is_of_trimming(name)));
    renderer.upload(&shapes::wave()).unwrap();
    draw(&mut renderer);
    draw(&mut renderer); // the second frame in the slot frees what the first one replaced
    let sorted = |mut names: Vec<String>| {
        names.retain(|name| !name.starts_with("staging"));
        names.sort();
        names
    };
    assert_eq!(sorted(renderer.objects()), sorted(before));
    assert_silent(renderer);
}

/// Buffers and pipelines exist for a volume that trims the scene; the tests above show that other scenes have none.
#[test]
fn a_scene_that_a_volume_trims_has_what_that_needs() {
    let mut model = shapes::beside();
    model.trim_by(&shapes::solids::solid("A", vec![shapes::solids::ball(1.0, 0.0)]).solids[0]).unwrap();
    let (renderer, objects) = objects(&model, Outputs::ALL);
    let of_volume = |o: &&String| o.contains("volume");
    let buffers =
        ["volume leaves", "volume sides", "volume surfaces", "volume surface places", "mesh (within a volume)"];
    for name in buffers {
        assert!(objects.iter().any(|o| o == name), "{name}: {objects:?}");
    }
    // in addition visibility and gap_fill, whose names end differently
    assert!(objects.iter().filter(of_volume).count() >= buffers.len() + 2, "{objects:?}");
    assert!(!objects.iter().any(|o| o.contains("solid")), "{objects:?}");
    assert_silent(renderer);
}
