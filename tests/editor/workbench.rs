//! The user interface without a real window, connected to a real document: requests of panels are applied before the next
//! frame.

use dragonfly::panels::window_status::DeviceStatus;
use dragonfly::panels::{self, Desk, Effect, Request, Settings, State, style};
use dragonfly_anim::data::Transform;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::history::Edited;
use dragonfly_document::{Change, HistoryView, View};
use dragonfly_kit::document::fixture;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::sync::Arc;
use std::time::Instant;

/// The user interface, its document, and the recorded requests.
pub(crate) struct Workbench {
    pub(crate) desk: Desk,
    pub(crate) state: State,
    pub(crate) edited: Option<Edited>,
    /// The models and the plan of the scene, if one is open.
    pub(crate) stage: Option<crate::scene_bench::SceneStage>,
    /// All changes requested of the document.
    pub(crate) changes: Vec<Change>,
    /// Reasons for which edits were refused.
    pub(crate) refused: Vec<String>,
}

/// Size of the window of [`Workbench::window_of_any_text`], points.
pub(crate) const WINDOW: egui::Vec2 = egui::vec2(1280.0, 720.0);

pub(crate) type Window = Harness<'static, Workbench>;

impl Workbench {
    pub(crate) fn new(view: Option<View>) -> Self {
        let mut state = State::new(Settings::default(), Instant::now());
        state
            .window_mut()
            .set_device(DeviceStatus::Ready { adapter: "llvmpipe (LLVM 15.0.6), Vulkan".to_owned() });
        let edited = view.as_ref().map(|view| Edited::new(ModelAdapter::of(&view.loaded.model)));
        if let Some(view) = view {
            state.show(view);
            state.pause();
        }
        Self { desk: Desk::new(""), state, edited, stage: None, changes: Vec::new(), refused: Vec::new() }
    }

    /// Creates the standard model with all panels.
    pub(crate) fn full() -> Self {
        Self::new(Some(fixture::full()))
    }

    /// Opens a window that is high enough to show everything without scrolling.
    pub(crate) fn window(self) -> Window {
        self.window_of(egui::vec2(1280.0, 1000.0), egui::Theme::Dark)
    }

    /// Opens a window that draws a box for characters that no font has, as the program does.
    pub(crate) fn window_of_any_text(self) -> Window {
        let builder = Harness::builder()
            .with_size(WINDOW)
            .with_max_steps(20)
            .allow_missing_glyphs()
            .with_context_setup(style::install);
        let mut window = builder.build_ui_state(|ui, bench: &mut Self| bench.frame(ui), self);
        window.run_steps(4);
        window
    }

    pub(crate) fn window_of(self, size: egui::Vec2, theme: egui::Theme) -> Window {
        let builder = Harness::builder()
            .with_size(size)
            .with_theme(theme)
            // At the frame rate of a real window: two clicks are a double click.
            .with_step_dt(1.0 / 60.0)
            .with_max_steps(20)
            .with_context_setup(style::install);
        let mut window = builder.build_ui_state(|ui, bench: &mut Self| bench.frame(ui), self);
        window.run_steps(4);
        window
    }

    pub(crate) fn frame(&mut self, ui: &mut egui::Ui) {
        let mut requests = Vec::new();
        self.state.begin_frame(self.state.read().now);
        if self.state.read().takes_shortcuts() {
            requests.extend(panels::commands::pressed(ui.ctx()).into_iter().map(Request::Command));
        }
        self.desk.show(ui, &self.state.read(), &mut requests);
        self.state.end_frame();
        for request in requests {
            match self.state.execute(request) {
                Some(Effect::Change(change)) => self.change(change),
                Some(Effect::TogglePanel(id)) => self.desk.toggle_panel(id),
                Some(Effect::ShowPanel(id)) => self.desk.show_panel(id),
                _ => {}
            }
        }
    }

    /// Applies a change as the thread of the document does.
    pub(crate) fn change(&mut self, change: Change) {
        let mut sent = Vec::new();
        self.state.let_through(Effect::Change(change), &mut |effect| sent.push(effect));
        for effect in sent {
            if let Effect::Send(number, change) = effect {
                self.answer(number, change);
            }
        }
    }

