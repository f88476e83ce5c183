//! Messages at rest: those of each type side by side in a row of their own, and one list that keeps
//! the order between the rows.
//!
//! ```text
//! order    2 of row 1, 1 of row 0, 1 of row 1
//! row 0    [resize]                each row an array of one type,
//! row 1    [edit][edit][edit]      whose room is used again and again
//! ```
//!
//! So a message is moved, not boxed: storing it allocates nothing once its row has grown, and a
//! thread still has one queue for all types. The box that forgets the type is around the row.

use crate::Context;
use crate::object::short_type_name;
use crate::sync::mutant;
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
    /// Which row, and how many of it one after the other.
    order: VecDeque<(u32, u32)>,
    /// By number; `None` where nothing of that type has come yet.
    rows: Vec<Option<Box<dyn Row>>>,
    len: usize,
    /// How many there were at most, which is how many there is room for.
    most: usize,
    /// How many batches in turn have left most of the room unused.
    calm: u32,
}

/// Letters of one type, which is forgotten.
trait Row: Any + Send {
    fn describe(&self, place: usize) -> (u32, &'static str);
    /// Delivers up to `count` from `place` on, while the thread takes them, and counts them off.
    fn deliver(&mut self, place: usize, count: &mut u32, thread: &mut Context);
    fn append(&mut self, newer: &mut dyn Row);
    fn discard(&mut self) -> usize;
}

/// Room for so many letters is always kept; room for more is given back after so many batches that
/// did not use it.
const KEPT: (usize, u32) = (4096, 16);

impl Batch {
    /// Stores `letter` in row number `row`, which holds its type.
    pub(crate) fn push<C: Content>(&mut self, row: u32, letter: Letter<C>) {
        match self.order.back_mut() {
            Some((last, count)) if *last == row => *count += 1,
            _ => self.order.push_back((row, 1)),
        }
        self.len += 1;
        let row = row as usize;
        if self.rows.len() <= row {
            self.rows.resize_with(row + 1, || None);
        }
        let letters = self.rows[row].get_or_insert_with(|| Box::new(VecDeque::<Letter<C>>::new()));
        let letters: &mut dyn Any = &mut **letters;
        letters.downcast_mut::<VecDeque<_>>().expect("a row is of one type").push_back(letter);
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Puts all of `newer` behind what is here; `newer` is empty then, and has room.
    pub(crate) fn append(&mut self, newer: &mut Self) {
        if self.len == 0 {
            return std::mem::swap(self, newer);
        }
        self.rows.resize_with(self.rows.len().max(newer.rows.len()), || None);
        for (mine, theirs) in self.rows.iter_mut().zip(&mut newer.rows) {
            match (&mut *mine, theirs) {
                (Some(mine), Some(theirs)) => mine.append(&mut **theirs),
                (_, theirs) => *mine = mine.take().or(theirs.take()),
            }
        }
        self.order.append(&mut newer.order);
        self.len += std::mem::take(&mut newer.len);
    }

    /// Delivers in order, while the thread takes it.
    pub(crate) fn deliver(&mut self, thread: &mut Context) {
        mutant!(self.reversed_batch(thread));
        while let Some((row, count)) = self.order.front_mut() {
            let before = *count;
            if let Some(row) = &mut self.rows[*row as usize] {
                // Counted off one by one, and outside of what a panic unwinds.
                thread.contain("message", "drop", |thread| row.deliver(0, count, thread));
            }
            self.len -= (before - *count) as usize;
            if *count == before {
                return;
            } else if *count == 0 {
                self.order.pop_front();
            }
        }
    }

    /// Delivers the letter at `index` of [`describe`](Self::describe) before all others; `false`
    /// when there is none, or the thread takes none.
    pub(crate) fn deliver_at(&mut self, index: usize, thread: &mut Context) -> bool {
        let Some((run, row, place)) = self.places().nth(index) else { return false };
        let mut left = 1;
        self.rows[row].iter_mut().for_each(|row| row.deliver(place, &mut left, thread));
        self.order[run].1 -= 1 - left;
        self.order.retain(|(_, count)| *count > 0);
        self.len -= (1 - left) as usize;
        left == 0
    }

    /// Whom each letter is for, and its name, in order.
    pub(crate) fn describe(&self) -> impl Iterator<Item = (u32, &'static str)> {
        self.places().filter_map(|(_, row, place)| Some(self.rows[row].as_ref()?.describe(place)))
    }

    /// Of each letter, in order: its run, its row, and its place there.
    fn places(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let mut next = vec![0; self.rows.len()];
        let all = self.order.iter().enumerate();
        let all = all.flat_map(|(run, (row, count))| (0..*count).map(move |_| (run, *row as usize)));
        all.map(move |(run, row)| {
            next[row] += 1;
            (run, row, next[row] - 1)
        })
    }

    /// Throws everything away: how many messages of the program that was.
    pub(crate) fn discard(mut self) -> usize {
        self.rows.iter_mut().flatten().map(|row| row.discard()).sum()
    }

    /// Gives the memory of a flood back, once batches have become small again: this one, which
    /// is empty now, had `letters`.
    pub(crate) fn shrink(&mut self, letters: usize) {
        self.most = self.most.max(letters);
        self.calm = if letters < self.most / 4 { self.calm + 1 } else { 0 };
        if self.most > KEPT.0 && self.calm > KEPT.1 && self.len == 0 {
            *self = Self::default();
        }
    }
}

impl<C: Content> Row for VecDeque<Letter<C>> {
    fn describe(&self, place: usize) -> (u32, &'static str) {
        (self[place].to, self[place].content.name())
    }

    fn deliver(&mut self, place: usize, count: &mut u32, thread: &mut Context) {
        while *count > 0 && !thread.halted() {
            let letter = if place == 0 { self.pop_front() } else { self.remove(place) };
            *count -= 1;
            if let Some(Letter { to, stamp, content }) = letter {
                content.deliver(to, stamp, thread);
            }
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
