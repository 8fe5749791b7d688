//! Where the sun reaches, exactly, and how far a drawn picture's light is from that.
//!
//! ```text
//!   hit ──────────▶ sun      the line behind the hit, through the opaque solids: any length within them is shade
//!
//!   drawn as the truth has it at the pixel's centre ........................... agree
//!   as it has it at an offset of at most limit_px, the smallest of some tried . shift
//!   neither .................................................................. wrong
//! ```

use super::csg::SolidTracer;
use super::judge::samples;
use super::{Hit, JudgeOptions, Probe, Tracer};
use crate::model::{Camera, Model, Primitive, Shape, Solid, SolidError, SurfaceTable};
use crate::picture::Picture;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::TAU;

/// A model's sun and the solids that cast shadows, made ready for lines.
#[derive(Debug)]
pub struct SunTracer {
    casters: Option<SolidTracer>,
    towards: DVec3,
    /// Of each part: light falls on its outside only.
    closed: Vec<bool>,
    /// Of the model, and of what casts shadows.
    size: f64,
}

/// Of a hit, relative to the model's size and its place: far above the roundings of [`Hit::point`], far below a pixel.
const ROUNDING: f64 = 1e-9;
/// Cosines of normal and sun below this are neither light nor shade: a key light so weak changes no picture.
const EDGE_ON: f64 = 1e-6;
/// Offsets tried for a shift: rings within the limit, and places on each.
const RINGS: u32 = 8;
const PLACES: u32 = 16;

impl SunTracer {
    /// `towards` is that of [`SceneSettings::sun`](crate::picture::SceneSettings::sun), finite and not 0: operands that
    /// are spline parts, placed parts and what is seen through cast no shadow.
    ///
    /// # Errors
    /// [`SolidError`] when an expression is too large.
    pub fn new(model: &Model, towards: DVec3) -> Result<Self, SolidError> {
        let opaque = model.items(false)?.opaque;
        let whole = Solid::union(&opaque)?;
        let splines = |p: &Primitive| matches!(&p.shape, Shape::Part(part) if !part.faces.is_empty());
        let kept: Vec<bool> = whole.primitives().iter().map(|p| !splines(p)).collect();
        let tree = whole.tree().fold(|p| (!kept[p as usize]).then_some(false));
        // nobody names what is left out, and it may be large
        let small = Shape::Sphere { radius: 1.0 };
        let primitives: Vec<Primitive> = (whole.primitives().iter().zip(&kept))
            .map(|(p, kept)| if *kept { p.clone() } else { Primitive { shape: small.clone(), ..p.clone() } })
            .collect();
        let casters = Solid::new(primitives, tree)?;
        let casters = SolidTracer::new(&casters, SurfaceTable::DRAWN)?;
        let bounds = model.bounds().union(casters.bounds());
        Ok(Self {
            casters: (!opaque.is_empty()).then_some(casters),
            towards: (towards / towards.abs().max_element()).normalize(),
            closed: model.parts.iter().map(|part| part.closed && model.trim.is_none()).collect(),
            size: if bounds.is_empty() { 0.0 } else { bounds.diagonal() },
        })
    }

    /// Whether the sun reaches a hit of a ray in `direction`; `None` where the face is edge-on to it.
    pub fn reaches(&self, hit: &Hit, direction: DVec3) -> Option<bool> {
        let outside = self.closed.get(hit.part).is_some_and(|closed| *closed);
        let n = if !outside && hit.normal.dot(direction) > 0.0 { -hit.normal } else { hit.normal };
        let rise = n.dot(self.towards);
        if rise.abs() < EDGE_ON {
            return None;
        }
        let clear = || {
            let Some(casters) = &self.casters else { return true };
            let trace = casters.trace(hit.point, self.towards);
            // a solid may have no end
            let rounding = ROUNDING * (self.size + hit.point.length());
            trace.thickness(rounding, f64::MAX) <= rounding
        };
        Some(rise > 0.0 && clear())
    }
}

