//! Sounds of a scene: which are read, and the messages about them.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::run;
use crate::workbench::Window;
use dragonfly::panels::commands::Id;
use dragonfly_document::{Cancel, SoundPeaks};
use dragonfly_kit::folder::Folder;
use egui_kittest::kittest::Queryable;

/// The foxes with a thunder of half a second at one second, twice, and one that is missing.
fn thunder() -> String {
    let sounds =
        "<sound src=\"thunder.wav\" begin=\"1\" repeat=\"2\"/>\n    <sound src=\"none.wav\" begin=\"2\"/>";
    FOXES.replace("    <title", &format!("    {sounds}\n    <title"))
}

/// Returns the peaks of half a second of full loudness.
fn peaks() -> SoundPeaks {
    let folder = Folder::new("scene-sound");
    let path = folder.join("thunder.wav");
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 8000,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::create(&path, spec).expect("a file");
    (0..4000)
        .for_each(|at| writer.write_sample(if at % 2 == 0 { i16::MAX } else { i16::MIN }).expect("a sample"));
    writer.finalize().expect("a file");
    SoundPeaks::read(&path, &Cancel::default()).expect("a sound")
}

fn said(window: &Window) -> String {
    window.state().state.read().status.last().map(|message| message.text.clone()).unwrap_or_default()
}

#[test]
fn each_sound_of_a_scene_is_wanted_once() {
    let mut bench = scene(&thunder());
    let wanted = |bench: &crate::workbench::Workbench| {
        let read = bench.state.read();
        let plan = read.scene().and_then(|scene| scene.plan.clone()).expect("a plan");
        read.scene_editing.sounds().wanted(&plan).map(str::to_owned)
    };
    assert_eq!(wanted(&bench).as_deref(), Some("thunder.wav"));
    bench.state.scene_sounds().begin("thunder.wav");
    assert_eq!(wanted(&bench).as_deref(), Some("none.wav"));
    bench.state.scene_sounds().receive("none.wav", Err("none.wav: not found".to_owned()));
    assert_eq!(wanted(&bench), None);
    let opened = bench.state.read().scene_editing.sounds().opened();
    bench.state.show(dragonfly_kit::document::fixture::full());
    assert!(bench.state.read().scene_editing.sounds().opened() > opened, "earlier answers mean nothing");
}

/// Returns the times from and to which waveforms are drawn in the lanes, seconds; `None` without one.
fn drawn(window: &Window) -> Option<[f32; 2]> {
    let canvas = window.query_by_label_contains("Lanes of the scene").expect("lanes").rect();
    // The lanes have a margin of 16 points before the start and after the end.
    let (left, width) = (canvas.left() + 16.0, canvas.width() - 32.0);
    let shown = window.state().state.read().scene_editing.window();
    let meshes = window.output().shapes.iter().filter_map(|shape| match &shape.shape {
        egui::Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    });
    let points = meshes.flat_map(|mesh| mesh.vertices.iter().map(|vertex| vertex.pos));
    let times = points
        .filter(|at| canvas.contains(*at))
        .map(|at| shown.start as f32 + (at.x - left) / width * shown.length as f32);
    let [from, to] = times.fold([f32::MAX, f32::MIN], |[from, to], time| [from.min(time), to.max(time)]);
    (from <= to).then_some([from, to])
}

#[test]
fn the_bar_of_a_sound_has_its_waveform_as_often_as_it_repeats() {
    let mut window = scene(&thunder()).window();
    assert_eq!(drawn(&window), None, "nothing is known of the sound");
    window.state_mut().state.scene_sounds().receive("thunder.wav", Ok(peaks()));
    window.run_steps(2);
    // Two times half a second from one second on; the bar is longer.
    let [from, to] = drawn(&window).expect("a waveform");
    assert!((from - 1.0).abs() < 0.02 && (to - 2.0).abs() < 0.02, "from {from} to {to} s");
}

#[test]
fn playing_a_scene_with_sounds_tells_once_that_they_are_silent() {
    let mut window = scene(&thunder()).window();
    run(&mut window, Id::PlayPause);
    assert!(said(&window).contains("no sound output"), "{}", said(&window));
    run(&mut window, Id::PlayPause);
    window.state_mut().state.say(dragonfly::panels::status::MessageSeverity::Info, "something else");
    run(&mut window, Id::PlayPause);
    assert_eq!(said(&window), "something else");
    let mut silent = scene(FOXES).window();
    run(&mut silent, Id::PlayPause);
    assert!(!said(&silent).contains("no sound output"), "{}", said(&silent));
}
