//! The leaves of a model's Boolean solids in each tile of a picture.
//!
//! ```text
//!   box of each leaf ──twin::solid_rects──▶ its tiles       a tile's own Blist has the leaves that cover it; the rest
//!                                                           is folded away, being outside
//! ```

use glam::DVec3;
use selvedge::csg::Blist;
use selvedge::internals::abi::{Frame, LEAF_UNBOUNDED, Leaf};
use selvedge::internals::seen_by;
use selvedge::internals::twin::solid_rects::{solid_rects, tile_count};
use selvedge::model::{Bounds, Camera, Model, Solid};
use serde::Serialize;

/// The counts of a view's tiles once their Blists are folded.
#[derive(Debug, PartialEq, Serialize)]
pub struct Tiles {
    /// Pixels.
    size: [u32; 2],
    /// Tiles of 16 by 16 pixels.
    tiles: u32,
    /// Of them those that have a leaf.
    used: u32,
    /// Switches of the whole Blist: symmetric differences name their operands twice.
    leaves: usize,
    /// Leaves of a used tile, on average.
    mean: f64,
    /// Leaves of the fullest tile.
    most: u32,
}

impl Tiles {
    /// The tiles of a view of the model's solids; `None` where there are none, or more than can be drawn.
    pub fn new(model: &Model, camera: &Camera) -> Option<Self> {
        let whole = Solid::union(&model.solids).ok()?;
        let list = Blist::new(whole.tree()).ok()?;
        let mut reaches = whole.reaches();
        for (reach, primitive) in reaches.iter_mut().zip(whole.primitives()) {
            if !primitive.shape.is_analytic() {
                *reach = primitive.bounds(); // frames store the whole box of a shape without equations
            }
        }
        let (leaves, centres): (Vec<Leaf>, Vec<[f32; 3]>) =
            list.entries().iter().map(|e| leaf(reaches[e.primitive() as usize], camera)).unzip();
        let frame = frame(camera);
        let [across, down] = tile_count(&frame).map(|n| n as usize);
        // each rectangle as its corners' differences: sums along both axes count the leaves of each tile
        let mut counts = vec![0i64; (across + 1) * (down + 1)];
        for rect in solid_rects(&frame, &leaves, &centres) {
            let ([left, top], [right, bottom]) = (rect.first.map(|n| n as usize), rect.last.map(|n| n as usize));
            if left > right || top > bottom {
                continue;
            }
            for (x, y, step) in
                [(left, top, 1), (right + 1, top, -1), (left, bottom + 1, -1), (right + 1, bottom + 1, 1)]
            {
                counts[y * (across + 1) + x] += step;
            }
        }
        let mut above = vec![0i64; across];
        let mut held = Vec::new();
        for row in counts.chunks(across + 1).take(down) {
            let mut sum = 0;
            for (above, step) in above.iter_mut().zip(row) {
                sum += step;
                *above += sum;
                held.extend(u32::try_from(*above).ok().filter(|n| *n > 0));
            }
        }
        let all: u64 = held.iter().map(|n| u64::from(*n)).sum();
        (!model.solids.is_empty()).then(|| Self {
            size: camera.size.into(),
            tiles: (across * down) as u32,
            used: held.len() as u32,
            leaves: leaves.len(),
            mean: all as f64 / held.len().max(1) as f64,
            most: held.iter().copied().max().unwrap_or_default(),
        })
    }

    /// A line of text.
    pub fn text(&self) -> String {
        let [w, h] = self.size;
        let (used, tiles, leaves) = (self.used, self.tiles, self.leaves);
        format!(
            "folded tiles at {w}x{h}: {used} of {tiles} hold a leaf, {:.1} of {leaves} leaves on average, {} at most",
            self.mean, self.most
        )
    }
}

