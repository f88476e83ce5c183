// A calm gradient behind everything.

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) height: f32,
}

@vertex
fn vs_background(@builtin(vertex_index) index: u32) -> Corner {
    // One triangle that covers the viewport.
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    // Depth 0 is the far end (reversed depth).
    return Corner(vec4f(corner * 2.0 - 1.0, 0.0, 1.0), corner.y);
}

@fragment
fn fs_background(in: Corner) -> @location(0) vec4f {
    // Mixed as the eye sees steps, not as light adds, so that the middle is not too bright.
    let top = sqrt(frame.background_top);
    let bottom = sqrt(frame.background_bottom);
    let color = mix(bottom, top, smoothstep(0.0, 1.0, in.height));
    let noise = dither(in.position.xy) / 255.0 * 0.5;
    let open = color * color;
    return vec4f((color.rgb + noise * open.a) * (color.rgb + noise * open.a), open.a);
}
