//! All points of a unit square where a planar Bernstein net is zero: where a ray meets a patch.
//!
//! ```text
//!   f(u, v) = (n₁·F, n₂·F),   F = Σ B_i B_j w_ij (X_ij - o)     n₁, n₂ ⟂ ray, o on the ray
//! ```
//!
//! `f` is a homogeneous image of the patch seen along the ray, so rational patches need no division
//! and `f = 0` exactly on the ray. The square is halved until each *cell* falls in one class:
//!
//! 1. **Empty.** The control values lie on one side of a line through 0, and with them all of `f`.
//! 2. **Regular.** With `J` the mean slope and `q = max ‖I - J⁻¹ D‖∞` over the control values `D` of
//!    both derivatives, `q ≤ 1/4`: `f` is one-to-one on the cell and Newton's method, clamped to it,
//!    shrinks the distance to a root by `ρ = 2q / (1 - q) ≤ 2/3` a step *if there is a root*. A
//!    step that leaves the cell by more than what is left of that distance proves that there is none.
//! 3. **Point.** All control values are within rounding of 0: a pole, or a tangent ray. Kept as a
//!    root with the size of its cell.
//! 4. **Edge-on.** A large cell whose image is a line through 0 within rounding: the surface contains
//!    a piece of the ray. It covers no area of any picture, and is left out.
//!
//! Halving goes across the side that is longer in the image, so that cells shrink to the root in both coordinates at a
//! fold as well. The mean value argument behind 2 is that of the Krawczyk operator: R. E. Moore, R. B. Kearfott, M. J.
//! Cloud, *Introduction to Interval Analysis*, 2009, chapter 8; the convex hull argument behind 1 is that of Bézier
//! clipping: T. Nishita, T. W. Sederberg, M. Kakimoto, *Ray tracing trimmed rational surface patches*, SIGGRAPH 1990.

use super::net::{self, Degrees};
use glam::DVec2;

/// Largest `q` of a regular cell; `ρ < 1` needs `q < 1/3`.
const CONTRACTION: f64 = 0.25;
/// Steps after which `ρᵏ` is below 1e-14 for the largest `q`.
const NEWTON_STEPS: u32 = 80;
/// Roots are accepted this far outside their cell, in its own unit: neighbours that share a border
/// must not both miss a root on it. Callers drop the duplicates.
const BORDER: f64 = 1e-12;
/// A step this small, in units of the patch, is the last: convergence is quadratic.
const POLISHED: f64 = 1e-9;
/// Cells smaller than this fraction of the patch whose image is a line count as points: a tangent
/// ray meets a second-order fold in a cell of 3e-8, a fourth-order one in 2e-4.
const EDGE_ON: f64 = 1e-3;
/// An image this many roundings long and one wide is a line. The last cell at a pole, a triangle that
/// wide, may be longer than it is wide, too: up to the angle of a leaf, about 1/50.
const LINE: f64 = 1e4;
/// Cells on either side within which the root of a point is searched.
const NEIGHBOURS: f64 = 16.0;
/// Cells visited before the search of a patch is given up. A transversal ray visits 1, a tangent one some hundreds.
const BUDGET: u32 = 1 << 15;

/// A common zero of both components.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    /// Parameters in the unit square.
    pub at: DVec2,
    /// The uncertainty of `at`: rounding over slope, or half the sides of the cell of a point.
    pub spread: DVec2,
}

/// A rectangle of the square, by its low corner and sides.
#[derive(Clone, Copy, Debug)]
struct Cell {
    low: DVec2,
    side: DVec2,
}

/// Working memory, reused between rays.
#[derive(Debug, Default)]
pub(super) struct Solver {
    /// The net of the whole square: fill before [`Solver::solve`].
    pub base: Vec<DVec2>,
    /// The zeros found by the last [`Solver::solve`].
    pub roots: Vec<Root>,
    /// Searches that exceeded their budget, since creation.
    pub given_up: u64,
    cells: Vec<Cell>,
    nets: Vec<DVec2>,
}

