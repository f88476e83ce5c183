//! Numbers of the selected bones are dragged and typed, and the pose changes accordingly.

use crate::workbench::{Window, Workbench, drag, move_to, press, release, type_into};
use dragonfly::panels::Request;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::{Quat, Vec3};

/// Opens a window with bone 3 selected, at a key of the first take.
fn window() -> Window {
    let mut bench = Workbench::full();
    bench.state.execute(Request::Select(Some(3)));
    bench.window()
}

/// Returns the value that a field shows.
fn value(window: &Window, field: &str) -> Option<f64> {
    window.get_by_label(field).accesskit_node().numeric_value()
}

/// Returns whether the field is marked as invalid and has a description of the reason.
fn is_marked(field: &egui_kittest::Node<'_>) -> bool {
    let node = field.accesskit_node();
    node.data().invalid().is_some() && node.has_description()
}

#[test]
fn a_typed_number_sets_the_pose() {
    let mut window = window();
    let before = window.state().pose(3);
    type_into(&mut window, "Translation result Y", "1/4 + 10cm", Key::Enter);
    let pose = window.state().pose(3);
    assert_eq!(pose.translation, Vec3 { y: 0.35, ..before.translation });
    assert_eq!(window.state().steps(), (1, 1));
    type_into(&mut window, "Scale change X", "200%", Key::Tab);
    assert_eq!(window.state().pose(3).scale, Vec3::new(2.0, 1.0, 1.0));
    type_into(&mut window, "Rotation change X", "pi/4 rad", Key::Enter);
    let turned = Quat::from_rotation_x(45_f32.to_radians()) * before.rotation;
    assert!(window.state().pose(3).rotation.angle_between(turned) < 1e-3);
    assert_eq!(window.state().steps(), (3, 3));
    assert_eq!(window.state().refused, [""; 0]);
}

#[test]
fn tab_moves_to_the_next_number_and_enter_releases_the_keyboard() {
    let mut window = window();
    window.get_by_label("Translation result X").click();
    window.run_steps(2);
    for (text, key) in [("1", Key::Tab), ("2", Key::Tab), ("3", Key::Enter)] {
        window.event(egui::Event::Text(text.to_owned()));
        window.run_steps(1);
        window.key_press(key);
        window.run_steps(1);
    }
    assert_eq!(window.state().pose(3).translation, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(window.state().steps(), (3, 3));
    // Further keys go to the commands, not to a text field.
    assert!(!window.ctx.egui_wants_keyboard_input());
}

#[test]
fn after_enter_tab_continues_from_the_last_focused_field() {
    let mut window = window();
    let focused = |window: &Window| {
        let root = window.root();
        let node = root.children_recursive().find(|node| node.accesskit_node().is_focused());
        node.and_then(|node| node.accesskit_node().label())
    };
    type_into(&mut window, "Translation result X", "1", Key::Enter);
    assert_eq!(focused(&window), None);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Tab);
    window.run_steps(2);
    assert_eq!(focused(&window), None, "with Ctrl it is another key");
    window.key_press(Key::Tab);
    window.run_steps(2);
    assert_eq!(focused(&window).as_deref(), Some("Translation result Y"));
    window.key_press(Key::Enter);
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::SHIFT, Key::Tab);
    window.run_steps(3);
    assert_eq!(focused(&window).as_deref(), Some("Translation result X"), "and back");
    window.key_press(Key::Escape);
    window.run_steps(2);
    // A click restarts the Tab order, and a field that no longer exists is not a starting point.
    window.get_by_label("Walk").click();
    window.run_steps(2);
    window.key_press(Key::Tab);
    window.run_steps(2);
    assert_eq!(focused(&window).as_deref(), Some("File"));
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn tab_goes_through_the_results_of_all_channels_before_it_comes_to_the_changes() {
    let mut window = window();
    window.get_by_label("Translation result X").click();
    window.run_steps(2);
    let mut met = Vec::new();
    for _ in 0..10 {
        met.push(
            window
                .root()
                .children_recursive()
                .find(|node| node.accesskit_node().is_focused())
                .map(|node| node.accesskit_node().label().unwrap_or_default()),
        );
        window.key_press(Key::Tab);
        window.run_steps(2);
    }
    let wanted = ["Translation", "Rotation", "Scale"]
        .into_iter()
        .flat_map(|channel| ["X", "Y", "Z"].map(|axis| format!("{channel} result {axis}")))
        .chain(["Translation change X".to_owned()]);
    assert_eq!(met.into_iter().flatten().collect::<Vec<_>>(), wanted.collect::<Vec<_>>());
}

