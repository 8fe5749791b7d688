//! The desktop's wish for less motion, and whether it is dark.
//!
//! | desktop | less motion | dark or light |
//! |---|---|---|
//! | with GSettings, as GNOME: `org.gnome.desktop.interface` | `enable-animations` is false | `color-scheme` prefers one |
//! | Plasma: `kdeglobals` | `AnimationDurationFactor` is 0 | `ColorScheme` has a name with "dark", or another |
//! | with a `settings.ini` of GTK, as Xfce | `gtk-enable-animations` is off | `gtk-application-prefer-dark-theme` |

use std::path::Path;
use std::process::{Command, Stdio};

/// Group and key of the colours in `kdeglobals`, and in the files of GTK.
const PLASMA: (&str, &str) = ("General", "ColorScheme");
const GTK: (&str, &str) = ("Settings", "gtk-application-prefer-dark-theme");
/// Files in the folder of the user's settings, with the group and the key that is off for less motion.
const FILES: [(&str, &str, &str); 3] = [
    ("gtk-4.0/settings.ini", "Settings", "gtk-enable-animations"),
    ("gtk-3.0/settings.ini", "Settings", "gtk-enable-animations"),
    ("kdeglobals", "KDE", "AnimationDurationFactor"),
];

/// Whether the desktop's settings ask for less motion. `folder` is that of the user's settings. It waits for a program,
/// where that is installed.
pub fn reduces_motion(folder: &Path) -> bool {
    in_files(folder) || gsettings("enable-animations").as_deref() == Some("false")
}

/// Whether the desktop is dark, and not light; `None` where its settings do not say. `folder` is that of the user's
/// settings. It waits for a program, where that is installed.
pub fn is_dark(folder: &Path) -> Option<bool> {
    let preferred = match gsettings("color-scheme").as_deref() {
        Some("'prefer-dark'") => Some(true),
        Some("'prefer-light'") => Some(false),
        _ => None,
    };
    preferred.or_else(|| is_dark_in_files(folder))
}

fn is_dark_in_files(folder: &Path) -> Option<bool> {
    let text = |file: &str| std::fs::read_to_string(folder.join(file)).unwrap_or_default();
    let plasma = text("kdeglobals");
    if let Some(name) = value(&plasma, PLASMA.0, PLASMA.1) {
        return Some(name.to_lowercase().contains("dark"));
    }
    ["gtk-4.0/settings.ini", "gtk-3.0/settings.ini"].into_iter().find_map(|file| {
        let text = text(file);
        value(&text, GTK.0, GTK.1).map(|value| !is_off(value))
    })
}

fn in_files(folder: &Path) -> bool {
    FILES.iter().any(|(file, group, key)| {
        // a missing file has no setting
        let text = std::fs::read_to_string(folder.join(file)).unwrap_or_default();
        value(&text, group, key).is_some_and(is_off)
    })
}

/// What GSettings says of a key of the desktop's interface; `None` where it is not installed or does not know the key.
fn gsettings(key: &str) -> Option<String> {
    let words = ["get", "org.gnome.desktop.interface", key];
    let answer = Command::new("gsettings").args(words).stdin(Stdio::null()).stderr(Stdio::null()).output();
    let answer = answer.ok().filter(|answer| answer.status.success())?;
    Some(String::from_utf8_lossy(&answer.stdout).trim().to_owned())
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

    #[test]
    fn each_desktop_s_file_says_whether_it_is_dark() {
        let prefers = |value: &str| format!("[Settings]\ngtk-application-prefer-dark-theme={value}\n");
        let cases = [
            ("kdeglobals", "[General]\nColorScheme=BreezeDark\n".to_owned(), Some(true)),
            ("kdeglobals", "[General]\nColorScheme=BreezeLight\n".to_owned(), Some(false)),
            ("kdeglobals", "[KDE]\nColorScheme=BreezeLight\n".to_owned(), None),
            ("gtk-4.0/settings.ini", prefers("1"), Some(true)),
            ("gtk-3.0/settings.ini", prefers("true"), Some(true)),
            ("gtk-3.0/settings.ini", prefers("0"), Some(false)),
            ("gtk-3.0/settings.ini", "[Settings]\n".to_owned(), None),
        ];
        for (file, text, wanted) in cases {
            let folder = tempfile::tempdir().expect("a folder");
            assert_eq!(is_dark_in_files(folder.path()), None, "no file yet");
            let path = folder.path().join(file);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            std::fs::write(path, &text).expect("written");
            assert_eq!(is_dark_in_files(folder.path()), wanted, "{file}: {text}");
        }
    }
}
