//! Columns of times that channels share.

use std::sync::Arc;

/// The columns of times that one edit has created, each with the column that it was created from.
///
/// A file often has one column for all channels of a take. Where an edit does the same to all of them, they still
/// share one: in memory, and in the saved file.
#[derive(Debug, Default)]
pub(crate) struct SharedTimes(Vec<(TimeColumn, TimeColumn)>, Vec<MovedTimes>);

/// A column, the moved keys, and the result.
type MovedTimes = (TimeColumn, Vec<(u32, f32)>, TimeColumn);

/// Seconds, ascending; shared by channels.
type TimeColumn = Arc<[f32]>;

/// Maximum number of columns that are compared with a new one: an edit that creates more than that creates different
/// ones.
const REMEMBERED: usize = 8;

impl SharedTimes {
    /// Returns `new` as a column. If another channel already got the same times in place of `old`, returns its column.
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

    /// Returns `old` with other times for some keys. If `old` was already changed in this way for another channel,
    /// returns the column of that channel.
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
