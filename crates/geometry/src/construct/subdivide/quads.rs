//! Catmull-Clark surfaces as bicubic patches.
//!
//! ```text
//!   a sector of an irregular vertex c, levels 1 and 2 of its rings, and the cap
//!
//!   q  C1 │ B1        (p, q): from c along its two rays; S maps [0, 1]² to the face
//!      ───┼────       A, B, C: exact patches of the level's B-spline nets
//!      C2│B2│         cap: bicubic, C¹ to the rings, through the limit point of c,
//!      ──┼──│ A1           tangent to the limit plane
//!   cap  │A2│
//!   c ──────────▶ p
//! ```
//!
//! Sources: E. Catmull, J. Clark, *Recursively generated B-spline surfaces on arbitrary topological meshes*, 1978;
//! J. Stam, *Exact evaluation of Catmull-Clark subdivision surfaces at arbitrary parameter values*, 1998; limits from
//! M. Halstead, M. Kass, T. DeRose, *Efficient, fair interpolation using Catmull-Clark surfaces*, 1993; borders from
//! A. Nasri, *Polyhedral subdivision methods for free-form surfaces*, 1987.

use super::super::ConstructError;
use super::caps::{Level, beside, capped};
use super::limit::Limit;
use super::mesh::{Fan, Topology};
use super::{Bound, NEGLIGIBLE, Scheme};
use crate::spline::Surface;
use glam::DVec3;
use std::array::from_fn;

/// Bézier points of a bicubic patch, `[j][i]`, `i` along `u`.
type Cubic = [[DVec3; 4]; 4];
/// Points of a sector: `[p][q]`.
type Sector = [[DVec3; 4]; 4];

/// Faces of a regular vertex: inside, and on a border.
const REGULAR: [usize; 2] = [4, 2];

/// The surfaces of a mesh, and where its irregular vertices are.
pub(super) fn surfaces(mut mesh: Topology, tolerance: f64) -> Result<(Vec<Surface>, Bound), ConstructError> {
    let mut irregular;
    let mut steps = 0;
    loop {
        irregular = (0..mesh.positions.len())
            .map(|v| mesh.used(v) && !mesh.fan(v).is_regular(mesh.sharp[v], REGULAR))
            .collect::<Vec<bool>>();
        let alone = |f: usize| {
            let corners = mesh.corners(f);
            corners.len() == 4 && corners.filter(|h| irregular[mesh.origin(*h)]).count() <= 1
        };
        // one step makes quadrilaterals, a second one separates the irregular vertices that it made
        if (0..mesh.face_count()).all(alone) {
            break;
        }
        mesh = refine(&mesh)?;
        steps += 1;
    }
    let mut out: Vec<Option<Surface>> = vec![None; mesh.face_count()];
    let mut bound = Bound { steps, ..Bound::default() };
    for v in (0..mesh.positions.len()).filter(|v| irregular[*v]) {
        let fan = mesh.fan(v);
        let made = Umbrella::new(&mesh, &fan, mesh.sharp[v]).surfaces(&mesh, &fan, tolerance, &mut bound)?;
        for (h, surface) in fan.out.iter().zip(made) {
            out[mesh.face_of(*h)] = Some(surface);
        }
    }
    let mut all = Vec::with_capacity(out.len());
    for (f, surface) in out.into_iter().enumerate() {
        all.push(match surface {
            Some(surface) => surface,
            None => single(&patch(&mesh, mesh.corners(f).start))?,
        });
    }
    Ok((all, bound))
}

/// One step of the scheme for the whole mesh; polygons become quadrilaterals.
fn refine(mesh: &Topology) -> Result<Topology, ConstructError> {
    let (numbers, edges) = mesh.edges();
    let vertices = mesh.positions.len();
    let mut positions = mesh.positions.clone();
    let centres: Vec<DVec3> = (0..mesh.face_count())
        .map(|f| mesh.corners(f).map(|h| mesh.at(h)).sum::<DVec3>() / mesh.corners(f).len() as f64)
        .collect();
    positions.extend(vec![DVec3::ZERO; edges as usize]);
    for h in 0..mesh.half_edges() {
        let (a, b) = (mesh.at(h), mesh.at(mesh.next(h)));
        positions[vertices + numbers[h] as usize] = match mesh.twin(h) {
            Some(t) => ((a + b) + (centres[mesh.face_of(h)] + centres[mesh.face_of(t)])) * 0.25,
            None => (a + b) * 0.5,
        };
    }
    positions.extend(&centres);
    for v in (0..vertices).filter(|v| mesh.used(*v)) {
        let fan = mesh.fan(v);
        let rays = mesh.rays(&fan);
        let middles = fan.out.iter().map(|h| centres[mesh.face_of(*h)]).sum();
        positions[v] = vertex_rule(mesh.positions[v], &rays, middles, fan.closed, mesh.sharp[v]);
    }
    let mut sharp = mesh.sharp.clone();
    sharp.resize(positions.len(), false);
    let middle = |h: usize| vertices as u32 + numbers[h];
    let mut faces = Vec::with_capacity(mesh.half_edges());
    for f in 0..mesh.face_count() {
        let centre = vertices as u32 + edges + f as u32;
        faces.extend(mesh.corners(f).map(|h| vec![mesh.origin(h) as u32, middle(h), centre, middle(mesh.prev(h))]));
    }
    Topology::refined(positions, sharp, &faces)
}