    pub(crate) fn answer(&mut self, answered: u64, change: Change) {
        self.changes.push(change.clone());
        let (Some(edited), Some(view)) = (&mut self.edited, self.state.read().view.cloned()) else { return };
        let _there_was_something_to_do = match change {
            Change::Edit(edit, gesture) => match edited.ask(edit, gesture) {
                Ok(()) => true,
                Err(error) => {
                    self.state.edit_refused();
                    self.refused.push(error.to_string());
                    false
                }
            },
            Change::Cancel(gesture) => edited.cancel(gesture),
            Change::Undo => edited.undo(),
            Change::Redo => edited.redo(),
            Change::GoTo(done) => edited.go_to(done),
            Change::Release(_) => {
                edited.end_gesture();
                true
            }
        };
        assert_eq!(edited.adapter().check(), Ok(()));
        let history = Arc::new(HistoryView::of(edited));
        let adapter = edited.adapter();
        let takes = adapter.results().cloned().collect();
        let generation = view.generation + 1;
        let scene = match &mut self.stage {
            Some(stage) => Some(stage.view(adapter.texts())),
            None => view.scene.clone(),
        };
        self.state.show(View {
            generation,
            answered,
            takes,
            slots: adapter.slots().into(),
            history,
            scene,
            ..view
        });
    }

    /// Returns the pose of a bone in the document, in the take and at the time shown.
    pub(crate) fn pose(&self, bone: u32) -> Transform {
        let view = self.state.read().view.unwrap();
        let take = &view.takes[self.state.read().playback.take.unwrap()];
        let bones = &view.loaded.model.animation.skeleton.bones;
        dragonfly_anim::sample::sample_track(
            &take.tracks[bone as usize],
            &bones[bone as usize],
            self.state.read().time(),
        )
    }

    /// Returns the number of steps done, and the number of all steps.
    pub(crate) fn steps(&self) -> (usize, usize) {
        let (steps, done) = self.edited.as_ref().unwrap().steps();
        (done, steps.len())
    }
}

/// Focuses a field, clears it, types a text, and presses the key `then`.
pub(crate) fn type_into(window: &mut Window, field: &str, text: &str, then: egui::Key) {
    window.get_by_label(field).click();
    window.run_steps(2);
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    window.run_steps(1);
    window.event(egui::Event::Text(text.to_owned()));
    window.run_steps(2);
    window.key_press(then);
    window.run_steps(3);
}

/// Drags from the middle of a field by an offset in points, in several steps.
pub(crate) fn drag(window: &mut Window, field: &str, by: egui::Vec2, modifiers: egui::Modifiers) {
    let from = window.get_by_label(field).rect().center();
    press(window, from);
    for step in 1..=4 {
        move_to(window, from + by * (step as f32 / 4.0), modifiers);
    }
    release(window, from + by);
}

/// Returns whether a text is drawn that contains `part`.
pub(crate) fn draws(output: &egui::FullOutput, part: &str) -> bool {
    let mut shapes = output.shapes.iter().map(|clipped| &clipped.shape);
    shapes.any(|shape| matches!(shape, egui::Shape::Text(text) if text.galley.text().contains(part)))
}

pub(crate) fn press(window: &mut Window, at: egui::Pos2) {
    window.event(egui::Event::PointerMoved(at));
    window.run_steps(1);
    button(window, at, true);
}

pub(crate) fn move_to(window: &mut Window, at: egui::Pos2, modifiers: egui::Modifiers) {
    window.event(egui::Event::ModifiersChanged(modifiers));
    window.event(egui::Event::PointerMoved(at));
    window.run_steps(2);
}

pub(crate) fn release(window: &mut Window, at: egui::Pos2) {
    button(window, at, false);
    window.event(egui::Event::ModifiersChanged(egui::Modifiers::NONE));
    window.run_steps(2);
}

pub(crate) fn button(window: &mut Window, pos: egui::Pos2, pressed: bool) {
    let modifiers = egui::Modifiers::NONE;
    window.event(egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers,
    });
    window.run_steps(1);
}
