//! Hand-made files with exact numbers, damaged files, and the models of a folder.

mod classes;
mod closing;
mod damage;
mod models;
mod previews;
mod shapes;
mod solids;
mod structure;
mod swept;

use crate::import::{Import, iges};
use crate::model::Face;
use glam::DVec3;

/// An entity of a hand-made file.
struct Entity {
    parameters: String,
    form: i32,
    matrix: u32,
    colour: i32,
    level: i32,
    status: &'static str,
    label: &'static str,
}

/// An entity with these parameters, its type first.
fn e(parameters: &str) -> Entity {
    let parameters = parameters.to_owned();
    Entity { parameters, form: 0, matrix: 0, colour: 0, level: 0, status: "00000000", label: "" }
}

/// The global section of a file in millimetres.
const GLOBAL: &str = ",,4Hpart,5Ht.igs,6Hwriter,1H1,32,38,6,308,15,,1.,2,2HMM,1,0.01,,1.E-6,100.,,,11,0;";

/// A file with these entities, numbered 1, 3, 5 and so on.
fn file(global: &str, entities: &[Entity]) -> String {
    let mut text = format!("{:<72}S{:>7}\n", "hand-made", 1);
    let cut = |text: &str, width: usize| -> Vec<String> {
        text.as_bytes().chunks(width).map(|c| String::from_utf8(c.to_vec()).unwrap()).collect()
    };
    for (i, line) in cut(global, 72).iter().enumerate() {
        text += &format!("{line:<72}G{:>7}\n", i + 1);
    }
    let mut parameters = String::new();
    let mut next = 1;
    for (i, e) in entities.iter().enumerate() {
        let (kind, id) = (e.parameters.split([',', ';', '|']).next().unwrap(), 2 * i + 1);
        let cards = cut(&e.parameters, 64);
        let (level, matrix, status) = (e.level, e.matrix, e.status);
        text +=
            &format!("{kind:>8}{next:>8}{:>8}{:>8}{level:>8}{:>8}{matrix:>8}{:>8}{status:>8}D{id:>7}\n", 0, 0, 0, 0);
        let (colour, form, label, second) = (e.colour, e.form, e.label, id + 1);
        text += &format!(
            "{kind:>8}{:>8}{colour:>8}{:>8}{form:>8}{:>16}{label:>8}{:>8}D{second:>7}\n",
            0,
            cards.len(),
            "",
            0
        );
        for card in &cards {
            parameters += &format!("{card:<64}{id:>8}P{next:>7}\n");
            next += 1;
        }
    }
    text += &parameters;
    let counts = format!("S{:>7}G{:>7}D{:>7}P{:>7}", 1, cut(global, 72).len(), 2 * entities.len(), next - 1);
    text + &format!("{counts:<72}T{:>7}\n", 1)
}

/// Reads a file in millimetres with these entities.
fn import(entities: &[Entity]) -> Import {
    iges(file(GLOBAL, entities).as_bytes(), "t.igs").expect("an IGES file")
}

/// The only face of a file that gives no warning.
fn face(entities: &[Entity]) -> Face {
    let import = import(entities);
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    assert_eq!((import.report.faces, import.model.face_count()), (1, 1));
    import.model.parts[0].faces[0].clone()
}

/// Points of the face: a grid of its carrier where the loops keep it, and its border.
fn points(face: &Face) -> Vec<DVec3> {
    let grid = face.surface.patches();
    let (u, v) = face.surface.domain();
    let region = crate::trim::LoopIndex::new(&face.loops);
    let mut out = Vec::new();
    for i in 0..=24 {
        for j in 0..=24 {
            let at = |(a, b): (f64, f64), k: i32| a + (b - a) * f64::from(k) / 24.0;
            let p = glam::DVec2::new(at(u, i), at(v, j));
            if face.loops.is_empty() || region.contains(p) {
                out.push(grid.point(p.x, p.y));
            }
        }
    }
    for curve in face.loops.iter().flat_map(crate::model::TrimLoop::curves) {
        out.extend((0..=16).map(|k| curve.point(f64::from(k) / 16.0)).map(|p| grid.point(p.x, p.y)));
    }
    out
}

/// Some point of the face's border or carrier is within `1e-9` of `p`.
fn reaches(face: &Face, p: DVec3) {
    let nearest = points(face).into_iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-9, "{p} is {nearest:e} away");
}

/// The value is 0 at every point of the face, within `1e-9`.
fn lies_on(face: &Face, value: impl Fn(DVec3) -> f64) {
    let all = points(face);
    assert!(all.len() > 60);
    let worst = all.into_iter().map(|p| value(p).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst:e}");
}
