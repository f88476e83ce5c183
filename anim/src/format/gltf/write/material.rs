//! Materials, textures and images of a written file.

use super::bytes::ViewTarget;
use super::{GltfWriter, named, number, numbers};
use crate::data::{AlphaMode, Filter, Image, Material, TextureRef, TextureTransform, Wrap};
use crate::format::ImageKind;
use glam::Vec4;
use serde_json::{Map, Value, json};

/// The materials of a written file, and what they use.
#[derive(Default)]
pub(super) struct WrittenMaterials {
    pub(super) materials: Vec<Value>,
    pub(super) textures: Vec<Value>,
    pub(super) samplers: Vec<Value>,
    pub(super) images: Vec<Value>,
}

impl WrittenMaterials {
    /// Returns the position of `value` in a list, and adds it where it is not there.
    fn position(list: &mut Vec<Value>, value: Value) -> usize {
        list.iter().position(|other| *other == value).unwrap_or_else(|| {
            list.push(value);
            list.len() - 1
        })
    }
}

impl GltfWriter<'_> {
    /// Writes all materials with their images.
    pub(super) fn materials(&mut self) -> WrittenMaterials {
        let model = self.model;
        let mut written = WrittenMaterials::default();
        let mut images = Vec::with_capacity(model.images.len());
        for (index, image) in model.images.iter().enumerate() {
            images.push(self.image(index, image).map(|value| {
                written.images.push(value);
                written.images.len() - 1
            }));
        }
        for (index, material) in model.materials.iter().enumerate() {
            if material.use_phong {
                let text = "Phong values are not in glTF; base color, metallic and roughness are written";
                self.lose(format!("/materials/{index}/phong"), text);
            }
            let value = self.material(material, &images, &mut written);
            written.materials.push(value);
        }
        written
    }

    /// Returns the image with its bytes in the buffer; `None` for one that glTF does not allow.
    fn image(&mut self, index: usize, image: &Image) -> Option<Value> {
        let mut written = Map::new();
        named(&mut written, &image.name);
        if image.bytes.is_empty() {
            self.lose(format!("/images/{index}"), "an image that could not be read is left out");
            return None;
        }
        if ImageKind::of(&image.mime).is_none() {
            let kind = if image.mime.is_empty() { "of an unknown kind" } else { &image.mime };
            self.lose(
                format!("/images/{index}"),
                format!("the image is {kind}; glTF allows PNG, JPEG, WebP and KTX 2, so it is left out"),
            );
            return None;
        }
        let view = self.binary.view(&image.bytes, ViewTarget::None, None);
        written.insert("bufferView".to_owned(), json!(view));
        written.insert("mimeType".to_owned(), json!(image.mime));
        Some(Value::Object(written))
    }

    fn material(
        &mut self,
        material: &Material,
        images: &[Option<usize>],
        written: &mut WrittenMaterials,
    ) -> Value {
        let mut value = Map::new();
        named(&mut value, &material.name);
        let mut pbr = Map::new();
        if material.base_color != Vec4::ONE {
            pbr.insert("baseColorFactor".to_owned(), numbers(material.base_color.to_array()));
        }
        for (name, factor) in
            [("metallicFactor", material.metallic.metallic), ("roughnessFactor", material.metallic.roughness)]
        {
            if factor != 1.0 {
                pbr.insert(name.to_owned(), number(factor));
            }
        }
        let mut texture = |use_: &Option<TextureRef>| self.texture(use_.as_ref()?, images, written);
        let insert = |object: &mut Map<String, Value>, name: &str, info: Option<Map<String, Value>>| {
            info.map(|info| object.insert(name.to_owned(), Value::Object(info)))
        };
        insert(&mut pbr, "baseColorTexture", texture(&material.base_color_texture));
        insert(&mut pbr, "metallicRoughnessTexture", texture(&material.metallic_roughness_texture));
        let with = |info: Option<Map<String, Value>>, name: &str, factor: f32| {
            info.map(|mut info| {
                if factor != 1.0 {
                    info.insert(name.to_owned(), number(factor));
                }
                info
            })
        };
        let normal = with(texture(&material.normal_texture), "scale", material.normal_scale);
        insert(&mut value, "normalTexture", normal);
        let occlusion = with(texture(&material.occlusion_texture), "strength", material.occlusion_strength);
        insert(&mut value, "occlusionTexture", occlusion);
        insert(&mut value, "emissiveTexture", texture(&material.emissive_texture));
        if !pbr.is_empty() {
            value.insert("pbrMetallicRoughness".to_owned(), Value::Object(pbr));
        }
        let mut extensions = Map::new();
        let strength = material.emissive.max_element().max(1.0);
        if material.emissive.max_element() > 0.0 {
            let factor = (material.emissive / strength).to_array().map(|part| part.clamp(0.0, 1.0));
            value.insert("emissiveFactor".to_owned(), numbers(factor));
        }
        if strength > 1.0 {
            let strength = json!({"emissiveStrength": number(strength)});
            extensions.insert(self.extension("KHR_materials_emissive_strength"), strength);
        }
        if material.unlit {
            extensions.insert(self.extension("KHR_materials_unlit"), json!({}));
        }
        match material.alpha_mode {
            AlphaMode::Opaque => {}
            AlphaMode::Mask(cutoff) => {
                value.insert("alphaMode".to_owned(), json!("MASK"));
                value.insert("alphaCutoff".to_owned(), number(cutoff));
            }
            AlphaMode::Blend => drop(value.insert("alphaMode".to_owned(), json!("BLEND"))),
        }
        if material.double_sided {
            value.insert("doubleSided".to_owned(), json!(true));
        }
        if !extensions.is_empty() {
            value.insert("extensions".to_owned(), Value::Object(extensions));
        }
        Value::Object(value)
    }

    /// Returns the members of a use of a texture; `None` where its image is not in the file.
    fn texture(
        &mut self,
        texture: &TextureRef,
        images: &[Option<usize>],
        written: &mut WrittenMaterials,
    ) -> Option<Map<String, Value>> {
        let source = images.get(texture.image as usize).copied().flatten()?;
        let sampler = WrittenMaterials::position(&mut written.samplers, sampler(texture));
        let image = self.model.images.get(texture.image as usize);
        let entry = match image.and_then(|image| ImageKind::of(&image.mime)?.gltf_extension) {
            Some(extension) => {
                self.extensions.insert(extension);
                json!({"sampler": sampler, "extensions": {extension: {"source": source}}})
            }
            None => json!({"sampler": sampler, "source": source}),
        };
        let index = WrittenMaterials::position(&mut written.textures, entry);
        let mut info = Map::new();
        info.insert("index".to_owned(), json!(index));
        if texture.set != 0 {
            info.insert("texCoord".to_owned(), json!(texture.set));
        }
        if texture.transform != TextureTransform::IDENTITY {
            let transform = texture.transform;
            let value = json!({
                "offset": numbers(transform.offset.to_array()),
                "rotation": number(transform.rotation),
                "scale": numbers(transform.scale.to_array()),
            });
            let name = self.extension("KHR_texture_transform");
            info.insert("extensions".to_owned(), json!({name: value}));
        }
        Some(info)
    }

    /// Lists an extension as used and returns its name.
    fn extension(&mut self, name: &'static str) -> String {
        self.extensions.insert(name);
        name.to_owned()
    }
}

/// Returns filters and wrapping with the numbers of OpenGL, as glTF has them.
fn sampler(texture: &TextureRef) -> Value {
    let minify = match (texture.minify, texture.mip) {
        (Filter::Nearest, false) => 9728,
        (Filter::Linear, false) => 9729,
        (Filter::Nearest, true) => 9986,
        (Filter::Linear, true) => 9987,
    };
    let magnify = match texture.magnify {
        Filter::Nearest => 9728,
        Filter::Linear => 9729,
    };
    let [wrap_s, wrap_t] = texture.wrap.map(|wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::MirroredRepeat => 33648,
        Wrap::ClampToEdge => 33071,
    });
    json!({"magFilter": magnify, "minFilter": minify, "wrapS": wrap_s, "wrapT": wrap_t})
}
