//! The result of a judgement: counts, the largest errors and their places, and a picture of them.

use super::{LEAST_REACH_PX, reach_px};
use serde::Serialize;

/// Upper ends of the shift histogram, pixels. A larger limit is one more.
const BINS: [f64; 9] = [0.0625, 0.125, 0.1875, 0.25, 0.375, 0.5, 1.0, 1.5, LEAST_REACH_PX];

/// The verdict on one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Class {
    /// Not examined.
    Unsampled,
    /// The face is right.
    Agree,
    /// No surface there, rightly.
    Background,
    /// Two faces at the same depth, and the other one was drawn.
    Tie,
    /// Right at this distance in pixels.
    Shift(f64),
    /// Right, and farther away than the limit.
    Far(f64),
    /// The right face; its drawn depth is right at this distance in pixels.
    Fold(f64),
    /// The right face at a depth that it has nowhere within 2 px or a larger limit.
    WrongDepth,
    /// The drawn face is not within 2 px or a larger limit.
    Gross,
    /// Wrong at its centre; there were too many to search for the distance.
    Unsearched,
}

/// Mean and worst error, and the place of the worst.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Errors {
    /// Pixels compared.
    pub count: u64,
    /// Arithmetic mean.
    pub mean: f64,
    /// Largest.
    pub worst: f64,
    /// Pixel of the largest: column, row.
    pub worst_at: [u32; 2],
}

/// Depth errors of one set of pixels in two units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DepthErrors {
    /// Model units.
    pub model: Errors,
    /// Sides of a pixel at that depth.
    pub px: Errors,
}

/// Pixels whose face hides itself: right id, other sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Folds {
    /// Right within `limit_px`.
    pub shifted: u64,
    /// Right, but farther away.
    pub beyond: u64,
    /// The drawn depth occurs nowhere within 2 px or a larger limit.
    pub wrong_depth: u64,
    /// Not searched: more than `searches`.
    pub unsearched: u64,
    /// Largest distance, pixels.
    pub worst_shift_px: f64,
}

/// Errors of the picture where the exact surface is regular ([`judge`](super::judge)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Exactness {
    /// Depth, sides of a pixel at that depth.
    pub depth_px: Errors,
    /// Angle between the normals, degrees; as many pixels.
    pub normal_deg: Errors,
    /// Of these, pixels off by more than [`EXACT_DEPTH_PX`](super::EXACT_DEPTH_PX) or
    /// [`EXACT_NORMAL_DEG`](super::EXACT_NORMAL_DEG).
    pub beyond: u64,
    /// Pixels with the right face where it is not regular: they are not compared here.
    pub irregular: u64,
}

/// One bar of the shift histogram.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bin {
    /// Shifts up to this, and above the bar before, pixels.
    pub up_to_px: f64,
    /// The number of pixels.
    pub pixels: u64,
}

/// A pixel that is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mismatch {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Face id drawn, 0 for background.
    pub drawn: u32,
    /// Face id at the pixel centre.
    pub truth: u32,
    /// Distance at which the drawn id is right, pixels; `None` when it is not known.
    pub shift_px: Option<f64>,
    /// There is no such distance within 2 px or a larger limit; `false` with `shift_px` unknown: not searched for.
    pub gross: bool,
}

