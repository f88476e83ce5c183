//! An image rendered without a window shows the model at the requested time over the requested background.

use dragonfly_kit::document::arm;
use dragonfly_kit::picture::images::{difference, settings};
use dragonfly_kit::picture::studio;
use dragonfly_picture::PictureSettings;
use image::RgbaImage;

#[test]
fn the_model_is_visible_and_moves_with_time() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = arm::loaded();
    let camera = Some(studio.camera(&loaded, &settings()));
    let mut at = |time| studio.render(&loaded, &PictureSettings { time, camera, ..settings() }).unwrap();
    let (begin, end, begin_again) = (at(0.0), at(arm::LENGTH), at(0.0));
    let red = |picture: &RgbaImage| {
        picture.pixels().filter(|pixel| pixel[0] > 100 && pixel[0] > pixel[2].saturating_mul(2)).count()
    };
    assert!(red(&begin) > 300, "only {} pixels show the red tube", red(&begin));
    assert!(difference(&begin, &end) > 500, "only {} pixels moved", difference(&begin, &end));
    assert_eq!(difference(&begin, &begin_again), 0, "the same time gives the same picture");
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn the_background_may_be_transparent_or_any_color() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = arm::loaded();
    let mut over = |background| {
        let settings = PictureSettings { background: Some(background), grid: false, ..settings() };
        studio.render(&loaded, &settings).unwrap()
    };
    let open = over([0, 0, 0, 0]);
    assert_eq!(open.get_pixel(0, 0).0, [0, 0, 0, 0]);
    assert!(open.pixels().any(|pixel| pixel[3] == 255), "the tube is solid");
    assert!(open.pixels().any(|pixel| (60..200).contains(&pixel[3])), "the pane is not");
    assert_eq!(over([200, 100, 50, 255]).get_pixel(0, 0).0, [200, 100, 50, 255]);
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn every_look_draws_without_an_error() {
    use dragonfly_picture::{BoneLook, Look, Shading};
    let Some(mut studio) = studio::studio() else { return };
    let loaded = arm::loaded();
    let mut before: Option<RgbaImage> = None;
    for shading in [Shading::Material, Shading::Clay, Shading::Unlit] {
        for bone_look in [BoneLook::Octahedra, BoneLook::Sticks, BoneLook::Lines] {
            let bones_in_front = bone_look != BoneLook::Sticks;
            let look = Look { shading, bone_look, bones_in_front, selected: vec![1], ..Look::default() };
            let settings = PictureSettings { look, skeleton: true, ..settings() };
            let picture = studio.render(&loaded, &settings).unwrap();
            if let Some(before) = before.replace(picture.clone()) {
                assert!(
                    difference(&before, &picture) > 20,
                    "{shading:?} with {bone_look:?} looks like the one before"
                );
            }
        }
    }
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn a_picture_of_impossible_size_is_refused() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = arm::loaded();
    for size in [[0, 10], [10, 0], [1 << 20, 4]] {
        assert!(studio.render(&loaded, &PictureSettings { size, ..settings() }).is_err());
    }
    assert_eq!(studio.stage().device().errors(), 0);
}
