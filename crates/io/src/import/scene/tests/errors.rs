//! Every refusal with its line and column.

use super::refused;
use crate::import::scene;

#[track_caller]
fn expect(cases: &[(&str, &str)]) {
    for (text, message) in cases {
        assert_eq!(&refused(text), message, "{text}");
    }
}

const LINE: &str = "[curve.c]\nshape = \"line\"\nfrom = [0, 0]\nto = [1, 0]\n";

#[test]
fn the_version_is_wanted_first() {
    let error = |text: &str| scene(text.as_bytes(), "t.toml", None).expect_err("no scene").to_string();
    assert_eq!(error("name = \"x\"\n"), "t.toml:1:1: not a scene: `selvedge = 1` is missing, the version of its form");
    assert_eq!(
        error("\nselvedge = 2\n"),
        "t.toml:2:12: `selvedge`: version 2 of the scene form; this engine reads version 1"
    );
    assert_eq!(error("selvedge = \"1\"\n"), "t.toml:1:12: `selvedge`: a whole number is wanted, not a string");
    assert_eq!(error("selvedge = 1\n"), "t.toml:1:1: the scene has nothing to draw");
    let bytes = b"selvedge = 1\nname = \"\xff\"\n";
    assert_eq!(scene(bytes, "t.toml", None).unwrap_err().to_string(), "t.toml:2:9: not UTF-8 text");
    assert!(error("selvedge = \n").starts_with("t.toml:1:"), "{}", error("selvedge = \n"));
    assert!(error("selvedge = 1\nname = \"a\"\nname = \"b\"\n").starts_with("t.toml:3:1: duplicate key"));
}

#[test]
fn unknown_keys_and_words_have_their_place() {
    expect(&[
        (
            "colour = 1\n",
            "2:1: `colour` is not known here; known are `selvedge`, `name`, `unit`, `tolerance`, \
             `coincident`, `curve`, `surface`, `solid`, `part`, `file`, `instance`, `camera`, `picture`, `trim`, \
             `section`, `xray`",
        ),
        ("coincident = 0\n", "2:14: `coincident`: a share from 1e-7 to 1e-3 is wanted"),
        ("coincident = nan\n", "2:14: `coincident`: not a finite number"),
        ("unit = \"parsec\"\n", "2:8: `unit`: `parsec` is none of `mm`, `cm`, `m`, `um`, `km`, `in`, `ft`"),
        ("[solid.a]\nshape = \"sphere\"\nradus = 3\n", "2:8: `radius` is missing"),
        (
            "[solid.a]\nshape = \"sphere\"\nradius = 3\nradus = 3\n",
            "5:1: `radus` is not known here; known are `shape`, `faces`, `radius`, `at`, `rotate`, `scale`, \
             `matrix`, `colour`",
        ),
        (
            "[surface.a]\nshape = \"ball\"\n",
            "3:9: `shape`: `ball` is none of `plane`, `bilinear`, `bezier`, `bspline`, `equations`, `grid`, \
             `extrude`, `lathe`, `sweep`, `tube`, `ruled`, `loft`, `coons`, `gordon`, `offset`",
        ),
        ("[solid]\na = 3\n", "3:5: `a`: a table is wanted, not a whole number"),
        ("[solid.\"ä\"]\n", "2:8: `ä` is no name: up to 64 letters, digits, `_` and `-`"),
    ]);
}

