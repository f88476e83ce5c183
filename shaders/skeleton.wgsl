// Bones: one unit mesh, instanced once per bone.

struct Corner {
    // x and z: across, in radii. y: along, in lengths. w: along, in radii.
    @location(0) place: vec4f,
    @location(1) normal: vec3f,
    // Distance from the three edges of a flat face; all 1 on round shapes.
    @location(2) edges: vec3f,
}

// Rust twin: picture::shape::BoneInstance
struct Bone {
    @location(3) head: vec3f,
    @location(4) radius: f32,
    @location(5) tail: vec3f,
    // 0 plain, 1 selected, 2 hovered, 3 both.
    @location(6) state: u32,
    // Unit vector across the bone.
    @location(7) side: vec3f,
    // Opacity: 1 for a bone that moves a mesh, less for any other.
    @location(8) strength: f32,
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) world: vec3f,
    @location(2) edges: vec3f,
    @location(3) @interpolate(flat) state: u32,
    @location(4) @interpolate(flat) strength: f32,
}

fn bone_color(state: u32) -> vec3f {
    switch state {
        case 0u: { return frame.bone_color.rgb; }
        case 1u: { return frame.accent.rgb; }
        case 2u: { return mix(frame.bone_color.rgb, frame.accent.rgb, 0.45); }
        default: { return mix(frame.accent.rgb, vec3f(1.0, 0.9, 0.8), 0.4); }
    }
}

fn placed(corner: Corner, bone: Bone) -> Surface {
    let along = bone.tail - bone.head;
    let length_along = max(length(along), 1e-12);
    let y = along / length_along;
    let x = bone.side;
    let z = cross(x, y);
    let local = vec3f(
        corner.place.x * bone.radius,
        corner.place.y * length_along + corner.place.w * bone.radius,
        corner.place.z * bone.radius);
    let world = bone.head + x * local.x + y * local.y + z * local.z;
    let normal = x * corner.normal.x + y * corner.normal.y + z * corner.normal.z;
    return Surface(
        frame.clip_from_world * vec4f(world, 1.0), normal, world, corner.edges, bone.state, bone.strength);
}

@vertex
fn vs_bone(corner: Corner, bone: Bone) -> Surface {
    return placed(corner, bone);
}

@fragment
fn fs_bone(in: Surface) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    let view = towards_viewer(in.world);
    let facing = max(dot(normal, view), 0.0);
    let studio = studio_from_world(normal);
    let key = max(dot(studio, studio_light(0u).direction), 0.0);
    var color = bone_color(in.state);
    color *= 0.34 + 0.62 * key + 0.26 * facing + 0.10 * max(normal.y, 0.0);
    // A fine dark line along the edges of flat faces, where they are large enough. Round shapes have none.
    let width = fwidth(in.edges);
    let near = in.edges / max(width, vec3f(1e-6));
    let distance_to_edge = min(near.x, min(near.y, near.z));
    let line = 1.0 - smoothstep(0.3, 1.3, distance_to_edge);
    let large = 1.0 - smoothstep(0.06, 0.22, max(width.x, max(width.y, width.z)));
    let flat_face = f32(any(in.edges < vec3f(0.99)));
    color = mix(color, bone_color(in.state) * 0.16, line * large * flat_face * 0.7);
    return vec4f(display_color(color), 1.0);
}

// A dark rim of constant width around every bone, so that it contrasts with light and dark surfaces: the same mesh,
// slightly larger on the screen, of which only the far side is drawn.
@vertex
fn vs_outline(corner: Corner, bone: Bone) -> Surface {
    var surface = placed(corner, bone);
    let middle = mix(bone.head, bone.tail, 0.5 * f32(corner.place.w == 0.0));
    let center = frame.clip_from_world * vec4f(middle, 1.0);
    let here = surface.position.xy / max(surface.position.w, 1e-6);
    let outwards = (here - center.xy / max(center.w, 1e-6)) * frame.size.xy;
    let width = select(1.3, 1.9, bone.state != 0u);
    let shift = outwards / max(length(outwards), 1e-3) * width * 2.0 * frame.size.zw;
    surface.position.x += shift.x * surface.position.w;
    surface.position.y += shift.y * surface.position.w;
    return surface;
}

@fragment
fn fs_outline(in: Surface) -> @location(0) vec4f {
    return vec4f(display_color(bone_color(in.state) * 0.035), 1.0);
}

struct Line {
    @builtin(position) position: vec4f,
    // -1..1 across the line.
    @location(0) across: f32,
    @location(1) @interpolate(flat) state: u32,
    @location(2) @interpolate(flat) strength: f32,
    @location(3) @interpolate(flat) half_width: f32,
}

// A line of constant width in pixels from head to tail: six vertices without a vertex buffer of its own.
@vertex
fn vs_line(@builtin(vertex_index) index: u32, bone: Bone) -> Line {
    let end = array(0.0, 1.0, 1.0, 0.0, 1.0, 0.0)[index];
    let side = array(-1.0, -1.0, 1.0, -1.0, 1.0, 1.0)[index];
    var a = frame.clip_from_world * vec4f(bone.head, 1.0);
    var b = frame.clip_from_world * vec4f(bone.tail, 1.0);
    // Clips the part behind the camera.
    let least = 1e-4;
    if a.w < least { a = mix(a, b, clamp((least - a.w) / max(b.w - a.w, 1e-9), 0.0, 1.0)); }
    if b.w < least { b = mix(b, a, clamp((least - b.w) / max(a.w - b.w, 1e-9), 0.0, 1.0)); }
    let pixel_a = a.xy / max(a.w, least) * frame.size.xy * 0.5;
    let pixel_b = b.xy / max(b.w, least) * frame.size.xy * 0.5;
    let along = pixel_b - pixel_a;
    let direction = along / max(length(along), 1e-6);
    let half_width = select(0.8, 1.4, bone.state != 0u);
    let shift = vec2f(-direction.y, direction.x) * side * (half_width + 1.0) * 2.0 * frame.size.zw;
    var position = mix(a, b, end);
    position.x += shift.x * position.w;
    position.y += shift.y * position.w;
    return Line(position, side * (half_width + 1.0), bone.state, bone.strength, half_width);
}

@fragment
fn fs_line(in: Line) -> @location(0) vec4f {
    let covered = clamp(in.half_width + 0.5 - abs(in.across), 0.0, 1.0);
    let alpha = covered * in.strength;
    return vec4f(display_color(bone_color(in.state)) * alpha, alpha);
}
