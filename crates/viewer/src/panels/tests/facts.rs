//! What the panel says of a face and of an edge, recent files, and the number of sections.

use super::*;
use selvedge::model::SurfaceKind;

/// The first face of a kind in the first instance, at the middle of its surface.
fn face(bench: &Bench, kind: SurfaceKind) -> (Picked, u32) {
    let world = &bench.session.world;
    let faces = &world.model.parts[world.model.instances[0].part].faces;
    let nth = faces.iter().position(|face| face.kind == kind).expect("such a face");
    let (u, v) = faces[nth].surface.domain();
    let uv = glam::DVec2::new(u.0 + u.1, v.0 + v.1) * 0.5;
    (Picked::Face { instance: 0, face: nth, uv }, faces[nth].id)
}

#[test]
fn the_panel_says_all_of_a_face_and_the_length_of_an_edge() {
    let mut bench = Bench::of("bracket.step");
    let (cylinder, id) = face(&bench, SurfaceKind::Cylinder);
    bench.session.select(Some(cylinder), false);
    for what in ["cylinder", "in the file", "degree", "knots in u", "knots in v", "normal"] {
        assert!(bench.says(what), "{what}");
    }
    assert!(bench.says(&format!("#{id}")) && bench.says("×"), "its number, and the multiplicity of a knot");
    assert!(!bench.says("radius"));
    let measured = |bench: &mut Bench, wanted: &[&str]| {
        let measurement = crate::measure::measure(&bench.session.world, &bench.session.selection).expect("measured");
        bench.ui.measured(Some(measurement.clone()));
        for what in wanted {
            let value = measurement.values.iter().find(|value| value.what == *what).expect(what);
            assert!(bench.says(what) && bench.says(&crate::measure::stated(value)), "{what}");
        }
    };
    measured(&mut bench, &["area", "radius"]);
    assert!(bench.says("axis"));
    bench.session.select(Some(Picked::Edge { instance: 0, edge: 0 }), false);
    measured(&mut bench, &["length"]);
}

#[test]
fn a_recent_file_is_opened_from_its_menu() {
    let mut bench = Bench::new();
    let recent = ["/x/later.step", "/x/before.step"];
    bench.settings.recent = recent.map(PathBuf::from).to_vec();
    for what in ["File", "Recent", recent[1]] {
        bench.click(what);
    }
    assert_eq!(bench.ui.commands, [Command::Open(recent[1].into())]);
}

#[test]
fn there_is_no_fourth_section() {
    for (before, after) in [(2, 3), (3, 3)] {
        let mut bench = Bench::of("bracket.step");
        let (plane, _) = face(&bench, SurfaceKind::Plane);
        bench.session.select(Some(plane), false);
        let section = cut::at_selection(&bench.session).expect("a plane");
        bench.session.scene.change(|state| state.sections = vec![section; before]);
        bench.click("Section");
        bench.click("Across x");
        assert_eq!(bench.session.scene.now().sections.len(), after, "by the menu, with {before}");
        bench.session.scene.change(|state| state.sections = vec![section; before]);
        bench.ui.obey(Command::Cut, &mut bench.session);
        assert_eq!(bench.session.scene.now().sections.len(), after, "by the key, with {before}");
    }
}
