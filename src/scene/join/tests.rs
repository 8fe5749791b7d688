use super::*;
use crate::model::{Instance, Mesh, Part};
use crate::picture::{SceneSettings, Smooth};
use glam::{DAffine3, DVec3};
use std::fmt::Debug;
use std::path::Path;

fn sample(name: &str) -> Model {
    selvedge_io::import::open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(name)).unwrap().model
}

fn both(a: &Model, b: &Model) -> Model {
    let mut model = a.clone();
    let first = model.parts.len();
    model.parts.extend(b.parts.iter().cloned());
    model.instances.extend(b.instances.iter().map(|i| Instance { part: first + i.part, ..i.clone() }));
    model
}

/// Every array that the GPU gets, as bytes.
fn arrays(data: &SceneData) -> Vec<(EditTarget, Vec<u8>)> {
    fn bytes<T: Pod>(array: &[T]) -> Vec<u8> {
        bytemuck::cast_slice(array).to_vec()
    }
    let m = &data.meshes;
    vec![
        (EditTarget::Patches, bytes(&data.patches)),
        (EditTarget::Outside, bytes(&data.outside)),
        (EditTarget::Cones, bytes(&data.cones)),
        (EditTarget::Points, bytes(&data.points)),
        (EditTarget::Links, bytes(&data.links)),
        (EditTarget::Faces, bytes(&data.faces)),
        (EditTarget::FaceInstances, bytes(&data.face_instances)),
        (EditTarget::Instances, bytes(&data.instances)),
        (EditTarget::Items, bytes(&data.patch_instances)),
        (EditTarget::Sources, bytes(&data.sources)),
        (EditTarget::Cells, bytes(&data.cells)),
        (EditTarget::CellInstances, bytes(&data.cell_instances)),
        (EditTarget::Curves, bytes(&data.curves)),
        (EditTarget::CurvePoints, bytes(&data.curve_points)),
        (EditTarget::CurveInstances, bytes(&data.curve_instances)),
        (EditTarget::WideStrips, bytes(&data.wide_strips)),
        (EditTarget::Exact(0), bytes(&data.exact.faces)),
        (EditTarget::Exact(1), bytes(&data.exact.cells)),
        (EditTarget::Exact(2), bytes(&data.exact.arcs)),
        (EditTarget::Mesh(0), bytes(&m.meshes)),
        (EditTarget::Mesh(1), bytes(&m.instances)),
        (EditTarget::Mesh(2), bytes(&m.positions)),
        (EditTarget::Mesh(3), bytes(&m.triangles)),
        (EditTarget::Mesh(4), bytes(&m.normals)),
        (EditTarget::Mesh(5), bytes(&m.neighbours)),
    ]
}

/// What the host keeps beside them.
fn kept(data: &SceneData) -> [String; 7] {
    let text = |of: &dyn Debug| format!("{of:?}");
    let (m, live) = (&data.meshes, &data.live);
    let counts = (data.bin_count, m.outward);
    [
        text(&data.placements),
        text(&data.boxes),
        text(&data.trimmed),
        text(live),
        text(&m.draws),
        text(&counts),
        text(&Lengths::of(data)),
    ]
}

