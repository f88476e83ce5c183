//! Materials: the object `Material`, and the textures in it.

use super::check as code;
use super::lexer::{XLexer, XToken};
use super::names::file_name;
use crate::data::{AlphaMode, Material, Metallic, Phong};
use crate::format::image::NeighborImages;
use crate::format::{ImportContext, ImportError, Place};
use glam::{Vec3, Vec4};
use std::collections::HashMap;

/// A material, as in the file.
pub(super) struct XMaterial {
    /// Empty where it has none.
    pub(super) name: String,
    color: Vec4,
    power: f32,
    specular: Vec3,
    emissive: Vec3,
    texture: Option<(String, Place)>,
}

/// A material of a mesh: a new one, or the name of one elsewhere in the file.
pub(super) enum MaterialUse {
    Own(XMaterial),
    Named(String, Place),
}

impl MaterialUse {
    /// Returns the name of the texture of a new material.
    pub(super) fn texture(&self) -> Option<&str> {
        match self {
            Self::Own(material) => material.texture(),
            Self::Named(..) => None,
        }
    }
}

/// Reads a material after its opening brace.
pub(super) fn material(
    lexer: &mut XLexer<'_>,
    name: String,
    context: &ImportContext<'_>,
) -> Result<XMaterial, ImportError> {
    let bytes = 4 * size_of::<XMaterial>() + 2 * size_of::<Material>() + 4 * name.len();
    context.charge(&lexer.place(lexer.at()), bytes as u64)?;
    let color = Vec4::from(lexer.floats::<4>("the color of a material")?);
    let [power] = lexer.floats("the power of a material")?;
    let specular = Vec3::from(lexer.floats::<3>("the specular color of a material")?);
    let emissive = Vec3::from(lexer.floats::<3>("the emissive color of a material")?);
    let mut texture = None;
    loop {
        context.work(1)?;
        let found = lexer.need("the end of a material")?;
        match found.token {
            XToken::Close => break,
            XToken::Word(kind) => {
                lexer.open()?;
                if kind.eq_ignore_ascii_case(b"TextureFilename") {
                    let string = lexer.string("the name of a texture")?;
                    if let XToken::Text(text) | XToken::Word(text) = string.token {
                        context.charge(&lexer.place(string.at), 4 * text.len() as u64 + 64)?;
                        texture = Some((file_name(text), lexer.place(string.at)));
                    }
                }
                lexer.close(context)?;
            }
            XToken::Open => _ = lexer.reference(context)?,
            // Numbers after those of the template.
            XToken::Number(_) | XToken::Text(_) | XToken::Other => {}
        }
    }
    Ok(XMaterial { name, color, power, specular, emissive, texture })
}

impl XMaterial {
    /// Returns the name of the texture.
    pub(super) fn texture(&self) -> Option<&str> {
        self.texture.as_ref().map(|(name, _)| name.as_str())
    }

    fn finish(&self, images: &mut NeighborImages<'_>) -> Result<Material, ImportError> {
        let texture = match &self.texture {
            Some((name, place)) if !name.is_empty() => Some(images.texture(name, place)?),
            _ => None,
        };
        let color = self.color.clamp(Vec4::ZERO, Vec4::ONE);
        // Black under a texture is how some programs write "only the texture".
        let is_black = texture.is_some() && color.truncate() == Vec3::ZERO;
        let diffuse = if is_black { Vec3::ONE } else { color.truncate() };
        let power = self.power.clamp(1.0, 1000.0);
        // As wide a highlight as that of the exponent (Beckmann, α² = 2 / (n + 2)).
        let roughness = libm::powf(2.0 / (power + 2.0), 0.25);
        Ok(Material {
            name: self.name.clone(),
            base_color: diffuse.extend(color.w),
            base_color_texture: texture,
            metallic: Metallic { metallic: 0.0, roughness },
            phong: Phong {
                ambient: diffuse * 0.2,
                diffuse,
                specular: self.specular.clamp(Vec3::ZERO, Vec3::ONE),
                specular_power: power,
            },
            use_phong: true,
            emissive: self.emissive.clamp(Vec3::ZERO, Vec3::ONE),
            alpha_mode: if color.w < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
            ..Material::default()
        })
    }
}

/// The materials of a model, while meshes are added.
pub(super) struct MaterialList<'a> {
    context: &'a ImportContext<'a>,
    images: NeighborImages<'a>,
    materials: Vec<Material>,
    /// Numbers of the materials outside of meshes, by their names.
    named: HashMap<String, u32>,
}

impl<'a> MaterialList<'a> {
    /// Returns a list with the materials outside of meshes.
    pub(super) fn new(shared: &[XMaterial], context: &'a ImportContext<'a>) -> Result<Self, ImportError> {
        let images = NeighborImages::new(context);
        let mut list = Self { context, images, materials: Vec::new(), named: HashMap::new() };
        for material in shared {
            let number = list.add(material)?;
            list.named.entry(material.name.clone()).or_insert(number);
        }
        Ok(list)
    }

    fn add(&mut self, material: &XMaterial) -> Result<u32, ImportError> {
        self.context.work(1)?;
        let finished = material.finish(&mut self.images)?;
        self.materials.push(finished);
        Ok(self.materials.len() as u32 - 1)
    }

    /// Returns the number of a material that a mesh uses.
    pub(super) fn number(&mut self, used: &MaterialUse) -> Result<Option<u32>, ImportError> {
        match used {
            MaterialUse::Own(material) => {
                let number = self.add(material)?;
                if !material.name.is_empty() {
                    self.named.entry(material.name.clone()).or_insert(number);
                }
                Ok(Some(number))
            }
            MaterialUse::Named(name, place) => {
                let number = self.named.get(name).copied();
                if number.is_none() {
                    let text = format!("there is no material \"{name}\"");
                    self.context.warn(place.clone(), code::REFERENCE_UNKNOWN, text);
                }
                Ok(number)
            }
        }
    }

    /// Returns materials and images.
    pub(super) fn finish(self) -> (Vec<Material>, Vec<crate::data::Image>) {
        (self.materials, self.images.into_images())
    }
}
