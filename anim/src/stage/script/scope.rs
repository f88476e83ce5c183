//! The things and actions of a script and of what it includes, and which names each file sees.
//!
//! A file sees the actions that it has itself. It sees the things of its own cast, of the project, and of the files that it includes. Things
//! of the same id are one thing, whose first element decides: that of the project, of the script, of an earlier include.

use super::{ElementOrigin, ErrorList, IncludedPart, ScriptElement, ScriptTree, StageScript};
use crate::stage::table::ElementGroup;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// The names of a script and of what it includes.
#[derive(Clone, Debug, Default)]
pub(super) struct ScriptNames {
    things: HashMap<Box<str>, KnownThing>,
    /// The actions by their ids: of the text, then of each included part.
    actions: Vec<HashMap<Box<str>, usize>>,
}

/// A thing that has an id.
#[derive(Clone, Debug)]
struct KnownThing {
    /// Its position in the list of things.
    position: usize,
    is_of_project: bool,
    /// The included parts whose casts have it, ascending.
    parts: Vec<usize>,
}

/// The names that a file sees: the file of an element.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScriptScope<'a> {
    names: &'a ScriptNames,
    /// The included part and the end of those that it includes; `None` for the text itself.
    part: Option<(usize, usize)>,
}

impl ScriptNames {
    /// Returns the position of the thing called `id`.
    pub(super) fn thing(&self, id: &str) -> Option<usize> {
        self.things.get(id).map(|known| known.position)
    }

    /// Returns the action of the text itself that is called `id`.
    pub(super) fn action(&self, id: &str) -> Option<usize> {
        self.actions.first()?.get(id).copied()
    }
}

impl<'a> ScriptScope<'a> {
    /// Returns the position of the thing that an id means.
    pub(super) fn thing(self, id: &str) -> Option<usize> {
        let known = self.names.things.get(id)?;
        let is_seen = match self.part {
            None => true,
            Some(_) if known.is_of_project => true,
            Some((part, end)) => {
                let next = known.parts.partition_point(|&other| other < part);
                known.parts.get(next).is_some_and(|&other| other < end)
            }
        };
        is_seen.then_some(known.position)
    }

    /// Returns the action that an id means.
    pub(super) fn action(self, id: &str) -> Option<usize> {
        self.names.actions.get(self.part.map_or(0, |(part, _)| part + 1))?.get(id).copied()
    }

    /// Returns the ids of the actions, in alphabetical order.
    pub(super) fn action_ids(self) -> Vec<&'a str> {
        let of = self.names.actions.get(self.part.map_or(0, |(part, _)| part + 1));
        let mut ids: Vec<&str> = of.into_iter().flatten().map(|(id, _)| &**id).collect();
        ids.sort_unstable();
        ids
    }
}

