//! Effects of the panels: what they ask of the document, the graphics thread, jobs, dialogs and the window.

use super::editor_runtime::{Asked, Running};
use super::file_dialog::{self, Purpose};
use super::{model_looker, scene_files, scene_maker, state_trace};
use crate::panels::status::MessageSeverity;
use crate::panels::{Effect, Request};

impl Running {
    /// Carries out an effect of the panels. Returns whether the program is to end.
    pub(super) fn effect(&mut self, effect: Effect) -> bool {
        if let Effect::File(action) = effect {
            return self.file_action(action);
        }
        let graphics = &self.parts.graphics;
        let mut interface = self.parts.interface.borrow_mut();
        match effect {
            // Handled above.
            Effect::File(_) => {}
            // `take_effects` has replaced these by other effects.
            Effect::Change(_)
            | Effect::Changes(_)
            | Effect::Cut(..)
            | Effect::CancelDrag
            | Effect::ReleaseDrag => {}
            Effect::OpenDialog | Effect::CompareDialog if interface.asking => {
                interface.state.say(MessageSeverity::Info, "The dialog for opening files is open already");
            }
            Effect::Choose(..) if interface.asking => {
                interface.state.say(MessageSeverity::Info, "A file dialog is open already");
            }
            Effect::Choose(choice, folder) => {
                match file_dialog::ask(Purpose::Choose(choice), folder, self.answers.clone()) {
                    Ok(()) => interface.asking = true,
                    Err(error) => {
                        let text = format!("The file dialog could not be opened: {error}");
                        interface.state.say(MessageSeverity::Error, text);
                    }
                }
            }
            Effect::OpenDialog | Effect::CompareDialog => {
                let compares = effect == Effect::CompareDialog;
                let purpose = if compares { Purpose::Compare } else { Purpose::Open };
                let recent = interface.state.read().settings.recent.first();
                let folder = recent.and_then(|path| path.parent()).map(std::path::Path::to_owned);
                match file_dialog::ask(purpose, folder, self.answers.clone()) {
                    Ok(()) => interface.asking = true,
                    Err(error) => {
                        let text = format!("The file dialog could not be opened: {error}");
                        interface.state.say(MessageSeverity::Error, text);
                    }
                }
            }
            Effect::Send(number, change) => {
                if let Some(document) = &self.document {
                    state_trace::asked(&change);
                    document.change_numbered(number, change);
                }
            }
            Effect::Copy(text) => interface.copy(text),
            Effect::PastePose { mirrored } => {
                let text = interface.clipboard();
                let effect = interface.state.execute(Request::PastePose { text, mirrored });
                interface.effects.extend(effect);
            }
            Effect::Pick(at, choice) => {
                self.tickets += 1;
                self.asked = Some((self.tickets, Asked::Click(at, choice)));
                let scale = interface.pixels_per_point();
                graphics.pick_all([at.x * scale, at.y * scale], self.tickets);
            }
            Effect::Catch(region, choice) => {
                self.tickets += 1;
                self.asked = Some((self.tickets, Asked::Region(choice)));
                graphics.catch(region, self.tickets);
            }
            Effect::FullScreen => interface.toggle_full_screen(),
            Effect::TogglePanel(id) => interface.toggle_panel(id),
            Effect::ShowPanel(id) => interface.show_panel(id),
            Effect::ResetLayout => interface.reset_layout(),
            Effect::RetryDevice => graphics.resume(),
            Effect::NewProject(script) => {
                if let Err(error) = scene_maker::make_project(script, &self.scenes) {
                    interface.state.say(MessageSeverity::Error, format!("No project was made: {error}"));
                }
            }
            Effect::DemoScene(folder) => {
                if let Err(error) = scene_maker::make_demo(folder, &self.scenes) {
                    interface.state.say(MessageSeverity::Error, format!("No scene was made: {error}"));
                }
            }
            Effect::LookAtModels(unknown) => {
                if let Err(error) = model_looker::look(*unknown, &self.looked) {
                    interface.state.say(MessageSeverity::Error, format!("Nothing was added: {error}"));
                }
            }
            Effect::LookAtFiles(wanted) => {
                let job = scene_files::look(wanted, &self.scene_files);
                if let Err(error) = self.file_jobs.keep(job) {
                    interface.state.say(MessageSeverity::Error, format!("No file was read: {error}"));
                }
            }
            Effect::CopyFiles(wanted) => {
                let job = scene_files::copy(wanted, &self.scene_files);
                if let Err(error) = self.file_jobs.keep(job) {
                    interface.state.say(MessageSeverity::Error, format!("Nothing was copied: {error}"));
                }
            }
            Effect::NewScene(model) => {
                if let Err(error) = scene_maker::make(model, &self.scenes) {
                    interface.state.say(MessageSeverity::Error, format!("No scene was made: {error}"));
                }
            }
        }
        interface.redraw();
        false
    }
}
