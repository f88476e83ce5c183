//! Nothing that is typed, pressed or dragged anywhere in the window breaks it.

use crate::nasty;
use crate::workbench::{WINDOW, Window, Workbench, button};
use dragonfly::panels::Request;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{CreateTake, Edit, RenameTake, SplitTake, TakeRef};
use dragonfly_document::history::Edited;
use dragonfly_kit::document::fixture;
use dragonfly_kit::folder::takes_long;
use dragonfly_kit::random::{Random, seed};
use egui::{Event, Key, Modifiers, MouseWheelUnit, Vec2, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};

fn bench() -> Workbench {
    let mut bench = Workbench::full();
    bench.state.execute(Request::Select(Some(3)));
    bench
}

/// Returns the number of rounds: `few`, or ten times `few` with `DRAGONFLY_LONG`.
fn times(few: usize) -> usize {
    if takes_long() { 10 * few } else { few }
}

/// Every number field accepts or refuses any text. A text that is no number changes nothing.
#[test]
fn any_text_typed_into_any_number_field_leaves_a_finite_pose() {
    let mut window = bench().window_of_any_text();
    window.get_by_label("Show the quaternion").click();
    window.run_steps(3);
    let fields: Vec<String> = window
        .root()
        .children_recursive()
        .filter(|node| node.accesskit_node().role() == egui::accesskit::Role::SpinButton)
        .filter_map(|node| node.accesskit_node().label())
        .collect();
    assert!(fields.len() > 20, "{fields:?}");
    let seed = seed(0x7e87);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let mut texts = nasty::texts();
    texts.extend((0..times(1_000)).map(|_| nasty::any(&mut random)));
    for (at, text) in texts.iter().enumerate() {
        // Each text in three fields, so that each field sees several.
        for more in 0..3 {
            let field = &fields[(at * 3 + more) % fields.len()];
            let Some(node) = window.query_by_label(field) else { continue };
            node.click();
            window.run_steps(1);
            window.event(Event::Text(text.clone()));
            window.run_steps(1);
            window.key_press([Key::Enter, Key::Tab, Key::Escape][more]);
            window.run_steps(1);
            window.key_press(Key::Escape);
            window.run_steps(1);
        }
    }
    let bench = window.state();
    for bone in 0..bench.state.read().selection.bone_count() as u32 {
        let pose = bench.pose(bone);
        assert!(pose.translation.is_finite() && pose.rotation.is_finite() && pose.scale.is_finite());
    }
}

fn some_event(random: &mut Random, at: egui::Pos2, texts: &[String]) -> Event {
    const KEYS: &[Key] = &[
        Key::Enter,
        Key::Tab,
        Key::Escape,
        Key::Space,
        Key::Delete,
        Key::Backspace,
        Key::F2,
        Key::Z,
        Key::Y,
        Key::ArrowUp,
        Key::ArrowDown,
        Key::ArrowLeft,
        Key::PageUp,
        Key::PageDown,
        Key::A,
        Key::Home,
        Key::End,
        Key::F3,
    ];
    let modifiers = random.choice(&[Modifiers::NONE, Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND]);
    match random.below(10) {
        0..4 => Event::PointerMoved(at),
        4 => Event::Text(texts[random.below(texts.len())].clone()),
        5 => Event::Text(random.choice(&["1", "45/2", "-3", "abc"]).to_owned()),
        6 => Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, random.between(-200.0, 200.0)),
            phase: egui::TouchPhase::Move,
            modifiers,
            source: egui::MouseWheelSource::Wheel,
        },
        7 => Event::PointerButton {
            pos: at,
            button: random.choice(&[egui::PointerButton::Secondary, egui::PointerButton::Middle]),
            pressed: random.below(2) == 0,
            modifiers,
        },
        8 => Event::ModifiersChanged(modifiers),
        _ => {
            let key = random.choice(KEYS);
            Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
        }
    }
}

