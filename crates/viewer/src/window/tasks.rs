//! Work beside the frames: measuring and judging in threads, settings and pictures to files, pictures and texts to the
//! clipboard.

use super::Failure;
use super::app::{App, Event, Opened};
use super::photograph::Photograph;
use super::screen::Picture;
use crate::measure;
use crate::panels::{Shot, Verdict};
use selvedge::model::{Camera, Images, Model};
use selvedge::picture::FrameSettings;
use selvedge_check::{JudgeOptions, Tracer, judge};
use selvedge_io::import::caught;
use selvedge_io::{export, native};
use std::error::Error;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use std::{fs, io};

/// Pixels that are judged, beside those at which the face changes.
const JUDGED: usize = 20_000;

impl App {
    /// Measures the selection in a thread.
    pub fn measure(&mut self) {
        let (world, selection) = (Arc::clone(&self.session.world), self.session.selection.clone());
        let proxy = self.proxy.clone();
        self.measuring += 1;
        std::thread::spawn(move || {
            // after a panic, too, the thread counts no more
            let measured = caught(|| measure::measure(&world, &selection)).unwrap_or_default();
            drop(proxy.send_event(Event::Measured(selection, measured)));
        });
    }

    /// Draws a view and waits for its picture. `None`, with a message, where it fails.
    fn photograph(&mut self, camera: &Camera, settings: FrameSettings) -> Option<Photograph> {
        let Opened { engine, screen, .. } = self.opened.as_mut()?;
        let Some(renderer) = engine.renderer() else {
            self.ui.tell("There is no model to draw yet.".to_owned());
            return None;
        };
        match screen.photograph(&mut Picture { renderer, camera, settings }) {
            Ok(photograph) => Some(photograph),
            Err(Failure::Picture(error) | Failure::Screen(error)) => {
                self.ui.tell(format!("No picture: {error}"));
                None
            }
        }
    }

    /// The picture of the dialog.
    fn shot(&mut self) -> Option<Photograph> {
        let Shot { size, transparent, .. } = self.ui.shot;
        let usual = self.frame_settings();
        let background = if transparent { Some([0.0; 4]) } else { usual.background };
        let camera = Camera { size, ..*self.view.camera() };
        self.photograph(&camera, FrameSettings { background, ..usual })
    }

    /// Writes settings that have changed.
    pub fn keep_settings(&mut self) {
        if self.settings == self.kept {
            return;
        }
        self.kept = self.settings.clone();
        let written = self.options.settings.as_deref().map(|path| self.settings.write(path));
        if let Some(Err(error)) = written {
            self.ui.tell(format!("The settings cannot be written: {error}"));
        }
    }

    /// The desktop's clipboard, or why there is none; what was copied is there as long as the window is.
    fn clipboard(&mut self) -> Result<&mut arboard::Clipboard, arboard::Error> {
        match &mut self.clipboard {
            Some(clipboard) => Ok(clipboard),
            none => Ok(none.insert(arboard::Clipboard::new()?)),
        }
    }

    /// Copies a text to it.
    pub fn set_clipboard(&mut self, text: String) {
        if let Err(error) = self.clipboard().and_then(|clipboard| clipboard.set_text(text)) {
            self.ui.tell(format!("Not copied: {error}"));
        }
    }

    /// Copies the picture of the dialog to the desktop's clipboard.
    pub fn copy_picture(&mut self) {
        let Some(photograph) = self.shot() else { return };
        let (width, height) = photograph.size;
        let copied = self.clipboard().and_then(|clipboard| clipboard.set_image(image(&photograph)));
        let told = match copied {
            Ok(()) => format!("Copied: a picture of {width} x {height}."),
            Err(error) => format!("The picture is not copied: {error}"),
        };
        tracing::info!("{told}");
        self.ui.tell(told);
        self.ui.shot.open = false;
    }

    /// Writes the picture of the dialog.
    pub fn write_picture(&mut self) {
        let Some(photograph) = self.shot() else { return };
        let (path, size) = (self.ui.shot.path.clone(), photograph.size);
        let told = match write(&path, &photograph) {
            Ok(()) => format!("{} is written, {} x {}.", path.display(), size.0, size.1),
            Err(error) => format!("{} is not written: {error}", path.display()),
        };
        tracing::info!("{told}");
        self.ui.tell(told);
        self.ui.shot.open = false;
    }