impl StageScript {
    /// Returns what the file of an element sees.
    pub(super) fn scope(&self, element: &ScriptElement) -> ScriptScope<'_> {
        let part = match element.origin {
            ElementOrigin::Text | ElementOrigin::Project => None,
            ElementOrigin::Included(part) => {
                Some((part, self.tree.parts.get(part).map_or(part, |part| part.end)))
            }
        };
        ScriptScope { names: &self.names, part }
    }

    /// Lists things, actions and ids.
    pub(super) fn collect(&mut self, errors: &mut ErrorList) {
        self.names.actions = vec![HashMap::new(); self.tree.parts.len() + 1];
        let own = self.tree.elements.iter().take_while(|element| element.is_own()).count();
        let shared = self.tree.parts.first().map_or(self.tree.elements.len(), |part| part.elements.start);
        self.collect_things((own..shared).chain(0..own), None, errors);
        let parts = Arc::clone(&self.tree.parts);
        for (number, part) in parts.iter().enumerate() {
            self.collect_things(part.elements.clone(), Some(number), errors);
        }
        self.collect_actions(own, &parts);
    }

    /// Lists the things of one file, and reports ids that it uses twice.
    fn collect_things(
        &mut self,
        of: impl Iterator<Item = usize>,
        part: Option<usize>,
        errors: &mut ErrorList,
    ) {
        let mut used: HashMap<&str, usize> = HashMap::new();
        for index in of {
            let element = &self.tree.elements[index];
            let is_thing = match element.row.group {
                ElementGroup::Thing => true,
                ElementGroup::Container | ElementGroup::Action => false,
                ElementGroup::Script | ElementGroup::Cast | ElementGroup::Part | ElementGroup::Project => {
                    continue;
                }
            };
            let id = element.value("id");
            if id == Some("prev") {
                let message = "\"prev\" means the action before, so nothing can be called that";
                errors.add(element.value_range("id"), message, "");
            } else if let Some((id, first)) = id.and_then(|id| Some((id, used.insert(id, index)?))) {
                let message = format!("the id \"{id}\" is used {} already", place(&self.tree, first, errors));
                errors.add(element.value_range("id"), message, "an id names one thing or action");
            }
            if !is_thing {
                continue;
            }
            let position = self.things.len();
            let new = || KnownThing {
                position,
                is_of_project: element.origin == ElementOrigin::Project,
                parts: Vec::new(),
            };
            let known = self.names.things.entry(id.unwrap_or_default().into()).or_insert_with(new);
            if known.position < position {
                let first = self.things[known.position];
                report_other(&self.tree, first, index, errors);
            } else {
                self.things.push(index);
            }
            known.parts.extend(part.filter(|part| known.parts.last() != Some(part)));
        }
    }

    /// Lists the actions in the order of the text, with those of an include after it.
    fn collect_actions(&mut self, own: usize, parts: &[IncludedPart]) {
        let brought: HashMap<usize, &IncludedPart> = parts.iter().map(|part| (part.include, part)).collect();
        let mut action_of: HashMap<usize, usize> = HashMap::new();
        // The last entry is the next one. Its depth is that of the includes.
        let mut open: Vec<Range<usize>> = std::iter::once(0..own).collect();
        while let Some(next) = open.last_mut() {
            let Some(index) = next.next() else {
                open.pop();
                continue;
            };
            let element = &self.tree.elements[index];
            match element.row.group {
                ElementGroup::Script | ElementGroup::Container | ElementGroup::Action => {}
                ElementGroup::Thing | ElementGroup::Cast | ElementGroup::Part | ElementGroup::Project => {
                    continue;
                }
            }
            let parent = element.parent.and_then(|parent| action_of.get(&parent)).copied();
            let action = self.actions.len();
            let position = parent.map_or(0, |parent| self.actions[parent].children.len());
            let scope = match element.origin {
                ElementOrigin::Text | ElementOrigin::Project => 0,
                ElementOrigin::Included(part) => part + 1,
            };
            if let Some(id) = element.value("id") {
                self.names.actions[scope].insert(id.into(), action);
            }
            self.actions.push(self.action(index, parent, position));
            if let Some(parent) = parent {
                self.actions[parent].children.push(action);
            }
            action_of.insert(index, action);
            open.extend(brought.get(&index).map(|part| part.elements.clone()));
        }
    }
}

/// Returns where an element is, for a message.
fn place(tree: &ScriptTree, element: usize, errors: &ErrorList) -> String {
    let element = &tree.elements[element];
    let place = errors.place(element.range.start);
    match (element.origin, tree.file_of(element)) {
        (ElementOrigin::Project, _) => "in the cast of the project".to_owned(),
        (ElementOrigin::Included(_), Some(file)) => format!("at {file}:{place}"),
        (ElementOrigin::Text | ElementOrigin::Included(_), _) => format!("at {place}"),
    }
}

/// Reports a thing of an included file that cannot be the one of the same id that is known.
fn report_other(tree: &ScriptTree, first: usize, second: usize, errors: &mut ErrorList) {
    let [known, other] = [first, second].map(|element| &tree.elements[element]);
    if !other.is_included() {
        // A second one in the same file was reported.
        return;
    }
    let id = other.value("id").unwrap_or_default();
    let is_same = |name: &&str| known.value(name) == other.value(name);
    let different = ["model", "kind"].into_iter().find(|name| !is_same(name));
    let what = match different {
        _ if known.row.name != other.row.name => format!("a {}", known.row.name),
        Some(name) => format!("{name}=\"{}\"", known.value(name).unwrap_or_default()),
        None => return,
    };
    let message = format!("\"{id}\" is {what} {}", place(tree, first, errors));
    let help = "things of the same id are one thing: give one of them another id";
    errors.add(other.value_range("id"), message, help);
}
