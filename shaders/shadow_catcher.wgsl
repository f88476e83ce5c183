// The ground as a catcher of shadows: darker by the light of lamps that does not reach it.
//
// Technique: the ratio of the light on a matte white ground with and without shadows, blended over what is there.
// Source: the shadow catchers of renderers, such as Blender's.
// Limits: the ground is a plane at one height; it reflects nothing, and shadows on it have no color.

struct Catcher {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
}

@vertex
fn vs_catcher(@builtin(vertex_index) index: u32) -> Catcher {
    // The same square as the grid's.
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let at = frame.grid.xy + corner * frame.grid.z;
    let world = vec3f(at.x, frame.counts.w, at.y);
    var clip = frame.clip_from_world * vec4f(world, 1.0);
    // A little farther away, so that a floor at the same height hides it: that has its own shadows.
    clip.z *= 0.9999;
    return Catcher(clip, world);
}

@fragment
fn fs_catcher(in: Catcher) -> @location(0) vec4f {
    let up = vec3f(0.0, 1.0, 0.0);
    var whole = luminance(studio_ambient(up));
    var left = whole;
    for (var index = 0u; index < lamp_count(); index++) {
        let lamp = lamp_at(index, in.world);
        let light = luminance(lamp.color) * max(lamp.direction.y, 0.0);
        whole += light;
        if light > 0.0 {
            left += light * lamp_share(index, in.world, up, lamp.direction);
        }
    }
    return vec4f(0.0, 0.0, 0.0, 1.0 - left / max(whole, 1e-6));
}