#[test]
fn numbers_are_finite_and_in_range() {
    let ball = |radius: &str| refused(&format!("[solid.a]\nshape = \"sphere\"\nradius = {radius}\n"));
    assert_eq!(ball("nan"), "4:10: `radius`: not a finite number");
    assert_eq!(ball("-inf"), "4:10: `radius`: not a finite number");
    assert_eq!(ball("1e999"), "4:10: `radius`: not a finite number");
    assert_eq!(ball("-1"), "4:10: `radius`: -1 is below 0");
    assert_eq!(ball("\"1\""), "4:10: `radius`: a number is wanted, not a string");
    let at = |at: &str| refused(&format!("[solid.a]\nshape = \"sphere\"\nradius = 1\nat = {at}\n"));
    assert_eq!(at("[1]"), "5:6: `at`: 2 or 3 coordinates are wanted, not 1");
    assert_eq!(at("[1, 2, nan]"), "5:13: `at`: not a finite number");
    assert_eq!(at("[1, 2]\nscale = 0"), "6:9: `scale`: a scale of 0 leaves nothing");
    assert_eq!(at("[1, 2]\nrotate = [1, 2]"), "6:10: `rotate`: 3 angles are wanted, about x, y and z");
    assert_eq!(
        at("[0, 0]\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]"),
        "6:10: `matrix`: beside `at`, `rotate` or `scale`"
    );
    let flat = "[solid.a]\nshape = \"sphere\"\nradius = 1\nmatrix = [[1, 0, 1, 0], [0, 1, 0, 0], [1, 0, 1, 0]]\n";
    assert_eq!(refused(flat), "5:10: `matrix`: it flattens space");
    let colour = |c: &str| refused(&format!("[solid.a]\nshape = \"sphere\"\nradius = 1\ncolour = {c}\n"));
    assert_eq!(colour("\"red\""), "5:10: `colour`: `red` is not a colour like `#c08040`");
    assert_eq!(colour("[1, 0, 2]"), "5:10: `colour`: a colour is `#rrggbb`, or 3 or 4 numbers from 0 to 1");
}

#[test]
fn names_are_defined_once_and_not_in_circles() {
    expect(&[
        (
            "[surface.s]\nshape = \"extrude\"\nprofile = \"gone\"\nalong = [0, 0, 1]\n",
            "4:11: `profile`: nothing is called `gone`",
        ),
        (
            "[solid.s]\nshape = \"sphere\"\nradius = 1\n[surface.s]\nshape = \"plane\"\n",
            "5:10: `s` is the name of a solid already",
        ),
        (
            "[solid.s]\nshape = \"sphere\"\nradius = 1\n[surface.t]\nshape = \"offset\"\nof = \"s\"\n",
            "7:6: `of`: a surface is wanted, and `s` is a solid or part",
        ),
        (
            "[surface.a]\nshape = \"offset\"\nof = \"b\"\n[surface.b]\nshape = \"offset\"\nof = \"a\"\n",
            "7:6: `of`: `a` is made of itself: a of b of a",
        ),
        ("[solid.A]\nshape = \"boolean\"\nof = \"A+A\"\n", "4:6: `of`: `A` is made of itself: A of A"),
        ("[[instance]]\nof = \"x\"\n", "3:6: `of`: nothing is called `x`"),
    ]);
    let curve = format!("{LINE}[[instance]]\nof = \"c\"\n");
    assert_eq!(refused(&curve), "7:6: `of`: a surface, solid, part or file is wanted, and `c` is a curve");
    // a hundred surfaces, each the offset of the one before
    let chain: String =
        (1..100).map(|i| format!("[surface.s{}]\nshape = \"offset\"\nof = \"s{i}\"\ndistance = 1\n", i - 1)).collect();
    assert_eq!(refused(&chain), "128:6: `of`: items made of items more than 32 deep");
}