/// The new place of a vertex; `middles` is the sum of the centres of its faces.
fn vertex_rule(c: DVec3, rays: &[DVec3], middles: DVec3, closed: bool, sharp: bool) -> DVec3 {
    if closed {
        let n = rays.len() as f64;
        c * ((n - 2.0) / n) + (rays.iter().sum::<DVec3>() + middles) / (n * n)
    } else if sharp {
        c
    } else {
        (c * 6.0 + (rays[0] + rays[rays.len() - 1])) * 0.125
    }
}

/// The 4 x 4 net around a face, its corner `origin(h)` at (1, 1), the next one at (2, 1); beyond a border points are
/// mirrored. The point diagonally across an irregular corner is not used.
fn net(mesh: &Topology, h: usize) -> Cubic {
    const AT: [(i32, i32); 4] = [(1, 1), (2, 1), (2, 2), (1, 2)];
    const OUT: [(i32, i32); 4] = [(0, -1), (1, 0), (0, 1), (-1, 0)];
    let mut g = [[DVec3::ZERO; 4]; 4];
    let mut sides = [h; 4];
    for k in 1..4 {
        sides[k] = mesh.next(sides[k - 1]);
    }
    let add = |a: (i32, i32), b: (i32, i32), s: i32| (a.0 + s * b.0, a.1 + s * b.1);
    let get = |g: &Cubic, at: (i32, i32)| g[at.1 as usize][at.0 as usize];
    for k in 0..4 {
        g[AT[k].1 as usize][AT[k].0 as usize] = mesh.at(sides[k]);
    }
    for k in 0..4 {
        let ends = [AT[k], AT[(k + 1) % 4]];
        let beyond = match mesh.twin(sides[k]) {
            Some(t) => [mesh.at(mesh.next(mesh.next(t))), mesh.at(mesh.prev(t))],
            None => ends.map(|e| get(&g, e) * 2.0 - get(&g, add(e, OUT[k], -1))),
        };
        for (e, p) in ends.into_iter().zip(beyond) {
            let to = add(e, OUT[k], 1);
            g[to.1 as usize][to.0 as usize] = p;
        }
    }
    for k in 0..4 {
        let (one, other) = (OUT[k], OUT[(k + 3) % 4]);
        let across = mesh.twin(sides[k]).zip(mesh.twin(sides[(k + 3) % 4]));
        let p = match across {
            // around the corner, as far as there are faces
            Some((t, _)) => match mesh.twin(mesh.next(t)) {
                Some(diagonal) => mesh.at(mesh.prev(diagonal)),
                None => DVec3::ZERO,
            },
            None => {
                // mirrored at the side that is a border
                let (along, beyond) = if mesh.twin(sides[k]).is_some() { (one, other) } else { (other, one) };
                let from = add(AT[k], along, 1);
                get(&g, from) * 2.0 - get(&g, add(from, beyond, -1))
            }
        };
        let to = add(add(AT[k], one, 1), other, 1);
        g[to.1 as usize][to.0 as usize] = p;
    }
    g
}

