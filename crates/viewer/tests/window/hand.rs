//! The hand: an X server without a screen, the mouse and the keys that xdotool moves, and the program with the window.

use super::{FILE, NAME, PATIENCE, SIZE};
use glam::DVec2;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{AtomEnum, PropMode};
use x11rb::wrapper::ConnectionExt;

/// An act of the hand reaches the program before its log was silent so long.
const STILL: Duration = Duration::from_millis(700);
/// A frame that a move or a click of the mouse causes begins within so long.
const MOMENT: Duration = Duration::from_millis(200);
/// Moves of one drag.
const STEPS: u32 = 6;
/// Size of the picture that Ctrl + Shift + S writes.
pub const PICTURE: (u32, u32) = (1280, 720);

/// An X server without a screen.
pub struct Display {
    server: Child,
    name: String,
    /// Width and height of the screen; the window fills it.
    size: (u32, u32),
    /// Where the server keeps its picture.
    folder: tempfile::TempDir,
}

impl Display {
    pub fn open(size: (u32, u32)) -> Option<Self> {
        Command::new("xdotool").arg("version").stdout(Stdio::null()).status().ok()?;
        let folder = tempfile::tempdir().ok()?;
        let mut server = Command::new("Xvfb")
            .arg("-fbdir")
            .arg(folder.path())
            .args(["-displayfd", "1", "-screen", "0", &format!("{}x{}x24", size.0, size.1), "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        let mut number = String::new();
        BufReader::new(server.stdout.take()?).read_line(&mut number).ok()?;
        Some(Self { server, name: format!(":{}", number.trim()), size, folder })
    }

    /// The server's name, for other clients.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Moves mouse and keys by the words of xdotool's command line.
    pub fn xdotool(&self, words: &str) -> String {
        let output = Command::new("xdotool").args(words.split(' ')).env("DISPLAY", &self.name).output().expect("runs");
        assert!(output.status.success(), "xdotool {words}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    /// Gives the display another scale. winit reads it from the root window's resources when those of its own window
    /// change.
    pub fn set_scale(&self, window: &str, scale: f64) {
        let (connection, screen) = x11rb::connect(Some(&self.name)).expect("the server");
        let root = connection.setup().roots[screen].root;
        let resources = format!("Xft.dpi:\t{}\n", 96.0 * scale);
        for window in [root, window.parse().expect("a number")] {
            let (name, kind) = (AtomEnum::RESOURCE_MANAGER, AtomEnum::STRING);
            let changed = connection.change_property8(PropMode::REPLACE, window, name, kind, resources.as_bytes());
            changed.expect("sent").check().expect("changed");
        }
    }

    pub fn move_to(&self, at: DVec2) {
        self.xdotool(&format!("mousemove {} {}", at.x as i32, at.y as i32));
    }

    pub fn click(&self, at: DVec2) {
        self.xdotool(&format!("mousemove {} {} click 1", at.x as i32, at.y as i32));
    }

    pub fn key(&self, key: &str) {
        self.xdotool(&format!("key --clearmodifiers {key}"));
    }

    /// The screen's pixels, red, green and blue, row 0 on top. The server's file is one of xwd: a header of big-endian
    /// words, colours of 12 bytes, pixels.
    pub fn screen(&self) -> Pixels {
        let bytes = std::fs::read(self.folder.path().join("Xvfb_screen0")).expect("the server's picture");
        let word = |n: usize| u32::from_be_bytes(bytes[4 * n..4 * n + 4].try_into().expect("four bytes")) as usize;
        let (header, width, height, bits, row, colours) = (word(0), word(4), word(5), word(11), word(12), word(19));
        assert_eq!((width, height, bits), (self.size.0 as usize, self.size.1 as usize, 32));
        let start = header + 12 * colours;
        let pixel = |x: usize, y: usize| {
            let [blue, green, red, _] = bytes[start + y * row + 4 * x..][..4] else { unreachable!("four bytes") };
            [red, green, blue]
        };
        let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        Pixels { size: self.size, all }
    }
}

/// A picture of the screen.
pub struct Pixels {
    size: (u32, u32),
    all: Vec<[u8; 3]>,
}

impl Pixels {
    /// How much more red than blue a place is, of 255.
    pub fn warmth(&self, at: DVec2) -> i32 {
        let [red, _, blue] = self.all[at.y as usize * self.size.0 as usize + at.x as usize];
        i32::from(red) - i32::from(blue)
    }

    /// The mean of red, green and blue at a place, of 255.
    pub fn brightness(&self, at: DVec2) -> i32 {
        let all = self.all[at.y as usize * self.size.0 as usize + at.x as usize];
        all.iter().map(|part| i32::from(*part)).sum::<i32>() / 3
    }

    /// The share of places that have the same colour in another picture of the screen.
    pub fn same(&self, other: &Self) -> f64 {
        let same = self.all.iter().zip(&other.all).filter(|(a, b)| a == b).count();
        same as f64 / self.all.len() as f64
    }

    /// Writes it as a picture of docs/viewer.md, where the environment names a folder for them.
    pub fn keep(&self, name: &str) {
        let Some(folder) = std::env::var_os("SELVEDGE_WINDOW_PICTURES") else { return };
        let file = std::fs::File::create(Path::new(&folder).join(name)).expect("a file");
        let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), self.size.0, self.size.1);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().expect("written");
        writer.write_image_data(self.all.as_flattened()).expect("written");
        writer.finish().expect("written");
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// The process with the window, and its log.
pub struct Program {
    child: Child,
    lines: Receiver<String>,
    pub all: Vec<String>,
    folder: PathBuf,
    /// The window's number.
    pub id: String,
}

impl Program {
    /// Opens a file and waits for its picture at rest.
    pub fn start(display: &Display, file: &Path, variables: &[(&str, &str)]) -> Self {
        let mut program = Self::begin(display, file, variables);
        program.rest();
        program
    }

    /// Opens a file and waits for the first picture. The process has these variables in its environment, too.
    pub fn begin(display: &Display, file: &Path, variables: &[(&str, &str)]) -> Self {
        let folder = file.parent().expect("a folder").to_owned();
        let mut child = Command::new(std::env::current_exe().expect("this test"))
            .args(["--exact", NAME, "--nocapture"])
            .env(FILE, file)
            .env(SIZE, format!("{} {}", display.size.0, display.size.1))
            .env("DISPLAY", &display.name)
            .envs(variables.iter().copied())
            .env_remove("WAYLAND_DISPLAY")
            .current_dir(&folder)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("starts");
        let (to, lines) = mpsc::channel();
        let said = BufReader::new(child.stderr.take().expect("piped"));
        std::thread::spawn(move || said.lines().map_while(Result::ok).try_for_each(|line| to.send(line)));
        let mut program = Self { child, lines, all: Vec::new(), folder, id: String::new() };
        program.wait("first picture");
        let id = display.xdotool("search --name selvedge");
        program.id = id.lines().last().expect("the window").to_owned();
        display.xdotool(&format!("windowfocus {}", program.id));
        program
    }

    pub fn line(&mut self, wait: Duration) -> Option<String> {
        let line = self.lines.recv_timeout(wait).ok()?;
        self.all.push(line.clone());
        Some(line)
    }

    /// The next line that contains `what`.
    pub fn wait(&mut self, what: &str) -> String {
        let end = Instant::now() + PATIENCE;
        while let Some(line) = self.line(end.saturating_duration_since(Instant::now())) {
            if line.contains(what) {
                return line;
            }
        }
        panic!("it never said `{what}`; it said\n{}", self.all.join("\n"));
    }

    /// Waits until it has said `what`, before or from now on.
    pub fn said(&mut self, what: &str) {
        if !self.all.iter().any(|line| line.contains(what)) {
            self.wait(what);
        }
    }

    /// Waits until the program is silent; it may be reading.
    pub fn quiet(&mut self) {
        while self.line(STILL).is_some() {}
    }

    /// Waits until the program is silent for a moment: a menu that was opened has its place.
    pub fn settle(&mut self) {
        while self.line(MOMENT).is_some() {}
    }

    /// Waits until the program says that it is idle, and nothing after that. Silence alone is not enough: a busy
    /// machine may be silent in the middle of an upload.
    pub fn rest(&mut self) {
        let end = Instant::now() + PATIENCE;
        while self.line(STILL).is_some() || !self.is_idle() {
            assert!(Instant::now() < end && self.runs(), "it never rests:\n{}", self.all.join("\n"));
        }
    }

    /// The last line of the window itself says so.
    fn is_idle(&self) -> bool {
        let own = self.all.iter().rfind(|line| line.contains("selvedge_viewer::"));
        own.is_some_and(|line| line.ends_with(": idle"))
    }

    pub fn runs(&mut self) -> bool {
        self.child.try_wait().expect("a state").is_none()
    }

    /// The last line so far that contains `what`.
    pub fn last(&self, what: &str) -> String {
        let found = self.all.iter().rfind(|line| line.contains(what));
        found.unwrap_or_else(|| panic!("it never said `{what}`; it said\n{}", self.all.join("\n"))).clone()
    }

    /// What it says from an act until it rests again.
    pub fn after(&mut self, act: impl FnOnce()) -> Vec<String> {
        let before = self.all.len();
        act();
        // whatever follows begins with a frame
        self.wait("frame");
        self.rest();
        self.all[before..].to_vec()
    }

    /// Moves the cursor, and waits for a frame with it there: by its end the window has what is under the cursor.
    pub fn point(&mut self, display: &Display, at: DVec2) {
        display.move_to(at);
        self.seen(at, false);
    }

    /// Drags with a button in a few steps, each of which a frame has seen: panels would take a press and a release
    /// within one frame for a click, and a view turns about the point that a frame after the press has found. Returns
    /// what it says until it rests.
    pub fn drag(&mut self, display: &Display, button: u32, from: DVec2, by: DVec2) -> Vec<String> {
        let before = self.all.len();
        self.point(display, from);
        display.xdotool(&format!("mousedown {button}"));
        self.seen(from, true);
        let mut at = from;
        for step in 1..=STEPS {
            at = (from + by * (f64::from(step) / f64::from(STEPS))).round();
            display.move_to(at);
            self.seen(at, true);
        }
        display.xdotool(&format!("mouseup {button}"));
        self.seen(at, false);
        self.rest();
        self.all[before..].to_vec()
    }

    /// Waits for the end of a frame with the cursor at a place, and a button down or none.
    fn seen(&mut self, at: DVec2, is_down: bool) {
        let button = if is_down { "down" } else { "up" };
        let wanted = format!("pointer at {}, {}, {button}", at.x as i32, at.y as i32);
        let end = Instant::now() + PATIENCE;
        loop {
            let last = self.all.iter().rposition(|line| line.contains("pointer at "));
            let is_there = last.is_some_and(|nth| {
                self.all[nth].ends_with(&wanted) && self.all[nth..].iter().any(|line| line.ends_with(": frame"))
            });
            if is_there {
                return;
            }
            if self.line(end.saturating_duration_since(Instant::now())).is_none() {
                panic!("no frame has seen `{wanted}`; it said\n{}", self.all.join("\n"));
            }
        }
    }

    /// The line of `selvedge render` for the view.
    pub fn command(&mut self, display: &Display) -> String {
        display.key("ctrl+shift+c");
        let line = self.wait("copied: selvedge render");
        self.rest();
        line
    }

    /// The view's picture: colours, row 0 on top.
    pub fn picture(&mut self, display: &Display) -> Vec<[u8; 4]> {
        display.key("ctrl+shift+s");
        self.wait("is written");
        self.rest();
        let (size, pixels) = read_png(&self.folder.join("view.png"));
        assert_eq!(size, PICTURE);
        pixels
    }

    /// A file of `/proc` on the process.
    pub fn status(&self, name: &str) -> String {
        std::fs::read_to_string(format!("/proc/{}/{name}", self.child.id())).expect("the process runs")
    }

    /// Seconds of all processors that it has used, in units of 1/100.
    pub fn ticks(&self) -> u64 {
        let stat = self.status("stat");
        // the second field is a name in brackets; user and system time are the 14th and 15th
        let fields = stat.rsplit(')').next().expect("fields").split_whitespace();
        fields.skip(11).take(2).map(|ticks| ticks.parse::<u64>().expect("a number")).sum()
    }

    /// Its memory, KiB.
    pub fn memory(&self) -> u64 {
        let status = self.status("status");
        let line = status.lines().find(|line| line.starts_with("VmRSS:")).expect("a line");
        line.split_whitespace().nth(1).and_then(|kib| kib.parse().ok()).expect("a number")
    }

    /// Closes it by its key; it must say nothing of the validation layer.
    pub fn close(mut self, display: &Display) {
        display.xdotool(&format!("windowfocus {} key --clearmodifiers ctrl+q", self.id));
        self.wait("closing");
        let status = self.child.wait().expect("ends");
        while self.line(Duration::from_millis(200)).is_some() {}
        assert!(status.success(), "{}", self.all.join("\n"));
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Size and pixels of a PNG file, row 0 on top.
pub fn read_png(path: &Path) -> ((u32, u32), Vec<[u8; 4]>) {
    let file = std::fs::File::open(path).expect("the picture");
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().expect("a picture");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    ((info.width, info.height), pixels.as_chunks::<4>().0.to_vec())
}

/// The numbers of a line, after `from`.
pub fn numbers(line: &str, from: &str) -> Vec<f64> {
    let rest = line.split(from).nth(1).unwrap_or_default();
    let words = rest.split(|c: char| !(c.is_ascii_digit() || ".-e".contains(c)));
    words.filter_map(|word| word.parse().ok()).collect()
}
