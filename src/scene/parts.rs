//! Makes the faces of placed parts in parallel, and passes them on in order.
//!
//! ```text
//!   parts      A   B   C   A'  D   B'        A' equals A except for numbers and colours: its faces are copied
//!   batches   └─────────────┘ └──────┘       made in parallel, then passed on; only faces needed again are stored
//! ```

use super::face::{Body, Cuts, FaceData, Trimming};
use crate::model::{Face, Items, Model, Part};
use glam::DVec3;
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::HashMap;

/// Faces in a batch: enough work for all threads, and little memory compared with a large scene.
const BATCH: usize = 4096;

/// Progress callback: the number of faces made since the last call, which is 0 between other steps. It runs on several
/// threads, in no order, and may unwind.
pub(crate) type Told<'a> = &'a (dyn Fn(usize) + Sync);

/// A part, and the other inputs of its faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedPart<'a> {
    /// The part's number in its model.
    pub number: usize,
    pub part: &'a Part,
    pub origin: DVec3,
    pub body: Body,
    pub trim: Trimming,
    pub cuts: Cuts,
}

impl PlacedPart<'_> {
    fn made(&self, told: Told<'_>) -> Vec<FaceData> {
        let Self { part, origin, body, trim, cuts, .. } = *self;
        let made = |face| {
            let made = FaceData::new(face, origin, body, trim, cuts);
            told(1);
            made
        };
        part.faces.par_iter().map(made).collect()
    }

    /// The faces of an equal part, with this part's numbers and colours.
    fn named(&self, mut faces: Vec<FaceData>) -> Vec<FaceData> {
        faces.iter_mut().zip(&self.part.faces).for_each(|(made, face)| made.name(face));
        faces
    }

    /// A cheap hash: equal parts have equal keys.
    fn key(&self) -> [u64; 5] {
        let points = self.part.faces.iter().map(|face| face.surface.points().len()).sum::<usize>();
        let [x, y, z] = self.origin.to_array().map(|x| (x + 0.0).to_bits());
        [self.part.faces.len() as u64, points as u64, x, y, z]
    }

    /// Whether both parts give equal faces, except for numbers, colours and the signs of zeros.
    fn is_like(&self, other: &Self) -> bool {
        let same = |(a, b): (&Face, &Face)| {
            a.kind == b.kind && a.same_sense == b.same_sense && a.surface == b.surface && a.loops == b.loops
        };
        (self.origin, self.body, self.trim, self.cuts) == (other.origin, other.body, other.trim, other.cuts)
            && self.part.faces.len() == other.part.faces.len()
            && self.part.faces.iter().zip(&other.part.faces).all(same)
    }
}

