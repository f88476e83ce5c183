//! A frame of many roles is computed in little time.

use super::{shown, view_of};
use dragonfly_document::{Cancel, Source, load_model};
use dragonfly_kit::folder::data;
use dragonfly_kit::process::thread_time;
use dragonfly_picture::playback::PlaybackClock;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Number of roles, and of frames that are measured.
const ROLES: usize = 100;
const FRAMES: u32 = 300;

/// Most processor time of a frame. Tests are built with less optimization than the program, which needs less than a third of it.
const MOST: Duration = Duration::from_millis(2);

#[test]
fn poses_and_matrices_of_a_hundred_roles_of_67_bones_take_less_than_2_ms_a_frame() {
    let rig =
        load_model(&Source::File(data("bench/pab.glb")), &mut |_| {}, &Cancel::default()).expect("the rig");
    assert_eq!(rig.model.animation.skeleton.len(), 67);
    let take = rig.model.animation.takes[0].name.clone();
    let roles: String =
        (0..ROLES).map(|role| format!("<role id=\"r{role}\" model=\"rig\" at=\"{role} 0 0\"/>")).collect();
    let plays: String = (0..ROLES)
        .map(|role| format!("<play who=\"r{role}\" take=\"{take}\" begin=\"{role}f\" repeat=\"20\"/>"))
        .collect();
    let view = view_of(&super::script(&roles, &plays), &Arc::new(rig));
    let mut scene = shown(&view, 0.0);
    let start = Instant::now();
    scene.playback = PlaybackClock { playing: true, ..PlaybackClock::of_scene(30.0, start) };
    let matrices: usize = scene.draw_sets().map(|set| set.palettes().len()).sum();
    assert!(matrices >= 54 * ROLES, "a skin of 54 joints: {matrices}");
    let mut best = Duration::MAX;
    for round in 0..3 {
        let before = thread_time();
        for frame in 0..FRAMES {
            scene.prepare(start + Duration::from_millis(u64::from(17 * (round * FRAMES + frame))));
        }
        best = best.min((thread_time() - before) / FRAMES);
    }
    println!("{ROLES} roles: {best:?} of processor time a frame");
    assert!(best < MOST, "{best:?}");
}
