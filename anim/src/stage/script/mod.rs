//! Scripts: from a text to things and actions whose references are resolved.
//!
//! ```text
//! text → XML with places → checked against the tables → includes replaced → names resolved: StageScript
//! ```
//!
//! What depends on models (takes, bones, lengths) is checked where a script is built for them: [`crate::stage::StagePlan`].

mod error;
mod included;
mod merge;
mod origin;
mod read;
mod references;
mod scope;
mod suggest;
mod text_place;
mod timing;
mod tree;

pub use crate::stage::moment::{MomentText, is_name};
pub(in crate::stage) use error::ErrorList;
pub use error::{MOST_ERRORS, ScriptError};
pub use included::{IncludedScripts, MOST_INCLUDES, MissingScript, ScriptContext};
use origin::IncludedPart;
pub(in crate::stage) use origin::SHARED;
pub use origin::{ElementOrigin, IncludedPlace};
pub(in crate::stage) use read::read_tree;
pub use read::{MOST_BYTES, MOST_DEPTH, MOST_NODES};
use scope::ScriptNames;
pub(in crate::stage) use suggest::suggestion;
use text_place::LineIndex;
pub use text_place::TextPlace;
pub use tree::{ScriptAttribute, ScriptElement, ScriptTree};

use crate::stage::project::StageProject;
use crate::stage::table::{SCRIPTS, size};
use crate::stage::time::{Decimal, StageRate, StageTime};
use std::sync::Arc;

/// How often an action runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageRepeat {
    /// This many times, not necessarily a whole number.
    Times(Decimal),
    /// For as long as there is time.
    Fill,
}

/// A moment of another action, with its reference resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionMoment {
    /// A time after the usual begin.
    Offset(StageTime),
    /// A time after the start of an action.
    Begin(usize, StageTime),
    /// A time after the end of an action.
    End(usize, StageTime),
    /// A time after a point of the take that an action plays: the point's time in the take, and the offset.
    Point(usize, StageTime, StageTime),
}

/// An action or container of a script.
#[derive(Clone, Debug)]
pub struct ScriptAction {
    /// Its element in [`ScriptTree::elements`].
    pub element: usize,
    /// The container; the script itself is action 0 and has none.
    pub parent: Option<usize>,
    /// The actions inside a container, in the order of the text.
    pub children: Vec<usize>,
    /// Its position among the children of its container.
    pub position: usize,
    /// When it begins; `None`: as usual.
    pub begin: Option<ActionMoment>,
    /// When it ends, as written.
    pub end: Option<ActionMoment>,
    /// Its duration, as written.
    pub dur: Option<StageTime>,
    /// How often it runs.
    pub repeat: StageRepeat,
    /// Whether it has no length of its own (rule 3).
    pub passive: bool,
}

/// A script whose names are resolved, ready to be given times.
#[derive(Clone, Debug)]
pub struct StageScript {
    tree: ScriptTree,
    context: ScriptContext,
    rate: StageRate,
    size: [u32; 2],
    seed: u32,
    /// Elements of the things, in the order of the text.
    things: Vec<usize>,
    actions: Vec<ScriptAction>,
    names: ScriptNames,
}

impl StageScript {
    /// Reads a script. Allocates in proportion to the text; the text is shared, not copied.
    ///
    /// # Errors
    ///
    /// Everything that is wrong, in the order of the text: at most [`MOST_ERRORS`]. A text that is not XML has one error.
    pub fn read(text: impl Into<Arc<str>>) -> Result<Self, Vec<ScriptError>> {
        Self::read_of(text, None)
    }

    /// Reads a script of a project: the things of the project's cast are things of the script too, and it has the frame rate, size and
    /// seed of the project where it does not say so itself.
    ///
    /// # Errors
    ///
    /// As [`Self::read`]. Those of shared things are in the text of the project: [`StageProject::separated`] finds them.
    pub fn read_of(
        text: impl Into<Arc<str>>,
        project: Option<&StageProject>,
    ) -> Result<Self, Vec<ScriptError>> {
        Self::read_in(text, &ScriptContext { project: project.cloned(), ..ScriptContext::default() })
    }

    /// Reads a script with everything that it is read with: the project that it belongs to, and the files that it includes.
    ///
    /// # Errors
    ///
    /// As [`Self::read_of`]. Errors of an included file have their places in it, and the bytes of the `include`.
    pub fn read_in(text: impl Into<Arc<str>>, context: &ScriptContext) -> Result<Self, Vec<ScriptError>> {
        Self::of_tree(read::read_tree(&text.into(), &SCRIPTS)?, context.clone())
    }

    /// Reads another text as this script was read: with the same project, if it has one, and the same included files.
    ///
    /// # Errors
    ///
    /// As [`Self::read_of`].
    pub fn reread(&self, text: impl Into<Arc<str>>) -> Result<Self, Vec<ScriptError>> {
        Self::read_in(text, &self.context)
    }

    /// Reads a text whose elements are known, as [`Self::reread`] does.
    ///
    /// # Errors
    ///
    /// As [`Self::read_of`].
    pub fn with_tree(&self, tree: ScriptTree) -> Result<Self, Vec<ScriptError>> {
        Self::of_tree(tree, self.context.clone())
    }

