//! Every input finds the control that it is for, whatever the controls do meanwhile; checked against a plain model.

use dragonfly::control::{
    Area, BaseControl, Button, ControlFramework, ControlId, Controls, InputEvent, Key, Modifiers, Mouse,
    Pass, PlaceError,
};
use dragonfly_kit::counting;
use dragonfly_kit::random::{Random, seed};
use glam::Vec2;

/// What a control was told.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Told {
    Enter,
    Leave,
    Move,
    Wheel,
    Down(Button),
    Up(Button),
    KeyDown(Key, bool),
    KeyUp(Key),
    Focus,
    NoFocus,
    Lost,
}

/// What a control does besides, when a button goes down on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Deed {
    #[default]
    Nothing,
    UnregisterSelf,
    Unregister(ControlId),
    Register(Area),
    Focus(ControlId),
}

struct Probe {
    id: ControlId,
    passes: bool,
    /// Is it round, inside its area?
    circle: Option<(Vec2, f32)>,
    deed: Deed,
    /// Takes the focus whenever it loses it.
    greedy: bool,
    told: Vec<Told>,
}

impl Probe {
    fn note(&mut self, told: Told) -> Pass {
        self.told.push(told);
        if self.passes { Pass::ToParent } else { Pass::Stop }
    }
}

impl BaseControl for Probe {
    fn is_pos_on(&self, point: Vec2) -> bool {
        self.circle.is_none_or(|(center, radius)| center.distance(point) < radius)
    }
    fn set_focus(&mut self, _: &mut ControlFramework) {
        self.note(Told::Focus);
    }
    fn null_focus(&mut self, framework: &mut ControlFramework) {
        self.note(Told::NoFocus);
        if self.greedy {
            framework.set_focus(self.id);
        }
    }
    fn key_down(&mut self, key: Key, _: Modifiers, repeat: bool, _: &mut ControlFramework) -> Pass {
        self.note(Told::KeyDown(key, repeat))
    }
    fn key_up(&mut self, key: Key, _: Modifiers, _: &mut ControlFramework) -> Pass {
        self.note(Told::KeyUp(key))
    }
    fn mouse_enter(&mut self, _: &mut ControlFramework) {
        self.note(Told::Enter);
    }
    fn mouse_leave(&mut self, _: &mut ControlFramework) {
        self.note(Told::Leave);
    }
    fn mouse_move(&mut self, _: Mouse, _: &mut ControlFramework) -> Pass {
        self.note(Told::Move)
    }
    fn mouse_wheel(&mut self, _: Vec2, _: Mouse, _: &mut ControlFramework) -> Pass {
        self.note(Told::Wheel)
    }
    fn mouse_down(&mut self, button: Button, _: Mouse, framework: &mut ControlFramework) -> Pass {
        match self.deed {
            Deed::Nothing => {}
            Deed::UnregisterSelf => assert!(framework.unregister_control(self.id)),
            Deed::Unregister(other) => _ = framework.unregister_control(other),
            Deed::Register(area) => _ = framework.register_control(area),
            Deed::Focus(other) => framework.set_focus(other),
        }
        self.note(Told::Down(button))
    }
    fn mouse_up(&mut self, button: Button, _: Mouse, _: &mut ControlFramework) -> Pass {
        self.note(Told::Up(button))
    }
    fn input_lost(&mut self, _: &mut ControlFramework) {
        self.note(Told::Lost);
    }
}

/// The owner of all controls.
#[derive(Default)]
struct Owner {
    probes: Vec<Probe>,
}

impl Controls for Owner {
    fn control(&mut self, id: ControlId) -> Option<&mut dyn BaseControl> {
        self.probes.iter_mut().find(|probe| probe.id == id).map(|probe| probe as &mut dyn BaseControl)
    }
}

impl Owner {
    fn add(&mut self, framework: &mut ControlFramework, area: Area) -> ControlId {
        let id = framework.register_control(area);
        self.own(id);
        id
    }

    fn own(&mut self, id: ControlId) {
        let told = Vec::with_capacity(256);
        self.probes.push(Probe { id, passes: false, circle: None, deed: Deed::Nothing, greedy: false, told });
    }

