//! The lane of the sound in the timeline: its waveform, dragged by whole frames, and removed.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::sound::SoundSettings;
use dragonfly_document::{Cancel, SoundSource, Source};
use dragonfly_kit::folder::Folder;
use egui::{Shape, vec2};
use egui_kittest::kittest::Queryable;

/// Creates a window with a sound of two seconds: one of silence, one at full scale.
fn animator(folder: &Folder) -> Animator {
    let path = folder.join("step.wav");
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 8000,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::create(&path, spec).expect("a file");
    for at in 0..16_000 {
        let loud = if at % 2 == 0 { i16::MAX } else { i16::MIN };
        writer.write_sample(if at < 8000 { 0 } else { loud }).expect("a sample");
    }
    writer.finalize().expect("a file");
    let mut animator = Animator::with_bone(3);
    animator.request(Request::FrameRate(24));
    animator.request(Request::Open(Source::File(path.clone())));
    assert_eq!(animator.harness.state().state.read().sound.settings().file, path, "a sound is no model");
    let peaks = SoundSource::File(path.clone()).peaks(&Cancel::default());
    animator.harness.state_mut().state.sound().read(peaks);
    animator.steps(3);
    animator
}

fn start(animator: &Animator) -> i32 {
    animator.harness.state().state.read().sound.settings().start
}

/// Returns the height of the waveform at a time of the take, points; `None` where nothing is drawn.
fn height(animator: &Animator, time: f32) -> Option<f32> {
    let lane = animator.harness.get_by_label("Sound").rect();
    let x = animator.at(time, 0).x;
    let meshes = animator.harness.output().shapes.iter().filter_map(|shape| match &shape.shape {
        Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    });
    let points = meshes.flat_map(|mesh| mesh.vertices.iter().map(|vertex| vertex.pos));
    let there = points.filter(|at| lane.expand(1.0).contains(*at) && (at.x - x).abs() < 1.5);
    let [low, high] = there.fold([f32::MAX, f32::MIN], |[low, high], at| [low.min(at.y), high.max(at.y)]);
    (low <= high).then_some(high - low)
}

#[test]
fn the_waveform_is_at_its_time_and_a_drag_moves_it_by_whole_frames() {
    let folder = Folder::new("timeline-sound");
    let mut animator = animator(&folder);
    let heights = |animator: &Animator| [0.5, 1.5, 2.5].map(|time| height(animator, time));
    let [silent, loud, after] = heights(&animator);
    assert!(
        silent.is_some_and(|height| height < 3.0) && loud.is_some_and(|height| height > 20.0),
        "{silent:?} {loud:?}"
    );
    assert_eq!(after, None, "the sound is two seconds long");
    // A second to the right: 24 frames.
    let lane = animator.harness.get_by_label("Sound").rect();
    let from = egui::pos2(animator.at(1.2, 0).x, lane.center().y);
    let to = from + vec2(animator.at(2.2, 0).x - animator.at(1.2, 0).x, 0.0);
    animator.drag(from, to);
    animator.release(to);
    animator.move_to(lane.center() - vec2(0.0, 200.0));
    animator.steps(2);
    assert_eq!(start(&animator), 24);
    let [before, silent, loud] = heights(&animator);
    assert!(before.is_none() && silent.is_some_and(|height| height < 3.0), "{before:?} {silent:?}");
    assert!(loud.is_some_and(|height| height > 20.0), "{loud:?}");
    // Escape leaves it where it was.
    animator.drag(to, to + vec2(80.0, 0.0));
    animator.harness.key_press(egui::Key::Escape);
    animator.steps(2);
    animator.release(to + vec2(80.0, 0.0));
    assert_eq!(start(&animator), 24);
    animator.request(Request::Seek(0.5));
    animator.request(Request::Command(Id::SoundToPlayhead));
    assert_eq!(start(&animator), 12);
    animator.request(Request::Command(Id::RemoveSound));
    assert!(animator.harness.query_by_label("Sound").is_none());
    assert_eq!(animator.edits().len(), 0, "the document stays as it is");
}

#[test]
fn a_broken_sound_shows_the_reason_in_its_lane() {
    let mut animator = Animator::with_bone(3);
    let file = "/films/broken.wav".into();
    animator.request(Request::Sound(SoundSettings { file, start: 0 }));
    animator.harness.state_mut().state.sound().read(Err("broken.wav cannot be read: it is empty".to_owned()));
    animator.steps(2);
    assert!(animator.harness.query_by_label("Sound").is_some());
    assert_eq!(
        animator.harness.state().state.read().sound.problem(),
        Some("broken.wav cannot be read: it is empty")
    );
}
