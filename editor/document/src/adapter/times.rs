//! Channels that had one column of times keep one.

use std::sync::Arc;

/// The columns of times that one edit made, by the columns they were made of.
///
/// A file often has one column for all channels of a take. Where an edit does the same to all of them, they have one
/// afterwards, too: in memory, and in the file that is saved.
#[derive(Debug, Default)]
pub(crate) struct SharedTimes(Vec<(TimeColumn, TimeColumn)>, Vec<MovedTimes>);

/// A column, what was moved in it, and what came of it.
type MovedTimes = (TimeColumn, Vec<(u32, f32)>, TimeColumn);

/// Seconds, ascending; shared by channels.
type TimeColumn = Arc<[f32]>;

/// More columns than this are not compared: an edit that makes that many makes different ones.
const REMEMBERED: usize = 8;

impl SharedTimes {
    /// `new` as a column; the one that another channel got for the same, if any did.
    pub(crate) fn times(&mut self, old: &TimeColumn, new: Vec<f32>) -> TimeColumn {
        let same = |(from, to): &&(TimeColumn, TimeColumn)| Arc::ptr_eq(from, old) && **to == *new;
        if let Some((_, to)) = self.0.iter().find(same) {
            return Arc::clone(to);
        }
        let new: TimeColumn = new.into();
        if self.0.len() == REMEMBERED {
            self.0.remove(0);
        }
        self.0.push((Arc::clone(old), Arc::clone(&new)));
        new
    }

    /// `old` with other times for some keys; the same column again for another channel that has it.
    pub(crate) fn moved(&mut self, old: &TimeColumn, wanted: &[(u32, f32)]) -> TimeColumn {
        let same = |(from, moved, _): &&MovedTimes| Arc::ptr_eq(from, old) && moved == wanted;
        if let Some((.., to)) = self.1.iter().find(same) {
            return Arc::clone(to);
        }
        let mut times: TimeColumn = Arc::from(&**old);
        if let Some(times) = Arc::get_mut(&mut times) {
            for &(key, time) in wanted {
                if let Some(at) = times.get_mut(key as usize) {
                    *at = time;
                }
            }
        }
        if self.1.len() == REMEMBERED {
            self.1.remove(0);
        }
        self.1.push((Arc::clone(old), wanted.to_vec(), Arc::clone(&times)));
        times
    }
}
