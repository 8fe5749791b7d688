//! Warnings with their places, counted by kind and bounded in number, and the import's counts.

use super::Reasons;
use crate::brep::BuiltFace;
use crate::model::{Face, SurfaceKind};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

/// Where in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line, counted from 1.
    Line(usize),
    /// A numbered entity and the line on which it starts.
    Entity {
        /// STEP: `#id`; IGES: number of its directory entry.
        id: u32,
        /// Counted from 1.
        line: usize,
    },
}

/// Something in a file that was left out, repaired or guessed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// The file.
    pub file: String,
    /// Where.
    pub place: Place,
    /// The fault, and what was done about it.
    pub message: String,
    /// How many occurrences this warning stands for; above 1 for the last one kept of its kind.
    pub count: usize,
}

/// Counts for readers of the report; drawing does not use them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ImportReport {
    /// File format and schema, as the file names it.
    pub format: String,
    /// The program that wrote the file, if it says so.
    pub written_by: String,
    /// Length units of the representation contexts in use.
    pub units: Vec<String>,
    /// Bodies: solids, shells, sets of surfaces.
    pub bodies: usize,
    /// Edges in use, each counted once per body.
    pub edges: usize,
    /// Faces in the bodies before any was left out.
    pub faces: usize,
    /// Triangle meshes: one for each tessellated face that has no exact face.
    pub meshes: usize,
    /// (u, v) curves in the file, of the faces that are read. STEP: none is used, since both faces of an edge are
    /// trimmed from the one edge in space, so that neighbours agree. IGES: used where there is no curve in space, or
    /// none that fits. OBJ and 3dm: they are the trims.
    pub pcurves: usize,
    /// Names of the assembly occurrences, by their path from the root.
    pub occurrences: Vec<String>,
    /// Files that hold parts of an assembly, by the names that the others give them.
    pub external_files: Vec<String>,
    /// Files that were read beside the one that was opened: models, data and materials that it names.
    pub files_read: Vec<PathBuf>,
    /// The files among them that were not read; their content is missing.
    pub missing_files: Vec<String>,
    /// Nodes of a Boolean solid by name, as the file has them, and of modifiers (`%`, `#`, `!`, `*`).
    pub nodes: BTreeMap<String, usize>,
    /// Warnings by kind.
    pub warnings: BTreeMap<String, usize>,
    /// Faces left out, by reason.
    pub dropped: Reasons,
    /// Everything else left out, by kind and reason: bodies, occurrences, polygons, unreadable statements, ...
    pub left_out: BTreeMap<String, Reasons>,
    /// Repaired faces, by what was repaired.
    pub repaired: Reasons,
    /// Largest [`FaceRecord::deviation`] of trim curves: the engine's own part of the error.
    pub deviation: f64,
    /// Largest distance in millimetres of a generated surface from its definition: an equation, data, an offset, the
    /// limit of a subdivision.
    pub made: f64,
    /// Vertices of subdivided meshes around which no polynomial patch is exact.
    pub irregular: usize,
    /// Largest [`FaceRecord::gap`]: the file's part.
    pub gap: f64,
    /// Faces whose edges lie farther off their surface than the file's tolerance.
    pub sloppy: usize,
    /// Content of the file beside bodies that is not drawn, by kind: hidden items, curves, annotations.
    pub ignored: BTreeMap<String, usize>,
    /// Layers by name, with the number of items that the file puts on each.
    pub layers: BTreeMap<String, usize>,
    /// One record a face: those that could not be read, then the others in the order of the file. Left out of
    /// the serialised report: a large file has tens of thousands.
    #[serde(skip)]
    pub face_records: Vec<FaceRecord>,
}

/// The result for one face of the file. Lengths in millimetres.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FaceRecord {
    /// Number in the source, as in [`Face::id`](crate::model::Face::id).
    pub id: u32,
    /// Index of its part in the model; the number of parts for a face left out whose part has no other, and for a face
    /// of an operand of a Boolean solid.
    pub part: usize,
    /// The kind of its surface; `None` when the face was left out, and `notes` says why.
    pub kind: Option<SurfaceKind>,
    /// Degrees of the drawn surface in u and v.
    pub degree: [usize; 2],
    /// The drawn surface has weights that differ.
    pub rational: bool,
    /// Trim loops.
    pub loops: usize,
    /// Trim curves in all loops.
    pub curves: usize,
    /// Largest distance on the surface of a trim curve from the pre-image of its edge; of a generated surface, its
    /// distance from its definition.
    pub deviation: f64,
    /// Largest distance of an edge from the surface: how well the file agrees with itself.
    pub gap: f64,
    /// The tolerance that the file states for this face.
    pub tolerance: f64,
    /// What was repaired or is ambiguous; for a face that was left out, why.
    pub notes: Vec<String>,
}

