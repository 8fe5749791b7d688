//! Exact descriptions of selected items, and the command that draws the view.

pub mod command;

use crate::session::{Picked, PointKind, Session, World};
use glam::{DVec2, DVec3};
use selvedge::model::{EdgeKind, Face, SurfaceKind};

/// Lines of a description: name and value.
pub type Description = Vec<(&'static str, String)>;

/// A number as the panels show it: 12 digits, without trailing zeros.
pub fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let digits = (11 - x.abs().log10().floor() as i32).clamp(0, 15) as usize;
    let text = format!("{x:.digits$}");
    let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text.as_str() };
    let short = if short == "-0" { "0" } else { short };
    short.to_owned()
}

/// A point or a direction.
pub fn vector(p: DVec3) -> String {
    p.to_array().map(number).join(", ")
}

/// The names of a face's knots along u and v.
pub const KNOTS: [&str; 2] = ["knots in u", "knots in v"];
/// Distinct knots that are listed of one direction.
const MOST_KNOTS: usize = 12;

/// A knot vector: each value once, with its multiplicity where that is more than 1. Knots are
/// compared exactly. After [`MOST_KNOTS`] values follows how many there are.
fn knots(knots: &[f64]) -> String {
    let values: Vec<&[f64]> = knots.chunk_by(|a, b| a == b).collect();
    let listed = values.iter().take(MOST_KNOTS).map(|same| match same {
        [one] => number(*one),
        _ => format!("{} ×{}", number(same[0]), same.len()),
    });
    let more = (values.len() > MOST_KNOTS).then(|| format!("… ({} in all)", values.len()));
    listed.chain(more).collect::<Vec<_>>().join(", ")
}

/// A face's kind in words.
pub fn kind(kind: SurfaceKind) -> &'static str {
    match kind {
        SurfaceKind::Plane => "plane",
        SurfaceKind::Cylinder => "cylinder",
        SurfaceKind::Cone => "cone",
        SurfaceKind::Sphere => "sphere",
        SurfaceKind::Torus => "torus",
        SurfaceKind::Revolution => "surface of revolution",
        SurfaceKind::Extrusion => "extrusion",
        SurfaceKind::Offset => "offset surface",
        SurfaceKind::BSpline => "B-spline surface",
    }
}

/// One line for the item under the cursor.
pub fn short(world: &World, picked: &Picked) -> String {
    let part = |instance: usize| &world.model.parts[world.model.instances[instance].part];
    match *picked {
        Picked::Face { instance, face, .. } => {
            let face = &part(instance).faces[face];
            format!("{} #{} of {}", kind(face.kind), face.id, world.instance_name(instance))
        }
        Picked::Edge { instance, edge } => {
            let edges = world.edges_of(world.model.instances[instance].part);
            let source = edges.and_then(|e| e.edges.get(edge)).and_then(|e| e.source);
            let number = source.map_or(format!("{}", edge + 1), |source| source.to_string());
            format!("edge {number} of {}", world.instance_name(instance))
        }
        Picked::Vertex { instance, vertex } => format!("vertex {} of {}", vertex + 1, world.instance_name(instance)),
        Picked::Point { instance, kind, of, .. } => {
            let (what, on) = match kind {
                PointKind::Centre => ("centre of", Picked::Edge { instance, edge: of }),
                PointKind::Middle => ("middle of", Picked::Edge { instance, edge: of }),
                PointKind::OnEdge => ("point on", Picked::Edge { instance, edge: of }),
                PointKind::OnFace => ("point on", Picked::Face { instance, face: of, uv: DVec2::ZERO }),
            };
            format!("{what} {}", short(world, &on))
        }
        Picked::Instance(instance) => world.instance_name(instance),
        Picked::Number { instance: Some(instance), id } => format!("face #{id} of {}", world.instance_name(instance)),
        Picked::Number { instance: None, id } => format!("face #{id} of a solid"),
    }
}

/// The whole description of an item.
pub fn long(world: &World, picked: &Picked) -> Description {
    let mut lines = Vec::new();
    if let Some(instance) = picked.instance() {
        lines.push(("part", world.instance_name(instance)));
    }
    match *picked {
        Picked::Face { instance, face, uv } => {
            let placed = &world.model.instances[instance];
            let part = &world.model.parts[placed.part];
            face_lines(&part.faces[face], &mut lines);
            let surface = &part.faces[face].surface;
            let jet = surface.jet2(uv.x, uv.y);
            lines.push(("(u, v)", format!("{}, {}", number(uv.x), number(uv.y))));
            lines.push(("point", vector(placed.transform.transform_point3(jet.point))));
            if let Some(normal) = surface.normal(uv.x, uv.y) {
                let outward = if part.faces[face].same_sense { normal } else { -normal };
                lines.push(("normal", vector(placed.transform.transform_vector3(outward).normalize())));
            }
        }
        Picked::Edge { instance, edge } => {
            let part = world.model.instances[instance].part;
            if let Some(edge) = world.edges_of(part).and_then(|edges| edges.edges.get(edge)) {
                let kind = match edge.kind {
                    EdgeKind::Sharp => "sharp edge",
                    EdgeKind::Smooth => "smooth edge",
                    EdgeKind::Seam => "seam",
                    EdgeKind::Border => "border",
                };
                lines.push(("edge", kind.to_owned()));
                lines.extend(edge.source.map(|source| ("in the file", source.to_string())));
                if edge.turn.is_finite() {
                    lines.push(("turns by", format!("{}°", number(edge.turn.to_degrees()))));
                }
                let faces = edge.uses.iter().map(|used| format!("#{}", world.model.parts[part].faces[used.face].id));
                lines.push(("faces", faces.collect::<Vec<_>>().join(", ")));
            }
        }
        Picked::Vertex { .. } | Picked::Point { .. } => {
            lines.extend(world.point_of(picked).map(|p| ("point", vector(p))));
        }
        Picked::Instance(instance) => {
            let part = &world.model.parts[world.model.instances[instance].part];
            lines.push(("faces", part.faces.len().to_string()));
            lines.push(("closed", if part.closed { "yes" } else { "no" }.to_owned()));
        }
        Picked::Number { id, .. } => lines.push(("in the file", format!("#{id}"))),
    }
    lines
}

