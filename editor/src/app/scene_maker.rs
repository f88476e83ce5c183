//! Writes a new scene next to a model, or a project next to a scene, in a job.

use super::interface::Interface;
use crate::panels::scene::{ListedModel, duel_text, free_name, project_texts};
use crate::panels::status::MessageSeverity;
use crate::panels::{Effect, FileAction};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_anim::stage::script::ScriptTree;
use dragonfly_document::{Cancel, Folder, Source, Then, load_model, make_folder, read_file};
use dragonfly_runtime::{Address, Job, JobContext};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The path of the scene that was written, or the reason why there is none.
pub type SceneAnswer = Result<PathBuf, String>;

/// Starts to write a project with a scene of two roles with a model.
pub fn make(model: PathBuf, to: &Address<SceneAnswer>) -> std::io::Result<()> {
    start_scene(to, move || {
        let folder = model.parent().ok_or("the model is in no folder")?.to_owned();
        written(&folder, [model.clone(), model], None)
    })
}

/// Starts to write two figures, and a project with a scene of them, into a folder.
pub fn make_demo(folder: PathBuf, to: &Address<SceneAnswer>) -> std::io::Result<()> {
    start_scene(to, move || {
        let figures = figures(&folder)?;
        written(&folder, [figures.join(FIGURES[0].0), figures.join(FIGURES[1].0)], Some("Idle"))
    })
}

fn start_scene(
    to: &Address<SceneAnswer>,
    write: impl FnOnce() -> SceneAnswer + Send + 'static,
) -> std::io::Result<()> {
    let failed = |reason: &str| -> SceneAnswer { Err(format!("No scene was made: {reason}")) };
    let work = move |_: &JobContext<SceneAnswer>| write().or_else(|reason| failed(&reason));
    Job::start(to, "new scene", work, failed)?.detach();
    Ok(())
}

/// The figures of a new scene: two models, which share a file, and their pictures.
const FIGURES: [(&str, &[u8]); 5] = [
    ("rogue.gltf", include_bytes!("../../examples/models/rogue.gltf")),
    ("rival.gltf", include_bytes!("../../examples/models/rival.gltf")),
    ("rogue.bin", include_bytes!("../../examples/models/rogue.bin")),
    ("rogue.png", include_bytes!("../../examples/models/rogue.png")),
    ("rival.png", include_bytes!("../../examples/models/rival.png")),
];

/// Returns the folder of the figures in a folder. Writes them, unless they are there already; other files stay as they are.
fn figures(folder: &Path) -> Result<PathBuf, String> {
    let names =
        std::iter::once("figures".to_owned()).chain((2_u32..).map(|number| format!("figures-{number}")));
    'names: for name in names {
        let place = folder.join(name);
        let mut missing = Vec::new();
        for (file, bytes) in FIGURES {
            let path = place.join(file);
            match std::fs::read(&path) {
                Ok(found) if found == bytes => {}
                Ok(_) => continue 'names,
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => missing.push((path, bytes)),
                Err(error) => return Err(format!("Cannot read {}: {error}", path.display())),
            }
        }
        make_folder(&place.join("figure"))?;
        missing.into_iter().try_for_each(|(path, bytes)| write_new(&path, bytes))?;
        return Ok(place);
    }
    Err(format!("Cannot write to {}", folder.display()))
}

/// Starts to write a project with a script.
pub fn make_project(script: PathBuf, to: &Address<SceneAnswer>) -> std::io::Result<()> {
    let failed = |reason: &str| -> SceneAnswer { Err(format!("No project was made: {reason}")) };
    let work = move |_: &JobContext<SceneAnswer>| written_project(&script).or_else(|reason| failed(&reason));
    Job::start(to, "new project", work, failed)?.detach();
    Ok(())
}

/// Writes a project and a file for its lines next to a script. Files that are there already stay as they are.
fn written_project(script: &Path) -> SceneAnswer {
    let name = script
        .file_name()
        .and_then(|name| name.to_str())
        .ok_or("the name of the script is not Unicode text")?;
    let stem = script.file_stem().and_then(|stem| stem.to_str()).unwrap_or(name);
    let (project, lines) = (script.with_file_name(format!("{stem}.meproj")), format!("{stem}.lines.xml"));
    let folder = script.parent().ok_or("the script is in no folder")?;
    let [project_text, lines_text] = project_texts(name, &lines, &models_of(script, folder));
    let lines = script.with_file_name(lines);
    write_new(&lines, lines_text.as_bytes())?;
    if let Err(reason) = write_new(&project, project_text.as_bytes()) {
        // A file of lines alone would stop every later try. If it cannot be removed, the next try reports it.
        let _removed = std::fs::remove_file(&lines);
        return Err(reason);
    }
    Ok(project)
}