/// The box as the frame's shaders read it to find its tiles; its centre from the eye.
fn leaf(bounds: Bounds, camera: &Camera) -> (Leaf, [f32; 3]) {
    let bounded = bounds.min.is_finite() && bounds.max.is_finite();
    let empty = bounds.is_empty();
    // an empty one is a point
    let half = if empty { DVec3::ZERO } else { (bounds.max - bounds.min) * 0.5 };
    let centre = if bounded && !empty { bounds.centre() - camera.eye } else { camera.target - camera.eye };
    let flags = if bounded || empty { 0 } else { LEAF_UNBOUNDED };
    let half_size = half.as_vec3().to_array().map(f32::next_up);
    (Leaf { half_size, flags, ..Leaf::default() }, centre.as_vec3().to_array())
}

fn frame(camera: &Camera) -> Frame {
    let (right, up, forward) = camera.axes();
    let frame = Frame {
        right: right.as_vec3().to_array(),
        up: up.as_vec3().to_array(),
        forward: forward.as_vec3().to_array(),
        ..Frame::default()
    };
    seen_by(camera, frame)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;
    use selvedge::csg::parse;
    use selvedge::model::{Primitive, Projection, Shape};

    /// Seen from above at one pixel a millimetre: 10 by 6 tiles.
    fn view() -> Camera {
        Camera {
            eye: DVec3::Z * 100.0,
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 96.0 },
            depth_range: (1.0, 200.0),
            size: (160, 96),
        }
    }

    fn model(text: &str, boxes: &[(f64, f64, f64, f64)]) -> Model {
        let block = |(k, &(x, y, w, h)): (usize, &(f64, f64, f64, f64))| Primitive {
            shape: Shape::Block { min: DVec3::new(x, y, 0.0), max: DVec3::new(x + w, y + h, 5.0) },
            transform: DAffine3::IDENTITY,
            colour: [1.0; 4],
            id: k as u32 + 1,
        };
        let primitives = boxes.iter().enumerate().map(block).collect();
        let solid = Solid::new(primitives, parse(text).unwrap().tree).unwrap();
        Model { solids: vec![solid], ..Model::default() }
    }

    #[test]
    fn leaves_are_counted_where_they_are() {
        // within the tiles 5 to 6 by 1 to 2 (from the top); the part that the second one removes is in 6 by 2
        let boxes = [(2.0, 2.0, 28.0, 28.0), (18.0, 2.0, 44.0, 12.0)];
        let tiles = Tiles::new(&model("A-B", &boxes), &view()).unwrap();
        let expected = Tiles { size: [160, 96], tiles: 60, used: 4, leaves: 2, mean: 5.0 / 4.0, most: 2 };
        assert_eq!(tiles, expected);
        // a union keeps both: the second lies within the tiles 6 to 8 by 2 to 2
        let tiles = Tiles::new(&model("A+B", &boxes), &view()).unwrap();
        assert_eq!((tiles.used, tiles.mean, tiles.most), (6, 7.0 / 6.0, 2));
        // a symmetric difference has each operand twice; one outside the view is in no tile
        let away = [boxes[0], (500.0, 2.0, 9.0, 9.0)];
        let tiles = Tiles::new(&model("A^B", &away), &view()).unwrap();
        assert_eq!((tiles.used, tiles.leaves, tiles.mean, tiles.most), (4, 4, 2.0, 2));
        assert_eq!(Tiles::new(&Model::default(), &view()), None);
    }

    #[test]
    fn what_has_no_end_is_everywhere() {
        let mut whole = model("A+B", &[(2.0, 2.0, 28.0, 28.0), (0.0, 0.0, 1.0, 1.0)]);
        let half = Primitive {
            shape: Shape::HalfSpace { normal: DVec3::X, offset: 9.0 },
            ..whole.solids[0].primitives()[1].clone()
        };
        let all = vec![whole.solids[0].primitives()[0].clone(), half];
        whole.solids[0] = Solid::new(all, whole.solids[0].tree().clone()).unwrap();
        let tiles = Tiles::new(&whole, &view()).unwrap();
        assert_eq!((tiles.used, tiles.most), (60, 2));
        // subtracted, it matters where there is something to subtract from
        let taken = parse("A-B").unwrap().tree;
        whole.solids[0] = Solid::new(whole.solids[0].primitives().to_vec(), taken).unwrap();
        let tiles = Tiles::new(&whole, &view()).unwrap();
        assert_eq!((tiles.used, tiles.mean, tiles.most), (4, 2.0, 2));
    }
}