    fn of_tree(mut tree: ScriptTree, context: ScriptContext) -> Result<Self, Vec<ScriptError>> {
        // A tree of a script has the elements of other texts already.
        tree.elements.retain(ScriptElement::is_own);
        tree.parts = Arc::default();
        if let Some(project) = &context.project {
            tree.elements.extend(project.shared_things());
        }
        let wrong = merge::merge(&mut tree, &context);
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let root = &tree.elements[0];
        let of_project = |name: &str| context.project.as_ref()?.tree().elements()[0].value(name);
        // A written value has priority, then that of the project, then the default.
        let value = |name: &str| match root.attribute(name) {
            Some(written) => Some(&*written.value),
            None => of_project(name).or_else(|| root.value(name)),
        };
        let (rate, size, seed) = (
            value("fps").and_then(StageRate::parse).unwrap_or_default(),
            value("size").and_then(size).unwrap_or([1280, 720]),
            value("seed").and_then(|seed| seed.parse().ok()).unwrap_or(0),
        );
        let (things, actions, names) = (Vec::new(), Vec::new(), ScriptNames::default());
        let mut script = Self { tree, context, rate, size, seed, things, actions, names };
        let (lines, parts) = (script.tree.lines.clone(), Arc::clone(&script.tree.parts));
        let mut errors = ErrorList::with_parts(&lines, &parts);
        script.collect(&mut errors);
        references::resolve(&mut script, &mut errors);
        if errors.is_empty() { Ok(script) } else { Err(errors.sorted()) }
    }

    fn action(&self, index: usize, parent: Option<usize>, position: usize) -> ScriptAction {
        let element = &self.tree.elements[index];
        let repeat = match element.value("repeat") {
            Some("fill") => StageRepeat::Fill,
            Some(times) => StageRepeat::Times(Decimal::parse(times).unwrap_or(Decimal::ONE)),
            None => StageRepeat::Times(Decimal::ONE),
        };
        ScriptAction {
            element: index,
            parent,
            children: Vec::new(),
            position,
            begin: None,
            end: None,
            dur: self.time(element, "dur"),
            repeat,
            passive: false,
        }
    }

    /// Returns the project with which it was read; `None` for a script alone.
    pub fn project(&self) -> Option<&StageProject> {
        self.context.project.as_ref()
    }

    /// Returns the height of the ground in meters: that of the project, else 0.
    pub fn ground(&self) -> f64 {
        self.project().map_or(0.0, StageProject::ground)
    }

    /// Returns the text and its elements.
    pub fn tree(&self) -> &ScriptTree {
        &self.tree
    }

    /// Returns the frames per second.
    pub fn rate(&self) -> StageRate {
        self.rate
    }

    /// Returns width and height of the image in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the start of all random numbers.
    pub fn seed(&self) -> u32 {
        self.seed
    }

    /// Returns the elements of the things, in the order of the text.
    pub fn things(&self) -> impl ExactSizeIterator<Item = &ScriptElement> {
        self.things.iter().map(|&thing| &self.tree.elements[thing])
    }

    /// Returns the indices of the elements of the things in [`Self::tree`], in the order of the text.
    pub fn thing_elements(&self) -> impl ExactSizeIterator<Item = usize> {
        self.things.iter().copied()
    }

    /// Returns the actions, in the order of the text, with those of an included file after its `include`; the first one is the script, which is
    /// a `par`.
    pub fn actions(&self) -> &[ScriptAction] {
        &self.actions
    }

    /// Returns the action of the text itself that is called `id`; those of included files have names of their own.
    pub fn action_called(&self, id: &str) -> Option<usize> {
        self.names.action(id)
    }

    /// Returns the position of the thing called `id` in [`Self::things`].
    pub fn thing_called(&self, id: &str) -> Option<usize> {
        self.names.thing(id)
    }

    /// Returns the action of the text itself that an action comes from: itself, or the `include` that brings it.
    pub fn action_in_text(&self, action: usize) -> usize {
        let is_included = |action: &usize| self.element(*action).is_included();
        let mut own = action;
        while let Some(parent) = self.actions[own].parent.filter(|_| is_included(&own)) {
            own = parent;
        }
        own
    }

    /// Returns an action with everything in it: their positions follow each other.
    pub fn branch(&self, action: usize) -> std::ops::Range<usize> {
        // Later siblings of it, or of a container around it, come after everything in it.
        let last =
            std::iter::successors(Some(action), |&at| self.actions[at].children.last().copied()).last();
        action..last.unwrap_or(action) + 1
    }

    /// Returns what it was read with.
    pub fn context(&self) -> &ScriptContext {
        &self.context
    }

    /// Returns the index of the element of the thing called `id` in [`Self::tree`].
    pub fn thing_element(&self, id: &str) -> Option<usize> {
        self.things.get(self.thing_called(id)?).copied()
    }

    /// Returns the element of an action.
    pub fn element(&self, action: usize) -> &ScriptElement {
        &self.tree.elements[self.actions[action].element]
    }

    /// Returns the errors of a later step, with their places, from what `check` adds.
    pub(in crate::stage) fn with_errors<T>(
        &self,
        check: impl FnOnce(&mut ErrorList) -> T,
    ) -> Result<T, Vec<ScriptError>> {
        let mut errors = ErrorList::with_parts(&self.tree.lines, &self.tree.parts);
        let result = check(&mut errors);
        if errors.is_empty() { Ok(result) } else { Err(errors.sorted()) }
    }
}