    fn get(&mut self, id: ControlId) -> &mut Probe {
        self.probes.iter_mut().find(|probe| probe.id == id).unwrap()
    }

    /// What a control was told since the last time.
    fn told(&mut self, id: ControlId) -> Vec<Told> {
        std::mem::take(&mut self.get(id).told)
    }

    fn forget(&mut self) {
        self.probes.iter_mut().for_each(|probe| probe.told.clear());
    }
}

fn area(x: f32, y: f32, width: f32, height: f32) -> Area {
    Area::new(Vec2::new(x, y), Vec2::new(x + width, y + height))
}

fn to(x: f32, y: f32) -> InputEvent {
    InputEvent::MouseMove(Vec2::new(x, y))
}

const A: Key = Key::Letter('a');
const LEFT: Button = Button::Left;

/// A window with a picture in it, a tool in that, and a panel beside it.
fn window() -> (ControlFramework, Owner, [ControlId; 3]) {
    let (mut framework, mut owner) = (ControlFramework::new(Vec2::new(800.0, 600.0)), Owner::default());
    // The inner one first: the order of registration does not matter.
    let tool = owner.add(&mut framework, area(100.0, 100.0, 50.0, 50.0));
    let picture = owner.add(&mut framework, area(0.0, 0.0, 600.0, 600.0));
    let panel = owner.add(&mut framework, area(600.0, 0.0, 200.0, 600.0));
    (framework, owner, [picture, tool, panel])
}

#[test]
fn a_control_is_the_parent_of_all_that_lie_wholly_inside_it() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    assert_eq!(framework.parent(tool), Some(picture));
    assert_eq!(framework.parent(picture), Some(ControlId::ROOT));
    assert_eq!(framework.parent(panel), Some(ControlId::ROOT));
    assert_eq!(framework.parent(ControlId::ROOT), None);
    // As large as the picture, and later: it comes between the two.
    let between = owner.add(&mut framework, area(0.0, 0.0, 600.0, 600.0));
    assert_eq!(framework.parent(tool), Some(between));
    assert_eq!(framework.parent(between), Some(picture));
    assert!(framework.is_inside(tool, picture) && !framework.is_inside(picture, tool));
    // It goes: those inside get its parent. Its name means nothing any more.
    assert!(framework.unregister_control(between));
    assert!(!framework.unregister_control(between));
    assert_eq!(framework.parent(tool), Some(picture));
    // It leaves the picture.
    assert!(framework.move_control(tool, area(590.0, 0.0, 50.0, 50.0)));
    assert_eq!(framework.parent(tool), Some(ControlId::ROOT));
    assert!(!framework.unregister_control(ControlId::ROOT));
}

#[test]
fn a_control_can_be_registered_inside_another_only() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    let inside = owner.get(picture).register_control(picture, area(10.0, 10.0, 5.0, 5.0), &mut framework);
    assert_eq!(framework.parent(inside.unwrap()), Some(picture));
    let outside = owner.get(tool).register_control(tool, area(10.0, 10.0, 5.0, 5.0), &mut framework);
    assert_eq!(outside, Err(PlaceError::NotInside));
    assert!(!owner.get(panel).unregister_control(panel, tool, &mut framework), "not its own");
    assert!(owner.get(picture).unregister_control(picture, tool, &mut framework));
    assert_eq!(framework.register_inside(tool, area(0.0, 0.0, 1.0, 1.0)), Err(PlaceError::NoParent));
}

#[test]
fn the_mouse_goes_to_the_deepest_control_and_on_to_its_parents_as_far_as_each_passes_it() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    owner.get(tool).passes = true;
    assert_eq!(framework.resolve_input(to(120.0, 120.0), &mut owner), Some(picture));
    assert_eq!(owner.told(tool), [Told::Enter, Told::Move]);
    assert_eq!(owner.told(picture), [Told::Move]);
    owner.get(tool).passes = false;
    assert_eq!(framework.resolve_input(InputEvent::Wheel(Vec2::Y), &mut owner), Some(tool));
    assert_eq!((owner.told(tool), owner.told(picture)), (vec![Told::Wheel], vec![]));
    framework.resolve_input(to(700.0, 50.0), &mut owner);
    assert_eq!(owner.told(tool), [Told::Leave]);
    assert_eq!(owner.told(panel), [Told::Enter, Told::Move]);
    assert_eq!(owner.told(picture), []);
    // A control that is round is met on its disc only.
    owner.get(tool).circle = Some((Vec2::new(125.0, 125.0), 10.0));
    assert_eq!(framework.resolve_input(to(101.0, 101.0), &mut owner), Some(picture));
    assert_eq!(framework.resolve_input(to(900.0, 50.0), &mut owner), None, "outside of the window");
    framework.resize(Vec2::new(50.0, 50.0));
    assert_eq!(framework.resolve_input(to(700.0, 50.0), &mut owner), None, "the window is smaller");
}

