// The surface at another time: transparent, in one color, brightest at its outline.

struct Ghost {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    // Linear RGB and opacity.
    @location(2) @interpolate(flat) tint: vec4f,
}

@vertex
fn vs_ghost(in: VertexIn, @builtin(vertex_index) index: u32) -> Ghost {
    let posed = posed_vertex(in, index);
    return Ghost(
        frame.clip_from_world * vec4f(posed.position, 1.0),
        posed.position, posed.normal, unpack4x8unorm(in.draw1.y));
}

@fragment
fn fs_ghost(in: Ghost) -> @location(0) vec4f {
    let normal = in.normal * inverseSqrt(max(dot(in.normal, in.normal), 1e-24));
    let facing = abs(dot(normal, towards_viewer(in.world)));
    let rim = 1.0 - facing;
    let alpha = in.tint.a * (0.22 + 0.78 * rim * rim);
    return vec4f(display_color(in.tint.rgb) * alpha, alpha);
}
