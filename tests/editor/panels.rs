//! Every panel draws every document, and input in a panel sends the right request.

use dragonfly::panels::commands::Id;
use dragonfly::panels::window_status::DeviceStatus;
use dragonfly::panels::{self, Desk, Effect, Request, Settings, State, style};
use dragonfly_document::edit::{BonePose, BoneRef, Edit, RenameTake, TakeRef};
use dragonfly_document::{Change, FileView, View};
use dragonfly_kit::document::fixture;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::time::Instant;

/// The whole user interface without a real window.
pub(crate) struct Bench {
    pub(crate) desk: Desk,
    pub(crate) state: State,
    pub(crate) effects: Vec<Effect>,
}

impl Bench {
    pub(crate) fn new(view: Option<View>) -> Self {
        let now = Instant::now();
        let mut state = State::new(Settings::default(), now);
        state
            .window_mut()
            .set_device(DeviceStatus::Ready { adapter: "llvmpipe (LLVM 15.0.6), Vulkan".to_owned() });
        if let Some(view) = view {
            state.show(view);
            state.pause();
        }
        Self { desk: Desk::new(""), state, effects: Vec::new() }
    }

    pub(crate) fn frame(&mut self, ui: &mut egui::Ui) {
        let mut requests = Vec::new();
        let mut input = ui.input(|input| input.raw.clone());
        self.state.feed(ui.ctx(), &mut input, 0, &mut self.effects);
        ui.input_mut(|state| state.events = input.events);
        self.state.begin_frame(self.state.read().now);
        if self.state.read().takes_shortcuts() {
            requests.extend(panels::commands::pressed(ui.ctx()).into_iter().map(Request::Command));
        }
        self.desk.show(ui, &self.state.read(), &mut requests);
        self.state.end_frame();
        self.effects.extend(requests.into_iter().filter_map(|request| self.state.execute(request)));
        if self.state.read().dragging.is_open() && !ui.input(|input| input.pointer.any_down()) {
            self.effects.push(Effect::ReleaseDrag);
        }
    }
}

pub(crate) fn harness(bench: Bench) -> Harness<'static, Bench> {
    harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark)
}

pub(crate) fn harness_of(
    bench: Bench,
    size: egui::Vec2,
    pixels_per_point: f32,
    theme: egui::Theme,
) -> Harness<'static, Bench> {
    Harness::builder()
        .with_size(size)
        .with_pixels_per_point(pixels_per_point)
        .with_theme(theme)
        .with_max_steps(20)
        .with_context_setup(style::install)
        .build_ui_state(|ui, bench: &mut Bench| bench.frame(ui), bench)
}

#[test]
fn an_edit_and_its_undo_are_each_reported_once() {
    use crate::timeline_rig::Animator;
    use dragonfly::panels::commands::Id;
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Seek(0.04));
    animator.request(Request::Command(Id::Key));
    let said = animator.said();
    assert!(said.starts_with("Add keys  ·  Survey  ·  ") && said.ends_with(" keys more"), "{said}");
    animator.request(Request::Command(Id::Undo));
    assert_eq!(animator.said(), "Undone: Add keys  ·  Survey");
    animator.request(Request::Command(Id::Redo));
    assert_eq!(animator.said(), "Redone: Add keys  ·  Survey");
    // A message appears when a drag starts and when it is cancelled.
    let state = &animator.harness.state().state;
    let gesture = state.read().new_gesture();
    let lines = |animator: &Animator| animator.harness.state().state.read().status.lines().count();
    let before = lines(&animator);
    for x in 1..20 {
        let poses = vec![BonePose {
            bone: BoneRef::Index(3),
            translation: Some([x as f32, 0.0, 0.0]),
            rotation: None,
            scale: None,
        }];
        let edit = animator.harness.state().state.read().pose_edit(poses).unwrap();
        animator.request(Request::Change(Change::Edit(edit, Some(gesture))));
    }
    assert!(animator.said().starts_with("Move  ·  rib_00_left_middle  ·  Survey"), "{}", animator.said());
    assert_eq!(lines(&animator), before + 1);
    animator.request(Request::Change(Change::Cancel(gesture)));
    assert!(animator.said().starts_with("Cancelled: Move"), "{}", animator.said());
    // Several steps are undone at once.
    for name in ["a", "b"] {
        let rename = Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: name.to_owned() });
        animator.request(Request::Change(Change::Edit(rename, None)));
    }
    animator.request(Request::Change(Change::GoTo(0)));
    assert_eq!(animator.said(), "Undone: 3 steps");
}