/// As `whole`, from `base` and what joins it: before the upload, and by what is told after it.
fn assert_joins(base: &Model, added: &Model, trim: TrimWay) -> SceneData {
    let request = SceneRequest::from(SceneSettings { trim, smooth: Smooth::Borders, ..SceneSettings::default() });
    let model = both(base, added);
    let whole = SceneData::telling(&model, request, &|_| ()).unwrap();
    let first = FirstNumbers { part: base.parts.len(), instance: base.instances.len() };
    for is_uploaded in [false, true] {
        let mut data = SceneData::telling(base, request, &|_| ()).unwrap();
        let before = arrays(&data);
        let mut to = Joinable::of(&data, base, request).expect("a scene of parts");
        let new = to.arrays_of(added, model.control_bounds().diagonal()).expect("of the same kinds");
        let picking = whole.picking(&model, |_, face| face);
        let mut own = data.picking(base, |_, face| face);
        let joined = data.join((added, new), &mut to, first, is_uploaded).unwrap();
        data.settle();
        own.join(joined.picking);
        assert_eq!(format!("{own:?}"), format!("{picking:?}"), "{trim:?}");
        assert_eq!(to.lengths, Lengths::of(&whole));
        if !is_uploaded {
            assert!(joined.writes.is_empty() && joined.draws.is_empty());
            assert!(arrays(&data) == arrays(&whole), "{trim:?}");
            for (kept, of_whole) in kept(&data).iter().zip(kept(&whole)) {
                let at = kept.bytes().zip(of_whole.bytes()).position(|(a, b)| a != b);
                let from =
                    |text: &str| text[at.unwrap_or(0).saturating_sub(60)..].chars().take(120).collect::<String>();
                assert!(*kept == of_whole, "{trim:?}: …{}…, not …{}…", from(kept), from(&of_whole));
            }
            continue;
        }
        assert!(arrays(&data) == before, "the GPU has them");
        let draws = [&*before_draws(base, request), &joined.draws].concat();
        assert_eq!(draws, whole.meshes.draws);
        let mut told = before;
        for Write { to, offset, bytes } in &joined.writes {
            let (_, array) = told.iter_mut().find(|(of, _)| of == to).unwrap();
            assert_eq!(array.len() as u64, *offset, "{to:?}: one behind the other");
            array.extend(bytes);
        }
        assert!(told == arrays(&whole), "{trim:?}");
    }
    whole
}

fn before_draws(base: &Model, request: SceneRequest) -> Vec<(Range<u32>, Range<u32>)> {
    SceneData::telling(base, request, &|_| ()).unwrap().meshes.draws
}

/// Two triangles that share a side.
fn folded() -> Model {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE].to_vec();
    let mesh = Mesh::new(9, corners, vec![[0, 1, 2], [1, 3, 2]], Vec::new()).unwrap();
    let part = Part { meshes: vec![mesh], ..Part::default() };
    let instance = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
    Model { parts: vec![part], instances: vec![instance], ..Model::default() }
}

/// Each way to trim, with parts of several patches and meshes.
#[test]
fn arrays_of_a_model_behind_a_scene_are_those_of_both() {
    let (bracket, assembly) = (sample("bracket.step"), sample("assembly.step"));
    let mut seen = 0;
    for trim in [TrimWay::Table, TrimWay::Exact] {
        for (base, added) in [(&bracket, &bracket), (&assembly, &assembly)] {
            seen |= Kinds::of(&assert_joins(base, added, trim)).0;
        }
        // no model has more trims than the scene, nor fewer kinds of anything
        let everything = both(&both(&assembly, &bracket), &folded());
        seen |= Kinds::of(&assert_joins(&everything, &both(&bracket, &folded()), trim)).0;
    }
    let (meshes, cones) = (1 << 6, 1 << 8);
    assert_eq!(seen & (meshes | cones), meshes | cones, "{seen:b}");
}

/// What a scene has none of does not join it.
#[test]
fn what_a_scene_has_none_of_has_it_made_anew() {
    let bracket = sample("bracket.step");
    let request = SceneRequest::from(SceneSettings::default());
    let mut plain = bracket.clone();
    plain.parts.iter_mut().flat_map(|part| &mut part.faces).for_each(|face| face.loops.clear());
    let joins = |base: &Model, added: &Model, request: SceneRequest| {
        let data = SceneData::telling(base, request, &|_| ()).unwrap();
        let extent = both(base, added).control_bounds().diagonal();
        Joinable::of(&data, base, request).is_some_and(|to| to.arrays_of(added, extent).is_some())
    };
    assert!(joins(&bracket, &bracket, request));
    assert!(!joins(&plain, &bracket, request), "the first trims");
    let mut glass = bracket.clone();
    glass.parts[0].closed = true;
    glass.instances[0].colour = Some([0.5, 0.5, 0.5, 0.5]);
    assert!(!joins(&bracket, &glass, request) && !joins(&glass, &bracket, request));
    let mut alone = request;
    alone.settings.thickness = true;
    assert!(!joins(&bracket, &bracket, alone));
    assert!(!joins(&Model::default(), &bracket, request), "the first patch");
    assert!(joins(&bracket, &Model::default(), request), "nothing");
}