/// The Bézier points of the uniform bicubic B-spline patch over the net's middle cell.
///
/// Sums are ordered so that patches that share an edge of the net share Bézier points to the bit.
fn bezier(g: &Cubic) -> Cubic {
    from_fn(|j| {
        from_fn(|i| {
            // the corner of the cell, and the ways in from there
            let (cx, cy) = (if i < 2 { 1i32 } else { 2 }, if j < 2 { 1i32 } else { 2 });
            let (dx, dy) = (if i < 2 { 1 } else { -1 }, if j < 2 { 1 } else { -1 });
            let at = |x: i32, y: i32| g[(cy + y * dy) as usize][(cx + x * dx) as usize];
            let edge = |along: DVec3, left: [DVec3; 2], right: [DVec3; 2]| {
                ((at(0, 0) * 2.0 + along) * 4.0 + ((left[0] * 2.0 + left[1]) + (right[0] * 2.0 + right[1]))) / 18.0
            };
            match (i == 1 || i == 2, j == 1 || j == 2) {
                (true, true) => (at(0, 0) * 4.0 + (at(1, 0) + at(0, 1)) * 2.0 + at(1, 1)) / 9.0,
                (true, false) => edge(at(1, 0), [at(0, 1), at(1, 1)], [at(0, -1), at(1, -1)]),
                (false, true) => edge(at(0, 1), [at(1, 0), at(1, 1)], [at(-1, 0), at(-1, 1)]),
                (false, false) => {
                    let sides = (at(1, 0) + at(-1, 0)) + (at(0, 1) + at(0, -1));
                    let corners = (at(1, 1) + at(-1, -1)) + (at(-1, 1) + at(1, -1));
                    (at(0, 0) * 16.0 + sides * 4.0 + corners) / 36.0
                }
            }
        })
    })
}

/// The patch of a face, `(0, 0)` at `origin(h)`; its points at a border are the border's own. Its points at an
/// irregular vertex inside are not used.
fn patch(mesh: &Topology, h: usize) -> Cubic {
    const CORNER: [(usize, usize); 4] = [(0, 0), (3, 0), (3, 3), (0, 3)];
    let mut b = bezier(&net(mesh, h));
    let mut side = h;
    for k in 0..4 {
        let ((x, y), (u, v)) = (CORNER[k], CORNER[(k + 1) % 4]);
        if let Some(p) = mesh.border_point(mesh.origin(side)) {
            b[y][x] = p;
        }
        for (n, p) in mesh.border(side).into_iter().flatten().enumerate() {
            b[(y * (3 - n) + v * n) / 3][(x * (3 - n) + u * n) / 3] = p;
        }
        side = mesh.next(side);
    }
    b
}

/// Halves of a cubic by de Casteljau's algorithm.
fn halves(c: [DVec3; 4]) -> [[DVec3; 4]; 2] {
    let m = |a: DVec3, b: DVec3| (a + b) * 0.5;
    let (a, b, d) = (m(c[0], c[1]), m(c[1], c[2]), m(c[2], c[3]));
    let (e, f) = (m(a, b), m(b, d));
    let g = m(e, f);
    [[c[0], a, e, g], [g, f, d, c[3]]]
}

fn turned(b: &Cubic) -> Cubic {
    from_fn(|j| from_fn(|i| b[i][j]))
}

/// Lower and upper half along `v`.
fn split_v(b: &Cubic) -> [Cubic; 2] {
    let columns: [[[DVec3; 4]; 2]; 4] = from_fn(|i| halves(from_fn(|j| b[j][i])));
    from_fn(|half| from_fn(|j| from_fn(|i| columns[i][half][j])))
}

/// Quarters `[low v, high v]` of `[low u, high u]`.
fn quarters(b: &Cubic) -> [[Cubic; 2]; 2] {
    let [low, high] = split_v(b);
    [low, high].map(|half| split_v(&turned(&half)).map(|q| turned(&q)))
}

/// Largest distance between control points: a bound on that between the patches at equal parameters.
fn apart(a: &Cubic, b: &Cubic) -> f64 {
    a.as_flattened().iter().zip(b.as_flattened()).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max)
}

fn single(b: &Cubic) -> Result<Surface, ConstructError> {
    let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let points = b.as_flattened().iter().map(|p| p.extend(1.0)).collect();
    Ok(Surface::new((3, 3), knots.clone(), knots, points)?)
}

/// The neighbourhood of one vertex at one level: sectors between rays, each with its points up to 3 along both.
struct Umbrella {
    sectors: Vec<Sector>,
    closed: bool,
    sharp: bool,
}

impl Umbrella {
    /// Level 0; only points up to 2 are used.
    fn new(mesh: &Topology, fan: &Fan, sharp: bool) -> Self {
        let sector = |h: &usize| {
            let g = net(mesh, *h);
            from_fn(|p| from_fn(|q| if p < 3 && q < 3 { g[q + 1][p + 1] } else { DVec3::ZERO }))
        };
        Self { sectors: fan.out.iter().map(sector).collect(), closed: fan.closed, sharp }
    }

