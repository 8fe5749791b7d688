//! The colour of the selected parts as a text: keys set it here, the mouse in the tree.
//!
//! Red, green and blue are in sRGB, two hexadecimal digits each, as on the web: `#1e90ff`. Colours of the model are in
//! linear light; their opacity stays.

use super::Ui;
use crate::session::Session;
use egui::{Color32, Rgba};
use selvedge::model::Colour;

/// Width of the text, points.
const WIDTH: f32 = 72.0;

/// A colour as a text.
fn written([r, g, b, _]: Colour) -> String {
    let [r, g, b, _] = Color32::from(Rgba::from_rgb(r, g, b)).to_array();
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The red, green and blue of a text, which may lack its `#`, in linear light.
fn read(text: &str) -> Option<[f32; 3]> {
    let digits = text.trim().trim_start_matches('#');
    let colour = Color32::from_hex(&format!("#{digits}")).ok().filter(|colour| colour.is_opaque())?;
    let [r, g, b, _] = Rgba::from(colour).to_array();
    Some([r, g, b])
}

/// Shows it while parts are selected, or faces and edges of them.
pub fn show(panel: &mut egui::Ui, ui: &mut Ui, session: &mut Session) {
    let count = session.world.model.instances.len();
    let chosen: Vec<usize> = session.selected_instances().into_iter().filter(|item| *item < count).collect();
    let Some(first) = chosen.first() else {
        ui.colour = None;
        return;
    };
    let now = written(session.colour(*first));
    let mut text = ui.colour.clone().unwrap_or_else(|| now.clone());
    panel.horizontal(|row| {
        row.label("Colour");
        let field = row.add(egui::TextEdit::singleline(&mut text).desired_width(WIDTH));
        let field = field.on_hover_text("Red, green and blue as #rrggbb, of the selected parts");
        field.widget_info(|| super::field("Colour", &text));
        if field.changed() {
            ui.colour = Some(text);
        }
        if !field.lost_focus() {
            return;
        }
        let is_given_up = row.input(|input| input.key_pressed(egui::Key::Escape));
        let Some(typed) = ui.colour.take().filter(|typed| !is_given_up && *typed != now) else { return };
        let Some([r, g, b]) = read(&typed) else {
            ui.tell(format!("`{typed}` is no colour: six hexadecimal digits are, such as #1e90ff."));
            return;
        };
        let colours: Vec<(usize, Colour)> =
            chosen.iter().map(|item| (*item, [r, g, b, session.colour(*item)[3]])).collect();
        session.scene.change(|state| state.colours.extend(colours));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the curve of IEC 61966-2-1.
    #[test]
    fn a_text_is_a_colour_in_srgb_and_back() {
        let linear = |byte: f64| match byte / 255.0 {
            low if low <= 0.04045 => low / 12.92,
            high => ((high + 0.055) / 1.055).powf(2.4),
        };
        for (text, bytes) in [("#1e90ff", [30.0, 144.0, 255.0]), ("#000000", [0.0; 3]), ("#010a0b", [1.0, 10.0, 11.0])]
        {
            let [r, g, b] = read(text).expect("a colour");
            for (found, byte) in [r, g, b].into_iter().zip(bytes) {
                // egui's curve has its constants rounded
                assert!((f64::from(found) - linear(byte)).abs() < 1e-4, "{text}: {found}");
            }
            assert_eq!(written([r, g, b, 0.5]), text);
        }
        assert_eq!((read(" 1E90FF "), read("#fff")), (read("#1e90ff"), read("#ffffff")));
        assert_eq!(["", "#", "#12345", "#12345678", "blue", "#gg0000"].map(read), [None; 6]);
    }
}
