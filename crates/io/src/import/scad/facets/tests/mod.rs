//! Regions and bodies against closed forms.

mod font;

use super::cells::{self, Cell};
use super::region::{Join, Region};
use super::solid::{Body, Part, Triangles};
use super::{Budget, dxf, hull, relief, svg};
use crate::model::Bounds;
use glam::{DAffine2, DAffine3, DVec2, DVec3};

fn block(min: [f64; 3], max: [f64; 3]) -> Body {
    let (min, max) = (DVec3::from_array(min), DVec3::from_array(max));
    let corner = |i: u32| min + (max - min) * DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    Body::hull(&(0..8).map(corner).collect::<Vec<_>>())
}

fn square(low: f64, high: f64) -> Region {
    let corner = |x: f64, y: f64| DVec2::new(x, y);
    Region::new(&[vec![corner(low, low), corner(high, low), corner(high, high), corner(low, high)]], true)
}

#[track_caller]
fn near(found: f64, expected: f64) {
    // sums of some dozens of products
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{found}, not {expected}");
}

/// Points of a low-discrepancy sequence in a cube from -1 to 1.
fn scattered(count: u32) -> Vec<DVec3> {
    let step = DVec3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_2);
    (1..=count).map(|i| (step * f64::from(i)).fract() * 2.0 - 1.0).collect()
}

#[test]
fn hulls_hold_all_points_and_no_more() {
    // in x and z: (0, 0) (30, 0) (30, 30) (20, 30) (0, 10), an area of 700, times 10
    let two = Body::union(vec![block([0.0; 3], [10.0; 3]), block([20.0, 0.0, 0.0], [30.0, 10.0, 30.0])]);
    let all = Body::hull(&two.corners());
    near(all.volume(), 7000.0);
    let Part::Cell(cell) = &all.parts[0] else { panic!("a cell") };
    assert_eq!(cell.planes().len(), 7);
    // many points in the sides, turned so that rounding moves them
    let turn = DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let grid = (0..1000).map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)));
    let grid: Vec<DVec3> = grid.map(|p| turn.transform_point3(p)).collect();
    let cube = Cell::hull(&grid).unwrap();
    assert!((cube.volume() - 729.0).abs() < 1e-7, "{}", cube.volume()); // points within 1e-10 of the size go
    assert_eq!(cube.planes().len(), 6);
    // a cloud: every point lies below every plane, every corner is one of the points
    let cloud: Vec<DVec3> = scattered(2000).into_iter().filter(|p| p.length() < 1.0).collect();
    let (corners, triangles) = hull::solid(&cloud).unwrap();
    assert_eq!(triangles.len(), 2 * corners.len() - 4, "Euler's formula for triangles");
    let ball = Cell::hull(&cloud).unwrap();
    for (normal, offset) in ball.planes() {
        assert!(cloud.iter().all(|p| normal.dot(*p) <= offset + 1e-9));
    }
    assert!(corners.iter().all(|c| cloud.contains(c)));
    // points in a plane, in a line, at one place, none
    let flat: Vec<DVec3> = cloud.iter().map(|p| p.with_z(0.25)).collect();
    let line: Vec<DVec3> = cloud.iter().map(|p| DVec3::splat(p.x)).collect();
    for points in [flat, line, vec![DVec3::ONE; 9], Vec::new()] {
        assert!(hull::solid(&points).is_none());
    }
}