#[test]
fn a_held_button_keeps_the_mouse_with_the_control_it_went_down_on() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(to(700.0, 50.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(Button::Right), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    framework.resolve_input(to(-50.0, 50.0), &mut owner);
    assert_eq!(framework.captured(), Some(tool));
    framework.resolve_input(InputEvent::MouseUp(Button::Right), &mut owner);
    use Told::{Down, Enter, Leave, Move, Up};
    let right = Button::Right;
    let expected = [Enter, Move, Down(LEFT), Move, Down(right), Up(LEFT), Move, Up(right), Leave];
    assert_eq!(owner.told(tool), expected);
    assert_eq!(framework.captured(), None);
    assert_eq!((owner.told(panel), owner.told(picture)), (vec![], vec![]));
    // A press that began beside the window belongs to nobody, even when it comes in.
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    assert_eq!(owner.told(tool), [Enter], "after the release");
}

#[test]
fn keys_go_to_the_focus_else_to_what_is_under_the_mouse_and_end_where_they_began() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    framework.resolve_input(to(300.0, 300.0), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    framework.set_focus(panel);
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    framework.resolve_input(InputEvent::KeyDown(Key::Enter), &mut owner);
    framework.resolve_input(InputEvent::KeyUp(A), &mut owner);
    assert_eq!(owner.told(picture), [Told::KeyDown(A, false), Told::KeyDown(A, true), Told::KeyUp(A)]);
    assert_eq!(owner.told(panel), [Told::Focus, Told::KeyDown(Key::Enter, false)]);
    framework.null_focus();
    framework.update(&mut owner);
    framework.resolve_input(InputEvent::KeyUp(Key::Enter), &mut owner);
    framework.resolve_input(InputEvent::KeyUp(Key::Enter), &mut owner);
    assert_eq!(owner.told(panel), [Told::NoFocus, Told::KeyUp(Key::Enter)]);
    // Passed on like everything else.
    owner.get(tool).passes = true;
    framework.set_focus(tool);
    assert_eq!(framework.resolve_input(InputEvent::KeyDown(A), &mut owner), Some(picture));
}

#[test]
fn keys_go_to_what_is_dragged_wherever_the_mouse_and_the_focus_are() {
    let (mut framework, mut owner, [_, tool, panel]) = window();
    framework.set_focus(panel);
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(to(700.0, 50.0), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::KeyDown(Key::Escape), &mut owner);
    assert_eq!((owner.told(tool), owner.told(panel)), (vec![Told::KeyDown(Key::Escape, false)], vec![]));
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    assert_eq!(owner.told(panel).last(), Some(&Told::KeyDown(A, false)));
}

#[test]
fn lost_input_cancels_what_is_captured_and_lets_every_key_go() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    owner.get(tool).passes = true;
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::Lost, &mut owner);
    assert_eq!(owner.told(tool), [Told::Lost, Told::KeyUp(A), Told::Leave]);
    assert_eq!(owner.told(picture), [Told::Lost, Told::KeyUp(A)], "the press was passed on to it");
    assert_eq!(owner.told(panel), []);
    assert_eq!(framework.captured(), None);
    // The release that comes late means nothing.
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    framework.resolve_input(InputEvent::KeyUp(A), &mut owner);
    assert_eq!(owner.told(tool), []);
    // A second press without a release in between: the first was lost.
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    use Told::{Down, Enter, Lost, Move};
    assert_eq!(owner.told(tool), [Enter, Move, Down(LEFT), Lost, Down(LEFT)]);
}

