//! The commands of the window, and their keys.

use crate::navigation::standard::StandardView;
use egui::{Key, Modifiers};
use glam::DVec3;
use std::path::PathBuf;

/// One command; panels and keys collect them, the window carries them out.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Show the dialog of files.
    OpenDialog,
    /// Open a file beside the others.
    Open(PathBuf),
    /// Close a file, by its place among the open ones.
    Close(usize),
    /// Read all open files again.
    Reload,
    /// Stop reading files.
    Cancel,
    /// The whole model in the picture.
    Fit,
    /// The selection in the picture.
    FitSelection,
    /// From a standard direction.
    Standard(StandardView),
    /// From a direction of the view cube.
    LookFrom(DVec3),
    /// Switch between perspective and parallel.
    Projection,
    /// The previous view.
    Previous,
    /// Turn by pixels, right and down.
    Turn(f64, f64),
    /// Move the picture by pixels, right and down.
    Shift(f64, f64),
    /// Come closer by so many notches of the wheel; below 0 go farther.
    Zoom(f64),
    /// Undo the last change of the scene.
    Undo,
    /// Do it again.
    Redo,
    /// Clear selection and measurement; close help and dialogs.
    Clear,
    /// Select the next item of the kind that clicks select.
    Next {
        /// The one before it.
        back: bool,
        /// What is selected stays so.
        add: bool,
    },
    /// Take colours away that the selection was given here.
    OwnColours,
    /// Hide the selection.
    Hide,
    /// Hide everything else.
    Isolate,
    /// Show everything.
    ShowAll,
    /// Cut the model open at the selected face.
    Cut,
    /// Make the selection transparent, or opaque again.
    SeeThrough,
    /// Open the dialog for writing the picture, or close it.
    Screenshot,
    /// Write the picture to its file.
    WritePicture,
    /// Start dragging trim loops, or stop.
    Trims,
    /// Open the dialog for saving the model, or close it.
    SaveAs,
    /// Save the model to its file.
    Save,
    /// Check the view against exact rays.
    Check,
    /// The picture that would be written, to the clipboard.
    CopyPicture,
    /// The line of `selvedge render` for this view, to the clipboard.
    CopyCommand,
    /// A text to the clipboard.
    CopyText(String),
    /// Start picking points to measure between, or stop.
    Points,
    /// Keep the measurement of the selection in the list.
    Measure,
    /// Show the help, or hide it.
    Help,
    /// Close the window.
    Quit,
}

/// A key and its command.
#[derive(Clone, Debug)]
pub struct Shortcut {
    /// The key.
    pub key: Key,
    /// Modifiers held with it.
    pub modifiers: Modifiers,
    /// Its command.
    pub command: Command,
    /// In words, for the help.
    pub what: &'static str,
}

const NONE: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const SHIFT: Modifiers = Modifiers::SHIFT;
const ARROWS: [Key; 4] = [Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown];
/// One press of an arrow key, pixels: it turns by 15 degrees at a picture 600 pixels high.
const TURN_PX: f64 = 50.0;

/// All keys, in the order of the help.
pub fn shortcuts() -> Vec<Shortcut> {
    use StandardView::{Back, Bottom, Front, Iso, Left, Right, Top};
    let list = [
        (Key::O, CTRL, Command::OpenDialog, "open files"),
        (Key::R, CTRL, Command::Reload, "read open files again"),
        (Key::Home, NONE, Command::Fit, "all in view"),
        (Key::F, NONE, Command::FitSelection, "selection in view"),
        (Key::Num1, NONE, Command::Standard(Front), "front"),
        (Key::Num1, CTRL, Command::Standard(Back), "back"),
        (Key::Num3, NONE, Command::Standard(Right), "right"),
        (Key::Num3, CTRL, Command::Standard(Left), "left"),
        (Key::Num7, NONE, Command::Standard(Top), "top"),
        (Key::Num7, CTRL, Command::Standard(Bottom), "bottom"),
        (Key::Num9, NONE, Command::Standard(Iso), "iso"),
        (Key::Num5, NONE, Command::Projection, "perspective or parallel"),
        (Key::Backspace, NONE, Command::Previous, "previous view"),
        (Key::ArrowLeft, NONE, Command::Turn(-TURN_PX, 0.0), "turn left"),
        (Key::ArrowRight, NONE, Command::Turn(TURN_PX, 0.0), "turn right"),
        (Key::ArrowUp, NONE, Command::Turn(0.0, -TURN_PX), "turn up"),
        (Key::ArrowDown, NONE, Command::Turn(0.0, TURN_PX), "turn down"),
        (Key::ArrowLeft, SHIFT, Command::Shift(-TURN_PX, 0.0), "move left"),
        (Key::ArrowRight, SHIFT, Command::Shift(TURN_PX, 0.0), "move right"),
        (Key::ArrowUp, SHIFT, Command::Shift(0.0, -TURN_PX), "move up"),
        (Key::ArrowDown, SHIFT, Command::Shift(0.0, TURN_PX), "move down"),
        (Key::Plus, NONE, Command::Zoom(1.0), "closer"),
        (Key::Equals, NONE, Command::Zoom(1.0), "closer, too"),
        (Key::Minus, NONE, Command::Zoom(-1.0), "farther"),
        (Key::N, NONE, Command::Next { back: false, add: false }, "select the next face, or what is picked"),
        (Key::N, SHIFT, Command::Next { back: true, add: false }, "select the one before"),
        (Key::N, CTRL, Command::Next { back: false, add: true }, "select the next one, too"),
        (Key::H, NONE, Command::Hide, "hide selection"),
        (Key::I, NONE, Command::Isolate, "hide everything else"),
        (Key::A, NONE, Command::ShowAll, "show everything"),
        (Key::C, NONE, Command::Cut, "cut at the selected face"),
        (Key::X, NONE, Command::SeeThrough, "see through selection"),
        (Key::U, NONE, Command::OwnColours, "selection in its own colours"),
        (Key::P, NONE, Command::Points, "measure between points"),
        (Key::M, NONE, Command::Measure, "keep the measurement"),
        (Key::Z, CTRL, Command::Undo, "undo"),
        (Key::Z, CTRL.plus(SHIFT), Command::Redo, "redo"),
        (Key::T, NONE, Command::Trims, "drag a trim loop of the selected face"),
        (Key::E, CTRL, Command::SaveAs, "save the model"),
        (Key::S, CTRL, Command::Screenshot, "write the picture to a file"),
        (Key::S, CTRL.plus(SHIFT), Command::WritePicture, "write it there at once"),
        (Key::K, NONE, Command::Check, "check this view against exact rays"),
        (Key::C, CTRL.plus(SHIFT), Command::CopyCommand, "copy the command of this view"),
        (Key::P, CTRL.plus(SHIFT), Command::CopyPicture, "copy the picture"),
        (Key::Escape, NONE, Command::Clear, "select nothing"),
        (Key::Questionmark, NONE, Command::Help, "help"),
        (Key::Q, CTRL, Command::Quit, "close"),
    ];
    list.map(|(key, modifiers, command, what)| Shortcut { key, modifiers, command, what }).to_vec()
}

