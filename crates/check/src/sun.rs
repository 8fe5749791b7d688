//! Which points the sun reaches, exactly, and the errors of a drawn picture's light.
//!
//! ```text
//!   hit ──────────▶ sun      the line behind the hit, through the opaque solids: any length within them is shade;
//!                            past placed faces and meshes: any that it meets casts shade, closed or not
//!
//!   drawn as at the pixel's centre in truth ................................... agree
//!   as at an offset of at most limit_px, the smallest of those tried .......... shift
//!   as where the hit is moved by FrameStats::shadow_deviation ................. deviated
//!   neither .................................................................. wrong
//! ```
//!
//! Faces are met by roots of their own equations. The surfaces that cast a picture's shadows are not used.

use super::bvh::Slabs;
use super::judge::samples;
use super::leaf::Ray;
use super::solids::SolidTracer;
use super::solver::Solver;
use super::{Hit, JudgeOptions, Probe, Tracer};
use crate::model::{Camera, Images, Model, Solid, SolidError};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::TAU;

/// A model's sun and the objects that cast shadows, made ready for lines.
#[derive(Debug)]
pub struct SunTracer {
    casters: Option<SolidTracer>,
    /// Placed parts that are drawn as faces, without their solids.
    parts: Option<Tracer>,
    towards: DVec3,
    /// For each part, whether it is closed: light then falls on its outside only.
    closed: Vec<bool>,
    /// Size of the model and the objects that cast shadows.
    size: f64,
}

/// Rounding of a hit, relative to the model's size: far above the roundings of [`Hit::point`], far below a pixel.
const ROUNDING: f64 = 1e-9;
/// Rounding relative to the hit's distance from the origin, 4096 ulp: a model may be a thousand million times nearer to
/// itself than to the origin.
const PLACE_ROUNDING: f64 = 1.0 / 1_099_511_627_776.0;
/// Cosines of normal and sun below this are neither light nor shade: a key light so weak changes no picture.
const EDGE_ON: f64 = 1e-6;
/// Hits of a face nearer to the start than this many times the uncertainty of their places are the start itself.
const CLUSTER: f64 = 8.0;
/// A point counts as on a surface that casts shadows when it is within this many deviations of it.
const ON_SURFACE: f64 = 2.0;
/// Offsets tried for a shift: rings within the limit, and places on each.
const RINGS: u32 = 8;
const PLACES: u32 = 16;

impl SunTracer {
    /// `towards` is that of the engine's `SceneSettings::sun`, finite and not 0. Transparent solids cast no shadow, nor
    /// do placed parts that a volume trims.
    ///
    /// # Errors
    /// [`SolidError`] when an expression is too large.
    pub fn new(model: &Model, towards: DVec3) -> Result<Self, SolidError> {
        let opaque = model.items(false)?.opaque;
        let casters = SolidTracer::new(&Solid::union(&opaque)?, model.coincidence())?;
        let casts = model.trim.is_none() && !model.instances.is_empty();
        let parts = casts.then(|| Tracer::new(&Model { solids: Vec::new(), ..model.clone() }));
        let bounds = model.control_bounds().union(casters.bounds());
        Ok(Self {
            casters: (!opaque.is_empty()).then_some(casters),
            parts,
            towards: (towards / towards.abs().max_element()).normalize(),
            closed: model.parts.iter().map(|part| part.closed && model.trim.is_none()).collect(),
            size: if bounds.is_empty() { 0.0 } else { bounds.diagonal() },
        })
    }

    /// Whether the sun reaches a hit of a ray in `direction`; `None` where the face is edge-on to it.
    pub fn reaches(&self, hit: &Hit, direction: DVec3) -> Option<bool> {
        self.reaches_at(hit, DVec3::ZERO, direction)
    }

    /// The same where the hit is moved.
    fn reaches_at(&self, hit: &Hit, by: DVec3, direction: DVec3) -> Option<bool> {
        let outside = self.closed.get(hit.part).is_some_and(|closed| *closed);
        let n = if !outside && hit.normal.dot(direction) > 0.0 { -hit.normal } else { hit.normal };
        let rise = n.dot(self.towards);
        if rise.abs() < EDGE_ON {
            return None;
        }
        let clear = || {
            let point = hit.point + by;
            // a solid may be unbounded
            let rounding = ROUNDING * self.size + PLACE_ROUNDING * point.length();
            let free =
                |casters: &SolidTracer| casters.trace(point, self.towards).thickness(rounding, f64::MAX) <= rounding;
            self.casters.as_ref().is_none_or(free)
                && !self.parts.as_ref().is_some_and(|parts| meets(parts, (point, self.towards), rounding))
        };
        Some(rise > 0.0 && clear())
    }
}

