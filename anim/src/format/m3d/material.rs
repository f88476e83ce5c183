//! Materials: what each dialect stores of a surface.

use super::dialect::M3dDialect;
use super::scan::{M3dScanner, is_number};
use crate::data::{AlphaMode, Material, Metallic, Phong};
use crate::format::image::NeighborImages;
use crate::format::{ImportContext, ImportError};
use glam::Vec3;
use std::ops::Range;

/// Alpha below which the programs of the books draw nothing, where alpha is tested.
pub(super) const CLIP: f32 = 0.1;

/// A material of a file: its values, and the places of the names of its textures.
pub(super) struct M3dMaterial {
    material: Material,
    diffuse_map: Range<usize>,
    normal_map: Range<usize>,
}

impl M3dMaterial {
    /// Returns the names of its textures.
    pub(super) fn textures(&self, bytes: &[u8]) -> impl Iterator<Item = String> {
        [&self.diffuse_map, &self.normal_map].into_iter().filter_map(|range| texture(bytes, range))
    }

    /// Returns the material with its textures.
    pub(super) fn finish(
        self,
        bytes: &[u8],
        scanner: &M3dScanner<'_>,
        images: &mut NeighborImages<'_>,
    ) -> Result<Material, ImportError> {
        let Self { mut material, diffuse_map, normal_map } = self;
        for (range, slot) in
            [(diffuse_map, &mut material.base_color_texture), (normal_map, &mut material.normal_texture)]
        {
            if let Some(name) = texture(bytes, &range) {
                *slot = Some(images.texture(&name, &scanner.place(range.start))?);
            }
        }
        Ok(material)
    }
}

/// Reads `count` materials of the dialects with bones. The dialect is known by what follows the label of the first one: the three
/// numbers of an ambient color, or a name.
pub(super) fn materials(
    scanner: &mut M3dScanner<'_>,
    count: usize,
    context: &ImportContext<'_>,
) -> Result<(M3dDialect, Vec<M3dMaterial>), ImportError> {
    scanner.label("the section Materials")?;
    let mut materials = context.vec(&scanner.place(scanner.at()), count)?;
    if count == 0 {
        return Ok((M3dDialect::Dx11, materials));
    }
    let at = scanner.at();
    scanner.label("a material")?;
    let mut has_color = true;
    for _ in 0..3 {
        has_color &= is_number(scanner.word("a material")?);
    }
    scanner.go_to(at);
    let dialect = if has_color { M3dDialect::Dx11 } else { M3dDialect::Dx12 };
    for number in 0..count {
        context.work(32)?;
        materials.push(match dialect {
            M3dDialect::Dx12 => dx12(scanner)?,
            M3dDialect::Dx10 | M3dDialect::Dx11 => dx11(scanner, number)?,
        });
    }
    Ok((dialect, materials))
}

fn dx11(scanner: &mut M3dScanner<'_>, number: usize) -> Result<M3dMaterial, ImportError> {
    let ambient = scanner.color("the ambient color of a material")?;
    let diffuse = scanner.color("the diffuse color of a material")?;
    let specular = scanner.color("the specular color of a material")?;
    let [power] = scanner.labelled("the specular power of a material")?;
    scanner.color("the reflectivity of a material")?;
    let alpha_mode = alpha_mode(scanner)?;
    name(scanner, "the effect of a material")?;
    let phong = Phong { ambient, diffuse, specular, specular_power: power.clamp(1.0, 1000.0) };
    let material = Material {
        name: format!("material{number}"),
        base_color: diffuse.clamp(Vec3::ZERO, Vec3::ONE).extend(1.0),
        metallic: Metallic { metallic: 0.0, roughness: roughness(phong.specular_power) },
        phong,
        use_phong: true,
        alpha_mode,
        ..Material::default()
    };
    with_maps(scanner, material)
}

fn dx12(scanner: &mut M3dScanner<'_>) -> Result<M3dMaterial, ImportError> {
    let own_name = name(scanner, "the name of a material")?;
    let diffuse = scanner.color("the diffuse color of a material")?;
    let fresnel = scanner.color("the reflectance of a material")?;
    let [roughness] = scanner.labelled("the roughness of a material")?;
    let roughness = roughness.clamp(0.0, 1.0);
    let alpha_mode = alpha_mode(scanner)?;
    name(scanner, "the type of a material")?;
    // The exponent in the shader of the book: 256 times the shininess.
    let phong = Phong {
        ambient: diffuse * 0.2,
        diffuse,
        specular: fresnel,
        specular_power: ((1.0 - roughness) * 256.0).clamp(1.0, 256.0),
    };
    let material = Material {
        name: own_name,
        base_color: diffuse.clamp(Vec3::ZERO, Vec3::ONE).extend(1.0),
        metallic: Metallic { metallic: 0.0, roughness },
        phong,
        alpha_mode,
        ..Material::default()
    };
    with_maps(scanner, material)
}

/// Reads `count` materials of the dialect without bones: three names of textures, and a color.
pub(super) fn dx10(
    scanner: &mut M3dScanner<'_>,
    count: usize,
    context: &ImportContext<'_>,
) -> Result<Vec<M3dMaterial>, ImportError> {
    scanner.label("the section Subsets")?;
    let mut materials = context.vec(&scanner.place(scanner.at()), count)?;
    for number in 0..count {
        context.work(8)?;
        let [diffuse_map, _, normal_map] = [(); 3].map(|()| range(scanner, "the name of a texture"));
        scanner.color("the reflectivity of a material")?;
        let material = Material {
            name: format!("material{number}"),
            metallic: Metallic { metallic: 0.0, roughness: roughness(16.0) },
            use_phong: true,
            ..Material::default()
        };
        materials.push(M3dMaterial { material, diffuse_map: diffuse_map?, normal_map: normal_map? });
    }
    Ok(materials)
}

fn with_maps(scanner: &mut M3dScanner<'_>, material: Material) -> Result<M3dMaterial, ImportError> {
    scanner.label("the diffuse map of a material")?;
    let diffuse_map = range(scanner, "the name of a diffuse map")?;
    scanner.label("the normal map of a material")?;
    let normal_map = range(scanner, "the name of a normal map")?;
    Ok(M3dMaterial { material, diffuse_map, normal_map })
}

/// Returns the name of a texture; `None` where the file has a word for no texture.
fn texture(bytes: &[u8], range: &Range<usize>) -> Option<String> {
    let name = String::from_utf8_lossy(&bytes[range.clone()]).into_owned();
    (!name.eq_ignore_ascii_case("none")).then_some(name)
}

fn alpha_mode(scanner: &mut M3dScanner<'_>) -> Result<AlphaMode, ImportError> {
    let [clips] = scanner.labelled("the alpha test of a material")?;
    Ok(if clips == 0.0 { AlphaMode::Opaque } else { AlphaMode::Mask(CLIP) })
}

fn name(scanner: &mut M3dScanner<'_>, what: &str) -> Result<String, ImportError> {
    scanner.label(what)?;
    Ok(String::from_utf8_lossy(scanner.word(what)?.text).into_owned())
}

fn range(scanner: &mut M3dScanner<'_>, what: &str) -> Result<Range<usize>, ImportError> {
    let token = scanner.word(what)?;
    Ok(token.at..token.at + token.text.len())
}

/// Returns the roughness with as wide a highlight as an exponent gives (Beckmann, α² = 2 / (n + 2)).
fn roughness(power: f32) -> f32 {
    libm::powf(2.0 / (power + 2.0), 0.25)
}