    /// Saves all open files as one model, with the trim loops that were changed.
    pub fn save(&mut self) {
        let Some(path) = self.ui.save.take() else { return };
        if self.session.world.is_partial() {
            self.ui.tell(format!("{} is not saved: not all files are read yet.", path.display()));
            return;
        }
        let mut model = self.session.world.model.clone();
        self.session.scene.now().edit_for_file(&mut model);
        let open = self.session.world.files.iter().map(|file| file.path.as_path());
        let told = match save(&path, &model, open) {
            Ok(warnings) if warnings.is_empty() => format!("{} is saved.", path.display()),
            Ok(warnings) => format!("{} is saved, but: {}", path.display(), warnings.join("; ")),
            Err(error) => format!("{} is not saved: {error}", path.display()),
        };
        tracing::info!("{told}");
        self.ui.tell(told);
    }

    /// Draws the view again, and judges it in a thread.
    pub fn check(&mut self) {
        let (camera, settings) = (*self.view.camera(), self.frame_settings());
        let Some((model, hidden)) = self.opened.as_ref().and_then(|o| o.engine.model()) else { return };
        let Some(photograph) = self.photograph(&camera, settings) else { return };
        self.ui.tell("The view is being checked against exact rays.".to_owned());
        let (proxy, limit_px) = (self.proxy.clone(), settings.tolerance_px);
        std::thread::spawn(move || {
            let Photograph { size, depth, face, normal, .. } = &photograph;
            let images = Images { size: *size, depth, face, normal, ..Images::default() };
            let options = JudgeOptions { samples: Some(JUDGED), limit_px, listed: 1000, ..JudgeOptions::default() };
            let visible = model.instances.iter().enumerate().filter(|(nth, _)| !hidden.contains(nth));
            let instances = visible.map(|(_, placed)| placed.clone()).collect();
            let seen = Model { instances, ..Model::clone(&model) };
            let judgement = judge(&Tracer::new(&seen), &camera, &images, &options);
            let wrong = judgement.wrong + judgement.folds.beyond + judgement.folds.wrong_depth;
            let pixels = judgement.mismatches.iter().map(|m| m.pixel).collect();
            tracing::info!("checked {} pixels: {wrong} wrong", judgement.sampled);
            let verdict = Verdict { camera, sampled: judgement.sampled, wrong, pixels };
            drop(proxy.send_event(Event::Judged(Ok(verdict))));
        });
    }
}

/// Writes a model in the form of the file's ending; returns the omissions. A file that is `open` is replaced only where
/// it has the engine's own form: others hold more than the model. If writing fails, the old file is unchanged.
fn save<'p>(
    path: &Path,
    model: &Model,
    mut open: impl Iterator<Item = &'p Path>,
) -> Result<Vec<String>, Box<dyn Error>> {
    let is_own = |path: &Path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("selvedge"));
    let place = path.canonicalize().ok();
    if place.is_some() && !is_own(path) && open.any(|file| file.canonicalize().ok() == place) {
        return Err("it is open, and the saved model would take its place".into());
    }
    let mut bytes = Vec::new();
    let mut warnings = Vec::new();
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("selvedge") => bytes = native::write(model),
        Some("step" | "stp") => {
            let told = export::step(model, &mut bytes)?;
            warnings.extend(told.iter().map(|w| format!("{}: {}", w.item, w.message)));
        }
        _ => return Err("its name ends neither in .selvedge nor in .step".into()),
    }
    replace(path, &bytes)?;
    Ok(warnings)
}

/// Writes a file, which appears when it is whole.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut name = OsString::from(".part-");
    name.push(path.file_name().unwrap_or_default());
    let beside = path.with_file_name(name);
    let written = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, path));
    if written.is_err() {
        // it may never have been there
        let _ = fs::remove_file(&beside);
    }
    written
}

/// The colours of a picture as the clipboard takes them: sRGB and opacity, not multiplied, row 0 on top.
fn image(photograph: &Photograph) -> arboard::ImageData<'_> {
    let (width, height) = (photograph.size.0 as usize, photograph.size.1 as usize);
    arboard::ImageData { width, height, bytes: photograph.colour.as_flattened().into() }
}