impl Place {
    /// The line and the entity's number, where there are any.
    pub fn numbers(self) -> (Option<usize>, Option<u32>) {
        match self {
            Self::File => (None, None),
            Self::Line(line) => (Some(line), None),
            Self::Entity { id, line } => (Some(line), Some(id)),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Place::File => write!(f, "{}: {}", self.file, self.message)?,
            Place::Line(line) => write!(f, "{}:{line}: {}", self.file, self.message)?,
            Place::Entity { id, line } => write!(f, "{}:{line}: #{id}: {}", self.file, self.message)?,
        }
        if self.count > 1 {
            write!(f, " (and {} more of this kind)", self.count - 1)?;
        }
        Ok(())
    }
}

/// The kind of warning of a face that lacks a loop: a hole is filled, or a border gone.
pub(crate) const LOOP_LOST: &str = "loop left out";

/// Warnings of each kind that are kept one by one; later ones only count.
const KEPT_PER_KIND: usize = 10;

/// The kind of warning that costs a face, which [`ImportReport::dropped`] counts.
pub(crate) const FACE_LOST: &str = "face left out";

/// What a kind of warning means for the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Loss {
    /// The model lacks something that the file states.
    LeftOut,
    /// The file hides it, or it is nothing that can be drawn.
    Beside,
    /// Nothing is lost.
    None,
}

impl Loss {
    /// By the end of the kind: `... left out` and `... not drawn` are losses by their names. Other losses are listed.
    fn of(kind: &str) -> Self {
        const OTHERS: [&str; 16] = [
            "card skipped",
            "cards missing",
            "entity without parameters",
            "external block not followed",
            "file cut short",
            "mapped item ignored",
            "not decoded",
            "parameter vertex not read",
            "record skipped",
            "record without end",
            "relationship ignored",
            "representation ignored",
            "statement not read",
            "subdivision surface not read",
            "truncated",
            "vertex not read",
        ];
        if kind == FACE_LOST {
            Self::None
        } else if kind.ends_with("left out") || OTHERS.contains(&kind) {
            Self::LeftOut
        } else if kind.ends_with("not drawn") || kind.ends_with("not placed") {
            Self::Beside
        } else {
            Self::None
        }
    }
}

/// Collects the warnings of one file.
#[derive(Debug)]
pub(crate) struct Warnings {
    file: String,
    list: Vec<Warning>,
    /// Kind: occurrences so far, index of the last kept warning.
    kinds: BTreeMap<&'static str, (usize, usize)>,
    /// All warnings of the kinds that mean a loss.
    missing: BTreeMap<&'static str, Reasons>,
}

impl Warnings {
    pub fn new(file: &str) -> Self {
        Self { file: file.to_owned(), list: Vec::new(), kinds: BTreeMap::new(), missing: BTreeMap::new() }
    }

    /// Adds one warning; `place` and `message` are made only if they are kept.
    pub fn push(&mut self, kind: &'static str, place: impl FnOnce() -> Place, message: impl FnOnce() -> String) {
        let (count, last) = self.kinds.entry(kind).or_insert((0, 0));
        *count += 1;
        let kept = *count <= KEPT_PER_KIND;
        let missing = Loss::of(kind) != Loss::None;
        if !kept {
            self.list[*last].count += 1;
        }
        if !kept && !missing {
            return;
        }
        let message = message();
        if missing {
            self.missing.entry(kind).or_default().add(&message);
        }
        if !kept {
            return;
        }
        *last = self.list.len();
        let message = format!("{kind}: {message}");
        self.list.push(Warning { file: self.file.clone(), place: place(), message, count: 1 });
    }

    /// The warnings; adds their counts to the report, by kind, and the losses by reason.
    pub fn finish(self, report: &mut ImportReport) -> Vec<Warning> {
        for (kind, (count, _)) in self.kinds {
            *report.warnings.entry(kind.to_owned()).or_default() += count;
        }
        for (kind, reasons) in self.missing {
            if Loss::of(kind) == Loss::LeftOut {
                report.left_out.entry(kind.to_owned()).or_default().extend(&reasons);
                continue;
            }
            let what = kind.trim_end_matches("not drawn").trim_end_matches("not placed").trim_end_matches([' ', ',']);
            for (why, count) in reasons.iter() {
                *report.ignored.entry(format!("{what} ({why})")).or_default() += count;
            }
        }
        self.list
    }
}

