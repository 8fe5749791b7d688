//! The summary of an import: the file's items, how many of them the model has, and why the rest is missing.

use super::{Import, ImportReport, Reasons};
use crate::model::{Model, Part, Shape};
use serde::Serialize;
use std::collections::{BTreeMap, HashSet};
use std::fmt;
use std::sync::Arc;

/// How many of one kind of thing, each counted once however often it is placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// The file states them.
    pub stated: usize,
    /// The model draws them.
    pub drawn: usize,
}

/// The result of reading a file, in counts.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Summary {
    /// Faces with a surface.
    pub faces: Tally,
    /// Triangle meshes.
    pub meshes: Tally,
    /// Boolean solids. One without any volume is not drawn; it is no loss, but counted in [`beside`](Self::beside).
    pub solids: Tally,
    /// Faces left out, by reason.
    pub lost_faces: Reasons,
    /// Everything else left out, by kind and reason: bodies, occurrences, polygons, unreadable statements, ...
    pub left_out: BTreeMap<String, Reasons>,
    /// Other files that the file names and that are not read: they may hold parts of the model.
    pub elsewhere: Vec<String>,
    /// Content of the file beside them that is not to be drawn, by kind: curves, hidden items, annotation.
    pub beside: BTreeMap<String, usize>,
}

/// Reasons and names that one sentence has of a kind; the rest is counted.
const MOST_LISTED: usize = 8;

impl Import {
    /// Counts what the model has of the file. The model counts as it is now: call this before changing it.
    #[must_use]
    pub fn summary(&self) -> Summary {
        Summary::of(&self.model, &self.report)
    }
}

impl Summary {
    fn of(model: &Model, report: &ImportReport) -> Self {
        let mut placed = vec![false; model.parts.len()];
        model.instances.iter().for_each(|instance| placed[instance.part] = true);
        let parts = || model.parts.iter().zip(&placed).filter(|(_, placed)| **placed).map(|(part, _)| part);
        // operands that several solids share count once
        let mut seen = HashSet::new();
        let operands: Vec<&Part> = model
            .solids
            .iter()
            .flat_map(|solid| solid.primitives())
            .filter_map(|primitive| if let Shape::Part(part) = &primitive.shape { Some(part) } else { None })
            .filter(|part| seen.insert(Arc::as_ptr(part)))
            .map(Arc::as_ref)
            .collect();
        let faces = parts().map(|p| p.faces.len()).chain(operands.iter().map(|p| p.faces.len())).sum();
        let meshes = parts().map(|p| p.meshes.len()).chain(operands.iter().map(|p| p.meshes.len())).sum();
        let solids = model.solids.iter().filter(|solid| !solid.bounds().is_empty()).count();
        let lost = |what: &str| -> usize {
            let of = report.left_out.iter().filter(|(kind, _)| kind.contains(what));
            of.map(|(_, reasons)| reasons.total()).sum()
        };
        let mut beside = report.ignored.clone();
        let stated = report.faces.max(faces + report.dropped.total());
        for (what, count) in [
            ("faces of parts that nothing places", stated - faces - report.dropped.total()),
            ("Boolean solids without any volume", model.solids.len() - solids),
        ] {
            if count > 0 {
                beside.insert(what.to_owned(), count);
            }
        }
        Self {
            faces: Tally { stated, drawn: faces },
            meshes: Tally { stated: meshes + lost("mesh") + lost("tessellated"), drawn: meshes },
            solids: Tally { stated: model.solids.len() + lost("solid"), drawn: solids },
            lost_faces: report.dropped.clone(),
            left_out: report.left_out.clone(),
            elsewhere: report.missing_files.clone(),
            beside,
        }
    }

    /// Nothing of the file can be drawn.
    #[must_use]
    pub fn draws_nothing(&self) -> bool {
        self.faces.drawn + self.meshes.drawn + self.solids.drawn == 0
    }

