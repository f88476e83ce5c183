//! A text that a gesture changes in steps, and the check of the last one.

use super::scene::{GestureRefusal, NO_PLACE, in_this_text, refused};
use crate::stage::schedule::{Schedule, resolve};
use crate::stage::script::{ScriptTree, StageScript};
use crate::stage::splice::{TextSplices, remove_attribute, set_attribute};
use crate::stage::time::StageTime;

/// A script, and the text that it becomes. Each step that changes something reads the text once.
pub(super) struct ScriptDraft<'a> {
    script: &'a StageScript,
    /// The text so far with its elements; `None` while it is that of the script.
    tree: Option<ScriptTree>,
}

/// A change of an attribute: the element, the name, and the new value; `None` removes it.
pub(super) type AttributeChange<'a> = (usize, &'a str, Option<String>);

impl<'a> ScriptDraft<'a> {
    /// Begins with the text of `script`.
    pub(super) fn of(script: &'a StageScript) -> Self {
        Self { script, tree: None }
    }

    /// Returns the text so far with its elements.
    pub(super) fn tree(&self) -> &ScriptTree {
        self.tree.as_ref().unwrap_or_else(|| self.script.tree())
    }

    /// Makes one step: `find` returns the splices of the text so far.
    pub(super) fn then(
        self,
        find: impl FnOnce(&ScriptTree) -> Option<TextSplices>,
    ) -> Result<Self, GestureRefusal> {
        let Some(splices) = find(self.tree()) else {
            return refused(NO_PLACE);
        };
        if splices.list().is_empty() {
            return Ok(self);
        }
        let text = splices.apply(self.tree().text());
        Ok(Self { tree: Some(ScriptTree::read(text)?), ..self })
    }

    /// Goes on with the text of `script`, which was made from the one at the start.
    pub(super) fn becoming(self, script: &StageScript) -> Self {
        Self { tree: Some(script.tree().clone()), ..self }
    }

    /// Returns the script that the text is now; `None` while it is the one at the start.
    pub(super) fn read(&self) -> Result<Option<StageScript>, GestureRefusal> {
        Ok(match &self.tree {
            Some(tree) => Some(self.script.with_tree(tree.clone())?),
            None => None,
        })
    }

    /// Refuses an element that is in another text.
    pub(super) fn own(self, element: usize) -> Result<Self, GestureRefusal> {
        in_this_text(self.tree(), element)?;
        Ok(self)
    }

    /// Changes attributes, in one step. Attributes that already have their values stay as they are written.
    pub(super) fn with(mut self, changes: &[AttributeChange<'_>]) -> Result<Self, GestureRefusal> {
        for (element, ..) in changes {
            self = self.own(*element)?;
        }
        self.then(|tree| {
            let changed = |(element, name, value): &AttributeChange<'_>| match value {
                Some(value) => set_attribute(tree, *element, name, value),
                None => remove_attribute(tree, *element, name),
            };
            let splices: Option<Vec<TextSplices>> = changes.iter().map(changed).collect();
            TextSplices::joined(splices?)
        })
    }

    /// Returns the text, if it is a script that can be read and whose times do not depend on themselves.
    pub(super) fn finish(self) -> Result<String, GestureRefusal> {
        // Whether times depend on themselves does not depend on how long anything is.
        self.finish_with(&[], |_| Ok(()))
    }

    /// Returns the text as [`Self::finish`] does, if `check` allows the times that follow from the lengths of the actions.
    pub(super) fn finish_with(
        self,
        lengths: &[StageTime],
        check: impl FnOnce(&Schedule) -> Result<(), GestureRefusal>,
    ) -> Result<String, GestureRefusal> {
        let Some(tree) = self.tree else { return Ok(self.script.tree().text().to_string()) };
        let script = self.script.with_tree(tree)?;
        check(&resolve(&script, lengths)?)?;
        Ok(script.tree().text().to_string())
    }
}

/// Refuses a change after which one of `actions` has another action before it, where it refers to that one as `prev`: it would begin or end
/// at another time.
pub(super) fn keeps_prev(
    script: &StageScript,
    actions: impl IntoIterator<Item = usize>,
) -> Result<(), GestureRefusal> {
    match actions.into_iter().find(|&action| script.refers_to_prev(action)) {
        Some(action) => refused(format!(
            "{} begins or ends relative to the action before it: change that first",
            script.tree().title(script.actions()[action].element)
        )),
        None => Ok(()),
    }
}

/// Returns the text of `script` with replacements.
///
/// # Errors
///
/// The result would be no script, its times would depend on themselves, or a replacement is one of the project.
pub fn spliced_text(script: &StageScript, splices: TextSplices) -> Result<String, GestureRefusal> {
    if splices.has_shared() {
        return refused("It belongs to the project: change it there");
    }
    ScriptDraft::of(script).then(|_| Some(splices))?.finish()
}
