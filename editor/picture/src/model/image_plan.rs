//! Decides which images of a model become textures, and at which size, so that the textures fit into the memory for them.

use crate::gpu::Gpu;
use dragonfly_anim::data::{Material, TextureRef};
use dragonfly_document::LoadedModel;
use dragonfly_document::images::{SurveyedImage, label};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Bytes of a texture below which it is not made smaller.
const SMALLEST: u64 = 64 << 10;
/// Largest number of images that a warning names.
const NAMED: usize = 8;

/// An image to upload.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PlannedImage {
    /// Index of the image in the model.
    pub(super) index: u32,
    /// Number of times that its width and height are halved.
    pub(super) halvings: u32,
    /// Whether it is read as values, and as sRGB colors.
    pub(super) encodings: [bool; 2],
    /// Size in the file, pixels.
    size: [u32; 2],
    /// Memory for decoding it, bytes.
    decoding: u64,
}

impl PlannedImage {
    /// Returns the number of pixels that have to be decoded.
    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Returns the bytes of its textures with all mip levels.
    fn bytes(&self) -> u64 {
        let mut size = self.size.map(|side| (side >> self.halvings).max(1));
        let mut bytes = 0;
        loop {
            bytes += 4 * u64::from(size[0]) * u64::from(size[1]);
            if size == [1, 1] {
                return bytes * self.encodings.iter().filter(|is_read| **is_read).count() as u64;
            }
            size = size.map(|side| (side / 2).max(1));
        }
    }
}

/// Returns the images that the materials of `loaded` use, those that need the most memory for decoding first, and a
/// warning if some of them are shown smaller.
pub(super) fn plan(gpu: &Gpu, loaded: &LoadedModel) -> (Vec<PlannedImage>, Option<String>) {
    let memory = loaded.images.memory();
    let mut used: BTreeMap<u32, PlannedImage> = BTreeMap::new();
    for (use_of, encoded) in loaded.model.materials.iter().flat_map(textures) {
        let image = use_of.and_then(|use_of| loaded.images.get(use_of.image));
        if let Some(image) = image {
            let first = || first_plan(image, gpu.max_side, memory);
            used.entry(image.source()).or_insert_with(first).encodings[usize::from(encoded)] = true;
        }
    }
    let mut images: Vec<PlannedImage> = used.into_values().collect();
    let decoding = images.iter().map(|image| image.decoding).max().unwrap_or(0);
    let room = gpu.texture_memory.room(memory, decoding);
    let needed = shrink(&mut images, room);
    let warning = warning(loaded, &images, needed, room);
    images.sort_by_key(|image| Reverse(image.decoding));
    (images, warning)
}

/// Returns the five textures of a material, in the order of their bindings, and whether each has sRGB colors.
pub(super) fn textures(material: &Material) -> [(Option<&TextureRef>, bool); 5] {
    [
        (material.base_color_texture.as_ref(), true),
        (material.metallic_roughness_texture.as_ref(), false),
        (material.normal_texture.as_ref(), false),
        (material.occlusion_texture.as_ref(), false),
        (material.emissive_texture.as_ref(), true),
    ]
}

/// Returns an image as large as the device can show and as `memory` bytes are enough to decode.
fn first_plan(image: &SurveyedImage, max_side: u32, memory: u64) -> PlannedImage {
    let size = image.size();
    let is_too_large =
        |halvings: &u32| size[0].max(size[1]) >> halvings > max_side || image.peak(*halvings) > memory;
    let halvings = (0..31).find(|halvings| !is_too_large(halvings)).unwrap_or(31);
    let decoding = image.peak(halvings);
    PlannedImage { index: image.source(), halvings, encodings: [false; 2], size, decoding }
}

/// Halves the largest of `images` until all textures need at most `room` bytes, or all are small. Returns the bytes that
/// they needed before.
fn shrink(images: &mut [PlannedImage], room: u64) -> u64 {
    // Of equal images, the first one.
    let entry = |at: usize, image: &PlannedImage| (image.bytes(), Reverse(at));
    let mut largest: BinaryHeap<_> = images.iter().enumerate().map(|(at, image)| entry(at, image)).collect();
    let needed = largest.iter().map(|(bytes, _)| bytes).sum();
    let mut total: u64 = needed;
    while total > room
        && let Some((bytes, Reverse(at))) = largest.pop()
        && bytes > SMALLEST
    {
        let image = &mut images[at];
        image.halvings += 1;
        total = total - bytes + image.bytes();
        largest.push(entry(at, image));
    }
    needed
}

/// Returns a sentence about the images that are shown smaller than they are; `None` where there is none.
fn warning(loaded: &LoadedModel, images: &[PlannedImage], needed: u64, room: u64) -> Option<String> {
    let mut smaller: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for image in images.iter().filter(|image| image.halvings > 0) {
        smaller.entry(image.halvings).or_default().push(image.index);
    }
    let mega = |bytes: u64| bytes.div_ceil(1 << 20);
    let reason = if needed > room {
        format!("together they need {} MB of memory, {} are left for them", mega(needed), mega(room))
    } else {
        "they are too large for the memory of a file of this size, or for the graphics device".to_owned()
    };
    let at_size = |(halvings, images): (&u32, &Vec<u32>)| {
        let size = match halvings {
            1 => "half size".to_owned(),
            2 => "a quarter of their size".to_owned(),
            more => format!("1/{} of their size", 1_u64 << more),
        };
        let names: Vec<String> =
            images.iter().take(NAMED).map(|&image| label(&loaded.model.images, image)).collect();
        let more = match images.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("at {size}: {}{more}", names.join(", "))
    };
    let sizes: Vec<String> = smaller.iter().map(at_size).collect();
    (!sizes.is_empty()).then(|| format!("Images are shown {}; {reason}", sizes.join("; ")))
}