/// Whether a line meets a face or a mesh of a placed part behind its start.
fn meets(tracer: &Tracer, (origin, direction): (DVec3, DVec3), start: f64) -> bool {
    let mut solver = Solver::default();
    let mut met = false;
    tracer.top.visit(&Slabs::new(origin, direction), (start, f64::INFINITY), |item| {
        let placed = &tracer.placed[item as usize];
        let part = &tracer.parts[placed.part];
        let local = (placed.to_part.transform_point3(origin), placed.to_part.transform_vector3(direction));
        let ray = Ray::new(local.0, local.1);
        part.tree.visit(&Slabs::new(local.0, local.1), (start, f64::INFINITY), |index| {
            let index = index as usize;
            match part.leaves.get(index) {
                Some(leaf) => leaf.meet(&ray, &mut solver, |m| {
                    // uncertainty, in the part's units
                    let known = CLUSTER * m.spread / local.1.length();
                    let there = leaf.inside || part.faces[leaf.face as usize].loops.contains(m.uv);
                    met |= m.t > start + known && there;
                }),
                None => met |= part.facets.meet(&ray, index - part.leaves.len()).is_some_and(|(_, m)| m.t > start),
            }
            if met { f64::NEG_INFINITY } else { f64::INFINITY }
        });
        if met { f64::NEG_INFINITY } else { f64::INFINITY }
    });
    tracer.given_up.fetch_add(solver.given_up, std::sync::atomic::Ordering::Relaxed);
    met
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
    /// Of the rest, pixels whose light is right where the point is moved by the error of the surfaces that cast
    /// shadows: [`Images::shadow_deviation`].
    pub deviated: u64,
    /// Pixels whose light is right nowhere within the limit, nor moved so.
    pub wrong: u64,
    /// The first wrong pixel: column, row.
    pub first_wrong: Option<[u32; 2]>,
}

/// Compares [`Images::sunlit`], drawn with `camera`, with the truth: the pixels that `options` samples, and those
/// beside which the light changes.
///
/// # Panics
/// When the picture does not have the camera's size, or has no face image or no `sunlit`.
pub fn judge_sun(
    tracer: &Tracer,
    sun: &SunTracer,
    camera: &Camera,
    picture: &Images<'_>,
    options: &JudgeOptions,
) -> SunJudgement {
    let pixels = picture.size.0 as usize * picture.size.1 as usize;
    let fits = picture.size == camera.size && picture.face.len() == pixels && picture.sunlit.len() == pixels;
    assert!(fits, "the picture has the camera's size, faces and light");
    let lit: Vec<u32> = picture.sunlit.iter().map(|lit| u32::from(*lit)).collect();
    let mut sampled = samples(picture.size, picture.face, options.samples);
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
        match light.drawn {
            Drawn::Shifted(0.0) => {}
            Drawn::Shifted(shift) => {
                judgement.shifted += 1;
                judgement.worst_shift_px = judgement.worst_shift_px.max(shift);
            }
            Drawn::Deviated => judgement.deviated += 1,
            Drawn::Wrong => {
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
    drawn: Drawn,
}

/// The offset at which a pixel's light is as it is drawn.
enum Drawn {
    /// At this distance, pixels.
    Shifted(f64),
    Deviated,
    Wrong,
}

/// `None` where another face than the true one is drawn: `judge` counts it.
fn look(probe: &mut Probe, sun: &SunTracer, picture: &Images<'_>, index: usize, limit_px: f64) -> Option<Light> {
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
        return Some(Light { truth: truth.unwrap_or(drawn), drawn: Drawn::Shifted(0.0) });
    }
    let rings = (1..=RINGS).map(|k| limit_px * f64::from(k) / f64::from(RINGS));
    let mut as_drawn = |far: f64| {
        let places = (0..PLACES).map(|k| centre + DVec2::from_angle(TAU * f64::from(k) / f64::from(PLACES)) * far);
        places.into_iter().any(|at| light(at).is_some_and(|lit| lit.is_none_or(|lit| lit == drawn)))
    };
    let shift = rings.into_iter().find(|far| as_drawn(*far)).map(Drawn::Shifted);
    let mut deviated = || {
        let far = ON_SURFACE * picture.shadow_deviation;
        let hit = probe.first(centre).filter(|_| far > 0.0)?;
        let (right, up) = sun.towards.any_orthonormal_pair();
        let ways = [hit.normal, right, up, right + up, right - up].map(DVec3::normalize_or_zero);
        let direction = camera.ray(centre).1;
        let mut moved = ways.into_iter().flat_map(|way| [way * far, way * -far]);
        moved.any(|by| sun.reaches_at(&hit, by, direction).is_none_or(|lit| lit == drawn)).then_some(Drawn::Deviated)
    };
    let drawn = shift.or_else(&mut deviated).unwrap_or(Drawn::Wrong);
    Some(Light { truth: truth == Some(true), drawn })
}
