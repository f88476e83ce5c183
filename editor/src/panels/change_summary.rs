//! Describes what was done to the document, for the status line: each step once when it begins, when it is undone, and
//! when it is redone.

use super::count_text::{count, grouped};
use super::difference_text::{ShownScale, difference_text};
use dragonfly_document::{HistoryView, View};
use std::sync::Arc;

/// Describes what leads from one view of a model to a newer one; `None` if nothing was done, or a gesture continues.
pub(super) fn describe_change(old: &View, new: &View, scale: ShownScale) -> Option<String> {
    let (before, now) = (&*old.history, &*new.history);
    if same_steps(before, now) {
        let (few, many) = (before.done.min(now.done), before.done.max(now.done));
        let what = match many - few {
            0 => return None,
            1 => step(now, few),
            several => count(several, "step", "steps"),
        };
        let verb = if now.done < before.done { "Undone" } else { "Redone" };
        return Some(format!("{verb}: {what}"));
    }
    let gone = before.steps.len().saturating_sub(1);
    if now.steps.len() < before.steps.len()
        && now.steps.len() == gone
        && now.numbers.last() == before.numbers.get(..gone).and_then(<[u64]>::last)
    {
        return Some(format!("Cancelled: {}", step(before, gone)));
    }
    let last = now.done.checked_sub(1)?;
    let parts = [Some(step(now, last)), keys(old, new), difference(old, new, scale)];
    Some(parts.into_iter().flatten().collect::<Vec<_>>().join("  ·  "))
}

/// Describes how many keys were overwritten when keys were moved, duplicated or pasted; `None` if none were. The take
/// had `before` keys, `brought` more were added, and it has `now` keys.
pub(super) fn describe_replaced(view: &View, before: usize, brought: usize, now: usize) -> Option<String> {
    let replaced = (before + brought).checked_sub(now).filter(|&keys| keys > 0)?;
    let last = view.history.done.checked_sub(1)?;
    let more = now.checked_sub(before).filter(|&keys| keys > 0).map(|keys| format!("{} more", grouped(keys)));
    let replaced = format!("{} replaced", count(replaced, "key", "keys"));
    Some(
        [Some(step(&view.history, last)), more, Some(replaced)]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join("  ·  "),
    )
}

/// Returns whether both contain the same steps, however many of them are done.
pub(super) fn same_steps(before: &HistoryView, now: &HistoryView) -> bool {
    before.steps.len() == now.steps.len() && before.numbers.last() == now.numbers.last()
}

/// Returns a step in a few words.
fn step(history: &HistoryView, at: usize) -> String {
    let label = history.steps.get(at).copied().unwrap_or_default();
    match history.about.get(at) {
        Some(about) if !about.is_empty() => format!("{label}  ·  {about}"),
        _ => label.to_owned(),
    }
}

/// Returns how far the last step moves bones, where it is a step for which that is shown.
fn difference(old: &View, new: &View, scale: ShownScale) -> Option<String> {
    if !new.history.shows_difference || old.slots.len() != new.slots.len() {
        return None;
    }
    let mut both = old.slots.iter().zip(new.slots.iter());
    let (before, now) = both.find(|(before, now)| !Arc::ptr_eq(before, now))?;
    let skeleton = &new.loaded.model.animation.skeleton;
    difference_text((before.shown(), now.shown()), skeleton, scale)
}

/// Returns how many keys were added or deleted, if the takes are the same ones.
fn keys(old: &View, new: &View) -> Option<String> {
    if !old.slots.iter().map(|slot| slot.id).eq(new.slots.iter().map(|slot| slot.id)) {
        return None;
    }
    let changed = old.takes.iter().zip(new.takes.iter()).filter(|(a, b)| !Arc::ptr_eq(a, b));
    let [before, now] = changed.fold([0, 0], |[before, now], (a, b)| [before + a.keys(), now + b.keys()]);
    match now.abs_diff(before) {
        0 => None,
        some => {
            Some(format!("{} {}", count(some, "key", "keys"), if now > before { "more" } else { "fewer" }))
        }
    }
}
