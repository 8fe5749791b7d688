//! Mouse buttons and keys to moves, in the styles of other programs.
//!
//! | style | rotate | pan | zoom |
//! |---|---|---|---|
//! | SolidWorks | M | Ctrl+M | wheel, Shift+M |
//! | Creo | M | Shift+M | wheel, Ctrl+M |
//! | Onshape | R | M, Ctrl+R | wheel |
//! | CATIA | M+L or M+R | M | hold M, click L or R, drag |
//! | Blender, FreeCAD | M; FreeCAD M+L | Shift+M; FreeCAD M | wheel, Ctrl+M |
//! | F3D | L | M, Shift+L | wheel |
//! | trackpad | L, Shift + two fingers | two fingers, M, Shift+L | pinch, Ctrl + two fingers, wheel |
//!
//! L, M, R are the buttons. With the other styles two fingers are a wheel; a pinch zooms with every style. A left
//! button that goes down and up in one place selects, whatever the style.

use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Pixels that two fingers move on a trackpad for one line of a wheel.
pub const LINE_PX: f64 = 40.0;

/// A program's style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)]
pub enum Preset {
    SolidWorks,
    Creo,
    #[default]
    Onshape,
    Catia,
    Blender,
    FreeCad,
    F3d,
    Trackpad,
}

/// The effect of a drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Turn about the point under the cursor.
    Orbit,
    /// Move with the cursor.
    Pan,
    /// Closer and farther.
    Zoom,
}

/// A scroll as the system reports it: right and down, as what is scrolled would move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scroll {
    /// Lines: a wheel. X11 reports two fingers so, too.
    Lines(DVec2),
    /// Pixels: two fingers on a trackpad.
    Pixels(DVec2),
}

/// The effect of a scroll.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scrolled {
    /// Turn as by a drag of so many pixels.
    Orbit(DVec2),
    /// Move by so many pixels.
    Pan(DVec2),
    /// Come closer by so many lines of a wheel.
    Zoom(f64),
}

/// A mouse button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Button {
    Left,
    Middle,
    Right,
}

/// The buttons and keys that are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Held {
    /// Left, middle and right button.
    pub buttons: [bool; 3],
    /// The control key.
    pub ctrl: bool,
    /// The shift key.
    pub shift: bool,
    /// A left or right button came up while the middle one was down: CATIA's zoom.
    tapped: bool,
}

impl Preset {
    /// All of them, as menus list them.
    pub const ALL: [Self; 8] = [
        Self::SolidWorks,
        Self::Creo,
        Self::Onshape,
        Self::Catia,
        Self::Blender,
        Self::FreeCad,
        Self::F3d,
        Self::Trackpad,
    ];

    /// As menus name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::SolidWorks => "SolidWorks",
            Self::Creo => "Creo",
            Self::Onshape => "Onshape",
            Self::Catia => "CATIA",
            Self::Blender => "Blender",
            Self::FreeCad => "FreeCAD",
            Self::F3d => "F3D",
            Self::Trackpad => "Trackpad",
        }
    }

    /// How a user rotates, pans and zooms, for the help.
    pub fn hints(self) -> [&'static str; 3] {
        match self {
            Self::SolidWorks => ["middle", "Ctrl + middle", "wheel, Shift + middle"],
            Self::Creo => ["middle", "Shift + middle", "wheel, Ctrl + middle"],
            Self::Onshape => ["right", "middle, Ctrl + right", "wheel"],
            Self::Catia => ["middle + left, middle + right", "middle", "wheel, hold middle and click left, drag"],
            Self::Blender => ["middle", "Shift + middle", "wheel, Ctrl + middle"],
            Self::FreeCad => ["middle + left, middle + right", "middle", "wheel"],
            Self::F3d => ["left", "middle, Shift + left", "wheel"],
            Self::Trackpad => {
                ["left, Shift + two fingers", "two fingers, middle, Shift + left", "pinch, Ctrl + two fingers, wheel"]
            }
        }
    }

    /// The effect of a drag while these are held.
    pub fn action(self, held: Held) -> Option<Action> {
        use Action::{Orbit, Pan, Zoom};
        let [left, middle, right] = held.buttons;
        let alone = |button: Button| held.buttons == [Button::Left, Button::Middle, Button::Right].map(|b| b == button);
        let (l, m, r) = (alone(Button::Left), alone(Button::Middle), alone(Button::Right));
        match self {
            Self::SolidWorks if m => Some(if held.ctrl {
                Pan
            } else if held.shift {
                Zoom
            } else {
                Orbit
            }),
            Self::Creo | Self::Blender if m => Some(if held.shift {
                Pan
            } else if held.ctrl {
                Zoom
            } else {
                Orbit
            }),
            Self::Onshape if m || r && held.ctrl => Some(Pan),
            Self::Onshape if r => Some(Orbit),
            Self::Catia | Self::FreeCad if middle && (left || right) => Some(Orbit),
            Self::Catia if m && held.tapped => Some(Zoom),
            Self::Catia | Self::FreeCad if m => Some(Pan),
            Self::F3d | Self::Trackpad if m || l && held.shift => Some(Pan),
            Self::F3d | Self::Trackpad if l => Some(Orbit),
            _ => None,
        }
    }

    /// The effect of a scroll while these are held. A wheel turns by whole lines up or down; anything else is two
    /// fingers.
    pub fn scroll(self, scroll: Scroll, held: Held) -> Scrolled {
        let (by_fingers, pixels) = match scroll {
            Scroll::Lines(lines) => (lines.x != 0.0 || lines.y.fract() != 0.0, lines * LINE_PX),
            Scroll::Pixels(pixels) => (true, pixels),
        };
        match self {
            Self::Trackpad if by_fingers && held.shift => Scrolled::Orbit(pixels),
            Self::Trackpad if by_fingers && !held.ctrl => Scrolled::Pan(pixels),
            _ => Scrolled::Zoom(pixels.y / LINE_PX),
        }
    }
}

