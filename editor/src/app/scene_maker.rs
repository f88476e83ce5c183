//! Writes a new scene next to a model, in a job.

use super::interface::Interface;
use crate::panels::scene::{duel_text, free_name};
use crate::panels::status::MessageSeverity;
use crate::panels::{Effect, FileAction};
use dragonfly_document::{Cancel, LoadedModel, Source, Then, load_model};
use dragonfly_runtime::{Address, Context, Job, JobContext, Receiver};
use std::cell::RefCell;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The path of the scene that was written, or the reason why there is none.
pub(super) type SceneAnswer = Result<PathBuf, String>;

/// Height of a role in a new scene, meters, where its model is far from human size.
const HEIGHT: f32 = 1.7;

/// Starts to write a scene of two roles with a model.
pub(super) fn make(model: PathBuf, to: &Address<SceneAnswer>) -> std::io::Result<()> {
    let work = move |_: &JobContext<SceneAnswer>| written(&model);
    Job::start(to, "new scene", work, |reason: &str| Err(reason.to_owned()))?.detach();
    Ok(())
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
    let mut file = std::fs::OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&place)
        .map_err(|error| format!("Cannot write {}: {error}", place.display()))?;
    file.write_all(text.as_bytes()).map_err(|error| format!("Cannot write {}: {error}", place.display()))?;
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
pub(super) struct SceneMakerReceiver(pub Rc<RefCell<Interface>>);

impl Receiver for SceneMakerReceiver {
    type Message = SceneAnswer;

    fn receive(&mut self, answer: SceneAnswer, _main: &mut Context) {
        let mut interface = self.0.borrow_mut();
        match answer {
            Ok(path) => {
                let action = FileAction::Leave(Then::Open(Source::File(path)));
                interface.effects.push(Effect::File(action));
            }
            Err(reason) => {
                interface.state.say(MessageSeverity::Error, format!("No scene was made: {reason}"))
            }
        }
        interface.redraw();
    }
}
