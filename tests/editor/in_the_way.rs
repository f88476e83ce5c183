//! Tooltips and values next to the pointer cover neither menus nor what is dragged, and a narrow bar has no overlaps.

use crate::timeline_rig::Animator;
use crate::workbench::{Window, Workbench, draws};
use dragonfly::panels::Request;
use dragonfly::panels::commands::{self, Id};
use dragonfly::panels::dialogs::UnsavedQuestion;
use dragonfly::panels::prompts::Overlay;
use dragonfly_document::Then;
use egui::{Event, PointerButton, pos2, vec2};
use egui_kittest::kittest::Queryable;

#[test]
fn the_tooltip_of_a_menu_entry_covers_no_other_entry() {
    let entry = |window: &crate::workbench::Window, name: &str| {
        let all = window.query_all_by_label_contains(name).map(|node| node.rect());
        all.min_by(|a, b| a.top().total_cmp(&b.top())).expect("an entry")
    };
    for (menu, name, help) in [("Edit", "Undo", "Undoes the last step"), ("File", "Save a copy", "Saves")] {
        let mut window = Workbench::full().window();
        window.get_by_label(menu).click();
        window.run_steps(4);
        let at = entry(&window, name);
        window.event(Event::PointerMoved(at.center()));
        window.run_steps(90);
        let tooltip = window.get_by_label_contains(help).rect();
        assert!(tooltip.left() >= at.right(), "{name}: {tooltip:?} covers {at:?} or its neighbors");
    }
}

#[test]
fn the_tooltip_of_the_scale_bar_is_not_shown_while_keys_are_scaled() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Seek(0.0));
    let (from, to) = (animator.at(animator.key(1) - 0.04, 4), animator.at(animator.key(10) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    let hints =
        |animator: &Animator| animator.harness.query_all_by_label_contains("About the other end").count();
    let grip = animator.harness.get_by_label("Scale keys by their end").rect().center();
    animator.move_to(grip);
    animator.steps(90);
    assert_eq!(hints(&animator), 1);
    animator.press(grip);
    for step in 1..=4 {
        animator.move_to(grip + vec2(10.0 * step as f32, 0.0));
    }
    animator.steps(90);
    assert_eq!(hints(&animator), 0);
    animator.release(grip + vec2(40.0, 0.0));
}

#[test]
fn a_tooltip_is_not_over_a_question_or_an_overlay_that_opens_while_the_pointer_rests() {
    // The history has no step, so that the second button is disabled.
    for id in [Id::PlayPause, Id::Undo] {
        for is_question in [true, false] {
            let mut window = Workbench::full().window();
            if id == Id::Undo {
                window.get_by_label("History").click();
                window.run_steps(20);
            }
            let hint = commands::get(id).help;
            let shown = |window: &Window| window.query_all_by_label_contains(hint).count();
            let button = window.query_all_by_label(commands::get(id).title).next().expect("a button").rect();
            window.event(Event::PointerMoved(button.center()));
            window.run_steps(90);
            assert_eq!(shown(&window), 1, "the pointer rests");
            let state = &mut window.state_mut().state;
            match is_question {
                true => state.ask(UnsavedQuestion { then: Then::Quit }.into()),
                false => state.show_overlay(Some(Overlay::About)),
            }
            for step in 0..60 {
                window.run_steps(1);
                assert_eq!(shown(&window), 0, "{id:?}, frame {step}");
            }
            if is_question {
                let button = window.get_by_label("Don't save").rect().center();
                window.event(Event::PointerMoved(button));
                window.run_steps(90);
                let own = "Continue without saving";
                assert_eq!(window.query_all_by_label_contains(own).count(), 1, "its own tooltips are shown");
            }
        }
    }
}

#[test]
fn the_value_of_a_key_is_not_drawn_over_its_menu() {
    let mut animator = Animator::with_bone(3);
    animator.steps(2);
    let curves = animator.curves();
    // Some position of the panel is on a key.
    let x = animator.x_in(curves, animator.key(8));
    let key = (0..curves.height() as u32).map(|y| pos2(x, curves.top() + y as f32)).find(|&at| {
        animator.move_to(at);
        draws(animator.harness.output(), "rib_00_left_middle rotation")
    });
    let key = key.expect("a key of the curves");
    animator.button(key, PointerButton::Secondary, true);
    animator.button(key, PointerButton::Secondary, false);
    animator.steps(4);
    assert!(animator.harness.query_by_label_contains("Delete keys").is_some(), "the menu is open");
    animator.move_to(key);
    assert!(!draws(animator.harness.output(), "rib_00_left_middle rotation"));
}

#[test]
fn nothing_in_the_bar_over_the_timeline_overlaps_at_any_width() {
    for width in (320..=1280).step_by(40) {
        let window = Workbench::full().window_of(vec2(width as f32, 720.0), egui::Theme::Dark);
        let mut rects = Vec::new();
        for name in [
            "Go to start",
            "Play / pause",
            "Go to end",
            "Auto-key",
            "Loop",
            "Ping-pong",
            "Play once",
            "Speed",
            "30 fps",
            "Frame",
            "Time",
        ] {
            rects.extend(window.query_all_by_label(name).map(|node| (name, node.rect())));
        }
        let bar = rects.iter().find(|(name, _)| *name == "Play / pause").expect("buttons").1;
        rects.retain(|(_, rect)| (rect.center().y - bar.center().y).abs() < 12.0);
        for (at, (name, rect)) in rects.iter().enumerate() {
            assert!(rect.right() <= width as f32 + 0.5 || *name == "Go to end", "{width}: {name} is cut");
            for (other, beside) in &rects[at + 1..] {
                let apart = rect.right() <= beside.left() + 0.5 || beside.right() <= rect.left() + 0.5;
                assert!(apart, "{width}: {name} {rect:?} and {other} {beside:?} overlap");
            }
        }
    }
}
