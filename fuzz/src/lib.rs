//! What must hold of whatever a file reader gives, be it never so damaged.

use selvedge_io::import::{Import, ImportError};
use selvedge_io::native;

/// Panics unless the result is an error that says something, or a model that keeps its invariants: the
/// engine's own form checks them all when it reads back what it has written.
pub fn sound(result: Result<Import, ImportError>) {
    match result {
        Ok(import) => {
            assert!(import.model.face_count() <= import.report.faces, "more faces than were found");
            let stored = native::write(&import.model);
            let back = native::read(&stored).expect("a reader made a model that is not valid");
            assert!(native::write(&back) == stored, "the model changed on its way");
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
