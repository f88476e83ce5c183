//! Any mouse input over the timeline and the curves: no panic, and a consistent document (promise U2).

use crate::timeline_rig::Animator;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest, TimeWindow};
use dragonfly::panels::{self, Request};
use dragonfly_kit::document::fixture;
use dragonfly_kit::random::{Random, seed};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};

const EVENTS: usize = 1200;

/// Performs one random input.
fn act(animator: &mut Animator, random: &mut Random, commands: &[Id]) {
    let lower =
        |random: &mut Random| -> Pos2 { pos2(random.between(-20.0, 1300.0), random.between(430.0, 740.0)) };
    match random.below(14) {
        0..=3 => {
            let pos = lower(random);
            animator.move_to(pos);
        }
        4..=6 => {
            let buttons = [
                PointerButton::Primary,
                PointerButton::Primary,
                PointerButton::Secondary,
                PointerButton::Middle,
            ];
            let (pos, button) = (lower(random), random.choice(&buttons));
            animator.move_to(pos);
            animator.button(pos, button, random.below(2) == 0);
        }
        7 => {
            let (from, to) = (lower(random), lower(random));
            animator.drag(from, to);
            if random.below(4) > 0 {
                animator.release(to);
            }
        }
        8 => {
            let pos = lower(random);
            let delta = vec2(random.between(-400.0, 400.0), random.between(-400.0, 400.0));
            animator.wheel(pos, delta);
        }
        9 => {
            let all = [
                Modifiers::NONE,
                Modifiers::SHIFT,
                Modifiers::ALT,
                Modifiers::COMMAND,
                Modifiers::ALT | Modifiers::SHIFT,
            ];
            animator.hold(random.choice(&all));
        }
        10 => {
            let key = random.choice(&[Key::Escape, Key::Num2, Key::Delete, Key::Tab, Key::Enter, Key::Space]);
            if random.below(2) == 0 {
                animator.harness.key_down(key)
            } else {
                animator.harness.key_up(key)
            }
            animator.steps(1);
        }
        11 => {
            let command = random.choice(commands);
            animator.request(Request::Command(command));
        }
        12 => {
            let bone = random.below(70) as u32;
            let flag = random.choice(&BoneFlag::ALL);
            let request = match random.below(5) {
                0 => Request::Select((random.below(3) > 0).then_some(bone.min(63))),
                1 => Request::ShowTake(Some(random.below(4))),
                2 => Request::Timeline(KeysRequest::Flag(flag, bone, random.below(2) == 0)),
                3 => Request::Seek(random.between(-1.0, 5.0)),
                _ => {
                    let wild = [f64::NAN, f64::INFINITY, -1e300, 0.0, 1e-30, 2.0];
                    let window = TimeWindow { start: random.choice(&wild), length: random.choice(&wild) };
                    Request::Timeline(KeysRequest::Window(Some(window)))
                }
            };
            animator.request(request);
        }
        _ => {
            animator.harness.event(Event::PointerGone);
            animator.steps(1);
        }
    }
}

#[test]
fn random_mouse_and_key_input_does_not_break_the_timeline() {
    let seed = seed(20);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    // All commands about keys and playback; commands that open dialogs or files are tested elsewhere.
    let commands: Vec<Id> = [
        panels::commands::Category::Keys,
        panels::commands::Category::Playback,
        panels::commands::Category::Edit,
    ]
    .into_iter()
    .flat_map(|category| panels::commands::of(category).iter().map(|command| command.id))
    .collect();
    let mut animator = Animator::new(fixture::full());
    for _ in 0..EVENTS {
        act(&mut animator, &mut random, &commands);
    }
    // All keys and buttons are released, and the panels still work.
    animator.hold(Modifiers::NONE);
    for button in [PointerButton::Primary, PointerButton::Secondary, PointerButton::Middle] {
        animator.button(pos2(2.0, 2.0), button, false);
    }
    animator.harness.key_press(Key::Escape);
    animator.steps(4);
    animator.request(Request::ShowTake(Some(0)));
    animator.request(Request::Command(Id::SelectAllKeys));
    assert_eq!(animator.edited.adapter().check(), Ok(()));
}