impl Shortcut {
    /// The key as the help shows it.
    pub fn label(&self) -> String {
        let mut label = String::new();
        for (held, name) in [(self.modifiers.command, "Ctrl + "), (self.modifiers.shift, "Shift + ")] {
            if held {
                label.push_str(name);
            }
        }
        label + self.key.symbol_or_name()
    }

    /// Whether its key went down with exactly its modifiers held; a question mark and a plus need shift on some
    /// keyboards.
    fn is_pressed(&self, input: &egui::InputState) -> bool {
        let exact = |held: Modifiers| {
            held.command == self.modifiers.command
                && !held.alt
                && (held.shift == self.modifiers.shift || matches!(self.key, Key::Questionmark | Key::Plus))
        };
        input.events.iter().any(|event| match event {
            egui::Event::Key { key, pressed: true, modifiers, .. } => *key == self.key && exact(*modifiers),
            _ => false,
        })
    }
}

/// Commands of the keys that went down; none while a text is typed. While a button, a slider or a handle has the keys,
/// arrows move it, or lead to the next one.
pub fn pressed(ctx: &egui::Context) -> Vec<Command> {
    let focused = ctx.memory(|memory| memory.focused());
    if focused.is_some_and(|id| egui::TextEdit::load_state(ctx, id).is_some()) {
        return Vec::new();
    }
    let is_free = |shortcut: &Shortcut| focused.is_none() || !ARROWS.contains(&shortcut.key);
    ctx.input(|input| {
        let pressed = shortcuts().into_iter().filter(|shortcut| is_free(shortcut) && shortcut.is_pressed(input));
        pressed.map(|shortcut| shortcut.command).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(key: Key, modifiers: Modifiers) -> Vec<Command> {
        let ctx = egui::Context::default();
        let event = egui::Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
        let input = egui::RawInput { events: vec![event], modifiers, ..Default::default() };
        let mut commands = Vec::new();
        let _ = ctx.run(input, |ctx| commands = pressed(ctx));
        commands
    }

    #[test]
    fn no_two_keys_are_one_and_each_does_what_it_says() {
        let all = shortcuts();
        for (i, shortcut) in all.iter().enumerate() {
            let twin = all[..i].iter().find(|s| s.key == shortcut.key && s.modifiers == shortcut.modifiers);
            assert!(twin.is_none(), "{} twice", shortcut.label());
            let mut held = shortcut.modifiers;
            held.ctrl = held.command;
            assert_eq!(after(shortcut.key, held), std::slice::from_ref(&shortcut.command));
        }
        assert_eq!(after(Key::Questionmark, SHIFT), [Command::Help]);
        assert_eq!(after(Key::H, Modifiers::ALT), []);
        assert_eq!(after(Key::Plus, SHIFT), [Command::Zoom(1.0)]);
    }

    #[test]
    fn keys_are_commands_beside_a_button_but_not_in_a_text() {
        let ctx = egui::Context::default();
        let mut text = String::new();
        // a button or a text field takes the keys, and a key goes down
        let mut after = |focus: Option<usize>, key: Option<Key>| {
            let press =
                |key| egui::Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers: NONE };
            let events = key.map(press).into_iter().collect();
            let mut commands = Vec::new();
            let _ = ctx.run(egui::RawInput { events, ..Default::default() }, |ctx| {
                commands.extend(pressed(ctx));
                egui::CentralPanel::default().show(ctx, |ui| {
                    let both = [ui.button("beside"), ui.text_edit_singleline(&mut text)];
                    focus.into_iter().for_each(|nth| both[nth].request_focus());
                });
            });
            commands
        };
        assert_eq!(after(None, Some(Key::ArrowLeft)), [Command::Turn(-TURN_PX, 0.0)]);
        after(Some(0), None);
        assert_eq!(after(None, Some(Key::H)), [Command::Hide]);
        assert_eq!(after(None, Some(Key::ArrowLeft)), []);
        after(Some(1), None);
        assert_eq!(after(None, Some(Key::H)), []);
        assert_eq!(after(None, Some(Key::Escape)), [Command::Clear], "it leaves the text, and closes the dialog");
    }
}
