//! The commands for takes: edits of the take that is shown.

use super::super::commands::Id;
use super::super::state::{Effect, State};
use super::super::status::Level;
use dragonfly_document::Change;
use dragonfly_document::adapter::{TakeId, TakeVersions};
use dragonfly_document::edit::{
    CreateTake, DeleteTake, Edit, MoveTake, ReverseTake, SplitTake, TakeRef, TrimTake,
};
use std::sync::Arc;

/// State of the list of takes.
#[derive(Clone, Debug, Default)]
pub struct TakesState {
    /// The take whose name is being typed.
    pub renaming: Option<TakeId>,
    /// Counts the requests to edit start and length.
    pub(super) times_asked: u64,
    /// Whether the next new take is shown when it appears.
    show_new: bool,
}

impl State {
    /// Carries out a command for takes.
    pub(in super::super) fn take_command(&mut self, id: Id) -> Option<Effect> {
        if id == Id::NewTake {
            return self.create_take(None);
        }
        let take = self.take_ref()?;
        let (index, name) = (self.playback.take?, self.take()?.name.clone());
        let edit = match id {
            Id::DuplicateTake => return self.create_take(Some((take, name))),
            Id::RenameTake => {
                self.rename_take(Some(index));
                return None;
            }
            Id::RetimeTake => {
                self.takes.times_asked += 1;
                return None;
            }
            Id::DeleteTake => Edit::DeleteTake(DeleteTake { take }),
            Id::MoveTakeUp => Edit::MoveTake(MoveTake { take, to: index.saturating_sub(1) }),
            Id::MoveTakeDown => Edit::MoveTake(MoveTake { take, to: index + 1 }),
            Id::SplitTake => {
                let name = self.unused_name(&part_of(&name), 2);
                Edit::SplitTake(SplitTake { take, time: self.time(), name })
            }
            Id::TrimTake => {
                let [from, to] = self.trim_range();
                let (start, length) = self.take_bounds();
                if from <= start && to >= start + length {
                    let text = "Nothing to trim: set a play range first";
                    self.status.say(Level::Info, text);
                    return None;
                }
                Edit::TrimTake(TrimTake { take, from, to, to_start: true })
            }
            Id::ReverseTake => Edit::ReverseTake(ReverseTake { take }),
            _ => return None,
        };
        Some(Effect::Change(Change::Edit(edit, None)))
    }

    /// Begins or ends the renaming of a take.
    pub(in super::super) fn rename_take(&mut self, index: Option<usize>) {
        self.takes.renaming = index.and_then(|index| Some(self.view.as_ref()?.slots.get(index)?.id));
    }

    /// Returns the play range, or the whole take if none is set, seconds: what trimming leaves.
    pub(in super::super) fn trim_range(&self) -> [f32; 2] {
        let (start, length) = self.play_bounds();
        [start, start + length]
    }

    fn create_take(&mut self, copy: Option<(TakeRef, String)>) -> Option<Effect> {
        self.takes.show_new = true;
        let (name, copy) = match copy {
            None => (self.unused_name("New take", 1), None),
            Some((take, name)) => (self.unused_name(&format!("{} copy", without_copy(&name)), 1), Some(take)),
        };
        Some(Effect::Change(Change::Edit(Edit::CreateTake(CreateTake { name, copy, at: None }), None)))
    }

    /// Returns `base`, or `base` with the first number that makes it an unused name.
    fn unused_name(&self, base: &str, first: usize) -> String {
        let takes = self.view.as_ref().map_or(&[][..], |view| &view.takes);
        let numbered = |number| if number == 1 { base.to_owned() } else { format!("{base} {number}") };
        let unused = |name: &String| !takes.iter().any(|take| take.name == *name);
        (first..first + takes.len() + 1).map(numbered).find(unused).unwrap_or_else(|| base.to_owned())
    }

    /// Keeps the take that was shown, wherever it is in the list now; if it was deleted, shows its neighbor.
    pub(in super::super) fn follow_take(&mut self, before: &[Arc<TakeVersions>]) {
        let Some(view) = &self.view else { return };
        let slots = Arc::clone(&view.slots);
        let place = |id: TakeId| slots.iter().position(|slot| slot.id == id);
        if self.takes.renaming.is_some_and(|id| place(id).is_none()) {
            self.takes.renaming = None;
        }
        let is_new = |slot: &Arc<TakeVersions>| !before.iter().any(|old| old.id == slot.id);
        if self.takes.show_new
            && let Some(index) = slots.iter().position(is_new)
        {
            self.takes.show_new = false;
            let time = self.time();
            self.show_take(Some(index));
            let (start, length) = self.take_bounds();
            if (start..=start + length).contains(&time) {
                self.playback = self.playback.seek(time, self.now);
            }
            return;
        }
        let Some(index) = self.playback.take else { return };
        match before.get(index).and_then(|slot| place(slot.id)) {
            Some(now) => self.playback.take = Some(now),
            None => self.show_take(index.min(slots.len().saturating_sub(1)).into()),
        }
    }
}

/// Removes the suffix of a copy: `Walk copy 2` and `Walk copy` are copies of `Walk`.
fn without_copy(name: &str) -> &str {
    let bare = without_number(name);
    bare.strip_suffix(" copy").or(name.strip_suffix(" copy")).filter(|bare| !bare.is_empty()).unwrap_or(name)
}

/// Returns the name of the second part of a take, without its number.
fn part_of(name: &str) -> String {
    without_number(name).to_owned()
}

fn without_number(name: &str) -> &str {
    match name.rsplit_once(' ') {
        Some((bare, number)) if !bare.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit()) => {
            bare
        }
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_of_a_copy_is_called_like_the_first() {
        assert_eq!(without_copy("Walk"), "Walk");
        assert_eq!(without_copy("Walk copy"), "Walk");
        assert_eq!(without_copy("Walk copy 12"), "Walk");
        assert_eq!(without_copy(" copy"), " copy");
        assert_eq!(without_copy("Take 001"), "Take 001");
        assert_eq!(part_of("Walk 2"), "Walk");
        assert_eq!(part_of("42"), "42");
    }
}
