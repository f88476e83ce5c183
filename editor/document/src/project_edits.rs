//! Edits of a model that its project keeps: a file with one edit a line, which the project names.

use super::adapter::{TextFile, TextFiles};
use super::edit::{Edit, EditScript, ScriptLabel, ScriptSplice, TextRef};
use super::outdated_edits::{OutdatedEdits, OutdatedEditsChoice};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::ScriptError;
use dragonfly_anim::stage::splice::{ElementPlace, NewElement, insert, set_attribute};
use std::collections::HashSet;

/// Name of the step of a project by which it gets edits of a model.
const LABEL: ScriptLabel = ScriptLabel::EditModel;

/// A model whose edits a project gets.
pub(super) struct EditedModel<'a> {
    /// The name by which the script means it: its id in the project, or its file.
    pub(super) name: &'a str,
    /// Its file, relative to the folder of the project.
    pub(super) file: &'a str,
    /// Hash of its file.
    pub(super) hash: Option<u64>,
    /// All edits that are not saved into it.
    pub(super) edits: &'a [Edit],
}

/// Returns the edit of the texts of a project by which it has exactly these edits of a model; `None` where it has them already. `has_file`
/// is whether there is a file of this name in the folder of the project.
///
/// # Errors
///
/// The reason why the project cannot have them.
pub(super) fn kept_in(
    texts: &TextFiles,
    model: &EditedModel<'_>,
    has_file: impl Fn(&str) -> bool,
) -> Result<Option<EditScript>, String> {
    let (main, project) = project_of(texts)?;
    let lines = written(model.edits)?;
    let own = project.edits_of(model.name).map(str::to_owned);
    if lines.is_empty() && own.as_deref().is_none_or(|name| texts.called(name).is_none()) {
        return Ok(None);
    }
    let (id, mut text) = with_model(&project, model).ok_or("the text has no place for the model")?;
    let is_used = |name: &str| texts.called(name).is_some() || has_file(name);
    let file = own.clone().unwrap_or_else(|| new_name(&main.name, &id, is_used));
    text = with_edits(&text, &id, &file, model.hash).ok_or("the text has no place for the edits")?;
    let mut parts = Vec::new();
    let text_ref = || Some(TextRef::Name(file.clone()));
    match texts.called(&file) {
        Some(old) => parts.extend(
            EditScript::between(&old.text, &lines, Some(LABEL))
                .map(|edit| EditScript { text: text_ref(), ..edit }),
        ),
        None => {
            let splices = vec![ScriptSplice { at: 0, old: String::new(), new: lines }];
            let label = Some(LABEL.text().to_owned());
            parts.push(EditScript { text: text_ref(), create: true, splices, label, also: Vec::new() });
        }
    }
    parts.extend(EditScript::between(&main.text, &text, Some(LABEL)));
    let mut parts = parts.into_iter();
    let Some(first) = parts.next() else { return Ok(None) };
    Ok(Some(EditScript { also: parts.collect(), ..first }))
}

/// Returns the edit of the texts of a project by which its edits of a model count as made for a file with this hash; `None` where they
/// do already.
///
/// # Errors
///
/// The reason why the project cannot state it.
fn made_for(texts: &TextFiles, name: &str, hash: u64) -> Result<Option<EditScript>, String> {
    let (main, project) = project_of(texts)?;
    let missing = || format!("the project has no edits of {name}");
    let (id, file) = project.model_id(name).zip(project.edits_of(name)).ok_or_else(missing)?;
    let text = with_edits(&main.text, id, file, Some(hash)).ok_or("the text has no place for the hash")?;
    Ok(EditScript::between(&main.text, &text, Some(LABEL)))
}

/// Returns the edit of the texts of a project that carries out the choice of the user about edits that were made for other files; `None` where
/// it changes nothing.
///
/// # Errors
///
/// The reason why the project cannot have it.
pub(super) fn settled(
    texts: &TextFiles,
    outdated: &[OutdatedEdits],
    choice: OutdatedEditsChoice,
) -> Result<Option<EditScript>, String> {
    let mut new = texts.clone();
    for edits in outdated {
        let edit = match choice {
            OutdatedEditsChoice::Apply => made_for(&new, &edits.model, edits.hash)?,
            OutdatedEditsChoice::Remove => {
                let (name, hash) = (&*edits.model, Some(edits.hash));
                // The project has the model and its edits, so that neither gets a new name.
                kept_in(&new, &EditedModel { name, file: name, hash, edits: &[] }, |_| false)?
            }
        };
        if let Some(edit) = edit {
            edit.apply_to(&mut new);
        }
    }
    let label = match choice {
        OutdatedEditsChoice::Apply => ScriptLabel::ApplyEdits,
        OutdatedEditsChoice::Remove => ScriptLabel::RemoveEdits,
    };
    let part = |(index, (old, new)): (usize, (&TextFile, &TextFile))| {
        let edit = EditScript::between(&old.text, &new.text, Some(label))?;
        Some(EditScript { text: (index > 0).then_some(TextRef::Index(index)), ..edit })
    };
    let mut parts = texts.list().iter().zip(new.list()).enumerate().filter_map(part);
    let Some(first) = parts.next() else { return Ok(None) };
    Ok(Some(EditScript { also: parts.collect(), ..first }))
}

