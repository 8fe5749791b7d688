//! Loop's surfaces as quartic patches.
//!
//! ```text
//!   (0, 2)                        a triangle's quartic Bézier points become the net of a surface over the unit
//!    │╲        sector of c,       square that collapses at v = 1:
//!    │T2╲      level 1              S(u, v) = T((1 - u)(1 - v), u (1 - v), v)
//!    ┼───╲                        row k is the triangle's row of degree 4 - k, raised to degree 4: exact, and the
//!    │╲T3│╲                       control points of all three sides stand in the net's own sides
//!    │cap╲│T1╲
//!    c────┼────▶ (2, 0)
//! ```
//!
//! Sources: C. Loop, *Smooth subdivision surfaces based on triangles*, 1987; J. Stam, *Evaluation of Loop subdivision
//! surfaces*, 1998; M. Lai, *Fortran subroutines for B-nets of box splines on three- and four-directional meshes*,
//! 1992 (the Bézier points); borders from H. Hoppe et al., *Piecewise smooth surface reconstruction*, 1994.

use super::super::ConstructError;
use super::caps::{Level, beside, capped};
use super::limit::{Limit, weight};
use super::mesh::{Fan, Topology};
use super::quartic::{Quartic, apart, children, far_side, halves, put_far_side, surface};
use super::{Bound, NEGLIGIBLE, Scheme};
use crate::spline::Surface;
use glam::DVec3;
use std::array::from_fn;

/// Points of a sector: `[p][q]`, `p + q <= 3`.
type Sector = [[DVec3; 4]; 4];

/// Faces of a regular vertex: inside, and on a border.
const REGULAR: [usize; 2] = [6, 3];

/// The surfaces of a mesh of triangles.
pub(super) fn surfaces(mut mesh: Topology, tolerance: f64) -> Result<(Vec<Surface>, Bound), ConstructError> {
    if let Some(face) = (0..mesh.face_count()).find(|f| mesh.corners(*f).len() != 3) {
        return Err(ConstructError::Polygon { face, what: "is no triangle, which Loop's scheme needs" });
    }
    let irregular = |mesh: &Topology| -> Vec<bool> {
        let odd = |v: usize| mesh.used(v) && !mesh.fan(v).is_regular(mesh.sharp[v], REGULAR);
        (0..mesh.positions.len()).map(odd).collect()
    };
    let mut odd = irregular(&mesh);
    let mut bound = Bound::default();
    let alone = |mesh: &Topology, odd: &[bool], f: usize| mesh.corners(f).filter(|h| odd[mesh.origin(*h)]).count() <= 1;
    if !(0..mesh.face_count()).all(|f| alone(&mesh, &odd, f)) {
        mesh = refine(&mesh)?;
        odd = irregular(&mesh);
        bound.steps = 1;
    }
    let mut out: Vec<Vec<Surface>> = vec![Vec::new(); mesh.face_count()];
    for v in (0..mesh.positions.len()).filter(|v| odd[*v]) {
        let fan = mesh.fan(v);
        let made = Umbrella::new(&mesh, &fan, mesh.sharp[v]).surfaces(&mesh, &fan, tolerance, &mut bound)?;
        for (h, surfaces) in fan.out.iter().zip(made) {
            out[mesh.face_of(*h)] = surfaces;
        }
    }
    let mut all = Vec::with_capacity(out.len());
    for (f, surfaces) in out.into_iter().enumerate() {
        if surfaces.is_empty() {
            all.push(surface(&patch(&mesh, mesh.corners(f).start))?);
        }
        all.extend(surfaces);
    }
    Ok((all, bound))
}

fn edge_rule(a: DVec3, b: DVec3, left: DVec3, right: DVec3) -> DVec3 {
    ((a + b) * 3.0 + (left + right)) * 0.125
}