#[test]
fn controls_come_and_go_while_an_input_is_on_its_way() {
    let (mut framework, mut owner, [picture, tool, _]) = window();
    owner.get(tool).passes = true;
    owner.get(tool).deed = Deed::UnregisterSelf;
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    assert_eq!(framework.captured(), Some(picture), "the press goes on to the parent, which keeps the mouse");
    framework.resolve_input(to(700.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    assert_eq!(owner.told(picture), [Told::Down(LEFT), Told::Move, Told::Up(LEFT)]);
    assert_eq!(owner.told(tool), [Told::Down(LEFT)]);

    let (mut framework, mut owner, [picture, tool, _]) = window();
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.unregister_control(tool);
    framework.resolve_input(to(130.0, 120.0), &mut owner);
    assert_eq!(owner.told(picture), [], "nobody has a mouse whose owner is gone");
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    assert_eq!(owner.told(picture), [Told::Enter]);

    let (mut framework, mut owner, [picture, tool, _]) = window();
    owner.get(tool).passes = true;
    owner.get(tool).deed = Deed::Unregister(picture);
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    assert_eq!(owner.told(picture), [], "it is gone, though its owner has it still");

    let (mut framework, mut owner, [_, tool, panel]) = window();
    owner.get(tool).deed = Deed::Register(area(110.0, 110.0, 20.0, 20.0));
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    assert_eq!(framework.hovered(), Some(tool), "a control that its owner does not have is not met");
    owner.get(tool).deed = Deed::Focus(panel);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    assert_eq!(owner.told(panel), [Told::Focus]);
}

#[test]
fn two_controls_that_take_the_focus_from_each_other_come_to_rest() {
    let (mut framework, mut owner, [picture, _, panel]) = window();
    owner.get(picture).greedy = true;
    owner.get(panel).greedy = true;
    framework.set_focus(picture);
    framework.update(&mut owner);
    framework.set_focus(panel);
    framework.update(&mut owner);
    framework.update(&mut owner);
    owner.forget();
    framework.update(&mut owner);
    assert!(owner.probes.iter().all(|probe| probe.told.is_empty()));
}

#[test]
fn an_input_allocates_nothing() {
    let (mut framework, mut owner, [_, tool, panel]) = window();
    owner.get(tool).passes = true;
    let events = [to(120.0, 120.0), InputEvent::MouseDown(LEFT), to(300.0, 10.0), InputEvent::MouseUp(LEFT)];
    let keys = [InputEvent::KeyDown(A), InputEvent::KeyUp(A), InputEvent::Wheel(Vec2::Y), InputEvent::Lost];
    let (count, ()) = counting::count(|| {
        for event in events.into_iter().chain(keys) {
            framework.resolve_input(event, &mut owner);
            framework.set_focus(panel);
        }
    });
    assert_eq!(count.allocations, 0, "{count:?}");
}

/// The plain model: lists, and the rules as they are said.
struct Naive {
    window: Area,
    /// In the order of registration.
    controls: Vec<(ControlId, Area)>,
}

impl Naive {
    fn smaller(&self, a: usize, b: usize) -> bool {
        let (size_a, size_b) = (self.controls[a].1.size(), self.controls[b].1.size());
        size_a < size_b || (size_a == size_b && a > b)
    }

    fn least(&self, of: impl Iterator<Item = usize>) -> Option<usize> {
        of.fold(
            None,
            |best, next| if best.is_none_or(|best| self.smaller(next, best)) { Some(next) } else { best },
        )
    }

    fn parent(&self, id: ControlId) -> ControlId {
        let own = self.controls.iter().position(|control| control.0 == id).unwrap();
        let around = (0..self.controls.len()).filter(|&other| {
            let equal = self.controls[other].1 == self.controls[own].1;
            let contains = self.controls[other].1.contains(&self.controls[own].1);
            other != own && contains && (!equal || other < own) && self.smaller(own, other)
        });
        self.least(around).map_or(ControlId::ROOT, |parent| self.controls[parent].0)
    }

    fn under(&self, at: Vec2, owner: &mut Owner) -> Option<ControlId> {
        let on = |index: &usize| {
            let (id, area) = self.controls[*index];
            area.holds(at) && owner.get(id).is_pos_on(at)
        };
        let found: Vec<usize> = (0..self.controls.len()).filter(on).collect();
        self.window.holds(at).then(|| self.least(found.into_iter())).flatten().map(|at| self.controls[at].0)
    }
}

#[test]
fn random_rectangles_and_events_agree_with_the_plain_model() {
    let seed = seed(33);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let window = Vec2::splat(100.0);
    for _ in 0..300 {
        let (mut framework, mut owner) = (ControlFramework::new(window), Owner::default());
        let mut naive = Naive { window: Area::new(Vec2::ZERO, window), controls: Vec::new() };
        let mut held: Vec<Button> = Vec::new();
        let mut captured: Option<Option<ControlId>> = None;
        let mut mouse: Option<Vec2> = None;
        for _ in 0..80 {
            let place = |random: &mut Random| {
                Vec2::new(random.below(12) as f32 * 10.0 - 5.0, random.below(12) as f32 * 10.0 - 5.0)
            };
            // Few different edges, so that there are many equal and nested ones.
            let corner =
                |random: &mut Random| Vec2::new(random.below(6) as f32 * 20.0, random.below(6) as f32 * 20.0);
            match random.below(12) {
                0 | 1 => {
                    let (a, b) = (corner(&mut random), corner(&mut random));
                    let area = Area::new(a.min(b), a.max(b));
                    let id = owner.add(&mut framework, area);
                    owner.get(id).passes = random.below(2) == 0;
                    let circle = ((area.min + area.max) / 2.0, random.unit() * 60.0);
                    owner.get(id).circle = (random.below(3) == 0).then_some(circle);
                    naive.controls.push((id, area));
                }
                2 if !naive.controls.is_empty() => {
                    let index = random.below(naive.controls.len());
                    let id = naive.controls[index].0;
                    if captured.is_none() {
                        naive.controls.remove(index);
                        assert!(framework.unregister_control(id));
                        owner.probes.retain(|probe| probe.id != id);
                    }
                }
                3 if !naive.controls.is_empty() => {
                    let index = random.below(naive.controls.len());
                    let (a, b) = (corner(&mut random), corner(&mut random));
                    naive.controls[index].1 = Area::new(a.min(b), a.max(b));
                    framework.move_control(naive.controls[index].0, naive.controls[index].1);
                }
                4 => {
                    let button = random.choice(&[Button::Left, Button::Middle, Button::Right]);
                    if !held.contains(&button) {
                        if held.is_empty() {
                            captured = Some(mouse.and_then(|at| naive.under(at, &mut owner)));
                        }
                        held.push(button);
                        owner.forget();
                        framework.resolve_input(InputEvent::MouseDown(button), &mut owner);
                        if let Some(Some(target)) = captured {
                            assert!(owner.get(target).told.contains(&Told::Down(button)));
                        }
                    }
                }
                5 | 6 if !held.is_empty() => {
                    let button = held.remove(random.below(held.len()));
                    owner.forget();
                    framework.resolve_input(InputEvent::MouseUp(button), &mut owner);
                    if let Some(Some(target)) = captured {
                        assert!(owner.get(target).told.contains(&Told::Up(button)));
                    }
                    captured = captured.filter(|_| !held.is_empty());
                }
                7 if random.below(4) == 0 => {
                    framework.resolve_input(InputEvent::Lost, &mut owner);
                    (captured, mouse) = (None, None);
                    held.clear();
                }
                _ => {
                    let at = place(&mut random);
                    mouse = Some(at);
                    owner.forget();
                    let stopped = framework.resolve_input(InputEvent::MouseMove(at), &mut owner);
                    let target = captured.unwrap_or_else(|| naive.under(at, &mut owner));
                    let mut expected = Vec::new();
                    let (mut next, mut stops) = (target, None);
                    while let Some(id) = next.filter(|&id| id != ControlId::ROOT && stops.is_none()) {
                        let (_, area) = naive.controls.iter().find(|control| control.0 == id).unwrap();
                        let on = area.holds(at) && owner.get(id).is_pos_on(at);
                        if captured.is_some() || on {
                            expected.push(id);
                            stops = (!owner.get(id).passes).then_some(id);
                        }
                        next = Some(naive.parent(id));
                    }
                    let moved: Vec<ControlId> = owner
                        .probes
                        .iter()
                        .filter(|probe| probe.told.contains(&Told::Move))
                        .map(|probe| probe.id)
                        .collect();
                    assert!(moved.iter().all(|id| expected.contains(id)) && moved.len() == expected.len());
                    assert_eq!(stopped, stops);
                }
            }
            framework.update(&mut owner);
            for &(id, _) in &naive.controls {
                assert_eq!(framework.parent(id), Some(naive.parent(id)));
            }
            if captured.is_none() {
                let under = mouse.and_then(|at| naive.under(at, &mut owner));
                assert_eq!(framework.hovered(), under);
            }
            assert_eq!(framework.captured(), captured.flatten());
        }
    }
}

#[test]
fn a_thousand_random_sequences_leave_no_control_with_half_a_story() {
    let seed = seed(34);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let odd = [f32::NAN, f32::INFINITY, -1e30, 50.0];
    for _ in 0..1_000 {
        let (mut framework, mut owner) = (ControlFramework::new(Vec2::splat(100.0)), Owner::default());
        for _ in 0..10 {
            // Quarters of quarters: none overlaps another in part.
            let size = 100.0 / (1 << random.below(4)) as f32;
            let count = (100.0 / size) as usize;
            let corner = Vec2::new(random.below(count) as f32, random.below(count) as f32) * size;
            let (a, b) = (corner, corner + size);
            let id = owner.add(&mut framework, Area::new(a, b));
            owner.get(id).passes = random.below(2) == 0;
            owner.get(id).greedy = random.below(6) == 0;
            let other = random.choice(&owner.probes.iter().map(|probe| probe.id).collect::<Vec<_>>());
            owner.get(id).deed = random.choice(&[
                Deed::Nothing,
                Deed::Nothing,
                Deed::Focus(other),
                Deed::Unregister(other),
                Deed::UnregisterSelf,
                Deed::Register(Area::new(a, b)),
            ]);
        }
        for _ in 0..60 {
            let button = random.choice(&[Button::Left, Button::Middle, Button::Right]);
            let other = Key::Other(random.below(40) as u32);
            let key = random.choice(&[A, Key::Enter, Key::letter('X'), other]);
            let down = random.unit() * 100.0;
            let place = if random.below(9) == 0 { random.choice(&odd) } else { random.unit() * 120.0 };
            let event = random.choice(&[
                InputEvent::MouseMove(Vec2::new(place, down)),
                InputEvent::MouseDown(button),
                InputEvent::MouseUp(button),
                InputEvent::Wheel(Vec2::new(place, 1.0)),
                InputEvent::KeyDown(key),
                InputEvent::KeyUp(key),
                InputEvent::MouseGone,
                InputEvent::Lost,
            ]);
            framework.resolve_input(event, &mut owner);
        }
        framework.null_focus();
        framework.resolve_input(InputEvent::Lost, &mut owner);
        for probe in owner.probes.iter().filter(|probe| framework.area(probe.id).is_some()) {
            whole_story(&probe.told, probe.greedy);
        }
    }
}

/// Everything that began has ended, once.
fn whole_story(told: &[Told], greedy: bool) {
    let (mut entered, mut focused) = (false, false);
    let (mut pressed, mut keys) = (Vec::new(), Vec::new());
    for told in told {
        match *told {
            Told::Enter => assert!(!std::mem::replace(&mut entered, true)),
            Told::Leave => assert!(std::mem::replace(&mut entered, false)),
            Told::Focus => assert!(!std::mem::replace(&mut focused, true)),
            Told::NoFocus => assert!(std::mem::replace(&mut focused, false)),
            Told::Down(button) => {
                assert!(!pressed.contains(&button), "a press while pressed");
                pressed.push(button);
            }
            Told::Up(button) => pressed.retain(|&held| held != button),
            Told::Lost => pressed.clear(),
            Told::KeyDown(key, false) => keys.push(key),
            Told::KeyUp(key) => keys.retain(|&held| held != key),
            Told::KeyDown(_, true) | Told::Move | Told::Wheel => {}
        }
    }
    assert!(!entered && pressed.is_empty() && keys.is_empty(), "{told:?}");
    assert!(!focused || greedy, "{told:?}");
}
