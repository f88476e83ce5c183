//! Random controls and inputs: the framework agrees with a naive model, and no control receives a press, key or focus event
//! without the event that ends it.

use crate::control_probe::{Owner, PressAction, ProbeEvent};
use dragonfly::control::{Area, BaseControl, Button, ControlFramework, ControlId, InputEvent, Key};
use dragonfly_kit::random::{Random, seed};
use glam::Vec2;

/// The naive model: plain lists, and the documented rules applied literally.
struct Naive {
    window: Area,
    /// All controls, in the order of registration.
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
fn on_random_rectangles_and_events_the_framework_agrees_with_a_naive_model() {
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
            // Coordinates have few different values, so that many rectangles are equal or nested.
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
                            assert!(owner.get(target).events.contains(&ProbeEvent::Down(button)));
                        }
                    }
                }
                5 | 6 if !held.is_empty() => {
                    let button = held.remove(random.below(held.len()));
                    owner.forget();
                    framework.resolve_input(InputEvent::MouseUp(button), &mut owner);
                    if let Some(Some(target)) = captured {
                        assert!(owner.get(target).events.contains(&ProbeEvent::Up(button)));
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
                        .filter(|probe| probe.events.contains(&ProbeEvent::Move))
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
fn after_random_input_every_press_key_and_hover_has_ended() {
    let seed = seed(34);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let odd = [f32::NAN, f32::INFINITY, -1e30, 50.0];
    for _ in 0..1_000 {
        let (mut framework, mut owner) = (ControlFramework::new(Vec2::splat(100.0)), Owner::default());
        for _ in 0..10 {
            // Squares of a grid that is halved again and again: two of them are nested or do not overlap at all.
            let size = 100.0 / (1 << random.below(4)) as f32;
            let count = (100.0 / size) as usize;
            let corner = Vec2::new(random.below(count) as f32, random.below(count) as f32) * size;
            let (a, b) = (corner, corner + size);
            let id = owner.add(&mut framework, Area::new(a, b));
            owner.get(id).passes = random.below(2) == 0;
            owner.get(id).greedy = random.below(6) == 0;
            let other = random.choice(&owner.probes.iter().map(|probe| probe.id).collect::<Vec<_>>());
            owner.get(id).on_press = random.choice(&[
                PressAction::Nothing,
                PressAction::Nothing,
                PressAction::Focus(other),
                PressAction::Unregister(other),
                PressAction::UnregisterSelf,
                PressAction::Register(Area::new(a, b)),
            ]);
        }
        for _ in 0..60 {
            let button = random.choice(&[Button::Left, Button::Middle, Button::Right]);
            let other = Key::Other(random.below(40) as u32);
            let key = random.choice(&[Key::Letter('a'), Key::Enter, Key::letter('X'), other]);
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
            assert_complete(&probe.events, probe.greedy);
        }
    }
}

/// Asserts that every hover, press, key and focus that started has ended exactly once.
fn assert_complete(told: &[ProbeEvent], greedy: bool) {
    let (mut entered, mut focused) = (false, false);
    let (mut pressed, mut keys) = (Vec::new(), Vec::new());
    for told in told {
        match *told {
            ProbeEvent::Enter => assert!(!std::mem::replace(&mut entered, true)),
            ProbeEvent::Leave => assert!(std::mem::replace(&mut entered, false)),
            ProbeEvent::Focus => assert!(!std::mem::replace(&mut focused, true)),
            ProbeEvent::NoFocus => assert!(std::mem::replace(&mut focused, false)),
            ProbeEvent::Down(button) => {
                assert!(!pressed.contains(&button), "a press while pressed");
                pressed.push(button);
            }
            ProbeEvent::Up(button) => pressed.retain(|&held| held != button),
            ProbeEvent::Lost => pressed.clear(),
            ProbeEvent::KeyDown(key, false) => keys.push(key),
            ProbeEvent::KeyUp(key) => keys.retain(|&held| held != key),
            ProbeEvent::KeyDown(_, true) | ProbeEvent::Move | ProbeEvent::Wheel => {}
        }
    }
    assert!(!entered && pressed.is_empty() && keys.is_empty(), "{told:?}");
    assert!(!focused || greedy, "{told:?}");
}
