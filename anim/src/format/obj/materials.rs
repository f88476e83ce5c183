//! MTL texts: the materials of OBJ files.

use super::check as code;
use super::faces::ObjText;
use super::lines::{Statement, StatementReader, decoded, places};
use crate::data::{AlphaMode, Material, Metallic, Phong, TextureRef};
use crate::format::image::NeighborImages;
use crate::format::text::{TextScanner, TextToken};
use crate::format::uri::plain_reference;
use crate::format::{ImportContext, ImportError, Place};
use glam::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

/// Share of the diffuse light that a surface reflects of light from all directions.
pub(super) const AMBIENT: f32 = 0.2;

/// Returns the materials of a text, in the order of their first use.
pub(super) fn materials(
    bytes: &[u8],
    text: &ObjText,
    images: &mut NeighborImages<'_>,
    context: &ImportContext<'_>,
) -> Result<Vec<Material>, ImportError> {
    let places = places(bytes);
    let mut read: HashMap<String, Material> = HashMap::new();
    for library in &text.libraries {
        for (name, file) in files(&library.name, &places.place(library.at), context)? {
            parse(&name, &file, images, &mut read, context)?;
        }
    }
    let mut materials = context.vec(&Place::File, text.materials.len())?;
    for used in &text.materials {
        context.work(1)?;
        materials.push(match read.get(&used.name) {
            Some(material) => material.clone(),
            None => {
                let text = format!("no file has the material \"{}\"; it is gray", used.name);
                context.warn(places.place(used.at), code::MATERIAL_UNKNOWN, text);
                MaterialDraft::new(used.name.clone()).finish()
            }
        });
    }
    Ok(materials)
}

/// Files with their names.
type NamedFiles = Vec<(String, Arc<[u8]>)>;

/// Reads the files that a statement names: one whose name has blanks, or several.
fn files(names: &str, place: &Place, context: &ImportContext<'_>) -> Result<NamedFiles, ImportError> {
    let (mut found, mut problem) = (Vec::new(), None);
    let words: Vec<&str> = names.split_whitespace().collect();
    let whole = [names.trim()];
    for choice in [&whole[..], &words[..]] {
        for name in choice {
            context.work(1)?;
            match context.read_neighbor(&plain_reference(name), place) {
                Ok(bytes) => found.push(((*name).to_owned(), bytes)),
                Err(ImportError::External { uri, reason, .. }) => problem = problem.or(Some((uri, reason))),
                Err(other) => return Err(other),
            }
        }
        if !found.is_empty() || words.len() < 2 {
            break;
        }
    }
    if let (true, Some((uri, reason))) = (found.is_empty(), problem) {
        let text = format!("\"{uri}\": {reason}; its materials are gray");
        context.warn(place.clone(), code::MATERIALS_MISSING, text);
    }
    Ok(found)
}

/// Reads a file of materials.
fn parse(
    name: &str,
    bytes: &[u8],
    images: &mut NeighborImages<'_>,
    read: &mut HashMap<String, Material>,
    context: &ImportContext<'_>,
) -> Result<(), ImportError> {
    let bytes = decoded(bytes, context)?;
    let places = places(&bytes);
    let mut reader = StatementReader::new(&bytes);
    let mut draft: Option<MaterialDraft> = None;
    let mut faults = 0;
    while let Some(statement) = reader.next(context, &places)? {
        context.work(1 + statement.values.len())?;
        if statement.keyword.is("newmtl") {
            let bytes = 2 * size_of::<Material>() + 4 * statement.name().len();
            context.charge(&Place::File, bytes as u64)?;
            let next = MaterialDraft::new(statement.name());
            keep(draft.replace(next), read);
        } else if let Some(draft) = &mut draft {
            let fault = draft.read(&statement, &places, images)?;
            if fault.is_some() && faults < MOST_FAULTS {
                faults += 1;
                let text = format!("{}: {}", name, fault.unwrap_or_default());
                context.warn(places.place(statement.keyword.at), code::MATERIAL_VALUE_IGNORED, text);
            }
        }
    }
    keep(draft, read);
    Ok(())
}

/// Largest number of warnings about values of one file of materials.
const MOST_FAULTS: usize = 20;

/// Adds a material; of several with one name the first stays.
fn keep(draft: Option<MaterialDraft>, read: &mut HashMap<String, Material>) {
    if let Some(draft) = draft {
        read.entry(draft.name.clone()).or_insert_with(|| draft.finish());
    }
}

/// The values of a material, where the file has them.
struct MaterialDraft {
    name: String,
    ambient: Option<Vec3>,
    diffuse: Vec3,
    specular: Vec3,
    power: f32,
    emissive: Vec3,
    alpha: f32,
    roughness: Option<f32>,
    metallic: Option<f32>,
    base_texture: Option<TextureRef>,
    emissive_texture: Option<TextureRef>,
    normal_texture: Option<TextureRef>,
    normal_scale: f32,
}

impl MaterialDraft {
    fn new(name: String) -> Self {
        Self {
            name,
            ambient: None,
            diffuse: Vec3::splat(0.8),
            specular: Vec3::ZERO,
            power: 16.0,
            emissive: Vec3::ZERO,
            alpha: 1.0,
            roughness: None,
            metallic: None,
            base_texture: None,
            emissive_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
        }
    }

