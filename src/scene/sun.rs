//! What a sun sees of what casts shadows: which of it each part of its picture sees.
//!
//! ```text
//!        ☀  rays are parallel: one picture for all frames         right ▶
//!        │                                              ┌────┬────┬────┐ up ▲     tiles, each with the leaves whose
//!   ┌────┴────┐  boxes of leaves ──────────────────────▶│ A  │ AB │ B  │          boxes reach into it, and their Blist;
//!   ▼         ▼  triangles, facets                      └────┴────┴────┘          triangles of those without equations;
//! ```                                                                             facets of parts that are placed
//!
//! As passes `solid_rects` to `solid_fold` have it for the eye, but made once, on the CPU and in `f64`: it depends on
//! the scene and the sun only. A point beside the picture belongs to the nearest tile, since nothing that is missing
//! there reaches beyond the picture. [`casters`] says what there is, [`faces`] and [`region`] how trimmed faces become
//! triangles.

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
    /// Of unit length.
    towards: DVec3,
    /// Across the rays, of unit length.
    right: DVec3,
    up: DVec3,
    /// The corner of the first tile, along `right` and `up`.
    corner: DVec2,
    /// Of a tile, model units.
    side: f64,
    /// Tiles along `right` and `up`; none where nothing casts shadows.
    across: [u32; 2],
    pub tiles: Vec<SunTile>,
    pub leaves: Vec<TileLeaf>,
    pub triangles: Vec<SunTriangle>,
    pub facets: Vec<SunFacet>,
    /// Triangles of each tile, and facets behind all of those.
    pub lists: Vec<u32>,
    /// Middles of the parts that have facets, model coordinates.
    pub middles: Vec<DVec3>,
    /// Parts and operands that were too much.
    pub left_out: usize,
    /// The most that the spline faces that cast shadows are off by, model units.
    pub deviation: f64,
}

/// Tiles to a leaf or triangle, and at most: lists of some each, where they lie beside each other.
const TILES_EACH: usize = 4;
const MOST_TILES: usize = 1 << 16;
/// Entries of all lists to a leaf or triangle, above those that few may have: what lies before each other gets larger
/// tiles.
const ENTRIES_EACH: u64 = 32;
const FEW_ENTRIES: u64 = 1 << 16;
/// And of all lists at most, where there are fewer tiles to make: 64 MiB.
const MOST_ENTRIES: u64 = 1 << 24;
/// A box reaches this far beside itself, in tiles: above the rounding of a point seen from an eye that is a thousand
/// scenes away.
const MARGIN: f64 = 1.0 / 32.0;
/// Of a tile, model units: single precision holds its inverse.
const LEAST_SIDE: f64 = 1e-30;

/// A box across the rays, model units.
#[derive(Clone, Copy)]
struct Square {
    low: DVec2,
    high: DVec2,
}

/// Tiles from first to last that something reaches.
#[derive(Clone, Copy)]
struct Rect {
    first: [u32; 2],
    last: [u32; 2],
}

impl SunData {
    /// `towards` is finite and not 0; its square may be neither. `placed`: the model whose instances cast shadows, all of
    /// them drawn.
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
        // one tile where there is nothing, or where numbers have no room for what is between
        let size = if low.cmple(high).all() && (high - low).is_finite() { high - low } else { DVec2::ZERO };
        sun.corner = if low.is_finite() { low } else { DVec2::ZERO };
        let count = leaves.len() + triangles.len() + facets.len();
        let wanted = (TILES_EACH * count).clamp(1, MOST_TILES) as f64;
        // square tiles, `wanted` of them, or a row of as many
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

    /// Where a leaf is across the rays; `None` everywhere.
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

    /// The leaves of each tile, in order, and their exits; the triangles; and the facets.
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

    /// Who reaches each tile, in order, and where its list begins.
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

    /// Middles of parts that have facets, seen from an eye, as texels.
    pub(crate) fn middles_from(&self, eye: DVec3) -> Vec<[f32; 4]> {
        self.middles.iter().map(|middle| (middle - eye).as_vec3().extend(0.0).to_array()).collect()
    }

    /// For the frames of an eye.
    pub(crate) fn seen_from(&self, eye: DVec3) -> abi::Sun {
        let place = (DVec2::new(self.right.dot(eye), self.up.dot(eye)) - self.corner) / self.side;
        abi::Sun {
            towards: self.towards.as_vec3().to_array(),
            across: self.across[0],
            right: (self.right / self.side).as_vec3().to_array(),
            down: self.across[1],
            up: (self.up / self.side).as_vec3().to_array(),
            eye: place.as_vec2().to_array(),
            // each of two faces is off by the deviation, and their trims by less than that again
            crack: (4.0 * self.deviation / self.side) as f32,
        }
    }

    /// Something casts shadows.
    pub(crate) fn has_casters(&self) -> bool {
        self.across[0] > 0
    }

    /// What frames need once the GPU has the rest.
    pub(super) fn directions_only(self) -> Self {
        let (tiles, leaves, triangles) = (Vec::new(), Vec::new(), Vec::new());
        Self { tiles, leaves, triangles, facets: Vec::new(), lists: Vec::new(), ..self }
    }
}

/// Of a triangle's corners.
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

/// The Blist of some of the leaves: one that is missing is one that the point is out of.
struct Folded {
    /// Exits are places in the list.
    leaves: Vec<TileLeaf>,
    entry: u32,
}

impl Folded {
    /// `list` is ascending.
    ///
    /// A walk that goes to a missing leaf follows its out-exits to the first that is there. These make a forest, in
    /// which leaf `l` has numbers `pre..end`: sought is the innermost range of `list` that holds the missing leaf's.
    fn new(casters: &[Leaf], list: &[u32]) -> Self {
        let mut order: Vec<u32> = (0..list.len() as u32).collect();
        let leaf = |place: u32| &casters[list[place as usize] as usize];
        order.sort_unstable_by_key(|place| leaf(*place).pre);
        // ranges around each, by a stack
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
