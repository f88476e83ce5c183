//! The user of an action or a thing that is to be deleted: it is named and selected instead.

use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::splice::elements_that_name;
use std::ops::Range;

/// An element of a script that depends on another one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum RevealedUser {
    /// An action.
    Action(usize),
    /// A thing of the cast.
    Thing {
        /// Its id.
        id: Box<str>,
        /// Name of its element.
        kind: &'static str,
    },
}

impl RevealedUser {
    /// Returns its name as the timeline and the list of things show it.
    pub(super) fn name(&self, lanes: &SceneLanes) -> String {
        match self {
            Self::Thing { id, kind } => format!("the {kind} {id}"),
            Self::Action(action) => match lanes.bar_of(*action) {
                Some((_, bar)) if bar.kind == "shot" => format!("the shot of {}", bar.label),
                Some((lane, bar)) => format!("\u{201c}{}\u{201d} in the lane of {}", bar.label, lane.name),
                // Containers and waits have no bars.
                None => "an action without a bar".to_owned(),
            },
        }
    }
}

/// Returns what refers to one of these things without being an action, or the action that depends on one that refers to them: only with it they can be
/// deleted.
pub(super) fn user_of_things(script: &StageScript, things: &[Box<str>]) -> Option<RevealedUser> {
    let tree = script.tree();
    let mut actions = Vec::new();
    for user in things.iter().flat_map(|thing| elements_that_name(tree, thing)) {
        let element = &tree.elements()[user];
        match (action_of(script, user), element.value("id")) {
            (Some(action), _) => actions.push(action),
            (None, Some(id)) if !things.iter().any(|thing| **thing == *id) => {
                return Some(RevealedUser::Thing { id: id.into(), kind: element.row.name });
            }
            (None, _) => {}
        }
    }
    user_of_actions(script, &actions)
}

/// Returns an action that refers to one of these ones from outside of them all: to its name, or as the one before it.
pub(super) fn user_of_actions(script: &StageScript, actions: &[usize]) -> Option<RevealedUser> {
    let tree = script.tree();
    let ranges: Vec<Range<usize>> =
        actions.iter().map(|&action| script.element(action).range.clone()).collect();
    let is_inside = |element: usize| {
        let own = &tree.elements()[element];
        !own.is_included()
            && ranges.iter().any(|range| range.start <= own.range.start && own.range.end <= range.end)
    };
    let inside = (0..tree.elements().len()).filter(|element| is_inside(*element));
    let ids = inside.filter_map(|element| tree.elements()[element].value("id"));
    let mut users = ids.flat_map(|id| elements_that_name(tree, id)).filter(|user| !is_inside(*user));
    let named = users.find_map(|user| action_of(script, user));
    let follows = || actions.iter().find_map(|&action| follower(script, action, actions));
    named.or_else(follows).map(RevealedUser::Action)
}

/// Returns the action after one, if it begins or ends relative to that one and is none of `without`.
fn follower(script: &StageScript, action: usize, without: &[usize]) -> Option<usize> {
    let own = script.actions().get(action)?;
    let next = *script.actions().get(own.parent?)?.children.get(own.position + 1)?;
    let element = script.element(next);
    let mut times = ["begin", "end"].into_iter().filter_map(|name| element.value(name));
    (!without.contains(&next) && times.any(|time| time.starts_with("prev"))).then_some(next)
}

/// Returns the action that an element of the script is or is in; `None` for things.
fn action_of(script: &StageScript, element: usize) -> Option<usize> {
    let tree = script.tree();
    let around = std::iter::successors(Some(element), |&at| tree.elements().get(at)?.parent);
    let mut found =
        around.filter_map(|element| script.actions().iter().position(|action| action.element == element));
    found.next().filter(|action| *action > 0)
}
