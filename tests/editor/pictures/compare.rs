//! How much two pictures may differ.
//!
//! Drivers round colors differently and place the soft edges of lines and letters up to a few levels apart. A pixel that
//! differs by no more than [`LEVELS`] in each channel is the same; of the others a picture may have a few.

use image::{Rgba, RgbaImage};

/// Largest difference of a channel between pixels that count as the same.
pub(super) const LEVELS: u8 = 6;

/// Number of pixels that may differ in any picture, and in addition one of so many.
const SOME: usize = 6;
const ONE_OF: usize = 20_000;

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
    pub(super) fn between(new: &RgbaImage, stored: &RgbaImage) -> Option<Self> {
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
        Some(Self { pixels, allowed: SOME + stored.pixels().len() / ONE_OF, most, shown })
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
