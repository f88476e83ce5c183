// Maps of shadows: the depth of surfaces as a lamp sees them.
//
// Technique: surfaces are drawn from both sides, with a slope bias; masked ones have a fragment stage that cuts their holes, and transparent ones
// cast the shadow of what is more than half opaque.
// Source: as `shaders/common/shadowed.wgsl`, which reads the maps.
// Limits: a shadow has no color, and a pane of thin glass casts none.

struct LampView {
    clip_from_world: mat4x4f,
}

@group(0) @binding(0) var<uniform> lamp_view: LampView;

@vertex
fn vs_caster(in: VertexIn, @builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return lamp_view.clip_from_world * vec4f(posed_vertex(in, index).position, 1.0);
}

struct Masked {
    @builtin(position) position: vec4f,
    @location(0) uv: vec4f,
    @location(1) alpha: f32,
}

@vertex
fn vs_masked(in: VertexIn, @builtin(vertex_index) index: u32) -> Masked {
    let clip = lamp_view.clip_from_world * vec4f(posed_vertex(in, index).position, 1.0);
    return Masked(clip, in.uv, in.color.a);
}

@fragment
fn fs_masked(in: Masked) {
    var alpha = material.base_color.a * in.alpha;
    if has_texture(material.base_color_use) {
        alpha *= textureSample(
            base_color_texture, base_color_sampler, coordinates(material.base_color_use, in.uv)).a;
    }
    let cut = select(material.emissive.w, 0.5, material.alpha_mode == 2u);
    if alpha < cut {
        discard;
    }
}