fn face_lines(face: &Face, lines: &mut Description) {
    lines.push(("face", kind(face.kind).to_owned()));
    lines.push(("in the file", format!("#{}", face.id)));
    let ((pu, pv), (nu, nv)) = (face.surface.degrees(), face.surface.counts());
    lines.push(("degree", format!("{pu} x {pv}")));
    lines.push(("control points", format!("{nu} x {nv}")));
    let (u, v) = face.surface.knots();
    lines.extend([(KNOTS[0], knots(u)), (KNOTS[1], knots(v))]);
    lines.push(("rational", if face.surface.is_polynomial() { "no" } else { "yes" }.to_owned()));
    let curves: usize = face.loops.iter().map(|l| l.curves().count()).sum();
    lines.push(("trims", format!("{} loops, {curves} curves", face.loops.len())));
}

/// Points around the selection.
pub fn extent(session: &Session) -> Vec<DVec3> {
    let world = &session.world;
    let mut points = Vec::new();
    for picked in &session.selection {
        let Some(instance) = picked.instance().filter(|i| *i < world.model.instances.len()) else { continue };
        let placed = &world.model.instances[instance];
        let (part, transform) = (&world.model.parts[placed.part], session.scene.now().placement(instance, world));
        let bounds = match *picked {
            Picked::Face { face, .. } => part.faces[face].control_bounds(),
            Picked::Edge { edge, .. } => {
                let edge = world.edges_of(placed.part).and_then(|edges| edges.edges.get(edge));
                let ends = edge.into_iter().flat_map(|e| &e.curve).flat_map(|span| &span.piece.points);
                let own = ends.map(|p| p.truncate() / p.w);
                own.fold(selvedge::model::Bounds::EMPTY, selvedge::model::Bounds::with)
            }
            _ => part.control_bounds(),
        };
        if !bounds.is_empty() {
            points.extend(bounds.corners().map(|p| transform.transform_point3(p)));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;
    use selvedge::spline::Surface;

    #[test]
    fn numbers_have_the_digits_that_they_need() {
        let all = [0.0, 5.0, -0.5, 12.7, 1.0 / 3.0, 1234567.0, 2.0e-7, 25.4 / 3.0, -1e-17];
        let text = all.map(number);
        assert_eq!(text, ["0", "5", "-0.5", "12.7", "0.333333333333", "1234567", "0.0000002", "8.46666666667", "0"]);
    }

    #[test]
    fn knots_are_listed_once_with_their_multiplicities() {
        assert_eq!(knots(&[0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0]), "0 ×4, 0.5, 1 ×4");
        let ends: [f64; 2] = [1.0, 1.0 + f64::EPSILON];
        assert_eq!(knots(&ends), "1, 1", "two values, whose first twelve digits are the same");
        let of = |count: u32| knots(&(0..count).map(f64::from).collect::<Vec<_>>());
        assert_eq!(of(12), "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11");
        assert_eq!(of(40), "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, … (40 in all)");
    }

    /// Cubic of two spans along u, straight along v.
    #[test]
    fn a_face_has_its_degrees_and_knots() {
        let (along, across) = (vec![0.0, 0.0, 0.0, 0.0, 0.25, 2.0, 2.0, 2.0, 2.0], vec![-1.0, -1.0, 3.0, 3.0]);
        let point = |i: u32| DVec4::new(f64::from(i % 5), f64::from(i / 5), 0.0, 1.0);
        let surface = Surface::new((3, 1), along, across, (0..10).map(point).collect()).expect("a surface");
        let face = Face { id: 7, kind: SurfaceKind::BSpline, surface, loops: vec![], same_sense: true, colour: None };
        let mut lines = Vec::new();
        face_lines(&face, &mut lines);
        let of = |name: &str| lines.iter().find(|(what, _)| *what == name).map(|(_, value)| value.as_str());
        let told = ["degree", "control points", "knots in u", "knots in v"].map(of);
        assert_eq!(told, [Some("3 x 1"), Some("5 x 2"), Some("0 ×4, 0.25, 2 ×4"), Some("-1 ×2, 3 ×2")]);
    }
}
