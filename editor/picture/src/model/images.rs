//! The textures of a model: decoded one at a time on the way to the device, a few with every frame.

use super::image_plan::{PlannedImage, plan};
use super::texture::TextureMaker;
use crate::gpu::Gpu;
use dragonfly_document::{DecodedImage, LoadedModel};
use std::collections::HashMap;

/// The textures of the images that the materials of a model use. It keeps no pixels: after a loss of the device, the images are
/// decoded again.
pub(super) struct ModelImages {
    /// Images that are not uploaded yet; the next one is the last.
    waiting: Vec<PlannedImage>,
    views: HashMap<(u32, bool), wgpu::TextureView>,
    /// The texture of materials without a texture.
    white: Option<wgpu::TextureView>,
}

impl ModelImages {
    /// Plans the textures of `loaded`. Returns also a warning if images will be shown smaller.
    pub(super) fn new(gpu: &Gpu, maker: &mut TextureMaker, loaded: &LoadedModel) -> (Self, Option<String>) {
        let white = DecodedImage { width: 1, height: 1, pixels: vec![255; 4] };
        let white = maker.texture(gpu, &white, false);
        let (mut waiting, warning) = plan(gpu, loaded);
        waiting.reverse();
        (Self { waiting, views: HashMap::new(), white }, warning)
    }

    /// Returns whether images wait to be uploaded.
    pub(super) fn is_loading(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Decodes and uploads the next images, as far as the budget goes. Returns a warning for each that cannot be decoded.
    pub(super) fn upload(
        &mut self,
        gpu: &Gpu,
        maker: &mut TextureMaker,
        loaded: &LoadedModel,
        budget: &mut PixelBudget,
    ) -> Vec<String> {
        let mut warnings = Vec::new();
        while let Some(image) = self.waiting.pop_if(|next| budget.takes(next.pixels())) {
            match loaded.images.decode(&loaded.model.images, image.index, image.halvings) {
                Ok(decoded) => {
                    for encoded in
                        [false, true].into_iter().filter(|&encoded| image.encodings[usize::from(encoded)])
                    {
                        let view = maker.texture(gpu, &decoded, encoded);
                        self.views.extend(view.map(|view| ((image.index, encoded), view)));
                    }
                }
                Err(warning) => warnings.push(warning),
            }
        }
        warnings
    }

    /// Returns the texture of image number `index` of `loaded`; `None` while it waits, and if it cannot be shown.
    pub(super) fn view(&self, loaded: &LoadedModel, index: u32, encoded: bool) -> Option<&wgpu::TextureView> {
        self.views.get(&(loaded.images.get(index)?.source(), encoded))
    }

    /// Returns the texture of materials without a texture; `None` only for a lost device.
    pub(super) fn white(&self) -> Option<&wgpu::TextureView> {
        self.white.as_ref()
    }
}

/// The number of pixels that are decoded in one frame.
pub(super) struct PixelBudget {
    left: u64,
    is_used: bool,
}

impl PixelBudget {
    pub(super) fn new(pixels: u64) -> Self {
        Self { left: pixels, is_used: false }
    }

    /// Takes the pixels of an image, if they are left; the first image always fits.
    fn takes(&mut self, pixels: u64) -> bool {
        let fits = !self.is_used || pixels <= self.left;
        if fits {
            (self.left, self.is_used) = (self.left.saturating_sub(pixels), true);
        }
        fits
    }
}
