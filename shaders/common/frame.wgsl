// What every pass of the scene knows about this frame.

// Rust twin: graphics::uniform::FrameUniform
struct Frame {
    clip_from_world: mat4x4f,
    view_from_world: mat4x4f,
    // xyz the eye, w = 1 for perspective; for parallel projection xyz points from the scene to the viewer and w = 0.
    eye: vec4f,
    // Width and height of the viewport in pixels, then one over each.
    size: vec4f,
    // Cosine and sine of the camera's yaw: the studio's lights follow the viewer around. z: 0 material, 1 clay, 2 unlit.
    studio: vec4f,
    // Linear RGB; alpha 0 leaves the picture's background open.
    background_top: vec4f,
    background_bottom: vec4f,
    // Linear RGB and strength.
    grid_color: vec4f,
    // Centre of the grid on the ground (x, z), its radius, and the distance between its fine lines.
    grid: vec4f,
    // Linear RGB of bones, of selected bones.
    bone_color: vec4f,
    accent: vec4f,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// From a point of the scene to the viewer, unit length.
fn towards_viewer(point: vec3f) -> vec3f {
    if frame.eye.w > 0.5 {
        return normalize(frame.eye.xyz - point);
    }
    return frame.eye.xyz;
}