/// The new place of a vertex.
fn vertex_rule(c: DVec3, rays: &[DVec3], closed: bool, sharp: bool) -> DVec3 {
    if closed {
        let (n, w) = (rays.len(), weight(rays.len()));
        c * (1.0 - n as f64 * w) + rays.iter().sum::<DVec3>() * w
    } else if sharp {
        c
    } else {
        (c * 6.0 + (rays[0] + rays[rays.len() - 1])) * 0.125
    }
}

/// One step of the scheme for the whole mesh.
fn refine(mesh: &Topology) -> Result<Topology, ConstructError> {
    let (numbers, edges) = mesh.edges();
    let vertices = mesh.positions.len();
    let mut positions = mesh.positions.clone();
    positions.extend(vec![DVec3::ZERO; edges as usize]);
    for h in 0..mesh.half_edges() {
        let (a, b) = (mesh.at(h), mesh.at(mesh.next(h)));
        positions[vertices + numbers[h] as usize] = match mesh.twin(h) {
            Some(t) => edge_rule(a, b, mesh.at(mesh.prev(h)), mesh.at(mesh.prev(t))),
            None => (a + b) * 0.5,
        };
    }
    for v in (0..vertices).filter(|v| mesh.used(*v)) {
        let fan = mesh.fan(v);
        positions[v] = vertex_rule(mesh.positions[v], &mesh.rays(&fan), fan.closed, mesh.sharp[v]);
    }
    let mut sharp = mesh.sharp.clone();
    sharp.resize(positions.len(), false);
    let middle = |h: usize| vertices as u32 + numbers[h];
    let mut faces = Vec::with_capacity(4 * mesh.face_count());
    for f in 0..mesh.face_count() {
        let c = mesh.corners(f);
        faces.extend(c.clone().map(|h| vec![mesh.origin(h) as u32, middle(h), middle(mesh.prev(h))]));
        faces.push(c.map(middle).collect());
    }
    Topology::refined(positions, sharp, &faces)
}

/// A triangle and the rings of its corners: six neighbours of each, counter-clockwise from the next corner.
struct Net {
    corners: [DVec3; 3],
    rings: [[DVec3; 6]; 3],
}

/// The net around a face; beyond borders, points that reproduce the border's rules. The ring of an irregular corner is
/// not used.
fn net(mesh: &Topology, h: usize) -> Net {
    let sides = [h, mesh.next(h), mesh.prev(h)];
    let ring = |h: usize| {
        let c = mesh.at(h);
        let (mut after, mut before) = (vec![mesh.at(mesh.next(h)), mesh.at(mesh.prev(h))], Vec::new());
        let mut at = h;
        while let Some(on) = mesh.turned(at).filter(|_| after.len() < 6) {
            at = on;
            after.push(mesh.at(mesh.prev(at)));
        }
        at = h;
        while let Some(t) = mesh.twin(at).filter(|_| after.len() + before.len() < 6) {
            at = mesh.next(t);
            before.push(mesh.at(mesh.next(at)));
        }
        // mirrored at both ends of the border, for a corner twice
        while after.len() + before.len() < 6 {
            let n = after.len();
            let first = before.last().copied().unwrap_or(after[0]);
            let second = match before.len() {
                0 => after[1],
                1 => after[0],
                k => before[k - 2],
            };
            after.push((c + after[n - 1]) - after[n - 2]);
            before.push((c + first) - second);
        }
        before.reverse();
        after.extend(before);
        from_fn(|k| after[k])
    };
    Net { corners: sides.map(|h| mesh.at(h)), rings: sides.map(ring) }
}

/// A sum that does not depend on the order.
fn symmetric(mut terms: [DVec3; 3]) -> DVec3 {
    let mut out = [0.0; 3];
    for (axis, sum) in out.iter_mut().enumerate() {
        terms.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
        *sum = (terms[0][axis] + terms[1][axis]) + terms[2][axis];
    }
    DVec3::from_array(out)
}