#[test]
fn constructions_tell_what_they_lack() {
    let lathe = "[curve.p]\nshape = \"line\"\nfrom = [-1, 0]\nto = [1, 1]\n[surface.s]\nshape = \"lathe\"\n\
                 profile = \"p\"\n";
    assert_eq!(refused(lathe), "7:9: `shape`: the profile crosses the axis at 1");
    let tilted = "[curve.p]\nshape = \"line\"\nfrom = [1, 0]\nto = [1, 1, 2]\n[surface.s]\nshape = \"lathe\"\n\
                  profile = \"p\"\n";
    assert_eq!(refused(tilted), "8:11: `profile`: `p` must lie in the plane z = 0, but reaches z = 2");
    expect(&[
        ("[curve.c]\nshape = \"line\"\nfrom = [1, 1]\nto = [1, 1]\n", "3:9: `shape`: the line has no length"),
        (
            "[curve.c]\nshape = \"bspline\"\ndegree = 2\npoints = [[0, 0], [1, 0], [2, 1]]\nknots = [0, 0, 1, 1]\n",
            "6:9: `knots`: 4 knots, but 6 are needed: points + degree + 1",
        ),
        (
            "[curve.c]\nshape = \"polyline\"\npoints = [[0, 0], [1, 0]]\nweights = [1]\n",
            "5:11: `weights`: 1 weights for 2 points",
        ),
        (
            "[curve.c]\nshape = \"bezier\"\npoints = [[0, 0], [1, 0]]\nweights = [1, -1]\n",
            "5:15: `weights`: -1 is not above 0",
        ),
        ("[curve.c]\nshape = \"through\"\npoints = [[0, 0], [0, 0]]\n", "4:10: `points`: points 0 and 1 coincide"),
        (
            "[surface.s]\nshape = \"equations\"\nx = \"u\"\ny = \"v + w\"\nz = \"0\"\nu = [0, 1]\nv = [0, 1]\n",
            "5:10: `y`: unknown name `w`",
        ),
        (
            "[surface.s]\nshape = \"equations\"\nx = \"u\"\ny = \"v\"\nz = \"0\"\nu = [0, \"2*u\"]\nv = [0, 1]\n",
            "7:9: `u`: neither `u` nor `v` has a value here, and the result must be finite",
        ),
        ("[solid.s]\nshape = \"boolean\"\nof = \"A+(B\"\n", "4:9: `of`: column 3: this bracket is not closed"),
        (
            "[solid.s]\nshape = \"boolean\"\nof = \"A+B\"\n",
            "4:6: `of`: no solid is called `A`, and `with` does not say what it is",
        ),
        (
            "[solid.A]\nshape = \"sphere\"\nradius = 1\n[solid.s]\nshape = \"boolean\"\nof = \"A\"\nwith = { B = \"A\" }\n",
            "8:10: `B` does not stand in the expression",
        ),
    ]);
}

#[test]
fn operands_have_an_inside() {
    let sheet = "[surface.s]\nshape = \"plane\"\nu = [0, 1]\nv = [0, 1]\n[part.P]\nsurfaces = \"s\"\n";
    let of = |name: &str| refused(&format!("{sheet}[solid.b]\nshape = \"boolean\"\nof = \"A\"\nwith.A = \"{name}\"\n"));
    assert_eq!(of("P"), "11:10: `A`: `P` has no inside: it is not closed");
    assert_eq!(of("s"), "11:10: `A`: a solid is wanted, and `s` is a surface");
}

#[test]
fn loops_close_and_stay_on_the_surface() {
    let sheet = |loops: &str| {
        let curves =
            "[curve.c]\nshape = \"circle\"\nradius = 2\n[curve.l]\nshape = \"line\"\nfrom = [0, 0]\nto = [1, 0]\n";
        refused(&format!("{curves}[surface.s]\nshape = \"plane\"\nu = [-3, 3]\nv = [-3, 3]\nloops = {loops}\n"))
    };
    assert_eq!(sheet("[]"), "13:9: `loops`: the list is empty");
    assert_eq!(sheet("[\"l\"]"), "13:9: `loops`: trim loop is open by 1e0 in (u, v) after curve 0");
    let out = "the loop reaches (4, 0), outside of the surface's u -3 to 3, v -3 to 3";
    assert_eq!(sheet("[{ curves = \"c\", at = [2, 0] }]"), format!("13:10: {out}"));
    let crossing = sheet("[\"c\", { curves = \"c\", at = [0.5, 0.1] }]");
    assert!(crossing.starts_with("13:9: `loops`: the profile (by its chords) crosses itself"), "{crossing}");
    let beside = sheet("[{ curves = \"c\", at = [20, 0, 5], along = [0, 0, -1] }]");
    assert_eq!(
        beside,
        "13:10: `loops`: the projected outline misses the surface, or reaches its border or outline, at 0"
    );
    let plain = "[surface.s]\nshape = \"plane\"\nu = [0, 1]\nv = [0, 1]\nborder = true\n";
    assert_eq!(refused(plain), "6:10: `border`: without `loops` every surface ends at its border");
}

