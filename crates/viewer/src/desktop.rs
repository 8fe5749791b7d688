//! The desktop's wish for less motion.
//!
//! | desktop | how it says so |
//! |---|---|
//! | with a `settings.ini` of GTK, as Xfce and Plasma write it | `gtk-enable-animations` is off |
//! | Plasma | `AnimationDurationFactor` in `kdeglobals` is 0 |
//! | with GSettings, as GNOME | `gsettings get org.gnome.desktop.interface enable-animations` says false |

use std::path::Path;
use std::process::{Command, Stdio};

/// Files in the folder of the user's settings, with the group and the key that is off for less motion.
const FILES: [(&str, &str, &str); 3] = [
    ("gtk-4.0/settings.ini", "Settings", "gtk-enable-animations"),
    ("gtk-3.0/settings.ini", "Settings", "gtk-enable-animations"),
    ("kdeglobals", "KDE", "AnimationDurationFactor"),
];

/// Whether the desktop's settings ask for less motion. `folder` is that of the user's settings. It waits for a program,
/// where that is installed.
pub fn reduces_motion(folder: &Path) -> bool {
    in_files(folder) || in_gsettings()
}

fn in_files(folder: &Path) -> bool {
    FILES.iter().any(|(file, group, key)| {
        // a missing file has no setting
        let text = std::fs::read_to_string(folder.join(file)).unwrap_or_default();
        value(&text, group, key).is_some_and(is_off)
    })
}

fn in_gsettings() -> bool {
    let words = ["get", "org.gnome.desktop.interface", "enable-animations"];
    let answer = Command::new("gsettings").args(words).stdin(Stdio::null()).stderr(Stdio::null()).output();
    answer.is_ok_and(|answer| answer.status.success() && answer.stdout.trim_ascii() == b"false")
}

/// The last value of a key in a group of a file of settings.
fn value<'a>(text: &'a str, group: &str, key: &str) -> Option<&'a str> {
    let (mut is_inside, mut found) = (false, None);
    for line in text.lines().map(str::trim) {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            is_inside = name == group;
        } else if let Some((name, value)) = line.split_once('=').filter(|_| is_inside)
            && name.trim_end() == key
        {
            found = Some(value.trim_start());
        }
    }
    found
}

fn is_off(value: &str) -> bool {
    value.eq_ignore_ascii_case("false") || value.parse::<f64>() == Ok(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_desktop_s_file_asks_for_less_motion() {
        let cases = [
            ("gtk-4.0/settings.ini", "[Settings]\ngtk-enable-animations=0\n", true),
            ("gtk-3.0/settings.ini", "[Settings]\ngtk-enable-animations = false\n", true),
            ("gtk-3.0/settings.ini", "[Settings]\ngtk-enable-animations=true\n", false),
            ("gtk-3.0/settings.ini", "[Other]\ngtk-enable-animations=0\n", false),
            ("kdeglobals", "[General]\nx=1\n\n[KDE]\nAnimationDurationFactor=0.0\n[X]\ny=0", true),
            ("kdeglobals", "[KDE]\n#AnimationDurationFactor=0\nAnimationDurationFactor=0.5\n", false),
            ("kdeglobals", "damaged", false),
        ];
        for (file, text, wanted) in cases {
            let folder = tempfile::tempdir().expect("a folder");
            assert!(!in_files(folder.path()), "no file yet");
            let path = folder.path().join(file);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            std::fs::write(path, text).expect("written");
            assert_eq!(in_files(folder.path()), wanted, "{file}: {text}");
        }
    }
}
