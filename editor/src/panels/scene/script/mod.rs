//! The script of a scene as a text that one writes, with colors, suggestions and errors.

mod coloring;
pub(super) mod cursor;
mod error_list;
pub(super) mod find;
mod lines;
mod margin;
mod popup;
pub(super) mod text_choice;
mod typed_steps;
mod typed_text;
mod typing;

use super::super::context::PanelContext;
use super::super::panel::PanelSubject;
use super::super::request::Request;
use super::super::theme::Theme;
use super::super::{Panel, PanelPlace, widgets};
use super::SceneRequest;
use crate::panels::commands::Id as CommandId;
use coloring::ScriptLayout;
use cursor::{cursor_request, is_text_of, selected_range, with_names};
use dragonfly_anim::stage::script::ScriptError;
use dragonfly_anim::stage::writing::completions;
use dragonfly_document::{Change, SceneView};
use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{
    CornerRadius, Event, EventFilter, Frame, Id, Key, Margin, Modifiers, Rect, ScrollArea, TextBuffer,
    TextEdit, Ui, pos2,
};
use error_list::{ListClick, SceneErrorList};
use find::{FindEvent, ScriptFind};
use lines::{byte_of, characters_before, lines_of, moved_position};
use popup::{SuggestionKey, SuggestionList};
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;
use text_choice::ShownText;
use typed_steps::typed_steps;
use typed_text::TypedText;
use typing::{TypedWord, WrittenText};

/// The editor of the script.
#[derive(Debug, Default)]
pub struct ScriptPanel {
    buffer: TypedText,
    /// The text of the document that the buffer shows.
    of: Option<Arc<str>>,
    layout: ScriptLayout,
    word: TypedWord,
    suggestions: SuggestionList,
    /// Byte of the cursor in the last request about it.
    told: Option<usize>,
    /// Whether what is at the cursor is to be selected once the script is that of the text: that of an earlier one has other things there.
    asks: bool,
    /// The selected range to which the text was scrolled last.
    followed: Option<Range<usize>>,
    /// Byte to which the cursor moves in the next frame.
    jump: Option<usize>,
    /// Height of the text in the last frame.
    height: f32,
    /// The caret in the last frame.
    caret: Option<CCursor>,
    /// The text that is shown.
    shown: ShownText,
    errors: SceneErrorList,
    find: ScriptFind,
    /// The found place that is brought into sight in this frame.
    found: Option<Range<usize>>,
}

impl Panel for ScriptPanel {
    fn id(&self) -> &'static str {
        "script"
    }

    fn title(&self) -> &'static str {
        "Script"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::BelowRight
    }

    fn subject(&self) -> PanelSubject {
        PanelSubject::Scene
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some(scene) = context.scene() else {
            (self.of, self.told) = (None, None);
            return widgets::empty(
                ui,
                "The script of a scene appears here",
                "Choose \"New scene of two roles\" in the menu File > New, or open a scene.xml",
            );
        };
        if scene.is_of_project() {
            let chosen = text_choice::show(ui, scene, self.shown, requests);
            self.choose(chosen, requests);
        } else {
            self.choose(Some(ShownText::Script), requests);
        }
        let rect = ui.available_rect_before_wrap();
        ui.painter().rect_filled(rect, CornerRadius::ZERO, Theme::of(ui).sunken);
        let sounds = context.scene_editing.sounds();
        if let Some(scene) = context.view.and_then(|view| view.scene.as_ref()) {
            self.errors.update(scene, sounds);
        }
        let errors = self.errors.height(rect.height());
        if context.find && find::has_focus(ui) {
            self.find.open();
        }
        let bar = if self.find.is_open() { find::HEIGHT } else { 0.0 };
        let edit = Rect::from_min_max(
            pos2(rect.left(), rect.top() + bar),
            pos2(rect.right(), rect.bottom() - errors),
        );
        let list = Rect::from_min_max(pos2(rect.left(), edit.bottom()), rect.max);
        match error_list::show(ui, list, &self.errors) {
            Some(ListClick::Place(text, at)) => {
                self.choose(Some(text), requests);
                self.jump = Some(at);
            }
            Some(ListClick::Find(missing)) => requests.push(Request::Scene(SceneRequest::Find(missing))),
            None => {}
        }
        let id = self.shown.field();
        let text = match self.shown {
            ShownText::Script => context.scene_editing.text(scene),
            ShownText::Project => match context.scene_editing.project_text(scene) {
                Some(text) => text,
                None => return,
            },
        };
        self.follow_document(ui, id, text);
        if self.find.is_open() {
            self.show_find(ui, Rect::from_min_max(rect.min, edit.right_top()), id);
        }
        let mut child = ui.new_child(egui::UiBuilder::new().max_rect(edit));
        child.set_clip_rect(edit.intersect(ui.clip_rect()));
        self.edit(&mut child, id, scene, context, requests);
    }
}