#[test]
fn counts_are_bounded() {
    let ball = "[solid.a]\nshape = \"sphere\"\nradius = 1\n";
    let copies =
        |n: &str| refused(&format!("{ball}[[instance]]\nof = \"a\"\nrepeat = {n}\nstep = {{ at = [3, 0] }}\n"));
    assert_eq!(copies("65537"), "7:10: `repeat`: 65537 is not between 1 and 65536");
    assert_eq!(copies("-1"), "7:10: `repeat`: -1 is not between 1 and 65536");
    assert_eq!(copies("99999999999999999999"), "7:10: `repeat`: 99999999999999999999 is not between 1 and 65536");
    expect(&[
        (
            &format!("{ball}[[instance]]\nof = \"a\"\nrepeat = 2\n"),
            "7:10: `repeat`: without a `step` all copies are in one place",
        ),
        (
            "[solid.g]\nshape = \"gear\"\nmodule = 1\nwidth = 1\nteeth = 100000\n",
            "6:9: `teeth`: 100000 is not between 4 and 1024",
        ),
    ]);
    // thirty solids, each twice the one before
    let mut bomb = "[solid.A0]\nshape = \"sphere\"\nradius = 1\n".to_owned();
    (1..30).for_each(|i| {
        let b = i - 1;
        bomb += &format!("[solid.A{i}]\nshape = \"boolean\"\nof = \"B+C\"\nwith = {{ B = \"A{b}\", C = \"A{b}\" }}\n");
    });
    let told = refused(&bomb);
    assert!(told.ends_with("the scene needs more than 2097152 control points and placed things"), "{told}");
    // many sections with many knots each: the net would have their product
    let section = |i: usize| {
        let points: Vec<String> = (0..90).map(|k| format!("[{k}, {i}, {}]", k % 7)).collect();
        format!("[curve.c{i}]\nshape = \"polyline\"\npoints = [{}]\n", points.join(","))
    };
    let names: Vec<String> = (0..100).map(|i| format!("\"c{i}\"")).collect();
    let text: String = (0..100).map(section).collect();
    let told = refused(&format!("{text}[surface.s]\nshape = \"loft\"\nsections = [{}]\n", names.join(",")));
    assert_eq!(told, "303:9: `shape`: its curves have 9200 knots in all, which is too many for one surface");
    // a million levels of nesting are the parser's to refuse
    let deep = format!("name = {}", "[".repeat(1_000_000));
    assert!(refused(&deep).starts_with("2:"));
}

#[test]
fn cameras_and_pictures() {
    let ball = "[solid.a]\nshape = \"sphere\"\nradius = 1\n";
    let camera = |keys: &str| refused(&format!("{ball}[camera.c]\n{keys}\n"));
    assert_eq!(camera("eye = [1, 0, 0]\ntarget = [1, 0, 0]"), "7:10: `target`: it is where the eye is");
    assert_eq!(camera("fov = 180"), "6:7: `fov`: an angle between 0 and 180 degrees is wanted");
    assert_eq!(camera("fov = 30\northo = 4"), "7:9: `ortho`: beside `fov`");
    assert_eq!(camera("from = [0, 0, 1]"), "6:8: `from`: the view runs along `up`");
    assert_eq!(camera("fit = \"b\""), "6:7: `fit`: nothing that is called `b` is placed");
    assert_eq!(camera("eye = [9, 0, 0]\nfit = true"), "7:7: `fit`: a camera with an `eye` is not fitted");
    assert_eq!(camera("target = [0, 0]"), "6:10: `target`: a fitted camera looks at the middle of what it fits");
    assert_eq!(camera("eye = [9, 0, 0]\northo = true"), "7:9: `ortho`: a number is wanted, not true or false");
    let picture = |keys: &str| refused(&format!("{ball}[picture]\n{keys}\n"));
    assert_eq!(picture("camera = \"x\""), "6:10: `camera`: there is no camera `x`");
    assert_eq!(picture("size = [0, 3]"), "6:9: `size`: 0 is not between 1 and 16384");
}
