//! The sun's picture: tiles across its rays, each with a list of what may cast shadows in it.
//!
//! ```text
//!        ☀  rays are parallel: one picture for all frames    right ▶
//!        │                                          ┌────┬────┬────┐ up ▲   tiles; each lists the leaves whose boxes
//!   ┌────┴────┐  boxes of leaves ──────────────────▶│ A  │ AB │ B  │        reach it, and their Blist; triangles of
//!   ▼         ▼  triangles, facets                  └────┴────┴────┘        operands without equations; facets of parts
//! ```
//!
//! For the eye, passes `solid_rects` to `solid_fold` make such lists in each frame. For the sun they are made once, on
//! the CPU in `f64`, since they depend only on the scene and the sun. A point beside the picture belongs to the nearest
//! tile, because everything that casts shadows lies within the picture. [`casters`] collects what casts shadows;
//! [`faces`] and [`region`] turn trimmed faces into triangles.

mod casters;
mod faces;
mod region;

use super::solids::SolidData;
use crate::abi::{
    self, EXIT_FALSE, EXIT_TRUE, LEAF_FALLS, LEAF_UNBOUNDED, Leaf, SunFacet, SunTile, SunTriangle, TileLeaf,
};
use crate::model::Model;
use casters::{Casters, Facet, Flat};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// The sun of a scene.
#[derive(Clone, Debug)]
pub(crate) struct SunData {
    /// Unit vector towards the sun.
    towards: DVec3,
    /// Unit vector across the rays.
    right: DVec3,
    up: DVec3,
    /// The corner of the first tile, along `right` and `up`.
    corner: DVec2,
    /// Side of a tile, in model units.
    side: f64,
    /// Number of tiles along `right` and `up`; 0 if nothing casts shadows.
    across: [u32; 2],
    pub tiles: Vec<SunTile>,
    pub leaves: Vec<TileLeaf>,
    pub triangles: Vec<SunTriangle>,
    pub facets: Vec<SunFacet>,
    /// The triangles of each tile, and after all of them the facets of each tile.
    pub lists: Vec<u32>,
    /// Middles of the parts with facets, in model coordinates.
    pub middles: Vec<DVec3>,
    /// Number of parts and operands that are left out for want of room.
    pub left_out: usize,
    /// Largest deviation of the flattened spline faces, in model units.
    pub deviation: f64,
}

/// Wanted number of tiles for each leaf or triangle, and most tiles of all: then lists of casters side by side are
/// short.
const TILES_EACH: usize = 4;
const MOST_TILES: usize = 1 << 16;
/// Most entries of all lists, for each leaf or triangle, beyond a number that small scenes may have. Casters that lie
/// behind each other exceed it and get larger tiles.
const ENTRIES_EACH: u64 = 32;
const FEW_ENTRIES: u64 = 1 << 16;
/// Most entries of all lists in any scene: 64 MiB.
const MOST_ENTRIES: u64 = 1 << 24;
/// Margin around a box, in tiles. It is larger than the rounding of a point seen from an eye a thousand scenes away.
const MARGIN: f64 = 1.0 / 32.0;
/// Least side of a tile, in model units: its inverse is finite in single precision.
const LEAST_SIDE: f64 = 1e-30;

/// A box across the rays, in model units.
#[derive(Clone, Copy)]
struct Square {
    low: DVec2,
    high: DVec2,
}

/// First and last tile that something reaches.
#[derive(Clone, Copy)]
struct Rect {
    first: [u32; 2],
    last: [u32; 2],
}

