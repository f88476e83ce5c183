//! Placeholders for models that are missing or still being read: a figure of human size, or a box for props.

use dragonfly_anim::bounds::{AxisBox, bounds_of_pose};
use dragonfly_anim::data::{Material, Mesh, MeshInstance, Metallic, ModelData, Primitive, Vertices};
use dragonfly_document::LoadedModel;
use dragonfly_document::images::ImageSurvey;
use glam::{Mat4, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

/// Height and radius of a figure, and half the side of a box, meters.
const HEIGHT: f32 = 1.75;
const RADIUS: f32 = 0.28;
const HALF_SIDE: f32 = 0.15;
/// Number of sides of a figure, and of rings of each of its ends.
const SIDES: usize = 20;
const RINGS: usize = 6;

/// Colors that tell things apart, linear RGB: alike in lightness.
const COLORS: [[f32; 3]; 8] = [
    [0.45, 0.10, 0.08],
    [0.07, 0.20, 0.48],
    [0.08, 0.30, 0.10],
    [0.45, 0.25, 0.03],
    [0.27, 0.10, 0.42],
    [0.03, 0.30, 0.30],
    [0.42, 0.10, 0.26],
    [0.22, 0.22, 0.20],
];

/// The placeholders that were needed so far, by kind and color: two things of one color share one.
#[derive(Default)]
pub(super) struct Placeholders([[Option<Arc<LoadedModel>>; COLORS.len()]; 2]);

impl Placeholders {
    /// Returns the placeholder of the thing called `id`: a figure for a role, a box for a prop.
    pub(super) fn of(&mut self, id: &str, is_role: bool) -> Arc<LoadedModel> {
        let number = id.bytes().fold(0_u32, |sum, byte| sum.wrapping_mul(31).wrapping_add(byte.into()));
        let color = number as usize % COLORS.len();
        let known = &mut self.0[usize::from(is_role)][color];
        Arc::clone(known.get_or_insert_with(|| Arc::new(model(COLORS[color], is_role))))
    }
}

/// Returns the box around a placeholder at the origin, meters: a figure for a role, a box for a prop.
pub fn placeholder_box(is_role: bool) -> AxisBox {
    let (half, height) = if is_role { (RADIUS, HEIGHT) } else { (HALF_SIDE, 2.0 * HALF_SIDE) };
    AxisBox { min: Vec3::new(-half, 0.0, -half), max: Vec3::new(half, height, half) }
}

fn model(color: [f32; 3], is_role: bool) -> LoadedModel {
    let primitive = if is_role { figure() } else { cube() };
    let material = Material {
        base_color: Vec3::from(color).extend(1.0),
        metallic: Metallic { metallic: 0.0, roughness: 0.7 },
        ..Material::default()
    };
    let instance = MeshInstance {
        mesh: 0,
        node: None,
        skin: None,
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: Vec::new(),
    };
    let mesh = Mesh {
        name: String::new(),
        primitives: vec![Primitive { material: Some(0), ..primitive }],
        morph_weights: Vec::new(),
    };
    let model = ModelData {
        meshes: vec![mesh],
        materials: vec![material],
        instances: vec![instance],
        ..ModelData::default()
    };
    made_model("placeholder", model)
}

/// Returns a model that was read from no file.
pub(crate) fn made_model(title: &str, model: ModelData) -> LoadedModel {
    let model = Arc::new(model);
    LoadedModel {
        title: title.to_owned(),
        path: None,
        format: None,
        conversion: Default::default(),
        bounds: bounds_of_pose(&model, None, 0.0),
        model,
        images: ImageSurvey::default(),
        warnings: Vec::new(),
        notes: Vec::new(),
    }
}

/// Returns a capsule on the ground, with a nose to the front, +z.
fn figure() -> Primitive {
    let mut vertices = Vertices::default();
    let mut indices = Vec::new();
    let rings = 2 * (RINGS + 1);
    for ring in 0..rings {
        let is_top = ring > RINGS;
        let angle = (if is_top { ring - RINGS - 1 } else { ring }) as f32 / RINGS as f32 * FRAC_PI_2;
        let (across, up) = if is_top { (angle.cos(), angle.sin()) } else { (angle.sin(), -angle.cos()) };
        let center = if is_top { HEIGHT - RADIUS } else { RADIUS };
        for side in 0..=SIDES {
            let (sin, cos) = (side as f32 / SIDES as f32 * TAU).sin_cos();
            let normal = Vec3::new(across * cos, up, across * sin);
            vertices.positions.push(Vec3::Y * center + normal * RADIUS);
            vertices.normals.push(normal);
        }
    }
    let row = SIDES as u32 + 1;
    for ring in 0..rings as u32 - 1 {
        for side in 0..SIDES as u32 {
            let [a, b] = [ring * row + side, ring * row + side + 1];
            indices.extend([a, a + row, b, b, a + row, b + row]);
        }
    }
    let front = Vec3::new(0.0, HEIGHT - 0.25, RADIUS);
    add_cuboid(&mut vertices, &mut indices, front, Vec3::new(0.05, 0.05, 0.1));
    Primitive { vertices, indices, ..Primitive::default() }
}

/// Returns a cube on the ground.
fn cube() -> Primitive {
    let (mut vertices, mut indices) = (Vertices::default(), Vec::new());
    add_cuboid(&mut vertices, &mut indices, Vec3::Y * HALF_SIDE, Vec3::splat(HALF_SIDE));
    Primitive { vertices, indices, ..Primitive::default() }
}

fn add_cuboid(vertices: &mut Vertices, indices: &mut Vec<u32>, center: Vec3, half: Vec3) {
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let mut normal = Vec3::ZERO;
            normal[axis] = sign;
            let (mut u, mut v) = (Vec3::ZERO, Vec3::ZERO);
            u[(axis + 1) % 3] = sign;
            v[(axis + 2) % 3] = 1.0;
            let first = vertices.positions.len() as u32;
            for (s, t) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                vertices.positions.push(center + (normal + u * s + v * t) * half);
                vertices.normals.push(normal);
            }
            indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
        }
    }
}
