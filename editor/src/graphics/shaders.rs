//! The list of shaders: each is one file of `shaders/`, put behind the common parts it names.

/// A shader module.
pub struct Shader {
    /// File name in `shaders/` without its ending.
    pub name: &'static str,
    /// Common parts, in order, then the file itself.
    parts: &'static [&'static str],
}

const FRAME: &str = include_str!("../../../shaders/common/frame.wgsl");
const COLOR: &str = include_str!("../../../shaders/common/color.wgsl");
const STUDIO: &str = include_str!("../../../shaders/common/studio.wgsl");
const POSE: &str = include_str!("../../../shaders/common/pose.wgsl");

/// The gradient behind the scene.
pub const BACKGROUND: Shader =
    Shader { name: "background", parts: &[FRAME, COLOR, include_str!("../../../shaders/background.wgsl")] };
/// Skinned and lit surfaces.
pub const MODEL: Shader = Shader {
    name: "model",
    parts: &[FRAME, COLOR, STUDIO, POSE, include_str!("../../../shaders/model.wgsl")],
};
/// The ground.
pub const GRID: Shader = Shader { name: "grid", parts: &[FRAME, include_str!("../../../shaders/grid.wgsl")] };
/// Bones.
pub const SKELETON: Shader =
    Shader { name: "skeleton", parts: &[FRAME, STUDIO, include_str!("../../../shaders/skeleton.wgsl")] };
/// The scene into the window.
pub const COMPOSITE: Shader =
    Shader { name: "composite", parts: &[COLOR, include_str!("../../../shaders/composite.wgsl")] };
/// Mip levels.
pub const MIP: Shader = Shader { name: "mip", parts: &[include_str!("../../../shaders/mip.wgsl")] };

/// Every shader of the program.
pub const ALL: &[Shader] = &[BACKGROUND, MODEL, GRID, SKELETON, COMPOSITE, MIP];

impl Shader {
    /// The whole text.
    pub fn source(&self) -> String {
        self.parts.join("\n")
    }

    /// The module on `device`.
    pub fn module(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.source().into()),
        })
    }
}
