//! Messages where the user looks: information that passes, an empty viewport that is explained, a gizmo that cannot
//! be dragged, the folder of a file that is saved.

use crate::workbench::Workbench;
use dragonfly::panels::commands::Id;
use dragonfly::panels::dialogs::{PlaceQuestion, Question};
use dragonfly::panels::settings::WindowSettings;
use dragonfly::panels::status::MessageSeverity;
use dragonfly::panels::{Request, Settings, State};
use dragonfly_anim::data::{Mesh, MeshInstance};
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
fn a_viewport_without_surface_and_skeleton_says_so_and_shows_either_again() {
    for (button, id) in [("Show the surface", Id::ToggleSurface), ("Show the skeleton", Id::ToggleSkeleton)] {
        let mut view = fixture::full();
        let loaded = Arc::get_mut(&mut view.loaded).expect("not shared yet");
        let model = Arc::get_mut(&mut loaded.model).expect("not shared yet");
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
