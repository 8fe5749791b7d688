//! Lines over pixels that a surface covers in part, before a background that shows through.

use crate::edge_lines::{SIZE, lines};
use crate::edges::linear;
use crate::shapes;
use crate::support::{assert_silent, perspective};
use crate::watched::renderer;
use selvedge::picture::{EdgeSettings, FrameSettings, Outputs, SceneSettings, Smooth};

/// Colours are not multiplied by their opacities: with a line of opacity `o` over a pixel of colour `c` and opacity `a`,
/// the opacity is `b = o + a (1 - o)`, and the colour, in linear light, `(line o + c a (1 - o)) / b`. The line is black.
#[test]
fn a_line_hides_as_much_of_what_covers_a_pixel_in_part() {
    let model = shapes::cylinder();
    let camera = perspective(&model, SIZE);
    let mut renderer = renderer();
    let clear = FrameSettings { background: Some([0.0; 4]), ..FrameSettings::default() };
    let black = EdgeSettings { colour: [0.0, 0.0, 0.0, 1.0], silhouettes: true, ..lines() };
    let without = SceneSettings { smooth: Smooth::Borders, ..SceneSettings::default() };
    let [before, after] = [without, SceneSettings { edges: Some(black), ..without }].map(|settings| {
        renderer.upload_with(&model, settings).unwrap();
        renderer.render(&camera, &clear, Outputs::default()).unwrap()
    });
    assert_silent(renderer);
    let part = |c: u8| f64::from(c) / 255.0;
    let (mut compared, mut worst) = (0, 0.0f64);
    for (before, after) in before.colour.iter().zip(&after.colour) {
        let (a, b) = (part(before[3]), part(after[3]));
        let opacity = (b - a) / (1.0 - a);
        if !(0.2..0.7).contains(&a) || opacity < 0.3 {
            continue;
        }
        compared += 1;
        let expected = linear(*before).x * a * (1.0 - opacity) / b;
        worst = worst.max((linear(*after).x - expected).abs());
    }
    // opacities of eight bits leave the line's known to 0.013
    println!("{compared} pixels, worst {worst:.4}");
    assert!(compared > 50 && worst < 0.02, "{compared}, {worst}");
}
