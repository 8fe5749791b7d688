//! The model as the window has it, and its view: places of faces and edges on the screen, in `f64`.

use super::hand::numbers;
use glam::{DVec2, DVec3};
use selvedge::model::{Camera, Face, Model, SurfaceKind};
use selvedge_check::{Hit, Tracer};
use selvedge_io::import::{Folders, Options, open_with};
use selvedge_viewer::session::{Loaded, World};
use selvedge_viewer::view::View;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Pixels around a place that show nothing else.
const ALONE: f64 = 5.0;
/// Pixels at the borders of the view, and those below its cube.
const BORDER: f64 = 12.0;
const CUBE: f64 = 130.0;

pub struct Scene {
    pub world: Arc<World>,
    tracer: Tracer,
    pub camera: Camera,
    /// Of the view, in the window.
    pub corner: DVec2,
}

impl Scene {
    /// Of the log's line on the view's place.
    pub fn new(file: &Path, line: &str) -> Self {
        Self::of(&[file.to_owned()], line)
    }

    /// The same, of several files.
    pub fn of(files: &[PathBuf], line: &str) -> Self {
        let place = numbers(line, "view of ");
        let beside = Folders::new(Vec::new());
        let options = Options { files: Some(&beside), ..Options::default() };
        let loaded = |file: &PathBuf| {
            let import = open_with(file, &options).expect("a sample");
            Arc::new(Loaded { path: file.clone(), import, partial: false })
        };
        let world = World::new(&files.iter().map(loaded).collect::<Vec<_>>());
        world.find_edges();
        let mut view = View::default();
        view.resize((place[0] as u32, place[1] as u32));
        view.set_bounds(world.bounds);
        view.reset(Instant::now());
        let tracer = Tracer::new(&world.model);
        let corner = DVec2::new(place[2], place[3]);
        Self { tracer, camera: *view.camera(), corner, world: Arc::new(world) }
    }

    /// The view of a line of `selvedge render`.
    pub fn camera_of(&self, line: &str) -> Camera {
        let triple = |name: &str| match numbers(line, name)[..] {
            [x, y, z, ..] => DVec3::new(x, y, z),
            _ => panic!("no {name} in {line}"),
        };
        Camera { eye: triple("--eye="), target: triple("--target="), up: triple("--up="), ..self.camera }
    }

    pub fn faces(&self) -> &[Face] {
        &self.world.model.parts[0].faces
    }

    /// The model without an instance.
    fn without(&self, instance: usize) -> Tracer {
        let mut model: Model = self.world.model.clone();
        model.instances.remove(instance);
        Tracer::new(&model)
    }

    /// What a place of the window shows.
    pub fn hit(&self, at: DVec2) -> Option<Hit> {
        self.tracer.first(&self.camera, at - self.corner)
    }

    /// Whether a place of the window is in the view, and not at its borders.
    pub fn is_in_view(&self, at: DVec2) -> bool {
        self.is_inside(at - self.corner)
    }

    fn is_inside(&self, pixel: DVec2) -> bool {
        let size = DVec2::new(f64::from(self.camera.size.0), f64::from(self.camera.size.1));
        pixel.min_element() > BORDER && pixel.x < size.x - CUBE && pixel.y < size.y - BORDER
    }

    /// The face that a pixel and those around it show to some rays.
    fn alone(&self, tracer: &Tracer, pixel: DVec2) -> Option<Hit> {
        let mut probe = tracer.probe(&self.camera);
        let hit = probe.first(pixel)?;
        let around = [(ALONE, 0.0), (-ALONE, 0.0), (0.0, ALONE), (0.0, -ALONE)];
        let same = |other: Hit| (other.face, other.instance) == (hit.face, hit.instance);
        around.iter().all(|(x, y)| probe.first(pixel + DVec2::new(*x, *y)).is_some_and(same)).then_some(hit)
    }

    fn pixels(&self) -> impl Iterator<Item = DVec2> {
        let (width, height) = self.camera.size;
        let all = (0..height).step_by(7).flat_map(move |y| (0..width).step_by(7).map(move |x| (x, y)));
        all.map(|(x, y)| DVec2::new(f64::from(x), f64::from(y))).filter(move |pixel| self.is_inside(*pixel))
    }

    /// A place in the window that shows such a face with nothing else around it.
    pub fn place(&self, wanted: impl Fn(&Hit, &Face) -> bool) -> (DVec2, Hit) {
        let found = self.pixels().find_map(|pixel| {
            let hit = self.alone(&self.tracer, pixel)?;
            let face = self.world.model.parts[hit.part].faces.get(hit.face_index)?;
            wanted(&hit, face).then_some((pixel + self.corner, hit))
        });
        found.expect("some such face is seen")
    }

    /// A place that shows a cylinder; and its face.
    pub fn cylinder(&self) -> (DVec2, &Face) {
        let (at, hit) = self.place(|_, face| face.kind == SurfaceKind::Cylinder);
        (at, &self.faces()[hit.face_index])
    }

    /// A place at which a face of another instance appears once the first one is hidden: before, and after.
    pub fn behind(&self) -> (DVec2, Hit, Hit) {
        let rest: Vec<Tracer> = (0..self.world.model.instances.len()).map(|i| self.without(i)).collect();
        let found = self.pixels().find_map(|pixel| {
            let before = self.alone(&self.tracer, pixel)?;
            let mut after = self.alone(&rest[before.instance], pixel)?;
            after.instance += usize::from(after.instance >= before.instance);
            Some((pixel + self.corner, before, after))
        });
        found.expect("parts stand behind others")
    }

    /// The place of a point, if it is seen there.
    fn seen(&self, p: DVec3) -> Option<DVec2> {
        let (pixel, depth) = self.camera.project(p)?;
        let hit = self.tracer.first(&self.camera, pixel).filter(|_| self.is_inside(pixel))?;
        ((hit.depth - depth).abs() < 1e-3 * self.world.bounds.diagonal()).then_some(pixel + self.corner)
    }

    /// A place that shows the middle of some edge.
    pub fn edge(&self) -> DVec2 {
        let edges = self.world.edges_of(0).expect("found");
        let middles = edges.edges.iter().map(|e| e.curve[e.curve.len() / 2].piece.point(0.5));
        middles.filter_map(|p| self.seen(p)).next().expect("some edge is seen")
    }

    /// A place that shows the end of some edge.
    pub fn vertex(&self) -> DVec2 {
        let vertices = &self.world.edges_of(0).expect("found").vertices;
        vertices.iter().filter_map(|p| self.seen(*p)).next().expect("some corner is seen")
    }

    /// Where the window shows a point of the model, in a view of it.
    pub fn in_window(&self, camera: &Camera, p: DVec3) -> DVec2 {
        camera.project(p).expect("in front").0 + self.corner
    }
}