    /// Nothing that the file states is missing.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.lost_faces.is_empty() && self.left_out.is_empty() && self.elsewhere.is_empty()
    }

    /// The losses and their reasons, as the phrases of one sentence.
    fn losses(&self) -> Vec<String> {
        let mut all = Vec::new();
        if !self.lost_faces.is_empty() {
            all.push(format!("{} left out: {}", self.lost_faces.total(), told(self.lost_faces.iter())));
        }
        all.extend(self.left_out.iter().map(|(kind, why)| format!("{} x {kind}: {}", why.total(), told(why.iter()))));
        if !self.elsewhere.is_empty() {
            let named = |name: &String| if name.is_empty() { "one without a name".to_owned() } else { name.clone() };
            let names = listed(self.elsewhere.iter().map(named), self.elsewhere.len());
            all.push(format!("other files not read: {names}"));
        }
        all
    }
}

/// One sentence without its full stop: `drawn 82 of 94 faces; 12 left out: …`, or the file's content where nothing of
/// it can be drawn.
impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tallies = [
            (self.faces, "face", "faces"),
            (self.meshes, "mesh", "meshes"),
            (self.solids, "Boolean solid", "Boolean solids"),
        ];
        let counts: Vec<String> = tallies
            .iter()
            .filter(|(tally, ..)| tally.stated > 0)
            .map(|(Tally { stated, drawn }, one, several)| {
                let what = if *stated == 1 { one } else { several };
                if stated == drawn { format!("{drawn} {what}") } else { format!("{drawn} of {stated} {what}") }
            })
            .collect();
        let mut clauses = Vec::new();
        if self.draws_nothing() {
            clauses.push("nothing of it can be drawn".to_owned());
            clauses.extend(self.losses());
            if !self.beside.is_empty() {
                let beside = self.beside.iter().map(|(kind, count)| (kind.clone(), *count));
                clauses.push(format!("it holds {}", told(beside)));
            } else if clauses.len() == 1 {
                clauses.push("it holds no surface, mesh or solid".to_owned());
            }
        } else {
            clauses.push(format!("drawn {}", counts.join(", ")));
            clauses.extend(self.losses());
        }
        f.write_str(&clauses.join("; "))
    }
}

/// `3 x this, 1 x that`, the most frequent first.
fn told(counts: impl Iterator<Item = (String, usize)>) -> String {
    let mut all: Vec<_> = counts.collect();
    all.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let more = all.len();
    listed(all.into_iter().map(|(what, count)| format!("{count} x {what}")), more)
}

/// The first few, and how many there are beside.
fn listed(all: impl Iterator<Item = String>, count: usize) -> String {
    let mut list: Vec<String> = all.take(MOST_LISTED).collect();
    if count > list.len() {
        list.push(format!("and {} others", count - list.len()));
    }
    list.join(", ")
}

#[cfg(test)]
mod tests {
    use crate::import::{Facets, Import, brlcad, bv, obj, scad, step};

    fn told(import: &Import) -> String {
        import.summary().to_string()
    }

    const PATCH: &str = "4\n1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";