impl ImportReport {
    /// Records a face that was built, and returns the face.
    pub(crate) fn record(&mut self, record: FaceRecord, built: BuiltFace) -> Face {
        let BuiltFace { face, mut notes, deviation, gap, lost } = built;
        notes.extend(lost);
        self.deviation = self.deviation.max(deviation);
        self.gap = self.gap.max(gap);
        self.sloppy += usize::from(gap > record.tolerance);
        let (u, v) = face.surface.degrees();
        self.face_records.push(FaceRecord {
            kind: Some(face.kind),
            degree: [u, v],
            rational: !face.surface.is_polynomial(),
            loops: face.loops.len(),
            curves: face.loops.iter().map(|l| l.curves().len()).sum(),
            deviation,
            gap,
            notes,
            ..record
        });
        face
    }

    /// The same for a generated surface, whose deviation is the distance from its definition.
    #[cfg(feature = "scene")]
    pub(crate) fn record_made(
        &mut self,
        record: FaceRecord,
        face: Face,
        (deviation, notes): (f64, Vec<String>),
    ) -> Face {
        self.made = self.made.max(deviation);
        let curves = self.deviation;
        let face = self.record(record, BuiltFace { face, notes, deviation, gap: 0.0, lost: Vec::new() });
        self.deviation = curves;
        face
    }

    /// Adds the report of a file that holds parts of this one; its parts begin at `part`. Format, writer and
    /// occurrences of the whole model stay.
    pub(crate) fn absorb(&mut self, other: Self, part: usize) {
        let Self {
            format: _, written_by: _, occurrences: _, units, external_files, missing_files, face_records, ..
        } = other;
        for (sum, more) in [
            (&mut self.bodies, other.bodies),
            (&mut self.edges, other.edges),
            (&mut self.faces, other.faces),
            (&mut self.meshes, other.meshes),
            (&mut self.pcurves, other.pcurves),
            (&mut self.irregular, other.irregular),
            (&mut self.sloppy, other.sloppy),
        ] {
            *sum += more;
        }
        for (most, more) in
            [(&mut self.deviation, other.deviation), (&mut self.made, other.made), (&mut self.gap, other.gap)]
        {
            *most = most.max(more);
        }
        for (counts, more) in [
            (&mut self.nodes, other.nodes),
            (&mut self.warnings, other.warnings),
            (&mut self.ignored, other.ignored),
            (&mut self.layers, other.layers),
        ] {
            more.into_iter().for_each(|(name, count)| *counts.entry(name).or_default() += count);
        }
        self.dropped.extend(&other.dropped);
        self.repaired.extend(&other.repaired);
        other.left_out.iter().for_each(|(kind, why)| self.left_out.entry(kind.clone()).or_default().extend(why));
        self.files_read.extend(other.files_read);
        self.units.extend(units);
        self.units.sort();
        self.units.dedup();
        self.external_files.extend(external_files);
        self.missing_files.extend(missing_files);
        self.face_records.extend(face_records.into_iter().map(|r| FaceRecord { part: r.part + part, ..r }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_are_bounded_and_counted() {
        let mut warnings = Warnings::new("a.stp");
        for line in 0..1000 {
            warnings.push("record skipped", || Place::Line(line), || "bad".into());
        }
        warnings.push("face left out", || Place::Entity { id: 7, line: 3 }, || "no loop".into());
        let mut report = ImportReport::default();
        let list = warnings.finish(&mut report);
        let counts = report.warnings;
        assert_eq!(list.len(), KEPT_PER_KIND + 1);
        assert_eq!(list.iter().map(|w| w.count).sum::<usize>(), 1001);
        assert_eq!(counts["record skipped"], 1000);
        assert_eq!(list[KEPT_PER_KIND].to_string(), "a.stp:3: #7: face left out: no loop");
        assert!(list[KEPT_PER_KIND - 1].to_string().ends_with("(and 990 more of this kind)"));
    }

    /// All of them, not only the warnings that are kept; faces are counted by their own reasons.
    #[test]
    fn what_is_not_in_the_model_is_counted_by_reason() {
        let mut warnings = Warnings::new("a.stp");
        for line in 0..50 {
            warnings.push("body left out", || Place::Line(line), || format!("#{line} does not exist"));
        }
        warnings.push("blanked entity not drawn", || Place::File, || "type 144".into());
        warnings.push("hidden object not placed", || Place::File, || "lid".into());
        warnings.push("face repaired", || Place::File, || "turned".into());
        warnings.push(FACE_LOST, || Place::File, || "no loop".into());
        let mut report = ImportReport::default();
        warnings.finish(&mut report);
        let left_out: Vec<_> = report.left_out.iter().map(|(kind, why)| (kind.as_str(), why.total())).collect();
        assert_eq!(left_out, [("body left out", 50)]);
        assert_eq!(report.left_out["body left out"].iter().next(), Some(("… does not exist".to_owned(), 50)));
        let beside: Vec<_> = report.ignored.iter().map(|(what, count)| (what.as_str(), *count)).collect();
        assert_eq!(beside, [("blanked entity (type 144)", 1), ("hidden object (lid)", 1)]);
    }
}
