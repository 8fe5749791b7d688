//! Walks across meshes: the twin against exact rays in `f64`, and parity of `mesh_walk.glsl` with its twin.
//!
//! ```text
//!   hills    a square field of random heights; from above no triangle hides another, from the side many do
//!   roof     two slopes; from before the front one hides the back one, and they meet at the outline
//!   strip    triangles in a row
//! ```

use super::Random;
use crate::abi::View;
use crate::model::{Camera, Instance, Mesh, Model, Part, Projection};
use crate::picture::{SceneSettings, Smooth};
use crate::scene::{SceneData, view};
use crate::twin::mesh_walk::{End, MOST_CROSSED, Meshes};
use glam::{DAffine3, DVec2, DVec3};

/// No other thing is known at the point.
const FARTHEST: f32 = 3.0e38;

/// Meshes, one a part, and views of them.
struct Ground {
    data: SceneData,
    cameras: Vec<Camera>,
    /// Of each camera, of each mesh.
    views: Vec<View>,
}

/// Triangle, its depth, and the least weight of a corner.
type Seen = (u32, f64, f64);

impl Ground {
    fn new(meshes: Vec<Mesh>, cameras: Vec<Camera>) -> Self {
        let of_part = |part: usize| Instance { part, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
        let part = |mesh: Mesh| Part { meshes: vec![mesh], ..Part::default() };
        let model = Model {
            instances: (0..meshes.len()).map(of_part).collect(),
            parts: meshes.into_iter().map(part).collect(),
            ..Model::default()
        };
        // only then neighbours are found
        let settings = SceneSettings { smooth: Smooth::Borders, ..SceneSettings::default() };
        let data = SceneData::new(&model, settings).unwrap();
        let mut views = Vec::new();
        for camera in &cameras {
            let pixels = camera.pixel_matrix();
            views.extend(data.placements.iter().map(|&placement| view(pixels, placement)));
        }
        Self { data, cameras, views }
    }

    fn meshes(&self) -> Meshes<'_> {
        let m = &self.data.meshes;
        Meshes { triangles: &m.triangles, positions: &m.positions, neighbours: &m.neighbours }
    }

    /// A corner of the mesh of a part, model coordinates.
    fn corner(&self, part: usize, corner: u32) -> DVec3 {
        let p = self.data.meshes.positions[corner as usize].map(f64::from);
        self.data.placements[part].transform_point3(DVec3::from(p))
    }

    /// What the first camera sees of the first mesh, by rays in double precision.
    fn exact(&self, pixel: DVec2) -> Option<Seen> {
        let camera = &self.cameras[0];
        let (origin, direction) = camera.ray(pixel);
        let (_, _, forward) = camera.axes();
        let meets = (0..).zip(&self.data.meshes.triangles).filter_map(|(triangle, corners)| {
            let [a, b, c] = corners.map(|i| self.corner(0, i));
            let n = (b - a).cross(c - a);
            let p = origin + direction * (n.dot(a - origin) / n.dot(direction));
            let across = [(c - b).cross(p - b), (a - c).cross(p - c), (b - a).cross(p - a)];
            let weights = across.map(|area| area.dot(n) / n.length_squared());
            let least = weights.into_iter().fold(f64::INFINITY, f64::min);
            let is_met = weights.iter().all(|weight| *weight >= 0.0);
            is_met.then(|| (triangle, (p - camera.eye).dot(forward), least))
        });
        meets.min_by(|x, y| x.1.total_cmp(&y.1))
    }
}

/// Cells of two triangles each, row by row: the one beside the left side first.
fn cells(positions: Vec<DVec3>, columns: u32) -> Mesh {
    let rows = positions.len() as u32 / (columns + 1) - 1;
    let cell = |(i, j): (u32, u32)| {
        let a = j * (columns + 1) + i;
        let (b, d) = (a + 1, a + columns + 1);
        [[a, d + 1, d], [a, b, d + 1]]
    };
    let places = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    Mesh::new(1, positions, places.flat_map(cell).collect(), vec![]).unwrap()
}