/// The comparison of a picture with the truth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judgement {
    /// Picture size in pixels.
    pub size: (u32, u32),
    /// Pixels compared; the sum of `agree`, `ties`, the histogram, `gross` and `unsearched`.
    pub sampled: u64,
    /// Same face id.
    pub agree: u64,
    /// Another face at the same depth.
    pub ties: u64,
    /// Shifts of the others.
    pub shifts: Vec<Bin>,
    /// Pixels whose drawn id is not right within 2 px or a larger limit.
    pub gross: u64,
    /// Pixels with another id that were not searched: more errors than `searches`.
    pub unsearched: u64,
    /// Shift above the limit, or gross, or unsearched: 0 in a picture that keeps its promise.
    pub wrong: u64,
    /// Largest shift found, pixels.
    pub worst_shift_px: f64,
    /// The first few wrong pixels: gross ones, then by shift, then those not
    /// searched; each in raster order.
    pub mismatches: Vec<Mismatch>,
    /// Depth where ids agree and the surface is neither grazing nor folded.
    pub depth_regular: DepthErrors,
    /// Depth wherever ids agree.
    pub depth_all: DepthErrors,
    /// Angle between drawn and true normal in degrees, where `depth_regular` counts. On a spline part that is an
    /// operand, whose faces share one id, the nearest of the normals that the part shows within the limit is the true one.
    pub normal_deg: Errors,
    /// Depth and normal where the surface is regular.
    pub exact: Exactness,
    /// Faces that hide themselves.
    pub folds: Folds,
    /// [`Tracer::given_up`](crate::Tracer::given_up): if it is not 0, the reference itself is incomplete.
    pub given_up: u64,
    /// The verdict on each pixel, row by row.
    #[serde(skip)]
    pub classes: Vec<Class>,
}

/// Running sum, maximum and its place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    count: u64,
    total: f64,
    worst: f64,
    at: usize,
}

impl Sum {
    /// Not-a-number counts as infinite.
    pub fn add(&mut self, index: usize, value: f64) {
        let value = if value.is_nan() { f64::INFINITY } else { value };
        self.merge(&Self { count: 1, total: value, worst: value, at: index });
    }

    fn merge(&mut self, other: &Self) {
        if other.count > 0 && (self.count == 0 || other.worst > self.worst) {
            (self.worst, self.at) = (other.worst, other.at);
        }
        self.count += other.count;
        self.total += other.total;
    }

    fn errors(&self, width: u32) -> Errors {
        let mean = if self.count == 0 { 0.0 } else { self.total / self.count as f64 };
        Errors { count: self.count, mean, worst: self.worst, worst_at: place(self.at, width) }
    }
}

/// The sums over a run of pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub agree: u64,
    pub normal: Sum,
    /// Regular model units and pixels, then all.
    depth: [Sum; 4],
    /// Depth in pixels and normal in degrees, of regular surface.
    exact: [Sum; 2],
    beyond: u64,
    pub irregular: u64,
}

impl Tally {
    pub fn depth(&mut self, index: usize, error: f64, pixel: f64, regular: bool) {
        let [a, b, c, d] = &mut self.depth;
        if regular {
            a.add(index, error);
            b.add(index, error / pixel);
        }
        c.add(index, error);
        d.add(index, error / pixel);
    }

    /// A pixel of regular surface.
    pub fn exact(&mut self, index: usize, depth_px: f64, normal_deg: f64, within: bool) {
        let [a, b] = &mut self.exact;
        a.add(index, depth_px);
        b.add(index, normal_deg);
        self.beyond += u64::from(!within);
    }

    pub fn merge(&mut self, other: &Self) {
        self.agree += other.agree;
        self.beyond += other.beyond;
        self.irregular += other.irregular;
        self.exact.iter_mut().zip(&other.exact).for_each(|(a, b)| a.merge(b));
        self.normal.merge(&other.normal);
        self.depth.iter_mut().zip(&other.depth).for_each(|(a, b)| a.merge(b));
    }
}

fn place(index: usize, width: u32) -> [u32; 2] {
    let w = width.max(1) as usize;
    [(index % w) as u32, (index / w) as u32]
}

impl Judgement {
    pub(super) fn new(size: (u32, u32), sampled: u64, limit: f64) -> Self {
        let reach = reach_px(limit);
        let wider = (reach > LEAST_REACH_PX).then_some(reach);
        Self {
            size,
            sampled,
            agree: 0,
            ties: 0,
            shifts: BINS.into_iter().chain(wider).map(|up_to_px| Bin { up_to_px, pixels: 0 }).collect(),
            gross: 0,
            unsearched: 0,
            wrong: 0,
            worst_shift_px: 0.0,
            mismatches: Vec::new(),
            depth_regular: DepthErrors::default(),
            depth_all: DepthErrors::default(),
            normal_deg: Errors::default(),
            exact: Exactness::default(),
            folds: Folds::default(),
            given_up: 0,
            classes: Vec::new(),
        }
    }

