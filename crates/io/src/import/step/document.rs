//! Documents: files in which the shape of a product stands.
//!
//! ```text
//!   DOCUMENT_FILE('id','name',…)                          DOCUMENT_PRODUCT_EQUIVALENCE(…,document,version)
//!     ▲ ▲ ▲                                                 and PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS
//!     │ │ └ APPLIED_DOCUMENT_REFERENCE(file,'',(product))    (…,version,…,(files)): a document with files of its own
//!     │ └── PROPERTY_DEFINITION('external definition','',file) ◀ PROPERTY_DEFINITION_REPRESENTATION(…,shape)
//!     └──── APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT('name',role,EXTERNAL_SOURCE(IDENTIFIER('where')),(file))
//! ```
//!
//! Writers put the file's name into any of the four strings: CATIA into the document's id and the assignment, Creo into
//! these and the source with a title as the document's name, others into a single one. All strings are kept, the
//! likeliest first. A product may be referred to by its definition, its version or itself.
//!
//! A document counts only for a product without content in this file: it has neither a body nor a part placed in it.
//!
//! Source: CAx-IF Recommended Practices for external references; PDM Schema usage guide, 9.

use super::entity::{Entity, Fault};
use super::geometry::Ledger;
use super::part21::{File, Value};
use super::product::Products;
use std::collections::{BTreeMap, BTreeSet};

/// The documents of a file, and their products.
#[derive(Debug, Default)]
pub(super) struct Documents {
    /// Names of each document's file, the likeliest first; none is blank.
    pub names: BTreeMap<u32, Vec<String>>,
    /// Documents by the representation whose shape they hold.
    pub of_shape: BTreeMap<u32, BTreeSet<u32>>,
}

impl Documents {
    /// Reads all documents; `products` say which representation is whose.
    pub fn read(file: &File<'_>, ledger: &Ledger<'_>, products: &Products) -> Self {
        let mut this = Self::default();
        let told = |kind: &str, f: &mut dyn FnMut(Entity<'_>) -> Result<(), Fault>| {
            for id in file.of_kind(kind) {
                if let Err(fault) = Entity::find(file, id).and_then(&mut *f) {
                    ledger.note("document ignored", id, fault.to_string());
                }
            }
        };
        let mut own: BTreeMap<u32, Vec<String>> = BTreeMap::new();
        told("DOCUMENT_FILE", &mut |document| {
            let fields = document.fields("DOCUMENT", 0).unwrap_or_else(|_| document.all());
            own.insert(document.id(), (0..3).map(|i| fields.text(i)).collect());
            Ok(())
        });
        if own.is_empty() {
            return this;
        }
        told("APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT", &mut |assignment| {
            let fields = assignment.all();
            let name = fields.text(0);
            let source = fields.optional(2).and_then(|id| Entity::find(file, id).ok()).map(|s| s.all().text(0));
            let source = source.filter(|s| !s.trim().is_empty());
            let inside = source.as_ref().map(|s| format!("{}/{name}", s.trim_end_matches(['/', '\\'])));
            for document in fields.references(3)? {
                let names = [inside.clone(), Some(name.clone()), source.clone()];
                this.names.entry(document?).or_default().extend(names.into_iter().flatten());
            }
            Ok(())
        });
        this.names.retain(|document, _| own.contains_key(document));
        for (document, names) in own {
            this.names.entry(document).or_default().extend(names);
        }
        for names in this.names.values_mut() {
            let mut seen = BTreeSet::new();
            names.retain(|n| !n.trim().is_empty() && seen.insert(n.clone()));
            // a name with an ending is more likely a file's
            names.sort_by_key(|n| !n.contains('.'));
        }
        // files of documents that are products of their own
        let mut files: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        told("PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS", &mut |definition| {
            let fields = definition.all();
            let version = fields.reference(2)?;
            for document in fields.references(4)? {
                files.entry(version).or_default().push(document?);
            }
            Ok(())
        });
        let mut of_document: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        told("DOCUMENT_PRODUCT_EQUIVALENCE", &mut |equivalence| {
            let fields = equivalence.all();
            let (document, version) = (fields.reference(2)?, fields.reference(3)?);
            of_document.entry(document).or_default().extend(files.get(&version).into_iter().flatten());
            Ok(())
        });
        let shapes = shapes(file, products);
        let mut add = |document: u32, item: u32| {
            let files = of_document.get(&document).cloned().unwrap_or_else(|| vec![document]);
            let files: Vec<u32> = files.into_iter().filter(|f| this.names.contains_key(f)).collect();
            for shape in shapes.get(&item).into_iter().flatten() {
                this.of_shape.entry(*shape).or_default().extend(&files);
            }
        };
        told("APPLIED_DOCUMENT_REFERENCE", &mut |reference| {
            let fields = reference.all();
            let document = fields.reference(0)?;
            fields.references(2)?.try_for_each(|item| item.map(|item| add(document, item)))
        });
        for (version, documents) in &files {
            documents.iter().for_each(|document| add(*document, *version));
        }
        told("PROPERTY_DEFINITION_REPRESENTATION", &mut |property| {
            let fields = property.all();
            let definition = fields.optional(0).and_then(|id| Entity::find(file, id).ok());
            let document = definition.filter(|d| d.is("PROPERTY_DEFINITION")).and_then(|d| d.all().optional(2));
            if let (Some(document), Some(shape)) = (document, fields.optional(1)) {
                add(document, shape);
            }
            Ok(())
        });
        this
    }
}

/// Representations by each entity whose number may refer to them: themselves, their product definition, its version,
/// its product.
fn shapes(file: &File<'_>, products: &Products) -> BTreeMap<u32, Vec<u32>> {
    let mut shapes: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let third = |id: u32| Entity::find(file, id).ok()?.all().value(2).and_then(Value::reference);
    for (shape, definition) in &products.owner {
        let version = third(*definition);
        let product = version.and_then(third);
        for name in [Some(*shape), Some(*definition), version, product].into_iter().flatten() {
            shapes.entry(name).or_default().push(*shape);
        }
    }
    shapes
}
