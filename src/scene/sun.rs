//! What a sun sees of the Boolean solids that cast shadows: which of their leaves each part of its picture sees.
//!
//! ```text
//!        ☀  rays are parallel: one picture for all frames         right ▶
//!        │                                              ┌────┬────┬────┐ up ▲
//!   ┌────┴────┐  boxes of leaves ──────────────────────▶│ A  │ AB │ B  │        tiles, each with the leaves whose
//!   ▼         ▼                                         └────┴────┴────┘        boxes reach into it, and their Blist;
//! ```                                                                          and triangles of those that are meshes
//!
//! As passes `solid_rects` to `solid_fold` have it for the eye, but made once, on the CPU and in `f64`: it depends on
//! the scene and the sun only. A point beside the picture belongs to the nearest tile, since no leaf that is missing
//! there reaches beyond the picture.

use super::solids::SolidData;
use crate::abi::{
    self, EXIT_FALSE, EXIT_TRUE, LEAF_FALLS, LEAF_UNBOUNDED, Leaf, OWN_PLANE, SunTile, SunTriangle, TileLeaf,
};
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
    /// Of each tile.
    pub tile_triangles: Vec<u32>,
}

/// Tiles to a leaf or triangle, and at most: lists of some each, where they lie beside each other.
const TILES_EACH: usize = 4;
const MOST_TILES: usize = 1 << 16;
/// Entries of all lists to a leaf or triangle, above those that few may have: what lies before each other gets larger
/// tiles.
const ENTRIES_EACH: u64 = 32;
const FEW_ENTRIES: u64 = 1 << 16;
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

/// A triangle of an operand, across the rays, model units.
struct Flat {
    corners: [DVec2; 3],
    /// Middle of the operand.
    centre: DVec2,
    /// Of the corners towards the sun, from there.
    heights: [f64; 3],
    shell: u32,
    surface: u32,
}

impl SunData {
    /// `towards` is finite and not 0; its square may be neither.
    pub(super) fn new(towards: DVec3, solids: &SolidData) -> Self {
        let towards = (towards / towards.abs().max_element()).normalize();
        let (right, up) = towards.any_orthonormal_pair();
        let casters = &solids.leaves[..solids.followed as usize];
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
            tile_triangles: Vec::new(),
        };
        if casters.is_empty() {
            return sun;
        }
        let leaf = |(leaf, centre): (&Leaf, &DVec3)| sun.square_of(leaf, *centre);
        let boxes: Vec<Option<Square>> = casters.iter().zip(&solids.leaf_centres).map(leaf).collect();
        let triangles = sun.flattened(solids);
        let ends = boxes.iter().flatten();
        let (low, high) =
            ends.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), b| (lo.min(b.low), hi.max(b.high)));
        // one tile where there is nothing, or where numbers have no room for what is between
        let size = if low.cmple(high).all() && (high - low).is_finite() { high - low } else { DVec2::ZERO };
        sun.corner = if low.is_finite() { low } else { DVec2::ZERO };
        let count = casters.len() + triangles.len();
        let wanted = (TILES_EACH * count).clamp(1, MOST_TILES) as f64;
        // square tiles, `wanted` of them, or a row of as many
        let square = size.x.sqrt() * size.y.sqrt() / wanted.sqrt();
        sun.side = square.max(size.max_element() / wanted).max(LEAST_SIDE);
        let most = FEW_ENTRIES + ENTRIES_EACH * count as u64;
        let (of_leaves, of_triangles) = loop {
            sun.across = size.to_array().map(|s| (s / sun.side).ceil().clamp(1.0, MOST_TILES as f64) as u32);
            let of_leaves: Vec<Rect> = boxes.iter().map(|b| sun.rect_of(*b)).collect();
            let of_triangles: Vec<Rect> = triangles.iter().map(|t| sun.rect_of(Some(t.square()))).collect();
            let entries: u64 = of_leaves.iter().chain(&of_triangles).map(Rect::count).sum();
            if entries <= most || sun.across == [1; 2] {
                break (of_leaves, of_triangles);
            }
            sun.side *= 2.0;
        };
        sun.triangles = triangles.iter().map(|t| t.stored(sun.side)).collect();
        sun.list(casters, &of_leaves, &of_triangles);
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

    /// The triangles of the union's operands that are meshes.
    fn flattened(&self, solids: &SolidData) -> Vec<Flat> {
        let mut all = Vec::new();
        for operand in solids.operands.iter().filter(|o| solids.shell_leaves[o.shell as usize] < solids.followed) {
            let middle = solids.leaf_centres[solids.shell_leaves[operand.shell as usize] as usize];
            let centre = self.flat(middle);
            let meshes = operand.meshes.clone();
            for (mesh, corners) in solids.operand_meshes[meshes.clone()].iter().zip(&solids.operand_draws[meshes]) {
                let triangles = &solids.operand_triangles[corners.start as usize / 3..corners.end as usize / 3];
                for (number, triangle) in (mesh.first_triangle..).zip(triangles) {
                    let corners = triangle.map(|v| {
                        let own = DVec3::from(solids.operand_positions[v as usize].map(f64::from)) + operand.origin;
                        operand.primitive.transform.transform_point3(own)
                    });
                    all.push(Flat {
                        corners: corners.map(|p| self.flat(p)),
                        centre,
                        heights: corners.map(|p| self.towards.dot(p - middle)),
                        shell: operand.shell,
                        surface: solids.plane_of(mesh, number).unwrap_or(OWN_PLANE | number),
                    });
                }
            }
        }
        all
    }

    fn rect_of(&self, place: Option<Square>) -> Rect {
        let last = self.across.map(|n| n - 1);
        let Some(Square { low, high }) = place else { return Rect { first: [0; 2], last } };
        let tile = |at: f64, k: usize| at.floor().clamp(0.0, f64::from(last[k])) as u32;
        let (first, end) = ((low - self.corner) / self.side - MARGIN, (high - self.corner) / self.side + MARGIN);
        Rect { first: [tile(first.x, 0), tile(first.y, 1)], last: [tile(end.x, 0), tile(end.y, 1)] }
    }

    /// The leaves of each tile, in order, and their exits; and the triangles.
    fn list(&mut self, casters: &[Leaf], of_leaves: &[Rect], of_triangles: &[Rect]) {
        let (starts, leaves) = self.by_tile(of_leaves);
        let (triangle_starts, triangles) = self.by_tile(of_triangles);
        self.tile_triangles = triangles;
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
        }
    }

    /// Something casts shadows.
    pub(crate) fn has_casters(&self) -> bool {
        self.across[0] > 0
    }

    /// What frames need once the GPU has the rest.
    pub(super) fn directions_only(self) -> Self {
        let (tiles, leaves) = (Vec::new(), Vec::new());
        Self { tiles, leaves, triangles: Vec::new(), tile_triangles: Vec::new(), ..self }
    }
}

