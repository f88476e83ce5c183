//! Writes a new scene next to a model, or a project next to a scene, in a job.

use super::interface::Interface;
use crate::panels::scene::{duel_text, free_name, project_texts};
use crate::panels::status::MessageSeverity;
use crate::panels::{Effect, FileAction};
use dragonfly_document::demo::DRAGONFLY_GLB;
use dragonfly_document::{Cancel, LoadedModel, Source, Then, load_model};
use dragonfly_runtime::{Address, Job, JobContext};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The path of the scene that was written, or the reason why there is none.
pub type SceneAnswer = Result<PathBuf, String>;

/// Height of a role in a new scene, meters, where its model is far from human size.
const HEIGHT: f32 = 1.7;

/// Starts to write a scene of two roles with a model.
pub(super) fn make(model: PathBuf, to: &Address<SceneAnswer>) -> std::io::Result<()> {
    start_scene(to, move || written(&model))
}

/// Starts to write the built-in model, and a scene of two roles with it, into a folder.
pub fn make_demo(folder: PathBuf, to: &Address<SceneAnswer>) -> std::io::Result<()> {
    start_scene(to, move || written(&demo_model(&folder)?))
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

/// Returns the file of the built-in model in a folder. Writes it, unless it is there already; other files of its name stay as they are.
fn demo_model(folder: &Path) -> Result<PathBuf, String> {
    let names = std::iter::once("dragonfly.glb".to_owned())
        .chain((2_u32..).map(|number| format!("dragonfly-{number}.glb")));
    for name in names {
        let place = folder.join(name);
        match std::fs::read(&place) {
            Ok(bytes) if bytes == DRAGONFLY_GLB => return Ok(place),
            Ok(_) => {}
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                write_new(&place, DRAGONFLY_GLB)?;
                return Ok(place);
            }
            Err(error) => return Err(format!("Cannot read {}: {error}", place.display())),
        }
    }
    Err(format!("Cannot write to {}", folder.display()))
}

/// Starts to write a project with a script.
pub(super) fn make_project(script: PathBuf, to: &Address<SceneAnswer>) -> std::io::Result<()> {
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
    let [project_text, lines_text] = project_texts(name, &lines);
    let lines = script.with_file_name(lines);
    write_new(&lines, lines_text.as_bytes())?;
    if let Err(reason) = write_new(&project, project_text.as_bytes()) {
        // A file of lines alone would stop every later try. If it cannot be removed, the next try reports it.
        let _removed = std::fs::remove_file(&lines);
        return Err(reason);
    }
    Ok(project)
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

fn written(path: &Path) -> SceneAnswer {
    let loaded = load_model(&Source::File(path.to_owned()), &mut |_| {}, &Cancel::default())
        .map_err(|error| error.to_string())?;
    let folder = path.parent().ok_or("the model is in no folder")?;
    let name =
        path.file_name().and_then(|name| name.to_str()).ok_or("the name of the model is not Unicode text")?;
    let moving = loaded.model.animation.takes.iter().find(|take| take.length > 0.0);
    let text = duel_text([name, name], scale_of(&loaded), moving.map(|take| take.name.as_str()));
    let place = free_name(folder, Path::exists);
    write_new(&place, text.as_bytes())?;
    Ok(place)
}

/// Returns the factor that makes a model as high as a human, where it is much larger or smaller.
fn scale_of(loaded: &LoadedModel) -> f64 {
    let height = loaded.bounds.max.y - loaded.bounds.min.y;
    if !(height.is_finite() && height > 0.0) || (0.5..=4.0).contains(&height) {
        return 1.0;
    }
    let scale = f64::from(HEIGHT / height);
    // Two digits, so that it is easy to read.
    let digits = 10_f64.powi(1 - scale.log10().floor() as i32);
    (scale * digits).round() / digits
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