/// Writes a PNG file. If writing fails, the old file is unchanged.
fn write(path: &Path, photograph: &Photograph) -> Result<(), Box<dyn Error>> {
    if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        return Err("its name does not end in .png".into());
    }
    let mut bytes: Vec<u8> = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, photograph.size.0, photograph.size.1);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(photograph.colour.as_flattened())?;
    writer.finish()?;
    Ok(replace(path, &bytes)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SceneState;
    use selvedge::model::{Face, SurfaceKind};

    /// A model that someone else wrote, a picture that is none, a folder that is not there.
    #[test]
    fn what_is_written_replaces_nothing_else() {
        let folder = std::env::temp_dir().join(format!("selvedge-save-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = |name: &str| folder.join(name);
        let (step, own, picture) = (path("a.step"), path("a.selvedge"), path("a.png"));
        fs::write(&step, "ISO-10303-21;").unwrap();
        let open = [step.as_path(), own.as_path()];
        let saved = |path: &Path| save(path, &Model::default(), open.into_iter()).map_err(|e| e.to_string());
        assert!(saved(&step).unwrap_err().contains("it is open"));
        assert!(saved(&path("./a.step")).is_err() && saved(&path("none/a.selvedge")).is_err());
        assert_eq!(fs::read(&step).unwrap(), b"ISO-10303-21;");
        saved(&own).unwrap();
        saved(&own).unwrap();
        let photograph = Photograph { size: (1, 1), colour: vec![[9; 4]], ..Photograph::default() };
        assert!(write(&step, &photograph).unwrap_err().to_string().contains(".png"));
        write(&picture, &photograph).unwrap();
        let old = fs::read(&picture).unwrap();
        // a pixel is missing
        assert!(write(&picture, &Photograph { size: (2, 1), ..photograph }).is_err());
        assert!(fs::read(&picture).unwrap() == old && old.starts_with(b"\x89PNG"));
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 3);
        fs::remove_dir_all(&folder).unwrap();
    }

    /// A hole of a plate, and the wall below it, which stays as it was.
    #[test]
    fn a_changed_loop_is_saved_in_both_forms() {
        let read = |path: &Path| selvedge_io::import::open(path).unwrap().model;
        let original = read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/bracket.step"));
        let is_plate = |face: &Face| face.kind == SurfaceKind::Plane && face.loops.len() > 1;
        let face = original.parts[0].faces.iter().position(is_plate).unwrap();
        let hole = &original.parts[0].faces[face].loops[1];
        let ((low, high), point) = (hole.bounds(), hole.curves().next().unwrap().point(0.0));
        let moved = hole.with_point(0, 0, point + 0.2 * (point - 0.5 * (low + high))).unwrap();
        let mut state = SceneState::default();
        state.edits.insert((0, face, 1), moved);
        let mut edited = original.clone();
        state.edit_for_file(&mut edited);
        let areas = |model: &Model| {
            let mut all: Vec<f64> = model.parts[0].faces.iter().map(|face| face.area()).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let (before, wanted) = (areas(&original), areas(&edited));
        let change = (before.iter().sum::<f64>() - wanted.iter().sum::<f64>()).abs();
        // the hole has a radius of millimetres
        assert!(change > 0.01, "{change}");
        let folder = std::env::temp_dir().join(format!("selvedge-edit-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        for name in ["edited.selvedge", "edited.step"] {
            let path = folder.join(name);
            save(&path, &edited, std::iter::empty()).unwrap();
            let found = areas(&read(&path));
            assert_eq!(found.len(), wanted.len(), "{name}");
            let off = found.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 0.01 * change, "{name}: a face is off by {off} mm² of {change}");
        }
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_copied_picture_keeps_its_rows_and_its_opacity() {
        let colour = vec![[255, 0, 0, 0], [1, 2, 3, 128]];
        let photograph = Photograph { size: (1, 2), colour, ..Photograph::default() };
        let image = image(&photograph);
        assert_eq!((image.width, image.height, &image.bytes[..]), (1, 2, &[255, 0, 0, 0, 1, 2, 3, 128][..]));
    }
}
