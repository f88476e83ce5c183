//! Messages where the user looks: information that passes, an empty viewport that is explained, a gizmo that cannot
//! be dragged, the folder of a file that is saved.

use crate::timeline_rig::Animator;
use crate::workbench::Workbench;
use dragonfly::panels::commands::Id;
use dragonfly::panels::dialogs::{PlaceQuestion, Question};
use dragonfly::panels::settings::WindowSettings;
use dragonfly::panels::status::MessageSeverity;
use dragonfly::panels::{Request, Settings, State};
use dragonfly_anim::data::{Mesh, MeshInstance};
use dragonfly_document::LoadedModel;
use dragonfly_kit::document::fixture;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::Mat4;
use std::sync::Arc;
use std::time::{Duration, Instant};

#[test]
fn an_information_passes_after_some_seconds_a_warning_later_and_an_error_stays() {
    let start = Instant::now();
    let mut state = State::new(Settings::default(), start);
    let shown = |state: &mut State, seconds: u64| {
        state.begin_frame(start + Duration::from_secs(seconds));
        state.read().status.current().map(|line| line.text.clone())
    };
    state.say(MessageSeverity::Info, "Copied");
    assert_eq!(shown(&mut state, 10).as_deref(), Some("Copied"));
    assert_eq!(state.next_display(), Some(Duration::from_secs(6)), "it is drawn again then");
    assert_eq!(shown(&mut state, 15).as_deref(), Some("Copied"));
    assert_eq!(shown(&mut state, 16), None);
    assert_eq!(state.next_display(), None, "no further drawing");
    assert_eq!(state.read().status.lines().count(), 1, "it is still in the list");
    // Said again, it is shown again.
    state.say(MessageSeverity::Info, "Copied");
    assert_eq!(shown(&mut state, 20).as_deref(), Some("Copied"));
    state.say(MessageSeverity::Warning, "No dialog");
    assert_eq!(shown(&mut state, 30).as_deref(), Some("No dialog"));
    assert_eq!(shown(&mut state, 49).as_deref(), Some("No dialog"));
    assert_eq!(shown(&mut state, 50), None);
    state.say(MessageSeverity::Error, "Not saved");
    assert_eq!(shown(&mut state, 60).as_deref(), Some("Not saved"));
    assert_eq!(shown(&mut state, 9_000).as_deref(), Some("Not saved"));
}

#[test]
fn a_warning_is_shown_at_the_pointer_for_some_seconds_and_an_information_is_not() {
    let mut window = Workbench::new(Some(fixture::full())).window();
    let pointer = egui::pos2(300.0, 250.0);
    window.event(egui::Event::PointerMoved(pointer));
    window.run_steps(3);
    let start = Instant::now();
    let shown = |window: &mut crate::workbench::Window, text: &str, seconds: u64| {
        window.state_mut().state.begin_frame(start + Duration::from_secs(seconds));
        window.run_steps(2);
        let texts = window.query_all_by_label(text);
        let near = texts.map(|node| node.rect()).find(|rect| rect.distance_to_pos(pointer) < 60.0);
        near.is_some()
    };
    window.state_mut().state.say(MessageSeverity::Info, "Copied");
    assert!(!shown(&mut window, "Copied", 1));
    window.state_mut().state.say(MessageSeverity::Warning, "The bone is locked");
    assert!(shown(&mut window, "The bone is locked", 2));
    assert!(shown(&mut window, "The bone is locked", 6));
    assert!(!shown(&mut window, "The bone is locked", 7), "after five seconds it is in the status line only");
    // Another one at the lower right corner stays inside the window.
    let screen = window.ctx.content_rect();
    window.event(egui::Event::PointerMoved(screen.max - egui::vec2(4.0, 4.0)));
    window.run_steps(2);
    window.state_mut().state.say(MessageSeverity::Error, "Not saved: the disk is full");
    window.state_mut().state.begin_frame(start + Duration::from_secs(8));
    window.run_steps(3);
    let inside = |rect: egui::Rect| screen.contains_rect(rect) && rect.height() > 8.0;
    let count =
        window.query_all_by_label("Not saved: the disk is full").filter(|node| inside(node.rect())).count();
    assert_eq!(count, 1);
}