    /// A point of sector `i`; one step beyond a ray is the neighbour's, or mirrored.
    fn at(&self, i: usize, p: i32, q: i32) -> DVec3 {
        let s = &self.sectors[i];
        if q < 0 {
            let p = p as usize;
            beside(&self.sectors, self.closed, i, false).map_or_else(|| s[p][0] * 2.0 - s[p][1], |o| o[1][p])
        } else if p < 0 {
            let q = q as usize;
            beside(&self.sectors, self.closed, i, true).map_or_else(|| s[0][q] * 2.0 - s[1][q], |o| o[q][1])
        } else {
            s[p as usize][q as usize]
        }
    }

    fn rays(&self) -> usize {
        self.sectors.len() + usize::from(!self.closed)
    }

    /// Points 0 to 2 along a ray, and one step to either side of it.
    fn ray(&self, r: usize) -> [[DVec3; 3]; 3] {
        let n = self.sectors.len();
        if r < n {
            from_fn(|side| from_fn(|p| self.at(r, p as i32, side as i32 - 1)))
        } else {
            // the last ray of an open fan: the other axis of the last sector
            from_fn(|side| from_fn(|p| self.at(n - 1, 1 - side as i32, p as i32)))
        }
    }

    fn first_ring(&self) -> Vec<DVec3> {
        (0..self.rays()).map(|r| self.ray(r)[1][1]).collect()
    }

    /// The patch over the cell from `(p, q)`.
    fn patch(&self, i: usize, p: i32, q: i32) -> Cubic {
        bezier(&from_fn(|y| from_fn(|x| self.at(i, p - 1 + x as i32, q - 1 + y as i32))))
    }

    /// Patches A, B, C of the figure: of a level that was refined.
    fn ring(&self, i: usize) -> [Cubic; 3] {
        [(1, 0), (1, 1), (0, 1)].map(|(p, q)| self.patch(i, p, q))
    }

    /// The sectors' surfaces: as many rings as the cap needs to be within the tolerance.
    fn surfaces(
        self,
        mesh: &Topology,
        fan: &Fan,
        tolerance: f64,
        bound: &mut Bound,
    ) -> Result<Vec<Surface>, ConstructError> {
        let limit = Limit::of(Scheme::CatmullClark, mesh, fan);
        let count = self.sectors.len();
        let (levels, caps) = capped(self, count, &limit, tolerance, bound)?;
        fan.out.iter().zip(caps).enumerate().map(|(i, (h, cap))| sector(&levels, i, &cap, (mesh, *h))).collect()
    }
}

impl Level for Umbrella {
    type Patch = Cubic;

    /// Points up to 3.
    fn refined(&self) -> Self {
        let along = |x: [DVec3; 3]| {
            let [a, b, c] = x;
            [(a + b) * 0.5, (b * 6.0 + (a + c)) * 0.125, (b + c) * 0.5]
        };
        let rays: Vec<[DVec3; 3]> = (0..self.rays())
            .map(|r| {
                let [right, own, left] = self.ray(r).map(along);
                let border = !self.closed && (r == 0 || r + 1 == self.rays());
                from_fn(|k| if border { own[k] } else { (own[k] * 6.0 + (right[k] + left[k])) * 0.125 })
            })
            .collect();
        let c = self.sectors[0][0][0];
        let middle = |s: &Sector| ((s[0][0] + s[1][1]) + (s[1][0] + s[0][1])) * 0.25;
        let middles = self.sectors.iter().map(middle).sum();
        let c = vertex_rule(c, &self.first_ring(), middles, self.closed, self.sharp);
        let sectors = self.sectors.iter().enumerate().map(|(i, s)| {
            let rows: [[DVec3; 3]; 3] = from_fn(|p| along([s[p][0], s[p][1], s[p][2]]));
            let columns: [[DVec3; 3]; 3] = from_fn(|q| along([rows[0][q], rows[1][q], rows[2][q]]));
            let next = (i + 1) % rays.len();
            from_fn(|p| {
                from_fn(|q| match (p, q) {
                    (0, 0) => c,
                    (p, 0) => rays[i][p - 1],
                    (0, q) => rays[next][q - 1],
                    (p, q) => columns[q - 1][p - 1],
                })
            })
        });
        Self { sectors: sectors.collect(), closed: self.closed, sharp: self.sharp }
    }

