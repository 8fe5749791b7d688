//! Cones of the outward normals of patches, for parts whose far side is hidden ([`twin::cone`](crate::twin::cone)).
//!
//! A file's statement that a part is closed is not enough. It may be wrong, and a face turned inside out would be
//! missing from the picture. A part is taken as closed only if it passes these tests:
//!
//! ```text
//!   no gaps       no face is trimmed, and every side is linked to another side (link.rs)
//!   one sense     the two faces at a shared curve run along it in opposite directions ──▶│◀──
//!   outwards      each connected piece has a volume above 0
//! ```

use crate::abi::{self, Link};
use crate::spline::{NormalCone, PatchGrid, SurfacePatch};
use glam::DVec3;

/// Sine of the angle by which a triangle may be turned from its patch's normals, where two sides with different numbers
/// of segments meet.
const TURNED: f64 = 0.02;
/// A volume smaller than this share of the sum of its terms' magnitudes has no certain sign.
const THIN: f64 = 0.01;
/// Points and weights of Gauss's rule of three points over 0 to 1.
const POINTS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// The normals of one patch of a closed part without trims.
#[derive(Clone, Copy, Debug)]
pub(super) struct Normals {
    /// The cone of the outward normals.
    cone: Option<NormalCone>,
    /// The signed volume of the pyramid from the part's origin to the patch, positive for outward normals, by
    /// quadrature.
    volume: f64,
}

impl Normals {
    /// The normals of every patch of a face.
    pub(super) fn of(grid: &PatchGrid, same_sense: bool, origin: DVec3) -> Vec<Self> {
        let outward = if same_sense { 1.0 } else { -1.0 };
        let normals = |p: &SurfacePatch| {
            let at = |(u, v): (f64, f64)| {
                let jet = p.patch.jet(u, v);
                (jet.point - origin).dot(jet.du.cross(jet.dv)) / 3.0
            };
            let pairs = POINTS.iter().flat_map(|&(v, b)| POINTS.map(|(u, a)| ((u, v), a * b)));
            Self {
                cone: p.patch.normal_cone().map(|c| NormalCone { axis: c.axis * outward, ..c }),
                volume: outward * pairs.map(|(uv, weight)| at(uv) * weight).sum::<f64>(),
            }
        };
        grid.patches.iter().map(normals).collect()
    }

    /// The four numbers that `twin::cone` reads, for a part within `radius` of its origin.
    fn packed(&self, radius: f64) -> [f32; 4] {
        let cone = self.cone.filter(|cone| cone.sine + TURNED < 1.0);
        cone.map_or([0.0; 4], |cone| (cone.axis * radius).extend(cone.sine + TURNED).to_array().map(|x| x as f32))
    }
}

/// The cones of a part's patches. All sides must be linked; `normals` begins with the part's first patch.
pub(super) fn cones(faces: &[abi::Face], links: &[Link], normals: &[Normals], radius: f64) -> Vec<[f32; 4]> {
    let Some(first) = faces.first().map(|f| f.first_patch) else { return Vec::new() };
    let patches =
        |f: &abi::Face| (f.first_patch - first) as usize..(f.first_patch - first + f.count_u * f.count_v) as usize;
    let mut face_of = vec![0; normals.len()];
    faces.iter().enumerate().for_each(|(n, f)| face_of[patches(f)].fill(n));
    let mut pieces = Pieces::new(faces.len());
    let of_part = 4 * first as usize..4 * (first as usize + normals.len());
    for name in of_part.filter(|&name| links.get(name).is_some_and(Link::is_shared)) {
        let face = |name: u32| face_of[(name / 4 - first) as usize];
        let mut turns = 0.0;
        let mut at = name as u32;
        loop {
            let link = &links[at as usize];
            turns += forwards(at % 4, faces[face(at)].flags, link) / f64::from(1u32 << link.halvings());
            pieces.join(face(name as u32), face(at));
            at = link.next;
            if at == name as u32 {
                break;
            }
        }
        if turns != 0.0 {
            pieces.spoil(face(name as u32));
        }
    }
    let mut volumes = vec![(0.0, 0.0); faces.len()];
    for (normals, &face) in normals.iter().zip(&face_of) {
        let (sum, all): &mut (f64, f64) = &mut volumes[pieces.of(face)];
        (*sum, *all) = (*sum + normals.volume, *all + normals.volume.abs());
    }
    let radius = radius * (1.0 + f64::from(f32::EPSILON));
    let mut packed = vec![[0.0; 4]; normals.len()];
    for (face, range) in faces.iter().map(patches).enumerate() {
        let (sum, all) = volumes[pieces.of(face)];
        if !pieces.is_spoilt(face) && sum > THIN * all {
            range.for_each(|n| packed[n] = normals[n].packed(radius));
        }
    }
    packed
}

/// Direction of a patch's border along the link's curve, walked with the outward normal up and the patch on the left: 1
/// if it is the curve's own direction, else -1.
fn forwards(side: u32, flags: u32, link: &Link) -> f64 {
    let rises = matches!(side, 1 | 2); // counter-clockwise about S_u x S_v
    let outward = flags & abi::FACE_SAME_SENSE != 0;
    if (rises == outward) != link.is_reversed() { 1.0 } else { -1.0 }
}

/// A union-find forest of connected faces.
struct Pieces {
    parents: Vec<usize>,
    /// Whether a piece fails one of the tests; valid for roots.
    spoilt: Vec<bool>,
}

impl Pieces {
    fn new(faces: usize) -> Self {
        Self { parents: (0..faces).collect(), spoilt: vec![false; faces] }
    }

    /// The root of the face's piece.
    fn of(&mut self, mut face: usize) -> usize {
        while self.parents[face] != face {
            self.parents[face] = self.parents[self.parents[face]];
            face = self.parents[face];
        }
        face
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.parents[b] = a;
        self.spoilt[a] |= self.spoilt[b];
    }

    fn spoil(&mut self, face: usize) {
        let root = self.of(face);
        self.spoilt[root] = true;
    }

    fn is_spoilt(&mut self, face: usize) -> bool {
        let root = self.of(face);
        self.spoilt[root]
    }
}
