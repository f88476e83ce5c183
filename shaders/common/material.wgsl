// The material of a surface: values, textures, and their coordinates.

// Coordinates of a texture. Rust twin: picture::uniform::TextureUse
struct TextureUse {
    // First row of the transformation; w: index of the coordinate set.
    u: vec4f,
    // Second row; w: 1 when there is a texture.
    v: vec4f,
}

// Rust twin: picture::uniform::MaterialUniform
struct Material {
    base_color: vec4f,
    // w: alpha cutoff of masked surfaces.
    emissive: vec4f,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    phong_ambient: vec4f,
    phong_diffuse: vec4f,
    // w: exponent.
    phong_specular: vec4f,
    use_phong: u32,
    unlit: u32,
    // 0 opaque, 1 mask, 2 blend.
    alpha_mode: u32,
    pad: u32,
    base_color_use: TextureUse,
    metallic_roughness_use: TextureUse,
    normal_use: TextureUse,
    occlusion_use: TextureUse,
    emissive_use: TextureUse,
}

@group(2) @binding(0) var<uniform> material: Material;
@group(2) @binding(1) var base_color_texture: texture_2d<f32>;
@group(2) @binding(2) var metallic_roughness_texture: texture_2d<f32>;
@group(2) @binding(3) var normal_texture: texture_2d<f32>;
@group(2) @binding(4) var occlusion_texture: texture_2d<f32>;
@group(2) @binding(5) var emissive_texture: texture_2d<f32>;
@group(2) @binding(6) var base_color_sampler: sampler;
@group(2) @binding(7) var metallic_roughness_sampler: sampler;
@group(2) @binding(8) var normal_sampler: sampler;
@group(2) @binding(9) var occlusion_sampler: sampler;
@group(2) @binding(10) var emissive_sampler: sampler;

fn coordinates(use_of: TextureUse, uv: vec4f) -> vec2f {
    let chosen = vec3f(select(uv.xy, uv.zw, use_of.u.w > 0.5), 1.0);
    return vec2f(dot(use_of.u.xyz, chosen), dot(use_of.v.xyz, chosen));
}

fn has_texture(use_of: TextureUse) -> bool {
    return use_of.v.w > 0.5;
}
