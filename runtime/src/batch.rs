//! Queued messages: one array ("row") for each message type, and a list that keeps the order
//! between the rows.
//!
//! ```text
//! order    2 of row 1, 1 of row 0, 1 of row 1
//! row 0    [resize]                each row is an array of one type,
//! row 1    [edit][edit][edit]      whose memory is reused
//! ```
//!
//! So a message is moved, not boxed: storing it allocates nothing once its row has grown, and a
//! thread still has one queue for all types. Only the row is boxed and type-erased.

use crate::Context;
use crate::object::short_type_name;
use crate::sync::mutant;
use crate::trace::Stamped;
use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A queued message with its target: the message of the thesis (§3.2.6.4), which is a receiver and
/// data of one type.
pub(crate) struct Letter<C> {
    /// The receiver's number; 0 for the thread itself.
    pub(crate) to: u32,
    /// Sender and time of sending; only when the receiving thread is traced.
    pub(crate) stamp: Stamped,
    pub(crate) content: C,
}

/// The data of a letter, and how it is delivered or discarded.
pub(crate) trait LetterContent: Send + 'static {
    /// Returns the type name of the message, or the name of the command to the thread.
    fn name(&self) -> &'static str;

    /// Delivers it to the receiver `to` of `thread`.
    fn deliver(self, to: u32, stamp: Stamped, thread: &mut Context);

    /// Drops it undelivered. Returns the number of user messages (not commands) that it held.
    fn discard(self) -> usize;
}

/// Letter content that holds a user message.
pub(crate) trait Envelope: Send + 'static {
    type Message: Send + 'static;

    /// Returns the message; `None` when it was taken out in the meantime.
    fn open(self) -> Option<Self::Message>;
}

impl<W: Envelope> LetterContent for W {
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

/// Letters of all types in the order in which they were queued.
#[derive(Default)]
pub(crate) struct Batch {
    /// Runs in order: the number of a row, and how many of its letters follow one another.
    order: VecDeque<(u32, u32)>,
    /// Rows by number; `None` where no letter of that type has arrived yet.
    rows: Vec<Option<Box<dyn MessageRow>>>,
    len: usize,
    /// Largest number of letters queued at once so far; the memory of the rows suffices for that
    /// many.
    most: usize,
    /// Number of consecutive batches that left most of that memory unused.
    small_batches: u32,
}

/// Letters of one type, type-erased.
trait MessageRow: Any + Send {
    /// Returns receiver and name of the letter at `place`.
    fn describe(&self, place: usize) -> (u32, &'static str);
    /// Delivers up to `count` letters starting at `place`, until the thread halts. Decrements `count`
    /// before each delivery.
    fn deliver(&mut self, place: usize, count: &mut u32, thread: &mut Context);
    /// Moves all letters of `newer`, a row of the same type, to the end.
    fn append(&mut self, newer: &mut dyn MessageRow);
    /// Drops all letters and returns the number of user messages among them.
    fn discard(&mut self) -> usize;
}

/// Number of letters up to which the memory of a batch is never freed.
const ALWAYS_KEPT: usize = 4096;

/// Number of consecutive small batches after which the memory of a larger batch is freed.
const SMALL_BATCHES: u32 = 16;

impl Batch {
    /// Appends `letter` to row number `row`, which must hold letters of its type.
    pub(crate) fn push<C: LetterContent>(&mut self, row: u32, letter: Letter<C>) {
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

    /// Appends all letters of `newer`, which is empty afterwards and keeps its memory.
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

    /// Delivers the letters in order until the thread halts.
    pub(crate) fn deliver(&mut self, thread: &mut Context) {
        mutant!(self.reversed_batch(thread));
        while let Some((row, count)) = self.order.front_mut() {
            let before = *count;
            if let Some(row) = &mut self.rows[*row as usize] {
                // `count` is stored outside of the closure, so it stays correct when a panic unwinds
                // out of it.
                thread.catch_and_report("message", "drop", |thread| row.deliver(0, count, thread));
            }
            self.len -= (before - *count) as usize;
            if *count == before {
                return;
            } else if *count == 0 {
                self.order.pop_front();
            }
        }
    }

    /// Delivers the letter at `index` of [`describe`](Self::describe) before all others. Returns
    /// `false` when there is none, or the thread has halted.
    pub(crate) fn deliver_at(&mut self, index: usize, thread: &mut Context) -> bool {
        let Some((run, row, place)) = self.places().nth(index) else { return false };
        let mut left = 1;
        self.rows[row].iter_mut().for_each(|row| row.deliver(place, &mut left, thread));
        self.order[run].1 -= 1 - left;
        self.order.retain(|(_, count)| *count > 0);
        self.len -= (1 - left) as usize;
        left == 0
    }

    /// Returns receiver and name of each letter, in order.
    pub(crate) fn describe(&self) -> impl Iterator<Item = (u32, &'static str)> {
        self.places().filter_map(|(_, row, place)| Some(self.rows[row].as_ref()?.describe(place)))
    }

    /// Returns the run, the row and the place in that row of each letter, in order.
    fn places(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let mut next = vec![0; self.rows.len()];
        let all = self.order.iter().enumerate();
        let all = all.flat_map(|(run, (row, count))| (0..*count).map(move |_| (run, *row as usize)));
        all.map(move |(run, row)| {
            next[row] += 1;
            (run, row, next[row] - 1)
        })
    }

    /// Drops all letters and returns the number of user messages among them.
    pub(crate) fn discard(mut self) -> usize {
        self.rows.iter_mut().flatten().map(|row| row.discard()).sum()
    }

    /// Frees the memory of an unusually large batch, once batches have become small again. Called
    /// when the batch, which had `letters` letters, has been delivered.
    pub(crate) fn shrink(&mut self, letters: usize) {
        self.most = self.most.max(letters);
        self.small_batches = if letters < self.most / 4 { self.small_batches + 1 } else { 0 };
        if self.most > ALWAYS_KEPT && self.small_batches > SMALL_BATCHES && self.len == 0 {
            *self = Self::default();
        }
    }
}

impl<C: LetterContent> MessageRow for VecDeque<Letter<C>> {
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

    fn append(&mut self, newer: &mut dyn MessageRow) {
        let newer: &mut dyn Any = newer;
        Self::append(self, newer.downcast_mut().expect("rows of one number are of one type"));
    }

    fn discard(&mut self) -> usize {
        // A letter that panics when it is dropped does not keep the others from being dropped.
        let discard = |letter: Letter<C>| catch_unwind(AssertUnwindSafe(|| letter.content.discard()));
        self.drain(..).map(|letter| discard(letter).unwrap_or(1)).sum()
    }
}