#[test]
fn differences_and_intersections_of_solids() {
    let budget = &mut Budget::whole();
    let (big, small) = (block([0.0; 3], [3.0; 3]), block([1.0; 3], [2.0; 3]));
    near(big.clone().without(small.clone(), budget).unwrap().volume(), 26.0);
    near(small.clone().without(big.clone(), budget).unwrap().volume(), 0.0);
    let corner = block([2.0; 3], [5.0; 3]);
    near(big.clone().without(corner.clone(), budget).unwrap().volume(), 26.0);
    near(big.clone().common(corner, budget).unwrap().volume(), 1.0);
    // beside each other, with a face in common
    let beside = block([3.0, 0.0, 0.0], [4.0, 3.0, 3.0]);
    near(big.clone().without(beside.clone(), budget).unwrap().volume(), 27.0);
    near(big.clone().common(beside, budget).unwrap().volume(), 0.0);
    // a cube and the one turned by 45 degrees about z: a prism over a regular octagon, 2 (sqrt 2 - 1) of the square
    let turned = block([-1.5; 3], [1.5; 3]).moved(&DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_4));
    let both = block([-1.5; 3], [1.5; 3]).common(turned, budget).unwrap();
    near(both.volume(), 27.0 * 2.0 * (2.0_f64.sqrt() - 1.0));
}

/// An L of thickness 1 whose corner is missing, 2 high.
fn ell() -> Triangles {
    let outline = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]].map(DVec2::from_array);
    let lift = super::gather::linear(
        &Region::new(&[outline.to_vec()], true),
        crate::import::scad::flat::Lift::Linear { base: 0.0, height: 2.0, scale: 1.0 },
    );
    lift.unwrap()
}

#[test]
fn meshes_become_convex_cells() {
    let mesh = ell();
    assert!(mesh.is_closed());
    near(mesh.volume(), 10.0);
    let cells = cells::of_mesh(&mesh.points, &mesh.triangles, &mut Budget::whole()).unwrap();
    near(cells.iter().map(Cell::volume).sum(), 10.0);
    let inner = |p: DVec3| cells.iter().any(|c| c.planes().iter().all(|(n, d)| n.dot(p) <= *d));
    for p in scattered(4000).into_iter().map(|p| 2.0 * p + 1.5) {
        let flat = (p.x < 3.0 && p.y < 1.0 || p.x < 1.0 && p.y < 3.0) && p.min_element() > 0.0 && p.z < 2.0;
        assert_eq!(inner(p), flat, "{p}");
    }
    // a spent budget is an error
    let error = cells::of_mesh(&mesh.points, &mesh.triangles, &mut Budget(5)).unwrap_err();
    assert!(error.contains("more facets"), "{error}");
    // a mesh that does not close has no inside
    let open = Triangles { triangles: mesh.triangles[1..].to_vec(), ..mesh };
    let error = Body::mesh(open).without(block([0.0; 3], [1.0; 3]), &mut Budget::whole()).unwrap_err();
    assert!(error.contains("do not close"), "{error}");
}

#[test]
fn minkowski_sums() {
    let budget = &mut Budget::whole();
    let sum = block([0.0; 3], [1.0, 2.0, 3.0]).minkowski(block([-1.0; 3], [1.0; 3]), budget).unwrap();
    near(sum.volume(), 3.0 * 4.0 * 5.0);
    let bounds = sum.bounds();
    assert_eq!([bounds.min, bounds.max], [DVec3::splat(-1.0), DVec3::new(2.0, 3.0, 4.0)]);
    // by parts: the L with a cube of 1 is the L of the sums
    let sum = Body::mesh(ell()).minkowski(block([0.0; 3], [1.0; 3]), budget).unwrap();
    let inner = |p: DVec3| {
        sum.parts.iter().any(|part| match part {
            Part::Cell(c) => c.planes().iter().all(|(n, d)| n.dot(p) <= *d),
            Part::Mesh(_) => panic!("cells"),
        })
    };
    for p in scattered(4000).into_iter().map(|p| 2.5 * p + 2.0) {
        let flat = (p.x < 4.0 && p.y < 2.0 || p.x < 2.0 && p.y < 4.0) && p.min_element() > 0.0 && p.z < 3.0;
        assert_eq!(inner(p), flat, "{p}");
    }
    // in the plane: 2 and 1 wide
    near(square(0.0, 2.0).minkowski(&square(-0.5, 0.5), budget).unwrap().area(), 9.0);
    let frame = square(0.0, 10.0).without(&square(3.0, 7.0));
    near(frame.minkowski(&square(-1.0, 1.0), budget).unwrap().area(), 144.0 - 4.0);
}

