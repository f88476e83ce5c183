//! Messages at rest: those of each type side by side in a row of their own, and one list that keeps
//! the order between the rows.
//!
//! ```text
//! order    1 1 0 1
//! row 0    [resize]                each row an array of one type,
//! row 1    [edit][edit][edit]      whose room is used again and again
//! ```
//!
//! So a message is moved, not boxed: storing it allocates nothing once its row has grown, and a
//! thread still has one queue for all types. The box that forgets the type is around the row.

use crate::Context;
use crate::object::short_type_name;
use crate::trace::Stamped;
use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What is stored until the thread's next iteration: a message of the thesis (§3.2.6.4), that is
/// whom it is for, and data of one type.
pub(crate) struct Letter<C> {
    /// The receiver's number; 0 for the thread itself.
    pub(crate) to: u32,
    /// Who sent it and when; only when the thread that gets it is traced.
    pub(crate) stamp: Stamped,
    pub(crate) content: C,
}

/// What a letter may hold: it knows what to do when its turn comes.
pub(crate) trait Content: Send + 'static {
    /// The type of the message, or what is asked of the thread.
    fn name(&self) -> &'static str;

    /// Its turn has come.
    fn deliver(self, to: u32, stamp: Stamped, thread: &mut Context);

    /// Its turn will not come: how many messages of the program (not of the runtime) that was.
    fn discard(self) -> usize;
}

/// What a message of the program is wrapped in while it waits: all that is left is to open it.
pub(crate) trait Wrapped: Send + 'static {
    type Message: Send + 'static;

    /// The message; `None` when it was taken out meanwhile.
    fn open(self) -> Option<Self::Message>;
}

impl<W: Wrapped> Content for W {
    fn name(&self) -> &'static str {
        short_type_name::<W::Message>()
    }

    fn deliver(self, to: u32, stamp: Stamped, thread: &mut Context) {
        if let Some(message) = self.open() {
            thread.resolve_message(to, message, stamp);
        }
    }

    fn discard(self) -> usize {
        usize::from(self.open().is_some())
    }
}

/// Letters in the order in which they were stored.
#[derive(Default)]
pub(crate) struct Batch {
    /// The row of each.
    order: VecDeque<u32>,
    /// By number; `None` where nothing of that type has come yet.
    rows: Vec<Option<Box<dyn Row>>>,
    /// How many there were at most, which is how many there is room for.
    most: usize,
}

/// Letters of one type, which is forgotten.
trait Row: Any + Send {
    fn describe(&self, place: usize) -> (u32, &'static str);
    fn deliver(&mut self, place: usize, thread: &mut Context);
    fn append(&mut self, newer: &mut dyn Row);
    fn discard(&mut self) -> usize;
}

/// Room for so many letters is always kept; room for more is given back when it is no longer used.
const KEPT: usize = 4096;

impl Batch {
    /// Stores `letter` in row number `row`, which holds its type.
    pub(crate) fn push<C: Content>(&mut self, row: u32, letter: Letter<C>) {
        self.order.push_back(row);
        let row = row as usize;
        if self.rows.len() <= row {
            self.rows.resize_with(row + 1, || None);
        }
        let letters = self.rows[row].get_or_insert_with(|| Box::new(VecDeque::<Letter<C>>::new()));
        let letters: &mut dyn Any = &mut **letters;
        letters.downcast_mut::<VecDeque<_>>().expect("a row is of one type").push_back(letter);
    }

    pub(crate) fn len(&self) -> usize {
        self.order.len()
    }

    /// Puts all of `newer` behind what is here; `newer` is empty then, and has room.
    pub(crate) fn append(&mut self, newer: &mut Self) {
        if self.order.is_empty() {
            std::mem::swap(self, newer);
        }
        self.rows.resize_with(self.rows.len().max(newer.rows.len()), || None);
        for (mine, theirs) in self.rows.iter_mut().zip(&mut newer.rows) {
            match (&mut *mine, theirs) {
                (Some(mine), Some(theirs)) => mine.append(&mut **theirs),
                (_, theirs) => *mine = mine.take().or(theirs.take()),
            }
        }
        self.order.append(&mut newer.order);
    }

    /// Delivers the letter at `index` before all others; `false` when there is none. It is out of
    /// the batch before that, so that a panic takes no other with it.
    pub(crate) fn deliver(&mut self, index: usize, thread: &mut Context) -> bool {
        let Some(row) = self.order.remove(index) else { return false };
        let place = self.place(row, index);
        self.rows[row as usize].iter_mut().for_each(|row| row.deliver(place, thread));
        true
    }

    /// Whom each letter is for, and its name, in order.
    pub(crate) fn describe(&self) -> impl Iterator<Item = (u32, &'static str)> {
        self.order.iter().enumerate().filter_map(|(index, row)| {
            let place = self.place(*row, index);
            Some(self.rows[*row as usize].as_ref()?.describe(place))
        })
    }

    /// Where in its row the letter at `index` of all is.
    fn place(&self, row: u32, index: usize) -> usize {
        self.order.iter().take(index).filter(|other| **other == row).count()
    }

    /// Throws everything away: how many messages of the program that was.
    pub(crate) fn discard(mut self) -> usize {
        self.rows.iter_mut().flatten().map(|row| row.discard()).sum()
    }

    /// Gives the memory of a flood back, once batches have become small again: this one, which
    /// is empty now, had `letters`.
    pub(crate) fn shrink(&mut self, letters: usize) {
        self.most = self.most.max(letters);
        if self.most > KEPT && letters < self.most / 4 && self.order.is_empty() {
            *self = Self::default();
        }
    }
}

impl<C: Content> Row for VecDeque<Letter<C>> {
    fn describe(&self, place: usize) -> (u32, &'static str) {
        (self[place].to, self[place].content.name())
    }

    fn deliver(&mut self, place: usize, thread: &mut Context) {
        if let Some(Letter { to, stamp, content }) = self.remove(place) {
            content.deliver(to, stamp, thread);
        }
    }

    fn append(&mut self, newer: &mut dyn Row) {
        let newer: &mut dyn Any = newer;
        Self::append(self, newer.downcast_mut().expect("rows of one number are of one type"));
    }

    fn discard(&mut self) -> usize {
        // One that panics when it is dropped is dropped all the same, and the others after it.
        let discard = |letter: Letter<C>| catch_unwind(AssertUnwindSafe(|| letter.content.discard()));
        self.drain(..).map(|letter| discard(letter).unwrap_or(1)).sum()
    }
}
