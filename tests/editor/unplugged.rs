//! Drags whose release event never arrives, because the mouse is unplugged or another window takes the keyboard: nothing
//! stays held, and the unfinished drag is cancelled. Nothing is saved or undone in the middle of a drag either.

use crate::timeline_rig::Animator;
use dragonfly::panels::FileAction;
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::edit::{Edit, RenameTake};
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_document::{Change, Then};
use dragonfly_kit::folder::takes_long;
use dragonfly_kit::random::{Random, seed};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput, pos2};

/// Takes the focus away from the window, which then receives no release events.
fn lose(animator: &mut Animator) {
    animator.harness.event(Event::WindowFocused(false));
    animator.steps(1);
    loop {
        let mut input = RawInput::default();
        let context = animator.harness.ctx.clone();
        let more = animator.harness.state_mut().state.prepend_events(&context, &mut input);
        input.events.into_iter().for_each(|event| animator.harness.event(event));
        animator.steps(1);
        if !more {
            break;
        }
    }
}

fn key(animator: &mut Animator, key: Key, modifiers: Modifiers) {
    for pressed in [true, false] {
        animator.harness.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
    }
    animator.steps(1);
}

#[track_caller]
fn nothing_is_held(animator: &Animator, round: usize) {
    let state = &animator.harness.state().state;
    assert!(!state.read().dragging.is_open(), "round {round}: a drag goes on");
    assert!(
        !state.read().tools.controls().is_busy() && !state.read().tools.controls().edits(),
        "round {round}: a viewport tool is still dragging"
    );
    assert!(!state.read().keys.drag().is_some_and(|drag| drag.held()), "round {round}: keys are held");
    assert_eq!(state.read().tools.controls().modifiers(), Default::default(), "round {round}: a key is held");
    let context = &animator.harness.ctx;
    assert_eq!(context.dragged_id(), None, "round {round}: a panel is dragged");
    context.input(|input| {
        assert!(!input.pointer.any_down(), "round {round}: a button is held");
        assert_eq!(input.modifiers, Modifiers::NONE, "round {round}: a key is held");
    });
}

fn same(one: &Edited, other: &Edited) -> bool {
    let takes = |edited: &Edited| edited.adapter().results().cloned().collect::<Vec<_>>();
    one.steps().1 == other.steps().1 && takes(one) == takes(other)
}

/// Returns a position at which, in most cases, something can be dragged.
fn place(random: &mut Random, animator: &Animator) -> Pos2 {
    let keys = animator.keys();
    let bones = random.below(8);
    match random.below(8) {
        // The gizmo at the selected bone, and the viewport around it.
        0..3 => pos2(random.between(430.0, 830.0), random.between(100.0, 420.0)),
        // Number fields of the bone.
        3 | 4 => pos2(random.between(1030.0, 1275.0), random.between(60.0, 460.0)),
        5 | 6 => animator.at(animator.key(random.below(40)), bones),
        _ => pos2(random.between(keys.left(), 1275.0), random.between(470.0, 690.0)),
    }
}

/// Returns the gestures of all steps.
fn gestures(animator: &Animator) -> Vec<Gesture> {
    animator.edited.steps().0.iter().filter_map(|step| step.gesture).collect()
}

/// Returns the number of applied steps without that of the drag in progress, whose gesture is not `known`. Modifiers switch snapping, so a
/// key may let a drag change something, or nothing any more.
fn other_steps(animator: &Animator, known: &[Gesture]) -> usize {
    let (steps, done) = animator.edited.steps();
    let is_other = |gesture: Option<Gesture>| gesture.is_none_or(|gesture| known.contains(&gesture));
    steps.iter().take(done).filter(|step| is_other(step.gesture)).count()
}