/// The Bézier points of the box spline over a regular triangle.
///
/// Sums are ordered so that patches that share an edge of the net share Bézier points to the bit.
fn bezier(net: &Net) -> Quartic {
    let mut b = [[DVec3::ZERO; 5]; 5];
    // place of the point `along` steps towards the next corner and `across` towards the one before
    let place = |corner: usize, along: usize, across: usize| match corner {
        0 => (across, along),
        1 => (along, 4 - along - across),
        _ => (4 - along - across, across),
    };
    for c in 0..3 {
        let (a, r) = (net.corners[c], &net.rings[c]);
        let mut put = |along: usize, across: usize, p: DVec3| {
            let (k, i) = place(c, along, across);
            b[k][i] = p;
        };
        let around = symmetric([r[0] + r[3], r[1] + r[4], r[2] + r[5]]);
        put(0, 0, (a * 12.0 + around * 2.0) / 24.0);
        // towards neighbour d: the neighbours next to it, and those after them
        let near = |d: usize| {
            let n = |k: usize| r[(d + k) % 6];
            (a * 12.0 + n(0) * 4.0 + (n(1) + n(5)) * 3.0 + (n(2) + n(4))) / 24.0
        };
        put(1, 0, near(0));
        put(0, 1, near(1));
        put(1, 1, (a * 10.0 + (r[0] + r[1]) * 6.0 + (r[5] + r[2])) / 24.0);
        put(2, 0, ((a + r[0]) * 8.0 + (r[1] + r[5]) * 4.0) / 24.0);
    }
    b
}

/// The patch of a face, its first corner at `origin(h)`; its points at a border are the border's own.
fn patch(mesh: &Topology, h: usize) -> Quartic {
    const CORNER: [(usize, usize); 3] = [(0, 0), (4, 0), (0, 4)];
    let mut b = bezier(&net(mesh, h));
    let mut side = h;
    for k in 0..3 {
        let ((x, y), (u, v)) = (CORNER[k], CORNER[(k + 1) % 3]);
        if let Some(p) = mesh.border_point(mesh.origin(side)) {
            b[y][x] = p;
        }
        if let Some([p, q, r, s]) = mesh.border(side) {
            // a cubic as a quartic
            let raised = [p, (p + q * 3.0) * 0.25, (q + r) * 0.5, (s + r * 3.0) * 0.25, s];
            for (n, p) in raised.into_iter().enumerate() {
                b[(y * (4 - n) + v * n) / 4][(x * (4 - n) + u * n) / 4] = p;
            }
        }
        side = mesh.next(side);
    }
    b
}

/// The neighbourhood of one vertex at one level.
struct Umbrella {
    sectors: Vec<Sector>,
    closed: bool,
    sharp: bool,
}

impl Umbrella {
    /// Level 0: points with `p + q <= 2`.
    fn new(mesh: &Topology, fan: &Fan, sharp: bool) -> Self {
        let sector = |h: &usize| {
            let n = net(mesh, *h);
            let mut s = [[DVec3::ZERO; 4]; 4];
            (s[0][0], s[1][0], s[0][1]) = (n.corners[0], n.corners[1], n.corners[2]);
            // ring of the second corner: third corner, c, ..., straight on is opposite of c
            (s[2][0], s[1][1], s[0][2]) = (n.rings[1][4], n.rings[1][5], n.rings[2][3]);
            s
        };
        Self { sectors: fan.out.iter().map(sector).collect(), closed: fan.closed, sharp }
    }

    /// A point of sector `i`; one step beyond a ray (not beyond its vertex) is the neighbour's, or mirrored.
    fn at(&self, i: usize, p: i32, q: i32) -> DVec3 {
        let s = &self.sectors[i];
        if q < 0 {
            let p = p as usize;
            beside(&self.sectors, self.closed, i, false)
                .map_or_else(|| (s[p - 1][0] + s[p][0]) - s[p - 1][1], |o| o[1][p - 1])
        } else if p < 0 {
            let q = q as usize;
            beside(&self.sectors, self.closed, i, true)
                .map_or_else(|| (s[0][q - 1] + s[0][q]) - s[1][q - 1], |o| o[q - 1][1])
        } else {
            s[p as usize][q as usize]
        }
    }