/// Sends random events to a window of `size` points.
pub(crate) fn run(window: &mut Window, size: Vec2, random: &mut Random, events: usize, texts: &[String]) {
    let mut down = false;
    for _ in 0..events {
        let at = pos2(random.between(-20.0, size.x + 20.0), random.between(-20.0, size.y + 20.0));
        // Half of the positions are in the panels that this test is about.
        let at = match random.below(4) {
            0 => pos2(random.between(size.x - 260.0, size.x - 5.0), random.between(40.0, size.y - 190.0)),
            1 => pos2(random.between(5.0, 245.0), random.between(size.y - 350.0, size.y - 190.0)),
            _ => at,
        };
        if random.below(4) == 0 {
            down = !down;
            window.event(Event::PointerMoved(at));
            button(window, at, down);
        } else {
            window.event(some_event(random, at, texts));
            window.run_steps(1);
        }
    }
    button(window, pos2(0.0, 0.0), false);
}

/// Any text can be typed into the search fields.
#[test]
fn any_text_can_be_searched_for() {
    let seed = seed(0x5ea4);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let names: Vec<String> = (0..20).map(|_| nasty::any(&mut random)).collect();
    for field in ["Find a bone", "Filter bones of the timeline", "Find a take"] {
        let takes: Vec<(&str, f32, usize)> = names.iter().map(|name| (name.as_str(), 1.0, 3)).collect();
        let view = fixture::view("model", fixture::skeleton(9), &takes);
        let mut window = Workbench::new(Some(view)).window_of_any_text();
        for _ in 0..if takes_long() { 10_000 } else { 200 } {
            window.get_by_label(field).focus();
            window.event(Event::Text(nasty::any(&mut random)));
            window.run_steps(1);
            if random.below(3) == 0 {
                window.key_press_modifiers(Modifiers::COMMAND, Key::A);
                window.key_press(Key::Delete);
                window.run_steps(1);
            }
        }
    }
}

#[test]
fn any_text_is_a_name_or_is_refused_and_changes_nothing() {
    let seed = seed(0x4a3e);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let view = fixture::full();
    let mut edited = Edited::new(ModelAdapter::of(&view.loaded.model));
    let mut kept = 0;
    for _ in 0..10_000 {
        let name = nasty::any(&mut random);
        let take = TakeRef::Index(random.below(3));
        let edit = match random.below(3) {
            0 => Edit::RenameTake(RenameTake { take, name: name.clone() }),
            1 => Edit::CreateTake(CreateTake { name: name.clone(), copy: Some(take), at: None }),
            _ => Edit::SplitTake(SplitTake { take, time: 0.3, name: name.clone() }),
        };
        if edited.apply(edit, None).is_ok() {
            kept += 1;
            assert!(edited.adapter().results().any(|take| take.name == name), "seed {seed}: {name:?}");
            assert_eq!(edited.adapter().check(), Ok(()), "seed {seed}: {name:?}");
            edited.undo();
        }
        let names: Vec<String> = edited.adapter().results().map(|take| take.name.clone()).collect();
        assert_eq!(names, ["Survey", "Walk", "Run"], "seed {seed}: {name:?}");
    }
    assert!(kept > 5_000, "{kept}");
}

#[test]
fn random_events_in_the_panels_never_panic() {
    let seed = seed(0xDA);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let texts = nasty::texts();
    for round in 0..4 {
        let bench = match round {
            0 => Workbench::new(None),
            1 => Workbench::new(Some(fixture::empty())),
            _ => bench(),
        };
        let mut window = bench.window_of_any_text();
        run(&mut window, WINDOW, &mut random, if round < 2 { 100 } else { 500 }, &texts);
        let Some(edited) = &window.state().edited else { continue };
        assert_eq!(edited.adapter().check(), Ok(()), "seed {seed}");
        // All of it can be undone.
        let mut edited = edited.clone();
        edited.go_to(0);
        let view = fixture::full();
        if round >= 2 {
            for (now, then) in edited.adapter().results().zip(view.takes.iter()) {
                assert_eq!(now, then, "seed {seed}");
            }
        }
    }
}
