//! The distance of a drawn picture from the true one, in pixels.
//!
//! ```text
//!   drawn id = true id at the pixel centre ................................ agree
//!   drawn face within `tie` of the true depth, there or up to limit_px away  tie
//!   the same within TOUCHING ties, where faces of two instances touch ..... tie
//!   true id = drawn id at an offset of s <= 2 px or limit_px, s the smallest  shift s
//!   none of these ......................................................... gross
//! ```
//!
//! *Touching parts.* Where faces of two instances coincide both are right, in face, depth and normal, and neither is
//! certainly before the other: a tie. A face within another part's face is seen nowhere but in the rim of the contact.
//! There, in a line, it is as near as the other two faces that meet. So it is right up to limit_px from that rim, at the
//! depth that it has there. Nothing else is excused: a face that ends before another part by more than the tolerance is
//! told from it.
//!
//! A picture keeps the accuracy promise when no shift exceeds `limit_px` and nothing is gross: every boundary then lies
//! within `limit_px` of its true place. Where ids agree, depth and normal are compared too. Two kinds of pixels would
//! make those numbers meaningless, and are counted separately:
//!
//! - *grazing* pixels, where the surface leans more than [`GRAZING_COSINE`] allows: there one pixel of
//!   shift is ten of depth. They count in `all`, not in `regular`.
//! - *folds*, where a face hides itself and a shifted silhouette shows its other sheet. A depth error
//!   of more than the slope explains starts the same search as a wrong id, for the drawn depth.
//!
//! `exact` is stricter, on *regular* surface: all rays up to [`SMOOTH_PX`] around the centre meet one sheet of one
//! face, which is nowhere grazing and turns by [`TURN`] at most. Elsewhere a shift within the limit may show another
//! sheet, or the normal may change by more within the last digits of a pixel; such pixels are only counted. The exact
//! surface alone decides whether a pixel is regular. It is tested only where the drawn one is off by more than
//! [`EXACT_DEPTH_PX`] or [`EXACT_NORMAL_DEG`]: all others are taken as regular.

mod report;
mod search;

pub use report::{Bin, Class, DepthErrors, Errors, Exactness, Folds, Judgement, Mismatch};

use super::{Hit, Probe, Tracer};
use crate::model::{Camera, Images};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use report::Tally;
use search::{Reach, Search, Wanted};
use std::f64::consts::FRAC_PI_4;

/// Shifts are searched for this far, pixels, and as far as a larger limit.
const LEAST_REACH_PX: f64 = 2.0;
/// Below this cosine between normal and ray a pixel is grazing: 84.3°, a slope of 10.
pub const GRAZING_COSINE: f64 = 0.1;
/// Largest depth error where the surface is regular, sides of a pixel.
pub const EXACT_DEPTH_PX: f64 = 0.1;
/// Largest error of a normal there, degrees.
pub const EXACT_NORMAL_DEG: f64 = 0.01;
/// How far around a pixel's centre regular surface must be one smooth sheet, pixels: beyond any shift within the limit.
pub const SMOOTH_PX: f64 = 1.0;
/// By how much its normal may turn within that, radians: a radius of curvature of ten pixels. A pixel's centre is known
/// to a thousandth of a pixel; the normal then to 0.006 degrees.
pub const TURN: f64 = 0.1;
/// Faces of different instances are one place within this many [ties](JudgeOptions::tie): 4e-6 of the diagonal by
/// default. Parts are placed by coordinates of six digits, as those of Boolean solids, whose faces are one within as much
/// ([`SurfaceTable::ROUNDED`](crate::model::SurfaceTable::ROUNDED)).
pub const TOUCHING: f64 = 4.0;
/// Normals of one mesh jump between triangles. A drawn normal off by more than this, radians, is also compared with the
/// normals beside the pixel's centre.
const SMOOTH: f64 = 1e-3;
/// How far beside, pixels: a rasteriser rounds corners to 1/256.
const FACET_PX: f64 = 1.0 / 128.0;
/// Pixels judged between two calls of the progress callback, and the unit of parallel work.
const CHUNK: usize = 1024;

