//! The stored settings: a JSON file in the user's folder of settings.
//!
//! Unknown fields are preserved, and so are values that this version cannot read; missing fields have their default:
//! newer and older versions share one file.

use crate::navigation::OrbitStyle;
use crate::navigation::gesture::Preset;
use glam::DVec3;
use selvedge::picture::{EdgeChoice, EdgeSettings, SceneSettings, Smooth, Style};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::io;
use std::path::{Path, PathBuf};

/// Towards the light that casts shadows, model axes: from the front right, high above.
pub const SUN: DVec3 = DVec3::new(0.5, -0.7, 1.0);
/// Reach of ambient occlusion as a share of the model's diagonal. A test of the program holds it equal to that of
/// `selvedge render --ao=auto`.
const AMBIENT: f64 = 0.04;
/// Most files in the list of recent ones.
const MOST_RECENT: usize = 12;

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)]
pub enum Theme {
    #[default]
    System,
    Light,
    Dark,
}

/// Which lines are drawn along edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)]
pub enum Lines {
    #[default]
    All,
    Sharp,
    None,
}

/// The user's choices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// The style of mouse buttons.
    pub preset: Preset,
    /// How a drag turns the model.
    pub orbit: OrbitStyle,
    /// Views change at once, whatever the desktop's settings say.
    pub reduced_motion: bool,
    /// Light or dark.
    pub theme: Theme,
    /// Size of text, times that of the display.
    pub text: f32,
    /// Lines along edges.
    pub lines: Lines,
    /// Outlines of curved faces.
    pub silhouettes: bool,
    /// Hidden lines, dashed.
    pub hidden_lines: bool,
    /// Borders of trimmed faces are smooth.
    pub smooth: bool,
    /// Ambient occlusion darkens corners.
    pub ambient: bool,
    /// The light stands still and casts shadows.
    pub shadows: bool,
    /// Files opened last, the last one first.
    pub recent: Vec<PathBuf>,
    /// Fields of other versions.
    #[serde(flatten)]
    pub others: Map<String, Value>,
    /// Values of this version's fields that it cannot read, such as those of a later one. Such a field has its default,
    /// and its value stays in the file until it is changed.
    #[serde(skip)]
    pub unread: Map<String, Value>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            preset: Preset::default(),
            orbit: OrbitStyle::default(),
            reduced_motion: false,
            theme: Theme::default(),
            text: 1.0,
            lines: Lines::default(),
            silhouettes: true,
            hidden_lines: false,
            smooth: true,
            ambient: false,
            shadows: false,
            recent: Vec::new(),
            others: Map::new(),
            unread: Map::new(),
        }
    }
}

/// The folder of the user's settings, by the XDG Base Directory Specification 0.8: `$XDG_CONFIG_HOME`, else
/// `~/.config`.
pub fn folder(config_home: Option<PathBuf>, home: Option<PathBuf>) -> Option<PathBuf> {
    let absolute = config_home.filter(|folder| folder.is_absolute());
    absolute.or_else(|| home.map(|home| home.join(".config")))
}

/// The window's settings in that [`folder`].
pub fn path(folder: &Path) -> PathBuf {
    folder.join("selvedge").join("viewer.json")
}