impl Solver {
    /// Finds the zeros of `base`; values below `noise` in both components are zero.
    pub fn solve(&mut self, degrees: Degrees, noise: f64) {
        let len = net::count(degrees);
        self.roots.clear();
        self.cells.clear();
        self.nets.clear();
        self.cells.push(Cell { low: DVec2::ZERO, side: DVec2::ONE });
        self.nets.extend_from_slice(&self.base);
        let mut visited = 0;
        while let Some(cell) = self.cells.pop() {
            visited += 1;
            if visited > BUDGET {
                self.given_up += 1;
                return;
            }
            let first = self.cells.len() * len;
            match classify(&self.nets[first..], degrees, noise, cell.side) {
                Class::Empty | Class::EdgeOn => self.nets.truncate(first),
                Class::Point => {
                    self.roots.push(point(&self.base, degrees, cell, noise));
                    self.nets.truncate(first);
                }
                Class::Regular { contraction, border } => {
                    if let Some(x) = newton(&self.nets[first..], degrees, contraction, border) {
                        let at = cell.low + cell.side * x;
                        self.roots.push(polished(&self.base, degrees, at, cell.side * (border + 1e-6), noise));
                    }
                    self.nets.truncate(first);
                }
                Class::Mixed { along_u } => self.halve(cell, first, degrees, along_u),
            }
        }
    }

    fn halve(&mut self, cell: Cell, first: usize, degrees: Degrees, along_u: bool) {
        let len = net::count(degrees);
        self.nets.resize(first + 2 * len, DVec2::ZERO);
        let (low, high) = self.nets[first..].split_at_mut(len);
        let side = if along_u {
            net::halve_u(low, high, degrees);
            cell.side * DVec2::new(0.5, 1.0)
        } else {
            net::halve_v(low, high, degrees);
            cell.side * DVec2::new(1.0, 0.5)
        };
        self.cells.push(Cell { low: cell.low, side });
        self.cells.push(Cell { low: cell.low + (cell.side - side), side });
    }
}

enum Class {
    Empty,
    Regular { contraction: f64, border: f64 },
    Point,
    EdgeOn,
    Mixed { along_u: bool },
}

fn classify(net: &[DVec2], degrees: Degrees, noise: f64, side: DVec2) -> Class {
    let (lo, hi) = net::bounds(net);
    if lo.max_element() > noise || hi.min_element() < -noise {
        return Class::Empty;
    }
    if (-lo).max(hi).max_element() <= 2.0 * noise {
        return Class::Point;
    }
    let (mu, mv) = net::mean_slopes(net, degrees);
    if let Some(inverse) = Inverse::new(mu, mv)
        && let Some(contraction) = inverse.contraction(net, degrees)
    {
        return Class::Regular { contraction, border: BORDER + 4.0 * noise * inverse.rows().max_element() };
    }
    let longest = |it: &mut dyn Iterator<Item = DVec2>| {
        it.map(|d| (d.length_squared(), d)).fold((0.0, DVec2::X), |a, b| if b.0 > a.0 { b } else { a })
    };
    let u = longest(&mut net::slopes_u(net, degrees));
    let v = longest(&mut net::slopes_v(net, degrees));
    let along_u = u.0 >= v.0;
    // the same test as at the top, across the image's long direction: thin images are excluded early
    let across = (if along_u { u.1 } else { v.1 }).normalize_or(DVec2::X).perp();
    let (near, far) = net.iter().map(|p| across.dot(*p)).fold((f64::MAX, f64::MIN), |(a, b), d| (a.min(d), b.max(d)));
    if near > noise || far < -noise {
        return Class::Empty;
    }
    if near >= -2.0 * noise && far <= 2.0 * noise {
        if side.max_element() <= EDGE_ON {
            return Class::Point;
        }
        if u.0.max(v.0).sqrt() > LINE * noise {
            return Class::EdgeOn;
        }
    }
    Class::Mixed { along_u }
}

