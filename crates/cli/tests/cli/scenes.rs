//! Scenes through every command: the only models here that draw as their files say.

use super::{pixel, refused, selvedge, text};

/// A ball and a trimmed sheet, small enough to be drawn in a test.
pub const SCENE: &str = r##"
selvedge = 1
name = "small"

[curve.ring]
shape = "circle"
radius = 3

[surface.sheet]
shape = "plane"
u = [-8, 8]
v = [-6, 6]
border = true
loops = ["ring"]
colour = "#4f7fa8"

[solid.ball]
shape = "sphere"
radius = 2

[camera.front]
eye = [0, -30, 30]
target = [0, 0, 0]

[camera.top]
from = [0, 0, 1]
up = [0, 1, 0]
ortho = true

[picture]
size = [48, 36]
camera = "front"
background = "#102030"
"##;

/// The ball goes behind the plane y = 0, and shows a cap towards the eye; the sheet is cut open. Then a quarter of
/// the same within a block of another file.
#[test]
fn a_model_is_cut_open() {
    let folder = std::env::temp_dir().join(format!("selvedge-cut-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let (scene, by, picture) = (path("small.toml"), path("by.csg"), path("a.png"));
    std::fs::write(&scene, SCENE).unwrap();
    std::fs::write(
        &by,
        "multmatrix([[1,0,0,-9],[0,1,0,0],[0,0,1,-9],[0,0,0,1]]) { cube(size = [18, 9, 18], center = false); }\n",
    )
    .unwrap();
    for cut in [["--section", "0,-1,0,0"], ["--trim-by", &by]] {
        let draw = [&["render", &scene, "-o", &picture][..], &cut].concat();
        let output = selvedge(&draw);
        assert_eq!(output.status.code(), Some(0), "{cut:?}: {}", text(&output.stderr));
        // the sheet before the plane is gone, behind it it is there
        let background = [0x10, 0x20, 0x30, 255];
        assert_eq!(pixel(&picture, 24, 22).1, background, "{cut:?}");
        assert_ne!(pixel(&picture, 24, 14).1, background, "{cut:?}");
        assert_ne!(pixel(&picture, 24, 17).1, background, "{cut:?}");
        let check = selvedge(&[&["check", &scene][..], &cut].concat());
        assert_eq!(check.status.code(), Some(0), "{cut:?}: {}", text(&check.stdout));
    }
    refused(&["render", &scene, "-o", &picture, "--trim-by", &scene], "needs equations");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// The ball's shadow falls on the sheet away from the sun, of the scene or of the command line; the light is judged. A
/// message says that glass casts none.
#[test]
fn the_sun_casts_shadows() {
    let folder = std::env::temp_dir().join(format!("selvedge-sun-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let (scene, picture, camera) = (path("small.toml"), path("a.png"), path("camera.json"));
    std::fs::write(&scene, format!("{SCENE}sun = [1, 0, 0.25]\n")).unwrap();
    // left and right of the ball, on the sheet
    let sides = |more: &[&str]| {
        let draw = ["render", &scene, "-o", &picture, "--camera", "top", "--size", "96x72", "--camera-out", &camera];
        let output = selvedge(&[&draw[..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{more:?}: {}", text(&output.stderr));
        let clear = more.contains(&"--xray");
        assert_eq!(text(&output.stderr).contains("cast no shadow"), clear, "{more:?}: {}", text(&output.stderr));
        let half: serde_json::Value = serde_json::from_slice(&std::fs::read(&camera).unwrap()).unwrap();
        let scale = 36.0 / half["ortho"].as_f64().unwrap();
        let bright =
            |x: f64| pixel(&picture, (48.0 + x * scale) as u32, 36).1[..3].iter().map(|c| u32::from(*c)).sum::<u32>();
        [-4.0, 4.0].map(bright)
    };
    let [left, right] = sides(&[]);
    assert!(left + 15 < right, "{left} in shade, {right} lit");
    let [left, right] = sides(&["--sun=-1,0,0.25"]);
    assert!(right + 15 < left, "{right} in shade, {left} lit");
    let [left, right] = sides(&["--xray", "#1"]);
    assert!(left.abs_diff(right) < 15, "{left} and {right} lit");
    let check = selvedge(&["check", &scene, "--camera", "top"]);
    let told = text(&check.stdout);
    assert!(check.status.code() == Some(0) && told.contains("light: wrong") && told.contains(" 0, 0.000"), "{told}");
    refused(&["render", &scene, "-o", &picture, "--sun", "0,0,0"], "not 0,0,0");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Squares in a row as long as `repeat` allows, seen at its last one; one more is refused.
#[test]
fn as_many_copies_as_a_scene_may_have_are_drawn() {
    let folder = std::env::temp_dir().join(format!("selvedge-copies-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let scene = folder.join("row.toml").to_string_lossy().into_owned();
    let row = |copies: u32| {
        let square = "selvedge = 1\n[surface.a]\nshape = \"plane\"\nu = [0, 1]\nv = [0, 1]\n";
        let text = format!("{square}[[instance]]\nof = \"a\"\nrepeat = {copies}\nstep = {{ at = [3, 0] }}\n");
        std::fs::write(&scene, text).unwrap();
    };
    row(65_536);
    let view = ["--size", "64x48", "--eye=196605.5,5,50", "--target=196605.5,0.5,0"];
    let check = selvedge(&[&["check", &scene][..], &view].concat());
    let told = text(&check.stdout) + &text(&check.stderr);
    assert!(check.status.code() == Some(0) && told.contains("kept") && !told.contains("no pixel"), "{told}");
    row(65_537);
    refused(&["check", &scene], "`repeat`: 65537 is not between 1 and 65536");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_scene_goes_through_every_command() {
    let folder = std::env::temp_dir().join(format!("selvedge-scenes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let scene = path("small.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let done = |arguments: &[&str]| {
        let output = selvedge(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
        text(&output.stdout)
    };

    let told: serde_json::Value = serde_json::from_str(&done(&["info", "--json", &scene])).unwrap();
    assert_eq!((&told["name"], &told["faces"]), (&"small".into(), &1.into()));
    assert_eq!(told["report"]["format"], "selvedge scene 1");
    assert_eq!(told["boolean_solids"].as_array().unwrap().len(), 1);
    // at the size of the scene's picture, and at another
    assert_eq!(
        (&told["folded_tiles"]["size"], &told["folded_tiles"]["tiles"]),
        (&serde_json::json!([48, 36]), &9.into())
    );
    assert!(done(&["info", &scene, "--size", "320x200"]).contains("folded tiles at 320x200: "), "told of a view");
    assert_eq!(told["report"]["nodes"], serde_json::json!({ "circle": 1, "plane": 1, "sphere": 1 }));

    // the scene's own picture: its size, its camera, its background in the corner
    let picture = path("front.png");
    done(&["render", &scene, "-o", &picture]);
    assert_eq!(pixel(&picture, 0, 0), ((48, 36), [0x10, 0x20, 0x30, 0xff]));
    // from above, the ball in the hole leaves a ring of background between 2 and 3 from the middle
    let above = path("top.png");
    done(&["render", &scene, "-o", &above, "--camera", "top", "--size", "96x72"]);
    let (size, middle) = pixel(&above, 48, 36);
    let camera = path("camera.json");
    done(&["render", &scene, "-o", &above, "--camera", "top", "--size", "96x72", "--camera-out", &camera]);
    let half: serde_json::Value = serde_json::from_slice(&std::fs::read(&camera).unwrap()).unwrap();
    let scale = 36.0 / half["ortho"].as_f64().unwrap(); // pixels a unit
    let background = [0x10, 0x20, 0x30, 0xff];
    assert_eq!(size, (96, 72));
    assert_ne!(middle, background);
    assert_eq!(pixel(&above, (48.0 + 2.5 * scale) as u32, 36).1, background);
    assert_ne!(pixel(&above, (48.0 + 4.0 * scale) as u32, 36).1, background);

    let verdict = done(&["check", &scene, "--samples", "500"]);
    assert!(verdict.contains("given") && verdict.contains("kept"), "{verdict}");
    refused(&["render", &scene, "-o", &picture, "--camera", "back"], "no camera `back`; it has front, top");
    done(&["convert", &scene, &path("small.selvedge")]);
    let again: serde_json::Value = serde_json::from_str(&done(&["info", "--json", &path("small.selvedge")])).unwrap();
    assert_eq!(again["faces"], told["faces"]);
    done(&["export", &scene, &path("small.step")]);
    std::fs::write(&scene, SCENE.replace("radius = 3", "radius = 7")).unwrap();
    let told = selvedge(&["info", &scene]);
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(told.status.code(), Some(2));
    let told = text(&told.stderr);
    assert!(told.contains("small.toml:14:10: the loop reaches"), "{told}");
}