impl ScriptPanel {
    /// Draws the bar that finds a text, and goes to what it found.
    fn show_find(&mut self, ui: &mut Ui, bar: Rect, id: Id) {
        match self.find.show(ui, bar, self.buffer.as_str(), id) {
            Some(FindEvent::Show(range)) => self.found = Some(range),
            Some(FindEvent::Close(Some(at))) => self.jump = Some(at),
            Some(FindEvent::Close(None)) => ui.memory_mut(|memory| memory.request_focus(id)),
            None => {}
        }
    }

    /// Shows another text from now on; a word that is being typed is over then.
    fn choose(&mut self, text: Option<ShownText>, requests: &mut Vec<Request>) {
        let Some(text) = text.filter(|text| *text != self.shown) else { return };
        requests.extend(self.word.end().map(|gesture| Request::Change(Change::Release(gesture))));
        self.shown = text;
        (self.of, self.told, self.followed) = (None, None, None);
        self.buffer.set("");
        self.suggestions.set(None);
    }

    /// Shows a newer text of the document; the cursor stays at what it was at.
    fn follow_document(&mut self, ui: &Ui, id: Id, text: &Arc<str>) {
        if self.of.as_ref().is_some_and(|of| Arc::ptr_eq(of, text)) {
            return;
        }
        self.of = Some(Arc::clone(text));
        if **text == *self.buffer.as_str() {
            return;
        }
        // Another text was shown before: the cursor is where it was in this one.
        let is_other = self.buffer.as_str().is_empty();
        if let Some(mut state) = TextEditState::load(ui.ctx(), id).filter(|_| !is_other) {
            let moved = |cursor: CCursor| {
                let at = byte_of(self.buffer.as_str(), cursor.index.0);
                CCursor::new(characters_before(text, moved_position(at, self.buffer.as_str(), text)))
            };
            let range = state.cursor.char_range().map(|range| {
                let (primary, secondary) = (moved(range.primary), moved(range.secondary));
                CCursorRange { primary, secondary, h_pos: None }
            });
            state.cursor.set_char_range(range);
            state.clear_undoer();
            state.store(ui.ctx(), id);
        }
        self.buffer.set(text);
        self.suggestions.set(None);
    }

