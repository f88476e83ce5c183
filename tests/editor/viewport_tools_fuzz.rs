//! Random mouse and keyboard input over the window causes no panic and leaves nothing held.

use crate::panels::{Bench, harness_of};
use crate::viewport_tools_rig::{PICTURE, ViewportHarness};
use dragonfly::panels::Request;
use dragonfly::panels::commands;
use dragonfly_document::{Cancel, LoadError, OpenedModel, Progress, Source};
use dragonfly_kit::document::arm;
use dragonfly_kit::document::fixture;
use dragonfly_kit::folder::takes_long;
use dragonfly_kit::random::{Random, seed};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput, pos2};
use std::sync::Arc;

fn load(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
    Ok(Arc::into_inner(arm::loaded()).expect("the only one").into())
}

const BUTTONS: [PointerButton; 3] = [PointerButton::Primary, PointerButton::Middle, PointerButton::Secondary];
const KEYS: [Key; 22] = [
    Key::X,
    Key::Y,
    Key::Z,
    Key::Num0,
    Key::Num3,
    Key::Num9,
    Key::Minus,
    Key::Period,
    Key::Slash,
    Key::Enter,
    Key::Escape,
    Key::Tab,
    Key::Backspace,
    Key::Q,
    Key::W,
    Key::E,
    Key::R,
    Key::T,
    Key::H,
    Key::OpenBracket,
    Key::CloseBracket,
    Key::ArrowLeft,
];

fn modifiers(random: &mut Random) -> Modifiers {
    let [alt, shift, ctrl] = [(); 3].map(|()| random.below(4) == 0);
    Modifiers { alt, ctrl, shift, mac_cmd: false, command: ctrl }
}

fn place(random: &mut Random, middle: Pos2) -> Pos2 {
    match random.below(12) {
        0 => pos2(f32::NAN, random.unit() * 800.0),
        1 => pos2(1e30, -1e30),
        2..6 => pos2(random.unit() * 1280.0, random.unit() * 720.0),
        // Where handles are.
        _ => middle + egui::vec2(random.unit() - 0.5, random.unit() - 0.5) * 220.0,
    }
}

fn event(random: &mut Random, middle: Pos2) -> Event {
    let modifiers = modifiers(random);
    match random.below(12) {
        0..4 => Event::PointerMoved(place(random, middle)),
        4..7 => Event::PointerButton {
            pos: place(random, middle),
            button: BUTTONS[if random.below(3) > 0 { 0 } else { random.below(3) }],
            pressed: random.below(2) == 0,
            modifiers,
        },
        7..10 => {
            let key = KEYS[random.below(KEYS.len())];
            let (pressed, repeat) = (random.below(4) > 0, random.below(6) == 0);
            Event::Key { key, physical_key: None, pressed, repeat, modifiers }
        }
        10 => match random.below(6) {
            0 => Event::WindowFocused(false),
            1 => Event::PointerGone,
            2 => Event::Text("(\u{b0}\u{1F98A}".to_owned()),
            3 => Event::Cut,
            4 => Event::Paste("30".to_owned()),
            _ => Event::Copy,
        },
        _ => Event::ModifiersChanged(modifiers),
    }
}

fn safe(at: Pos2) -> bool {
    at.is_finite() && at.x.abs() < 1e5
}

#[test]
fn random_events_and_commands_leave_the_document_valid() {
    let seed = seed(2026);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut viewport = ViewportHarness::new(load);
    let context = egui::Context::default();
    let all: Vec<commands::Id> = commands::all()
        .map(|command| command.id)
        .filter(|id| !matches!(*id, commands::Id::Quit | commands::Id::Open | commands::Id::OpenBuiltIn))
        .collect();
    let mut effects = Vec::new();
    for _ in 0..if takes_long() { 10_000_000 } else { 100_000 } {
        let joint = viewport
            .state
            .read()
            .selected()
            .map_or(glam::Vec2::new(400.0, 300.0), |_| viewport.joint_or_middle());
        let middle = pos2(joint.x + PICTURE[0], joint.y + PICTURE[1]);
        let mut input = RawInput { events: vec![event(&mut random, middle)], ..RawInput::default() };
        viewport.state.feed(&context, &mut input, 0, &mut effects);
        viewport.carry_some(&mut effects);
        match random.below(40) {
            0 => viewport.command(all[random.below(all.len())]),
            1 => _ = viewport.state.execute(Request::Select(Some(random.below(arm::BONES) as u32))),
            2 => drop(viewport.state.execute(Request::Wheel((random.unit() - 0.5) * 400.0))),
            3 => drop(viewport.state.execute(Request::Seek(random.unit()))),
            _ => {}
        }
        let camera = viewport.state.read().camera;
        assert!(camera.target.is_finite() && camera.distance.is_finite(), "{camera:?}");
        if viewport.steps().len() > 200 {
            (0..200).for_each(|_| viewport.command(commands::Id::Undo));
        }
    }
    // When the window loses the keyboard focus, every drag ends.
    let mut input = RawInput { events: vec![Event::WindowFocused(false)], ..RawInput::default() };
    viewport.state.feed(&context, &mut input, 0, &mut effects);
    assert!(
        !viewport.state.read().tools.controls().is_busy() && !viewport.state.read().tools.controls().edits()
    );
}

#[test]
fn random_input_over_the_whole_window_never_panics() {
    let seed = seed(4242);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut bench = Bench::new(Some(fixture::full()));
    bench.state.execute(Request::Select(Some(3)));
    let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
    harness.run_steps(3);
    for step in 0..600 {
        let made = event(&mut random, pos2(620.0, 300.0));
        // egui itself panics on coordinates that no window system sends.
        let sound = match &made {
            Event::PointerMoved(at) | Event::PointerButton { pos: at, .. } => safe(*at),
            _ => true,
        };
        if sound {
            harness.event(made);
        }
        if step % 3 == 0 {
            harness.run_steps(1);
        }
    }
}
