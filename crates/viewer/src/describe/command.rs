//! The line of `selvedge render` for a view.
//!
//! A test of the program draws such lines, and compares the pictures with the view.

use crate::session::{FilePart, SceneState, Session, World};
use crate::settings::{Lines, SUN, Settings};
use glam::DVec3;
use selvedge::model::{Camera, Colour, Projection, srgb};
use selvedge::picture::Style;

/// A word of a command line, quoted for a shell where it must be.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Degrees of an angle: those that have its bits as radians again, where one of the three nearest does.
fn degrees(angle: f64) -> f64 {
    let near = angle.to_degrees();
    let all = [near, near.next_up(), near.next_down()];
    all.into_iter().find(|degrees| degrees.to_radians() == angle).unwrap_or(near)
}

/// A colour in linear light as a style sheet has it: eight bits a part where these are exact, else shares.
fn css([r, g, b, a]: Colour) -> String {
    let light = [r, g, b];
    let digits = light.map(|c| (srgb::encoded(f64::from(c)) * 255.0).round() as u8);
    let decoded = digits.map(|c| srgb::decoded(f64::from(c) / 255.0) as f32);
    let opacity = f64::from(a) * 100.0;
    if decoded == light {
        let [r, g, b] = digits;
        return if a == 1.0 { format!("#{r:02x}{g:02x}{b:02x}") } else { format!("rgb({r} {g} {b} / {opacity}%)") };
    }
    let [r, g, b] = light.map(|c| srgb::encoded(f64::from(c)) * 100.0);
    format!("rgb({r}% {g}% {b}% / {opacity}%)")
}

/// Ascending numbers, those in a row as a range: `2,5-9`.
fn ranges(numbers: &[usize]) -> String {
    let rows = numbers.chunk_by(|a, b| a + 1 == *b).map(|row| match row {
        [one] => one.to_string(),
        _ => format!("{}-{}", row[0], row[row.len() - 1]),
    });
    rows.collect::<Vec<_>>().join(",")
}

/// The number of an item of the tree in its own file, from 1 on: instances first, solids behind them.
fn number(item: usize, file: &FilePart, world: &World) -> Option<usize> {
    let count = world.model.instances.len();
    match item.checked_sub(count) {
        None => file.instances.contains(&item).then(|| item - file.instances.start + 1),
        Some(solid) => file.solids.contains(&solid).then(|| file.instances.len() + solid - file.solids.start + 1),
    }
}

/// What the [`line`] does not draw as the window does.
pub fn left_out(session: &Session) -> Vec<String> {
    let state = session.scene.now();
    let mut all = Vec::new();
    match session.world.files.len() {
        0 | 1 => {}
        count => all.push(format!("{} of {count} open files", count - 1)),
    }
    if state.explosion != 0.0 {
        all.push("that parts are moved apart".to_owned());
    }
    if !state.edits.is_empty() {
        all.push(format!("edits of {} trim loops", state.edits.len()));
    }
    all
}

/// The line of `selvedge render` for this view, whose background is in linear light. It draws one file, the first of
/// several, as it is read: see [`left_out`].
pub fn line(session: &Session, camera: &Camera, settings: &Settings, (style, background): (Style, Colour)) -> String {
    let triple = |p: DVec3| p.to_array().map(|x| format!("{x}")).join(",");
    let (world, state) = (&*session.world, session.scene.now());
    let file = world.files.first();
    let path = file.map_or("FILE".into(), |file| file.path.to_string_lossy());
    let mut words = vec!["selvedge".to_owned(), "render".to_owned(), quoted(&path)];
    let mut push = |name: &str, value: String| words.push(format!("{name}={}", quoted(&value)));
    push("--output", "view.png".to_owned());
    push("--size", format!("{}x{}", camera.size.0, camera.size.1));
    push("--eye", triple(camera.eye));
    push("--target", triple(camera.target));
    push("--up", triple(camera.up));
    match camera.projection {
        Projection::Perspective { fov_y } => push("--fov", format!("{}", degrees(fov_y))),
        Projection::Orthographic { height } => push("--ortho", format!("{height}")),
        // no argument sets a calibrated camera, and the window never shows one
        Projection::Pinhole { .. } => {}
    }
    push("--near-far", format!("{},{}", camera.depth_range.0, camera.depth_range.1));
    push("--style", style.name().to_owned());
    if style.is_curvature() {
        push("--curvature-range", format!("{}", world.curvature_range()));
    }
    push("--background", css(background));
    if let Some(file) = file {
        parts(file, state, world, &mut push);
    }
    for section in state.sections.iter().filter(|s| s.on) {
        push("--section", format!("{},{}", triple(section.normal), section.offset));
    }
    let edges = match settings.lines {
        Lines::All => "all",
        Lines::Sharp => "sharp",
        Lines::None => "none",
    };
    push("--edges", edges.to_owned());
    push("--smooth", if settings.smooth { "borders" } else { "none" }.to_owned());
    let ambient = settings.ambient_radius(world.bounds.diagonal());
    push("--ao", ambient.map_or("none".to_owned(), |radius| format!("{radius}")));
    if settings.shadows {
        push("--sun", triple(SUN));
    }
    for (flag, on) in [("--silhouettes", settings.silhouettes), ("--hidden-lines", settings.hidden_lines)] {
        words.extend(on.then(|| flag.to_owned()));
    }
    words.join(" ")
}

