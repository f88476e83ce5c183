// Copies the finished scene into the window, encoding it to sRGB exactly once.

@group(0) @binding(0) var scene: texture_2d<f32>;

@vertex
fn vs_composite(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

// Rust twin: picture::pass::composite, `prepare`
struct Place {
    // Top left of the viewport in the window, pixels.
    origin: vec2f,
    pad: vec2f,
}
@group(0) @binding(1) var<uniform> place: Place;

fn scene_at(position: vec4f) -> vec3f {
    let size = vec2i(textureDimensions(scene));
    let pixel = clamp(vec2i(position.xy - place.origin), vec2i(0), size - 1);
    return textureLoad(scene, pixel, 0).rgb;
}

// For a window format that stores values unchanged.
@fragment
fn fs_encode(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(srgb_encode(scene_at(position)), 1.0);
}

// For a window format that encodes to sRGB itself.
@fragment
fn fs_plain(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(scene_at(position), 1.0);
}