#[test]
fn the_status_line_counts_overwritten_keys() {
    use crate::timeline_rig::Animator;
    use dragonfly::panels::commands::Id;
    use dragonfly::panels::keys::KeysRequest;
    use dragonfly_document::bones::Choice;
    use dragonfly_document::edit::Property;
    let mut animator = Animator::with_bone(3);
    let select = |animator: &mut Animator, first: usize, last: usize| {
        let channels = std::sync::Arc::new([(3, Property::Rotation)]);
        let stretch = [animator.key(first), animator.key(last)];
        animator.request(Request::Timeline(KeysRequest::Select {
            shapes: false,
            channels,
            stretch,
            choice: Choice::Replace,
        }));
        assert_eq!(animator.selected(), last - first + 1);
    };
    // Moves three keys so that the first one lands on the last key but one.
    select(&mut animator, 2, 4);
    let to = animator.key(39);
    animator.request(Request::Seek(to));
    animator.request(Request::Command(Id::DuplicateKeys));
    animator.steps(2);
    let said = animator.said();
    assert!(
        said.starts_with("Duplicate keys  ·  ") && said.ends_with("1 more  ·  2 keys replaced"),
        "{said}"
    );
    // A key that is moved to a time without other keys replaces none.
    select(&mut animator, 0, 0);
    animator.request(Request::Timeline(KeysRequest::Drag(dragonfly::panels::keys::KeyDragOp::Move(0.03))));
    animator.request(Request::Timeline(KeysRequest::Release));
    animator.steps(2);
    assert!(
        animator.said().starts_with("Move keys") && !animator.said().contains("replaced"),
        "{}",
        animator.said()
    );
    select(&mut animator, 1, 1);
    let text = animator.harness.state_mut().state.execute(Request::Command(Id::CopyKeys));
    let Some(Effect::Copy(text)) = text else { panic!("{text:?}") };
    let to = animator.key(6);
    animator.request(Request::Seek(to));
    animator.request(Request::PastePose { text, mirrored: false });
    animator.steps(2);
    assert!(animator.said().ends_with("1 key replaced"), "{}", animator.said());
}

#[test]
fn a_message_with_more_detail_is_not_replaced_by_the_edits_own_message() {
    use crate::timeline_rig::Animator;
    use dragonfly::panels::keys::{BoneFlag, KeysRequest};
    let mut animator = Animator::with_bone(3);
    let copied = animator.harness.state_mut().state.execute(Request::Command(Id::CopyPose));
    let Some(Effect::Copy(text)) = copied else { panic!("{copied:?}") };
    let two = vec![3, 4];
    animator.request(Request::SelectBones(two, dragonfly_document::bones::Choice::Replace));
    let copied = animator.harness.state_mut().state.execute(Request::Command(Id::CopyPose));
    let Some(Effect::Copy(both)) = copied else { panic!("{copied:?}") };
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 4, true)));
    animator.request(Request::PastePose { text: both, mirrored: false });
    assert!(animator.said().ends_with("is locked and stays unchanged"), "{}", animator.said());
    animator.request(Request::PastePose { text, mirrored: false });
    assert!(animator.said().starts_with("Paste pose"), "{}", animator.said());
}

#[test]
fn the_built_in_model_is_shown_as_a_file_after_it_was_saved() {
    let source = dragonfly_document::Source::BuiltIn;
    let loaded = dragonfly_document::load_model(&source, &mut |_| {}, &dragonfly_document::Cancel::default());
    let mut view = View::opened(1, std::sync::Arc::new(loaded.unwrap()));
    let path = Some("mine.glb".into());
    view.file = std::sync::Arc::new(FileView { title: "mine.glb".to_owned(), path, ..FileView::default() });
    let bench = Bench::new(Some(view));
    let mut harness = harness(bench);
    harness.run_steps(4);
    assert!(harness.query_by_label("Built-in model").is_none());
    assert!(harness.query_by_label("glTF 2.0, binary").is_some());
}