#[test]
fn a_drag_without_a_release_leaves_nothing_held_and_no_partial_edit() {
    let seed = seed(0x756e_706c);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let rounds = if takes_long() { 1000 } else { 200 };
    let mut animator = Animator::with_bone(3);
    let (mut taken_back, mut ended, mut deaf) = (0, 0, 0);
    for round in 0..rounds {
        let modifiers =
            random.choice(&[Modifiers::NONE, Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND]);
        animator.hold(modifiers);
        let from = place(&mut random, &animator);
        let mut before = animator.edited.clone();
        let known = gestures(&animator);
        animator.press(from);
        let mut open = animator.harness.state().state.read().dragging.is_open();
        for _ in 0..2 + random.below(5) {
            if !open {
                before = animator.edited.clone();
            }
            let to = from + egui::vec2(random.between(-60.0, 60.0), random.between(-60.0, 60.0));
            animator.move_to(to);
            let now = animator.harness.state().state.read().dragging.is_open();
            open = now;
            if open && random.below(3) == 0 {
                // A command during the drag is ignored.
                let (others, asked) =
                    (other_steps(&animator, &known), animator.harness.state().effects.len());
                let letter = random.choice(&[Key::S, Key::Z, Key::O, Key::Q, Key::K, Key::Delete]);
                let with = if letter == Key::Delete { Modifiers::NONE } else { Modifiers::COMMAND };
                key(&mut animator, letter, with);
                animator.hold(modifiers);
                assert_eq!(other_steps(&animator, &known), others, "round {round}: {letter:?} did something");
                assert_eq!(animator.harness.state().effects.len(), asked, "round {round}: {letter:?}");
                deaf += 1;
            }
        }
        open = animator.harness.state().state.read().dragging.is_open();
        if random.below(4) == 0 {
            animator.release(from);
            ended += usize::from(open);
            animator.hold(Modifiers::NONE);
            lose(&mut animator);
        } else {
            lose(&mut animator);
            if open {
                assert!(same(&animator.edited, &before), "round {round}: a part of the drag is left");
                taken_back += 1;
            }
        }
        nothing_is_held(&animator, round);
        // The focus returns, perhaps with a button pressed whose press event was never received.
        animator.harness.event(Event::WindowFocused(true));
        let asked = animator.changes.len();
        animator.move_to(from);
        if random.below(2) == 0 {
            animator.button(from, PointerButton::Primary, false);
        }
        animator.move_to(from + egui::vec2(30.0, 10.0));
        assert_eq!(animator.changes.len(), asked, "round {round}: {:?}", animator.changes.last());
        // Anything that a click opened is closed, and the bone is selected again.
        key(&mut animator, Key::Escape, Modifiers::NONE);
        let bench = animator.harness.state_mut();
        bench.effects.clear();
        while bench.state.read().question().is_some() {
            bench.state.execute(Request::Dismiss);
        }
        bench.state.show_overlay(None);
        bench.state.pause();
        bench.state.execute(Request::Select(Some(3)));
        animator.steps(2);
        nothing_is_held(&animator, round);
    }
    println!("{taken_back} drags cancelled, {ended} ended, {deaf} commands in the middle of one");
    assert!(taken_back > rounds / 20 && ended > 0 && deaf > 0);
    // All of it can be undone.
    animator.edited.go_to(0);
    assert!(
        animator
            .edited
            .adapter()
            .slots()
            .iter()
            .all(|slot| slot.result == slot.original || slot.origin.is_none())
    );
}

/// Every request to the document during a drag, from any source, is carried out without the unfinished drag.
#[test]
fn saving_closing_or_undoing_during_a_drag_excludes_the_drag() {
    let ways: [fn() -> Request; 6] = [
        || Request::Command(Id::Save),
        || Request::Command(Id::SaveAs),
        || Request::Command(Id::Quit),
        || Request::Change(Change::Undo),
        || Request::Answer(FileAction::Leave(Then::Quit)),
        || Request::Open(dragonfly_document::Source::BuiltIn),
    ];
    for (number, way) in ways.into_iter().enumerate() {
        let mut animator = Animator::with_bone(3);
        let rename = Edit::RenameTake(RenameTake {
            take: dragonfly_document::edit::TakeRef::Index(0),
            name: "Sneak".to_owned(),
        });
        animator.request(Request::Change(Change::Edit(rename, None)));
        let before = animator.edited.clone();
        let keys = [animator.at(animator.key(4), 0), animator.at(animator.key(9), 0)];
        animator.drag(keys[0], keys[1]);
        animator.steps(2);
        assert!(animator.harness.state().state.read().dragging.is_open(), "{number}: nothing is dragged");
        assert_eq!(animator.edited.steps().1, 2, "{number}");
        animator.request(way());
        let undone = usize::from(number == 3);
        assert_eq!(animator.edited.steps().1, 1 - undone, "{number}: the drag is there");
        if undone == 0 {
            assert!(same(&animator.edited, &before), "{number}");
        }
        // Further movement of the same drag is ignored; the next drag works.
        animator.move_to(keys[0]);
        animator.move_to(keys[1]);
        animator.release(keys[1]);
        assert_eq!(animator.edited.steps().1, 1 - undone, "{number}");
        animator
            .harness
            .state_mut()
            .effects
            .retain(|effect| !matches!(effect, Effect::File(FileAction::Leave(_))));
        animator.drag(keys[0], keys[1]);
        animator.release(keys[1]);
        assert_eq!(animator.edited.steps().1, 2 - undone, "{number}: it is stuck");
    }
}
