//! Keys of the keyboard follow the panel under the pointer: over the timeline and the curves they act on keys of the take,
//! as in the program whose preset is chosen.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::{Id, KeyScope, KeySettings, Keymap, Preset, parse};
use dragonfly_anim::data::Take;
use dragonfly_kit::random::{Random, seed};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use glam::EulerRot;
use std::sync::Arc;

/// Returns an animator with the keys of a preset; the rotation keys of bone 3 are listed.
fn animator(preset: Preset) -> Animator {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Keys(KeySettings { preset, ..KeySettings::default() }));
    animator
}

impl Animator {
    /// Presses and releases a key, with the text that it types.
    fn type_key(&mut self, key: Key, modifiers: Modifiers) {
        for pressed in [true, false] {
            let event = Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
            self.harness.event(event);
            let text = if key == Key::Minus { "-" } else { key.symbol_or_name() };
            if pressed && text.len() == 1 && modifiers.is_none() {
                self.harness.event(Event::Text(text.to_lowercase()));
            }
            self.steps(1);
        }
    }

    fn type_all(&mut self, keys: &[Key]) {
        for key in keys {
            self.type_key(*key, Modifiers::NONE);
        }
    }

    fn take(&self) -> Arc<Take> {
        Arc::clone(&self.edited.adapter().slots()[0].result)
    }

    fn frame(&self) -> f32 {
        1.0 / self.harness.state().state.read().frame_rate as f32
    }

    fn steps_done(&self) -> usize {
        self.edited.steps().0.len()
    }

    /// Selects the column of keys at a key's time, and leaves the pointer there.
    fn select_key(&mut self, key: usize) -> Pos2 {
        let at = self.at(self.key(key), 0);
        self.click(at);
        assert_eq!(self.selected(), 1);
        at
    }
}

#[test]
fn a_selects_all_keys_over_the_timeline_and_all_bones_elsewhere() {
    let mut animator = animator(Preset::Blender);
    let bones = |animator: &Animator| animator.harness.state().state.read().selection.bones().len();
    let at = animator.at(animator.key(5), 0);
    animator.move_to(at);
    animator.type_key(Key::A, Modifiers::NONE);
    assert_eq!((animator.selected(), bones(&animator)), (41, 1));
    animator.type_key(Key::A, Modifiers::ALT);
    assert_eq!((animator.selected(), bones(&animator)), (0, 1));
    animator.type_key(Key::I, Modifiers::COMMAND);
    assert_eq!(animator.selected(), 41, "all were deselected");
    let viewport = animator.keys().center() - vec2(0.0, 400.0);
    animator.move_to(viewport);
    animator.type_key(Key::A, Modifiers::NONE);
    assert!(bones(&animator) > 10, "{} bones", bones(&animator));
}

#[test]
fn keys_follow_the_pointer_without_a_button_until_a_click_confirms_one_step() {
    let mut animator = animator(Preset::Blender);
    let (before, at) = (animator.times(3), animator.select_key(8));
    animator.type_key(Key::G, Modifiers::NONE);
    let to = animator.at(animator.key(8) + 3.0 * animator.frame(), 0);
    animator.move_to(at + (to - at) / 2.0);
    animator.move_to(to);
    animator.steps(2);
    let moved = animator.times(3)[8];
    assert!((moved - before[8] - 3.0 * animator.frame()).abs() < 0.6 * animator.frame(), "{moved}");
    let hint = "Messages: Move keys: X time, Y value · digits enter frames or a value · Enter or click confirms · Esc cancels";
    animator.harness.get_by_label(hint);
    animator.click(to);
    assert_eq!(animator.times(3)[8], moved, "the click moves nothing");
    assert_eq!((animator.selected(), animator.steps_done()), (1, 1));
    // The drag is over: the pointer moves alone.
    animator.move_to(to + vec2(100.0, 0.0));
    assert_eq!(animator.times(3)[8], moved);
    animator.request(Request::Command(Id::Undo));
    assert_eq!(animator.times(3), before);
}

#[test]
fn typed_digits_move_keys_by_exactly_that_many_frames() {
    let mut animator = animator(Preset::Blender);
    let before = animator.times(3);
    animator.select_key(40);
    animator.type_all(&[Key::G, Key::Num1, Key::Num2, Key::Enter]);
    animator.steps(2);
    assert!((animator.times(3)[40] - before[40] - 12.0 * animator.frame()).abs() < 1e-6);
    assert_eq!(animator.steps_done(), 1);
    // Each drag begins with no text.
    animator.type_all(&[Key::G, Key::Num5, Key::Backspace, Key::Minus, Key::Num2, Key::Enter]);
    animator.steps(2);
    assert!((animator.times(3)[40] - before[40] - 10.0 * animator.frame()).abs() < 1e-6);
}

