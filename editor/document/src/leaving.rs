//! Leaving the open document: for another one, or to end the program. Unsaved work is asked about, that of a scene and of the model that is
//! edited in it as one.

use super::Source;
use super::message::DocumentReply;
use super::open::Open;
use super::owner::Document;
use super::saving::Then;
use super::waiting_scene::WaitingScene;
use crate::text::sentence;
use std::time::Instant;

impl Document {
    /// Opens a model, or replies that the open one has unsaved work.
    pub(super) fn open_or_ask(&mut self, source: Source, anyway: bool, now: Instant) {
        if anyway && let Some(model) = self.model_at(&source) {
            return self.read_model(model);
        }
        if !anyway && !self.may_leave(now) {
            return self.reply(DocumentReply::Unsaved(Then::Open(source)));
        }
        self.open(source, None);
    }

    /// Replies whether the program may end.
    pub(super) fn quit(&mut self, now: Instant) {
        let reply =
            if self.may_leave(now) { DocumentReply::MayQuit } else { DocumentReply::Unsaved(Then::Quit) };
        self.reply(reply);
    }

    /// Returns whether nothing is unsaved. A scene that waits is shown first, so that the question is about all its work.
    fn may_leave(&mut self, now: Instant) -> bool {
        if let Err(reason) = self.return_to_scene(now) {
            self.reply(DocumentReply::Warning(sentence(&reason)));
        }
        self.open.as_ref().is_none_or(|open| !open.has_unsaved_work())
            && self.scene.as_ref().is_none_or(|scene| !scene.has_unsaved_work())
    }

    /// Marks the unsaved work of the open document as discarded.
    pub(super) fn do_not_save(&mut self) {
        if let Some(open) = &mut self.open {
            open.unwanted = true;
        }
    }

    /// Notes that the open document stays open after all: a decision to discard its work does not count any more.
    pub(super) fn stay(&mut self) {
        let waiting = self.scene.as_mut().map(|scene: &mut WaitingScene| &mut scene.open);
        self.open.as_mut().into_iter().chain(waiting).for_each(|open: &mut Open| open.unwanted = false);
    }

    /// Returns the model that is edited in a scene, if `source` is its file.
    fn model_at(&self, source: &Source) -> Option<super::waiting_scene::SceneModelEdit> {
        let model = &self.scene.as_ref()?.model;
        (source.path() == Some(&*model.path)).then(|| model.clone())
    }
}
