//! The assembly as a tree: sub-assemblies by the names of their occurrences, bodies by their own.
//!
//! ```text
//!   instances "stand/bolt:1"  bolt        pump
//!             "stand/bolt:2"  bolt   ─▶   └─ stand
//!             "stand/plate"   plate          ├─ bolt x 2
//!                                            └─ plate
//! ```
//!
//! Occurrences side by side that hold the same are one line with all their names.

use selvedge::model::{Instance, Model};
use serde::Serialize;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// An occurrence and what stands in it.
#[derive(Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct Node<'a> {
    /// Names of the occurrences alike; the root has the model's.
    pub names: Vec<&'a str>,
    /// Bodies in it, in the order of their first instance.
    pub bodies: Vec<Body<'a>>,
    /// Occurrences in it.
    pub children: Vec<Node<'a>>,
}

/// One body in one occurrence.
#[derive(Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Body<'a> {
    /// Index into the model's parts.
    pub part: usize,
    /// Its name, or that of the occurrence.
    pub name: &'a str,
    /// How often it stands there.
    pub count: usize,
}

/// Names listed of like occurrences before the rest is only counted.
const NAMES: usize = 4;

impl<'a> Node<'a> {
    /// The tree of all instances.
    pub fn new(model: &'a Model) -> Self {
        let mut root = Self { names: vec![&model.name], ..Self::default() };
        let all: Vec<_> = model.instances.iter().map(|i| (i, i.name.as_str())).collect();
        root.fill(model, &all);
        root
    }

    /// Adds instances, given with the part of their path below this node.
    fn fill(&mut self, model: &'a Model, instances: &[(&'a Instance, &'a str)]) {
        let mut inner: Vec<(&str, Vec<_>)> = Vec::new();
        let mut bodies = HashMap::new();
        for &(instance, path) in instances {
            match path.split_once('/') {
                // occurrences of a file follow one another
                Some((first, rest)) => match inner.last_mut().filter(|(name, _)| *name == first) {
                    Some((_, list)) => list.push((instance, rest)),
                    None => inner.push((first, vec![(instance, rest)])),
                },
                None => self.body(model, instance, path, &mut bodies),
            }
        }
        let mut alike = HashMap::new();
        for (name, list) in inner {
            let mut child = Self { names: vec![name], ..Self::default() };
            child.fill(model, &list);
            let first = *alike.entry(child.content()).or_insert(self.children.len());
            match self.children.get_mut(first) {
                Some(twin) if twin.bodies == child.bodies && twin.children == child.children => twin.names.push(name),
                _ => self.children.push(child),
            }
        }
    }

    /// A hash of what stands in it, without its names.
    fn content(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (&self.bodies, &self.children).hash(&mut hasher);
        hasher.finish()
    }

    fn body(&mut self, model: &'a Model, at: &'a Instance, occurrence: &'a str, known: &mut HashMap<usize, usize>) {
        if let Some(&index) = known.get(&at.part) {
            self.bodies[index].count += 1;
            return;
        }
        known.insert(at.part, self.bodies.len());
        let own = model.parts[at.part].name.as_str();
        let name = [own, occurrence].into_iter().find(|n| !n.is_empty()).unwrap_or("(no name)");
        self.bodies.push(Body { part: at.part, name, count: 1 });
    }

    /// Indented lines, without one at the end.
    pub fn text(&self) -> String {
        let mut text = self.label();
        self.lines("", &mut text);
        text
    }

    fn label(&self) -> String {
        let label = self.names.iter().take(NAMES).copied().collect::<Vec<_>>().join(", ");
        match self.names.len() {
            1 => label,
            n if n <= NAMES => format!("{label} ({n} alike)"),
            n => format!("{label}, ... ({n} alike)"),
        }
    }

    fn lines(&self, indent: &str, text: &mut String) {
        let mut left = self.bodies.len() + self.children.len();
        let mut line = |label: &str, text: &mut String| {
            left -= 1;
            let (branch, below) = if left > 0 { ("├─ ", "│  ") } else { ("└─ ", "   ") };
            text.push_str(&format!("\n{indent}{branch}{label}"));
            format!("{indent}{below}")
        };
        for body in &self.bodies {
            let count = if body.count > 1 { format!(" x {}", body.count) } else { String::new() };
            line(&format!("{}{count}", body.name), text);
        }
        for child in &self.children {
            let below = line(&child.label(), text);
            child.lines(&below, text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;
    use selvedge::model::Part;

    fn model(parts: &[&str], instances: &[(usize, &str)]) -> Model {
        let part = |name: &&str| Part { name: (*name).into(), ..Part::default() };
        let instance = |&(part, name): &(usize, &str)| Instance {
            part,
            name: name.into(),
            transform: DAffine3::IDENTITY,
            colour: None,
        };
        Model {
            name: "pump".into(),
            parts: parts.iter().map(part).collect(),
            instances: instances.iter().map(instance).collect(),
            ..Model::default()
        }
    }

    #[test]
    fn copies_are_counted_and_twins_joined() {
        let instances =
            [(1, "plate"), (0, "left/bolt:1"), (0, "left/bolt:2"), (0, "right/bolt:3"), (0, "right/bolt:4"), (2, "")];
        let model = model(&["bolt", "plate", ""], &instances);
        let tree = Node::new(&model);
        assert_eq!(
            tree.text(),
            "pump\n\
             ├─ plate\n\
             ├─ (no name)\n\
             └─ left, right (2 alike)\n   \
                └─ bolt x 2"
        );
        assert_eq!(tree.children[0].bodies[0].count, 2);
    }

    #[test]
    fn an_empty_model_is_its_name() {
        assert_eq!(Node::new(&model(&[], &[])).text(), "pump");
    }
}
