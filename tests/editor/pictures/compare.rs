//! The tolerance of the comparison of two pictures.
//!
//! Drivers round colors differently and place the soft edges of lines and letters up to a few levels apart. A pixel that
//! differs by no more than [`LEVELS`] in each channel is the same; of the others a picture may have a few.

use image::{Rgba, RgbaImage};

/// Largest difference of a channel between pixels that count as the same.
pub(super) const LEVELS: u8 = 6;

/// Number of pixels that may differ in any picture, in addition to a share of them.
const SOME: usize = 6;

/// The part of a picture that may differ: one pixel of this many.
#[derive(Clone, Copy)]
pub(super) struct OneOf(usize);

/// For panels, whose lines and letters are placed by the program.
pub(super) const PANELS: OneOf = OneOf(20_000);

/// For scenes, where a driver decides which samples the edge of a triangle covers.
pub(super) const SCENES: OneOf = OneOf(4_000);

/// The difference between two pictures of the same size.
pub(super) struct PictureDifference {
    /// Number of pixels that differ.
    pub(super) pixels: usize,
    /// Number of pixels that may differ.
    pub(super) allowed: usize,
    /// Largest difference of a channel in the whole picture.
    pub(super) most: u8,
    /// The new picture, dimmed, with the pixels that differ in magenta.
    pub(super) shown: RgbaImage,
}

impl PictureDifference {
    /// Compares a new picture with the stored one; `None` if their sizes differ.
    pub(super) fn between(new: &RgbaImage, stored: &RgbaImage, OneOf(many): OneOf) -> Option<Self> {
        if new.dimensions() != stored.dimensions() {
            return None;
        }
        let (mut pixels, mut most) = (0, 0);
        let mut shown = new.clone();
        for (pixel, old) in shown.pixels_mut().zip(stored.pixels()) {
            let difference = distance(pixel.0, old.0);
            most = most.max(difference);
            if difference > LEVELS {
                pixels += 1;
                *pixel = Rgba([255, 0, 255, 255]);
            } else {
                pixel.0[..3].iter_mut().for_each(|channel| *channel /= 3);
            }
        }
        Some(Self { pixels, allowed: SOME + stored.pixels().len() / many, most, shown })
    }

    /// Returns whether the pictures count as equal.
    pub(super) fn is_small(&self) -> bool {
        self.pixels <= self.allowed
    }
}

/// Returns the largest difference of a channel between two colors.
pub(super) fn distance<const CHANNELS: usize>(a: [u8; CHANNELS], b: [u8; CHANNELS]) -> u8 {
    a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

/// A small card with a button, drawn with and without a change that must be noticed.
mod noticed {
    use super::{PANELS, PictureDifference};
    use crate::pictures::drawing;
    use dragonfly::panels::style;
    use egui::{Color32, Theme};
    use egui_kittest::Harness;
    use image::RgbaImage;

    /// What is drawn.
    #[derive(Clone, Copy)]
    struct Card {
        word: &'static str,
        /// Distance of the button from its place, points.
        moved: f32,
        fill: Color32,
    }

    const CARD: Card = Card { word: "Save", moved: 0.0, fill: Color32::from_rgb(46, 201, 164) };

    /// Draws a card in a picture of the size of a panel, at 1x.
    fn drawn(card: Card) -> Option<RgbaImage> {
        let mut window = Harness::builder()
            .with_size([300.0, 500.0])
            .with_theme(Theme::Dark)
            .with_context_setup(style::install)
            .wgpu_setup(drawing::device()?)
            .build_ui(move |ui| {
                ui.label("A sentence above the button");
                ui.add_space(8.0 + card.moved);
                let _ = ui.add(egui::Button::new(card.word).fill(card.fill));
            });
        window.run_steps(2);
        Some(window.render().unwrap())
    }

    #[track_caller]
    fn is_noticed(changed: Card) {
        let (Some(before), Some(after)) = (drawn(CARD), drawn(changed)) else { return };
        let difference = PictureDifference::between(&after, &before, PANELS).expect("the same size");
        assert!(!difference.is_small(), "{} pixels, {} allowed", difference.pixels, difference.allowed);
    }

    #[test]
    fn a_widget_two_points_off_is_a_difference() {
        is_noticed(Card { moved: 2.0, ..CARD });
    }

    #[test]
    fn another_word_is_a_difference() {
        is_noticed(Card { word: "Safe", ..CARD });
    }

    #[test]
    fn a_color_eight_levels_off_is_a_difference() {
        is_noticed(Card { fill: Color32::from_rgb(46, 193, 164), ..CARD });
    }

    #[test]
    fn a_picture_drawn_twice_is_the_same() {
        let (Some(first), Some(second)) = (drawn(CARD), drawn(CARD)) else { return };
        let difference = PictureDifference::between(&second, &first, PANELS).expect("the same size");
        assert_eq!((difference.pixels, difference.most), (0, 0));
    }

    #[test]
    fn one_level_more_in_every_color_is_no_difference() {
        let Some(before) = drawn(CARD) else { return };
        let mut after = before.clone();
        after
            .pixels_mut()
            .for_each(|pixel| pixel.0[..3].iter_mut().for_each(|value| *value = value.saturating_add(1)));
        let difference = PictureDifference::between(&after, &before, PANELS).expect("the same size");
        assert_eq!((difference.pixels, difference.most), (0, 1));
    }
}
