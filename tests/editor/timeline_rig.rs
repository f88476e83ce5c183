//! A simulated user of the timeline and the curves: the panels without a window, connected to a real document.

use crate::panels::{Bench, harness_of};
use dragonfly::panels::{Effect, Request};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::Edit;
use dragonfly_document::history::Edited;
use dragonfly_document::{Change, HistoryView, View};
use dragonfly_kit::document::fixture;
use egui::{Event, Modifiers, PointerButton, Pos2, Rect, Vec2, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

/// The panels, their document, and the simulated input.
pub(crate) struct Animator {
    pub(crate) harness: Harness<'static, Bench>,
    pub(crate) edited: Edited,
    first: View,
    /// Generation of the last view of the document.
    generation: u64,
    modifiers: Modifiers,
    /// Effects that are not addressed to the document.
    others: usize,
    /// Every requested change.
    pub(crate) changes: Vec<Change>,
}

impl Animator {
    pub(crate) fn new(view: View) -> Self {
        let edited = Edited::new(ModelAdapter::of(&view.loaded.model));
        let bench = Bench::new(Some(view.clone()));
        let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        let generation = view.generation;
        Self {
            harness,
            edited,
            first: view,
            generation,
            modifiers: Modifiers::NONE,
            others: 0,
            changes: Vec::new(),
        }
    }

    /// Creates it with a spine model, each bone with 41 rotation keys over 3.417 seconds; `bone` is selected.
    pub(crate) fn with_bone(bone: u32) -> Self {
        let mut animator = Self::new(fixture::full());
        animator.harness.state_mut().state.execute(Request::Select(Some(bone)));
        animator.steps(2);
        animator
    }

    /// Draws frames, and lets the document answer the requests of each.
    pub(crate) fn steps(&mut self, steps: usize) {
        for _ in 0..steps {
            self.harness.run_steps(1);
            self.answer();
        }
    }

    fn answer(&mut self) {
        let bench = self.harness.state_mut();
        let mut changes = Vec::new();
        // Effects for other receivers are kept, so that tests can inspect them.
        let fresh = bench.effects.split_off(self.others.min(bench.effects.len()));
        for effect in fresh {
            let mut passed = Vec::new();
            bench.state.let_through(effect, &mut |effect| passed.push(effect));
            for effect in passed {
                match effect {
                    Effect::Send(number, change) => changes.push((number, change)),
                    other => bench.effects.push(other),
                }
            }
        }
        self.others = bench.effects.len();
        for (answered, change) in changes {
            self.changes.push(change.clone());
            let done = match change {
                Change::Edit(edit, gesture) => match self.edited.ask(edit, gesture) {
                    Ok(()) => true,
                    Err(_) => {
                        self.harness.state_mut().state.edit_refused();
                        false
                    }
                },
                Change::Cancel(gesture) => self.edited.cancel(gesture),
                Change::Undo => self.edited.undo(),
                Change::Redo => self.edited.redo(),
                Change::GoTo(step) => self.edited.go_to(step),
                _ => false,
            };
            assert_eq!(self.edited.adapter().check(), Ok(()));
            self.generation += u64::from(done);
            let view = View {
                generation: self.generation,
                answered,
                history: std::sync::Arc::new(HistoryView::of(&self.edited)),
                ..self.first.with_edited(&self.edited)
            };
            self.first.loaded = std::sync::Arc::clone(&view.loaded);
            self.harness.state_mut().state.show(view);
        }
    }

    /// Sends a request as a panel would.
    pub(crate) fn request(&mut self, request: Request) {
        let bench = self.harness.state_mut();
        let effect = bench.state.execute(request);
        bench.effects.extend(effect);
        self.steps(2);
    }

    /// Holds these modifier keys from now on.
    pub(crate) fn hold(&mut self, modifiers: Modifiers) {
        self.modifiers = modifiers;
        self.harness.event(Event::ModifiersChanged(modifiers));
        self.steps(1);
    }

    fn event(&mut self, event: Event) {
        self.harness.event(event);
    }

    pub(crate) fn move_to(&mut self, pos: Pos2) {
        self.event(Event::PointerMoved(pos));
        self.steps(1);
    }

    pub(crate) fn button(&mut self, pos: Pos2, button: PointerButton, pressed: bool) {
        let modifiers = self.modifiers;
        self.event(Event::PointerButton { pos, button, pressed, modifiers });
        self.steps(1);
    }

    pub(crate) fn press(&mut self, pos: Pos2) {
        self.move_to(pos);
        self.button(pos, PointerButton::Primary, true);
    }

    pub(crate) fn release(&mut self, pos: Pos2) {
        self.button(pos, PointerButton::Primary, false);
        self.steps(2);
    }

    pub(crate) fn click(&mut self, pos: Pos2) {
        self.press(pos);
        self.release(pos);
    }

    /// Moves with the button pressed from one position to another, in several steps, without releasing it.
    pub(crate) fn drag(&mut self, from: Pos2, to: Pos2) {
        self.press(from);
        for part in 1..=4 {
            self.move_to(from + (to - from) * (part as f32 / 4.0));
        }
    }

    pub(crate) fn wheel(&mut self, pos: Pos2, delta: Vec2) {
        self.move_to(pos);
        let modifiers = self.modifiers;
        self.event(Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta,
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers,
        });
        self.steps(8);
    }

    /// Returns the rectangle of the keys in the timeline.
    pub(crate) fn keys(&self) -> Rect {
        self.harness.get_by_label_contains("Keys, ").rect()
    }

    /// Returns the rectangle of the curves.
    pub(crate) fn curves(&self) -> Rect {
        self.harness.get_by_label("Curves of keys").rect()
    }

    /// Returns the position of a time in a row of the timeline; row 0 is the topmost.
    pub(crate) fn at(&self, time: f32, row: usize) -> Pos2 {
        let keys = self.keys();
        pos2(self.x_in(keys, time), keys.top() + (row as f32 + 0.5) * 20.0)
    }

    /// Returns the x coordinate of a time in a part that shows it, in points.
    pub(crate) fn x_in(&self, part: Rect, time: f32) -> f32 {
        let state = &self.harness.state().state;
        let window = state.read().keys.window(state.read().take().unwrap());
        part.left() + 16.0 + (time - window.start as f32) / window.length as f32 * (part.width() - 36.0)
    }

    /// Returns the number of selected keys.
    pub(crate) fn selected(&self) -> usize {
        let state = &self.harness.state().state;
        state.read().keys.selection().count(state.read().take().unwrap())
    }

    /// Returns the time of a key of the fixture.
    pub(crate) fn key(&self, index: usize) -> f32 {
        index as f32 * 3.417 / 40.0
    }

    /// Returns the text of the status line.
    pub(crate) fn said(&self) -> String {
        let line = self.harness.state().state.read().status.last();
        line.map_or_else(String::new, |line| line.text.clone())
    }

    /// Returns the edits requested so far.
    pub(crate) fn edits(&self) -> Vec<&Edit> {
        self.changes
            .iter()
            .filter_map(|change| if let Change::Edit(edit, _) = change { Some(edit) } else { None })
            .collect()
    }

    /// Returns the times of the rotation keys of a bone in the document.
    pub(crate) fn times(&self, bone: usize) -> Vec<f32> {
        self.edited.adapter().slots()[0].result.tracks[bone].rotation.times.to_vec()
    }
}
