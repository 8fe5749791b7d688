//! A real window, driven by keys and mouse: Xvfb shows it, xdotool moves the mouse, a Vulkan device draws.
//!
//! The test starts itself again as the program with the window, and reads its log. It computes the places of faces and
//! edges on the screen from the same camera in `f64`. The validation layer is on, and must stay silent.

use glam::{DVec2, DVec3};
use selvedge::model::{Camera, Face, SurfaceKind};
use selvedge_check::Tracer;
use selvedge_viewer::session::{Loaded, World};
use selvedge_viewer::view::View;
use selvedge_viewer::{ViewOptions, run};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

/// Names the file that the window opens: set for the process with the window.
const FILE: &str = "SELVEDGE_WINDOW_FILE";
const NAME: &str = "a_window_is_used_as_a_person_does";
/// Longest wait for anything; a machine that draws by its CPU and is busy takes seconds for the first picture.
const PATIENCE: Duration = Duration::from_secs(120);

#[test]
fn a_window_is_used_as_a_person_does() {
    if let Some(file) = std::env::var_os(FILE) {
        return window(PathBuf::from(file));
    }
    if std::env::var("SELVEDGE_WITHOUT").is_ok_and(|left_out| left_out.split(',').any(|name| name == "window")) {
        return;
    }
    let needs =
        "the window test needs Xvfb and xdotool: apt install xvfb xdotool; SELVEDGE_WITHOUT=window leaves it out";
    script(&Display::open().expect(needs));
}

/// The process with the window.
fn window(file: PathBuf) {
    tracing_subscriber::fmt()
        .with_max_level(tracing::Level::DEBUG)
        .with_writer(std::io::stderr)
        .with_ansi(false)
        .init();
    let closed = run(ViewOptions {
        settings: file.parent().map(|folder| folder.join("settings.json")),
        files: vec![file],
        validation: true,
        size: Some((900, 560)),
        device: None,
    });
    let messages = closed.expect("the window closes well").messages;
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}

/// An X server without a screen.
struct Display {
    server: Child,
    name: String,
}

impl Display {
    fn open() -> Option<Self> {
        Command::new("xdotool").arg("version").stdout(Stdio::null()).status().ok()?;
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "900x560x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        let mut number = String::new();
        BufReader::new(server.stdout.take()?).read_line(&mut number).ok()?;
        Some(Self { server, name: format!(":{}", number.trim()) })
    }

