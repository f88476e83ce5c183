//! Projects: the models, scripts, drawn lines and movies that belong together, as an XML text.
//!
//! ```
//! use dragonfly_anim::stage::project::StageProject;
//! use dragonfly_anim::stage::script::StageScript;
//!
//! let text = r#"<project version="1" fps="30">
//!   <models>
//!     <model id="anna" src="models/anna.glb"/>
//!   </models>
//!   <cast>
//!     <camera id="wide" at="0 1.6 9"/>
//!   </cast>
//!   <script id="main" src="duel.xml"/>
//! </project>"#;
//! let project = StageProject::read(text).map_err(|errors| errors[0].in_file("duel.meproj"))?;
//! assert_eq!(project.source_of("anna"), "models/anna.glb");
//!
//! // The cast of the project is that of its scripts too.
//! let duel = r#"<script version="1"><cast><role id="a" model="anna"/></cast><shot who="wide"/></script>"#;
//! let script = StageScript::read_of(duel, Some(&project)).map_err(|errors| errors[0].in_file("duel.xml"))?;
//! assert_eq!((script.things().len(), script.rate().frame(30).seconds()), (2, 1.0));
//! # Ok::<(), String>(())
//! ```
//!
//! [`crate::stage::table::PROJECTS`] has every element and attribute. All files are named relative to the project, with `/`, and none of
//! them is above its folder. Changes of a project are splices of its text ([`crate::stage::splice`]), as those of scripts are.

use super::script::{
    ElementOrigin, ErrorList, SHARED, ScriptElement, ScriptError, ScriptTree, read_tree, suggestion,
};
use super::table::{ElementGroup, PROJECTS};
use super::time::{Decimal, StageRate, StageTime, parse_time};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// A project whose names are resolved. Never changes.
#[derive(Clone, Debug)]
pub struct StageProject {
    /// Shared with every script that is read with it.
    tree: Arc<ScriptTree>,
}

/// Attributes that name an element of the project: element, attribute, and the name of the element that is meant.
const NAMED: [(&str, &str, &str); 2] = [("edits", "of", "model"), ("movie", "script", "script")];

/// Elements of which a project has at most one.
const SINGLE: [&str; 4] = ["models", "scene", "cast", "lines"];

impl StageProject {
    /// Reads a project. Allocates in proportion to the text; the text is shared, not copied.
    ///
    /// # Errors
    ///
    /// Everything that is wrong, in the order of the text, as [`crate::stage::script::StageScript::read`] reports it.
    pub fn read(text: impl Into<Arc<str>>) -> Result<Self, Vec<ScriptError>> {
        let text = text.into();
        let project = Self { tree: Arc::new(read_tree(&text, &PROJECTS)?) };
        let lines = project.tree.lines().clone();
        let mut errors = ErrorList::new(&lines);
        project.check_names(&mut errors);
        project.check_single(&mut errors);
        if errors.is_empty() { Ok(project) } else { Err(errors.sorted()) }
    }

    /// Returns the text and its elements; the first one is the project.
    pub fn tree(&self) -> &ScriptTree {
        &self.tree
    }

    /// Returns the frames per second of what does not say so itself.
    pub fn rate(&self) -> StageRate {
        self.tree.elements()[0].value("fps").and_then(StageRate::parse).unwrap_or_default()
    }

    /// Returns its title; `None` where it has none.
    pub fn name(&self) -> Option<&str> {
        self.tree.elements()[0].value("name").filter(|name| !name.is_empty())
    }

    /// Returns the part of its scenes that is shown: its start, and its end, each where it is stated.
    pub fn range(&self) -> [Option<StageTime>; 2] {
        ["start", "end"].map(|name| parse_time(self.tree.elements()[0].value(name)?, self.rate()))
    }

    /// Returns the height of the ground in meters.
    pub fn ground(&self) -> f64 {
        let scene = self.elements_called("scene").next();
        let height = scene.and_then(|scene| Decimal::parse(scene.value("ground")?));
        height.map_or(0.0, Decimal::to_f64)
    }

    /// Returns the elements called `name` outside of the cast, in the order of the text.
    pub fn elements_called<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a ScriptElement> {
        let elements = self.tree.elements().iter();
        elements.filter(move |element| element.row.name == name && element.row.group != ElementGroup::Thing)
    }

    /// Returns the element called `name` with this id.
    pub fn element_with_id(&self, name: &str, id: &str) -> Option<&ScriptElement> {
        self.tree
            .elements()
            .iter()
            .find(|element| element.row.name == name && element.value("id") == Some(id))
    }

    /// Returns the file that scripts mean by `model`: that of the model with this id, or else the text itself.
    pub fn source_of<'a>(&'a self, model: &'a str) -> &'a str {
        self.element_with_id("model", model).and_then(|found| found.value("src")).unwrap_or(model)
    }

    /// Returns the id of the model that scripts mean by `model`, an id or a file; `None` where the project does not have it.
    pub fn model_id<'a>(&'a self, model: &'a str) -> Option<&'a str> {
        if self.element_with_id("model", model).is_some() {
            return Some(model);
        }
        self.elements_called("model").find(|found| found.value("src") == Some(model))?.value("id")
    }

    /// Returns the file of the edits of a model that are not saved into it; `None` where there is none.
    pub fn edits_of(&self, model: &str) -> Option<&str> {
        let id = self.model_id(model)?;
        self.elements_called("edits").find(|edits| edits.value("of") == Some(id))?.value("src")
    }

