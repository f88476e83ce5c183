// Data of this frame for every pass of the scene.

// Rust twin: picture::uniform::SPOTS
const SPOTS: u32 = 64u;

// Rust twin: picture::uniform::LIGHTS
const LIGHTS: u32 = 8u;

// A light of the scene. Rust twin: picture::uniform::LightUniform
struct SceneLight {
    // w: 0 for a sun, 1 for a point light, 2 for a spot light.
    position: vec4f,
    // Direction in which it shines; w: 0 without a shadow, 1 for the sun that casts one, 2 and more for the spot lights that do.
    direction: vec4f,
    // Light that a white matte surface reflects where it faces the light, at a distance of 1 if it is no sun.
    color: vec4f,
}

// Rust twin: picture::uniform::FrameUniform
struct Frame {
    clip_from_world: mat4x4f,
    view_from_world: mat4x4f,
    // Perspective: xyz is the position of the camera, w is 1. Orthographic: xyz is the unit vector towards the viewer,
    // w is 0.
    eye: vec4f,
    // Width and height of the viewport in pixels, and their reciprocals.
    size: vec4f,
    // x and y: cosine and sine of the camera's yaw, because the studio's lights follow the viewer. z: 0 material,
    // 1 clay, 2 unlit. w: 1 where the lines of the grid are drawn.
    studio: vec4f,
    // Linear RGB; alpha 0 makes the background transparent.
    background_top: vec4f,
    background_bottom: vec4f,
    // Linear RGB; w: fade-in of the fine lines.
    grid_color: vec4f,
    // Center of the grid on the ground (x, z), its radius, and the distance between its fine lines.
    grid: vec4f,
    // Linear RGB of bones and of selected bones.
    bone_color: vec4f,
    accent: vec4f,
    // Of a sub-frame. x: 1 where the target takes light before the tone map, 0 where it takes colors of the display. y: threshold of
    // masks.
    sampling: vec4f,
    // Spots of the contact shadow: center x and z, radius, strength.
    contact: array<vec4f, SPOTS>,
    // Number of lights of the scene, share of the studio's ambient light, number of spots, height of the ground.
    counts: vec4f,
    lights: array<SceneLight, LIGHTS>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// Unit vector from a point of the scene to the viewer.
fn towards_viewer(point: vec3f) -> vec3f {
    if frame.eye.w > 0.5 {
        return normalize(frame.eye.xyz - point);
    }
    return frame.eye.xyz;
}
