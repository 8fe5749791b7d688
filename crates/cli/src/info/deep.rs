//! `selvedge info --deep`: every face, and the worst of them.

use crate::output;
use comfy_table::{CellAlignment, Table};
use selvedge_io::import::FaceRecord;

/// Faces listed as the worst in each respect.
const WORST: usize = 10;

/// A table of all faces, those left out, and the worst by deviation and by gap.
pub fn text(faces: &[FaceRecord]) -> String {
    let all: Vec<&FaceRecord> = faces.iter().collect();
    let lost: Vec<&FaceRecord> = faces.iter().filter(|f| f.kind.is_none()).collect();
    let mut blocks = vec![format!("every face:\n{}", table(&all))];
    let mut block = |title: &str, list: &[&FaceRecord]| {
        if !list.is_empty() {
            blocks.push(format!("{title}:\n{}", table(list)));
        }
    };
    block("faces left out", &lost);
    block("trim curves farthest from their edges", &worst(faces, |f| f.deviation));
    block("edges farthest off their surfaces", &worst(faces, |f| f.gap));
    blocks.join("\n")
}

/// The faces with the largest values above 0, largest first.
fn worst(faces: &[FaceRecord], value: impl Fn(&FaceRecord) -> f64) -> Vec<&FaceRecord> {
    let mut list: Vec<&FaceRecord> = faces.iter().filter(|f| value(f) > 0.0).collect();
    list.sort_by(|a, b| value(b).total_cmp(&value(a)));
    list.truncate(WORST);
    list
}

fn table(faces: &[&FaceRecord]) -> Table {
    let mut table = output::table([
        "face",
        "part",
        "surface",
        "degree",
        "rational",
        "loops",
        "curves",
        "deviation, mm",
        "gap, mm",
        "tolerance, mm",
        "notes",
    ]);
    for face in faces {
        let kind = face.kind.map_or("left out".to_string(), |kind| format!("{kind:?}"));
        let [u, v] = face.degree;
        table.add_row([
            format!("#{}", face.id),
            face.part.to_string(),
            kind,
            format!("{u} x {v}"),
            if face.rational { "yes" } else { "no" }.to_string(),
            face.loops.to_string(),
            face.curves.to_string(),
            format!("{:.2e}", face.deviation),
            format!("{:.2e}", face.gap),
            format!("{:.2e}", face.tolerance),
            face.notes.join("; "),
        ]);
    }
    for column in [0, 1, 5, 6, 7, 8, 9] {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face(id: u32, deviation: f64, gap: f64) -> FaceRecord {
        FaceRecord { id, deviation, gap, ..FaceRecord::default() }
    }

    #[test]
    fn the_worst_come_first_and_perfect_ones_not_at_all() {
        let mut faces: Vec<_> = (1..=20).map(|i| face(i, f64::from(i), 0.0)).collect();
        faces.push(face(99, 0.0, 1.0));
        let ids: Vec<u32> = worst(&faces, |f| f.deviation).iter().map(|f| f.id).collect();
        assert_eq!(ids, (11..=20).rev().collect::<Vec<_>>());
        assert_eq!(worst(&faces, |f| f.gap).len(), 1);
    }

    #[test]
    fn lost_faces_stand_apart_with_their_reason() {
        let lost = FaceRecord { notes: vec!["no loop".into()], ..face(7, 0.0, 0.0) };
        let text = text(&[lost, face(8, 1e-7, 0.0)]);
        assert!(text.contains("faces left out:") && text.matches("no loop").count() == 2, "{text}");
    }
}