    #[test]
    fn a_whole_file_is_complete() {
        let good = step(include_bytes!("step/tests/good.step"), "good.step").unwrap();
        assert!(good.summary().is_complete() && !good.summary().draws_nothing());
        assert_eq!(told(&good), "drawn 3 faces");
        assert_eq!(told(&obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "t.obj", None).unwrap()), "drawn 1 mesh");
        assert_eq!(told(&scad(b"sphere(1);", "t.csg", Facets::Round).unwrap()), "drawn 1 Boolean solid");
    }

    /// One damaged patch beside a whole one, in every format whose faces stand alone; then nothing but the damaged one.
    #[test]
    fn what_is_left_out_is_counted_with_its_reason() {
        let reason = "degree 16 is not between 1 and 15";
        let damaged = format!("5\n16 1\n{}", "0 0 0\n".repeat(34));
        let some = bv(format!("{PATCH}{damaged}{PATCH}{damaged}").as_bytes(), "t.bv").unwrap();
        let summary = some.summary();
        assert_eq!((summary.faces.stated, summary.faces.drawn), (4, 2));
        assert!(!summary.is_complete() && !summary.draws_nothing());
        assert_eq!(told(&some), format!("drawn 2 of 4 faces; 2 left out: 2 x {reason}"));
        let none = bv(damaged.as_bytes(), "t.bv").unwrap();
        assert!(none.summary().draws_nothing());
        assert_eq!(told(&none), format!("nothing of it can be drawn; 1 left out: 1 x {reason}"));

        let good = include_str!("step/tests/good.step");
        let cut = good.replacen("CYLINDRICAL_SURFACE('',#24,5.)", "CYLINDRICAL_SURFACE('',#24,0.)", 1);
        let some = told(&step(cut.as_bytes(), "t.step").unwrap());
        assert_eq!(some, "drawn 2 of 3 faces; 1 left out: 1 x attribute 2 is not a length other than 0");

        let some = obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n", "t.obj", None).unwrap();
        assert!(told(&some).starts_with("drawn 1 mesh; 1 x polygon left out: 1 x "), "{}", told(&some));
    }

    /// Solids without volume are no loss, but nothing is drawn.
    #[test]
    fn empty_solids_are_not_drawn() {
        let apart = scad(
            b"intersection() { cube(1); multmatrix([[1,0,0,9],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); } }",
            "t.csg",
            Facets::Round,
        );
        let summary = apart.unwrap().summary();
        assert!(summary.draws_nothing() && summary.is_complete());
        assert_eq!(summary.to_string(), "nothing of it can be drawn; it holds 1 x Boolean solids without any volume");
        let nothing = scad(b"", "t.csg", Facets::Round).unwrap().summary();
        assert_eq!(nothing.to_string(), "nothing of it can be drawn; it holds no surface, mesh or solid");
        assert!(brlcad(b"title {t}\n", "t.asc").unwrap().summary().draws_nothing());
    }

    /// Files of lines, of hidden items, of parts in other files.
    #[test]
    fn contents_other_than_surfaces_are_reported() {
        let around = |data: &str| {
            format!("ISO-10303-21;HEADER;FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;DATA;{data}ENDSEC;END-ISO-10303-21;")
        };
        let of_step = |data: &str| told(&step(around(data).as_bytes(), "t.step").unwrap());
        let lines = "#1=CARTESIAN_POINT('',(0.,0.,0.));#2=DIRECTION('',(1.,0.,0.));#3=VECTOR('',#2,1.);#4=LINE('',#1,#3);\
                     #5=GEOMETRIC_CURVE_SET('',(#4));#6=SHAPE_REPRESENTATION('',(#5),#7);#7=REPRESENTATION_CONTEXT('','');";
        assert_eq!(of_step(lines), "nothing of it can be drawn; it holds 1 x GEOMETRIC_CURVE_SET");
        let hidden = "#6=SHAPE_REPRESENTATION('',(#5),#7);#7=REPRESENTATION_CONTEXT('','');#5=OPEN_SHELL('',());\
                      #8=INVISIBILITY((#5));";
        assert_eq!(of_step(hidden), "nothing of it can be drawn; it holds 1 x hidden bodies");
    }

    /// Messages with numbers of their own keep them; a reason of one message is that message.
    #[test]
    fn reasons_have_no_holes() {
        let good = include_str!("step/tests/good.step");
        let cone = |semi: &str| format!("CONICAL_SURFACE('',#24,5.,{semi})");
        let cut = good.replacen("CYLINDRICAL_SURFACE('',#24,5.)", &cone("100."), 1);
        let import = step(cut.as_bytes(), "t.step").unwrap();
        let (reason, _) = import.report.dropped.iter().next().expect("the cone is left out");
        assert_eq!(reason, "a cone needs an angle other than 0 and below a right one");
    }
}