    /// Returns the file of the script that is meant by `script`, an id or a file.
    ///
    /// # Errors
    ///
    /// The ids of all scripts, where none is meant.
    pub fn script_called(&self, script: &str) -> Result<&str, Vec<&str>> {
        let by_id = self.elements_called("script").find(|found| found.value("id") == Some(script));
        let by_file = || self.elements_called("script").find(|found| found.value("src") == Some(script));
        let found = by_id.or_else(by_file).and_then(|found| found.value("src"));
        found.ok_or_else(|| self.elements_called("script").filter_map(|found| found.value("id")).collect())
    }

    /// Returns the files of its scripts, in the order of the text.
    pub fn scripts(&self) -> impl Iterator<Item = &str> {
        self.elements_called("script").filter_map(|script| script.value("src"))
    }

    /// Returns the file of its lines; `None` where it has none.
    pub fn lines(&self) -> Option<&str> {
        self.elements_called("lines").find_map(|lines| lines.value("src"))
    }

    /// Returns every file that it names, each once, in the order of the text. Files that are written, such as movies, are left out.
    pub fn files(&self) -> Vec<&str> {
        let (mut files, mut known) = (Vec::new(), HashSet::new());
        let mut sources: HashMap<&str, &str> = HashMap::new();
        for model in self.elements_called("model") {
            let Some((id, source)) = model.value("id").zip(model.value("src")) else { continue };
            sources.entry(id).or_insert(source);
        }
        for element in self.tree.elements() {
            for name in ["src", "model", "sky"] {
                let written = element.attribute(name).map(|attribute| &*attribute.value);
                let file = written.map(|file| match name {
                    "model" => sources.get(file).copied().unwrap_or(file),
                    _ => file,
                });
                files.extend(file.filter(|file| known.insert(*file)));
            }
        }
        files
    }

    /// Returns kind and id of the things of its cast, in the order of the text.
    pub fn things(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let things = self.tree.elements().iter().filter(|element| element.row.group == ElementGroup::Thing);
        things.filter_map(|thing| Some((thing.row.name, thing.value("id")?)))
    }

    /// Returns the things of its cast for a script, with [`SHARED`] added to their bytes.
    pub(super) fn shared_things(&self) -> impl Iterator<Item = ScriptElement> {
        let things = self.tree.elements().iter().filter(|element| element.row.group == ElementGroup::Thing);
        things.map(move |thing| {
            let mut thing = thing.clone();
            (thing.parent, thing.origin) = (None, ElementOrigin::Project);
            let ranges = thing
                .attributes
                .iter_mut()
                .flat_map(|own| [&mut own.range, &mut own.name, &mut own.value_range]);
            for range in ranges.chain([&mut thing.range, &mut thing.name]) {
                (range.start, range.end) = (range.start + SHARED, range.end + SHARED);
            }
            thing
        })
    }

    /// Separates the errors of a script of this project: those of its own text, and those of the shared cast, with their places in the text of
    /// the project.
    pub fn separated(&self, errors: Vec<ScriptError>) -> (Vec<ScriptError>, Vec<ScriptError>) {
        let (shared, own): (Vec<ScriptError>, _) =
            errors.into_iter().partition(|error| error.range.start >= SHARED);
        let placed = |error: ScriptError| {
            let range = error.range.start - SHARED..error.range.end - SHARED;
            ScriptError { place: self.tree.place(range.start), range, ..error }
        };
        (own, shared.into_iter().map(placed).collect())
    }

    /// Returns the position in [`Self::tree`] of an element that a script shares with the project; `None` for one of the script itself.
    pub fn element_of(&self, shared: &ScriptElement) -> Option<usize> {
        let start = shared.range.start.checked_sub(SHARED)?;
        self.tree.elements().iter().position(|element| element.range.start == start)
    }

    /// Checks that ids are unique, and that what is named is there.
    fn check_names(&self, errors: &mut ErrorList) {
        let mut ids: HashMap<&str, &ScriptElement> = HashMap::new();
        for element in self.tree.elements() {
            let Some(id) = element.value("id") else { continue };
            if let Some(first) = ids.insert(id, element) {
                let place = errors.place(first.range.start);
                let message = format!("the id \"{id}\" is used at {place} already");
                errors.add(element.value_range("id"), message, "an id names one part of a project");
            }
        }
        for (name, attribute, kind) in NAMED {
            for element in self.elements_called(name) {
                let Some(id) = element.value(attribute) else { continue };
                let found = ids.get(id).is_some_and(|found| found.row.name == kind);
                if !found {
                    // A suggestion costs more than what is not reported any more is worth.
                    if errors.is_full() {
                        return;
                    }
                    let known = self.elements_called(kind).filter_map(|element| element.value("id"));
                    let help = suggestion(id, &format!("{kind}s"), known);
                    errors.add(element.value_range(attribute), format!("there is no {kind} \"{id}\""), help);
                }
            }
        }
    }

    /// Checks that nothing is there twice that there is once.
    fn check_single(&self, errors: &mut ErrorList) {
        for name in SINGLE {
            for second in self.elements_called(name).skip(1) {
                errors.add(second.name.clone(), format!("a project has one <{name}>"), "");
            }
        }
    }
}
