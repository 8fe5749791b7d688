//! Which loops are outer borders and which are holes: by containment, not by order or direction.

use super::cut::cut_open;
use super::edge::EdgeCurve;
use super::loops::{Limits, Loop, area};
use super::outline::Outline;
use super::rims::natural_rims;
use super::support::Support;
use super::{BuildError, law};
use crate::trim::{Box2, each_pair};
use glam::DVec2;
use std::rc::Rc;

/// Whether the directions of a face's loops can be trusted.
pub(super) enum Directions<'n> {
    /// They keep the face on their left.
    Sound,
    /// They contradict each other or the neighbours; a note says what was guessed against them.
    Ambiguous(&'n mut Vec<String>),
}

/// Unrolled loops of a face, outer ones counter-clockwise and holes clockwise, without winding.
///
/// The given directions are read in one case only: on a closed surface whose loops can all be contracted, they say
/// whether the face is inside or outside of the loops. If they are ambiguous, the face is the smaller part. A loop that
/// runs along an edge twice, once each way, has the face on both sides of that edge. Its direction is not read, since
/// real files get it wrong there: the face is the area that the loop goes around.
pub(super) fn arrange(
    support: &Support,
    loops: Vec<Loop>,
    vertices: &[usize],
    limits: Limits,
    directions: Directions<'_>,
) -> Result<Vec<Loop>, BuildError> {
    let told_by_direction = support.is_closed() && loops.iter().all(|l| l.winding == [0, 0] && !has_seam(l));
    let mut loops = cut_open(support, loops, vertices, limits)?;
    gather(support, &mut loops);
    let outside = match directions {
        _ if !told_by_direction => false,
        Directions::Sound => is_outside(support, &loops),
        Directions::Ambiguous(notes) => {
            let outside = share_inside(support, &loops) > 0.5;
            if outside != is_outside(support, &loops) {
                let what = "its loops do not say which side of them it is; the smaller one is taken";
                notes.push(format!("face #{}: {what}", limits.face));
            }
            outside
        }
    };
    if outside {
        let rims = natural_rims(support, &loops).ok_or(BuildError::Tangled { face: limits.face })?;
        loops.extend(rims);
        loops = cut_open(support, loops, vertices, limits)?;
        gather(support, &mut loops);
    }
    orient(support, &mut loops);
    Ok(loops)
}

/// Moves every loop by whole periods into the largest one, where it fits.
fn gather(support: &Support, loops: &mut [Loop]) {
    if support.periods == [None, None] || loops.len() < 2 {
        return;
    }
    let polygons: Vec<Vec<DVec2>> = loops.iter().map(|l| closed(l.polygon(support))).collect();
    let size = |i: usize| area(&polygons[i]).abs();
    let Some(outer) = (0..loops.len()).max_by(|a, b| size(*a).total_cmp(&size(*b))) else { return };
    let centre = |p: &[DVec2]| p.iter().sum::<DVec2>() / p.len() as f64;
    let middle = centre(&polygons[outer]);
    let around = Outline::new(&polygons[outer]);
    for i in (0..loops.len()).filter(|i| *i != outer) {
        let mut candidates = vec![DVec2::ZERO];
        for ku in -1..=1 {
            for kv in -1..=1 {
                let here = centre(&polygons[i]);
                let base = support.unwrap(here, middle) - here;
                let by = |k: i32, axis: usize| f64::from(k) * support.periods[axis].unwrap_or(0.0);
                candidates.push(base + DVec2::new(by(ku, 0), by(kv, 1)));
            }
        }
        let inside = |by: &DVec2| {
            let moved: Vec<DVec2> = polygons[i].iter().map(|p| *p + *by).collect();
            around.contains(&moved)
        };
        if let Some(by) = candidates.into_iter().find(inside) {
            loops[i] = loops[i].clone().shifted(by);
        }
    }
}

/// Some edge is used twice. The parts of one that passes a pole are one use.
fn has_seam(l: &Loop) -> bool {
    let edges = l.strands.iter().filter_map(|s| Some(&s.part.as_ref()?.trace.edge));
    let mut uses: Vec<(u32, *const EdgeCurve)> = edges.map(|e| (e.id, Rc::as_ptr(e))).collect();
    uses.sort_unstable();
    uses.dedup();
    uses.windows(2).any(|w| w[0].0 == w[1].0)
}

/// Every outermost loop runs clockwise as given: the face is what they leave.
fn is_outside(support: &Support, loops: &[Loop]) -> bool {
    let polygons: Vec<Vec<DVec2>> = loops.iter().map(|l| closed(l.polygon(support))).collect();
    let depths = depths(&polygons);
    !loops.is_empty() && (0..loops.len()).all(|i| depths[i] > 0 || area(&polygons[i]) < 0.0)
}

