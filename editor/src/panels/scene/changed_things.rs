//! The things that a change of the script changes: it is refused while one of them is locked.

use dragonfly_anim::stage::script::StageScript;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The existing things that a gesture changes.
#[derive(Clone, Copy, Debug)]
pub enum ChangedThings<'a> {
    /// None: it adds something, or changes what belongs to no thing.
    None,
    /// One thing, by its id.
    Thing(&'a str),
    /// These things, by their ids.
    Things(&'a [Box<str>]),
    /// Those that do these actions, or actions inside of them. Shots change no camera.
    Actions(&'a [usize]),
    /// The thing that an element is, or to which it belongs.
    Element(usize),
}

impl ChangedThings<'_> {
    /// Returns the ids of the things of a script.
    pub fn ids(self, script: &StageScript) -> Arc<[Box<str>]> {
        match self {
            Self::None => Arc::default(),
            Self::Thing(id) => Arc::from([Box::from(id)]),
            Self::Things(ids) => ids.into(),
            Self::Actions(actions) => {
                let known = actions.iter().filter(|&&action| action < script.actions().len());
                let all = known.flat_map(|&action| script.branch(action));
                all.filter_map(|action| actor(script, script.actions()[action].element))
                    .collect::<BTreeSet<&str>>()
                    .into_iter()
                    .map(Box::from)
                    .collect()
            }
            Self::Element(element) => {
                if let Some(action) = script.actions().iter().position(|own| own.element == element) {
                    return ChangedThings::Actions(&[action]).ids(script);
                }
                let elements = script.tree().elements();
                let mut around = std::iter::successors(Some(element), |&at| elements.get(at)?.parent);
                let named = |at: usize| {
                    let id = elements.get(at)?.value("id")?;
                    (script.thing_element(id) == Some(at)).then_some(id)
                };
                let owner = around.find_map(|at| actor(script, at).or_else(|| named(at)));
                owner.map_or_else(Arc::default, |id| Arc::from([Box::from(id)]))
            }
        }
    }
}

/// Returns the thing that does an action.
fn actor(script: &StageScript, element: usize) -> Option<&str> {
    let element = script.tree().elements().get(element)?;
    element.value("who").filter(|_| element.row.name != "shot")
}