    fn rays(&self) -> usize {
        self.sectors.len() + usize::from(!self.closed)
    }

    /// A point of ray `r`, `side` steps off it, `p` along: the neighbours are those of the hexagonal grid.
    fn ray(&self, r: usize, p: i32, side: i32) -> DVec3 {
        let n = self.sectors.len();
        if r < n { self.at(r, p, side) } else { self.at(n - 1, -side, p + side) }
    }

    /// The net of the triangle at `(p, q)`, turned by half where `sign` is -1.
    fn net(&self, i: usize, (p, q): (i32, i32), sign: i32) -> Net {
        const WAYS: [(i32, i32); 6] = [(1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)];
        let corners = [(0, 0), (1, 0), (0, 1)].map(|(x, y)| (p + sign * x, q + sign * y));
        let ring = |c: usize| -> [DVec3; 6] {
            from_fn(|k| {
                // the next corner comes first: ways 0, 2, 4
                let way = WAYS[(k + 2 * c) % 6];
                self.at(i, corners[c].0 + sign * way.0, corners[c].1 + sign * way.1)
            })
        };
        Net { corners: corners.map(|(x, y)| self.at(i, x, y)), rings: [ring(0), ring(1), ring(2)] }
    }

    /// T1, T2, T3 of the figure, at a level that was refined.
    fn ring(&self, i: usize) -> [Quartic; 3] {
        [((1, 0), 1), ((0, 1), 1), ((1, 1), -1)].map(|(at, sign)| bezier(&self.net(i, at, sign)))
    }

    /// Of each sector: its cap, then its rings from the vertex outwards.
    fn surfaces(
        self,
        mesh: &Topology,
        fan: &Fan,
        tolerance: f64,
        bound: &mut Bound,
    ) -> Result<Vec<Vec<Surface>>, ConstructError> {
        let limit = Limit::of(Scheme::Loop, mesh, fan);
        let count = self.sectors.len();
        let (levels, caps) = capped(self, count, &limit, tolerance, bound)?;
        let sector = |(i, (h, cap)): (usize, (&usize, Quartic))| {
            let whole = patch(mesh, *h);
            let mut outer = far_side(&whole);
            // the rays, where they are borders
            let mut along = mesh.twin(*h).is_none().then_some(whole[0]);
            let mut up_along = mesh.twin(mesh.prev(*h)).is_none().then(|| from_fn(|k| whole[k][0]));
            let mut all = Vec::new();
            for level in levels[1..].iter().rev() {
                all.push(level.ring(i));
            }
            // from the outside: each ring ends in halves of the side before it
            for [right, up, middle] in all.iter_mut().rev() {
                let [low, high] = halves(outer);
                put_far_side(right, low);
                put_far_side(up, high);
                if let Some(side) = &mut along {
                    [*side, right[0]] = halves(*side);
                }
                if let Some(side) = &mut up_along {
                    let [low, high] = halves(*side);
                    *side = low;
                    (0..5).for_each(|k| up[k][0] = high[k]);
                }
                // the middle one's corners are its neighbours'
                (middle[0][0], middle[4][0], middle[0][4]) = (right[4][0], right[0][0], up[0][0]);
                // the middle one's far side runs the other way, at the ring's inside
                outer = far_side(middle);
                outer.reverse();
            }
            let mut cap = cap;
            put_far_side(&mut cap, outer);
            if let Some(side) = along {
                cap[0] = side;
            }
            if let Some(side) = up_along {
                (0..5).for_each(|k| cap[k][0] = side[k]);
            }
            let rest = all.iter().flatten();
            [&cap].into_iter().chain(rest).map(surface).collect::<Result<Vec<_>, _>>()
        };
        fan.out.iter().zip(caps).enumerate().map(sector).collect()
    }
}

impl Level for Umbrella {
    type Patch = Quartic;