/// Share of a closed surface's area within an odd number of loops, by samples.
fn share_inside(support: &Support, loops: &[Loop]) -> f64 {
    const STEPS: u32 = 48;
    let polygons: Vec<Vec<DVec2>> = loops.iter().map(|l| closed(l.polygon(support))).collect();
    let [Some(u), Some(v)] = support.natural else { return 0.0 };
    let at = |(a, b): (f64, f64), i: u32| a + (b - a) * (f64::from(i) + 0.5) / f64::from(STEPS);
    // the samples of a range, and one more at each end
    let samples = |(a, b): (f64, f64), lo: f64, hi: f64| {
        let step = |x: f64| (x - a) / (b - a) * f64::from(STEPS);
        (step(lo).floor() - 1.0).max(0.0) as u32..(step(hi).ceil() + 1.0).clamp(0.0, f64::from(STEPS)) as u32
    };
    let copies = |axis: usize| if support.periods[axis].is_some() { -1..=1 } else { 0..=0 };
    let by = |axis: usize, k: i32| f64::from(k) * support.periods[axis].unwrap_or(0.0);
    let mut odd = vec![false; (STEPS * STEPS) as usize];
    for polygon in &polygons {
        let outline = Outline::new(polygon);
        let (lo, hi) = outline.bounds;
        for by in copies(0).flat_map(|k| copies(1).map(move |l| DVec2::new(by(0, k), by(1, l)))) {
            let (lo, hi) = (lo - by, hi - by);
            for i in samples(u, lo.x, hi.x) {
                for j in samples(v, lo.y, hi.y) {
                    odd[(i * STEPS + j) as usize] ^= outline.encloses(DVec2::new(at(u, i), at(v, j)) + by);
                }
            }
        }
    }
    let (mut all, mut inside) = (0.0, 0.0);
    for (i, odd) in (0..STEPS * STEPS).zip(odd) {
        let jet = support.jet(DVec2::new(at(u, i / STEPS), at(v, i % STEPS)));
        let area = jet.du.cross(jet.dv).length();
        all += area;
        inside += if odd { area } else { 0.0 };
    }
    inside / all
}

/// Turns loops around so that those at even depth run counter-clockwise.
fn orient(support: &Support, loops: &mut [Loop]) {
    let polygons: Vec<Vec<DVec2>> = loops.iter().map(|l| closed(l.polygon(support))).collect();
    for ((l, polygon), depth) in loops.iter_mut().zip(&polygons).zip(depths(&polygons)) {
        if (area(polygon) > 0.0) != depth.is_multiple_of(2) {
            *l = l.clone().reversed();
        }
    }
}

/// How many other polygons hold each one. Only polygons whose boxes meet are compared.
pub(super) fn depths(polygons: &[Vec<DVec2>]) -> Vec<usize> {
    let outlines: Vec<Outline<'_>> = polygons.iter().map(|p| Outline::new(p)).collect();
    let boxes: Vec<Box2> = outlines.iter().map(|o| o.bounds).collect();
    let mut depths = vec![0; polygons.len()];
    let none: Option<()> = each_pair(&boxes, |i, j| {
        depths[i] += usize::from(outlines[j].contains(&polygons[i]));
        depths[j] += usize::from(outlines[i].contains(&polygons[j]));
        None
    });
    debug_assert!(none.is_none(), "every pair is visited");
    depths
}

fn closed(mut polygon: Vec<DVec2>) -> Vec<DVec2> {
    polygon.extend(polygon.first().copied());
    polygon
}

/// Moves all loops by whole periods so that their box begins in the natural range.
pub(super) fn come_home(support: &Support, loops: Vec<Loop>) -> (Vec<Loop>, [(f64, f64); 2]) {
    let mut bounds = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for l in &loops {
        bounds = l.bounds_with(support, bounds);
    }
    let mut by = DVec2::ZERO;
    for i in 0..2 {
        if let (Some(period), Some((start, end))) = (support.periods[i], support.natural[i]) {
            // an apple's natural range is shorter than its period: go by the middle
            let full = end - start >= period * (1.0 - 1e-9);
            by[i] = if full {
                -period * ((bounds.0[i] - start) / period + 1e-9).floor()
            } else {
                let middle = 0.5 * (bounds.0[i] + bounds.1[i]);
                law::nearest(middle, 0.5 * (start + end), period) - middle
            };
        }
    }
    let loops = if by == DVec2::ZERO { loops } else { loops.into_iter().map(|l| l.shifted(by)).collect() };
    let (lo, hi) = (bounds.0 + by, bounds.1 + by);
    (loops, [(lo.x, hi.x), (lo.y, hi.y)])
}