    fn edit(
        &mut self,
        ui: &mut Ui,
        id: Id,
        scene: &SceneView,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let has_focus = ui.memory(|memory| memory.has_focus(id));
        let time = ui.input(|input| input.time);
        if has_focus {
            self.history_keys(ui, requests);
            if let SuggestionKey::Taken(index) = self.suggestions.keys(ui) {
                self.take(ui, id, index, time, context, requests);
            }
        }
        if let Some(at) = self.jump.take() {
            let mut state = TextEditState::load(ui.ctx(), id).unwrap_or_default();
            let cursor = CCursor::new(characters_before(self.buffer.as_str(), at));
            state.cursor.set_char_range(Some(CCursorRange::one(cursor)));
            state.store(ui.ctx(), id);
            ui.memory_mut(|memory| memory.request_focus(id));
            self.followed = None;
        }
        let asks = has_focus && ui.input_mut(|input| input.consume_key(Modifiers::CTRL, Key::Space));
        let is_paste = |event: &Event| matches!(event, Event::Paste(text) if !text.is_empty());
        let is_pasted = ui.input(|input| input.events.iter().any(is_paste));
        let width = margin::width(ui, self.buffer.as_str());
        let text_width = self.layout.galley(ui, self.buffer.as_str()).size().x + 24.0;
        let room = text_width.max(ui.available_width() - width - 20.0);
        let layout = &mut self.layout;
        let mut layouter = |ui: &Ui, text: &dyn TextBuffer, _: f32| layout.galley(ui, text.as_str());
        let selected = selected_range(scene, context, self.shown);
        let errors: Vec<&ScriptError> = match self.shown {
            ShownText::Script => scene.errors.iter().collect(),
            ShownText::Project => scene.project_errors.iter().chain(&*scene.shared_errors).collect(),
        };
        // The list of errors takes room from the text, and the cursor stays in sight.
        let is_smaller = has_focus && ui.max_rect().height() < self.height;
        self.height = ui.max_rect().height();
        let found = self.found.take();
        let follows = selected.clone().filter(|range| self.followed.as_ref() != Some(range) && !has_focus);
        let area = ScrollArea::both().auto_shrink(false).id_salt("script");
        let output = area.show(ui, |ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            ui.horizontal_top(|ui| {
                ui.add_space(width);
                let field = TextEdit::multiline(&mut self.buffer)
                    .id(id)
                    .frame(Frame::NONE.inner_margin(Margin { left: 6, right: 12, top: 4, bottom: 12 }))
                    .event_filter(EventFilter {
                        tab: true,
                        horizontal_arrows: true,
                        vertical_arrows: true,
                        // It closes the suggestions, and only then leaves the text.
                        escape: self.suggestions.shown().is_some(),
                    })
                    .desired_width(room)
                    .desired_rows(1)
                    .layouter(&mut layouter);
                let background = ui.painter().add(egui::Shape::Noop);
                let output = field.show(ui);
                let text = self.buffer.as_str();
                let lines = selected.as_ref().map(|range| lines_of(text, range));
                let errors = &errors;
                let sheet = margin::MarginSheet { text, errors, output: &output, width, lines };
                margin::background(ui, background, &sheet);
                margin::show(ui, &sheet);
                if let Some(range) = &follows {
                    margin::scroll_to(ui, &sheet, range);
                }
                self.find.mark(ui, text, &output);
                if let Some(range) = &found {
                    margin::scroll_to(ui, &sheet, range);
                }
                let moved = output.cursor_range.map(|range| range.primary) != self.caret;
                self.caret = output.cursor_range.map(|range| range.primary);
                if let (true, Some(range)) = (is_smaller, output.cursor_range) {
                    let at = byte_of(text, range.primary.index.0);
                    margin::scroll_to(ui, &sheet, &(at..at));
                }
                if let (true, true, Some(range)) = (has_focus, moved, output.cursor_range) {
                    let caret = output.galley.pos_from_cursor(range.primary);
                    margin::show_caret(ui, caret.translate(output.galley_pos.to_vec2()), width);
                }
                output
            })
            .inner
        });
        let output = output.inner;
        let _named = output.response.response.clone().accessible_name(self.shown.name());
        self.followed = selected.or(self.followed.take());
        let cursor = output.cursor_range.map(|range| byte_of(self.buffer.as_str(), range.primary.index.0));
        let before = self.buffer.take_before();
        if let Some(before) = &before {
            let written = if is_pasted { WrittenText::Pasted } else { WrittenText::Typed };
            self.written(before, written, time, context, requests);
            let at = cursor.unwrap_or(self.buffer.as_str().len());
            self.suggest(scene, at, false);
        } else if asks && let Some(at) = cursor {
            self.suggest(scene, at, true);
        }
        let moved = cursor.filter(|at| has_focus && self.told != Some(*at));
        if let Some(at) = moved {
            if before.is_none() && !asks {
                self.suggestions.set(None);
            }
            self.told = Some(at);
            self.followed = None;
            self.asks = true;
        }
        self.asks &= has_focus;
        if self.asks
            && let Some(at) = cursor
            && is_text_of(scene, self.shown, self.buffer.as_str())
        {
            self.asks = false;
            requests.extend(cursor_request(scene, self.shown, at).map(Request::Scene));
        }
        self.finish_word(ui, has_focus, time, requests);
        if let (true, Some(range)) = (has_focus, output.cursor_range) {
            let caret = output.galley.pos_from_cursor(range.primary).translate(output.galley_pos.to_vec2());
            if let Some(index) = self.suggestions.show(ui, caret) {
                self.take(ui, id, index, time, context, requests);
            }
        } else if !ui
            .input(|input| input.pointer.latest_pos())
            .is_some_and(|at| self.suggestions.contains(ui, at))
        {
            self.suggestions.set(None);
        }
    }

    /// Gives undo and redo to the document: it has the steps of this text.
    fn history_keys(&mut self, ui: &Ui, requests: &mut Vec<Request>) {
        let pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
        let redo =
            pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y);
        let undo = pressed(Modifiers::COMMAND, Key::Z);
        if undo || redo {
            requests.extend(self.word.end().map(|gesture| Request::Change(Change::Release(gesture))));
            requests.push(Request::Command(if redo { CommandId::Redo } else { CommandId::Undo }));
        }
    }

    /// Sends what was written, each word as a step.
    fn written(
        &mut self,
        before: &str,
        written: WrittenText,
        time: f64,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let texts = [before, self.buffer.as_str()];
        for step in typed_steps(&mut self.word, texts, written, time, || context.new_gesture()) {
            requests.extend(step.over.map(|gesture| Request::Change(Change::Release(gesture))));
            requests.push(Request::Scene(match self.shown {
                ShownText::Script => SceneRequest::Typed(step.change),
                ShownText::Project => SceneRequest::TypedProject(step.change),
            }));
        }
    }

    /// Ends the word after a pause, or when the field has lost the focus.
    fn finish_word(&mut self, ui: &Ui, has_focus: bool, time: f64, requests: &mut Vec<Request>) {
        let over = if has_focus { self.word.after_pause(time) } else { self.word.end() };
        requests.extend(over.map(|gesture| Request::Change(Change::Release(gesture))));
        if let Some(rest) = self.word.rest(time) {
            ui.ctx().request_repaint_after(Duration::from_secs_f64(rest));
        }
    }

    fn suggest(&mut self, scene: &SceneView, at: usize, asked: bool) {
        let text = self.buffer.as_str();
        let found = with_names(scene, self.shown, |names| completions(text, at, names));
        // Unasked, a list appears only where something of the word is typed, or a tag or value begins.
        let begins =
            self.buffer.as_str().get(..at).is_some_and(|text| text.ends_with(['<', '"', '\'', '.', '/']));
        self.suggestions.set(found.filter(|found| asked || begins || found.range.start < at));
    }

    /// Writes a suggestion into the text.
    fn take(
        &mut self,
        ui: &Ui,
        id: Id,
        index: usize,
        time: f64,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let Some((range, item)) = self
            .suggestions
            .shown()
            .and_then(|shown| Some((shown.range.clone(), shown.items.get(index)?.clone())))
        else {
            return;
        };
        self.suggestions.set(None);
        if !self.buffer.replace_range(range.clone(), &item.insert) {
            return;
        }
        let mut state = TextEditState::load(ui.ctx(), id).unwrap_or_default();
        let cursor = CCursor::new(characters_before(self.buffer.as_str(), range.start + item.cursor));
        state.cursor.set_char_range(Some(CCursorRange::one(cursor)));
        state.store(ui.ctx(), id);
        ui.memory_mut(|memory| memory.request_focus(id));
        if let Some(before) = self.buffer.take_before() {
            self.written(&before, WrittenText::Suggested, time, context, requests);
        }
    }
}
