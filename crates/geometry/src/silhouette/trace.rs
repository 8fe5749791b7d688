//! Divides patches into cells in which a fold is a graph.

use super::Branch;
use super::net::{FoldNet, Side};
use crate::math::bernstein::{sign_changes, split, value};
use crate::spline::{PatchGrid, SurfacePatch};
use std::sync::Arc;

/// Where a cell is divided: not in the middle, where symmetric models have their folds.
const SHARE: f64 = 0.486_3;
/// Pixels: a cell this small is not divided further.
const SMALL: f64 = 0.002;
/// Divisions of a patch whose size in pixels is unknown.
const LEVELS: u32 = 24;
/// Cells of a patch; a fold without crossings takes some dozens.
const BUDGET: usize = 20_000;
/// Branches shorter than this share of a patch are dropped.
const SHORT: f64 = 1e-13;

/// The branches of all patches.
#[derive(Debug, Default)]
pub(super) struct Traced {
    pub branches: Vec<Branch>,
    pub unresolved: usize,
}

/// A rectangle of the unit square with its own coefficients.
struct Cell {
    u: (f64, f64),
    v: (f64, f64),
    values: Vec<f64>,
    level: u32,
}

/// The sign that all have, zero for those within `noise`; `None` where signs differ.
fn sign(values: impl Iterator<Item = f64>, noise: f64) -> Option<f64> {
    let mut sign = 0.0;
    for c in values.filter(|c| c.abs() > noise) {
        if sign * c < 0.0 {
            return None;
        }
        sign = c.signum();
    }
    Some(sign)
}

/// `net`: of a patch its function, and the sides on which that is zero; these count on the surface's own `borders`, too.
pub(super) fn branches(
    grid: &PatchGrid,
    borders: bool,
    net: impl Fn(&SurfacePatch) -> Option<(FoldNet, Vec<Side>)>,
) -> Traced {
    let mut out = Traced::default();
    for (index, patch) in grid.patches.iter().enumerate() {
        let Some((net, folds)) = net(patch) else { continue };
        let net = Arc::new(net);
        let (i, j) = (index % grid.count_u, index / grid.count_u);
        for side in folds {
            let at_border = match side {
                Side::Left => i == 0,
                Side::Right => i + 1 == grid.count_u,
                Side::Bottom => j == 0,
                Side::Top => j + 1 == grid.count_v,
            };
            if borders || !at_border {
                let bracket = (side.at(), side.at());
                out.branches.push(Branch { net: Arc::clone(&net), over_v: side.over_v(), range: (0.0, 1.0), bracket });
            }
        }
        patch_branches(&net, &mut out);
    }
    out
}

fn patch_branches(net: &Arc<FoldNet>, out: &mut Traced) {
    let mut cells = vec![Cell { u: (0.0, 1.0), v: (0.0, 1.0), values: net.values.clone(), level: 0 }];
    let mut visited = 0;
    let (n, k) = (net.n, net.k);
    while let Some(cell) = cells.pop() {
        visited += 1;
        if sign(cell.values.iter().copied(), net.noise).is_some() {
            continue;
        }
        let row = n + 1;
        let along_u = cell.values.chunks_exact(row).flat_map(|r| r.windows(2).map(|w| w[1] - w[0]));
        let along_v = cell.values.iter().zip(&cell.values[row..]).map(|(a, b)| b - a);
        // differences of coefficients have at most twice their rounding
        let graph_over_v = n > 0 && sign(along_u, 2.0 * net.noise).is_some_and(|s| s != 0.0);
        let graph_over_u = k > 0 && sign(along_v, 2.0 * net.noise).is_some_and(|s| s != 0.0);
        if graph_over_v || graph_over_u {
            graphs(net, &cell, graph_over_v, out);
            continue;
        }
        let side = (cell.u.1 - cell.u.0).max(cell.v.1 - cell.v.0);
        let small = net.pixels.is_finite() && side * net.pixels < SMALL;
        if small || cell.level >= LEVELS || visited > BUDGET {
            out.unresolved += 1;
            if visited > BUDGET {
                return;
            }
            continue;
        }
        divide(cell, (n, k), &mut cells);
    }
}

/// The branches of a cell in which `f` rises, or falls, all along `u` (`over_v`) or `v`.
fn graphs(net: &Arc<FoldNet>, cell: &Cell, over_v: bool, out: &mut Traced) {
    let (n, k) = (net.n, net.k);
    let at = |i: usize, j: usize| cell.values[j * (n + 1) + i];
    let [low, high]: [Vec<f64>; 2] = if over_v {
        [0, n].map(|i| (0..=k).map(|j| at(i, j)).collect())
    } else {
        [0, k].map(|j| (0..=n).map(|i| at(i, j)).collect())
    };
    let mut cuts = vec![0.0, 1.0];
    for side in [&low, &high] {
        cuts.extend(sign_changes(side, &vec![net.noise; side.len()]));
    }
    cuts.sort_by(f64::total_cmp);
    let (along, bracket) = if over_v { (cell.v, cell.u) } else { (cell.u, cell.v) };
    let place = |t: f64| along.0 + (along.1 - along.0) * t;
    for pair in cuts.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        if pair[1] - pair[0] > SHORT && value(&low, middle) * value(&high, middle) < 0.0 {
            let range = (place(pair[0]), place(pair[1]));
            out.branches.push(Branch { net: Arc::clone(net), over_v, range, bracket });
        }
    }
}

fn divide(cell: Cell, (n, k): (usize, usize), cells: &mut Vec<Cell>) {
    let level = cell.level + 1;
    let parts = |(a, b): (f64, f64)| {
        let middle = a + (b - a) * SHARE;
        [(a, middle), (middle, b)]
    };
    let (mut left, mut right) = (cell.values.clone(), cell.values);
    for (l, r) in left.chunks_exact_mut(n + 1).zip(right.chunks_exact_mut(n + 1)) {
        r.copy_from_slice(&split(l, SHARE));
    }
    for (u, half) in parts(cell.u).into_iter().zip([left, right]) {
        let (mut low, mut high) = (half.clone(), half);
        for i in 0..=n {
            let mut column: Vec<f64> = (0..=k).map(|j| low[j * (n + 1) + i]).collect();
            let rest = split(&mut column, SHARE);
            for j in 0..=k {
                low[j * (n + 1) + i] = column[j];
                high[j * (n + 1) + i] = rest[j];
            }
        }
        for (v, values) in parts(cell.v).into_iter().zip([low, high]) {
            cells.push(Cell { u, v, values, level });
        }
    }
}
