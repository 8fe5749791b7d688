//! The table of the host's images in docs/embedding.md, against the engine's formats and the accesses of its barriers.

use super::{Aovs, TARGETS, Targets};
use crate::frame::shading::numbers::NUMBER_FORMAT;
use crate::frame::shading::resolve::AOV_FORMATS;
use crate::frame::transparency::solid_layers::THICKNESS_FORMAT;
use crate::frame::viewport::drawn;
use crate::gpu::{Access, Image, ImageAccess};
use ash::vk;
use vk::{AccessFlags2 as A, PipelineStageFlags2 as S};

fn page() -> String {
    std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/embedding.md")).unwrap()
}

/// An image of each field of [`Targets`], named after it as in the page. No device makes them: nothing is drawn.
fn images() -> [Image; TARGETS] {
    let [depth, face, uv, normal] = AOV_FORMATS;
    let formats = [
        ("colour", vk::Format::R8G8B8A8_SRGB),
        ("depth", vk::Format::D32_SFLOAT),
        ("thickness", THICKNESS_FORMAT),
        ("aovs.depth", depth),
        ("aovs.face", face),
        ("aovs.uv", uv),
        ("aovs.normal", normal),
        ("aovs.edge", NUMBER_FORMAT),
        ("aovs.part", NUMBER_FORMAT),
        ("aovs.instance", NUMBER_FORMAT),
    ];
    // SAFETY: no call of Vulkan gets the handles.
    formats.map(|(name, format)| unsafe {
        Image::borrowed(name, vk::Image::null(), vk::ImageView::null(), (1, 1), format)
    })
}

/// The cells of each row: image, field, format, layout, access.
fn rows(page: &str) -> Vec<Vec<String>> {
    let section = page.split("\n## Targets\n").nth(1).expect("a section on targets");
    let table = section.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    let cell = |text: &str| text.trim().trim_matches('`').to_owned();
    table.skip(2).map(|line| line.trim_matches('|').split('|').map(cell).collect()).collect()
}

/// What the table says of each image and the engine does otherwise.
fn faults(page: &str) -> Vec<String> {
    let images = images();
    let [_, depth, thickness, aov_depth, face, uv, normal, edge, part, instance] = images.each_ref().map(Some);
    let aovs = Aovs { depth: aov_depth, face, uv, normal, edge, part, instance };
    let targets = Targets { colour: &images[0], depth, aovs, thickness, corner: None };
    assert_eq!(targets.all().map(|image| image.map(Image::name)), images.each_ref().map(|image| Some(image.name())));
    let rows = rows(page);
    let mut wrong = Vec::new();
    for image in targets.all().into_iter().flatten() {
        let name = image.name();
        let own: Vec<_> = rows.iter().filter(|row| row.get(1).is_some_and(|field| field == name)).collect();
        let [row] = own[..] else {
            wrong.push(format!("{name}: not one row"));
            continue;
        };
        let access = drawn(image);
        let named = if access == Access::DEPTH_WRITE { "Access::DEPTH_WRITE" } else { "Access::COLOUR_WRITE" };
        // the host chooses the formats of these two
        let format = match name {
            "colour" => "TargetFormats::colour".to_owned(),
            "depth" => "TargetFormats::depth".to_owned(),
            _ => format!("{:?}", image.format()),
        };
        let layout = format!("{:?}", ImageAccess::from(access).layout);
        let wanted = [format.as_str(), layout.as_str(), named];
        let told: Vec<_> = row[2..].iter().map(String::as_str).collect();
        if told != wanted {
            wrong.push(format!("{name}: {wanted:?}, and the page has {told:?}"));
        }
    }
    if rows.len() != TARGETS {
        wrong.push(format!("{} rows, and {TARGETS} images", rows.len()));
    }
    wrong
}

#[test]
fn the_page_has_each_target_as_it_is_drawn() {
    assert_eq!(faults(&page()), [""; 0]);
}

/// The stages and accesses behind the names of the table, as the text below it has them.
#[test]
fn the_page_says_what_the_accesses_are() {
    let text = page().split_whitespace().collect::<Vec<_>>().join(" ");
    let told = "`Access::COLOUR_WRITE` is the stage `COLOR_ATTACHMENT_OUTPUT` with attachment reads and writes, \
                `Access::DEPTH_WRITE` both fragment test stages with theirs.";
    assert!(text.contains(told), "the sentence is not there: {told}");
    let colour = Access::new(S::COLOR_ATTACHMENT_OUTPUT, A::COLOR_ATTACHMENT_READ | A::COLOR_ATTACHMENT_WRITE);
    let tests = S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS;
    let depth = Access::new(tests, A::DEPTH_STENCIL_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE);
    assert_eq!((Access::COLOUR_WRITE, Access::DEPTH_WRITE), (colour, depth));
}

#[test]
fn a_wrong_row_is_seen() {
    let page = page();
    for (from, to) in [
        ("`DEPTH_STENCIL_ATTACHMENT_OPTIMAL` |", "`GENERAL` |"),
        ("`Access::DEPTH_WRITE` |", "`Access::COLOUR_WRITE` |"),
        ("`R32G32_SFLOAT`", "`R32_SFLOAT`"),
        ("`aovs.part`", "`aovs.parts`"),
        ("| `aovs.depth` | `R32_SFLOAT` |", "| `aovs.depth` | `R32_UINT` |"),
    ] {
        assert!(page.contains(from), "{from}");
        assert_eq!(faults(&page.replacen(from, to, 1)).len(), 1, "{from}");
    }
}
