//! A frame of the panels is not larger for a large skeleton: only what is in sight is laid out, and nothing is listed again
//! that did not change.

use dragonfly::panels::commands::Id;
use dragonfly::panels::{Desk, Request, Settings, State, style};
use dragonfly_document::View;
use dragonfly_document::bones::Choice;
use dragonfly_kit::counting;
use dragonfly_kit::document::large;
use egui::{Context, Event, Pos2, RawInput, Rect, vec2};
use std::time::Instant;

/// Bytes that a frame may allocate more for the larger skeleton: longer numbers and names, not lists of bones.
const SLACK: u64 = 32 << 10;

/// The panels with a tree of bones.
struct Panels {
    context: Context,
    desk: Desk,
    state: State,
    now: Instant,
    frame: u32,
}

impl Panels {
    fn new(bones: u32) -> Self {
        let context = Context::default();
        style::install(&context);
        context.enable_accesskit();
        let now = Instant::now();
        let mut state = State::new(Settings::default(), now);
        state.show(View::opened(1, large::tree(bones)));
        state.pause();
        Self { context, desk: Desk::new(""), state, now, frame: 0 }
    }

    /// Runs a frame. Returns the number of widgets that it describes to screen readers.
    fn frame(&mut self, events: Vec<Event>) -> usize {
        self.frame += 1;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 800.0))),
            time: Some(f64::from(self.frame) / 60.0),
            events,
            ..RawInput::default()
        };
        let mut requests = Vec::new();
        self.state.begin_frame(self.now);
        let (desk, state) = (&mut self.desk, &self.state.read());
        let mut output = self.context.run_ui(input, |ui| desk.show(ui, state, &mut requests));
        output.textures_delta.clear();
        self.state.end_frame();
        for request in requests {
            self.state.execute(request);
        }
        output.platform_output.accesskit_update.map_or(0, |update| update.nodes.len())
    }

    /// Returns the widgets of a frame in which nothing changes, and the bytes that it allocates.
    fn cost(&mut self) -> (usize, u64) {
        for _ in 0..30 {
            self.frame(Vec::new());
        }
        let (count, widgets) = counting::count(|| self.frame(Vec::new()));
        (widgets, count.bytes)
    }
}

/// Compares a small and a large skeleton after `prepare`.
#[track_caller]
fn same_cost(prepare: impl Fn(&mut Panels)) {
    let [small, large] = [200, 20_000].map(|bones| {
        let mut panels = Panels::new(bones);
        for _ in 0..4 {
            panels.frame(Vec::new());
        }
        prepare(&mut panels);
        panels.cost()
    });
    assert!(small.0 > 40 && small.1 > 0, "the panels are shown: {small:?}");
    assert!(large.0 <= small.0 + 8, "widgets: {} instead of {}", large.0, small.0);
    assert!(large.1 <= small.1 + SLACK, "bytes: {} instead of {}", large.1, small.1);
}

#[test]
fn a_frame_of_a_large_skeleton_lays_out_and_allocates_what_a_small_one_does() {
    same_cost(|_| {});
}

#[test]
fn a_search_is_not_run_again_in_frames_in_which_nothing_changed() {
    same_cost(|panels| {
        panels.state.execute(Request::Command(Id::Find));
        panels.frame(Vec::new());
        panels.frame(vec![Event::Text("bone 1".to_owned())]);
    });
}

#[test]
fn a_frame_with_all_bones_selected_allocates_what_a_small_skeleton_does() {
    same_cost(|panels| {
        let bones = panels.state.read().loaded().expect("open").model.animation.skeleton.len() as u32;
        panels.state.execute(Request::SelectBones((0..bones).collect(), Choice::Replace));
    });
}
