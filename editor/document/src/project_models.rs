//! The models of a project by the names with which scripts mean them. Each look-up in the project itself is a search of all its elements.

use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::ScriptElement;
use std::collections::HashMap;

/// The models of a project and their edits, by name. Where several have one name, the first one counts.
#[derive(Debug)]
pub(super) struct ProjectModels<'a> {
    by_id: HashMap<&'a str, &'a ScriptElement>,
    by_file: HashMap<&'a str, &'a ScriptElement>,
    /// The edits by the ids of their models.
    edits: HashMap<&'a str, &'a ScriptElement>,
}

impl<'a> ProjectModels<'a> {
    /// Returns the models of a project. Looks at each of its elements a fixed number of times.
    pub(super) fn of(project: &'a StageProject) -> Self {
        let by = |name: &'a str, attribute: &str| {
            let mut found = HashMap::new();
            for element in project.elements_called(name) {
                if let Some(value) = element.value(attribute) {
                    found.entry(value).or_insert(element);
                }
            }
            found
        };
        Self { by_id: by("model", "id"), by_file: by("model", "src"), edits: by("edits", "of") }
    }

    /// Returns the model that scripts mean by `name`, an id or a file; `None` where the project does not have it.
    pub(super) fn model(&self, name: &str) -> Option<&'a ScriptElement> {
        let of_file = || self.by_file.get(name).filter(|model| model.value("id").is_some());
        self.by_id.get(name).or_else(of_file).copied()
    }

    /// Returns the element of the edits of a model; `None` where it has none.
    pub(super) fn edits_of(&self, model: &ScriptElement) -> Option<&'a ScriptElement> {
        self.edits.get(model.value("id")?).copied()
    }
}