#[test]
fn a_low_viewport_shows_all_tool_buttons() {
    for height in [700.0, 720.0, 1100.0] {
        let bench = Bench::new(Some(fixture::full()));
        let mut harness = harness_of(bench, egui::vec2(1280.0, height), 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        let picture = harness.get_by_label("Viewport").rect();
        for tool in ["Rotate", "IK", "Pin / unpin", "Ghosts", "Motion path"] {
            let button = harness.get_by_label(tool).rect();
            assert!(picture.contains_rect(button), "{tool} at {height}: {button:?} in {picture:?}");
        }
    }
}

#[test]
fn playback_is_paused_while_a_question_is_open() {
    use dragonfly::panels::dialogs::PlaceQuestion;
    let mut bench = Bench::new(Some(fixture::full()));
    bench.state.execute(Request::Command(Id::PlayPause));
    assert!(bench.state.read().playback.playing);
    bench.state.ask(PlaceQuestion { copy: false, then: None }.into());
    assert!(!bench.state.read().playback.playing);
    // A model opened while the question is shown does not play either.
    let mut other = State::new(Settings::default(), Instant::now());
    other.ask(PlaceQuestion { copy: false, then: None }.into());
    other.show(fixture::full());
    assert!(!other.read().playback.playing);
}

#[test]
fn every_panel_draws_no_model_an_empty_one_and_a_full_one() {
    for view in [None, Some(fixture::empty()), Some(fixture::full())] {
        for theme in [egui::Theme::Dark, egui::Theme::Light] {
            for size in [egui::vec2(1280.0, 720.0), egui::vec2(320.0, 240.0), egui::vec2(40.0, 30.0)] {
                let mut harness = harness_of(Bench::new(view.clone()), size, 1.0, theme);
                harness.run_steps(4);
            }
        }
    }
}

#[test]
fn every_panel_and_its_main_controls_have_a_label() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    for panel in panels::all() {
        if panel.id() == panels::VIEWPORT || !panel.subject().fits(false) {
            continue;
        }
        assert!(harness.query_all_by_label(panel.title()).next().is_some(), "{} has no title", panel.id());
    }
    for label in [
        "File",
        "View",
        "Find a bone",
        "Play / pause",
        "Time",
        "Frame",
        "Speed",
        "Viewport",
        "Walk",
        "Rest pose",
    ] {
        assert!(harness.query_all_by_label(label).next().is_some(), "{label} is missing");
    }
}

#[test]
fn a_click_on_a_row_selects_the_bone_and_shows_its_numbers() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    harness.get_by_label("spine_00").click();
    harness.run_steps(4);
    assert_eq!(harness.state().state.read().selected(), Some(1));
    assert!(harness.query_by_label("Translation original Y: 0.100").is_some());
}

#[test]
fn the_bones_button_is_pressed_whenever_bones_are_shown() {
    let pressed = |view| {
        let mut harness = harness(Bench::new(view));
        harness.run_steps(4);
        let on = Some(egui::accesskit::Toggled::True);
        let found = harness.query_all_by_label("Skeleton");
        (
            found.filter(|node| node.accesskit_node().toggled() == on).count(),
            harness.state().state.read().shows_skeleton(),
        )
    };
    // The tab of the panel has the same name and is pressed as well.
    assert_eq!(pressed(None), (1, false));
    // The model has bones and nothing else, so they are shown without being asked for.
    assert_eq!(pressed(Some(fixture::full())), (2, true));
}

#[test]
fn a_click_on_a_take_shows_it() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    harness.get_by_label("Walk").click();
    harness.run_steps(4);
    assert_eq!(harness.state().state.read().playback.take, Some(1));
    harness.get_by_label("Rest pose").click();
    harness.run_steps(4);
    assert_eq!(harness.state().state.read().playback.take, None);
}

#[test]
fn the_search_shows_the_bones_found_with_their_ancestors() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    harness.get_by_label("Find a bone").click();
    harness.run_steps(2);
    harness.get_by_label("Find a bone").type_text("03_LEFT_tip");
    harness.run_steps(4);
    assert!(harness.query_by_label("rib_03_left_tip").is_some());
    assert!(harness.query_by_label("spine_03").is_some(), "its ancestors are shown");
    assert!(harness.query_by_label("rib_00_left_tip").is_none(), "others are not");
}