    /// Counts one searched pixel and returns its class with the limit applied.
    pub(super) fn enter(&mut self, index: usize, drawn: u32, truth: u32, class: Class, limit: f64) -> Class {
        let same = drawn == truth;
        let (shift_px, class) = match class {
            Class::Tie if same => return Class::Agree,
            Class::Tie => {
                self.ties += 1;
                return class;
            }
            Class::Fold(s) => {
                self.folds.worst_shift_px = self.folds.worst_shift_px.max(s);
                let count = if s <= limit { &mut self.folds.shifted } else { &mut self.folds.beyond };
                *count += 1;
                return class;
            }
            Class::Shift(s) => {
                self.worst_shift_px = self.worst_shift_px.max(s);
                if let Some(bin) = self.shifts.iter_mut().find(|b| s <= b.up_to_px) {
                    bin.pixels += 1;
                }
                if s <= limit {
                    return class;
                }
                (Some(s), Class::Far(s))
            }
            Class::Unsearched if same => {
                self.folds.unsearched += 1;
                return class;
            }
            Class::Unsearched => {
                self.unsearched += 1;
                (None, class)
            }
            _ if same => {
                self.folds.wrong_depth += 1;
                return Class::WrongDepth;
            }
            _ => {
                self.gross += 1;
                (None, Class::Gross)
            }
        };
        self.wrong += 1;
        self.mismatches.push(Mismatch {
            pixel: place(index, self.size.0),
            drawn,
            truth,
            shift_px,
            gross: class == Class::Gross,
        });
        class
    }

    pub(super) fn finish(&mut self, tally: Tally, listed: usize) {
        let width = self.size.0;
        self.agree = tally.agree;
        self.normal_deg = tally.normal.errors(width);
        let [a, b, c, d] = tally.depth.map(|s| s.errors(width));
        self.depth_regular = DepthErrors { model: a, px: b };
        self.depth_all = DepthErrors { model: c, px: d };
        let [depth_px, normal_deg] = tally.exact.map(|s| s.errors(width));
        self.exact = Exactness { depth_px, normal_deg, beyond: tally.beyond, irregular: tally.irregular };
        let severity = |m: &Mismatch| if m.gross { f64::INFINITY } else { m.shift_px.unwrap_or(0.0) };
        self.mismatches.sort_by(|a, b| severity(b).total_cmp(&severity(a)));
        self.mismatches.truncate(listed);
    }

    /// The verdicts as a picture, sRGB:
    ///
    /// | pixel | colour |
    /// |---|---|
    /// | background, right | white |
    /// | face, right | light grey |
    /// | not sampled | dark grey |
    /// | tie | light blue |
    /// | shift within the limit | green |
    /// | fold, right depth nearby | teal |
    /// | right face, wrong depth | purple |
    /// | shift beyond the limit | orange |
    /// | gross | red |
    /// | not searched | magenta |
    pub fn paint(&self) -> Vec<[u8; 4]> {
        let colour = |c: &Class| match c {
            Class::Background => [255, 255, 255, 255],
            Class::Agree => [205, 205, 205, 255],
            Class::Unsampled => [90, 90, 90, 255],
            Class::Tie => [120, 170, 255, 255],
            Class::Shift(_) => [40, 170, 60, 255],
            Class::Fold(_) => [0, 150, 150, 255],
            Class::WrongDepth => [120, 40, 160, 255],
            Class::Far(_) => [255, 140, 0, 255],
            Class::Gross => [220, 0, 0, 255],
            Class::Unsearched => [255, 0, 200, 255],
        };
        self.classes.iter().map(colour).collect()
    }
}
