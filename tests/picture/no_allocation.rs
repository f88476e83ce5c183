//! Playback does not allocate: the scene is computed in memory that was allocated when the model was loaded.

use dragonfly_kit::counting;
use dragonfly_kit::document::arm;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{BoneLook, Look};
use std::time::{Duration, Instant};

#[test]
fn preparing_a_frame_allocates_nothing() {
    let start = Instant::now();
    let mut scene = Scene::new(start);
    scene.show_model(arm::loaded());
    scene.look = Look { viewport: [0, 0, 640, 480], skeleton: true, selected: vec![1], ..Look::default() };
    scene.playback =
        PlaybackClock { take: Some(0), length: arm::LENGTH, playing: true, ..PlaybackClock::rest(start) };
    for bone_look in [BoneLook::Octahedra, BoneLook::Sticks, BoneLook::Lines] {
        scene.look.bone_look = bone_look;
        let (count, ()) = counting::count(|| {
            for frame in 0..100 {
                scene.prepare(start + Duration::from_millis(16 * frame));
            }
        });
        assert_eq!(count.allocations, 0, "{bone_look:?}: {count:?}");
    }
    assert!(counting::so_far().allocations > 0, "the counter counts");
}
