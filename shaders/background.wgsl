// The background gradient.

struct Corner {
    @builtin(position) position: vec4f,
    // 0 at the bottom left, 1 at the top right.
    @location(0) place: vec2f,
}

@vertex
fn vs_background(@builtin(vertex_index) index: u32) -> Corner {
    // One triangle that covers the viewport.
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    // Depth 0 is the far end (reversed depth).
    return Corner(vec4f(corner * 2.0 - 1.0, 0.0, 1.0), corner);
}

@fragment
fn fs_background(in: Corner) -> @location(0) vec4f {
    // Mixed in a roughly perceptual space instead of linear light, so that the middle is not too bright.
    let top = sqrt(frame.background_top);
    let bottom = sqrt(frame.background_bottom);
    var color = mix(bottom, top, smoothstep(0.0, 1.0, in.place.y));
    // The key light leaves a soft pool of light on the wall; a plain background stays plain.
    let aside = (in.place - vec2f(0.44, 0.6)) * vec2f(frame.size.x * frame.size.w, 1.0);
    let pool = 0.22 * f32(any(frame.background_top != frame.background_bottom));
    color = color * (1.0 + pool * exp(-3.2 * dot(aside, aside)));
    let noise = dither(in.position.xy) / 255.0 * 0.5;
    let alpha = frame.background_top.a;
    let noisy = color.rgb + noise * alpha;
    return vec4f(noisy * noisy, alpha);
}
