//! Writes one pose of a model as an OBJ file with its materials and images.

use super::materials::AMBIENT;
use crate::data::{AlphaMode, Material, ModelData, Primitive};
use crate::evaluator::Evaluator;
use crate::format::{ImageKind, OutputFile, Place, SavePlan, Warning};
use glam::{Vec3, Vec4};
use std::collections::HashMap;
use std::fmt::Write;

/// Code of a loss: an image has no bytes, or is stored in no file of its own.
const IMAGE_MISSING: &str = "IMAGE_DATA_INVALID";

/// Returns the files of the pose that `evaluator` has: images, `<stem>.mtl` if there are materials, and `<stem>.obj`, each relative
/// to one folder. Positions are in scene space, in meters, Y up; a skin and morph targets are applied.
///
/// Lost are the animation, which the caller knows of, a second set of texture coordinates, and what MTL has no value for: roughness
/// and metallic textures, occlusion, and transparent texels.
pub fn write(evaluator: &Evaluator, stem: &str) -> SavePlan {
    let model = evaluator.model();
    let mut plan = SavePlan::default();
    let images = image_names(model, stem, &mut plan);
    if !model.materials.is_empty() {
        let text = materials(model, &images);
        plan.files.push(OutputFile { name: format!("{stem}.mtl"), bytes: text.into_bytes() });
    }
    plan.files.push(OutputFile { name: format!("{stem}.obj"), bytes: shapes(evaluator, stem) });
    plan
}

/// Returns the content of the OBJ file alone: the shapes in the pose that `evaluator` has, with materials of `<stem>.mtl`.
pub(super) fn shapes(evaluator: &Evaluator, stem: &str) -> Vec<u8> {
    ObjWriter::default().write(evaluator, stem).into_bytes()
}

/// Adds the images that materials use, and returns their names.
fn image_names(model: &ModelData, stem: &str, plan: &mut SavePlan) -> HashMap<u32, String> {
    let textures = model.materials.iter().flat_map(|material| {
        [material.base_color_texture, material.emissive_texture, material.normal_texture]
    });
    let mut names = HashMap::new();
    for texture in textures.flatten() {
        let Some(image) = model.images.get(texture.image as usize) else { continue };
        if names.contains_key(&texture.image) {
            continue;
        }
        if image.bytes.is_empty() {
            let place = Place::Pointer(format!("/images/{}", texture.image));
            let text = "the image has no content".to_owned();
            plan.lost.push(Warning { place, code: IMAGE_MISSING, text });
            continue;
        }
        let extension = ImageKind::of(&image.mime).map_or("png", |kind| kind.extensions[0]);
        let name = format!("{stem}_{}.{extension}", texture.image);
        plan.files.push(OutputFile { name: name.clone(), bytes: image.bytes.to_vec() });
        names.insert(texture.image, name);
    }
    names
}

fn materials(model: &ModelData, images: &HashMap<u32, String>) -> String {
    let mut text = String::new();
    for (index, material) in model.materials.iter().enumerate() {
        let _ = writeln!(text, "newmtl {}", material_name(material, index));
        // Phong values where the model is lit with them, and otherwise those of its colors.
        let (phong, color) = (&material.phong, material.base_color);
        let diffuse = if material.use_phong { phong.diffuse } else { color.truncate() };
        let colors = [
            ("Ka", (phong.ambient / AMBIENT).min(Vec3::ONE)),
            ("Kd", diffuse),
            ("Ks", phong.specular),
            ("Ke", material.emissive),
        ];
        for (name, color) in colors {
            let _ = writeln!(text, "{name} {}", numbers(color));
        }
        let _ = writeln!(text, "Ns {}", phong.specular_power);
        let alpha = match material.alpha_mode {
            AlphaMode::Blend => color.w,
            AlphaMode::Opaque | AlphaMode::Mask(_) => 1.0,
        };
        let _ = writeln!(text, "d {alpha}");
        if !material.use_phong {
            let metallic = &material.metallic;
            let _ = writeln!(text, "Pr {}\nPm {}", metallic.roughness, metallic.metallic);
        }
        let textures = [
            ("map_Kd", material.base_color_texture),
            ("map_Ke", material.emissive_texture),
            ("norm", material.normal_texture),
        ];
        for (name, texture) in textures {
            if let Some(file) = texture.and_then(|texture| images.get(&texture.image)) {
                let _ = writeln!(text, "{name} {file}");
            }
        }
        text.push('\n');
    }
    text
}

