//! Opacity by name, for parts and faces that hide others.

use super::{Colour, GREY, Model, Part, Shape, Solid};
use std::sync::Arc;

/// No part, face or primitive has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("nothing is called `{name}`; there are {known}")]
pub struct UnknownName {
    /// The name.
    pub name: String,
    /// The names that exist.
    pub known: String,
}

/// Names listed in a message; the rest is counted.
const MOST_LISTED: usize = 20;

impl Model {
    /// Gives the opacity `alpha`, from 0 to 1, to everything of a name: occurrences of that name, or whose part has it;
    /// and for `#N` all faces, meshes and primitives of that number, as in the face image. If an occurrence has a
    /// colour as a whole and one of its faces is named, all of the occurrence becomes transparent. Transparent objects
    /// need an inside: see [`Items::open`](super::Items::open).
    ///
    /// # Errors
    /// [`UnknownName`] lists the names that exist; the model is unchanged.
    pub fn xray(&mut self, names: &[&str], alpha: f32) -> Result<(), UnknownName> {
        let alpha = alpha.clamp(0.0, 1.0);
        let mut changed = self.clone();
        for name in names {
            let found = match name.strip_prefix('#').map(str::parse::<u32>) {
                Some(Ok(number)) => changed.xray_number(number, alpha),
                _ => changed.xray_name(name, alpha),
            };
            if !found {
                return Err(UnknownName { name: (*name).to_owned(), known: self.known() });
            }
        }
        *self = changed;
        Ok(())
    }

    fn xray_name(&mut self, name: &str, alpha: f32) -> bool {
        let mut found = false;
        for i in 0..self.instances.len() {
            let Some(part) = self.parts.get(self.instances[i].part) else { continue };
            if !name.is_empty() && (self.instances[i].name == name || part.name == name) {
                found = true;
                self.xray_instance(i, alpha);
            }
        }
        found
    }

    fn xray_instance(&mut self, i: usize, alpha: f32) {
        if let Some(colour) = &mut self.instances[i].colour {
            colour[3] = alpha;
            return;
        }
        // other occurrences keep theirs
        let Some(mut clear) = self.parts.get(self.instances[i].part).cloned() else { return };
        clear.set_opacity(alpha, |_| true);
        self.instances[i].part = self.parts.len();
        self.parts.push(clear);
    }

    /// The opacity of some instances and solids, for scene files.
    pub fn xray_placed(&mut self, instances: std::ops::Range<usize>, solids: std::ops::Range<usize>, alpha: f32) {
        instances.for_each(|i| self.xray_instance(i, alpha));
        self.solids[solids].iter_mut().for_each(|s| s.set_opacity(alpha, |_| true));
    }

    fn xray_number(&mut self, number: u32, alpha: f32) -> bool {
        let mut found = false;
        for (index, part) in self.parts.iter_mut().enumerate() {
            if part.set_opacity(alpha, |id| id == number) {
                found = true;
                let placed = self.instances.iter_mut().filter(|i| i.part == index);
                placed.filter_map(|i| i.colour.as_mut()).for_each(|colour| colour[3] = alpha);
            }
        }
        for solid in &mut self.solids {
            if solid.primitives().iter().any(|p| p.id == number) {
                found = true;
                solid.set_opacity(alpha, |id| id == number);
            }
        }
        found
    }

    /// The names that exist, for a message.
    fn known(&self) -> String {
        let own = self.placed_parts().flat_map(|(i, part)| [&i.name, &part.name]);
        let mut names: Vec<String> = own.filter(|n| !n.is_empty()).map(|n| format!("`{n}`")).collect();
        let faces = self.parts.iter().flat_map(|p| p.faces.iter().map(|f| f.id).chain(p.meshes.iter().map(|m| m.id)));
        let mut numbers: Vec<u32> = faces.chain(self.solids.iter().flat_map(Solid::primitives).map(|p| p.id)).collect();
        names.sort();
        names.dedup();
        numbers.sort_unstable();
        numbers.dedup();
        names.extend(numbers.iter().map(|n| format!("#{n}")));
        let more = names.len().saturating_sub(MOST_LISTED);
        names.truncate(MOST_LISTED);
        let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
        if names.is_empty() { "none".into() } else { names.join(", ") + &rest }
    }
}

