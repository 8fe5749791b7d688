use glam::*;
use selvedge::headless::*;
use selvedge::model::*;
use selvedge::picture::*;
use selvedge::spline::*;
use std::f64::consts::*;

fn arc4() -> (Vec<f64>, Vec<(f64, f64, f64)>) {
    let s = SQRT_2 / 2.0;
    let pts = vec![
        (1., 0., 1.),
        (1., 1., s),
        (0., 1., 1.),
        (-1., 1., s),
        (-1., 0., 1.),
        (-1., -1., s),
        (0., -1., 1.),
        (1., -1., s),
        (1., 0., 1.),
    ];
    let h = FRAC_PI_2;
    (vec![0., 0., 0., h, h, 2. * h, 2. * h, 3. * h, 3. * h, 4. * h, 4. * h, 4. * h], pts)
}
fn sphere(r: f64) -> Surface {
    let (ku, pu) = arc4();
    let s = SQRT_2 / 2.0;
    let pv = [(0., -1., 1.), (1., -1., s), (1., 0., 1.), (1., 1., s), (0., 1., 1.)];
    let h = FRAC_PI_2;
    let kv = vec![-h, -h, -h, 0., 0., h, h, h];
    let points = pv
        .iter()
        .flat_map(|&(x, z, wv)| {
            pu.iter().map(move |&(a, b, wu)| {
                let w = wu * wv;
                DVec4::new(a * x * r * w, b * x * r * w, z * r * w, w)
            })
        })
        .collect();
    Surface::new((2, 2), ku, kv, points).unwrap()
}
fn main() {
    let plane = Surface::new(
        (1, 1),
        vec![-10., -10., 10., 10.],
        vec![-10., -10., 10., 10.],
        vec![(-10., -10.), (10., -10.), (-10., 10.), (10., 10.)]
            .into_iter()
            .map(|(x, y)| DVec4::new(x, y, -3., 1.))
            .collect(),
    )
    .unwrap();
    let sq: Vec<Bezier<DVec3>> = [(-10., -10.), (10., -10.), (10., 10.), (-10., 10.)]
        .windows(2)
        .map(|w| Bezier::line(DVec2::from(w[0]), DVec2::from(w[1])))
        .chain([Bezier::line(DVec2::new(-10., 10.), DVec2::new(-10., -10.))])
        .collect();
    let (_, pu) = arc4();
    let hole: Vec<Bezier<DVec3>> = (0..4)
        .map(|k| Bezier {
            points: pu[2 * k..2 * k + 3]
                .iter()
                .map(|&(x, y, w)| DVec3::new((x * 4. + 2.) * w, (y * 4. + 2.) * w, w))
                .collect(),
        })
        .collect();
    let snap = DVec2::splat(1e-9);
    let loops = vec![TrimLoop::new(sq, snap).unwrap(), TrimLoop::new(hole, snap).unwrap().reversed()];
    let face = |id, surface, loops, kind| Face { id, kind, surface, loops, same_sense: true, colour: None };
    let model = Model {
        name: "t".into(),
        parts: vec![Part {
            name: "p".into(),
            closed: false,
            faces: vec![face(1, sphere(3.0), vec![], SurfaceKind::Sphere), face(2, plane, loops, SurfaceKind::Plane)],
        }],
        instances: vec![Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() }],
        unit: "mm".into(),
    };
    let mut r = HeadlessRenderer::new(&HeadlessOptions { device: None, validation: true }).unwrap();
    r.upload(&model).unwrap();
    let cam = Camera::framing(model.bounds(), DVec3::new(1., -2., 1.5), DVec3::Z, 0.6, (960, 720));
    let pic = r.render(&cam, &FrameSettings::default(), Outputs::ALL).unwrap();
    println!("{:#?}", pic.stats);
    let mut s = format!("P6\n{} {}\n255\n", pic.size.0, pic.size.1).into_bytes();
    s.extend(pic.colour.iter().flat_map(|c| [c[0], c[1], c[2]]));
    std::fs::write("/tmp/first.ppm", s).unwrap();
    println!("{:#?}", r.shutdown());
}
