//! The list of shaders: each is one file of `shaders/`, put behind the common parts it names.

/// A shader module.
pub struct Shader {
    /// File name in `shaders/` without its ending.
    pub name: &'static str,
    /// Common parts, in order, then the file itself.
    parts: &'static [Part],
}

/// A file of `shaders/`, and what it held when the program was built.
type Part = (&'static str, &'static str);

macro_rules! part {
    ($path:literal) => {
        ($path, include_str!(concat!("../../../shaders/", $path)))
    };
}

const FRAME: Part = part!("common/frame.wgsl");
const COLOR: Part = part!("common/color.wgsl");
const STUDIO: Part = part!("common/studio.wgsl");
const POSE: Part = part!("common/pose.wgsl");
const VERTEX: Part = part!("common/vertex.wgsl");

/// The gradient behind the scene.
pub const BACKGROUND: Shader =
    Shader { name: "background", parts: &[FRAME, COLOR, part!("background.wgsl")] };
/// Skinned and lit surfaces.
pub const MODEL: Shader =
    Shader { name: "model", parts: &[FRAME, COLOR, STUDIO, POSE, VERTEX, part!("model.wgsl")] };
/// Surfaces at other times.
pub const GHOST: Shader = Shader { name: "ghost", parts: &[FRAME, POSE, VERTEX, part!("ghost.wgsl")] };
/// The ground.
pub const GRID: Shader = Shader { name: "grid", parts: &[FRAME, part!("grid.wgsl")] };
/// Bones.
pub const SKELETON: Shader = Shader { name: "skeleton", parts: &[FRAME, STUDIO, part!("skeleton.wgsl")] };
/// Controls of the scene.
pub const CONTROLS: Shader = Shader { name: "controls", parts: &[FRAME, part!("controls.wgsl")] };
/// The scene into the window.
pub const COMPOSITE: Shader = Shader { name: "composite", parts: &[COLOR, part!("composite.wgsl")] };
/// Mip levels.
pub const MIP: Shader = Shader { name: "mip", parts: &[part!("mip.wgsl")] };

/// Every shader of the program.
pub const ALL: &[Shader] = &[BACKGROUND, MODEL, GHOST, GRID, SKELETON, CONTROLS, COMPOSITE, MIP];

impl Shader {
    /// The whole text.
    ///
    /// A build for development reads it anew from the folder that `DRAGONFLY_SHADERS` names, so that the look can be
    /// worked on without building.
    pub fn source(&self) -> String {
        let folder = std::env::var_os("DRAGONFLY_SHADERS").filter(|_| cfg!(debug_assertions));
        let text = |&(path, built): &Part| {
            let newer = folder.as_ref().map(|folder| std::path::Path::new(folder).join(path));
            newer.and_then(|path| std::fs::read_to_string(path).ok()).unwrap_or_else(|| built.to_owned())
        };
        self.parts.iter().map(text).collect::<Vec<_>>().join("\n")
    }

    /// The module on `device`.
    pub fn module(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.source().into()),
        })
    }
}
