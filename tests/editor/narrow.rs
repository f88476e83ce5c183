//! A window that is too small for its contents breaks nothing, whatever it shows.

use crate::nasty;
use crate::panels_random::run;
use crate::workbench::{Window, Workbench};
use dragonfly::panels::{Effect, Request, commands};
use dragonfly_kit::document::fixture;
use dragonfly_kit::folder::takes_long;
use dragonfly_kit::random::{Random, seed};
use egui::{Vec2, vec2};

fn bench() -> Workbench {
    let mut bench = Workbench::full();
    bench.state.execute(Request::Select(Some(3)));
    bench
}

fn resize(window: &mut Window, size: Vec2) {
    window.set_size(size);
    window.run_steps(2);
}

fn execute(window: &mut Window, id: commands::Id) {
    let bench = window.state_mut();
    if let Some(Effect::Change(change)) = bench.state.execute(Request::Command(id)) {
        bench.change(change);
    }
    window.run_steps(2);
}

/// A text next to the pointer can be wider than the viewport.
#[test]
fn a_text_next_to_the_pointer_fits_into_any_window() {
    let mut window = bench().window_of_any_text();
    for id in [commands::Id::BoxSelect, commands::Id::LassoSelect] {
        for width in (200..=600).step_by(20) {
            for height in [60, 240, 320, 720] {
                resize(&mut window, vec2(width as f32, height as f32));
                execute(&mut window, id);
            }
        }
    }
}

#[test]
fn every_command_can_be_executed_in_a_narrow_window() {
    for size in [vec2(300.0, 200.0), vec2(420.0, 320.0), vec2(500.0, 720.0)] {
        let mut window = bench().window_of_any_text();
        resize(&mut window, size);
        for command in commands::all() {
            execute(&mut window, command.id);
        }
    }
}

#[test]
fn random_events_in_a_narrow_window_never_panic() {
    let seed = seed(0x6e61);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let texts = nasty::texts();
    let ids: Vec<commands::Id> = commands::all().map(|command| command.id).collect();
    let rounds = if takes_long() { 200 } else { 20 };
    for round in 0..rounds {
        let bench = if round % 5 == 4 { Workbench::new(Some(fixture::empty())) } else { bench() };
        let mut window = bench.window_of_any_text();
        for _ in 0..4 {
            let size = vec2(random.between(300.0, 600.0), random.between(120.0, 720.0));
            resize(&mut window, size);
            execute(&mut window, random.choice(&ids));
            run(&mut window, size, &mut random, 20, &texts);
        }
        if let Some(edited) = &window.state().edited {
            assert_eq!(edited.adapter().check(), Ok(()), "seed {seed}");
        }
    }
}