#[test]
fn offsets() {
    let ten = square(0.0, 10.0);
    // 7 segments on a circle of 2: corners at 0, 51.43 and 90 degrees, as OpenSCAD 2021.01 has them (area 191.24268)
    let step = std::f64::consts::TAU / 7.0;
    let corner = 0.5 * 4.0 * (step.sin() + (0.25 * 7.0 * step - step).sin());
    near(ten.offset(2.0, Join::Round(7.0)).area(), 180.0 + 4.0 * corner);
    near(ten.offset(2.0, Join::Miter).area(), 196.0);
    let cut = 2.0 - 2.0 * (std::f64::consts::PI / 8.0).tan();
    near(ten.offset(2.0, Join::Chamfer).area(), 196.0 - 2.0 * cut * cut);
    for join in [Join::Round(7.0), Join::Miter, Join::Chamfer] {
        near(ten.offset(-2.0, join).area(), 36.0);
        assert!(ten.offset(-5.5, join).is_empty());
        near(ten.offset(0.0, join).area(), 100.0);
    }
    // the hole shrinks while the outline grows, and closes
    let frame = ten.without(&square(3.0, 7.0));
    near(frame.offset(1.0, Join::Miter).area(), 144.0 - 4.0);
    near(frame.offset(3.0, Join::Miter).area(), 256.0);
    near(frame.offset(-1.0, Join::Miter).area(), 64.0 - 36.0);
    near(frame.filled().area(), 100.0);
}

#[test]
fn regions_by_odd_and_even() {
    // a bow tie: two triangles of 1 by 2 half
    let tie = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]].map(DVec2::from_array).to_vec();
    near(Region::new(&[tie], true).area(), 2.0);
    near(square(0.0, 2.0).hull().area(), 4.0);
    let mirrored = square(0.0, 2.0).without(&square(0.5, 1.0)).moved(&DAffine2::from_scale(DVec2::new(-3.0, 1.0)));
    near(mirrored.area(), 3.0 * 3.75);
    assert!(mirrored.moved(&DAffine2::from_scale(DVec2::new(0.0, 1.0))).is_empty());
}

#[test]
fn shadows_and_cuts() {
    // 36.87 degrees about x: 8 + 6 deep
    let tilted = DAffine3::from_rotation_x(0.6_f64.asin());
    near(block([0.0; 3], [10.0; 3]).moved(&tilted).shadow().area(), 140.0);
    near(Body::mesh(ell()).shadow().area(), 5.0);
    let budget = &mut Budget::whole();
    let at = |z: f64| DAffine3::from_translation(DVec3::Z * -z);
    near(Body::mesh(ell()).moved(&at(1.0)).cut(budget).unwrap().area(), 5.0);
    near(block([0.0; 3], [2.0, 3.0, 4.0]).cut(budget).unwrap().area(), 6.0); // the plane holds its bottom
    assert!(block([0.0; 3], [1.0; 3]).moved(&at(1.5)).cut(budget).unwrap().is_empty());
    // a pyramid of 2 by 2 at half its height of 1
    let pyramid = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    near(Body::hull(&pyramid.map(DVec3::from_array)).moved(&at(0.5)).cut(budget).unwrap().area(), 1.0);
}

