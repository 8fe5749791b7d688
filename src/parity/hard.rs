//! The hard cases of trimming, shared with the tests of whole frames; and loops moved by one unit of single precision.

use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};

#[path = "../../tests/shapes/trims.rs"]
mod trims;

pub(super) use trims::{all, loops};

/// Moves every control point by a number of units in the last place of single precision.
pub(super) fn moved(trim_loop: &TrimLoop, (du, dv): (i32, i32)) -> TrimLoop {
    let step = |x: f64, by: i32| {
        let rounded = x as f32;
        match by {
            0 => x,
            1 => x + f64::from(rounded.next_up()) - f64::from(rounded),
            _ => x - (f64::from(rounded) - f64::from(rounded.next_down())),
        }
    };
    let point = |p: &DVec3| {
        let q = p.point();
        DVec3::from_point(DVec2::new(step(q.x, du), step(q.y, dv)), p.z)
    };
    let curves = trim_loop.curves().map(|c| Bezier { points: c.points.iter().map(point).collect() });
    TrimLoop::new(curves.collect(), DVec2::splat(1e-12)).expect("as closed as before")
}

/// The table's twins at several zooms: every case, and again with joints moved by one unit of single precision.
mod table {
    use super::super::chain::Chain;
    use super::super::{Case, placed};
    use super::{all, moved, trims::TrimCase};
    use crate::model::{Camera, Face, Projection, SurfaceKind, TrimLoop};
    use crate::spline::Surface;
    use crate::trim::LoopIndex;
    use crate::twin::table::Table;
    use glam::{DAffine3, DVec2, DVec3, DVec4};

    /// Pixels along each side of a picture.
    const SIZE: u32 = 64;
    const TOLERANCE_PX: f64 = 0.5;

    fn square(loops: Vec<TrimLoop>) -> Face {
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| DVec4::new(u, v, 0.0, 1.0));
        let knots = || vec![0.0, 0.0, 1.0, 1.0];
        let surface = Surface::new((1, 1), knots(), knots(), corners.to_vec()).unwrap();
        Face { id: 1, kind: SurfaceKind::Plane, surface, loops, same_sense: true, colour: None }
    }

    /// The twins' buffers, as large as the rows need: rows through hundreds of holes need 2^24 intercepts, others few.
    fn chain_of(case: &mut Case) -> Chain {
        for capacity in [1 << 14, 1 << 19] {
            case.frame.intercept_capacity = capacity;
            let chain = Chain::new(case);
            if chain.counters.failed == 0 {
                return chain;
            }
        }
        case.frame.intercept_capacity = 1 << 24;
        Chain::new(case)
    }

    /// Number of judged points; asserts that all are right.
    fn judged(case: &TrimCase, loops: Vec<TrimLoop>, zoom: f64) -> usize {
        let centre = if zoom == 1.0 { DVec2::splat(0.5) } else { DVec2::from(case.focus) };
        let target = centre.extend(0.0);
        let camera = Camera {
            eye: target + DVec3::Z * 2.0,
            target,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 1.0 / zoom },
            depth_range: (1.0, 3.0),
            size: (SIZE, SIZE),
        };
        let index = LoopIndex::new(&loops);
        let mut case_ = Case::new(&placed(vec![square(loops)], DAffine3::IDENTITY), &camera, TOLERANCE_PX);
        if !case_.data.has_trimmed {
            return 0; // every patch is inside or outside as a whole
        }
        let chain = chain_of(&mut case_);
        assert_eq!((chain.counters.failed, chain.counters.clamps), (0, 0), "{}", case.name);
        let flips: Vec<f32> = chain.flips.iter().map(|&bits| f32::from_bits(bits)).collect();
        let table = Table {
            strips: &chain.strips,
            row_starts: &chain.row_starts,
            row_counts: &chain.flip_counts,
            flips: &flips,
            border_cells: &chain.border_cells,
            row_capacity: case_.frame.row_capacity,
        };
        let face = &case_.data.faces[0];
        let pixel = 1.0 / (zoom * f64::from(SIZE));
        let grid = (0..SIZE * SIZE).map(|k| DVec2::new(f64::from(k % SIZE) + 0.5, f64::from(k / SIZE) + 0.5));
        let grid = grid.map(|p| centre + (p - 0.5 * f64::from(SIZE)) * pixel);
        let rows = case.rows.iter().map(|&(u, v, _)| DVec2::new(u, v));
        let seen =
            |p: &DVec2| (*p - centre).abs().max_element() < 0.5 / zoom && p.min(DVec2::ONE - *p).min_element() > 0.0;
        let far = |p: &DVec2| index.distance(*p, 1.0) > TOLERANCE_PX * pixel;
        let points: Vec<DVec2> = grid.chain(rows).filter(seen).filter(far).collect();
        for p in &points {
            let inside = |p: DVec2| table.inside(0, face, p.as_vec2().to_array());
            assert_eq!(inside(*p), index.contains(*p), "{} at {p}, zoom {zoom}", case.name);
            let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|c| *p + pixel * DVec2::from(c));
            if table.same(0, face, corners[0].as_vec2().to_array(), corners[3].as_vec2().to_array()) {
                let same = corners.iter().all(|q| inside(*q) == inside(*p));
                assert!(same, "{}: the box around {p}, zoom {zoom}", case.name);
            }
        }
        points.len()
    }

    #[test]
    fn every_case_at_every_zoom() {
        let mut all_judged = 0;
        for case in all() {
            for zoom in [1.0, 20.0, 100.0] {
                all_judged += judged(&case, case.loops.clone(), zoom);
            }
            for by in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let loops = case.loops.iter().map(|l| moved(l, by)).collect();
                assert!(judged(&case, loops, 1.0) > 100, "{}", case.name);
            }
        }
        assert!(all_judged > 100_000, "{all_judged}");
    }
}
