//! Comparing the take that is shown with a take of another file.

use crate::panels::compared::CompareWith;
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::LoadedModel;
use std::sync::Arc;

/// The panel of the differences.
const PANEL: &str = "differences";

/// Compares with the take as it was opened, or with nothing if that was compared.
pub(in crate::panels) fn toggle_opened(workspace: &mut Workspace) -> Option<Effect> {
    let is_compared = workspace.compared == CompareWith::Opened;
    workspace.compared = if is_compared { CompareWith::Nothing } else { CompareWith::Opened };
    (!is_compared).then_some(Effect::ShowPanel(PANEL))
}

/// Compares with the file that was read: with its take of the same name, or else with its first.
pub(in crate::panels) fn file_read(workspace: &mut Workspace, file: Arc<LoadedModel>) -> Option<Effect> {
    let title = file.title.clone();
    let takes = &file.model.animation.takes;
    if takes.is_empty() {
        let text = format!("{title} has no takes: nothing is compared");
        workspace.say(MessageSeverity::Warning, text);
        return None;
    }
    let panels = workspace.read();
    let name = panels.shown_take().map(|take| take.name.as_str());
    let same = takes.iter().position(|take| Some(take.name.as_str()) == name);
    workspace.compared = CompareWith::File(same.unwrap_or_default());
    workspace.compared_file.set_file(file);
    let own = workspace.model.loaded().map(|loaded| Arc::clone(&loaded.model.animation.skeleton));
    workspace.compared_file.update(own.as_ref());
    if workspace.compared_file.is_unpaired() {
        let text =
            format!("No bone of {title} has the name of a bone of this model: nothing can be compared");
        workspace.say(MessageSeverity::Warning, text);
    }
    Some(Effect::ShowPanel(PANEL))
}
