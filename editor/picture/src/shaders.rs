//! The list of shaders: each is one file in `shaders/`, appended to the common parts it names. A new one is such a file and a
//! line in the list `shaders!`.

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
    ($path:expr) => {
        ($path, include_str!(concat!("../../../shaders/", $path)))
    };
}

const FRAME: ShaderFile = part!("common/frame.wgsl");
const COLOR: ShaderFile = part!("common/color.wgsl");
const DISPLAY: ShaderFile = part!("common/display.wgsl");
const STUDIO: ShaderFile = part!("common/studio.wgsl");
const DRAW: ShaderFile = part!("common/draw.wgsl");
const POSE: ShaderFile = part!("common/pose.wgsl");
const VERTEX: ShaderFile = part!("common/vertex.wgsl");
const POSED: ShaderFile = part!("common/posed.wgsl");
const MATERIAL: ShaderFile = part!("common/material.wgsl");
const UNSHADOWED: ShaderFile = part!("common/unshadowed.wgsl");
const SHADOWED: ShaderFile = part!("common/shadowed.wgsl");

/// Declares the constants of shaders and [`ALL`] from a list of `NAME = "file name": common parts;` lines.
macro_rules! shaders {
    ($($(#[$doc:meta])* $NAME:ident = $name:literal: $($part:ident)*;)*) => {
        $($(#[$doc])* pub const $NAME: Shader =
            Shader { name: $name, parts: &[$($part,)* part!(concat!($name, ".wgsl"))] };)*

        /// Every shader of the program.
        pub const ALL: &[Shader] = &[$($NAME),*];
    };
}

shaders! {
    /// The background gradient.
    BACKGROUND = "background": FRAME COLOR;
    /// The reference picture.
    REFERENCE = "reference": FRAME COLOR DISPLAY;
    /// Morphed and skinned vertices, for several passes.
    SKIN = "skin": DRAW POSE;
    /// Maps of shadows.
    SHADOW = "shadow": DRAW POSE VERTEX MATERIAL;
    /// The same of vertices that were posed before.
    SHADOW_POSED = "shadow": DRAW POSED MATERIAL;
    /// Skinned and lit surfaces.
    MODEL = "model": FRAME COLOR DISPLAY STUDIO DRAW POSE VERTEX MATERIAL UNSHADOWED;
    /// The same with shadows of lamps.
    MODEL_SHADOWED = "model": FRAME COLOR DISPLAY STUDIO DRAW POSE VERTEX MATERIAL SHADOWED;
    /// The same of vertices that were posed before.
    MODEL_POSED = "model": FRAME COLOR DISPLAY STUDIO DRAW POSED MATERIAL SHADOWED;
    /// Shadows of lamps on the ground.
    SHADOW_CATCHER = "shadow_catcher": FRAME COLOR STUDIO SHADOWED;
    /// Surfaces of ghosts.
    GHOST = "ghost": FRAME COLOR DISPLAY DRAW POSE VERTEX;
    /// The ground grid.
    GRID = "grid": FRAME COLOR DISPLAY;
    /// The bones.
    SKELETON = "skeleton": FRAME COLOR DISPLAY STUDIO;
    /// The controls of the scene.
    CONTROLS = "controls": FRAME COLOR DISPLAY;
    /// Adding sub-frames, and developing their sum.
    ACCUMULATE = "accumulate": COLOR;
    /// Copying the scene into the window.
    COMPOSITE = "composite": COLOR;
    /// Computing mip levels.
    MIP = "mip":;
}

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