/// A square of 22 x 22 cells of unit size, level along its border: so its picture is convex.
fn hills() -> Mesh {
    const CELLS: u32 = 22;
    let mut random = Random::new(50);
    let mut positions = Vec::new();
    for (i, j) in (0..=CELLS).flat_map(|j| (0..=CELLS).map(move |i| (i, j))) {
        let height = random.range(-0.2, 0.2);
        let is_inner = [i, j].iter().all(|k| (1..CELLS).contains(k));
        let at = |k: u32| f64::from(k) - 0.5 * f64::from(CELLS);
        positions.push(DVec3::new(at(i), at(j), if is_inner { height } else { 0.0 }));
    }
    cells(positions, CELLS)
}

/// The ridge runs along x, one unit above the eaves.
fn roof() -> Mesh {
    let rows = [(-1.0, 0.0), (0.0, 1.0), (1.0, 0.0)];
    let row = |(y, z): (f64, f64)| (-4..=4).map(move |x| DVec3::new(f64::from(x), y, z));
    cells(rows.into_iter().flat_map(row).collect(), 8)
}

/// 100 triangles in a row along x.
fn strip() -> Mesh {
    let rows = (0..2).flat_map(|y| (0..=50).map(move |x| DVec3::new(f64::from(x) - 25.0, f64::from(y), 0.0)));
    cells(rows.collect(), 50)
}

/// From straight above: some ten pixels a unit.
fn above() -> Camera {
    Camera {
        eye: DVec3::new(0.0, 0.0, 40.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.6 },
        depth_range: (1.0, 100.0),
        size: (240, 240),
    }
}

/// From before and somewhat above: 25 pixels a unit.
fn before() -> Camera {
    Camera {
        eye: DVec3::new(0.0, -10.0, 2.0),
        target: DVec3::new(0.0, 0.0, 0.5),
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 0.9 },
        ..above()
    }
}

fn single(pixel: DVec2) -> [f32; 2] {
    pixel.as_vec2().to_array()
}

/// From any triangle of a field that hides nothing, the walk ends where the exact ray does, or beyond the border.
#[test]
fn a_walk_ends_where_the_exact_ray_does() {
    let ground = Ground::new(vec![hills()], vec![above()]);
    let mut random = Random::new(51);
    let (mut crossed, mut gone) = (0, 0);
    for _ in 0..1000 {
        let from = DVec2::new(random.range(2.0, 238.0), random.range(2.0, 238.0));
        let to = from + DVec2::new(random.range(-20.0, 20.0), random.range(-20.0, 20.0));
        let Some((start, _, _)) = ground.exact(from) else { continue };
        let found = ground.meshes().walk(start, &ground.views[0], single(to), FARTHEST);
        match ground.exact(to) {
            None => {
                assert_eq!(found.end, End::Gone, "from {from} to {to}");
                gone += 1;
            }
            // this near to a side rounding decides
            Some((_, _, least)) if least < 1e-3 => {}
            Some((triangle, depth, _)) => {
                assert_eq!((found.end, found.triangle), (End::Met, triangle), "from {from} to {to}");
                assert!((f64::from(found.depth) - depth).abs() < 1e-5 * depth, "{found:?}, not {depth}");
                crossed += usize::from(start != triangle);
            }
        }
    }
    assert!(crossed > 400 && gone > 15, "{crossed} walks across sides, {gone} beyond the border");
}

