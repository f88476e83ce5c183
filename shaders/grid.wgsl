// The ground: the contact shadow, and a grid of lines about one pixel wide, two densities that blend into each other, fading with distance.

struct Ground {
    @builtin(position) position: vec4f,
    // Offset from the grid's center, scene units.
    @location(0) offset: vec2f,
    @location(1) world: vec2f,
}

@vertex
fn vs_grid(@builtin(vertex_index) index: u32) -> Ground {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let offset = corner * frame.grid.z;
    let world = frame.grid.xy + offset;
    return Ground(frame.clip_from_world * vec4f(world.x, frame.counts.w, world.y, 1.0), offset, world);
}

// Coverage by lines every `step` units, 0..1; `width` in pixels.
fn lines(world: vec2f, footprint: vec2f, step: f32, width: f32) -> f32 {
    let cell = abs(fract(world / step - 0.5) - 0.5) * step;
    let covered = clamp(width * 0.5 + 0.5 - cell / footprint, vec2f(0.0), vec2f(1.0));
    // Lines only a few pixels apart would flicker, so they fade out.
    let dense = clamp((step / footprint - 3.0) / 9.0, vec2f(0.0), vec2f(1.0));
    let strength = covered * dense;
    return max(strength.x, strength.y);
}

// Share of the light that parts near the ground keep away from it, 0..1.
fn contact_shadow(world: vec2f) -> f32 {
    var light = 1.0;
    for (var index = 0u; index < min(u32(frame.counts.z), SPOTS); index++) {
        let spot = frame.contact[index];
        let away = length(world - spot.xy) / max(spot.z, 1e-9);
        let inside = clamp(1.0 - away * away, 0.0, 1.0);
        light *= 1.0 - spot.w * inside * inside;
    }
    return 1.0 - light;
}

@fragment
fn fs_grid(in: Ground) -> @location(0) vec4f {
    let footprint = max(fwidth(in.world), vec2f(1e-9));
    let fine = frame.grid.w;
    // Fade-in of the fine lines: 1 when they have just appeared, 0 when they are about to become the coarse ones.
    let appearing = frame.grid_color.w;
    let edge = length(in.offset) / frame.grid.z;
    let fade = pow(clamp(1.0 - edge, 0.0, 1.0), 2.2);
    let glance = abs(towards_viewer(vec3f(in.world.x, frame.counts.w, in.world.y)).y);
    let grazing = smoothstep(0.0, 0.16, glance);

    let small = lines(in.world, footprint, fine, 1.0) * 0.11 * appearing;
    let large = lines(in.world, footprint, fine * 10.0, 1.0) * mix(0.26, 0.11, 1.0 - appearing);
    let larger = lines(in.world, footprint, fine * 100.0, 1.0) * 0.26;
    var strength = max(max(small, large), larger);
    var color = frame.grid_color.rgb;

    let axis = clamp(1.1 - abs(in.world) / footprint, vec2f(0.0), vec2f(1.0));
    // The line along X is where z is 0.
    if axis.y > 0.0 {
        color = mix(color, vec3f(0.58, 0.11, 0.12), axis.y);
        strength = max(strength, axis.y * 0.5);
    }
    if axis.x > 0.0 {
        color = mix(color, vec3f(0.10, 0.22, 0.62), axis.x);
        strength = max(strength, axis.x * 0.5);
    }
    let alpha = strength * fade * grazing * frame.studio.w;
    // The shadow is below the lines.
    let shadow = contact_shadow(in.world);
    return vec4f(display_color(color) * alpha, 1.0 - (1.0 - alpha) * (1.0 - shadow));
}