impl SunData {
    /// `towards` is finite and not 0; its square may overflow or vanish. `placed` is the model whose instances cast
    /// shadows; all of them are drawn.
    pub(super) fn new(towards: DVec3, solids: &SolidData, placed: Option<&Model>) -> Self {
        let towards = (towards / towards.abs().max_element()).normalize();
        let (right, up) = towards.any_orthonormal_pair();
        let leaves = &solids.leaves[..solids.followed as usize];
        let mut sun = Self {
            towards,
            right,
            up,
            corner: DVec2::ZERO,
            side: 1.0,
            across: [0; 2],
            tiles: Vec::new(),
            leaves: Vec::new(),
            triangles: Vec::new(),
            facets: Vec::new(),
            lists: Vec::new(),
            middles: Vec::new(),
            left_out: 0,
            deviation: 0.0,
        };
        let Casters { triangles, facets, middles, left_out, deviation } = Casters::new(&sun, solids, placed);
        let flat: Vec<DVec2> = middles.iter().map(|m| sun.flat(*m)).collect();
        (sun.middles, sun.left_out, sun.deviation) = (middles, left_out, deviation);
        if leaves.is_empty() && facets.is_empty() {
            return sun;
        }
        let leaf = |(leaf, centre): (&Leaf, &DVec3)| sun.square_of(leaf, *centre);
        let boxes: Vec<Option<Square>> = leaves.iter().zip(&solids.leaf_centres).map(leaf).collect();
        let of_facet = |facet: &Facet| {
            let (low, high) = facet.square(&flat);
            Square { low, high }
        };
        let ends = boxes.iter().flatten().copied().chain(facets.iter().map(of_facet));
        let (low, high) =
            ends.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), b| (lo.min(b.low), hi.max(b.high)));
        // one tile if there is nothing, or if the size is not finite
        let size = if low.cmple(high).all() && (high - low).is_finite() { high - low } else { DVec2::ZERO };
        sun.corner = if low.is_finite() { low } else { DVec2::ZERO };
        let count = leaves.len() + triangles.len() + facets.len();
        let wanted = (TILES_EACH * count).clamp(1, MOST_TILES) as f64;
        // `wanted` square tiles, or a row of `wanted` tiles
        let square = size.x.sqrt() * size.y.sqrt() / wanted.sqrt();
        sun.side = square.max(size.max_element() / wanted).max(LEAST_SIDE);
        let most = (FEW_ENTRIES + ENTRIES_EACH * count as u64).min(MOST_ENTRIES);
        let (of_leaves, of_triangles, of_facets) = loop {
            sun.across = size.to_array().map(|s| (s / sun.side).ceil().clamp(1.0, MOST_TILES as f64) as u32);
            let of_leaves: Vec<Rect> = boxes.iter().map(|b| sun.rect_of(*b)).collect();
            let of_triangles: Vec<Rect> = triangles.iter().map(|t| sun.rect_of(Some(square_of(t)))).collect();
            let of_facets: Vec<Rect> = facets.iter().map(|f| sun.rect_of(Some(of_facet(f)))).collect();
            let entries: u64 = [&of_leaves, &of_triangles, &of_facets].into_iter().flatten().map(Rect::count).sum();
            if entries <= most || sun.across == [1; 2] {
                break (of_leaves, of_triangles, of_facets);
            }
            sun.side *= 2.0;
        };
        sun.triangles = triangles.iter().map(|t| t.stored(sun.side)).collect();
        sun.facets = facets.iter().map(|f| f.stored(sun.side)).collect();
        sun.list(leaves, &of_leaves, &of_triangles, &of_facets);
        sun
    }

    fn flat(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.right.dot(p), self.up.dot(p))
    }

    /// The box of a leaf across the rays; `None` if the leaf is unbounded.
    fn square_of(&self, leaf: &Leaf, centre: DVec3) -> Option<Square> {
        let half = DVec3::from_array(leaf.half_size.map(f64::from));
        let bounded = leaf.flags & LEAF_UNBOUNDED == 0 && half.is_finite() && centre.is_finite();
        let (middle, reach) = (self.flat(centre), DVec2::new(self.right.abs().dot(half), self.up.abs().dot(half)));
        bounded.then_some(Square { low: middle - reach, high: middle + reach })
    }

    fn rect_of(&self, place: Option<Square>) -> Rect {
        let last = self.across.map(|n| n - 1);
        let Some(Square { low, high }) = place else { return Rect { first: [0; 2], last } };
        let tile = |at: f64, k: usize| at.floor().clamp(0.0, f64::from(last[k])) as u32;
        let (first, end) = ((low - self.corner) / self.side - MARGIN, (high - self.corner) / self.side + MARGIN);
        Rect { first: [tile(first.x, 0), tile(first.y, 1)], last: [tile(end.x, 0), tile(end.y, 1)] }
    }

    /// Makes each tile's list of leaves, in order and with exits, and its lists of triangles and facets.
    fn list(&mut self, casters: &[Leaf], of_leaves: &[Rect], of_triangles: &[Rect], of_facets: &[Rect]) {
        let (starts, leaves) = self.by_tile(of_leaves);
        let (triangle_starts, mut lists) = self.by_tile(of_triangles);
        let (facet_starts, facets) = self.by_tile(of_facets);
        let first_facet = lists.len() as u32;
        lists.extend(facets);
        self.lists = lists;
        let list = |ends: &[u32]| Folded::new(casters, &leaves[ends[0] as usize..ends[1] as usize]);
        let folded: Vec<Folded> = starts.par_windows(2).map(list).collect();
        for (n, tile) in folded.into_iter().enumerate() {
            let first = starts[n];
            let place = |to: u32| if to >= EXIT_FALSE { to } else { first + to };
            self.leaves.extend(tile.leaves.iter().map(|l| TileLeaf {
                leaf: l.leaf,
                in_exit: place(l.in_exit),
                out_exit: place(l.out_exit),
                of: l.of,
            }));
            self.tiles.push(SunTile {
                first,
                end: starts[n + 1],
                entry: place(tile.entry),
                first_triangle: triangle_starts[n],
                end_triangle: triangle_starts[n + 1],
                first_facet: first_facet + facet_starts[n],
                end_facet: first_facet + facet_starts[n + 1],
            });
        }
    }

    /// The start of each tile's list, and the lists: the numbers of the rects that reach each tile, ascending.
    fn by_tile(&self, rects: &[Rect]) -> (Vec<u32>, Vec<u32>) {
        let across = self.across[0];
        let tiles = |r: &Rect| {
            let Rect { first, last } = *r;
            (first[1]..=last[1]).flat_map(move |y| (first[0]..=last[0]).map(move |x| (y * across + x) as usize))
        };
        let mut starts = vec![0; across as usize * self.across[1] as usize + 1];
        rects.iter().flat_map(tiles).for_each(|n| starts[n + 1] += 1);
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let (mut next, mut lists) = (starts.clone(), vec![0; starts[starts.len() - 1] as usize]);
        for (number, rect) in (0u32..).zip(rects) {
            for n in tiles(rect) {
                lists[next[n] as usize] = number;
                next[n] += 1;
            }
        }
        (starts, lists)
    }

    /// Middles of the parts with facets, relative to the eye, as texels.
    pub(crate) fn middles_from(&self, eye: DVec3) -> Vec<[f32; 4]> {
        self.middles.iter().map(|middle| (middle - eye).as_vec3().extend(0.0).to_array()).collect()
    }

    /// The sun's constants for frames of an eye.
    pub(crate) fn seen_from(&self, eye: DVec3) -> abi::Sun {
        let place = (DVec2::new(self.right.dot(eye), self.up.dot(eye)) - self.corner) / self.side;
        abi::Sun {
            towards: self.towards.as_vec3().to_array(),
            across: self.across[0],
            right: (self.right / self.side).as_vec3().to_array(),
            down: self.across[1],
            up: (self.up / self.side).as_vec3().to_array(),
            eye: place.as_vec2().to_array(),
            // both faces at a border deviate by up to this, and their trims by less than as much again
            crack: (4.0 * self.deviation / self.side) as f32,
        }
    }

    /// Something casts shadows.
    pub(crate) fn has_casters(&self) -> bool {
        self.across[0] > 0
    }

    /// The part that frames still need after the upload.
    pub(super) fn directions_only(self) -> Self {
        let (tiles, leaves, triangles) = (Vec::new(), Vec::new(), Vec::new());
        Self { tiles, leaves, triangles, facets: Vec::new(), lists: Vec::new(), ..self }
    }
}