/// How a picture's light compares with the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SunJudgement {
    /// Pixels compared: those that show the true face.
    pub compared: u64,
    /// Of them lit, in truth.
    pub lit: u64,
    /// Pixels whose light is right within the limit only.
    pub shifted: u64,
    /// The largest distance at which one is, pixels: of the offsets tried.
    pub worst_shift_px: f64,
    /// Pixels whose light is right nowhere within the limit.
    pub wrong: u64,
    /// The first of them: column, row.
    pub first_wrong: Option<[u32; 2]>,
}

/// Compares [`Picture::sunlit`], drawn with `camera`, with the truth: the pixels that `options` samples, and those
/// beside which the light changes.
///
/// # Panics
/// When the picture has not the camera's size, no face image or no `sunlit`.
pub fn judge_sun(
    tracer: &Tracer,
    sun: &SunTracer,
    camera: &Camera,
    picture: &Picture,
    options: &JudgeOptions,
) -> SunJudgement {
    let pixels = picture.size.0 as usize * picture.size.1 as usize;
    let fits = picture.size == camera.size && picture.face.len() == pixels && picture.sunlit.len() == pixels;
    assert!(fits, "the picture has the camera's size, faces and light");
    let lit: Vec<u32> = picture.sunlit.iter().map(|lit| u32::from(*lit)).collect();
    let mut sampled = samples(picture.size, &picture.face, options.samples);
    sampled.extend(samples(picture.size, &lit, options.samples));
    sampled.sort_unstable();
    sampled.dedup();
    let shifts: Vec<(usize, Option<Light>)> = sampled
        .par_iter()
        .map_init(|| tracer.probe(camera), |probe, &index| (index, look(probe, sun, picture, index, options.limit_px)))
        .collect();
    let mut judgement = SunJudgement::default();
    for (index, light) in shifts.into_iter().filter_map(|(index, light)| Some((index, light?))) {
        judgement.compared += 1;
        judgement.lit += u64::from(light.truth);
        match light.shift_px {
            Some(0.0) => {}
            Some(shift) => {
                judgement.shifted += 1;
                judgement.worst_shift_px = judgement.worst_shift_px.max(shift);
            }
            None => {
                judgement.wrong += 1;
                let (w, at) = (picture.size.0, index as u32);
                judgement.first_wrong.get_or_insert([at % w, at / w]);
            }
        }
    }
    judgement
}

/// The light of one pixel.
struct Light {
    truth: bool,
    /// `None`: nowhere within the limit as it is drawn.
    shift_px: Option<f64>,
}

/// `None` where another face than the true one is drawn, which is judged elsewhere.
fn look(probe: &mut Probe, sun: &SunTracer, picture: &Picture, index: usize, limit_px: f64) -> Option<Light> {
    let w = picture.size.0 as usize;
    let centre = DVec2::new((index % w) as f64 + 0.5, (index / w) as f64 + 0.5);
    let (face, drawn) = (picture.face[index], picture.sunlit[index]);
    let camera = probe.camera();
    let mut light = |at: DVec2| {
        let hit = probe.first(at).filter(|hit| hit.face == face)?;
        Some(sun.reaches(&hit, camera.ray(at).1))
    };
    let truth = light(centre)?;
    if truth.is_none_or(|truth| truth == drawn) {
        return Some(Light { truth: truth.unwrap_or(drawn), shift_px: Some(0.0) });
    }
    let rings = (1..=RINGS).map(|k| limit_px * f64::from(k) / f64::from(RINGS));
    let mut as_drawn = |far: f64| {
        let places = (0..PLACES).map(|k| centre + DVec2::from_angle(TAU * f64::from(k) / f64::from(PLACES)) * far);
        places.into_iter().any(|at| light(at).is_some_and(|lit| lit.is_none_or(|lit| lit == drawn)))
    };
    let shift_px = rings.into_iter().find(|far| as_drawn(*far));
    Some(Light { truth: truth == Some(true), shift_px })
}