impl Settings {
    /// Reads them; the defaults where there is no file yet.
    ///
    /// # Errors
    /// When the file cannot be read, or is no JSON object: naming the line.
    pub fn read(path: &Path) -> io::Result<Self> {
        let text = match std::fs::read(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::default()),
            text => text?,
        };
        let all: Map<String, Value> = serde_json::from_slice(&text)?;
        let is_read = |(name, value): (&String, &Value)| {
            let alone = Map::from_iter([(name.clone(), value.clone())]);
            serde_json::from_value::<Self>(Value::Object(alone)).is_ok()
        };
        let (read, unread): (Vec<_>, Vec<_>) = all.into_iter().partition(|(name, value)| is_read((name, value)));
        let mut settings: Self = serde_json::from_value(Value::Object(read.into_iter().collect()))?;
        settings.unread = unread.into_iter().collect();
        settings.text = settings.text.clamp(0.5, 4.0);
        settings.recent.truncate(MOST_RECENT);
        Ok(settings)
    }

    /// Writes them. If writing fails, the old file is unchanged.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let folder = path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder)?;
        let beside = path.with_extension("json.new");
        std::fs::write(&beside, serde_json::to_vec_pretty(&self.stored()?)?)?;
        std::fs::rename(&beside, path)
    }

    /// As the file has them.
    fn stored(&self) -> serde_json::Result<Value> {
        let (mut stored, usual) = (serde_json::to_value(self)?, serde_json::to_value(Self::default())?);
        for (name, value) in &self.unread {
            if stored[name] == usual[name] {
                stored[name] = value.clone();
            }
        }
        Ok(stored)
    }

    /// The reach of ambient occlusion in model units, where it is wanted, of a model with this diagonal. A model
    /// without a size has none.
    pub fn ambient_radius(&self, diagonal: f64) -> Option<f64> {
        let radius = AMBIENT * diagonal;
        (self.ambient && radius.is_finite() && radius > 0.0).then_some(radius)
    }

    /// The engine's settings of a model with this diagonal, in this style.
    pub fn scene(&self, style: Style, diagonal: f64) -> SceneSettings {
        let which = match self.lines {
            Lines::All => EdgeChoice::All,
            Lines::Sharp => EdgeChoice::Sharp,
            Lines::None => EdgeChoice::None,
        };
        let (silhouettes, hidden) = (self.silhouettes, self.hidden_lines);
        let edges = EdgeSettings { which, silhouettes, hidden, ..EdgeSettings::default() };
        SceneSettings {
            edges: (which != EdgeChoice::None || silhouettes).then_some(edges),
            smooth: if self.smooth { Smooth::Borders } else { Smooth::None },
            curvature: style.is_curvature(),
            ambient: self.ambient_radius(diagonal),
            sun: self.shadows.then_some(SUN),
            ..SceneSettings::default()
        }
    }

    /// A file was opened.
    pub fn opened(&mut self, file: &Path) {
        let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        self.recent.retain(|known| *known != file);
        self.recent.insert(0, file);
        self.recent.truncate(MOST_RECENT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_another_version_is_read_and_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a/b/viewer.json");
        assert_eq!(Settings::read(&path).expect("no file yet"), Settings::default());
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(&path, r#"{"preset": "catia", "later": {"x": 1}, "text": 99}"#).expect("written");
        let mut settings = Settings::read(&path).expect("read");
        assert_eq!((settings.preset, settings.text, settings.lines), (Preset::Catia, 4.0, Lines::All));
        settings.opened(Path::new("/x/a.step"));
        settings.write(&path).expect("written");
        let again = Settings::read(&path).expect("read");
        assert_eq!(again, settings);
        assert_eq!(again.others["later"]["x"], 1);
        assert_eq!(std::fs::read_dir(path.parent().expect("a folder")).expect("a list").count(), 1);
    }

    #[test]
    fn a_damaged_file_is_reported_and_not_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("viewer.json");
        std::fs::write(&path, "{\n\"preset\": }").expect("written");
        let error = Settings::read(&path).expect_err("damaged").to_string();
        assert!(error.contains("line 2"), "{error}");
        std::fs::write(&path, "[]").expect("written");
        assert!(Settings::read(&path).is_err());
    }

    #[test]
    fn values_of_another_version_stay_in_the_file_until_they_are_changed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("viewer.json");
        let file = r#"{"preset": "later", "lines": {"kind": "dotted"}, "text": 2.0, "shadows": true}"#;
        std::fs::write(&path, file).expect("written");
        let mut settings = Settings::read(&path).expect("read");
        let seen = (settings.preset, settings.lines, settings.text, settings.shadows);
        assert_eq!(seen, (Preset::default(), Lines::default(), 2.0, true));
        settings.lines = Lines::None;
        settings.write(&path).expect("written");
        let stored: Value = serde_json::from_slice(&std::fs::read(&path).expect("read")).expect("JSON");
        assert_eq!((&stored["preset"], &stored["lines"]), (&Value::from("later"), &Value::from("none")));
        assert_eq!(Settings::read(&path).expect("read").preset, Preset::default());
    }

    #[test]
    fn recent_files_are_each_there_once_and_the_last_is_first() {
        let mut settings = Settings::default();
        for name in ["/a", "/b", "/a"] {
            settings.opened(Path::new(name));
        }
        assert_eq!(settings.recent, [PathBuf::from("/a"), PathBuf::from("/b")]);
        (0..50).for_each(|i| settings.opened(Path::new(&format!("/{i}"))));
        assert_eq!((settings.recent.len(), settings.recent[0].clone()), (MOST_RECENT, PathBuf::from("/49")));
    }

    #[test]
    fn only_a_wanted_light_reaches_somewhere() {
        let settings = Settings { ambient: true, ..Settings::default() };
        assert_eq!(settings.ambient_radius(50.0), Some(2.0));
        assert_eq!([0.0, -1.0, f64::INFINITY, f64::NAN].map(|diagonal| settings.ambient_radius(diagonal)), [None; 4]);
        assert_eq!(Settings::default().ambient_radius(50.0), None);
    }

    #[test]
    fn the_folder_is_that_of_the_specification() {
        let at = |config: Option<&str>, home: Option<&str>| {
            folder(config.map(PathBuf::from), home.map(PathBuf::from)).map(|folder| path(&folder))
        };
        assert_eq!(at(Some("/c"), Some("/h")), Some(PathBuf::from("/c/selvedge/viewer.json")));
        assert_eq!(at(Some("relative"), Some("/h")), Some(PathBuf::from("/h/.config/selvedge/viewer.json")));
        assert_eq!(at(None, None), None);
    }
}
