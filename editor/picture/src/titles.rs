//! The titles of a scene, drawn over an image that is finished.

use super::cast::PosedScene;
use egui::epaint::text::{Fonts, TextOptions, ViewportKey};
use egui::{Color32, ColorImage, FontDefinitions, FontId, Galley};
use image::{Rgba, RgbaImage};

/// Height of a line as a part of the height of the image.
const LINE: f32 = 0.07;
/// Distance of the shadow of a text as a part of the height of its lines.
const SHADOW: f32 = 0.05;

/// How titles look in an image, in the unit of its height: the same in movies and in a viewport.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TitleLook {
    /// Height of the font.
    pub size: f32,
    /// Distance of the shadow to the right and below.
    pub shadow: f32,
    /// Opacity of the shadow of a title that is not faded.
    pub shadow_opacity: f32,
}

impl TitleLook {
    /// Returns the look in an image of this height.
    pub fn of(height: f32) -> Self {
        let size = (LINE * height).max(6.0);
        Self { size, shadow: (SHADOW * size).max(1.0), shadow_opacity: 0.6 }
    }

    /// Returns the fonts of titles, the first one first.
    pub fn fonts() -> FontDefinitions {
        FontDefinitions::default()
    }
}

/// Smallest and largest side of the image in which the shapes of letters are kept, pixels.
const LEAST_SIDE: u32 = 2048;
const MOST_SIDE: u32 = 16384;

/// Draws titles with the font of the program's user interface library.
pub(super) struct TitleDrawer {
    fonts: Fonts,
}

impl Default for TitleDrawer {
    fn default() -> Self {
        Self { fonts: Fonts::new(TextOptions::default(), TitleLook::fonts()) }
    }
}

impl TitleDrawer {
    /// Draws the titles that `cast` shows at its time: white, with a soft shadow, around their positions.
    pub(super) fn draw(&mut self, cast: &PosedScene, picture: &mut RgbaImage) {
        let (width, height) = (picture.width() as f32, picture.height() as f32);
        let look = TitleLook::of(height);
        for shown in &cast.state().titles {
            let Some(title) = cast.plan().titles().get(shown.title) else { continue };
            // If earlier letters have filled their image, it begins again.
            self.fonts.begin_pass(options(picture), ViewportKey::default());
            let mut view = self.fonts.with_pixels_per_point(1.0);
            let galley =
                view.layout_no_wrap(title.text.to_string(), FontId::proportional(look.size), Color32::WHITE);
            let atlas = view.image();
            let [x, y] = [title.at[0] * width, title.at[1] * height];
            let corner = [x - galley.size().x / 2.0, y - galley.size().y / 2.0];
            let shadow = corner.map(|side| side + look.shadow);
            draw_text(picture, &galley, &atlas, shadow, ([0; 3], look.shadow_opacity * shown.weight));
            draw_text(picture, &galley, &atlas, corner, ([255; 3], shown.weight));
        }
    }
}

/// Returns how letters are kept for an image: as large as they are drawn, each at whole pixels.
fn options(picture: &RgbaImage) -> TextOptions {
    let side = picture.width().max(picture.height()).clamp(LEAST_SIDE, MOST_SIDE) as usize;
    TextOptions { max_texture_side: side, subpixel_binning: false, ..TextOptions::default() }
}

/// Draws a text in a color with this opacity.
fn draw_text(
    picture: &mut RgbaImage,
    galley: &Galley,
    atlas: &ColorImage,
    [left, top]: [f32; 2],
    (color, opacity): ([u8; 3], f32),
) {
    for row in &galley.rows {
        for glyph in &row.row.glyphs {
            let part = glyph.uv_rect;
            let x = (left + row.pos.x + glyph.pos.x + part.offset.x).round() as i64;
            let y = (top + row.pos.y + glyph.pos.y + part.offset.y).round() as i64;
            for v in part.min[1]..part.max[1] {
                for u in part.min[0]..part.max[0] {
                    let at = usize::from(v) * atlas.width() + usize::from(u);
                    let coverage = atlas.pixels.get(at).map_or(0, |texel| texel.a());
                    let place = [x + i64::from(u - part.min[0]), y + i64::from(v - part.min[1])];
                    let [Ok(x), Ok(y)] = place.map(u32::try_from) else { continue };
                    if let Some(pixel) = picture.get_pixel_mut_checked(x, y) {
                        blend(pixel, color, opacity * f32::from(coverage) / 255.0);
                    }
                }
            }
        }
    }
}

/// Mixes a color into a pixel, whose alpha is straight.
fn blend(pixel: &mut Rgba<u8>, color: [u8; 3], opacity: f32) {
    let under = f32::from(pixel[3]) / 255.0 * (1.0 - opacity);
    let whole = opacity + under;
    if whole <= 0.0 {
        return;
    }
    for (value, new) in pixel.0.iter_mut().zip(color) {
        *value = ((f32::from(new) * opacity + f32::from(*value) * under) / whole).round() as u8;
    }
    pixel[3] = (whole * 255.0).round() as u8;
}
