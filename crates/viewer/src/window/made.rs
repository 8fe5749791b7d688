//! Destroys what was made so far where a later step fails.

/// Calls that destroy, the last one first, unless all was made.
#[derive(Default)]
pub struct Made(Vec<Box<dyn FnOnce()>>);

impl Made {
    /// `destroy` gets a copy of `owner`.
    pub fn push<T: Clone + 'static>(&mut self, owner: &T, destroy: impl FnOnce(&T) + 'static) {
        let owner = owner.clone();
        self.0.push(Box::new(move || destroy(&owner)));
    }

    /// All was made.
    pub fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for Made {
    fn drop(&mut self) {
        while let Some(destroy) = self.0.pop() {
            destroy();
        }
    }
}
