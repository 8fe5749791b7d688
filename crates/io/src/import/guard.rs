//! Guards that keep the mapping of entities finite.
//!
//! Entities form a graph that a hostile file can close or share at will. The trail of the entities that are being mapped
//! finds cycles, its length is bounded, and work comes from a budget that is a multiple of the parameters in the file.

use std::cell::{Cell, RefCell};

/// Uses of an average parameter. Real files share surfaces among a few dozen faces at most.
const SHARING: u64 = 64;

/// Work that even the smallest file may do.
const FREE_WORK: u64 = 1 << 20;

/// Largest number of instances of a model; a few kilobytes of text can ask for 2^60.
pub(super) const MAX_INSTANCES: usize = 1 << 20;

/// Why an entity is not mapped to its end.
#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum Endless {
    #[error("#{0} refers to itself")]
    Cycle(u32),
    #[error("#{0} is nested deeper than {1} levels")]
    Depth(u32, usize),
    #[error("#{0}: entities are shared so often that the file would not end")]
    Exhausted(u32),
}

/// The guards of a file.
#[derive(Debug)]
pub(super) struct Guard {
    work: Cell<u64>,
    trail: RefCell<Vec<u32>>,
    most_levels: usize,
}

impl Guard {
    /// Of a file with so many parameters. `most_levels`: the longest chain of entities that define one another.
    pub fn new(parameters: usize, most_levels: usize) -> Self {
        let work = Cell::new(FREE_WORK + SHARING * parameters as u64);
        Self { work, trail: RefCell::default(), most_levels }
    }

    /// Takes `amount` of work for `#id` from the budget.
    pub fn spend(&self, id: u32, amount: usize) -> Result<(), Endless> {
        let left = self.work.get().checked_sub(amount as u64).ok_or(Endless::Exhausted(id))?;
        self.work.set(left);
        Ok(())
    }

    /// Runs `f` with `#id` on the trail, for `amount` of work; `fault` makes an error of the format's.
    pub fn nested<T, F>(
        &self,
        id: u32,
        amount: usize,
        fault: fn(Endless) -> F,
        f: impl FnOnce() -> Result<T, F>,
    ) -> Result<T, F> {
        {
            let mut trail = self.trail.borrow_mut();
            if trail.contains(&id) {
                return Err(fault(Endless::Cycle(id)));
            }
            if trail.len() >= self.most_levels {
                return Err(fault(Endless::Depth(id, self.most_levels)));
            }
            trail.push(id);
        }
        let result = self.spend(id, amount).map_err(fault).and_then(|()| f());
        self.trail.borrow_mut().pop();
        result
    }
}
