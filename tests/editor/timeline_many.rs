//! Drags of more keys than can be moved between two frames: they are drawn in coarser steps, and each drawn state is
//! that after an edit.

use dragonfly::panels::keys::{ChannelId, KeyDragOp, KeysRequest, channel};
use dragonfly::panels::{Effect, Request, Settings, State};
use dragonfly_document::bones::Choice;
use dragonfly_document::history::Edited;
use dragonfly_document::{Change, View};
use dragonfly_kit::document::fixture;
use std::sync::Arc;
use std::time::Instant;

/// The state of the panels, and a document that answers when it is asked to.
struct SlowDocument {
    state: State,
    edited: Edited,
    view: View,
    waiting: Vec<(u64, Change)>,
}

impl SlowDocument {
    /// Opens a take of 57 bones with 3000 keys each, and selects the keys up to a time.
    fn new(until: f32) -> Self {
        let view = fixture::view("long.glb", fixture::skeleton(8), &[("Long", 100.0, 3000)]);
        let mut state = State::new(Settings::default(), Instant::now());
        state.show(view.clone());
        state.pause();
        let take = Arc::clone(&view.takes[0]);
        let bones = take.tracks.iter().map(|track| track.bone);
        let channels: Arc<[ChannelId]> = bones.flat_map(|bone| channel::channels(&take, bone)).collect();
        let stretch = [0.0, until];
        let only = KeysRequest::OnlySelected(false);
        state.execute(Request::Timeline(only));
        let choice = Choice::Replace;
        state.execute(Request::Timeline(KeysRequest::Select { channels, shapes: false, stretch, choice }));
        Self { state, edited: view.edited(), view, waiting: Vec::new() }
    }

    fn request(&mut self, request: KeysRequest) {
        let Some(effect) = self.state.execute(Request::Timeline(request)) else { return };
        let mut passed = Vec::new();
        self.state.let_through(effect, &mut |effect| passed.push(effect));
        for effect in passed {
            if let Effect::Send(number, change) = effect {
                self.waiting.push((number, change));
            }
        }
    }

    /// Answers all waiting changes with one view.
    fn answer(&mut self) {
        for (number, change) in self.waiting.drain(..) {
            match change {
                Change::Edit(edit, gesture) => self.edited.ask(edit, gesture).unwrap(),
                Change::Cancel(gesture) => assert!(self.edited.cancel(gesture)),
                Change::Release(_) => {}
                other => panic!("{other:?}"),
            }
            self.view.answered = number;
        }
        self.view.generation += 1;
        self.view.takes = self.edited.adapter().results().cloned().collect();
        self.view.slots = self.edited.adapter().slots().into();
        self.state.show(self.view.clone());
    }

    /// Returns the times of the first key and of the first selected key as they are drawn.
    fn drawn(&self) -> [f32; 2] {
        let drawn = self.state.read().drawn_keys().unwrap();
        let first = drawn.take.tracks.iter().filter_map(|track| track.rotation.times.first()).copied();
        let selected = drawn.selection.extent(&drawn.take).unwrap()[0];
        [first.reduce(f32::min).unwrap(), selected]
    }

    fn selected(&self) -> usize {
        let panels = self.state.read();
        panels.keys.selection().count(panels.take().unwrap())
    }
}

fn moved(by: f32) -> KeysRequest {
    KeysRequest::Drag(KeyDragOp::Move(by))
}

#[test]
fn a_drag_of_many_keys_shows_the_newest_answer_and_sends_one_edit_at_a_time() {
    let mut slow = SlowDocument::new(f32::INFINITY);
    let count = slow.selected();
    assert!(count > 30_000, "{count}");
    slow.request(moved(0.5));
    assert_eq!((slow.drawn(), slow.waiting.len()), ([0.0; 2], 1), "not answered");
    slow.request(moved(0.75));
    assert_eq!((slow.drawn(), slow.waiting.len()), ([0.0; 2], 1), "still not");
    slow.answer();
    assert_eq!((slow.drawn(), slow.selected()), ([0.5; 2], count));
    slow.request(moved(1.0));
    assert_eq!((slow.drawn(), slow.waiting.len()), ([0.5; 2], 1));
    slow.answer();
    assert_eq!((slow.drawn(), slow.selected()), ([1.0; 2], count));
    slow.request(moved(2.0));
    slow.request(KeysRequest::Cancel);
    slow.answer();
    assert_eq!((slow.drawn(), slow.selected()), ([0.0; 2], count));
}

#[test]
fn a_drag_of_many_keys_ends_where_it_was_released() {
    let mut slow = SlowDocument::new(f32::INFINITY);
    let count = slow.selected();
    slow.request(moved(0.5));
    slow.request(moved(0.75));
    slow.request(KeysRequest::Release);
    assert_eq!(slow.drawn(), [0.0; 2]);
    slow.answer();
    assert_eq!((slow.drawn(), slow.selected()), ([0.75; 2], count));
    assert!(slow.state.read().keys.drag().is_none());
}

#[test]
fn a_drag_of_few_keys_is_shown_before_any_answer() {
    let mut slow = SlowDocument::new(0.1);
    let count = slow.selected();
    for by in [0.01, 0.02, 0.025] {
        slow.request(moved(by));
        assert_eq!((slow.drawn(), slow.selected()), ([by; 2], count));
    }
    assert_eq!(slow.waiting.len(), 3);
    slow.request(KeysRequest::Release);
    slow.answer();
    assert_eq!((slow.drawn(), slow.selected()), ([0.025; 2], count));
}
