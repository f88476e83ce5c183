//! The vocabularies: which elements a kind of text has.

use super::row::{ElementGroup, ElementRow};
use super::{cast, project};

/// The elements of one kind of text.
#[derive(Clone, Copy, Debug)]
pub struct Vocabulary {
    /// The name of such a text, with its article: `a script`.
    pub title: &'static str,
    /// The element around everything.
    pub root: &'static ElementRow,
    /// Every element, in the order of the documentation, the root first.
    pub elements: &'static [&'static ElementRow],
}

/// Scripts of scenes.
pub static SCRIPTS: Vocabulary =
    Vocabulary { title: "a script", root: &cast::SCRIPT, elements: super::ELEMENTS };

/// Projects.
pub static PROJECTS: Vocabulary = Vocabulary {
    title: "a project",
    root: &project::PROJECT,
    elements: &[
        &project::PROJECT,
        &project::MODELS,
        &project::MODEL,
        &project::EDITS,
        &project::SCENE,
        &cast::CAST,
        &cast::ROLE,
        &cast::PROP,
        &cast::CAMERA,
        &cast::LIGHT,
        &cast::EFFECT,
        &cast::PATH,
        &cast::MARK,
        &project::LINES,
        &project::SCRIPT_FILE,
        &project::MOVIE,
    ],
};

/// Files of drawn lines.
pub static LINE_FILES: Vocabulary = Vocabulary {
    title: "a file of lines",
    root: &project::LINE_FILE,
    elements: &[&project::LINE_FILE, &project::LINE],
};

impl Vocabulary {
    /// Returns the row of the first element called `name`.
    pub fn element(&self, name: &str) -> Option<&'static ElementRow> {
        self.elements.iter().find(|row| row.name == name).copied()
    }

    /// Returns the elements that may be inside `row`.
    pub fn children_of(&self, row: &ElementRow) -> Vec<&'static ElementRow> {
        let of = |groups: &[ElementGroup]| {
            self.elements.iter().copied().filter(|row| groups.contains(&row.group)).collect()
        };
        match row.group {
            ElementGroup::Script => of(&[ElementGroup::Cast, ElementGroup::Container, ElementGroup::Action]),
            ElementGroup::Cast => of(&[ElementGroup::Thing]),
            ElementGroup::Container => of(&[ElementGroup::Container, ElementGroup::Action]),
            ElementGroup::Project | ElementGroup::Thing | ElementGroup::Action | ElementGroup::Part => {
                row.parts.to_vec()
            }
        }
    }
}