impl Held {
    /// A button went down or came up.
    pub fn button(&mut self, button: Button, down: bool) {
        self.buttons[button as usize] = down;
        let middle = self.buttons[Button::Middle as usize];
        self.tapped = middle && (self.tapped || !down);
    }

    /// Whether any button is down.
    pub fn any(self) -> bool {
        self.buttons.contains(&true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Buttons in the order in which they go down, `^` for control, `+` for shift; a small letter comes up again.
    fn held(keys: &str) -> Held {
        let mut held = Held::default();
        for key in keys.chars() {
            match key {
                '^' => held.ctrl = true,
                '+' => held.shift = true,
                'L' | 'l' => held.button(Button::Left, key == 'L'),
                'M' | 'm' => held.button(Button::Middle, key == 'M'),
                'R' | 'r' => held.button(Button::Right, key == 'R'),
                _ => unreachable!("{key}"),
            }
        }
        held
    }

    /// The table above, and combinations outside of it.
    #[test]
    fn each_style_moves_as_its_users_know() {
        use Action::{Orbit, Pan, Zoom};
        let table = [
            (Preset::SolidWorks, [("M", Some(Orbit)), ("^M", Some(Pan)), ("+M", Some(Zoom)), ("L", None), ("R", None)]),
            (Preset::Creo, [("M", Some(Orbit)), ("+M", Some(Pan)), ("^M", Some(Zoom)), ("L", None), ("ML", None)]),
            (Preset::Onshape, [("R", Some(Orbit)), ("M", Some(Pan)), ("^R", Some(Pan)), ("L", None), ("LR", None)]),
            (
                Preset::Catia,
                [("ML", Some(Orbit)), ("MR", Some(Orbit)), ("M", Some(Pan)), ("MLl", Some(Zoom)), ("L", None)],
            ),
            (Preset::Blender, [("M", Some(Orbit)), ("+M", Some(Pan)), ("^M", Some(Zoom)), ("L", None), ("R", None)]),
            (
                Preset::FreeCad,
                [("ML", Some(Orbit)), ("MR", Some(Orbit)), ("M", Some(Pan)), ("MLl", Some(Pan)), ("L", None)],
            ),
            (Preset::F3d, [("L", Some(Orbit)), ("M", Some(Pan)), ("+L", Some(Pan)), ("R", None), ("", None)]),
            (Preset::Trackpad, [("L", Some(Orbit)), ("M", Some(Pan)), ("+L", Some(Pan)), ("R", None), ("", None)]),
        ];
        assert_eq!(table.map(|(preset, _)| preset), Preset::ALL);
        for (preset, moves) in table {
            for (keys, action) in moves {
                assert_eq!(preset.action(held(keys)), action, "{preset:?} {keys}");
            }
        }
    }

    #[test]
    fn two_fingers_move_and_turn_with_the_trackpad_s_style_alone() {
        let by = DVec2::new(12.0, -20.0);
        let fingers = [Scroll::Pixels(by), Scroll::Lines(by / LINE_PX)];
        let wheel = Scroll::Lines(DVec2::new(0.0, -2.0));
        for preset in Preset::ALL {
            assert_eq!(preset.scroll(wheel, held("")), Scrolled::Zoom(-2.0), "{preset:?}");
            assert_eq!(preset.scroll(wheel, held("+")), Scrolled::Zoom(-2.0), "{preset:?}");
            let is_trackpad = preset == Preset::Trackpad;
            for scroll in fingers {
                let zoom = Scrolled::Zoom(-0.5);
                let [plain, shift, ctrl] = ["", "+", "^"].map(|keys| preset.scroll(scroll, held(keys)));
                let wanted = if is_trackpad { [Scrolled::Pan(by), Scrolled::Orbit(by), zoom] } else { [zoom; 3] };
                assert_eq!([plain, shift, ctrl], wanted, "{preset:?} {scroll:?}");
            }
        }
    }

    #[test]
    fn a_tap_ends_with_the_middle_button() {
        assert_eq!(Preset::Catia.action(held("MLlmM")), Some(Action::Pan));
        assert_eq!(Preset::Catia.action(held("MRr")), Some(Action::Zoom), "the right button taps, too");
        assert!(!held("MLlm").any());
    }
}
