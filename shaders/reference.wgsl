// A reference picture: locked to the camera behind everything, or on a plane of the scene.

// Rust twin: picture::pass::reference::ReferenceUniform
struct Reference {
    // Center: in clip space where w is 0, in the scene where it is 1.
    center: vec4f,
    // From the center to the right and to the upper edge.
    right: vec4f,
    up: vec4f,
    // x: opacity.
    look: vec4f,
}

@group(1) @binding(0) var<uniform> reference: Reference;
@group(1) @binding(1) var picture: texture_2d<f32>;
@group(1) @binding(2) var picture_sampler: sampler;

struct Point {
    @builtin(position) position: vec4f,
    @location(0) place: vec2f,
}

@vertex
fn vs_reference(@builtin(vertex_index) index: u32) -> Point {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    let side = corner * 2.0 - 1.0;
    let point = reference.center.xyz + side.x * reference.right.xyz + side.y * reference.up.xyz;
    var position = vec4f(point.xy, 0.0, 1.0);
    if reference.center.w > 0.5 {
        position = frame.clip_from_world * vec4f(point, 1.0);
    }
    return Point(position, vec2f(corner.x, 1.0 - corner.y));
}

@fragment
fn fs_reference(in: Point) -> @location(0) vec4f {
    let color = textureSample(picture, picture_sampler, in.place);
    let alpha = color.a * reference.look.x;
    return vec4f(display_color(color.rgb) * alpha, alpha);
}