/// Beyond the ridge of the roof the mesh goes on, behind its front slope: the point does not see it.
#[test]
fn a_walk_ends_at_a_fold() {
    let ground = Ground::new(vec![roof()], vec![before()]);
    let ridge = ground.cameras[0].project(DVec3::Z).unwrap().0.y;
    let mut random = Random::new(53);
    let (mut met, mut gone) = (0, 0);
    for _ in 0..500 {
        let from = DVec2::new(random.range(40.0, 200.0), ridge + random.range(0.3, 6.0));
        let to = DVec2::new(from.x + random.range(-8.0, 8.0), ridge + random.range(-6.0, 6.0));
        if (to.y - ridge).abs() < 0.05 {
            continue;
        }
        let (start, _, _) = ground.exact(from).unwrap();
        let found = ground.meshes().walk(start, &ground.views[0], single(to), FARTHEST);
        if to.y < ridge {
            assert_eq!(found.end, End::Gone, "from {from} to {to}");
            gone += 1;
        } else {
            let (triangle, _, least) = ground.exact(to).unwrap();
            assert_eq!(found.end, End::Met, "from {from} to {to}");
            assert!(found.triangle == triangle || least < 1e-3, "from {from} to {to}");
            met += 1;
        }
    }
    assert!(met > 100 && gone > 100, "{met}, {gone}");
}

/// A walk crosses [`MOST_CROSSED`] triangles, none of them if a nearer thing is known, and none that is edge-on.
#[test]
fn a_walk_has_limits() {
    let parallel = Camera { projection: Projection::Orthographic { height: 60.0 }, ..above() };
    let edge_on = Camera { eye: DVec3::new(0.0, -40.0, 0.0), up: DVec3::Z, ..parallel };
    let ground = Ground::new(vec![strip()], vec![parallel, edge_on]);
    let centre = |triangle: u32| {
        let corners = ground.data.meshes.triangles[triangle as usize].map(|i| ground.corner(0, i));
        single(parallel.project(corners.into_iter().sum::<DVec3>() / 3.0).unwrap().0)
    };
    let (meshes, views) = (ground.meshes(), &ground.views);
    for (target, end) in [(MOST_CROSSED, End::Met), (MOST_CROSSED + 1, End::TooFar)] {
        let met = meshes.walk(0, &views[0], centre(target), FARTHEST);
        assert_eq!((met.end, met.triangle), (end, target));
    }
    let met = meshes.walk(0, &views[0], centre(5), 40.5);
    assert_eq!((met.end, met.triangle), (End::Met, 5));
    let met = meshes.walk(0, &views[0], centre(5), 39.5);
    assert_eq!((met.end, met.triangle), (End::Gone, 0));
    let met = meshes.walk(0, &views[1], centre(5), FARTHEST);
    assert_eq!((met.end, met.triangle), (End::Gone, 0));
}

/// `tests/gpu/glsl/mesh_walk.comp` wraps the include.
#[cfg(feature = "headless")]
mod parity {
    use super::super::harness::{Gpu, Mismatch, same, words};
    use super::*;
    use crate::gpu::{Binding, ComputeInfo, Pipeline, Resource};
    use crate::twin::mesh_walk::{Facing, Met, NO_TRIANGLE};
    use bytemuck::{Pod, Zeroable};

    const WALKS: usize = 20_000;
    /// Pixels by which points are moved to see whether rounding may lead a walk elsewhere.
    const NUDGE: f32 = 2e-3;

    /// A walk, as the shader reads it.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, Pod, Zeroable)]
    struct Walk {
        view: u32,
        triangle: u32,
        middle: [f32; 2],
        point: [f32; 2],
        nearest: f32,
    }

    impl Walk {
        fn pixel(&self) -> [f32; 2] {
            [self.middle[0] + self.point[0], self.middle[1] + self.point[1]]
        }
    }

    /// End, triangle, depth, and the first triangle's weights and depth, as the shader writes them.
    type Answer = [u32; 7];

    /// All meshes, from above, from before, and in a low parallel view across the hills.
    fn ground() -> Ground {
        let low = Camera {
            eye: DVec3::new(3.0, -30.0, 4.0),
            target: DVec3::ZERO,
            up: DVec3::Z,
            projection: Projection::Orthographic { height: 20.0 },
            ..above()
        };
        Ground::new(vec![hills(), roof(), strip()], vec![above(), before(), low])
    }

