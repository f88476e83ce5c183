//! The list of shaders: each is one file in `shaders/`, appended to the common parts it names.

/// A shader module.
pub struct Shader {
    /// File name in `shaders/` without its extension.
    pub name: &'static str,
    /// Common parts, in order, then the file itself.
    parts: &'static [ShaderFile],
}

/// Name of a file in `shaders/`, and its content when the program was built.
type ShaderFile = (&'static str, &'static str);

macro_rules! part {
    ($path:literal) => {
        ($path, include_str!(concat!("../../../shaders/", $path)))
    };
}

const FRAME: ShaderFile = part!("common/frame.wgsl");
const COLOR: ShaderFile = part!("common/color.wgsl");
const STUDIO: ShaderFile = part!("common/studio.wgsl");
const POSE: ShaderFile = part!("common/pose.wgsl");
const VERTEX: ShaderFile = part!("common/vertex.wgsl");

/// The background gradient.
pub const BACKGROUND: Shader =
    Shader { name: "background", parts: &[FRAME, COLOR, part!("background.wgsl")] };
/// Skinned and lit surfaces.
pub const MODEL: Shader =
    Shader { name: "model", parts: &[FRAME, COLOR, STUDIO, POSE, VERTEX, part!("model.wgsl")] };
/// Surfaces of ghosts.
pub const GHOST: Shader = Shader { name: "ghost", parts: &[FRAME, POSE, VERTEX, part!("ghost.wgsl")] };
/// The ground grid.
pub const GRID: Shader = Shader { name: "grid", parts: &[FRAME, part!("grid.wgsl")] };
/// The bones.
pub const SKELETON: Shader = Shader { name: "skeleton", parts: &[FRAME, STUDIO, part!("skeleton.wgsl")] };
/// The controls of the scene.
pub const CONTROLS: Shader = Shader { name: "controls", parts: &[FRAME, part!("controls.wgsl")] };
/// Copying the scene into the window.
pub const COMPOSITE: Shader = Shader { name: "composite", parts: &[COLOR, part!("composite.wgsl")] };
/// Computing mip levels.
pub const MIP: Shader = Shader { name: "mip", parts: &[part!("mip.wgsl")] };

/// Every shader of the program.
pub const ALL: &[Shader] = &[BACKGROUND, MODEL, GHOST, GRID, SKELETON, CONTROLS, COMPOSITE, MIP];

impl Shader {
    /// Returns the complete source.
    ///
    /// A development build reads it from the folder in `DRAGONFLY_SHADERS` if that is set, so that shaders can be
    /// edited without rebuilding.
    pub fn source(&self) -> String {
        let folder = std::env::var_os("DRAGONFLY_SHADERS").filter(|_| cfg!(debug_assertions));
        let text = |&(path, built): &ShaderFile| {
            let newer = folder.as_ref().map(|folder| std::path::Path::new(folder).join(path));
            newer.and_then(|path| std::fs::read_to_string(path).ok()).unwrap_or_else(|| built.to_owned())
        };
        self.parts.iter().map(text).collect::<Vec<_>>().join("\n")
    }

    /// Compiles the module for `device`.
    pub fn module(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.source().into()),
        })
    }
}