/// The first part that each part equals; mostly the part itself.
fn alike(parts: &[PlacedPart<'_>]) -> Vec<usize> {
    let mut firsts: HashMap<[u64; 5], Vec<usize>> = HashMap::new();
    let first = |(n, part): (usize, &PlacedPart<'_>)| {
        let known = firsts.entry(part.key()).or_default();
        let like = known.iter().copied().find(|&first| parts[first].is_like(part));
        like.unwrap_or_else(|| {
            known.push(n);
            n
        })
    };
    parts.iter().enumerate().map(first).collect()
}

/// Makes the faces of all parts and passes each part's to `take`, in order. Calls `told` with the number of new faces.
pub(super) fn each_made(
    parts: &[PlacedPart<'_>],
    told: Told<'_>,
    mut take: impl FnMut(&PlacedPart<'_>, Vec<FaceData>),
) {
    let like = alike(parts);
    let mut to_come = vec![0usize; parts.len()];
    like.iter().enumerate().filter(|(n, first)| n != *first).for_each(|(_, &first)| to_come[first] += 1);
    let mut kept: HashMap<usize, Vec<FaceData>> = HashMap::new();
    let mut start = 0;
    while start < parts.len() {
        let mut faces = 0;
        let some = parts[start..].iter().zip(&like[start..]).enumerate().take_while(|(n, (part, first))| {
            let room = faces < BATCH;
            faces += if **first == start + n { part.part.faces.len() } else { 0 };
            room
        });
        let end = start + some.count();
        let made: Vec<_> = (start..end).into_par_iter().map(|n| (like[n] == n).then(|| parts[n].made(told))).collect();
        for (n, made) in (start..end).zip(made) {
            let first = like[n];
            let faces = match made {
                Some(faces) if to_come[n] > 0 => {
                    kept.insert(n, faces.clone());
                    faces
                }
                Some(faces) => faces,
                None => {
                    to_come[first] -= 1;
                    let faces = if to_come[first] > 0 { kept.get(&first).cloned() } else { kept.remove(&first) };
                    told(parts[n].part.faces.len());
                    parts[n].named(faces.expect("it is kept for those that are like it"))
                }
            };
            // putting a large part in place takes long
            told(0);
            take(&parts[n], faces);
        }
        start = end;
    }
}

/// The model without the instances that are drawn as solids.
pub(super) fn drawn_as_faces<'a>(model: &'a Model, items: Option<&Items>) -> Cow<'a, Model> {
    let mut model = Cow::Borrowed(model);
    if let Some(items) = items.filter(|items| items.drawn.contains(&false)) {
        let mut drawn = items.drawn.iter();
        model.to_mut().instances.retain(|_| drawn.next() == Some(&true));
    }
    model
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::picture::TakenWay;
    use bytemuck::{bytes_of, cast_slice};
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn bracket() -> Model {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/bracket.step");
        selvedge_io::import::open(&path).unwrap().model
    }

    /// The bracket, a shorter one, and copies of both with other numbers and colours.
    fn pairs() -> Model {
        let mut model = bracket();
        let whole = model.parts[0].clone();
        let mut short = whole.clone();
        short.faces.pop();
        let renamed = |part: &Part| {
            let mut part = part.clone();
            for face in &mut part.faces {
                (face.id, face.colour) = (face.id + 1000, Some([0.1, 0.2, 0.3, 1.0]));
            }
            part
        };
        model.parts = vec![whole.clone(), short.clone(), renamed(&whole), renamed(&short), renamed(&whole)];
        model
    }

    fn placed(part: &Part, way: TakenWay) -> PlacedPart<'_> {
        let trim = Trimming { way, smooth: false, editable: false, extent: 100.0 };
        PlacedPart { number: 0, part, origin: DVec3::new(0.0, 1.0, 2.0), body: Body::Closed, trim, cuts: Cuts::Any }
    }

    /// A part that equals another gets the faces that it would have by itself, with its own numbers and colours.
    #[test]
    fn parts_that_are_alike_have_the_faces_that_each_would_have() {
        for way in [TakenWay::Table, TakenWay::Exact] {
            let model = pairs();
            let parts: Vec<_> = model.parts.iter().map(|part| placed(part, way)).collect();
            let mut taken = 0;
            let told = AtomicUsize::new(0);
            let tell = |n| {
                let _ = told.fetch_add(n, Ordering::Relaxed);
            };
            each_made(&parts, &tell, |part, faces| {
                assert!(std::ptr::eq(part.part, parts[taken].part), "in order");
                taken += 1;
                let own = part.made(&|_| ());
                assert_eq!(faces.len(), own.len());
                for (a, b) in faces.iter().zip(&own) {
                    assert_eq!(bytes_of(&a.face), bytes_of(&b.face));
                    assert_eq!(cast_slice::<_, u8>(&a.patches), cast_slice::<_, u8>(&b.patches));
                    assert_eq!((&a.points, &a.outside, &a.curve_points), (&b.points, &b.outside, &b.curve_points));
                    assert_eq!(cast_slice::<_, u8>(&a.cells), cast_slice::<_, u8>(&b.cells));
                    assert_eq!(cast_slice::<_, u8>(&a.curves), cast_slice::<_, u8>(&b.curves));
                    assert_eq!(a.exact, b.exact);
                }
            });
            assert_eq!(taken, 5);
            assert_eq!(told.into_inner(), model.face_count());
        }
    }

    #[test]
    fn a_callback_ends_it_before_a_part_is_passed_on() {
        let model = pairs();
        let parts: Vec<_> = model.parts.iter().map(|part| placed(part, TakenWay::Exact)).collect();
        let (mut taken, calls) = (0, AtomicUsize::new(0));
        let tell = |n: usize| {
            if n == 0 && calls.fetch_add(1, Ordering::Relaxed) == 2 {
                std::panic::resume_unwind(Box::new(()));
            }
        };
        let work = std::panic::AssertUnwindSafe(|| each_made(&parts, &tell, |_, _| taken += 1));
        assert!(std::panic::catch_unwind(work).is_err());
        assert_eq!(taken, 2, "of {}", parts.len());
    }

    #[test]
    fn what_differs_in_anything_is_not_alike() {
        let model = pairs();
        let parts: Vec<_> = model.parts.iter().map(|part| placed(part, TakenWay::Table)).collect();
        assert_eq!(alike(&parts), [0, 1, 0, 1, 0]);
        let mut others = vec![parts[0]; 6];
        others[1].origin.x = 1e-300;
        others[2].body = Body::Open;
        others[3].trim.extent = 2.0;
        others[4].cuts = Cuts::Halves;
        let mut turned = model.parts[0].clone();
        turned.faces[0].same_sense ^= true;
        others[5].part = &turned;
        assert_eq!(alike(&others), [0, 1, 2, 3, 4, 5]);
        let mut moved = model.parts[0].clone();
        let face = moved.faces.iter_mut().find(|f| !f.loops.is_empty()).unwrap();
        face.loops[0] = face.loops[0].translated(glam::DVec2::new(1e-12, 0.0)).unwrap();
        assert_eq!(alike(&[parts[0], placed(&moved, TakenWay::Table)]), [0, 1]);
    }
}