    /// From any triangle in front of the eye to points within a pixel, some pixels, or a long way of its middle.
    fn walks(ground: &Ground) -> Vec<Walk> {
        let mut random = Random::new(52);
        let mut all = Vec::new();
        while all.len() < WALKS {
            let camera = random.integer(0, 2) as usize;
            let mesh = random.integer(0, 2) as usize;
            let corners = &ground.data.meshes.draws[mesh].0;
            let triangle = random.integer(corners.start / 3, corners.end / 3 - 1);
            let ends = ground.data.meshes.triangles[triangle as usize].map(|i| ground.corner(mesh, i));
            let centre = ends.into_iter().sum::<DVec3>() / 3.0;
            let camera_of = &ground.cameras[camera];
            if ends.iter().any(|p| camera_of.project(*p).is_none_or(|(_, depth)| depth < 1.0)) {
                continue;
            }
            let Some((pixel, depth)) = camera_of.project(centre) else { continue };
            let (across, down) = random.pick(&[(0.5, 0.5), (1.5, 1.5), (12.0, 12.0), (300.0, 4.0)]);
            let nearest = depth as f32 * random.pick(&[0.9f32, 1.1, 1e9, 1e9, 1e9]);
            all.push(Walk {
                view: (camera * ground.data.placements.len() + mesh) as u32,
                triangle,
                middle: single(pixel.floor() + 0.5),
                point: [random.range(-across, across) as f32, random.range(-down, down) as f32],
                nearest,
            });
        }
        all
    }

    fn walked(ground: &Ground, walk: &Walk) -> Met {
        ground.meshes().walk(walk.triangle, &ground.views[walk.view as usize], walk.pixel(), walk.nearest)
    }

    fn first(ground: &Ground, walk: &Walk) -> Facing {
        ground.meshes().facing(walk.triangle, &ground.views[walk.view as usize], walk.middle)
    }

