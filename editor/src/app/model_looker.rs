//! Reads models that were dropped on a scene in a job, to know whether they are figures or objects.

use super::interface::Interface;
use crate::panels::Request;
use crate::panels::dropped_files::{DroppedModel, DroppedModels, UnknownModels};
use crate::panels::status::MessageSeverity;
use dragonfly_document::{Cancel, Source, load_model};
use dragonfly_runtime::{Address, Job, JobContext};

/// The models with what is known of them now, or the reason why one cannot be added.
pub(super) type LookedModels = Result<DroppedModels, String>;

/// Starts to read the models.
pub(super) fn look(unknown: UnknownModels, to: &Address<LookedModels>) -> std::io::Result<()> {
    let failed = |reason: &str| -> LookedModels { Err(format!("Nothing was added to the scene: {reason}")) };
    let work = move |_: &JobContext<LookedModels>| looked(unknown).or_else(|reason| failed(&reason));
    Job::start(to, "models dropped on a scene", work, failed)?.detach();
    Ok(())
}

/// Reads the models.
///
/// # Errors
///
/// The first one that cannot be read, with its name and the reason.
fn looked(unknown: UnknownModels) -> LookedModels {
    let UnknownModels { models, is_role, place, sounds, hashes, copied, target } = unknown;
    let looked = |(file, name)| -> Result<DroppedModel, String> {
        match load_model(&Source::File(file), &mut |_| {}, &Cancel::default()) {
            Ok(loaded) => Ok(DroppedModel::of(name, &loaded, is_role)),
            Err(error) => Err(format!("{name}: {error}")),
        }
    };
    let models: Result<Vec<DroppedModel>, String> = models.into_iter().map(looked).collect();
    Ok(DroppedModels { models: models?, place, sounds, hashes, copied, target })
}

/// Adds the models to the scene.
pub(super) fn added(interface: &mut Interface, answer: LookedModels) {
    match answer {
        Ok(dropped) => {
            let effect = interface.state.execute(Request::DroppedModels(Box::new(dropped)));
            interface.effects.extend(effect);
        }
        Err(reason) => interface.state.say(MessageSeverity::Error, reason),
    }
}