    fn xdotool(&self, words: &str) -> String {
        let output = Command::new("xdotool").args(words.split(' ')).env("DISPLAY", &self.name).output().expect("runs");
        assert!(output.status.success(), "xdotool {words}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// The process with the window, and its log.
struct Program {
    child: Child,
    lines: Receiver<String>,
    all: Vec<String>,
}

impl Program {
    fn start(display: &Display, file: &Path) -> Self {
        let mut child = Command::new(std::env::current_exe().expect("this test"))
            .args(["--exact", NAME, "--nocapture"])
            .env(FILE, file)
            .env("DISPLAY", &display.name)
            .env_remove("WAYLAND_DISPLAY")
            .current_dir(file.parent().expect("a folder"))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("starts");
        let (to, lines) = mpsc::channel();
        let said = BufReader::new(child.stderr.take().expect("piped"));
        std::thread::spawn(move || said.lines().map_while(Result::ok).try_for_each(|line| to.send(line)));
        Self { child, lines, all: Vec::new() }
    }

    fn line(&mut self, wait: Duration) -> Option<String> {
        let line = self.lines.recv_timeout(wait).ok()?;
        self.all.push(line.clone());
        Some(line)
    }

    /// The next line that contains `what`.
    fn wait(&mut self, what: &str) -> String {
        let end = Instant::now() + PATIENCE;
        while let Some(line) = self.line(end.saturating_duration_since(Instant::now())) {
            if line.contains(what) {
                return line;
            }
        }
        panic!("it never said `{what}`; it said\n{}", self.all.join("\n"));
    }

    /// Waits until the log is silent for so long, so nothing is drawn.
    fn rest(&mut self, still: Duration) {
        let end = Instant::now() + PATIENCE;
        while self.line(still).is_some() {
            assert!(Instant::now() < end, "it never rests:\n{}", self.all.join("\n"));
        }
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The numbers of a line, after `from`.
fn numbers(line: &str, from: &str) -> Vec<f64> {
    let rest = line.split(from).nth(1).unwrap_or_default();
    let words = rest.split(|c: char| !(c.is_ascii_digit() || ".-e".contains(c)));
    words.filter_map(|word| word.parse().ok()).collect()
}

/// The model as the window has it, and its view.
struct Scene {
    world: World,
    tracer: Tracer,
    camera: Camera,
    corner: DVec2,
}

impl Scene {
    fn new(file: &Path, place: &[f64]) -> Self {
        let import = selvedge_io::import::open(file).expect("a sample");
        let world = World::new(&[Arc::new(Loaded { path: file.to_owned(), import })]);
        world.find_edges();
        let mut view = View::default();
        view.resize((place[0] as u32, place[1] as u32));
        view.set_bounds(world.bounds);
        view.reset(Instant::now());
        let tracer = Tracer::new(&world.model);
        Self { tracer, camera: *view.camera(), corner: DVec2::new(place[2], place[3]), world }
    }

    fn faces(&self) -> &[Face] {
        &self.world.model.parts[0].faces
    }

    /// The pixel of the view of a point, if the point is visible there.
    fn seen(&self, p: DVec3) -> Option<DVec2> {
        let (pixel, depth) = self.camera.project(p)?;
        let inside = pixel.min_element() > 12.0 && pixel.x < f64::from(self.camera.size.0) - 130.0;
        let hit = self.tracer.probe(&self.camera).first(pixel).filter(|_| inside)?;
        ((hit.depth - depth).abs() < 1e-3 * self.world.bounds.diagonal()).then_some(pixel)
    }

    /// A place on the screen that shows a cylinder with nothing else within five pixels; and its face.
    fn cylinder(&self) -> (DVec2, &Face) {
        let alone = |id: u32, pixel: DVec2| {
            let mut probe = self.tracer.probe(&self.camera);
            let around = [(5.0, 0.0), (-5.0, 0.0), (0.0, 5.0), (0.0, -5.0), (0.0, 0.0)];
            around.iter().all(|(x, y)| probe.first(pixel + DVec2::new(*x, *y)).is_some_and(|hit| hit.face == id))
        };
        let found = self.faces().iter().filter(|f| f.kind == SurfaceKind::Cylinder).find_map(|face| {
            let ((u0, u1), (v0, v1)) = face.surface.domain();
            let grid = (1..20).flat_map(|i| (1..20).map(move |j| (f64::from(i) / 20.0, f64::from(j) / 20.0)));
            let point = |(a, b): (f64, f64)| face.surface.point(u0 + (u1 - u0) * a, v0 + (v1 - v0) * b);
            Some((grid.filter_map(|at| self.seen(point(at))).find(|p| alone(face.id, *p))?, face))
        });
        let (pixel, face) = found.expect("some cylinder is seen");
        (pixel + self.corner, face)
    }

    /// A place on the screen that shows the middle of some edge.
    fn edge(&self) -> DVec2 {
        let edges = self.world.edges_of(0).expect("found");
        let middles = edges.edges.iter().map(|e| e.curve[e.curve.len() / 2].piece.point(0.5));
        middles.filter_map(|p| self.seen(p)).next().expect("some edge is seen") + self.corner
    }
}

/// The radius that the file states for the cylinder of a face.
fn stated_radius(file: &Path, face: u32) -> f64 {
    let text = std::fs::read_to_string(file).expect("a sample").replace(['\n', '\r', ' '], "");
    let entity = |number: u32| {
        let start = text.find(&format!("#{number}=")).expect("the entity");
        text[start..].split(';').next().expect("its end").to_owned()
    };
    let of_face = entity(face);
    let surface = of_face.rsplit('#').next().and_then(|rest| rest.split(',').next()).expect("a surface");
    let cylinder = entity(surface.parse().expect("a number"));
    assert!(cylinder.contains("CYLINDRICAL_SURFACE"), "{cylinder}");
    cylinder.rsplit(',').next().and_then(|r| r.trim_end_matches(')').parse().ok()).expect("a radius")
}

fn script(display: &Display) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("bracket.step");
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/bracket.step");
    std::fs::copy(&sample, &file).expect("copied");
    let mut program = Program::start(display, &file);
    let place = program.wait("view of ");
    program.wait("first picture");
    program.rest(Duration::from_millis(700));
    let place = program.all.iter().rfind(|line| line.contains("view of ")).unwrap_or(&place).clone();
    let scene = Scene::new(&file, &numbers(&place, "view of "));
    let id = display.xdotool("search --name selvedge");
    let id = id.lines().last().expect("the window");
    display.xdotool(&format!("windowfocus {id}"));
    let click = |at: DVec2| display.xdotool(&format!("mousemove {} {} click 1", at.x as i32, at.y as i32));

    // a cylinder: recognised, and measured as the file states it
    let (at, face) = scene.cylinder();
    click(at);
    let selected = program.wait("selected ");
    assert!(selected.contains(&format!("cylinder #{}", face.id)), "{selected}");
    let radius = numbers(&program.wait("radius: "), "radius: ")[0];
    let stated = stated_radius(&file, face.id);
    // twelve digits: the accuracy of rational arcs of f64 points
    assert!((radius / stated - 1.0).abs() < 1e-12, "{radius} instead of {stated}");

    // an edge
    click(scene.edge());
    let selected = program.wait("selected ");
    assert!(selected.contains("edge ") || selected.contains("vertex "), "{selected}");

    // turned by the right button; the cursor's point stays, all pixels come in the end
    let (width, height) = (scene.camera.size.0, scene.camera.size.1);
    display.xdotool(&format!("mousemove {} {} mousedown 3", at.x as i32, at.y as i32));
    (0..6).for_each(|_| drop(display.xdotool("mousemove_relative 14 5")));
    display.xdotool("mouseup 3");
    program.wait(&format!("picture of {width} x {height}"));
    program.rest(Duration::from_millis(700));

    // a picture in a file, of the view that is shown
    display.xdotool("key --clearmodifiers ctrl+shift+s");
    program.wait("is written");
    let picture = std::fs::File::open(folder.path().join("view.png")).expect("the picture");
    let mut reader = png::Decoder::new(BufReader::new(picture)).read_info().expect("a picture");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    assert_eq!((info.width, info.height), (1280, 720));
    let (corner, colours) = (pixels[..4].to_vec(), pixels.chunks_exact(4));
    let model = colours.filter(|p| *p != corner).count();
    assert!(model > 1280 * 720 / 20, "{model} pixels show the model");

    // nothing is drawn while nothing happens
    program.rest(Duration::from_millis(700));
    let before = program.all.len();
    assert!(program.line(Duration::from_millis(1500)).is_none(), "{:?}", &program.all[before..]);

    // another size, then hidden and shown again
    display.xdotool(&format!("windowsize {id} 700 480"));
    program.wait("picture of ");
    program.rest(Duration::from_millis(700));
    display.xdotool(&format!("windowunmap {id}"));
    display.xdotool(&format!("windowmap {id}"));
    program.rest(Duration::from_millis(700));

    // a file that changes is read again
    std::fs::copy(&sample, &file).expect("copied");
    program.wait("has changed");
    program.wait("read ");
    program.wait("picture of ");

    display.xdotool(&format!("windowfocus {id} key --clearmodifiers ctrl+q"));
    program.wait("closing");
    let status = program.child.wait().expect("ends");
    while program.line(Duration::from_millis(200)).is_some() {}
    assert!(status.success(), "{}", program.all.join("\n"));
}
