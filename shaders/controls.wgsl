// Controls of the scene, over everything: lines of constant width on the screen, and faces.

// Rust twin: picture::pass::controls::ControlStyle
struct Style {
    colors: array<vec4f, 9>,
    // Half the width of a line, pixels.
    half_width: f32,
    // Pixels of a point.
    pixels: f32,
}

@group(1) @binding(0) var<uniform> style: Style;

// Rust twin: picture::gizmo::GizmoVertex
struct Corner {
    @location(0) position: vec3f,
    @location(1) role: u32,
    @location(2) opacity: f32,
}

struct Face {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) role: u32,
    @location(1) opacity: f32,
}

// Rust twin: picture::gizmo::LineInk. Bit 31 marks it, then 7 bits of width in quarters of a point, then sRGB.
fn is_ink(role: u32) -> bool {
    return (role >> 31u) == 1u;
}

fn half_width_of(role: u32) -> f32 {
    if is_ink(role) { return f32((role >> 24u) & 127u) / 8.0 * style.pixels; }
    return style.half_width;
}

fn color_of(role: u32) -> vec3f {
    if is_ink(role) {
        let c = vec3f(vec3u(role >> 16u, role >> 8u, role) & vec3u(255u)) / 255.0;
        return select(pow((c + 0.055) / 1.055, vec3f(2.4)), c / 12.92, c <= vec3f(0.04045));
    }
    return style.colors[min(role, 8u)].rgb;
}

// Clip-space position; never clipped by the near and far plane, because handles may be nearer than the whole scene.
fn seen(place: vec3f) -> vec4f {
    let clip = frame.clip_from_world * vec4f(place, 1.0);
    return vec4f(clip.xy, 0.5 * clip.w, clip.w);
}

@vertex
fn vs_fill(corner: Corner) -> Face {
    return Face(seen(corner.position), corner.role, corner.opacity);
}

@fragment
fn fs_fill(in: Face) -> @location(0) vec4f {
    return vec4f(display_color(color_of(in.role)) * in.opacity, in.opacity);
}

struct Ends {
    @location(0) from_position: vec3f,
    @location(1) from_role: u32,
    @location(2) from_opacity: f32,
    @location(3) to_position: vec3f,
    @location(4) to_role: u32,
    @location(5) to_opacity: f32,
}

struct Line {
    @builtin(position) position: vec4f,
    // Distance from the center line, pixels.
    @location(0) across: f32,
    @location(1) opacity: f32,
    @location(2) @interpolate(flat) role: u32,
    // Pixels from the start of the line, and its length in pixels.
    @location(3) @interpolate(linear) along: f32,
    @location(4) @interpolate(flat) length: f32,
}

@vertex
fn vs_line(@builtin(vertex_index) index: u32, ends: Ends) -> Line {
    let end = array(0.0, 1.0, 1.0, 0.0, 1.0, 0.0)[index];
    let side = array(-1.0, -1.0, 1.0, -1.0, 1.0, 1.0)[index];
    var a = frame.clip_from_world * vec4f(ends.from_position, 1.0);
    var b = frame.clip_from_world * vec4f(ends.to_position, 1.0);
    // Clips the part behind the camera.
    let least = 1e-4;
    if a.w < least && b.w < least {
        return Line(vec4f(0.0, 0.0, 2.0, 1.0), 0.0, 0.0, ends.from_role, 0.0, 0.0);
    }
    if a.w < least { a = mix(a, b, clamp((least - a.w) / max(b.w - a.w, 1e-9), 0.0, 1.0)); }
    if b.w < least { b = mix(b, a, clamp((least - b.w) / max(a.w - b.w, 1e-9), 0.0, 1.0)); }
    let pixel_a = a.xy / max(a.w, least) * frame.size.xy * 0.5;
    let pixel_b = b.xy / max(b.w, least) * frame.size.xy * 0.5;
    let along = pixel_b - pixel_a;
    let direction = along / max(length(along), 1e-6);
    let reach = half_width_of(ends.from_role) + 1.0;
    // Drawn lines have round ends, so that the pieces of a curve join.
    let beyond = select(0.0, (end * 2.0 - 1.0) * reach, is_ink(ends.from_role));
    let aside = vec2f(-direction.y, direction.x) * side * reach + direction * beyond;
    let shift = aside * 2.0 * frame.size.zw;
    var position = mix(a, b, end);
    position = vec4f(position.xy + shift * position.w, 0.5 * position.w, position.w);
    let opacity = mix(ends.from_opacity, ends.to_opacity, end);
    let whole = length(along);
    return Line(position, side * reach, opacity, ends.from_role, whole * end + beyond, whole);
}

@fragment
fn fs_line(in: Line) -> @location(0) vec4f {
    let past = max(max(-in.along, in.along - in.length), 0.0);
    let covered = clamp(half_width_of(in.role) + 0.5 - length(vec2f(in.across, past)), 0.0, 1.0);
    let alpha = covered * in.opacity;
    return vec4f(display_color(color_of(in.role)) * alpha, alpha);
}
