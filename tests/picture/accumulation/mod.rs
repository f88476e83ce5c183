//! A frame that is the mean of sub-frames: exact edges, motion blur, light added before the tone map; the same bytes whatever happened before.

mod edges;
mod frames;
mod light;
mod motion;
mod points;
mod shadows;

use dragonfly_anim::data::{Material, ModelData, Primitive, Transform};
use dragonfly_document::LoadedModel;
use dragonfly_kit::document::made;
use dragonfly_picture::camera::{Camera, Projection};
use dragonfly_picture::{FrameSampling, Look, PictureSettings, Shading};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Returns settings with this number of sub-frames and a closed shutter.
fn still(samples: u32) -> FrameSampling {
    FrameSampling { samples, shutter: 0.0, ..FrameSampling::default() }
}

/// Returns settings for an orthographic view from the front in which a pixel is a unit, without lighting, over nothing.
fn front(size: [u32; 2], middle: Vec3, sampling: FrameSampling) -> PictureSettings {
    let camera = Camera {
        target: middle,
        distance: size[1] as f32,
        yaw: 0.0,
        pitch: 0.0,
        roll: 0.0,
        field_of_view: 2.0 * 0.5_f32.atan(),
        projection: Projection::Orthographic,
    };
    PictureSettings {
        size,
        camera: Some(camera),
        background: Some([0; 4]),
        grid: false,
        sampling,
        look: Look { shading: Shading::Unlit, ..Look::default() },
        ..PictureSettings::default()
    }
}

/// Returns a quadrilateral that faces +Z; corners from the upper left, counterclockwise.
fn quadrilateral(corners: [Vec2; 4]) -> Primitive {
    let mut sheet = made::sheet();
    sheet.vertices.positions = corners.map(|corner| corner.extend(0.0)).to_vec();
    sheet
}

/// Returns an upright rectangle around the origin.
fn rectangle(width: f32, height: f32) -> Primitive {
    let (x, y) = (width / 2.0, height / 2.0);
    quadrilateral([Vec2::new(-x, y), Vec2::new(-x, -y), Vec2::new(x, -y), Vec2::new(x, y)])
}

/// Returns a model of one primitive that a bone carries along x, by `distance` within a second.
fn carried(primitive: Primitive, material: Material, distance: f32) -> Arc<LoadedModel> {
    let end = |_| Transform { translation: Vec3::X * distance, ..Transform::IDENTITY };
    let model = ModelData {
        meshes: vec![made::mesh(primitive)],
        instances: vec![made::instance(0, None, Some(0))],
        materials: vec![material],
        animation: made::chain(1, Vec3::ZERO, end),
        ..ModelData::default()
    };
    made::loaded(model, Vec::new())
}
