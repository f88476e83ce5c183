//! Materials: the thesis's lighting and texture, then everything else about a surface.

use super::code::DFM_INDEX;
use super::part::DfmPart;
use super::reader::DfmReader;
use super::record::{DfmRecord, NONE, Put, RecordFields, choice, number_of, only_bits};
use super::writer::DfmWriter;
use crate::data::{
    AlphaMode, Filter, Material, Metallic, ModelData, Phong, TextureRef, TextureTransform, Wrap,
};
use crate::format::ImportError;

const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge];
const FILTERS: [Filter; 2] = [Filter::Nearest, Filter::Linear];

/// The five textures of a material.
type Textures = [Option<TextureRef>; 5];

/// A material without its name.
pub(super) struct MaterialRecord(Material);

impl DfmRecord for MaterialRecord {
    const SIZE: usize = 280;

    fn put(&self, out: &mut Vec<u8>) {
        let material = &self.0;
        let phong = &material.phong;
        for color in [phong.diffuse, phong.ambient, phong.specular] {
            out.floats(&color.to_array());
        }
        out.floats(&[phong.specular_power]);
        out.u32(material.base_color_texture.map_or(NONE, |texture| texture.image));
        out.floats(&material.base_color.to_array());
        out.floats(&[material.metallic.metallic, material.metallic.roughness]);
        out.floats(&material.emissive.to_array());
        out.floats(&[material.normal_scale, material.occlusion_strength]);
        let (mode, cutoff) = match material.alpha_mode {
            AlphaMode::Opaque => (0, 0.0),
            AlphaMode::Mask(cutoff) => (1, cutoff),
            AlphaMode::Blend => (2, 0.0),
        };
        out.u32(mode);
        out.floats(&[cutoff]);
        let flags = [(material.use_phong, 1), (material.double_sided, 2), (material.unlit, 4)];
        out.u32(flags.iter().filter(|(set, _)| *set).map(|(_, bit)| bit).sum());
        for texture in textures(material) {
            put_texture(texture, out);
        }
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let (diffuse, ambient, specular) = (fields.vec3(), fields.vec3(), fields.vec3());
        let phong = Phong { ambient, diffuse, specular, specular_power: fields.f32() };
        let image = fields.u32();
        let base_color = fields.vec4();
        let metallic = Metallic { metallic: fields.f32(), roughness: fields.f32() };
        let emissive = fields.vec3();
        let (normal_scale, occlusion_strength) = (fields.f32(), fields.f32());
        let (mode, cutoff) = (fields.u32(), fields.f32());
        let alpha_mode = match mode {
            0 => AlphaMode::Opaque,
            1 => AlphaMode::Mask(cutoff),
            2 => AlphaMode::Blend,
            other => return Err(format!("alpha mode {other} is not below 3")),
        };
        let flags = only_bits(fields.u32(), 7)?;
        let mut textures: Textures = [None; 5];
        for texture in &mut textures {
            *texture = get_texture(fields)?;
        }
        let [
            base_color_texture,
            metallic_roughness_texture,
            normal_texture,
            occlusion_texture,
            emissive_texture,
        ] = textures;
        if image != base_color_texture.map_or(NONE, |texture| texture.image) {
            return Err("the texture is not that of the base color".to_owned());
        }
        Ok(Self(Material {
            name: String::new(),
            base_color,
            base_color_texture,
            metallic,
            metallic_roughness_texture,
            phong,
            use_phong: flags & 1 != 0,
            normal_texture,
            normal_scale,
            occlusion_texture,
            occlusion_strength,
            emissive,
            emissive_texture,
            alpha_mode,
            double_sided: flags & 2 != 0,
            unlit: flags & 4 != 0,
        }))
    }
}

fn textures(material: &Material) -> Textures {
    [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.normal_texture,
        material.occlusion_texture,
        material.emissive_texture,
    ]
}

fn put_texture(texture: Option<TextureRef>, out: &mut Vec<u8>) {
    let Some(texture) = texture else {
        out.u32(NONE);
        out.extend_from_slice(&[0; 32]);
        return;
    };
    out.u32(texture.image);
    out.u32(texture.set);
    let [along, across] = texture.wrap.map(|wrap| number_of(&WRAPS, &wrap));
    let [magnify, minify] = [texture.magnify, texture.minify].map(|filter| number_of(&FILTERS, &filter));
    out.extend_from_slice(&[along, across, magnify, minify]);
    out.u32(texture.mip.into());
    let transform = texture.transform;
    out.floats(&transform.offset.to_array());
    out.floats(&[transform.rotation]);
    out.floats(&transform.scale.to_array());
}

fn get_texture(fields: &mut RecordFields<'_>) -> Result<Option<TextureRef>, String> {
    let (image, set) = (fields.u32(), fields.u32());
    let [along, across, magnify, minify] = fields.take();
    let mip = fields.u32();
    let transform = TextureTransform { offset: fields.vec2(), rotation: fields.f32(), scale: fields.vec2() };
    if image == NONE {
        return Ok(None);
    }
    if set > 1 || mip > 1 {
        return Err(format!("texture coordinates {set} and mip levels {mip} must be 0 or 1"));
    }
    Ok(Some(TextureRef {
        image,
        set,
        wrap: [choice(&WRAPS, along, "wrap")?, choice(&WRAPS, across, "wrap")?],
        magnify: choice(&FILTERS, magnify, "filter")?,
        minify: choice(&FILTERS, minify, "filter")?,
        mip: mip == 1,
        transform,
    }))
}

/// Writes every material of `model`.
pub(super) fn write(model: &ModelData, writer: &mut DfmWriter) {
    for material in &model.materials {
        writer.text(&material.name);
        writer.put(DfmPart::Materials, &MaterialRecord(Material { name: String::new(), ..material.clone() }));
    }
}

/// Reads every material.
pub(super) fn read(reader: &mut DfmReader<'_, '_>) -> Result<Vec<Material>, ImportError> {
    let images = reader.count(DfmPart::Images);
    let mut materials = reader.vec(DfmPart::Materials, 0, reader.count(DfmPart::Materials))?;
    for _ in 0..materials.capacity() {
        let name = reader.text()?;
        let MaterialRecord(material) = reader.get(DfmPart::Materials)?;
        if let Some(texture) =
            textures(&material).into_iter().flatten().find(|texture| texture.image as usize >= images)
        {
            return Err(reader.wrong(DFM_INDEX, format!("there is no image {}", texture.image)));
        }
        materials.push(Material { name, ..material });
    }
    Ok(materials)
}