    /// Over `[0, 1]²`.
    fn cap(&self, i: usize, limit: &Limit) -> Cubic {
        let mut g: Cubic =
            from_fn(|y| from_fn(|x| if x + y == 0 { DVec3::ZERO } else { self.at(i, x as i32 - 1, y as i32 - 1) }));
        // diagonally across the vertex: any value will do, since the only point that depends on it is replaced below
        g[0][0] = g[1][1];
        let mut b = bezier(&g);
        b[0][0] = limit.point;
        // the third difference vanishes, and the tangent is the limit's
        b[0][1] = limit.tangent_plane((limit.point - b[0][3]) / 3.0 + b[0][2]);
        b[1][0] = limit.tangent_plane((limit.point - b[3][0]) / 3.0 + b[2][0]);
        let (by_u, by_v) = ((b[1][0] - b[1][3]) / 3.0 + b[1][2], (b[0][1] - b[3][1]) / 3.0 + b[2][1]);
        b[1][1] = (by_u + by_v) * 0.5;
        b
    }

    fn deviation(cap: &Cubic, i: usize, finer: &[Self], limit: DVec3) -> f64 {
        let (mut rest, mut most) = (*cap, 0.0f64);
        let mut remainder = 0.0;
        for level in finer {
            let [[low, right], [left, high]] = quarters(&rest);
            for (mine, exact) in [right, high, left].iter().zip(level.ring(i)) {
                most = most.max(apart(mine, &exact));
            }
            rest = low;
            // the rest of the surface lies within the hull of these points
            let around = level.sectors.iter().flat_map(|s| s[..3].iter().flat_map(|r| &r[..3]));
            let far = |most: f64, p: &DVec3| most.max(p.distance(limit));
            remainder = around.fold(0.0, far) + rest.as_flattened().iter().fold(0.0, far);
            if remainder <= NEGLIGIBLE * most {
                break;
            }
        }
        most.max(remainder)
    }
}

/// One face: cap and rings as one surface, its far sides halves of the face's own sides.
fn sector(
    levels: &[Umbrella],
    i: usize,
    cap: &Cubic,
    (mesh, h): (&Topology, usize),
) -> Result<Surface, ConstructError> {
    let rings = levels.len() - 1;
    let cells = rings + 1;
    let size = 3 * cells + 1;
    let mut points = vec![DVec3::ZERO; size * size];
    let mut put = |a: usize, b: usize, patch: &Cubic| {
        for (j, row) in patch.iter().enumerate() {
            for (k, p) in row.iter().enumerate() {
                points[(3 * b + j) * size + 3 * a + k] = *p;
            }
        }
    };
    put(0, 0, cap);
    for m in 1..cells {
        let [a, b, c] = levels[rings + 1 - m].ring(i);
        put(m, m, &b);
        // the arms are cut where the finer rings end
        let (mut right, mut up) = (a, turned(&c));
        for n in (0..m).rev() {
            if n > 0 {
                let [low, high] = split_v(&right);
                put(m, n, &high);
                right = low;
                let [low, high] = split_v(&up);
                put(n, m, &turned(&high));
                up = low;
            } else {
                put(m, 0, &right);
                put(0, m, &turned(&up));
            }
        }
    }
    // the face's far sides, and those that are borders: start and step in the net, and the side
    let whole = patch(mesh, h);
    let row = |j: usize| whole[j];
    let column = |k: usize| -> [DVec3; 4] { from_fn(|j| whole[j][k]) };
    let mut sides = vec![((size - 1) * size, 1, row(3)), (size - 1, size, column(3))];
    sides.extend(mesh.twin(h).is_none().then(|| (0, 1, row(0))));
    sides.extend(mesh.twin(mesh.prev(h)).is_none().then(|| (0, size, column(0))));
    for (start, step, mut side) in sides {
        for n in (0..cells).rev() {
            let piece = if n > 0 {
                let [low, high] = halves(side);
                side = low;
                high
            } else {
                side
            };
            for (k, p) in piece.into_iter().enumerate() {
                points[start + step * (3 * n + k)] = p;
            }
        }
    }
    let mut knots = vec![0.0; 4];
    for m in 1..cells {
        knots.extend([0.5f64.powi((cells - m) as i32); 3]);
    }
    knots.extend([1.0; 4]);
    let points = points.into_iter().map(|p| p.extend(1.0)).collect();
    Ok(Surface::new((3, 3), knots.clone(), knots, points)?)
}
