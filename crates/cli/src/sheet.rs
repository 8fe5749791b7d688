//! A contact sheet.

use anyhow::{Result, bail};
use selvedge::picture::Picture;

/// Pictures of one size, side by side in one: row by row, the first on top and to the left.
pub struct Sheet {
    pub size: (u32, u32),
    columns: u32,
    tile: (u32, u32),
    pub pixels: Vec<[u8; 4]>,
}

impl Sheet {
    /// Room for `count` pictures within `size`, in about as many columns as rows.
    pub fn new(size: (u32, u32), count: usize) -> Result<Self> {
        let columns = (count as f64).sqrt().ceil().max(1.0) as u32;
        let rows = (count as u32).div_ceil(columns).max(1);
        let tile = (size.0 / columns, size.1 / rows);
        if tile.0 == 0 || tile.1 == 0 {
            bail!("a contact sheet of {}x{} pixels has no room for {count} views", size.0, size.1);
        }
        let pixels = vec![[0; 4]; size.0 as usize * size.1 as usize];
        Ok(Self { size, columns, tile, pixels })
    }

    /// Width and height of each picture.
    pub fn tile(&self) -> (u32, u32) {
        self.tile
    }

    /// The picture in its place; the first is number 0.
    pub fn put(&mut self, index: usize, picture: &Picture) {
        let (width, height) = (self.tile.0 as usize, self.tile.1 as usize);
        let columns = self.columns as usize;
        let (left, top) = (index % columns * width, index / columns * height);
        for (y, row) in picture.colour.chunks_exact(width).enumerate() {
            let start = (top + y) * self.size.0 as usize + left;
            self.pixels[start..start + width].copy_from_slice(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_row_by_row() {
        let mut sheet = Sheet::new((7, 4), 3).expect("room");
        assert_eq!(sheet.tile(), (3, 2));
        for index in 0..3 {
            let shade = [index as u8 + 1; 4];
            sheet.put(index, &Picture { size: (3, 2), colour: vec![shade; 6], ..Picture::default() });
        }
        let rows: Vec<Vec<u8>> = sheet.pixels.chunks(7).map(|row| row.iter().map(|p| p[0]).collect()).collect();
        assert_eq!(rows[0], [1, 1, 1, 2, 2, 2, 0]);
        assert_eq!(rows[1], rows[0]);
        assert_eq!(rows[3], [3, 3, 3, 0, 0, 0, 0]);
        assert!(Sheet::new((2, 1), 9).is_err());
    }
}
