// An instance of a draw, and a vertex in its pose.

// Rust twin: picture::uniform::DrawInstance
struct Draw {
    // First matrix of this instance in `palettes`.
    palette: u32,
    // Influences per vertex: 0 for an instance that one matrix moves, otherwise 4 or 8.
    influences: u32,
    // Number of morph targets, and the index of their first weight in `weights`.
    morph_targets: u32,
    morph_weights: u32,
    vertices: u32,
    // Tint of a ghost: four bytes, linear RGB and opacity.
    tint: u32,
    // Index of its first vertex among the posed ones of all instances.
    posed: u32,
}

struct Posed {
    position: vec3f,
    normal: vec3f,
    // w: sign of the bitangent.
    tangent: vec4f,
}

// The same in a buffer: 40 bytes without padding, and every bit of the numbers. Rust twin: picture::uniform::POSED_BYTES
struct PosedVertex {
    position_x: f32,
    position_y: f32,
    position_z: f32,
    normal_x: f32,
    normal_y: f32,
    normal_z: f32,
    tangent_x: f32,
    tangent_y: f32,
    tangent_z: f32,
    tangent_w: f32,
}