#[test]
fn height_maps() {
    // the mean of the corners of a square is that of its four triangles: volume over the base, which lies 1 lower
    let relief = relief::read(b"# heights\n1 2 3\n\n4 5 6\n", false).unwrap();
    let mesh = relief.mesh(false);
    assert!(mesh.is_closed());
    near(mesh.volume(), 3.0 + 4.0);
    let bounds = mesh.points.iter().copied().fold(Bounds::EMPTY, Bounds::with);
    assert_eq!([bounds.min, bounds.max], [DVec3::ZERO, DVec3::new(2.0, 1.0, 6.0)]);
    let centred = relief.mesh(true).points.iter().copied().fold(Bounds::EMPTY, Bounds::with);
    assert_eq!(centred.min, DVec3::new(-1.0, -0.5, 0.0));
    for (bytes, message) in [
        (&b"1 2\n3 x\n"[..], "line 2 holds something that is no finite number"),
        (b"1 2 nan\n3 4 5\n", "line 1 holds"),
        (b"1 2 3\n", "3 by 1 heights are no surface"),
        (b"", "0 by 0"),
        (b"\xff\xfe", "neither text nor"),
        (b"\x89PNG\r\n\x1a\n cut", ""),
    ] {
        let error = relief::read(bytes, false).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    // white is 100 high, and the last row is that of y = 0
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 2, 2);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(&[255, 0, 51, 51]).unwrap();
    let mesh = relief::read(&png, false).unwrap().mesh(false);
    near(mesh.points[0].z, 20.0);
    near(mesh.points[2].z, 100.0);
    assert!(relief::read(&png[..png.len() - 20], false).is_err());
}

