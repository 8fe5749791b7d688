//! Twin of `glsl/solids/solid_squares.comp` and `glsl/shading/seen_squares.comp`: the squares of tiles that are drawn.

use crate::abi::{BLOCK, EXIT_FALSE, TILE};
use std::ops::Range;

/// For each tile of a picture of `size` pixels: the side, in tiles, of the square that begins there, or 0. `sees`
/// returns whether a tile is drawn.
pub fn seen_squares(size: [u32; 2], sees: impl Fn([u32; 2]) -> bool) -> Vec<u32> {
    let tiles = size.map(|pixels| pixels.div_ceil(TILE));
    let pixels = |tile: u32, axis: usize| tile * TILE..(tile * TILE + TILE).min(size[axis]);
    let any = |n: u32| {
        let (tile_x, tile_y) = (n % tiles[0], n / tiles[0]);
        pixels(tile_y, 1).any(|y| pixels(tile_x, 0).any(|x| sees([x, y])))
    };
    let entries: Vec<u32> = (0..tiles[0] * tiles[1]).map(|n| if any(n) { n } else { EXIT_FALSE }).collect();
    solid_squares(tiles, 0..tiles[1], &entries)
}

/// For each tile of a band of rows, in a picture of `tiles` across and down: the side, in tiles, of the square that
/// begins there, or 0. `entries` are the first leaves of the tiles' walks.
pub fn solid_squares(tiles: [u32; 2], band: Range<u32>, entries: &[u32]) -> Vec<u32> {
    let is_last = band.end == tiles[1];
    let entries = &entries[(band.start * tiles[0]) as usize..(band.end * tiles[0]) as usize];
    let tiles = [tiles[0], band.end - band.start];
    let sees = |x: u32, y: u32| entries[(y * tiles[0] + x) as usize] != EXIT_FALSE;
    let all_see = |[x, y]: [u32; 2], side: u32| {
        let (end_x, end_y) = ((x + side).min(tiles[0]), (y + side).min(tiles[1]));
        (y..end_y).all(|y| (x..end_x).all(|x| sees(x, y)))
    };
    let square = |n: u32| {
        let tile = [n % tiles[0], n / tiles[0]];
        let sides = std::iter::successors(Some(BLOCK), |side| (*side > 1).then_some(side / 2));
        let found = sides
            .map(|side| (tile.map(|k| k / side * side), side))
            .find(|(first, side)| (is_last || first[1] + side <= tiles[1]) && all_see(*first, *side));
        found.filter(|(first, _)| *first == tile).map_or(0, |(_, side)| side)
    };
    (0..tiles[0] * tiles[1]).map(square).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every tile that shows a solid is in exactly one square, and other tiles are in none.
    #[test]
    fn squares_cover_what_sees_a_solid_once() {
        let tiles = [21, 13];
        let mut covered_by_larger = 0;
        for seed in 0..20u32 {
            let seen = |x: u32, y: u32| (x / 3 + y / 2 * 7 + seed).wrapping_mul(2_654_435_761) >> 29 > seed % 5;
            let entries: Vec<_> = (0..tiles[0] * tiles[1])
                .map(|n| if seen(n % tiles[0], n / tiles[0]) { n } else { EXIT_FALSE })
                .collect();
            let mut times = vec![0; entries.len()];
            // bands, or the whole picture
            let ends: &[u32] = if seed % 2 == 0 { &[0, 13] } else { &[0, 5, 10, 13] };
            let squares = ends.windows(2).flat_map(|w| solid_squares(tiles, w[0]..w[1], &entries));
            for (n, side) in (0..).zip(squares) {
                let first = [n % tiles[0], n / tiles[0]];
                for y in first[1]..(first[1] + side).min(tiles[1]) {
                    for x in first[0]..(first[0] + side).min(tiles[0]) {
                        times[(y * tiles[0] + x) as usize] += 1;
                        covered_by_larger += u32::from(side > 1);
                    }
                }
            }
            let expected: Vec<_> = entries.iter().map(|e| i32::from(*e != EXIT_FALSE)).collect();
            assert_eq!(times, expected, "seed {seed}");
        }
        assert!(covered_by_larger > 100, "{covered_by_larger}");
    }
}