#[test]
fn escape_and_the_right_button_leave_no_trace_and_keep_what_was_undone() {
    let mut animator = animator(Preset::Blender);
    let at = animator.select_key(8);
    animator.type_all(&[Key::G, Key::Num3, Key::Enter]);
    animator.steps(2);
    animator.request(Request::Command(Id::Undo));
    animator.click(at);
    let before = animator.take();
    animator.type_key(Key::G, Modifiers::NONE);
    animator.move_to(at + vec2(60.0, 0.0));
    assert_ne!(animator.times(3), before.tracks[3].rotation.times.to_vec(), "the drag moves keys");
    animator.type_key(Key::Escape, Modifiers::NONE);
    animator.steps(2);
    assert_eq!(animator.take(), before);
    assert_eq!(animator.selected(), 1, "Escape deselects nothing");
    animator.type_key(Key::S, Modifiers::NONE);
    animator.move_to(at + vec2(-90.0, 0.0));
    animator.button(at, PointerButton::Secondary, true);
    animator.button(at, PointerButton::Secondary, false);
    animator.steps(2);
    assert_eq!(animator.take(), before);
    animator.request(Request::Command(Id::Redo));
    assert_ne!(animator.take(), before, "what was undone is still there");
}

#[test]
fn keys_are_scaled_about_the_playhead_by_the_typed_factor() {
    let mut animator = animator(Preset::Blender);
    let before = animator.times(3);
    animator.request(Request::Seek(1.0));
    animator.select_key(40);
    animator.request(Request::Seek(1.0));
    animator.type_all(&[Key::S, Key::Num2, Key::Enter]);
    animator.steps(2);
    let expected = 1.0 + 2.0 * (before[40] - 1.0);
    assert!((animator.times(3)[40] - expected).abs() < 1e-5, "{} {expected}", animator.times(3)[40]);
}

#[test]
fn shift_d_moves_copies_and_leaves_the_keys_where_they_are() {
    let mut animator = animator(Preset::Blender);
    let before = animator.times(3);
    animator.select_key(40);
    animator.type_key(Key::D, Modifiers::SHIFT);
    animator.type_all(&[Key::Num7, Key::Enter]);
    animator.steps(2);
    let after = animator.times(3);
    assert_eq!(after[..41], before);
    assert!((after[41] - before[40] - 7.0 * animator.frame()).abs() < 1e-6);
}

#[test]
fn in_the_curves_y_moves_values_by_the_typed_number_and_x_moves_times() {
    let mut animator = animator(Preset::Blender);
    let angle = |animator: &Animator| {
        let rotation = animator.take().tracks[3].rotation.value(8).unwrap();
        rotation.to_euler(EulerRot::XYZ).0.to_degrees()
    };
    let (before, times) = (angle(&animator), animator.times(3));
    animator.select_key(8);
    let inside = animator.curves().center();
    animator.move_to(inside);
    animator.type_all(&[Key::G, Key::Y, Key::Num5, Key::Enter]);
    animator.steps(2);
    assert!((angle(&animator) - before - 5.0).abs() < 1e-3, "{before} {}", angle(&animator));
    assert_eq!(animator.times(3), times);
    animator.type_all(&[Key::G, Key::Y, Key::X, Key::Num2, Key::Enter]);
    animator.steps(2);
    assert!((animator.times(3)[8] - times[8] - 2.0 * animator.frame()).abs() < 1e-6);
    // Without a lock the first movement decides.
    animator.type_key(Key::G, Modifiers::NONE);
    animator.move_to(inside - vec2(0.0, 30.0));
    animator.move_to(inside - vec2(20.0, 40.0));
    animator.type_key(Key::Enter, Modifiers::NONE);
    animator.steps(2);
    assert!(angle(&animator) > before + 5.5, "{}", angle(&animator));
    assert!((animator.times(3)[8] - times[8] - 2.0 * animator.frame()).abs() < 1e-6);
    assert_eq!(animator.steps_done(), 3);
}

#[test]
fn every_preset_selects_and_moves_keys_over_the_timeline() {
    for (preset, select, modifiers, drag) in [
        (Preset::Blender, Key::A, Modifiers::NONE, Some(Key::G)),
        (Preset::Maya, Key::A, Modifiers::COMMAND, Some(Key::W)),
        (Preset::GameEngines, Key::A, Modifiers::COMMAND, Some(Key::W)),
        (Preset::Dragonfly, Key::A, Modifiers::COMMAND, None),
    ] {
        let mut animator = animator(preset);
        let before = animator.times(3);
        let at = animator.at(animator.key(5), 0);
        animator.move_to(at);
        animator.type_key(select, modifiers);
        assert_eq!(animator.selected(), 41, "{}", preset.title());
        if let Some(drag) = drag {
            animator.type_all(&[drag, Key::Num4, Key::Enter]);
            animator.steps(2);
            let by = animator.times(3)[0] - before[0];
            assert!((by - 4.0 * animator.frame()).abs() < 1e-6, "{}", preset.title());
        }
    }
}

