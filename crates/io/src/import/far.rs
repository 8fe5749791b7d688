//! What lies too far away to be drawn: a stray value, `1e30` where a number is missing, costs the thing that has it and
//! not the picture.

use super::{FACE_LOST, Import, Place, Warnings};
use crate::model::Bounds;
use std::collections::HashSet;

/// Largest coordinate in millimetres: a tenth of the largest length that a camera takes, which stands beside the model.
const MOST: f64 = 1e14;

/// Why a face is left out.
const WHY: &str = "a control point lies more than 1e14 mm from the origin";

/// Takes faces, meshes and instances from the model that reach beyond [`MOST`]; `name` is the file's name in messages.
/// Primitives of solids stay: they may be unbounded. Cost: one pass over the control points.
pub(super) fn leave_out(import: &mut Import, name: &str) {
    let near = |b: Bounds| b.is_empty() || (b.min.abs().max_element() <= MOST && b.max.abs().max_element() <= MOST);
    let Import { model, warnings, report, .. } = import;
    let mut losses = Warnings::new(name);
    let mut lost = HashSet::new();
    for (index, part) in model.parts.iter_mut().enumerate() {
        let count = part.faces.len() + part.meshes.len();
        part.faces.retain(|face| {
            let (min, max) = face.surface.bounds();
            let keep = near(Bounds { min, max });
            if !keep {
                lost.insert((index, face.id));
                report.dropped.add(WHY);
                losses.push(FACE_LOST, || Place::File, || format!("#{}: {WHY}", face.id));
            }
            keep
        });
        part.meshes.retain(|mesh| {
            let keep = near(mesh.bounds());
            if !keep {
                losses.push(
                    "mesh left out",
                    || Place::File,
                    || "a vertex lies more than 1e14 mm from the origin".into(),
                );
            }
            keep
        });
        // what is left has a hole
        part.closed &= part.faces.len() + part.meshes.len() == count;
    }
    model.instances.retain(|instance| {
        let keep = instance.transform.to_cols_array().iter().all(|x| x.abs() <= MOST);
        if !keep {
            let why = || format!("`{}` is placed more than 1e14 mm from the origin", instance.name);
            losses.push("occurrence left out", || Place::File, why);
        }
        keep
    });
    for record in report.face_records.iter_mut().filter(|r| lost.contains(&(r.part, r.id))) {
        record.kind = None;
        record.notes.push(WHY.to_owned());
    }
    warnings.append(&mut losses.finish(report));
}

#[cfg(test)]
mod tests {
    use crate::import::{Import, Options, read_from};

    fn read(text: &str, name: &str) -> Import {
        read_from(&mut text.as_bytes(), name, &Options::default()).unwrap()
    }

    #[test]
    fn a_stray_value_costs_what_has_it() {
        let patch = |x: &str| format!("4\n1\n0 0 0\n1 0 0\n0 1 0\n{x} 1 0\n");
        let both = read(&[patch("1e14"), patch("1e30")].concat(), "t.bv");
        let told: Vec<_> = both.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(told, ["t.bv: face left out: #2: a control point lies more than 1e14 mm from the origin"]);
        let summary = both.summary();
        assert_eq!((summary.faces.stated, summary.faces.drawn), (2, 1));
        let kinds: Vec<_> = both.report.face_records.iter().map(|r| (r.id, r.kind.is_some())).collect();
        assert_eq!(kinds, [(1, true), (2, false)]);
        let mesh = read("v 0 0 0\nv 1 0 0\nv 0 1e300 0\nf 1 2 3\n", "t.obj");
        assert!(mesh.summary().draws_nothing() && !mesh.summary().is_complete());
        assert!(mesh.warnings[0].message.starts_with("mesh left out: "), "{:?}", mesh.warnings);
    }

    /// A vertex that no facet has is nowhere.
    #[cfg(feature = "meshes")]
    #[test]
    fn a_stray_vertex_without_a_facet_costs_nothing() {
        for (corners, drawn) in [("0 1 2", 1), ("0 1 3", 0)] {
            let import = read(&format!("OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1e300\n3 {corners}\n"), "t.off");
            assert_eq!((import.summary().meshes.drawn, import.summary().is_complete()), (drawn, drawn == 1));
            let bounds = import.model.bounds();
            assert!(drawn == 0 || bounds.max == glam::DVec3::new(1.0, 1.0, 0.0), "{bounds:?}");
        }
    }

    /// A tetrahedron of a red side and three others.
    #[cfg(feature = "meshes")]
    #[test]
    fn what_lacks_a_mesh_is_not_closed() {
        let sides = "3 0 2 1 255 0 0\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
        for (tip, meshes) in [("1", 2), ("1e15", 1)] {
            let import = read(&format!("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 {tip}\n{sides}"), "t.off");
            let part = &import.model.parts[0];
            assert_eq!((part.meshes.len(), part.closed), (meshes, meshes == 2), "{tip}");
        }
    }
}