#[test]
fn enter_in_the_search_selects_the_exact_match_or_the_first() {
    let mut skeleton = fixture::skeleton(9);
    // A name that contains the name of another bone, and comes before it in the list.
    skeleton.bones[1].name = "spine_05_helper".to_owned();
    let mut harness = harness(Bench::new(Some(fixture::view("model", skeleton, &[("Walk", 1.0, 5)]))));
    let mut find = |text: &str| {
        harness.state_mut().state.execute(Request::Command(dragonfly::panels::commands::Id::Find));
        harness.run_steps(4);
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        harness.get_by_label("Find a bone").type_text(text);
        harness.run_steps(4);
        harness.key_press(egui::Key::Enter);
        harness.run_steps(4);
        harness.state().state.read().selected().map(|bone| harness.state().state.read().bone_name(bone))
    };
    assert_eq!(find("03_left_tip").as_deref(), Some("rib_03_left_tip"));
    assert_eq!(find("Spine_05").as_deref(), Some("spine_05"));
    assert_eq!(find("Left_Tip").as_deref(), Some("rib_00_left_tip"), "the first of many");
    assert_eq!(find("no such bone").as_deref(), Some("rib_00_left_tip"), "nothing found, nothing changed");
}

#[test]
fn typing_in_a_field_does_not_start_playback() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    harness.key_press(egui::Key::Space);
    harness.run_steps(2);
    assert!(harness.state().state.read().playback.playing);
    harness.key_press(egui::Key::Space);
    harness.run_steps(2);
    assert!(!harness.state().state.read().playback.playing);
    harness.get_by_label("Find a bone").click();
    harness.run_steps(2);
    harness.key_press(egui::Key::Space);
    harness.run_steps(2);
    assert!(!harness.state().state.read().playback.playing);
}

#[test]
fn scrubbing_sets_the_time_and_playback_continues_after_it() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    harness.key_press(egui::Key::Space);
    harness.run_steps(2);
    let track = harness.get_by_label("Time track").rect();
    // The ruler begins 16 points and ends 20 points inside.
    let middle = egui::pos2((track.left() + 16.0 + track.right() - 20.0) / 2.0, track.top() + 12.0);
    harness.drag_at(track.left_top() + egui::vec2(60.0, 12.0));
    harness.run_steps(2);
    harness.hover_at(middle);
    harness.run_steps(3);
    assert!(!harness.state().state.read().playback.playing, "time stands while it is held");
    let time = harness.state().state.read().time();
    assert!((time - 3.417 / 2.0).abs() < 0.02, "{time}");
    harness.drop_at(middle);
    harness.run_steps(3);
    assert!(harness.state().state.read().playback.playing, "and goes on afterwards");
}

/// In a slow frame a click may last longer than clicks usually do, and must not be lost because of that.
#[test]
fn a_press_on_the_timeline_moves_the_time_before_it_is_a_click_or_a_drag() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    let track = harness.get_by_label("Time track").rect();
    let middle = egui::pos2((track.left() + 16.0 + track.right() - 20.0) / 2.0, track.top() + 12.0);
    harness.hover_at(middle);
    harness.run_steps(1);
    harness.drag_at(middle);
    harness.run_steps(1);
    let time = harness.state().state.read().time();
    assert!((time - 3.417 / 2.0).abs() < 0.02, "{time}");
    // Another button does nothing.
    harness.drop_at(middle);
    harness.run_steps(2);
    let right = egui::PointerButton::Secondary;
    let early = track.left_top() + egui::vec2(60.0, 12.0);
    harness.hover_at(early);
    harness.event(egui::Event::PointerButton {
        pos: early,
        button: right,
        pressed: true,
        modifiers: egui::Modifiers::NONE,
    });
    harness.run_steps(2);
    assert_eq!(harness.state().state.read().time(), time);
}

#[test]
fn a_drag_started_by_a_command_shows_a_hint_next_to_the_pointer() {
    use dragonfly::panels::commands::Id;
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("Draw a lasso around bones").is_none());
    harness.state_mut().state.execute(Request::Command(Id::LassoSelect));
    harness.run_steps(4);
    harness.get_by_label_contains("Draw a lasso around bones");
    harness.state_mut().state.execute(Request::Command(Id::BoxSelect));
    harness.run_steps(4);
    harness.get_by_label_contains("Drag a box over bones");
}