/// Returns the models that a script names, with the hashes of their files; none of a script with errors.
fn models_of(script: &Path, folder: &Path) -> Vec<ListedModel> {
    let text = std::fs::read_to_string(script).unwrap_or_default();
    let Ok(tree) = ScriptTree::read(text) else { return Vec::new() };
    let named = tree.elements().iter().filter_map(|element| element.value("model").map(str::to_owned));
    let door = Folder::new(folder);
    let hash = |file: &str| {
        let bytes = door.as_ref().ok()?.read(file, FILE_BYTES).ok()?;
        Some(dragonfly_store::hash(&bytes))
    };
    ListedModel::listed(named.map(|file| {
        let hash = hash(&file);
        (file, hash)
    }))
}

/// Writes a file that is not there yet; none is left over where it cannot be written.
fn write_new(place: &Path, bytes: &[u8]) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("Cannot write {}: {error}", place.display());
    let file = std::fs::OpenOptions::new().write(true).create_new(true).open(place);
    let mut file = file.map_err(failed)?;
    file.write_all(bytes).map_err(|error| {
        let _removed = std::fs::remove_file(place);
        failed(error)
    })
}

/// Writes a project, its script and its file of lines into a folder, with two models in it or below; both play a take, the first that moves where none is
/// named.
fn written(folder: &Path, models: [PathBuf; 2], take: Option<&str>) -> SceneAnswer {
    let [first, second] = &models;
    let loaded = load_model(&Source::File(first.clone()), &mut |_| {}, &Cancel::default())
        .map_err(|error| error.to_string())?;
    let mut files = Vec::new();
    for path in [first, second] {
        let below = path.strip_prefix(folder).map_err(|_| "the model is in another folder")?;
        let parts: Option<Vec<&str>> = below.iter().map(|part| part.to_str()).collect();
        let name = parts.ok_or("the name of the model is not Unicode text")?.join("/");
        let bytes = read_file(path, FILE_BYTES).map_err(|error| format!("{name}: {error}"))?;
        files.push((name, Some(dragonfly_store::hash(&bytes))));
    }
    let listed = ListedModel::listed(files);
    let ids = [listed.first(), listed.last()].map(|model| model.map_or("", |model| model.id.as_str()));
    let mut moving = loaded.model.animation.takes.iter().filter(|take| take.length > 0.0);
    // Standing figures are the start of most scenes.
    let idle = moving.clone().find(|take| take.name.to_lowercase().contains("idle"));
    let take = take.or_else(|| idle.or_else(|| moving.next()).map(|take| take.name.as_str()));
    let scale = loaded.human_scale();
    let face = match loaded.model.animation.skeleton.bones.iter().find(|bone| is_head(&bone.name)) {
        Some(head) => format!("ben.{}", head.name),
        None => format!("1 {:.2} 0", 0.85 * f64::from(loaded.height()) * scale),
    };
    let script = free_name(folder, Path::exists);
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let (project, lines) = (script.with_extension("meproj"), script.with_extension("lines.xml"));
    let [project_text, lines_text] = project_texts(&name(&script), &name(&lines), &listed);
    write_new(&script, duel_text(ids, scale, &face, take).as_bytes())?;
    write_new(&lines, lines_text.as_bytes())?;
    // The project last: what it names is there.
    write_new(&project, project_text.as_bytes())?;
    Ok(project)
}

/// Returns whether a bone with this name is a head: `head` is one of its words.
fn is_head(name: &str) -> bool {
    name.split(|letter: char| !letter.is_ascii_alphabetic()).any(|word| word.eq_ignore_ascii_case("head"))
}

/// Opens the scene that a job has written.
pub(super) fn made(interface: &mut Interface, answer: SceneAnswer) {
    match answer {
        Ok(path) => {
            let action = FileAction::Leave(Then::Open(Source::File(path)));
            interface.effects.push(Effect::File(action));
        }
        Err(reason) => interface.state.say(MessageSeverity::Error, reason),
    }
}
