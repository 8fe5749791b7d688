//! A face with any number of holes, on which ways to trim differ most.
//!
//! ```text
//!   ┌───────────────┐     a wavy bicubic sheet, 100 x 100 mm; in each cell of a grid one round hole,
//!   │ o  O  o  o  O │     of four rational quadratic arcs, off the cell's centre and of its own size,
//!   │  O  o O o  o  │     so that no two start or end on a common scan line
//!   │ o  o  o  O  o │
//!   └───────────────┘
//! ```

use crate::model::{Face, Instance, Model, Part, SurfaceKind, TrimLoop};
use crate::spline::{Bezier, Control, Surface};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use std::f64::consts::FRAC_1_SQRT_2;

/// Side of the sheet, mm.
const SIDE: f64 = 100.0;
/// Control points along each side of the sheet.
const NET: usize = 11;
/// Height of the waves, mm.
const WAVES: f64 = 3.0;

/// A sheet with `across * across` holes, one face in an open shell.
pub fn many_holes(across: usize) -> Model {
    let cell = SIDE / across as f64;
    let mut loops = vec![rectangle(DVec2::splat(0.1 * cell), DVec2::splat(SIDE - 0.1 * cell))];
    for k in 0..across * across {
        let [x, y, r] = random(k as u64);
        let corner = DVec2::new((k % across) as f64, (k / across) as f64) * cell;
        // the largest hole at its largest offset stays 0.1 of a cell away from its neighbours
        let centre = corner + cell * (DVec2::splat(0.5) + 0.1 * (2.0 * DVec2::new(x, y) - DVec2::ONE));
        loops.push(hole(centre, cell * (0.2 + 0.1 * r)));
    }
    let surface = sheet();
    let face = Face { id: 1, kind: SurfaceKind::BSpline, surface, loops, same_sense: true, colour: None };
    Model {
        name: format!("{} holes", across * across),
        parts: vec![Part { faces: vec![face], ..Part::default() }],
        instances: vec![Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() }],
        unit: "millimetre".into(),
        ..Model::default()
    }
}

/// A uniform bicubic B-spline with waves in both directions.
fn sheet() -> Surface {
    let spans = NET - 3;
    let inner = (1..spans).map(|i| SIDE * i as f64 / spans as f64);
    let knots: Vec<f64> = [0.0; 4].into_iter().chain(inner).chain([SIDE; 4]).collect();
    // Greville abscissas: the parameters are lengths in x and y, exactly
    let greville = |i: usize| knots[i + 1..i + 4].iter().sum::<f64>() / 3.0;
    let height = |i: usize| (i as f64 * 1.3).sin();
    let points = (0..NET * NET).map(|k| {
        let (i, j) = (k % NET, k / NET);
        DVec4::new(greville(i), greville(j), WAVES * height(i) * height(j + 1), 1.0)
    });
    let points = points.collect();
    Surface::new((3, 3), knots.clone(), knots, points).expect("a clamped net")
}

fn rectangle(lo: DVec2, hi: DVec2) -> TrimLoop {
    let corners = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
    closed((0..4).map(|i| Bezier::line(corners[i], corners[(i + 1) % 4])).collect())
}

/// A clockwise circle.
fn hole(centre: DVec2, radius: f64) -> TrimLoop {
    let corners = [(1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0)];
    let points: Vec<DVec3> = corners
        .iter()
        .enumerate()
        .map(|(i, &(x, y))| {
            let weight = if i % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 };
            DVec3::from_point(centre + radius * DVec2::new(f64::from(x), f64::from(y)), weight)
        })
        .collect();
    closed((0..4).map(|i| Bezier { points: points[2 * i..2 * i + 3].to_vec() }).collect())
}

fn closed(curves: Vec<Bezier<DVec3>>) -> TrimLoop {
    TrimLoop::new(curves, DVec2::splat(1e-12 * SIDE)).expect("a closed loop")
}

/// Three numbers in `[0, 1)` from a counter. Source: G. L. Steele, D. Lea, C. H. Flood, *Fast splittable
/// pseudorandom number generators*, OOPSLA 2014 (SplitMix64).
fn random(counter: u64) -> [f64; 3] {
    let mut z = (counter + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    [0, 21, 42].map(|shift| ((z >> shift) & 0x1F_FFFF) as f64 / f64::from(1 << 21))
}