/// The inverse of the matrix with columns `u` and `v`, by rows.
struct Inverse {
    x: DVec2,
    y: DVec2,
}

impl Inverse {
    /// `None` when the columns are parallel to 12 digits: such a cell cannot be regular.
    fn new(u: DVec2, v: DVec2) -> Option<Self> {
        let det = u.perp_dot(v);
        (det.abs() > 1e-12 * u.length() * v.length())
            .then(|| Self { x: DVec2::new(v.y, -v.x) / det, y: DVec2::new(-u.y, u.x) / det })
    }

    fn apply(&self, d: DVec2) -> DVec2 {
        DVec2::new(self.x.dot(d), self.y.dot(d))
    }

    /// Row sums of absolute values: the change of each parameter by a unit error in both components.
    fn rows(&self) -> DVec2 {
        DVec2::new(self.x.abs().element_sum(), self.y.abs().element_sum())
    }

    /// `q` of the module's class 2, or `None` when it exceeds [`CONTRACTION`].
    fn contraction(&self, net: &[DVec2], degrees: Degrees) -> Option<f64> {
        let mut u = DVec2::ZERO;
        for d in net::slopes_u(net, degrees) {
            u = u.max((DVec2::X - self.apply(d)).abs());
            if u.max_element() > CONTRACTION {
                return None;
            }
        }
        let mut v = DVec2::ZERO;
        for d in net::slopes_v(net, degrees) {
            v = v.max((DVec2::Y - self.apply(d)).abs());
            if (u + v).max_element() > CONTRACTION {
                return None;
            }
        }
        Some((u + v).max_element())
    }
}

/// The zero of a regular cell, or the proof that there is none within `border` of it.
fn newton(net: &[DVec2], degrees: Degrees, contraction: f64, border: f64) -> Option<DVec2> {
    let (low, high) = (DVec2::splat(-border), DVec2::splat(1.0 + border));
    let rate = 2.0 * contraction / (1.0 - contraction);
    let mut x = DVec2::splat(0.5);
    let mut reach = 0.5 + border; // a root in the cell is no farther than this from x
    for _ in 0..NEWTON_STEPS {
        let (f, fu, fv) = net::jet(net, degrees, x.x, x.y);
        let step = Inverse::new(fu, fv)?.apply(f);
        let next = x - step;
        reach *= rate;
        if (next - next.clamp(low, high)).abs().max_element() > reach + border {
            return None;
        }
        x = next.clamp(low, high);
        if step.abs().max_element() <= border {
            return Some(x); // the step just made squares what was left
        }
    }
    None
}

/// Newton's method on the whole net, from a root of a cell: halving adds a rounding a level, and near a
/// fold the root may lie a little outside the cell. Stays within `leash` of the start.
fn polished(base: &[DVec2], degrees: Degrees, start: DVec2, leash: DVec2, noise: f64) -> Root {
    let mut root = Root { at: start, spread: DVec2::ZERO };
    for _ in 0..3 {
        let (f, fu, fv) = net::jet(base, degrees, root.at.x, root.at.y);
        let Some(inverse) = Inverse::new(fu, fv) else { break };
        root.spread = inverse.rows() * noise;
        let step = inverse.apply(f);
        if (root.at - step - start).abs().cmpgt(leash).any() {
            break;
        }
        root.at -= step;
        if step.abs().max_element() <= POLISHED {
            break;
        }
    }
    root
}