    fn refined(&self) -> Self {
        let rays: Vec<[DVec3; 3]> = (0..self.rays())
            .map(|r| {
                let at = |p: i32, side: i32| self.ray(r, p, side);
                let (c, e, f) = (at(0, 0), at(1, 0), at(2, 0));
                if !self.closed && (r == 0 || r + 1 == self.rays()) {
                    return [(c + e) * 0.5, (e * 6.0 + (c + f)) * 0.125, (e + f) * 0.5];
                }
                let ring = symmetric([at(1, 1) + at(1, -1), at(0, 1) + at(2, -1), c + f]);
                [edge_rule(c, e, at(0, 1), at(1, -1)), (e * 10.0 + ring) * 0.0625, edge_rule(e, f, at(1, 1), at(2, -1))]
            })
            .collect();
        let first: Vec<DVec3> = (0..self.rays()).map(|r| self.ray(r, 1, 0)).collect();
        let c = vertex_rule(self.sectors[0][0][0], &first, self.closed, self.sharp);
        let sectors = self.sectors.iter().enumerate().map(|(i, s)| {
            let mut new = [[DVec3::ZERO; 4]; 4];
            new[0][0] = c;
            let next = (i + 1) % rays.len();
            for k in 0..3 {
                new[k + 1][0] = rays[i][k];
                new[0][k + 1] = rays[next][k];
            }
            new[1][1] = edge_rule(s[1][0], s[0][1], s[0][0], s[1][1]);
            new[2][1] = edge_rule(s[1][0], s[1][1], s[2][0], s[0][1]);
            new[1][2] = edge_rule(s[0][1], s[1][1], s[0][2], s[1][0]);
            new
        });
        Self { sectors: sectors.collect(), closed: self.closed, sharp: self.sharp }
    }

    fn cap(&self, i: usize, limit: &Limit) -> Quartic {
        let at = |p: i32, q: i32| self.at(i, p, q);
        let c = at(0, 0);
        let corners = [c, at(1, 0), at(0, 1)];
        let rings = [
            // across the vertex any value will do: the points that depend on it are replaced below
            [at(1, 0), at(0, 1), at(-1, 1), c, c, at(1, -1)],
            [at(0, 1), c, at(1, -1), at(2, -1), at(2, 0), at(1, 1)],
            [c, at(1, 0), at(1, 1), at(0, 2), at(-1, 2), at(-1, 1)],
        ];
        let mut b = bezier(&Net { corners, rings });
        b[0][0] = limit.point;
        // the fourth difference vanishes, and the tangent is the limit's
        let first = |third: DVec3, second: DVec3, last: DVec3| {
            limit.tangent_plane((limit.point + second * 6.0 + last) * 0.25 - third)
        };
        b[0][1] = first(b[0][3], b[0][2], b[0][4]);
        b[1][0] = first(b[3][0], b[2][0], b[4][0]);
        let (by_row, by_column) = ((b[1][0] - b[1][3]) / 3.0 + b[1][2], (b[0][1] - b[3][1]) / 3.0 + b[2][1]);
        b[1][1] = (by_row + by_column) * 0.5;
        b
    }

    fn deviation(cap: &Quartic, i: usize, finer: &[Self], limit: DVec3) -> f64 {
        let (mut rest, mut most, mut remainder) = (*cap, 0.0f64, 0.0);
        for level in finer {
            let [low, right, up, middle] = children(&rest);
            for (mine, exact) in [right, up, middle].iter().zip(level.ring(i)) {
                most = most.max(apart(mine, &exact));
            }
            rest = low;
            let far = |most: f64, p: DVec3| most.max(p.distance(limit));
            let around = level.sectors.iter().flat_map(|s| [s[1][0], s[0][1], s[2][0], s[1][1], s[0][2]]);
            let own = (0..5).flat_map(|k| (0..5 - k).map(move |i| (k, i))).map(|(k, i)| rest[k][i]);
            remainder = around.fold(0.0, far) + own.fold(0.0, far);
            if remainder <= NEGLIGIBLE * most {
                break;
            }
        }
        most.max(remainder)
    }
}