/// The pixels to compare, and the limits.
#[derive(Clone, Copy)]
pub struct JudgeOptions<'a> {
    /// `None`: every pixel. `Some(n)`: about `n` stratified pixels, and every pixel beside a change of
    /// face id in the drawn picture.
    pub samples: Option<usize>,
    /// Largest shift that is right, pixels; the promise.
    pub limit_px: f64,
    /// Depth within which faces are indistinguishable, relative to the model's diagonal; [`TOUCHING`] times as much for
    /// faces of different instances.
    pub tie: f64,
    /// Pixels that may be searched for a shift, and as many again for a fold; the rest count as
    /// `unsearched`. A search costs up to some thousand rays, fifty thousand at a limit of 2 px or more, and
    /// a picture with more errors than this is wrong anyway.
    pub searches: usize,
    /// Wrong pixels listed, the worst first.
    pub listed: usize,
    /// Called with the number of pixels done since the last call, from any thread.
    pub progress: Option<&'a (dyn Fn(u64) + Sync)>,
}

impl Default for JudgeOptions<'_> {
    fn default() -> Self {
        Self { samples: None, limit_px: 0.5, tie: 1e-6, searches: 50_000, listed: 16, progress: None }
    }
}

/// A pixel that does not agree at its centre.
#[derive(Clone, Copy, Debug)]
struct Suspect {
    index: usize,
    truth: u32,
    wanted: Wanted,
    searched: bool,
}

/// One comparison: the constants of a judgement.
struct Bench<'a> {
    camera: &'a Camera,
    picture: &'a Images<'a>,
    /// The depth of a tie in model units.
    slack: f64,
    /// [`JudgeOptions::limit_px`].
    limit: f64,
}

/// Compares `picture`, drawn with `camera`, with `tracer`.
///
/// The result does not depend on the number of threads.
///
/// # Panics
/// When the picture does not have the camera's size, or has no face image.
pub fn judge(tracer: &Tracer, camera: &Camera, picture: &Images<'_>, options: &JudgeOptions) -> Judgement {
    let pixels = picture.size.0 as usize * picture.size.1 as usize;
    assert!(picture.size == camera.size && picture.face.len() == pixels, "picture and camera differ in size");
    let bench = Bench { camera, picture, slack: options.tie * tracer.bounds().diagonal(), limit: options.limit_px };
    let sampled = samples(picture.size, picture.face, options.samples);
    let progress = |done: usize| {
        if let Some(call) = options.progress {
            call(done as u64);
        }
    };
    let parts: Vec<(Tally, Vec<Suspect>)> = sampled
        .par_chunks(CHUNK)
        .map(|chunk| {
            let mut probe = tracer.probe(camera);
            let mut tally = Tally::default();
            let suspects = chunk.iter().filter_map(|&index| bench.look(&mut probe, index, &mut tally)).collect();
            progress(chunk.len());
            (tally, suspects)
        })
        .collect();
    let mut judgement = Judgement::new(picture.size, sampled.len() as u64, options.limit_px);
    let mut tally = Tally::default();
    let mut suspects = Vec::new();
    for (t, s) in parts {
        tally.merge(&t);
        suspects.extend(s);
    }
    ration(&mut suspects, options.searches);
    let reach = Reach::new(tracer, camera, options.limit_px, suspects.iter().map(|s| s.wanted.face));
    let search = |probe: &mut Probe, s: &Suspect| {
        let centre = bench.centre(s.index);
        if !reach.near(s.wanted.face, centre) {
            return Class::Gross;
        }
        if !s.searched {
            return Class::Unsearched;
        }
        let (limit, slack) = (options.limit_px, bench.slack);
        Search { probe, centre, wanted: s.wanted, limit, slack, touches: false }.run()
    };
    let verdicts: Vec<Class> =
        suspects.par_iter().map_init(|| tracer.probe(camera), |probe, s| search(probe, s)).collect();
    judgement.classes = vec![Class::Unsampled; pixels];
    for &index in &sampled {
        judgement.classes[index] = if picture.face[index] == 0 { Class::Background } else { Class::Agree };
    }
    for (s, &class) in suspects.iter().zip(&verdicts) {
        let class = judgement.enter(s.index, picture.face[s.index], s.truth, class, options.limit_px);
        judgement.classes[s.index] = class;
    }
    judgement.finish(tally, options.listed);
    judgement.given_up = tracer.given_up();
    judgement
}