#[test]
fn a_key_over_the_timeline_that_the_user_chose_is_saved_and_wins_there() {
    let mut keys = KeySettings { preset: Preset::Blender, ..KeySettings::default() };
    keys.set(KeyScope::Keys, Id::ScaleKeysNow, &[parse("G").unwrap()]);
    let text = serde_json::to_string(&keys).unwrap();
    let keymap = Keymap::new(serde_json::from_str(&text).unwrap());
    assert_eq!(keymap.command_of(KeyScope::Keys, Key::G, Modifiers::NONE), Some(Id::ScaleKeysNow));
    assert!(keymap.shortcuts(KeyScope::Keys, Id::MoveKeysNow).is_empty());
    assert_eq!(keymap.command_of(KeyScope::Window, Key::G, Modifiers::NONE), Some(Id::MoveNow));
}

#[test]
fn random_drags_without_a_button_that_are_cancelled_change_no_bit() {
    let seed = seed(31);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut animator = animator(Preset::Blender);
    animator.select_key(8);
    let before = animator.take();
    let keys = [
        Key::G,
        Key::S,
        Key::X,
        Key::Y,
        Key::Num0,
        Key::Num3,
        Key::Num9,
        Key::Minus,
        Key::Period,
        Key::Backspace,
    ];
    for round in 0..60 {
        let area = if random.below(2) == 0 { animator.keys() } else { animator.curves() };
        let mut anywhere = || area.min + vec2(random.unit(), random.unit()) * area.size();
        let [first, second] = [anywhere(), anywhere()];
        animator.move_to(first);
        animator.type_key(random.choice(&[Key::G, Key::S]), Modifiers::NONE);
        for _ in 0..random.below(6) {
            animator.type_key(random.choice(&keys), Modifiers::NONE);
        }
        animator.move_to(second);
        animator.type_key(Key::Escape, Modifiers::NONE);
        animator.steps(2);
        assert_eq!(animator.take(), before, "round {round}");
        assert_eq!(animator.selected(), 1, "round {round}");
    }
    assert_eq!(animator.steps_done(), 0);
}

#[test]
fn the_next_drag_after_b_draws_a_box_although_it_begins_on_a_key() {
    for (preset, letter) in [
        (Preset::Blender, Key::B),
        (Preset::Maya, Key::Q),
        (Preset::GameEngines, Key::Q),
        (Preset::Dragonfly, Key::B),
    ] {
        let mut animator = animator(preset);
        let (times, from) = (animator.times(3), animator.at(animator.key(8), 2));
        let to = animator.at(animator.key(12) + 0.04, 2) + vec2(0.0, 4.0);
        animator.move_to(from);
        animator.type_key(letter, Modifiers::NONE);
        animator.drag(from, to);
        animator.release(to);
        assert_eq!(animator.times(3), times, "{preset:?}: no key was moved");
        assert_eq!(animator.selected(), 5, "{preset:?}");
        // The box is over: the next drag moves keys.
        let at = animator.at(animator.key(8), 2);
        animator.drag(at, at + vec2(40.0, 0.0));
        animator.release(at + vec2(40.0, 0.0));
        assert_ne!(animator.times(3), times, "{preset:?}");
    }
}

#[test]
fn t_and_v_over_keys_open_menus_of_interpolations_and_tangents_that_escape_closes() {
    for preset in Preset::ALL.iter().copied() {
        for (letter, entry, hint) in [
            (Key::T, "Spline interpolation", "Choose the interpolation"),
            (Key::V, "Flat tangents", "Choose the tangents"),
        ] {
            let mut animator = animator(preset);
            let at = animator.select_key(8);
            animator.move_to(at);
            // The buttons over the curves have these names, too.
            let count = |animator: &Animator| animator.harness.query_all_by_label_contains(entry).count();
            let buttons = count(&animator);
            for _ in 0..2 {
                animator.type_key(letter, Modifiers::NONE);
                animator.steps(2);
                assert_eq!(count(&animator), buttons + 1, "{preset:?} {letter:?}");
                let hints = animator.harness.query_all_by_label_contains(hint).count();
                assert!(hints > 0, "{preset:?}: the status line");
                animator.type_key(Key::Escape, Modifiers::NONE);
                animator.steps(2);
                assert_eq!(count(&animator), buttons, "Escape closes it");
            }
            animator.type_key(letter, Modifiers::NONE);
            animator.steps(2);
            let below = |rect: &egui::Rect| rect.top() > at.y - 30.0 && rect.left() < at.x + 30.0;
            let places: Vec<egui::Rect> =
                animator.harness.query_all_by_label_contains(entry).map(|node| node.rect()).collect();
            let place =
                places.into_iter().min_by(|a, b| a.center().distance(at).total_cmp(&b.center().distance(at)));
            let place = place.filter(below).expect("an entry near the pointer");
            animator.click(place.center());
            animator.steps(3);
            let rotation = &animator.take().tracks[3].rotation;
            assert_eq!(
                rotation.interpolation,
                dragonfly_anim::data::Interpolation::CubicSpline,
                "{preset:?}"
            );
            assert_eq!(count(&animator), buttons, "the menu is closed");
        }
    }
}
