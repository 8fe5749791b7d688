//! Undo and redo of plain data: whole states, since they are small.

/// Most states that are kept.
const MOST: usize = 200;

/// A state with those before it and those that were undone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History<T> {
    before: Vec<T>,
    now: T,
    undone: Vec<T>,
}

impl<T: Clone + PartialEq> History<T> {
    /// A state without a past.
    pub fn new(now: T) -> Self {
        Self { before: Vec::new(), now, undone: Vec::new() }
    }

    /// The state.
    pub fn now(&self) -> &T {
        &self.now
    }

    /// The state, and all that undo and redo lead to.
    pub fn states(&self) -> impl Iterator<Item = &T> {
        self.before.iter().chain([&self.now]).chain(&self.undone)
    }

    /// Makes a change that can be undone; what was undone before is gone. A change that changes nothing is none.
    pub fn change(&mut self, change: impl FnOnce(&mut T)) {
        let mut next = self.now.clone();
        change(&mut next);
        if next == self.now {
            return;
        }
        self.undone.clear();
        let before = std::mem::replace(&mut self.now, next);
        self.keep(before);
    }

    /// Keeps a state to undo to, and forgets the oldest of too many.
    fn keep(&mut self, state: T) {
        if self.before.len() == MOST {
            self.before.remove(0);
        }
        self.before.push(state);
    }

    /// A drag begins: what [`go_on`](Self::go_on) does from now on is one change.
    pub fn begin(&mut self) {
        self.undone.clear();
        self.keep(self.now.clone());
    }

    /// Goes on with the change made last, as a drag does: no state of its own.
    pub fn go_on(&mut self, change: impl FnOnce(&mut T)) {
        change(&mut self.now);
    }

    /// Back to the state before; false where there is none.
    pub fn undo(&mut self) -> bool {
        // a drag that led back is no change
        while self.before.last() == Some(&self.now) {
            self.before.pop();
        }
        let Some(before) = self.before.pop() else { return false };
        self.undone.push(std::mem::replace(&mut self.now, before));
        true
    }

    /// Forward again.
    pub fn redo(&mut self) -> bool {
        let Some(next) = self.undone.pop() else { return false };
        self.before.push(std::mem::replace(&mut self.now, next));
        true
    }

    /// Whether there is something to undo, and to redo.
    pub fn has(&self) -> (bool, bool) {
        (!self.before.is_empty(), !self.undone.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_undone_and_redone_in_order() {
        let mut history = History::new(0);
        assert!(!history.undo() && !history.redo());
        history.change(|x| *x = 1);
        history.change(|x| *x = 2);
        history.change(|x| *x = 2);
        history.go_on(|x| *x = 3);
        assert!(history.undo() && *history.now() == 1);
        assert_eq!(history.states().collect::<Vec<_>>(), [&0, &1, &3]);
        assert!(history.redo() && *history.now() == 3);
        assert!(history.undo() && history.undo() && !history.undo());
        assert_eq!(*history.now(), 0);
        history.change(|x| *x = 9);
        assert!(!history.redo(), "a change ends what was undone");
        assert_eq!(history.has(), (true, false));
        (0..300).for_each(|i| history.change(|x| *x = 100 + i));
        assert_eq!((0..400).filter(|_| history.undo()).count(), MOST);
        let mut dragged = History::new(0);
        dragged.begin();
        (1..5).for_each(|i| dragged.go_on(|x| *x = i));
        dragged.begin();
        assert!(dragged.undo() && *dragged.now() == 0 && !dragged.undo());
    }

    /// Drags and changes share one list.
    #[test]
    fn no_more_states_are_kept_than_the_limit() {
        let mut dragged = History::new(0);
        for i in 1..=2 * MOST {
            dragged.begin();
            dragged.go_on(|x| *x = i);
        }
        assert_eq!(dragged.states().count(), MOST + 1);
        assert_eq!(std::iter::repeat_with(|| dragged.undo()).take_while(|undone| *undone).count(), MOST);
        assert_eq!((*dragged.now(), dragged.states().count()), (MOST, MOST + 1));
    }
}
