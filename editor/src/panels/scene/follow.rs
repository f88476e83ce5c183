//! The action of a new script that was a given one of the script before.

use dragonfly_anim::stage::script::{ScriptElement, StageScript};

/// Returns the action of `new` that is `action` of `old`: the one with its id, otherwise the nearest one in the text that is
/// the same apart from its times. `None` where it is gone.
pub(super) fn follow_action(old: &StageScript, action: usize, new: &StageScript) -> Option<usize> {
    let element = old.actions().get(action).map(|_| old.element(action))?;
    if element.is_included() {
        return follow_included(old, action, new);
    }
    if let Some(id) = element.value("id") {
        return new.action_called(id);
    }
    let same_count = old.actions().len() == new.actions().len();
    let is_same = |other: usize| {
        let other = new.element(other);
        other.is_own() && other.attribute("id").is_none() && is_alike(element, other)
    };
    // Most edits change attributes of one action and leave all others where they are.
    if same_count && action < new.actions().len() && new.element(action).row.name == element.row.name {
        let around = |script: &StageScript, at: usize| script.actions()[at].parent;
        if is_same(action)
            || around(old, action) == around(new, action) && !(1..new.actions().len()).any(is_same)
        {
            return Some(action);
        }
    }
    let nearest = |is_wanted: &dyn Fn(usize) -> bool| {
        (1..new.actions().len()).filter(|&other| is_wanted(other)).min_by_key(|other| other.abs_diff(action))
    };
    // Or it went to another thing.
    let is_new = |other: usize| {
        !old.actions().iter().enumerate().any(|(at, _)| is_alike(old.element(at), new.element(other)))
    };
    nearest(&is_same).or_else(|| {
        nearest(&|other| new.element(other).row.name == element.row.name && is_new(other))
            .filter(|_| same_count)
    })
}

/// Returns the action of an included file that was a given one: at the same place after its `include`, if it is the same apart from its times.
fn follow_included(old: &StageScript, action: usize, new: &StageScript) -> Option<usize> {
    let include = old.action_in_text(action);
    let found = follow_action(old, include, new)? + (action - include);
    let (element, other) = (old.element(action), new.actions().get(found).map(|_| new.element(found))?);
    let is_same = other.is_included() && is_alike(element, other);
    (is_same && old.tree().file_of(element) == new.tree().file_of(other)).then_some(found)
}

/// Returns whether two elements are the same apart from their times.
fn is_alike(one: &ScriptElement, other: &ScriptElement) -> bool {
    const TIMES: [&str; 4] = ["begin", "end", "dur", "fade-in"];
    let rest = |element: &ScriptElement| {
        let attributes = element.attributes.iter().filter(|attribute| !TIMES.contains(&attribute.row.name));
        attributes.map(|attribute| (attribute.row.name, attribute.value.clone())).collect::<Vec<_>>()
    };
    one.row.name == other.row.name && rest(one) == rest(other)
}