/// The root of a cell within rounding of 0. Next to a fold, Newton's method still separates its two roots; at a fold or
/// a pole it does not converge, and the middle is as good as any point.
fn point(base: &[DVec2], degrees: Degrees, cell: Cell, noise: f64) -> Root {
    let middle = cell.low + cell.side * 0.5;
    let mut at = middle;
    for _ in 0..6 {
        let (f, fu, fv) = net::jet(base, degrees, at.x, at.y);
        let Some(inverse) = Inverse::new(fu, fv) else { break };
        let step = inverse.apply(f);
        at -= step;
        let spread = inverse.rows() * noise;
        if (at - middle).abs().cmpgt(cell.side * NEIGHBOURS).any() || spread.cmpgt(cell.side).any() {
            break;
        }
        if step.abs().cmple(spread).all() {
            return Root { at, spread };
        }
    }
    Root { at: middle, spread: cell.side * 0.5 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The net of `f` sampled as a polynomial of degree (2, 2), by interpolation at 0, 1/2, 1.
    fn quadratic(f: impl Fn(f64, f64) -> DVec2) -> Vec<DVec2> {
        let row = |v: f64| {
            let (a, m, b) = (f(0.0, v), f(0.5, v), f(1.0, v));
            [a, m * 2.0 - (a + b) * 0.5, b]
        };
        let (r0, rm, r1) = (row(0.0), row(0.5), row(1.0));
        let mid: Vec<DVec2> = (0..3).map(|i| rm[i] * 2.0 - (r0[i] + r1[i]) * 0.5).collect();
        [&r0[..], &mid[..], &r1[..]].concat()
    }

    fn roots(net: Vec<DVec2>) -> Vec<Root> {
        let mut solver = Solver { base: net, ..Solver::default() };
        solver.solve((2, 2), 1e-15);
        assert_eq!(solver.given_up, 0);
        let mut roots = solver.roots;
        roots.sort_by(|a, b| a.at.x.total_cmp(&b.at.x));
        roots
    }

    #[test]
    fn a_fold_gives_both_roots_at_every_distance() {
        // u = 1/3 ± gap, v on a slope; the roots close in until they meet
        for gap in [0.3, 1e-2, 1e-4, 1e-6] {
            let r =
                roots(quadratic(|u, v| DVec2::new((u - 1.0 / 3.0) * (u - 1.0 / 3.0) - gap * gap, v - 0.4 + 0.1 * u)));
            assert_eq!(r.len(), 2, "gap {gap}: {r:?}");
            for (root, sign) in r.iter().zip([-1.0, 1.0]) {
                let u = 1.0 / 3.0 + sign * gap;
                // rounding moves a root by 1e-16 over the slope 2 gap
                assert!((root.at - DVec2::new(u, 0.4 - 0.1 * u)).length() < 1e-15 / gap, "gap {gap}: {root:?}");
            }
        }
    }

    #[test]
    fn a_tangent_gives_a_point_and_a_miss_gives_none() {
        let fold =
            |gap: f64| roots(quadratic(move |u, v| DVec2::new((u - 1.0 / 3.0).powi(2) + gap, v - 0.4 + 0.1 * u)));
        let r = fold(0.0);
        assert!(!r.is_empty() && r.iter().all(|r| (r.at - DVec2::new(1.0 / 3.0, 0.4 - 0.1 / 3.0)).length() < 1e-6));
        assert!(fold(1e-12).is_empty());
    }

    #[test]
    fn four_roots_of_two_hyperbolas() {
        let f = |u: f64, v: f64| {
            let (x, y) = (u - 0.47, v - 0.52);
            DVec2::new(x * x + y * y - 0.13, x * y - 0.04)
        };
        let r = roots(quadratic(f));
        assert_eq!(r.len(), 4);
        assert!(r.iter().all(|r| f(r.at.x, r.at.y).length() < 1e-15));
    }

    #[test]
    fn a_pole_is_a_point_and_an_edge_on_sheet_is_nothing() {
        let pole = roots(quadratic(|u, v| DVec2::new(v * (1.0 - u * u), v * 2.0 * u)));
        assert!(!pole.is_empty() && pole.iter().all(|r| r.at.y < 1e-14));
        assert!(roots(quadratic(|u, v| DVec2::new(u * u - 0.2 * v, 2.0 * u * u - 0.4 * v))).is_empty());
        // 0 on the border of the square: found once, not lost
        assert_eq!(roots(quadratic(|u, v| DVec2::new(u, v - 0.3))).len(), 1);
        assert_eq!(roots(quadratic(|u, v| DVec2::new(u + 1e-9, v - 0.3))).len(), 0);
    }
}
