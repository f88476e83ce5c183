//! The pictures of shots on their bars.

use super::sheet::SceneSheet;
use dragonfly_anim::stage::lanes::SceneBar;
use egui::{Color32, ColorImage, Painter, Rect, TextureHandle, TextureOptions, pos2, vec2};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Distance of a picture from the edges of its bar, points.
const MARGIN: f32 = 2.0;
/// Width of a bar that is too short for any picture, points.
const LEAST: f32 = 12.0;

/// The textures of the pictures that were drawn last.
#[derive(Default)]
pub(super) struct ShotTextures {
    /// By the addresses of their pictures, which they keep.
    drawn: BTreeMap<usize, ShotTexture>,
    /// Those of the frame before.
    before: BTreeMap<usize, ShotTexture>,
}

struct ShotTexture {
    image: Arc<ColorImage>,
    texture: TextureHandle,
}

impl std::fmt::Debug for ShotTextures {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "ShotTextures({})", self.drawn.len())
    }
}

impl ShotTextures {
    /// Begins a frame: textures that it does not draw are freed.
    pub(super) fn begin_frame(&mut self) {
        self.before = std::mem::take(&mut self.drawn);
    }

    /// Draws the picture of a shot at the start of its bar, as far as there is room. Returns the part of the bar that is left for its label.
    pub(super) fn show(
        &mut self,
        painter: &Painter,
        sheet: &SceneSheet<'_>,
        bar: &SceneBar,
        rect: Rect,
    ) -> Rect {
        let script = sheet.scene.script.as_ref().filter(|_| rect.width() >= LEAST);
        let thumbnails = sheet.context.scene_editing.thumbnails();
        let Some(image) = script.and_then(|script| thumbnails.of_bar(script, bar)) else { return rect };
        let key = Arc::as_ptr(image).addr();
        let before = self.before.remove(&key);
        let texture = self.drawn.entry(key).or_insert_with(|| {
            before.unwrap_or_else(|| {
                let texture = painter.ctx().load_texture("shot", Arc::clone(image), TextureOptions::LINEAR);
                ShotTexture { image: Arc::clone(image), texture }
            })
        });
        debug_assert!(Arc::ptr_eq(&texture.image, image), "a texture keeps its picture");
        let inside = rect.shrink(MARGIN);
        let [width, height] = image.size.map(|side| side.max(1) as f32);
        let place = Rect::from_min_size(inside.min, vec2(inside.height() * width / height, inside.height()));
        let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.with_clip_rect(inside.intersect(painter.clip_rect())).image(
            texture.texture.id(),
            place,
            uv,
            Color32::WHITE,
        );
        Rect::from_min_max(pos2(place.right().min(rect.right()), rect.top()), rect.max)
    }
}