#[test]
fn typing_after_a_double_click_replaces_the_number() {
    let mut window = window();
    let at = window.get_by_label("Translation result X").rect().center();
    for pressed in [true, false, true, false] {
        let event = egui::Event::PointerButton {
            pos: at,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        };
        window.event(egui::Event::PointerMoved(at));
        window.event(event);
        window.run_steps(1);
    }
    window.event(egui::Event::Text("45/2".to_owned()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(2);
    assert_eq!(window.state().pose(3).translation.x, 22.5);
}

#[test]
fn a_drag_of_a_number_is_one_undo_step() {
    let mut window = window();
    let before = window.state().pose(3);
    drag(&mut window, "Translation change X", vec2(40.0, 0.0), Modifiers::NONE);
    let after = window.state().pose(3);
    assert!(after.translation.x > before.translation.x);
    assert_eq!(after.translation.y, before.translation.y);
    assert_eq!(window.state().steps(), (1, 1));
    assert!(window.state().changes.len() > 2, "it was seen on the way");
    assert!(matches!(window.state().changes.last(), Some(Change::Release(_))), "and is over");
    let from = window.get_by_label("Rotation result Z").rect().center();
    press(&mut window, from);
    move_to(&mut window, from + vec2(30.0, 0.0), Modifiers::NONE);
    assert!(window.state().pose(3).rotation != after.rotation);
    window.key_press(Key::Escape);
    window.run_steps(2);
    assert_eq!(window.state().pose(3), after, "Escape cancels the drag");
    assert_eq!(window.state().state.read().selected(), Some(3), "and nothing else");
    move_to(&mut window, from + vec2(60.0, 0.0), Modifiers::NONE);
    release(&mut window, from + vec2(60.0, 0.0));
    assert_eq!(window.state().pose(3), after);
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn a_drag_of_a_number_is_finer_with_shift_and_snaps_with_ctrl() {
    let turned = |modifiers| {
        let mut window = window();
        drag(&mut window, "Rotation result X", vec2(80.0, 0.0), modifiers);
        value(&window, "Rotation result X").unwrap()
    };
    let (plain, fine, snapped) =
        (turned(Modifiers::NONE), turned(Modifiers::SHIFT), turned(Modifiers::COMMAND));
    assert!((plain - 40.0).abs() < 1e-3, "{plain}");
    assert!((fine - 4.0).abs() < 1e-3, "{fine}");
    assert!((snapped - 45.0).abs() < 1e-3, "{snapped}");
}

#[test]
fn a_number_dragged_back_to_its_start_leaves_no_undo_step() {
    let mut window = window();
    let before = window.state().pose(3);
    let from = window.get_by_label("Translation result Z").rect().center();
    press(&mut window, from);
    for by in [20.0, 40.0, 20.0, 0.0] {
        move_to(&mut window, from + vec2(by, 0.0), Modifiers::NONE);
    }
    release(&mut window, from);
    assert_eq!((window.state().pose(3), window.state().steps()), (before, (0, 0)));
}

#[test]
fn a_drag_of_a_number_ends_when_another_time_is_shown() {
    let mut window = window();
    let from = window.get_by_label("Translation result Z").rect().center();
    press(&mut window, from);
    move_to(&mut window, from + vec2(20.0, 0.0), Modifiers::NONE);
    let edits = |window: &Window| {
        window.state().changes.iter().filter(|change| matches!(change, Change::Edit(..))).count()
    };
    let (sent, time) = (edits(&window), window.state().state.read().time());
    window.state_mut().state.execute(Request::Seek(time + 0.5));
    move_to(&mut window, from + vec2(80.0, 0.0), Modifiers::NONE);
    release(&mut window, from + vec2(80.0, 0.0));
    assert_eq!(edits(&window), sent, "nothing is keyed at another time");
}

#[test]
fn playback_pauses_while_numbers_are_changed() {
    let mut window = window();
    window.key_press(Key::Space);
    window.run_steps(2);
    assert!(window.state().state.read().playback.playing);
    type_into(&mut window, "Translation result X", "1", Key::Enter);
    assert!(!window.state().state.read().playback.playing);
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn a_wrong_number_is_marked_and_its_field_keeps_the_focus() {
    for wrong in ["", "abc", "1..2", "1/0", "(((", "45m", "1e99", "🦊", "שלום", "1,234"] {
        for key in [Key::Enter, Key::Tab] {
            let mut bench = Workbench::full();
            bench.state.execute(Request::Select(Some(3)));
            let mut window = bench.window_of_any_text();
            let before = window.state().pose(3);
            window.get_by_label("Rotation result Y").click();
            window.run_steps(2);
            window.key_press(Key::Delete);
            window.event(egui::Event::Text(wrong.to_owned()));
            window.run_steps(1);
            window.key_press(key);
            window.run_steps(2);
            let field = window.get_by_label("Rotation result Y");
            assert!(field.is_focused(), "{wrong:?}: the cursor stays");
            assert!(is_marked(&field), "{wrong:?}: it is marked");
            assert_eq!((window.state().pose(3), window.state().changes.len()), (before, 0));
            window.key_press(Key::Escape);
            window.run_steps(3);
            let field = window.get_by_label("Rotation result Y");
            assert!(!field.is_focused() && !is_marked(&field), "Escape cancels it");
            assert_eq!(value(&window, "Rotation result Y"), Some(0.0));
            assert_eq!(window.state().state.read().selected(), Some(3), "and nothing else");
        }
    }
}

/// Opens a window in which the focused field contains a text that is no number.
fn with_a_wrong_number() -> Window {
    let mut window = window();
    window.get_by_label("Scale result Y").click();
    window.run_steps(2);
    window.event(egui::Event::Text("2 +".to_owned()));
    window.run_steps(1);
    window
}

#[test]
fn a_wrong_number_left_with_a_click_is_discarded_with_a_message() {
    let mut window = with_a_wrong_number();
    window.get_by_label("Rest pose").click();
    window.run_steps(1);
    window.get_by_label("Survey").click();
    window.run_steps(3);
    let field = window.get_by_label("Scale result Y");
    assert!(is_marked(&field));
    assert_eq!(value(&window, "Scale result Y"), Some(1.0));
    assert_eq!(window.state().changes, []);
    type_into(&mut window, "Scale result Y", "2", Key::Enter);
    assert!(!is_marked(&window.get_by_label("Scale result Y")));
}

#[test]
fn the_message_about_a_refused_number_disappears() {
    let mut window = with_a_wrong_number();
    window.get_by_label("Find a bone").click();
    window.run_steps(60);
    assert!(is_marked(&window.get_by_label("Scale result Y")), "a second later it is still said");
    window.run_steps(400);
    assert!(!is_marked(&window.get_by_label("Scale result Y")), "seven seconds later it is not");
    assert_eq!((value(&window, "Scale result Y"), window.state().steps()), (Some(1.0), (0, 0)));
}

#[test]
fn numbers_that_cannot_be_applied_are_refused() {
    let mut window = window();
    window.get_by_label("Show the quaternion").click();
    window.run_steps(3);
    type_into(&mut window, "Scale result X", "0", Key::Enter);
    for axis in ["X", "Y", "Z"] {
        type_into(&mut window, &format!("Quaternion result {axis}"), "0", Key::Tab);
    }
    let before = window.state().pose(3);
    type_into(&mut window, "Quaternion result W", "0", Key::Enter);
    assert!(is_marked(&window.get_by_label("Quaternion result W")));
    assert_eq!(window.state().pose(3), before);
}

#[test]
fn a_quaternion_is_typed_number_by_number() {
    let mut window = window();
    window.get_by_label("Show the quaternion").click();
    window.run_steps(3);
    window.get_by_label("Quaternion result X").click();
    window.run_steps(2);
    for text in ["1", "2", "3", "4"] {
        window.event(egui::Event::Text(text.to_owned()));
        window.run_steps(1);
        window.key_press(Key::Tab);
        window.run_steps(1);
    }
    let wanted = Quat::from_xyzw(1.0, 2.0, 3.0, 4.0).normalize();
    let rotation = window.state().pose(3).rotation;
    assert!((rotation - wanted).length() < 1e-6, "{rotation}");
}

/// If the second angle is near 90°, many angles mean the same rotation; the typed ones must stay.
#[test]
fn typed_angles_stay_as_they_were_typed() {
    let mut window = window();
    window.get_by_label("Rotation result X").click();
    window.run_steps(2);
    for text in ["30", "90", "-45", ""] {
        if !text.is_empty() {
            window.event(egui::Event::Text(text.to_owned()));
            window.run_steps(1);
        }
        window.key_press(Key::Tab);
        window.run_steps(2);
    }
    let shown = ["X", "Y", "Z"].map(|axis| value(&window, &format!("Rotation result {axis}")).unwrap());
    assert_eq!(shown, [30.0, 90.0, -45.0]);
    drag(&mut window, "Rotation result Y", vec2(40.0, 0.0), Modifiers::NONE);
    let shown = ["X", "Y", "Z"].map(|axis| value(&window, &format!("Rotation result {axis}")).unwrap());
    assert_eq!(shown, [30.0, 110.0, -45.0], "a drag through 90° turns no other angle");
    window.state_mut().state.execute(Request::Select(Some(4)));
    window.run_steps(2);
    window.state_mut().state.execute(Request::Select(Some(3)));
    window.run_steps(3);
    let later = ["X", "Y", "Z"].map(|axis| value(&window, &format!("Rotation result {axis}")).unwrap());
    let same = later.iter().zip(shown).all(|(later, shown)| (later - shown).abs() < 1e-3);
    assert!(same, "later they are as the curves show them: {later:?}");
}

#[test]
fn a_number_goes_to_all_selected_bones() {
    let mut bench = Workbench::full();
    bench.state.execute(Request::SelectBones(vec![1, 2, 3], Choice::Replace));
    let mut window = bench.window();
    assert_eq!(value(&window, "Translation result Y"), None, "they differ");
    assert_eq!(value(&window, "Translation change Y"), Some(0.0), "none is changed");
    let before = [1, 2, 3].map(|bone| window.state().pose(bone));
    type_into(&mut window, "Translation result Y", "0.5", Key::Enter);
    for bone in [1, 2, 3] {
        assert_eq!(window.state().pose(bone).translation.y, 0.5);
        assert_eq!(window.state().pose(bone).translation.x, before[bone as usize - 1].translation.x);
    }
    assert_eq!((value(&window, "Translation result Y"), window.state().steps()), (Some(0.5), (1, 1)));
    drag(&mut window, "Translation result X", vec2(50.0, 0.0), Modifiers::NONE);
    let by = [1, 2, 3]
        .map(|bone| window.state().pose(bone).translation.x - before[bone as usize - 1].translation.x);
    assert!(
        by[0] > 0.0 && by.iter().all(|other| (other - by[0]).abs() < 1e-6),
        "{by:?}: each from where it was"
    );
    assert_eq!(window.state().steps(), (2, 2));
}

#[test]
fn the_key_button_of_a_channel_adds_and_deletes_its_key() {
    let mut window = window();
    let keys =
        |window: &Window| window.state().state.read().view.unwrap().takes[0].tracks[3].rotation.times.len();
    assert_eq!(keys(&window), 41);
    window.state_mut().state.execute(Request::Seek(0.05));
    window.run_steps(2);
    let before = window.state().pose(3);
    window.get_by_label("Add a rotation key").click();
    window.run_steps(3);
    assert_eq!((keys(&window), window.state().pose(3)), (42, before), "the motion stays");
    window.get_by_label("Delete the rotation key").click();
    window.run_steps(3);
    assert_eq!(keys(&window), 41);
    window.get_by_label("Add a scale key").click();
    window.run_steps(3);
    assert!(window.query_by_label("Delete the scale key").is_some());
}

#[test]
fn without_auto_key_a_number_is_pending_until_it_is_keyed() {
    let mut window = window();
    window.state_mut().state.settings_mut().auto_key = false;
    let before = window.state().pose(3);
    type_into(&mut window, "Scale result X", "2", Key::Enter);
    assert_eq!(value(&window, "Scale result X"), Some(2.0), "it is shown");
    assert_eq!(window.state().pose(3), before, "and no key");
    type_into(&mut window, "Scale change X", "3", Key::Enter);
    window.get_by_label("Reset scale to the original").click();
    window.run_steps(3);
    assert_eq!(value(&window, "Scale result X"), Some(1.0));
    type_into(&mut window, "Scale result X", "4", Key::Enter);
    window.get_by_label("Key the pending scale").click();
    window.run_steps(3);
    assert_eq!(window.state().pose(3).scale.x, 4.0);
    assert!(window.query_by_label("Delete the scale key").is_some());
    assert_eq!(window.state().refused, [""; 0]);
}

#[test]
fn a_channel_is_reset_to_the_original_or_to_the_rest_pose() {
    for time in [0.0, 0.05] {
        let mut window = window();
        window.state_mut().state.execute(Request::Seek(time));
        window.run_steps(2);
        let before = window.state().pose(3);
        type_into(&mut window, "Rotation result X", "77", Key::Enter);
        window.get_by_label("Reset rotation to the original").click();
        window.run_steps(3);
        assert!(window.state().pose(3).rotation.angle_between(before.rotation) < 1e-3);
        window.get_by_label("Reset rotation to the rest pose").click();
        window.run_steps(3);
        assert!(window.state().pose(3).rotation.angle_between(Quat::IDENTITY) < 1e-3);
        type_into(&mut window, "Translation result X", "7", Key::Enter);
        window.get_by_label("Translation original X: \u{2212}0.080").click();
        window.run_steps(3);
        assert_eq!(window.state().pose(3).translation, before.translation, "a click takes over the original");
        assert_eq!(window.state().refused, [""; 0]);
    }
}

#[test]
fn the_rest_pose_is_shown_and_not_changed() {
    let mut window = window();
    window.state_mut().state.execute(Request::ShowTake(None));
    window.run_steps(3);
    assert!(window.query_by_label("The rest pose cannot be edited: show a take").is_some());
    for key in [Key::Enter, Key::Tab] {
        type_into(&mut window, "Translation result X", "5", key);
    }
    drag(&mut window, "Rotation change X", vec2(50.0, 0.0), Modifiers::NONE);
    drag(&mut window, "Rotation change X slider", vec2(50.0, 0.0), Modifiers::NONE);
    assert_eq!(window.state().changes, []);
    // Ctrl+A found no field to select in, and selected all bones.
    window.state_mut().state.execute(Request::Select(Some(3)));
    window.run_steps(2);
    assert_eq!(value(&window, "Translation result X"), Some(f64::from(-0.08_f32)));
}

#[test]
fn a_locked_bone_is_shown_and_not_changed_and_others_change_without_it() {
    let mut window = window();
    let lock = |on| Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 3, on));
    let said = "Locked in the timeline: its keys cannot be edited";
    assert!(window.query_by_label(said).is_none());
    window.state_mut().state.execute(lock(true));
    window.run_steps(3);
    assert!(window.query_by_label(said).is_some());
    drag(&mut window, "Rotation change X", vec2(50.0, 0.0), Modifiers::NONE);
    assert_eq!(window.state().changes, []);
    // The bone that was selected last is the active one, whose numbers are shown.
    window.state_mut().state.execute(Request::SelectBones(vec![3, 5], Choice::Replace));
    window.run_steps(3);
    assert!(window.query_by_label(said).is_none());
    let before = [3, 5].map(|bone| window.state().pose(bone).rotation);
    drag(&mut window, "Rotation change X", vec2(50.0, 0.0), Modifiers::NONE);
    assert_eq!(window.state().pose(3).rotation, before[0], "it is locked");
    assert_ne!(window.state().pose(5).rotation, before[1], "the other one is not");
    window.state_mut().state.execute(lock(false));
    window.run_steps(3);
    drag(&mut window, "Rotation change X", vec2(50.0, 0.0), Modifiers::NONE);
    assert_ne!(window.state().pose(3).rotation, before[0]);
}

#[test]
fn a_slider_rotates_and_can_be_undone() {
    let mut window = window();
    let before = window.state().pose(3);
    let slider = window.get_by_label("Rotation change Y slider").rect();
    drag(&mut window, "Rotation change Y slider", vec2(slider.width() / 4.0, 0.0), Modifiers::NONE);
    let turned = value(&window, "Rotation change Y").unwrap();
    assert!((turned - 90.0).abs() < 2.0, "{turned}");
    assert_eq!(window.state().steps(), (1, 1));
    let knob = slider.center() + vec2(slider.width() / 4.0, 0.0);
    press(&mut window, knob);
    move_to(&mut window, knob - vec2(60.0, 0.0), Modifiers::NONE);
    window.key_press(Key::Escape);
    window.run_steps(2);
    release(&mut window, knob);
    assert!((value(&window, "Rotation change Y").unwrap() - turned).abs() < 1e-3);
    window.state_mut().change(Change::Undo);
    assert_eq!(window.state().pose(3), before);
    window.get_by_label("Sliders for scale").click();
    window.run_steps(3);
    assert!(window.query_by_label("Scale change X slider").is_some());
}

#[test]
fn the_order_of_the_angles_is_chosen_and_remembered() {
    let mut window = window();
    window.get_by_label("Order of rotation: XYZ").click();
    window.run_steps(3);
    window.get_by_label("ZXY").click();
    window.run_steps(3);
    assert!(window.query_by_label("Order of rotation: ZXY").is_some());
    let text = window.state().state.read().settings.to_text();
    assert!(text.contains("\"ZXY\""), "{text}");
    let read = dragonfly::panels::Settings::parse(&text);
    assert_eq!(read.properties, window.state().state.read().settings.properties);
    let unknown = dragonfly::panels::Settings::parse(&text.replace("ZXY", "ABC"));
    assert_eq!(unknown.properties.euler, Default::default());
}

#[test]
fn rounding_errors_of_a_translation_are_shown_as_zero() {
    let mut window = window();
    let before = window.state().pose(3).translation;
    let x = before.x + 4e-7;
    type_into(&mut window, "Translation result X", &format!("{x:e}"), Key::Enter);
    assert_ne!(window.state().pose(3).translation.x.to_bits(), before.x.to_bits());
    assert_eq!(value(&window, "Translation change X"), Some(0.0));
    type_into(&mut window, "Translation result Y", "-4.8e-8", Key::Enter);
    assert_eq!(window.state().pose(3).translation.y, -4.8e-8);
    assert_eq!(value(&window, "Translation result Y"), Some(0.0));
    type_into(&mut window, "Translation result Y", "0.001", Key::Enter);
    assert_eq!(value(&window, "Translation result Y"), Some(f64::from(0.001_f32)));
}

#[test]
fn the_tooltip_of_a_disabled_button_names_the_button_and_the_reason() {
    let mut window = window();
    window.get_by_label("History").click();
    window.run_steps(2);
    for (button, reason) in
        [("Linear interpolation", "No key is selected"), ("Undo", "There is nothing to undo")]
    {
        let at = window.get_by_label(button).rect().center();
        window.event(egui::Event::PointerMoved(at));
        window.run_steps(60);
        let says = |text: &str| window.query_all_by_label_contains(text).count();
        assert!(says(reason) > 0, "{button}: the reason");
        let named = window.query_all_by_label_contains(&format!("{button}\n")).count();
        let shortcut = window.query_all_by_label_contains(&format!("{button} (")).count();
        assert!(named + shortcut > 0, "{button}: its name");
    }
}