    /// Reads a statement. Returns why it is ignored, if it is and matters.
    fn read(
        &mut self,
        statement: &Statement<'_, '_>,
        places: &TextScanner<'_>,
        images: &mut NeighborImages<'_>,
    ) -> Result<Option<String>, ImportError> {
        let keyword = String::from_utf8_lossy(statement.keyword.text).to_ascii_lowercase();
        let value = match keyword.as_str() {
            "ka" => color(statement, places).map(|color| self.ambient = Some(color)),
            "kd" => color(statement, places).map(|color| self.diffuse = color),
            "ks" => color(statement, places).map(|color| self.specular = color),
            "ke" => color(statement, places).map(|color| self.emissive = color),
            "ns" => number(statement, 0, places).map(|power| self.power = power.clamp(1.0, 1000.0)),
            "d" => number(statement, 0, places).map(|alpha| self.alpha = alpha.clamp(0.0, 1.0)),
            "tr" => number(statement, 0, places).map(|clear| self.alpha = 1.0 - clear.clamp(0.0, 1.0)),
            "pr" => number(statement, 0, places).map(|number| self.roughness = Some(number.clamp(0.0, 1.0))),
            "pm" => number(statement, 0, places).map(|number| self.metallic = Some(number.clamp(0.0, 1.0))),
            "map_kd" | "map_ke" | "map_bump" | "bump" | "norm" => {
                let (name, scale) = texture_name(statement, places);
                if name.is_empty() {
                    return Ok(Some(format!("{keyword} names no file")));
                }
                let texture = Some(images.texture(&name, &places.place(statement.keyword.at))?);
                match keyword.as_str() {
                    "map_kd" => self.base_texture = texture,
                    "map_ke" => self.emissive_texture = texture,
                    _ => (self.normal_texture, self.normal_scale) = (texture, scale),
                }
                Some(())
            }
            "map_d" | "map_pr" | "map_pm" | "map_ks" | "map_ns" => {
                return Ok(Some(format!("the texture {keyword} is not shown")));
            }
            _ => Some(()),
        };
        Ok(value.is_none().then(|| format!("the values of {keyword} are not numbers in range")))
    }

    fn finish(self) -> Material {
        // Black under a texture is how some programs write "only the texture".
        let diffuse =
            if self.base_texture.is_some() && self.diffuse == Vec3::ZERO { Vec3::ONE } else { self.diffuse };
        // Ka is the color in light from all sides, white in many files that mean that of Kd; the light here is weaker.
        let ambient = self.ambient.map_or(diffuse, |ambient| ambient.min(diffuse)) * AMBIENT;
        // As wide a highlight as that of the exponent (Beckmann, α² = 2 / (n + 2)).
        let roughness = self.roughness.unwrap_or_else(|| libm::powf(2.0 / (self.power + 2.0), 0.25));
        let is_physical = self.roughness.is_some() || self.metallic.is_some();
        Material {
            name: self.name,
            base_color: diffuse.extend(self.alpha),
            base_color_texture: self.base_texture,
            metallic: Metallic { metallic: self.metallic.unwrap_or(0.0), roughness },
            phong: Phong { ambient, diffuse, specular: self.specular, specular_power: self.power },
            use_phong: !is_physical,
            normal_texture: self.normal_texture,
            normal_scale: self.normal_scale,
            emissive: self.emissive,
            emissive_texture: self.emissive_texture,
            alpha_mode: if self.alpha < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
            // The sense of polygons is not reliable in files of this format.
            double_sided: true,
            ..Material::default()
        }
    }
}

/// Returns the number of a value; `None` if it is missing or no finite number.
fn number(statement: &Statement<'_, '_>, index: usize, places: &TextScanner<'_>) -> Option<f32> {
    places.float_of(*statement.values.get(index)?, "a value").ok()
}

/// Returns a color; one number is gray.
fn color(statement: &Statement<'_, '_>, places: &TextScanner<'_>) -> Option<Vec3> {
    let red = number(statement, 0, places)?;
    let other = |index: usize| match statement.values.get(index) {
        Some(_) => number(statement, index, places),
        None => Some(red),
    };
    Some(Vec3::new(red, other(1)?, other(2)?).clamp(Vec3::ZERO, Vec3::ONE))
}

/// Returns the name of a texture after its options, and the strength in the option `-bm`.
fn texture_name(statement: &Statement<'_, '_>, places: &TextScanner<'_>) -> (String, f32) {
    let (mut first, mut scale) = (0, 1.0);
    while let Some(option) = statement.values.get(first) {
        let most = match option.text {
            b"-bm" | b"-boost" | b"-texres" | b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-imfchan"
            | b"-type" | b"-colorspace" => 1,
            b"-mm" => 2,
            b"-o" | b"-s" | b"-t" => 3,
            _ => break,
        };
        if option.text == b"-bm" {
            scale = number(statement, first + 1, places).unwrap_or(1.0);
        }
        let is_number = |value: &&TextToken<'_>| places.number_of(**value, "").is_ok();
        let values = statement.values[first + 1..].iter().take(most);
        // Vectors may be shorter.
        first += 1 + if most == 1 { 1 } else { values.take_while(is_number).count() };
    }
    (statement.name_from(first), scale)
}