    /// A number's bits; all that are no numbers have the same.
    fn bits(x: f32) -> u32 {
        if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() }
    }

    fn expected(ground: &Ground, walk: &Walk) -> Answer {
        let met = walked(ground, walk);
        let ([x, y, z], depth) = first(ground, walk).weights(walk.point);
        [met.end as u32, met.triangle, bits(met.depth), bits(x), bits(y), bits(z), bits(depth)]
    }

    /// Points around and depths beside it lead to the same triangle.
    fn is_clear(ground: &Ground, walk: &Walk) -> bool {
        let met = walked(ground, walk);
        let ways = [(-NUDGE, -NUDGE), (NUDGE, -NUDGE), (-NUDGE, NUDGE), (NUDGE, NUDGE)];
        ways.iter().flat_map(|way| [0.999, 1.001].map(|share| (way, share))).all(|(&(x, y), share)| {
            let point = [walk.point[0] + x, walk.point[1] + y];
            let other = walked(ground, &Walk { point, nearest: walk.nearest * share, ..*walk });
            (other.end, other.triangle) == (met.end, met.triangle)
        })
    }

    /// Within the error of quotients: `twin::mesh_walk`.
    fn is_near(ground: &Ground, walk: &Walk, answer: Answer) -> bool {
        let number = |k: usize| f32::from_bits(answer[k]);
        let facing = first(ground, walk);
        let ([x, y, z], depth) = facing.weights(walk.point);
        let (weight, depth_bound) = facing.bounds(walk.point);
        let is_finite = [x, y, z, depth].iter().all(|x| x.is_finite());
        let near = |k: usize, twin: f32, bound: f32| (number(k) - twin).abs() <= bound;
        let weights = near(3, x, weight) && near(4, y, weight) && near(5, z, weight) && near(6, depth, depth_bound);
        let met = walked(ground, walk);
        let same_end = (answer[0], answer[1]) == (met.end as u32, met.triangle);
        let last = ground.meshes().facing(met.triangle, &ground.views[walk.view as usize], walk.pixel());
        let same_depth = met.end != End::Met || near(2, met.depth, last.bounds([0.0; 2]).1);
        (weights || !is_finite) && (same_end && same_depth || !is_clear(ground, walk))
    }

    /// Walks on the GPU over the neighbours of `given`, against the twin's.
    fn compare(gpu: &Gpu, given: &[u32], ground: &Ground, walks: &[Walk]) -> Result<Vec<Answer>, Mismatch> {
        let spirv = words(include_bytes!("../../tests/gpu/spirv/mesh_walk.comp.spv"));
        let bindings = [Binding::Storage; 6];
        let info = ComputeInfo { name: "mesh walk", spirv: &spirv, bindings: &bindings, push_bytes: 4, constants: &[] };
        let pipeline = Pipeline::compute(gpu.device(), &info).unwrap();
        let buffers = [
            gpu.upload("views", &ground.views),
            gpu.upload("triangles", &ground.data.meshes.triangles),
            gpu.upload("positions", &ground.data.meshes.positions),
            gpu.upload("neighbours", given),
            gpu.upload("walks", walks),
            gpu.upload("answers", &vec![[99u32; 7]; walks.len()]),
        ];
        gpu.run(|cmd| {
            cmd.bind(&pipeline, &buffers.each_ref().map(Resource::from), bytemuck::bytes_of(&(walks.len() as u32)));
            cmd.dispatch(walks.len().div_ceil(64) as u32);
        });
        let answers: Vec<Answer> = gpu.read(&buffers[5], walks.len());
        if gpu.is_exact() {
            let twin: Vec<_> = walks.iter().map(|walk| expected(ground, walk)).collect();
            let numbers = |a: &Answer| std::array::from_fn(|k| if k < 2 { a[k] } else { bits(f32::from_bits(a[k])) });
            let answers: Vec<Answer> = answers.iter().map(numbers).collect();
            return same("answers", &answers, &twin).map(|()| answers);
        }
        match (0..walks.len()).find(|&i| !is_near(ground, &walks[i], answers[i])) {
            None => Ok(answers),
            Some(index) => {
                let values = format!("GPU {:?}, twin {:?}", answers[index], expected(ground, &walks[index]));
                Err(Mismatch { buffer: "answers", index, values })
            }
        }
    }

    #[test]
    fn parity() {
        let ground = ground();
        let walks = walks(&ground);
        let clear = walks.iter().filter(|walk| is_clear(&ground, walk)).count();
        assert!(clear * 4 > WALKS * 3, "{clear} of {WALKS} walks do not depend on rounding");
        for gpu in Gpu::all() {
            let answers = compare(&gpu, &ground.data.meshes.neighbours, &ground, &walks).unwrap();
            // every end is frequent, and so are walks that cross sides
            let ends = [End::Met, End::Gone, End::TooFar].map(|end| {
                let ended = answers.iter().zip(&walks).filter(|(answer, _)| answer[0] == end as u32);
                [ended.clone().count(), ended.filter(|(answer, walk)| answer[1] != walk.triangle).count()]
            });
            assert!(ends[0][1] > WALKS / 20 && ends[0][0] > ends[0][1] + WALKS / 20, "{ends:?}");
            assert!(ends[1][1] > WALKS / 100 && ends[2][0] > WALKS / 1000, "{ends:?}");
            gpu.finish();
        }
    }

    /// One side without a triangle beyond it: the first walk across it ends there.
    #[test]
    fn a_difference_is_seen() {
        let gpu = Gpu::new();
        let ground = ground();
        let walks = walks(&ground);
        let mut given = ground.data.meshes.neighbours.clone();
        let crosses = |walk: &&Walk| {
            let met = walked(&ground, walk);
            met.end == End::Met && met.triangle != walk.triangle && is_clear(&ground, walk)
        };
        let walk = walks.iter().find(crosses).unwrap();
        let (weights, _) =
            ground.meshes().facing(walk.triangle, &ground.views[walk.view as usize], walk.pixel()).weights([0.0; 2]);
        let least = (0..3).min_by(|&i, &j| weights[i].total_cmp(&weights[j])).unwrap();
        given[3 * walk.triangle as usize + least] = NO_TRIANGLE;
        let mismatch = compare(&gpu, &given, &ground, &walks).unwrap_err();
        assert_eq!(mismatch.buffer, "answers");
        gpu.finish();
    }
}