impl Flat {
    fn square(&self) -> Square {
        let [a, b, c] = self.corners;
        Square { low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    /// In tiles, from the operand's middle.
    fn stored(&self, side: f64) -> SunTriangle {
        let corners = self.corners.map(|p| ((p - self.centre) / side).as_vec2().to_array());
        SunTriangle { corners, heights: self.heights.map(|h| h as f32), shell: self.shell, surface: self.surface }
    }
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
        Self { leaves: list.iter().map(exits).collect(), entry: fold(0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csg::{Builder, Op};
    use crate::model::{Primitive, Shape, Solid};
    use crate::picture::SolidWay;
    use crate::scene::solids::Lists;
    use glam::DAffine3;

    /// Numbers from a counter. Source: G. Marsaglia, Xorshift RNGs, 2003.
    struct Dice(u64);

    impl Dice {
        fn below(&mut self, n: u64) -> u64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            self.0 % n
        }
    }

    /// A random expression over balls beside each other, some of them half-spaces.
    fn solids(dice: &mut Dice, count: u32, ops: [Op; 4]) -> SolidData {
        let shape = |k: u32, unbounded: bool| match unbounded {
            true => Shape::HalfSpace { normal: DVec3::Y, offset: f64::from(k) },
            false => Shape::Sphere { radius: 0.7 },
        };
        let primitives = (0..count).map(|k| Primitive {
            shape: shape(k, dice.below(9) == 0),
            transform: DAffine3::from_translation(DVec3::new(f64::from(k % 4), f64::from(k / 4), 0.0)),
            colour: [1.0; 4],
            id: k + 1,
        });
        let primitives: Vec<Primitive> = primitives.collect();
        let mut b = Builder::new();
        let mut nodes: Vec<u32> = (0..count).map(|p| b.leaf(p)).collect();
        while nodes.len() > 1 {
            let left = nodes.swap_remove(dice.below(nodes.len() as u64) as usize);
            let right = nodes.swap_remove(dice.below(nodes.len() as u64) as usize);
            let op = ops[dice.below(4) as usize];
            nodes.push(b.pair(op, left, right));
        }
        let tree = b.finish(nodes[0]).unwrap();
        let solid = Solid::new(primitives, tree).unwrap();
        SolidData::new(&Lists::union(std::slice::from_ref(&solid)), SolidWay::Events).unwrap()
    }

    /// Where a walk ends that is out of every leaf but those of which `inside` says otherwise.
    fn walk(from: u32, exits: impl Fn(u32) -> (u32, u32, u32), inside: &[bool]) -> u32 {
        let mut at = from;
        while at < EXIT_FALSE {
            let (leaf, in_exit, out_exit) = exits(at);
            at = if inside[leaf as usize] { in_exit } else { out_exit };
        }
        at
    }

    /// In every tile, the walk over its list ends where that over all leaves does, whoever of the list is inside.
    #[test]
    fn a_tile_answers_as_the_whole_list_does() {
        let mut dice = Dice(7);
        let (mut short, mut ends) = (0, [0; 2]);
        for round in 0..200 {
            let data = solids(&mut dice, 2 + round % 24, [Op::Union, Op::Intersection, Op::Difference, Op::Union]);
            let sun = SunData::new(DVec3::new(0.2, 0.1, 1.0), &data);
            for tile in &sun.tiles {
                let list = &sun.leaves[tile.first as usize..tile.end as usize];
                short += usize::from(list.len() < data.leaves.len());
                for _ in 0..4 {
                    let mut inside = vec![false; data.leaves.len()];
                    list.iter().for_each(|l| inside[l.leaf as usize] = dice.below(2) == 0);
                    let whole = |l: u32| (l, data.leaves[l as usize].in_exit, data.leaves[l as usize].out_exit);
                    let folded = |i: u32| {
                        let l = sun.leaves[i as usize];
                        (l.leaf, l.in_exit, l.out_exit)
                    };
                    let end = walk(0, whole, &inside);
                    assert_eq!(walk(tile.entry, folded, &inside), end, "round {round}");
                    ends[usize::from(end == EXIT_TRUE)] += 1;
                }
            }
        }
        assert!(short > 1000 && ends.iter().all(|n| *n > 1000), "{short} lists are shorter, {ends:?}");
    }

    /// A leaf is in the tile of every point of its box, and where there is none its point belongs to a tile, too.
    #[test]
    fn a_leaf_is_in_the_tiles_that_its_box_reaches() {
        let mut dice = Dice(3);
        // of a union every box is whole
        let data = solids(&mut dice, 24, [Op::Union; 4]);
        let (eye, sun) = (DVec3::new(30.0, -20.0, 40.0), SunData::new(DVec3::new(-0.7, 0.4, 0.8), &data));
        let seen = sun.seen_from(eye);
        let row = |axis: [f32; 3], p: DVec3| DVec3::from(axis.map(f64::from)).dot(p);
        let mut met = 0;
        for (leaf, centre) in data.leaves.iter().zip(&data.leaf_centres) {
            for _ in 0..50 {
                let mut share = || dice.below(2001) as f64 / 1000.0 - 1.0;
                let (x, y, z) = (share(), share(), share());
                let half = DVec3::from(leaf.half_size.map(f64::from));
                let half = if half.is_finite() { half } else { DVec3::splat(100.0) };
                // seen from the eye, along the sun's ray
                let p = centre + half * DVec3::new(x, y, z) + sun.towards * 10.0 * share() - eye;
                let at = [row(seen.right, p) + f64::from(seen.eye[0]), row(seen.up, p) + f64::from(seen.eye[1])];
                let [x, y] = std::array::from_fn(|k| at[k].clamp(0.0, f64::from(sun.across[k] - 1)) as usize);
                let tile = sun.tiles[y * sun.across[0] as usize + x];
                let list = &sun.leaves[tile.first as usize..tile.end as usize];
                assert!(list.iter().any(|l| data.leaves[l.leaf as usize] == *leaf), "{at:?}");
                met += usize::from(at[0] > 0.0 && at[1] > 0.0);
            }
        }
        assert!(sun.tiles.len() > 16 && met > 500, "{} tiles, {met}", sun.tiles.len());
    }

    /// Large leaves in front of each other get larger tiles, a point and a line some, nothing none.
    #[test]
    fn lists_are_bounded() {
        let stack = |n: u32, half: [f32; 3]| SolidData {
            leaves: vec![
                Leaf {
                    half_size: half,
                    out_exit: EXIT_FALSE,
                    in_exit: EXIT_TRUE,
                    flags: LEAF_FALLS,
                    ..Default::default()
                };
                n as usize
            ],
            leaf_centres: vec![DVec3::ONE; n as usize],
            followed: n,
            ..Default::default()
        };
        let sun = |data: &SolidData| SunData::new(DVec3::Z, data);
        let many = sun(&stack(20_000, [1.0; 3]));
        assert!(many.leaves.len() as u64 <= FEW_ENTRIES + ENTRIES_EACH * 20_000 && !many.tiles.is_empty());
        for half in [[0.0; 3], [1.0, 0.0, 0.0], [f32::MAX; 3], [1e-40; 3]] {
            let few = sun(&stack(3, half));
            assert!((1..=4 * 12).contains(&few.tiles.len()), "{half:?}: {}", few.tiles.len());
            assert!(few.seen_from(DVec3::ONE).right.iter().all(|x| x.is_finite()), "{half:?}");
        }
        assert!(!sun(&SolidData::default()).has_casters());
        // as far from each other as numbers go
        let far = [DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX)];
        let apart = sun(&SolidData { leaf_centres: far.to_vec(), ..stack(2, [1.0; 3]) });
        assert_eq!((apart.across, apart.leaves.len()), ([1; 2], 2));
    }
}