/// Leaves at most `searches` wrong ids, and as many folds, to be searched: every k-th of either kind.
fn ration(suspects: &mut [Suspect], searches: usize) {
    for fold in [false, true] {
        let of_kind = |s: &Suspect| s.wanted.fold == fold;
        let count = suspects.iter().filter(|s| of_kind(s)).count();
        let stride = count.div_ceil(searches.max(1)).max(1);
        suspects.iter_mut().filter(|s| of_kind(s)).enumerate().for_each(|(k, s)| s.searched = k % stride == 0);
    }
}

impl Bench<'_> {
    fn centre(&self, index: usize) -> DVec2 {
        let w = self.picture.size.0 as usize;
        DVec2::new((index % w) as f64 + 0.5, (index / w) as f64 + 0.5)
    }

    /// Tallies an agreeing pixel; returns any other.
    fn look(&self, probe: &mut Probe, index: usize, tally: &mut Tally) -> Option<Suspect> {
        let centre = self.centre(index);
        let drawn_id = self.picture.face[index];
        let first = probe.first(centre);
        let truth = first.map_or(0, |h| h.face);
        if drawn_id != truth {
            let depth = self.picture.depth.get(index).map(|depth| f64::from(*depth));
            let wanted = Wanted { face: drawn_id, depth, fold: false };
            return Some(Suspect { index, truth, wanted, searched: true });
        }
        tally.agree += 1;
        let hit = first?;
        let (_, direction) = self.camera.ray(centre);
        let cosine = hit.normal.dot(direction).abs();
        let regular = cosine >= GRAZING_COSINE;
        let mut suspect = None;
        let mut off = [None; 2]; // depth in pixels, normal in degrees
        if let Some(&depth) = self.picture.depth.get(index) {
            let depth = f64::from(depth);
            let error = (depth - hit.depth).abs();
            let pixel = pixel_size(self.camera, hit.depth);
            let fold = error.is_nan() || error > fold_depth(self.camera, &hit, direction, reach_px(self.limit));
            tally.depth(index, error, pixel, regular && !fold);
            off[0] = Some(error / pixel);
            let wanted = Wanted { face: drawn_id, depth: Some(depth), fold };
            suspect = fold.then_some(Suspect { index, truth, wanted, searched: true });
        }
        if regular
            && suspect.is_none()
            && let Some(&n) = self.picture.normal.get(index)
        {
            let drawn = DVec3::new(f64::from(n[0]), f64::from(n[1]), f64::from(n[2]));
            let mut angle = angle_between(drawn, hit.normal);
            if angle > SMOOTH {
                // copies of one part that touch may have one number there
                let close = probe.within(centre, TOUCHING * self.slack).iter();
                let other = close.filter(|h| h.face == drawn_id && h.instance != hit.instance);
                angle = other.map(|h| angle_between(drawn, h.normal)).fold(angle, f64::min);
            }
            if hit.facet && angle > SMOOTH {
                let beside = beside(centre, FACET_PX).filter_map(|p| probe.first(p)).filter(|h| h.face == drawn_id);
                angle = beside.map(|h| angle_between(drawn, h.normal)).fold(angle, f64::min);
            }
            // faces of a spline part that is an operand have one id: an edge between them may be as far off as any
            // boundary
            if angle > SMOOTH && probe.on_spline_operand(&hit) {
                let ring = [0.25, 0.5, 1.0].into_iter().flat_map(|far| beside(centre, far * self.limit));
                let ring = ring.filter_map(|p| probe.first(p)).filter(|h| h.face == drawn_id);
                angle = ring.map(|h| angle_between(drawn, h.normal)).fold(angle, f64::min);
            }
            tally.normal.add(index, angle.to_degrees());
            off[1] = Some(angle.to_degrees());
        }
        if let [Some(depth_px), Some(normal_deg)] = off {
            let within = depth_px <= EXACT_DEPTH_PX && normal_deg <= EXACT_NORMAL_DEG;
            if within || self.is_smooth(probe, centre, &hit) {
                tally.exact(index, depth_px, normal_deg, within);
            } else {
                tally.irregular += 1;
            }
        } else {
            tally.irregular += u64::from(!regular || suspect.is_some());
        }
        suspect
    }

    /// The surface around `centre` is the sheet of `hit`, and turns little.
    fn is_smooth(&self, probe: &mut Probe, centre: DVec2, hit: &Hit) -> bool {
        beside(centre, SMOOTH_PX).all(|pixel| {
            let (origin, direction) = self.camera.ray(pixel);
            probe.first(pixel).is_some_and(|h| {
                let cosine = h.normal.dot(direction).abs();
                // the meeting point of the ray with the sheet's tangent plane, along the ray
                let flat = hit.normal.dot(hit.point - origin) / hit.normal.dot(direction);
                let apart = (flat - (h.point - origin).dot(direction)).abs();
                (h.face, h.instance) == (hit.face, hit.instance)
                    && cosine >= GRAZING_COSINE
                    && angle_between(h.normal, hit.normal) <= TURN
                    && apart <= fold_depth(self.camera, hit, direction, LEAST_REACH_PX)
            })
        })
    }
}

