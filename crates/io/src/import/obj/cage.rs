//! Control meshes: the polygons as the file has them, corner by corner, for subdivision.
//!
//! ```text
//!   v  f          vertices and polygons; texture and normal numbers are passed over
//!   o             a mesh of its own; vertices are shared by number within it
//!   t crease 2/1/0 a b s      OpenSubdiv's tag: the edge from vertex a to b (from 0) is sharp by s
//! ```
//!
//! Without one of its polygons a mesh is another surface, so an unreadable statement is an error here, not a warning.
//!
//! Source: Pixar, *OpenSubdiv* regression shapes, which write creases as tags in OBJ comments' place.

use super::{index, lines};
use crate::import::ImportError;
use glam::DVec3;
use std::collections::HashMap;

/// Polygons over shared vertices, as one object of a file has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cage {
    /// The object's name, or empty.
    pub name: String,
    /// The vertices that the polygons use, in the order of the file.
    pub positions: Vec<DVec3>,
    /// Numbers of the vertices of each polygon.
    pub faces: Vec<Vec<u32>>,
    /// Edges that stay sharp.
    pub creases: Vec<[u32; 2]>,
}

/// Sharpness from which OpenSubdiv takes a crease as sharp for ever.
const SHARP: f64 = 10.0;

/// An object while it is read: vertices by their number in the file.
#[derive(Default)]
struct Object {
    name: String,
    faces: Vec<Vec<usize>>,
    creases: Vec<[usize; 2]>,
}

/// Reads the polygons of OBJ text.
pub(in crate::import) fn read(bytes: &[u8], name: &str) -> Result<Vec<Cage>, ImportError> {
    let mut vertices: Vec<DVec3> = Vec::new();
    let mut objects: Vec<Object> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut current = String::new();
    for (line, text) in lines(bytes) {
        let wrong = |message: String| ImportError::Solid { file: name.to_owned(), line, message };
        let mut words = text.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        if keyword == "v" {
            let p: Option<Vec<f64>> = words.take(3).map(|w| w.parse::<f64>().ok().filter(|x| x.is_finite())).collect();
            let p = p.filter(|p| p.len() == 3).ok_or_else(|| wrong("a vertex without three finite numbers".into()))?;
            vertices.push(DVec3::from_slice(&p));
        } else if keyword == "o" {
            current = text.trim_start()[1..].trim().to_owned();
        } else if keyword == "f" || keyword == "t" {
            let at = *places.entry(current.clone()).or_insert(objects.len());
            if at == objects.len() {
                objects.push(Object { name: current.clone(), ..Object::default() });
            }
            let object = &mut objects[at];
            if keyword == "f" {
                let corner = |w: &str| index(w.split('/').next().unwrap_or_default(), vertices.len(), "vertex");
                object.faces.push(words.map(corner).collect::<Result<_, _>>().map_err(wrong)?);
            } else {
                let tag: Vec<&str> = words.collect();
                object.creases.extend(crease(&tag, vertices.len()).map_err(wrong)?);
            }
        }
    }
    let cages: Vec<Cage> = objects.into_iter().filter(|o| !o.faces.is_empty()).map(|o| o.cage(&vertices)).collect();
    if cages.is_empty() {
        return Err(ImportError::Nothing { file: name.to_owned(), format: "a polygon of Wavefront OBJ" });
    }
    Ok(cages)
}

/// The edge of a tag; `None` for a crease that is not sharp at all.
fn crease(tag: &[&str], vertices: usize) -> Result<Option<[usize; 2]>, String> {
    let ["crease", "2/1/0", a, b, sharpness] = tag else {
        return Err(format!("a tag that is not read: {:.40}", tag.join(" ")));
    };
    let end = |w: &str| w.parse().ok().filter(|v| *v < vertices).ok_or(format!("vertex {w:.20} of a crease"));
    let sharpness: f64 = sharpness.parse().map_err(|_| "a crease whose sharpness is no number".to_owned())?;
    if sharpness > 0.0 && sharpness < SHARP {
        return Err(format!(
            "a crease of sharpness {sharpness}: only those that stay sharp ({SHARP} and more) are read"
        ));
    }
    Ok((sharpness > 0.0).then_some([end(a)?, end(b)?]))
}

impl Object {
    fn cage(self, vertices: &[DVec3]) -> Cage {
        let mut used: Vec<usize> = self.faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        // a crease between vertices that no polygon of the object has: the check of the mesh refuses it
        used.extend(
            self.creases.iter().flatten().filter(|v| used.binary_search(v).is_err()).copied().collect::<Vec<_>>(),
        );
        let number: HashMap<usize, u32> = used.iter().enumerate().map(|(k, v)| (*v, k as u32)).collect();
        Cage {
            name: self.name,
            positions: used.iter().map(|v| vertices[*v]).collect(),
            faces: self.faces.iter().map(|f| f.iter().map(|v| number[v]).collect()).collect(),
            creases: self.creases.iter().map(|c| c.map(|v| number[&v])).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_keep_their_corners_and_objects_their_vertices() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no a\nf 1/1/1 2//2 3 4\nt crease 2/1/0 0 1 10\n\
                    v 5 0 0\nv 6 0 0\no b\nf -2 -1 3\no a\nf 4 3 2\n";
        let cages = read(text.as_bytes(), "a.obj").unwrap();
        assert_eq!(cages.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!(cages[0].faces, [vec![0, 1, 2, 3], vec![3, 2, 1]]);
        assert_eq!(cages[0].creases, [[0, 1]]);
        assert_eq!(cages[1].positions, [DVec3::new(1.0, 1.0, 0.0), DVec3::X * 5.0, DVec3::X * 6.0]);
        assert_eq!(cages[1].faces, [vec![1, 2, 0]]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, words) in [
            ("v 0 0 nan\n", "a.obj:1: a vertex without three finite numbers"),
            ("v 0 0\n", "a.obj:1: a vertex without"),
            ("v 0 0 0\n\nf 1 2 1\n", "a.obj:3: vertex 2 of 1"),
            ("v 0 0 0\nf 1 x 1\n", "a.obj:2: vertex x is no whole number"),
            ("v 0 0 0\nt crease 2/1/0 0 0 2.5\n", "a.obj:2: a crease of sharpness 2.5"),
            ("v 0 0 0\nt corner 1/1/0 0 3\n", "a.obj:2: a tag that is not read: corner"),
            ("v 0 0 0\nt crease 2/1/0 0 9 10\n", "a.obj:2: vertex 9 of a crease"),
            ("v 0 0 0\n", "a.obj: holds nothing that is a polygon"),
        ] {
            let message = read(text.as_bytes(), "a.obj").unwrap_err().to_string();
            assert!(message.contains(words), "{message} for {text:?}");
        }
    }
}