impl Part {
    /// Sets the opacity of chosen faces and meshes; whether there were any.
    fn set_opacity(&mut self, alpha: f32, chosen: impl Fn(u32) -> bool) -> bool {
        let faces = self.faces.iter_mut().map(|f| (f.id, &mut f.colour));
        let all = faces.chain(self.meshes.iter_mut().map(|m| (m.id, &mut m.colour)));
        let mut any = false;
        for (_, colour) in all.filter(|(id, _)| chosen(*id)) {
            let [r, g, b, _]: Colour = colour.unwrap_or(GREY);
            *colour = Some([r, g, b, alpha]);
            any = true;
        }
        any
    }
}

impl Solid {
    /// Sets the opacity of chosen primitives.
    fn set_opacity(&mut self, alpha: f32, chosen: impl Fn(u32) -> bool) {
        for p in self.primitives.iter_mut().filter(|p| chosen(p.id)) {
            p.colour[3] = alpha;
            if let Shape::Part(part) = &mut p.shape {
                Arc::make_mut(part).set_opacity(alpha, |_| true);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Instance, Primitive};
    use glam::DAffine3;

    fn model() -> Model {
        let ball = |id| {
            let (shape, transform) = (Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY);
            Solid::of(Primitive { shape, transform, colour: GREY, id }).unwrap()
        };
        let placed = |name: &str, colour| {
            let transform = DAffine3::IDENTITY;
            Instance { part: 0, transform, colour, name: name.into() }
        };
        let positions = vec![glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z];
        let mesh = crate::model::Mesh::new(7, positions, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], vec![]);
        let part = Part { name: "bolt".into(), meshes: vec![mesh.unwrap()], closed: true, ..Part::default() };
        Model {
            parts: vec![part],
            instances: vec![placed("left", None), placed("right", Some(GREY))],
            solids: vec![ball(3), ball(4)],
            ..Model::default()
        }
    }

    /// Opacities of the instances' meshes, then of the solids.
    fn opacities(m: &Model) -> Vec<f32> {
        let parts = m.instances.iter().map(|i| i.colour.or(m.parts[i.part].meshes[0].colour).map_or(1.0, |c| c[3]));
        parts.chain(m.solids.iter().map(|s| s.primitives()[0].colour[3])).collect()
    }

    #[test]
    fn one_occurrence_all_of_a_part_or_a_number() {
        for (names, expected) in [
            (&["left"][..], [0.25, 1.0, 1.0, 1.0]),
            (&["right"], [1.0, 0.25, 1.0, 1.0]),
            (&["bolt"], [0.25, 0.25, 1.0, 1.0]),
            (&["#7"], [0.25, 0.25, 1.0, 1.0]),
            (&["#4", "left"], [0.25, 1.0, 1.0, 0.25]),
        ] {
            let mut m = model();
            m.xray(names, 0.25).unwrap();
            assert_eq!(opacities(&m), expected, "{names:?}");
        }
    }

    #[test]
    fn an_absent_name_is_reported_with_the_present_ones() {
        let mut m = model();
        let error = m.xray(&["#3", "nut"], 0.5).unwrap_err();
        assert_eq!(error.to_string(), "nothing is called `nut`; there are `bolt`, `left`, `right`, #3, #4, #7");
        assert_eq!(m, model());
        assert_eq!(m.xray(&["#9"], 0.5).unwrap_err().name, "#9");
        assert_eq!(m.xray(&[""], 0.5).unwrap_err().name, "");
    }
}