/// In radians. `atan2` keeps its digits near 0, where `acos` of a dot product has none.
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// Places around a pixel's centre at which a neighbouring triangle may have been drawn.
fn beside(centre: DVec2, far: f64) -> impl Iterator<Item = DVec2> {
    (0..8).map(move |k| centre + DVec2::from_angle(f64::from(k) * FRAC_PI_4) * far)
}

/// Shorter side of a pixel in model units at `depth`.
fn pixel_size(camera: &Camera, depth: f64) -> f64 {
    let focal = camera.focal_px().max_element();
    if camera.is_perspective() { depth / focal } else { 1.0 / focal }
}

/// How far around a pixel's centre shifts are searched for, pixels.
fn reach_px(limit: f64) -> f64 {
    limit.max(LEAST_REACH_PX)
}

/// The depth error that a shift of so many pixels explains on the hit's tangent plane (at least one
/// pixel's side): `shift_px tan(angle of normal and ray)`.
fn fold_depth(camera: &Camera, hit: &Hit, direction: DVec3, shift_px: f64) -> f64 {
    let cosine = hit.normal.dot(direction).abs().max(1e-6);
    let slope = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
    pixel_size(camera, hit.depth) * (shift_px * slope).max(1.0)
}

/// The pixels to examine, in raster order: about so many, and those beside which a value of `image` changes.
pub(super) fn samples(size: (u32, u32), image: &[u32], wanted: Option<usize>) -> Vec<usize> {
    let (w, h) = (size.0 as usize, size.1 as usize);
    let Some(n) = wanted else { return (0..w * h).collect() };
    let mut chosen = vec![false; w * h];
    let step = ((w * h) as f64 / n.max(1) as f64).sqrt().max(1.0);
    let mut cell = 0;
    let cells = |side: usize| (side as f64 / step).ceil() as usize;
    for j in 0..cells(h) {
        for i in 0..cells(w) {
            let (a, b) = jitter(cell);
            cell += 1;
            let x = ((i as f64 + a) * step) as usize;
            let y = ((j as f64 + b) * step) as usize;
            if x < w && y < h {
                chosen[y * w + x] = true;
            }
        }
    }
    let mut pair = |a: usize, b: usize| {
        if image[a] != image[b] {
            chosen[a] = true;
            chosen[b] = true;
        }
    };
    for y in 0..h {
        for x in 0..w {
            let here = y * w + x;
            if x + 1 < w {
                pair(here, here + 1);
            }
            if y + 1 < h {
                pair(here, here + w);
            }
        }
    }
    (0..w * h).filter(|&i| chosen[i]).collect()
}

/// Two numbers in `[0, 1)` from a counter. Source: G. L. Steele, D. Lea, C. H. Flood, *Fast splittable
/// pseudorandom number generators*, OOPSLA 2014 (SplitMix64).
fn jitter(cell: u64) -> (f64, f64) {
    let mut z = (cell + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    let unit = |x: u64| x as f64 / (1u64 << 32) as f64;
    (unit(z >> 32), unit(z & 0xFFFF_FFFF))
}