#[test]
fn escape_closes_a_menu_and_keeps_the_selection() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.state_mut().state.execute(Request::Select(Some(3)));
    harness.run_steps(4);
    harness.get_by_label("View").click();
    harness.run_steps(4);
    assert!(egui::Popup::is_any_open(&harness.ctx));
    harness.key_press(egui::Key::Escape);
    harness.run_steps(4);
    assert!(!egui::Popup::is_any_open(&harness.ctx));
    assert_eq!(harness.state().state.read().selected(), Some(3));
    harness.key_press(egui::Key::Escape);
    harness.run_steps(4);
    assert_eq!(harness.state().state.read().selected(), None, "now it is for the bones");
}

#[test]
fn keys_do_not_reach_panels_behind_a_dialog() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.state_mut().state.execute(Request::Select(Some(3)));
    harness.state_mut().state.execute(Request::Command(dragonfly::panels::commands::Id::About));
    harness.run_steps(4);
    let grid = harness.state().state.read().settings.look.grid;
    harness.key_press(egui::Key::G);
    harness.run_steps(4);
    assert_eq!(harness.state().state.read().settings.look.grid, grid);
    harness.key_press(egui::Key::Escape);
    harness.run_steps(4);
    assert_eq!(
        (harness.state().state.read().overlay, harness.state().state.read().selected()),
        (None, Some(3))
    );
}

#[test]
fn a_request_that_the_state_cannot_handle_itself_becomes_an_effect() {
    let mut harness = harness(Bench::new(None));
    harness.run_steps(4);
    harness.get_by_label("Open a model…").click();
    harness.run_steps(4);
    assert_eq!(harness.state().effects, [Effect::OpenDialog]);
}

#[test]
fn a_model_opens_with_its_first_moving_take_playing_and_a_single_pose_paused() {
    let shown = |takes: &[(&str, f32, usize)]| {
        let mut state = State::new(Settings::default(), Instant::now());
        state.show(fixture::view("model", fixture::skeleton(3), takes));
        (state.read().playback.take, state.read().playback.playing)
    };
    assert_eq!(shown(&[("RESET", 0.0, 1), ("idle", 1.0, 5)]), (Some(1), true));
    assert_eq!(shown(&[("RESET", 0.0, 1), ("T-pose", 0.0, 1)]), (Some(0), false));
    assert_eq!(shown(&[]), (None, false));
}

#[test]
fn an_edit_of_the_shown_take_keeps_the_time_selection_and_camera() {
    let opened = fixture::full();
    let mut state = Bench::new(Some(opened.clone())).state;
    let (selected, camera) = (Some(3), state.read().camera);
    state.execute(Request::Select(selected));
    state.execute(Request::Seek(1.5));
    let with = |generation, length: f32| {
        let mut takes = opened.takes.to_vec();
        takes[0] = std::sync::Arc::new(dragonfly_anim::data::Take { length, ..(*takes[0]).clone() });
        View { generation, takes: takes.into(), ..opened.clone() }
    };
    state.show(with(2, 2.0));
    assert_eq!(
        (state.read().playback.take, state.read().playback.length, state.read().time()),
        (Some(0), 2.0, 1.5)
    );
    state.show(with(3, 1.0));
    assert_eq!(
        (state.read().playback.length, state.read().time()),
        (1.0, 1.5),
        "though it ends before that now"
    );
    assert_eq!(
        (state.read().selected(), state.read().camera),
        (selected, camera),
        "everything else is as the user left it"
    );
    state.begin_frame(state.read().now);
    assert_eq!((state.read().digest.takes.len(), state.read().digest.takes[0].length), (3, 1.0));
    state.show(View { generation: 4, takes: [].into(), ..opened });
    assert_eq!((state.read().playback.take, state.read().time()), (None, 0.0));
    state.begin_frame(state.read().now);
    assert!(state.read().digest.takes.is_empty());
}

#[test]
fn a_model_is_shown_under_the_name_of_the_file_it_was_last_saved_to() {
    let mut view = fixture::full();
    let file =
        FileView { title: "renamed.glb".to_owned(), path: Some("renamed.glb".into()), ..FileView::default() };
    view.file = std::sync::Arc::new(file);
    let mut harness = harness_of(Bench::new(Some(view)), egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
    harness.run_steps(4);
    harness.get_by_label("Shown model: renamed.glb");
    harness.get_by_label("renamed.glb");
}