/// The box around a triangle's corners.
fn square_of(triangle: &Flat) -> Square {
    let [a, b, c] = triangle.corners;
    Square { low: a.min(b).min(c), high: a.max(b).max(c) }
}

impl Rect {
    fn count(&self) -> u64 {
        let side = |k: usize| u64::from(self.last[k] - self.first[k] + 1);
        side(0) * side(1)
    }
}

/// The Blist restricted to some leaves; the point is outside all others.
struct Folded {
    /// Exits are places in the restricted list.
    leaves: Vec<TileLeaf>,
    entry: u32,
}

impl Folded {
    /// `list` is ascending.
    ///
    /// A walk that reaches a missing leaf follows its out-exits to the first leaf in the list. Out-exits form a forest
    /// in which leaf `l` has the numbers `pre..end`. So the next leaf of the walk is the one whose range is the
    /// innermost around the missing leaf's number.
    fn new(casters: &[Leaf], list: &[u32]) -> Self {
        let mut order: Vec<u32> = (0..list.len() as u32).collect();
        let leaf = |place: u32| &casters[list[place as usize] as usize];
        order.sort_unstable_by_key(|place| leaf(*place).pre);
        // the innermost range around each leaf, by a stack
        let mut around = vec![None; order.len()];
        let mut open: Vec<usize> = Vec::new();
        for (at, place) in order.iter().enumerate() {
            while open.last().is_some_and(|o| leaf(order[*o]).end <= leaf(*place).pre) {
                open.pop();
            }
            around[at] = open.last().copied();
            open.push(at);
        }
        let fold = |to: u32| {
            if to >= EXIT_FALSE {
                return to;
            }
            let target = &casters[to as usize];
            let before = order.partition_point(|place| leaf(*place).pre <= target.pre);
            let mut at = before.checked_sub(1);
            while let Some(range) = at.filter(|at| leaf(order[*at]).end <= target.pre) {
                at = around[range];
            }
            let ends = if target.flags & LEAF_FALLS != 0 { EXIT_FALSE } else { EXIT_TRUE };
            at.map_or(ends, |at| order[at])
        };
        let exits = |l: &u32| {
            let leaf = &casters[*l as usize];
            TileLeaf { leaf: *l, in_exit: fold(leaf.in_exit), out_exit: fold(leaf.out_exit), of: leaf.own() }
        };
        let entry = if casters.is_empty() { EXIT_FALSE } else { fold(0) };
        Self { leaves: list.iter().map(exits).collect(), entry }
    }
}

#[cfg(test)]
mod tests;