#[test]
fn a_viewport_without_surface_and_skeleton_says_so_and_shows_either_again() {
    for (button, id) in [("Show the surface", Id::ToggleSurface), ("Show the skeleton", Id::ToggleSkeleton)] {
        let mut view = fixture::full();
        let mut loaded = LoadedModel::clone(&view.loaded);
        let model = Arc::make_mut(&mut loaded.model);
        let (node, skin, bone, morph_weights) = (None, None, None, Vec::new());
        model.meshes.push(Mesh::default());
        model.instances.push(MeshInstance {
            mesh: 0,
            node,
            skin,
            bone,
            to_bone: Mat4::IDENTITY,
            morph_weights,
        });
        view.loaded = Arc::new(loaded);
        view.opened = Arc::clone(&view.loaded);
        let mut window = Workbench::new(Some(view)).window();
        assert!(window.query_by_label(button).is_none(), "{id:?}");
        window.state_mut().state.execute(Request::Command(Id::ToggleSurface));
        window.run_steps(4);
        window.get_by_label(button).click();
        window.run_steps(4);
        assert!(window.query_by_label(button).is_none());
        let look = window.state().state.read().settings.look;
        assert!(look.surface != look.skeleton);
    }
}

#[test]
fn the_path_to_save_at_has_its_folder() {
    // The fixture was opened by a relative path.
    let mut bench = Workbench::full();
    for copy in [false, true] {
        bench.state.ask(Question::from(PlaceQuestion { copy, then: None }));
        let mut window = bench.window();
        window.run_steps(4);
        let value = window.get_by_label("Path to save at").accesskit_node().value().unwrap_or_default();
        let folder = std::env::current_dir().unwrap();
        assert!(std::path::Path::new(&value).starts_with(&folder), "{value}");
        bench = Workbench::full();
    }
}

#[test]
fn the_size_of_the_window_is_remembered_within_the_limits_of_the_screen() {
    let settings =
        |size, maximized| Settings { window: WindowSettings { size, maximized }, ..Settings::default() };
    let again = Settings::parse(&settings([900.0, 600.0], true).to_text()).window;
    assert_eq!((again.size, again.maximized), ([900.0, 600.0], true));
    assert_eq!(again.size_on(Some([1920.0, 1080.0])), [900.0, 600.0]);
    assert_eq!(again.size_on(None), [900.0, 600.0]);
    let usual = WindowSettings::default();
    assert_eq!(usual.size_on(Some([1280.0, 800.0])), [1280.0, 720.0]);
    let small = usual.size_on(Some([1280.0, 720.0]));
    assert_eq!(small, [1280.0, 660.0], "the status line is on the screen");
    for damaged in [[f32::NAN, 600.0], [-3.0, 1e30], [0.0, 0.0]] {
        let size = Settings::parse(&settings(damaged, false).to_text()).window.size;
        assert!(
            size.iter().zip(WindowSettings::LEAST).all(|(side, least)| (least..=20_000.0).contains(side)),
            "{size:?}"
        );
    }
}

#[test]
fn another_interpolation_tells_how_far_it_moves_bones_and_in_which_frame() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::SelectAllKeys));
    animator.request(Request::Command(Id::InterpolateStep));
    let state = &animator.harness.state().state;
    let text = state.read().status.last().expect("a message").text.clone();
    // A step channel holds each key until the next one, so the largest error is nearly the turn between two keys.
    let take = state.read().take().expect("a take");
    let values = &take.tracks[3].rotation.values;
    let turns = values.windows(2).map(|pair| pair[0].angle_between(pair[1]).to_degrees());
    let most = turns.fold(0.0, f32::max);
    let told = text.split(" · ").last().and_then(|part| part.split('°').next());
    let told: f32 = told.and_then(|number| number.trim().parse().ok()).unwrap_or_else(|| panic!("{text}"));
    assert!(told > 0.3 * most && told <= most + 0.01, "{text}: {most}");
    assert!(text.contains(" mm ") && text.contains(" frame "), "{text}");
}