#[test]
fn drawings() {
    let sheet = r#"<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="20mm" viewBox="0 0 80 40">
        <rect x="10" y="10" width="20" height="10"/><g transform="translate(40 0)"><path d="M10 20h10v10z"/></g></svg>"#;
    let (region, notes) = svg::region(sheet.as_bytes(), 72.0, 30.0, false).unwrap();
    assert!(notes.is_empty());
    let worded = sheet.replace("</svg>", "<text x=\"1\" y=\"9\">A</text></svg>");
    assert_eq!(svg::region(worded.as_bytes(), 72.0, 30.0, false).unwrap().1, ["1 of `text` are not read"]);
    // half a millimetre a unit; usvg keeps single floats
    assert!((region.area() - 50.0 - 12.5).abs() < 1e-4, "{}", region.area());
    let low = region.corners().fold(DVec2::INFINITY, DVec2::min);
    assert!(low.distance(DVec2::new(5.0, 5.0)) < 1e-5, "{low}: y runs upwards from the lower edge");
    assert!(svg::region(b"<svg", 72.0, 30.0, false).is_err());

    let wrap = |body: &str| format!("0\nSECTION\n2\nENTITIES\n{body}0\nENDSEC\n0\nEOF\n");
    let line =
        |a: [i32; 2], b: [i32; 2]| format!("0\nLINE\n8\na\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", a[0], a[1], b[0], b[1]);
    // three lines in any order and direction, a circle as a square, a polyline with two half circles of radius 1
    let triangle = [line([0, 0], [4, 0]), line([0, 3], [4, 0]), line([0, 3], [0, 0])].concat();
    let (region, notes) = dxf::region(wrap(&triangle).as_bytes(), "", |_| 4.0).unwrap();
    near(region.area(), 6.0);
    assert!(notes.is_empty());
    let circle = "0\nCIRCLE\n8\nb\n10\n20\n20\n0\n40\n1\n";
    let (region, _) = dxf::region(wrap(&(triangle.clone() + circle)).as_bytes(), "b", |_| 4.0).unwrap();
    near(region.area(), 2.0);
    let slot = "0\nLWPOLYLINE\n70\n1\n10\n0\n20\n-1\n10\n5\n20\n-1\n42\n1\n10\n5\n20\n1\n10\n0\n20\n1\n42\n1\n";
    let (region, _) = dxf::region(wrap(slot).as_bytes(), "", |_| 4.0).unwrap();
    near(region.area(), 10.0 + 2.0);
    let (region, notes) =
        dxf::region(wrap(&(line([0, 0], [1, 0]) + "0\nTEXT\n8\na\n")).as_bytes(), "", |_| 4.0).unwrap();
    assert!(region.is_empty());
    assert_eq!(notes, ["1 of TEXT are not read", "1 runs do not close"]);
    let (_, notes) = dxf::region(wrap("0\nINSERT\n2\nno\n").as_bytes(), "", |_| 4.0).unwrap();
    assert_eq!(notes, ["the block \"no\" of an INSERT is not there"]);
    for (text, message) in [
        ("0\nSECTION\n2\nENTITIES\n0\nLINE\n", "cut off"),
        ("0\nSECTION\n2\n", "the file ends in line 3"),
        ("zero\nSECTION\n", "line 1 holds no group code"),
    ] {
        let error = dxf::region(text.as_bytes(), "", |_| 4.0).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
}

/// A triangle of area 6, and a square of 2 about (20, 0) on another layer.
#[test]
fn blocks_of_drawings() {
    let line = |a: [i32; 2], b: [i32; 2]| format!("0\nLINE\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", a[0], a[1], b[0], b[1]);
    let triangle = [line([0, 0], [4, 0]), line([4, 0], [0, 3]), line([0, 3], [0, 0])].concat();
    let block = |name: &str, base: i32, body: &str| {
        format!("0\nBLOCK\n8\n0\n2\n{name}\n10\n{base}\n20\n0\n{body}0\nENDBLK\n8\n0\n")
    };
    let insert = |name: &str, more: &str| format!("0\nINSERT\n8\na\n2\n{name}\n10\n100\n20\n50\n{more}");
    let read = |blocks: &[String], entities: &str, layer: &str| {
        let text = format!(
            "0\nSECTION\n2\nBLOCKS\n{}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n",
            blocks.concat()
        );
        dxf::region(text.as_bytes(), layer, |_| 4.0).unwrap()
    };
    let blocks = [block("T", 0, &triangle), block("TT", 0, &insert("T", ""))];
    let bounds = |region: &Region| {
        let all: Vec<DVec2> = region.corners().collect();
        let (low, high) = all.iter().fold((all[0], all[0]), |(l, h), p| (l.min(*p), h.max(*p)));
        [low.x, low.y, high.x, high.y]
    };
    // a block that nothing inserts is not drawn
    assert!(read(&blocks, "", "").0.is_empty());
    let (region, notes) = read(&blocks, &insert("T", ""), "a");
    near(region.area(), 6.0);
    assert_eq!((bounds(&region), notes.len()), ([100.0, 50.0, 104.0, 53.0], 0));
    assert!(read(&blocks, &insert("T", ""), "b").0.is_empty());
    // mirrored and twice as high, then turned by a right angle: (4, 0) goes to (-4, 0) and (0, -4), (0, 3) to (0, 6) and (-6, 0)
    let (region, _) = read(&blocks, &insert("T", "41\n-1\n42\n2\n50\n90\n"), "");
    near(region.area(), 12.0);
    for (found, wanted) in bounds(&region).into_iter().zip([94.0, 46.0, 100.0, 50.0]) {
        assert!((found - wanted).abs() < 1e-12, "{found}, not {wanted}");
    }
    // a block in a block, moved twice
    let (region, _) = read(&blocks, &insert("TT", ""), "");
    near(region.area(), 6.0);
    assert_eq!(bounds(&region), [200.0, 100.0, 204.0, 103.0]);
    // faults of the file, each with its note
    for (blocks, entity, note) in [
        (vec![block("T", 7, &triangle)], insert("T", ""), "the base point of the block \"T\""),
        (blocks.to_vec(), insert("T", "70\n3\n44\n9\n"), "the block \"T\" is drawn once"),
        (vec![block("A", 0, &insert("A", ""))], insert("A", ""), "the block \"A\" is within itself"),
        (vec![block("A", 0, "0\nTEXT\n")], insert("A", ""), "1 of TEXT are not read"),
    ] {
        let (_, notes) = read(&blocks, &entity, "");
        assert!(notes.len() == 1 && notes[0].starts_with(note), "{notes:?}");
    }
    // 10^30 uses
    let many: Vec<String> =
        (0..30).map(|i| block(&format!("{i}"), 0, &insert(&format!("{}", i + 1), "").repeat(10))).collect();
    let text = format!(
        "0\nSECTION\n2\nBLOCKS\n{}{}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{}0\nENDSEC\n0\nEOF\n",
        many.concat(),
        block("30", 0, &triangle),
        insert("0", "")
    );
    assert!(dxf::region(text.as_bytes(), "", |_| 4.0).unwrap_err().contains("corners"));
}
