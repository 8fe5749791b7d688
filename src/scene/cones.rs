//! Cones of the outward normals of patches, of parts that hide whatever looks away ([`twin::cone`](crate::twin::cone)).
//!
//! That a part says of itself that it is closed does not do: files err, and a face that is inside out would be missing
//! from the picture. So what is taken for closed is
//!
//! ```text
//!   without trims     whose sides are all drawn with the vertices of others' (link.rs)        no gap to look through
//!   turned alike      along each shared curve as long one way as the other  ──▶│◀──          inside out all or none
//!   outwards          of a volume above 0, each connected piece by itself
//! ```

use crate::abi::{self, Link};
use crate::spline::{NormalCone, PatchGrid, SurfacePatch};
use glam::DVec3;

/// Triangles of a patch may be turned from its normals by about this, where sides with other numbers of segments meet.
const TURNED: f64 = 0.02;
/// A volume less than this share of what its parts add up to without their signs may be any.
const THIN: f64 = 0.01;
/// Of Gauss's rule of three points over 0 to 1.
const POINTS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// What a patch of a closed part without trims knows of its normals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Normals {
    /// Of the outward ones.
    cone: Option<NormalCone>,
    /// Of the pyramid from the part's origin to the patch, by its outward normals; by quadrature.
    volume: f64,
}

impl Normals {
    /// Of every patch of a face.
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

    /// As `twin::cone` wants it, of a part that reaches `radius` far from its origin.
    fn packed(&self, radius: f64) -> [f32; 4] {
        let cone = self.cone.filter(|cone| cone.sine + TURNED < 1.0);
        cone.map_or([0.0; 4], |cone| (cone.axis * radius).extend(cone.sine + TURNED).to_array().map(|x| x as f32))
    }
}

/// The cones of a part's patches, whose sides are all linked; `normals` begins with its first patch.
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

/// 1 where the border of a patch, with its outward normal on the left of whoever walks it seen from outside, runs along
/// the link's curve; else -1.
fn forwards(side: u32, flags: u32, link: &Link) -> f64 {
    let rises = matches!(side, 1 | 2); // v = 0 and u = 1 are walked towards larger parameters where S_u x S_v is outward
    let outward = flags & abi::FACE_SAME_SENSE != 0;
    if (rises == outward) != link.is_reversed() { 1.0 } else { -1.0 }
}

/// Which faces are connected: a forest of them.
struct Pieces {
    parents: Vec<usize>,
    /// Of roots.
    spoilt: Vec<bool>,
}

impl Pieces {
    fn new(faces: usize) -> Self {
        Self { parents: (0..faces).collect(), spoilt: vec![false; faces] }
    }

    /// The face that stands for the piece.
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