/// The words for hidden items and for instances that have another colour or are seen through.
fn parts(file: &FilePart, state: &SceneState, world: &World, push: &mut impl FnMut(&str, String)) {
    let hidden: Vec<usize> = state.hidden.iter().filter_map(|item| number(*item, file, world)).collect();
    if !hidden.is_empty() {
        push("--hide", ranges(&hidden));
    }
    let painted = |i: &usize| !state.hidden.contains(i) && (state.colours.contains_key(i) || state.clear.contains(i));
    for instance in file.instances.clone().filter(painted) {
        let colour = state.instance(instance, world).colour;
        let number = number(instance, file, world);
        number
            .zip(colour)
            .into_iter()
            .for_each(|(number, colour)| push("--paint", format!("{number}={}", css(colour))));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Loaded;
    use std::path::Path;
    use std::sync::Arc;

    const BLACK: Colour = [0.0, 0.0, 0.0, 1.0];

    /// The program's own default is ambient occlusion, and a light that casts no shadows.
    #[test]
    fn the_command_names_the_light_of_the_window() {
        let bounds = selvedge::model::Bounds { min: DVec3::ZERO, max: DVec3::new(3.0, 0.0, 4.0) };
        let camera = Camera::around(bounds, DVec3::ONE, DVec3::Z, 0.6, (64, 48));
        let mut world = World::default();
        world.bounds = bounds;
        let session = Session { world: Arc::new(world), ..Session::default() };
        let of = |settings: &Settings| line(&session, &camera, settings, (Style::Shaded, BLACK));
        let plain = of(&Settings::default());
        assert!(plain.contains(" --ao=none") && !plain.contains("--sun"), "{plain}");
        assert!(plain.contains(" --background='#000000'"), "{plain}");
        let lit = of(&Settings { ambient: true, shadows: true, ..Settings::default() });
        assert!(lit.contains(" --ao=0.2") && lit.contains(" --sun=0.5,-0.7,1"), "{lit}");
    }

    /// Numbers are those of the first file, and what the line cannot say is said beside it.
    #[test]
    fn the_command_hides_and_paints_parts_of_the_first_file() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/assembly.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        let count = import.model.instances.len();
        let file = Arc::new(Loaded { path, import, partial: false });
        let mut session = Session { world: Arc::new(World::new(&[Arc::clone(&file), file])), ..Session::default() };
        let camera = Camera::around(session.world.bounds, DVec3::ONE, DVec3::Z, 0.6, (64, 48));
        session.scene.change(|state| {
            state.hidden.extend([1, 4, 5, 6, count + 2]);
            state.colours.extend([(0, [1.0, 0.0, 0.0, 1.0]), (4, BLACK), (count, BLACK)]);
            state.clear.insert(2);
            state.colours.insert(2, [0.0, 0.0, 1.0, 1.0]);
            state.explosion = 0.5;
        });
        let told = line(&session, &camera, &Settings::default(), (Style::Shaded, BLACK));
        assert!(told.contains(" --hide=2,5-7 "), "{told}");
        assert_eq!(told.matches("--paint=").count(), 2, "{told}");
        for paint in ["1=#ff0000", "3=rgb(0 0 255 / 25%)"] {
            assert!(told.contains(&format!(" --paint='{paint}' ")), "{told}");
        }
        assert_eq!(left_out(&session), ["1 of 2 open files", "that parts are moved apart"]);
        assert!(left_out(&Session::default()).is_empty());
    }

    #[test]
    fn words_of_a_shell_are_quoted() {
        assert_eq!([quoted("a/b.step"), quoted("a b"), quoted("it's")], ["a/b.step", "'a b'", r"'it'\''s'"]);
    }

    #[test]
    fn numbers_in_a_row_are_ranges() {
        assert_eq!([ranges(&[]), ranges(&[3]), ranges(&[1, 2, 3, 7, 9, 10])], ["", "3", "1-3,7,9-10"]);
    }

    /// Within a rounding; exactly for the window's own angle.
    #[test]
    fn angles_come_back_from_degrees() {
        for angle in [0.6, 35.0_f64.to_radians(), crate::navigation::FOV, 0.123_456_789] {
            assert!((degrees(angle).to_radians() - angle).abs() <= f64::EPSILON * angle, "{angle}");
        }
        assert_eq!(degrees(crate::navigation::FOV).to_radians(), crate::navigation::FOV);
    }
}