/// Numbers of the vertices written so far.
#[derive(Default)]
struct ObjWriter {
    text: String,
    vertices: usize,
    texture_coordinates: usize,
}

impl ObjWriter {
    fn write(mut self, evaluator: &Evaluator, stem: &str) -> String {
        let model = evaluator.model();
        if !model.materials.is_empty() {
            let _ = writeln!(self.text, "mtllib {stem}.mtl");
        }
        for (number, instance) in model.instances.iter().enumerate() {
            let name = model.meshes.get(instance.mesh as usize).map_or("", |mesh| mesh.name.as_str());
            let _ = writeln!(self.text, "o {}", one_word(name, "mesh", number));
            for (index, primitive) in evaluator.primitives(number).iter().enumerate() {
                let count = primitive.vertices.len();
                let (mut positions, mut normals) = (vec![Vec3::ZERO; count], vec![Vec3::Y; count]);
                evaluator.positions(number, index, &mut positions);
                evaluator.normals(number, index, &mut normals);
                self.primitive(model, primitive, &positions, &normals);
            }
        }
        self.text
    }

    fn primitive(&mut self, model: &ModelData, primitive: &Primitive, positions: &[Vec3], normals: &[Vec3]) {
        let colors = &primitive.vertices.colors;
        for (vertex, position) in positions.iter().enumerate() {
            let _ = write!(self.text, "v {}", numbers(*position));
            if let Some(color) = colors.get(vertex) {
                let _ = write!(self.text, " {}", numbers(color_of(*color)));
            }
            self.text.push('\n');
        }
        let coordinates = &primitive.vertices.texture_coordinates[0];
        for coordinate in coordinates {
            let _ = writeln!(self.text, "vt {} {}", coordinate.x, 1.0 - coordinate.y);
        }
        for normal in normals {
            let _ = writeln!(self.text, "vn {}", numbers(*normal));
        }
        if let Some(material) = primitive.material
            && let Some(used) = model.materials.get(material as usize)
        {
            let _ = writeln!(self.text, "usemtl {}", material_name(used, material as usize));
        }
        let has_coordinates = !coordinates.is_empty();
        for corners in primitive.indices.chunks_exact(3) {
            self.text.push('f');
            for &corner in corners {
                let vertex = self.vertices + corner as usize + 1;
                if has_coordinates {
                    let coordinate = self.texture_coordinates + corner as usize + 1;
                    let _ = write!(self.text, " {vertex}/{coordinate}/{vertex}");
                } else {
                    let _ = write!(self.text, " {vertex}//{vertex}");
                }
            }
            self.text.push('\n');
        }
        self.vertices += positions.len();
        self.texture_coordinates += coordinates.len();
    }
}

fn numbers(vector: Vec3) -> String {
    format!("{} {} {}", vector.x, vector.y, vector.z)
}

/// Returns a linear color in sRGB.
fn color_of(color: Vec4) -> Vec3 {
    let srgb = |linear: f32| {
        if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 }
    };
    Vec3::new(srgb(color.x), srgb(color.y), srgb(color.z))
}

/// Returns the name of a material in the file, different for each.
fn material_name(material: &Material, index: usize) -> String {
    one_word(&material.name, "material", index)
}

/// Returns a name without blanks that ends in its number, so that it is unique.
fn one_word(name: &str, what: &str, number: usize) -> String {
    let is_kept = |character: char| {
        !character.is_whitespace() && !character.is_control() && character != '#' && character != '\\'
    };
    let name: String =
        name.chars().map(|character| if is_kept(character) { character } else { '_' }).collect();
    format!("{}_{number}", if name.is_empty() { what } else { &name })
}