/// Returns the main text and its project.
///
/// # Errors
///
/// The first error of the text.
fn project_of(texts: &TextFiles) -> Result<(&TextFile, StageProject), String> {
    let main = texts.list().first().ok_or("the scene has no text")?;
    let wrong =
        |errors: Vec<ScriptError>| errors.first().map_or_else(String::new, |error| error.in_file(&main.name));
    Ok((main, StageProject::read(main.text.clone()).map_err(wrong)?))
}

/// Returns edits as a text, one a line.
fn written(edits: &[Edit]) -> Result<String, String> {
    let mut text = String::new();
    for edit in edits {
        text += &serde_json::to_string(edit).map_err(|error| error.to_string())?;
        text.push('\n');
    }
    Ok(text)
}

/// Returns the id of the model in the project, and the text of the project with it.
fn with_model(project: &StageProject, model: &EditedModel<'_>) -> Option<(String, String)> {
    let text = project.tree().text();
    if let Some(id) = project.model_id(model.name) {
        return Some((id.to_owned(), text.to_string()));
    }
    with_new_model(project, model.file)
}

/// Returns the id of a new model of the project, and the text of the project with it.
fn with_new_model(project: &StageProject, file: &str) -> Option<(String, String)> {
    let ids: HashSet<&str> = project.tree().elements().iter().filter_map(|one| one.value("id")).collect();
    let id = new_id(file, |id| ids.contains(id));
    let element = NewElement::new("model").with("id", &id).with("src", file);
    let position = |project: &StageProject, name: &str| {
        project.tree().elements().iter().rposition(|element| element.row.name == name)
    };
    let mut project = project.clone();
    if position(&project, "models").is_none() {
        let new = insert(project.tree(), ElementPlace::First(0), &NewElement::new("models"))?;
        project = StageProject::read(new.apply(project.tree().text())).ok()?;
    }
    let place = match position(&project, "model") {
        Some(last) => ElementPlace::After(last),
        None => ElementPlace::First(position(&project, "models")?),
    };
    let new = insert(project.tree(), place, &element)?;
    Some((id, new.apply(project.tree().text())))
}

/// Returns the edit of a project by which it lists these models, each by its file relative to the folder of the project and the hash of the file. A hash
/// that it states already stays. `None` where the project has all of them.
pub fn listed_models<'a>(
    project: &StageProject,
    models: impl IntoIterator<Item = (&'a str, u64)>,
    label: ScriptLabel,
) -> Option<EditScript> {
    let mut new = project.clone();
    for (file, hash) in models {
        let find = |project: &StageProject| {
            let elements = project.tree().elements();
            elements.iter().position(|one| one.row.name == "model" && one.value("src") == Some(file))
        };
        if find(&new).is_none() {
            new = StageProject::read(with_new_model(&new, file)?.1).ok()?;
        }
        let model = find(&new)?;
        if new.tree().elements()[model].value("hash").is_none() {
            let splices = set_attribute(new.tree(), model, "hash", &format!("{hash:016x}"))?;
            new = StageProject::read(splices.apply(new.tree().text())).ok()?;
        }
    }
    EditScript::between(project.tree().text(), new.tree().text(), Some(label))
}

/// Returns the text of a project that names the edits of a model, with the hash of the file for which they were made.
fn with_edits(text: &str, id: &str, file: &str, hash: Option<u64>) -> Option<String> {
    let project = StageProject::read(text).ok()?;
    let is_model = |project: &StageProject| {
        let elements = project.tree().elements();
        elements.iter().position(|element| element.row.name == "model" && element.value("id") == Some(id))
    };
    let mut text = text.to_owned();
    if project.edits_of(id).is_none() {
        let element = NewElement::new("edits").with("of", id).with("src", file);
        text = insert(project.tree(), ElementPlace::After(is_model(&project)?), &element)?.apply(&text);
    }
    if let Some(hash) = hash {
        let project = StageProject::read(text.as_str()).ok()?;
        let value = format!("{hash:016x}");
        text = set_attribute(project.tree(), is_model(&project)?, "hash", &value)?.apply(&text);
    }
    Some(text)
}

/// Returns an id from the name of a file that is not used.
fn new_id(file: &str, is_used: impl Fn(&str) -> bool) -> String {
    let name = file.rsplit('/').next().unwrap_or(file);
    let stem = name.split('.').next().unwrap_or(name);
    let letter =
        |letter: char| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' };
    let mut id: String = stem.chars().map(letter).collect();
    if !id.starts_with(|first: char| first.is_ascii_alphabetic()) {
        id = format!("model_{id}");
    }
    let numbered = (2..).map(|number| format!("{id}_{number}"));
    std::iter::once(id.clone()).chain(numbered).find(|id| !is_used(id)).unwrap_or(id)
}

/// Returns the name of a new file of edits: `duel.edits/anna.jsonl`. A file that is there, although the project does not name it, may
/// be needed by an older version of the project.
fn new_name(main: &str, id: &str, is_used: impl Fn(&str) -> bool) -> String {
    let stem = main.rsplit_once('.').map_or(main, |(stem, _)| stem);
    let numbered = (2..).map(|number| format!("{stem}.edits/{id}-{number}.jsonl"));
    let mut names = std::iter::once(format!("{stem}.edits/{id}.jsonl")).chain(numbered);
    names.find(|name| !is_used(name)).unwrap_or_default()
}
