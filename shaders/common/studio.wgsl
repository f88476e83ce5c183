// The studio lighting: a soft key light from the upper left of the viewer, a cool fill, a rim, and walls, so that
// even a mirror has something to reflect. Everything is a formula, so there is no environment image to load or to
// lose.

const PI: f32 = 3.14159265;

struct Light {
    // Direction towards the light, studio space.
    direction: vec3f,
    color: vec3f,
}

const LIGHT_COUNT: u32 = 3u;

fn studio_light(index: u32) -> Light {
    switch index {
        case 0u: { return Light(vec3f(-0.4830, 0.7043, 0.5202), vec3f(1.02, 0.985, 0.93)); }
        case 1u: { return Light(vec3f(0.8290, 0.1660, 0.5341), vec3f(0.17, 0.20, 0.25)); }
        default: { return Light(vec3f(0.3900, 0.4680, -0.7930), vec3f(0.36, 0.38, 0.42)); }
    }
}

// The studio rotates about the vertical axis with the viewer.
fn studio_from_world(direction: vec3f) -> vec3f {
    let c = frame.studio.x;
    let s = frame.studio.y;
    return vec3f(c * direction.x - s * direction.z, direction.y, s * direction.x + c * direction.z);
}

// Number of lamps: the lights of the scene, or those of the studio if it has none.
fn lamp_count() -> u32 {
    let own = min(u32(frame.counts.x), LIGHTS);
    return select(LIGHT_COUNT, own, own > 0u);
}

// Cosines of the angles from its axis at which a spot light begins to fade, and at which it is dark.
const SPOT_INSIDE: f32 = 0.94;
const SPOT_OUTSIDE: f32 = 0.87;

// A lamp as it shines on a point of the scene.
fn lamp_at(index: u32, world: vec3f) -> Light {
    if frame.counts.x < 0.5 {
        return studio_light(index);
    }
    let lamp = frame.lights[index];
    if lamp.position.w < 0.5 {
        return Light(studio_from_world(-lamp.direction.xyz), lamp.color.rgb);
    }
    let away = lamp.position.xyz - world;
    let squared = max(dot(away, away), 1e-4);
    let towards = away * inverseSqrt(squared);
    var strength = 1.0 / squared;
    if lamp.position.w > 1.5 {
        strength *= smoothstep(SPOT_OUTSIDE, SPOT_INSIDE, dot(-towards, lamp.direction.xyz));
    }
    return Light(studio_from_world(towards), lamp.color.rgb * strength);
}

// Ambient light on a matte surface with this normal (studio space).
fn studio_ambient(normal: vec3f) -> vec3f {
    let above = vec3f(0.375, 0.395, 0.43);
    let below = vec3f(0.155, 0.148, 0.142);
    let side = 0.06 * max(normal.z, 0.0);
    return frame.counts.y * (mix(below, above, smoothstep(-1.0, 1.0, normal.y)) + side);
}

// Light of a soft box in direction `along`, blurred by roughness.
fn soft_box(along: vec3f, towards: vec3f, sharpness: f32, roughness: f32) -> f32 {
    let blurred = mix(sharpness, 2.0, sqrt(roughness));
    // Dividing by the width preserves the total light of the box.
    return exp(blurred * (dot(along, towards) - 1.0)) * (blurred + 2.0) / (sharpness + 2.0);
}

// Light that a surface reflects from direction `along` (studio space).
fn studio_reflection(along: vec3f, roughness: f32) -> vec3f {
    let blur = mix(0.08, 1.0, roughness);
    let walls = mix(vec3f(0.10, 0.097, 0.094), vec3f(0.34, 0.36, 0.40), smoothstep(-blur, blur, along.y));
    let ceiling = vec3f(0.42, 0.44, 0.47) * smoothstep(0.35 - blur, 0.75 + blur, along.y);
    if frame.counts.x > 0.5 {
        return frame.counts.y * (walls + ceiling);
    }
    let key = vec3f(3.4, 3.3, 3.1) * soft_box(along, studio_light(0u).direction, 22.0, roughness);
    let fill = vec3f(0.55, 0.62, 0.72) * soft_box(along, studio_light(1u).direction, 12.0, roughness);
    let rim = vec3f(1.1, 1.15, 1.25) * soft_box(along, studio_light(2u).direction, 16.0, roughness);
    return walls + ceiling + key + fill + rim;
}

// Share of the surroundings that a surface reflects (Karis' fit to the split-sum tables).
fn mirrored_share(f0: vec3f, roughness: f32, n_dot_v: f32) -> vec3f {
    let c0 = vec4f(-1.0, -0.0275, -0.572, 0.022);
    let c1 = vec4f(1.0, 0.0425, 1.04, -0.04);
    let r = roughness * c0 + c1;
    let a004 = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
    let ab = vec2f(-1.04, 1.04) * a004 + r.zw;
    return f0 * ab.x + ab.y;
}

// GGX specular highlight of one light, including the cosine, in units in which a white matte surface reflects 1.
fn highlight(normal: vec3f, view: vec3f, light: vec3f, f0: vec3f, roughness: f32) -> vec3f {
    let middle = normalize(view + light);
    let n_dot_l = max(dot(normal, light), 0.0);
    let n_dot_v = max(dot(normal, view), 1e-3);
    let n_dot_h = max(dot(normal, middle), 0.0);
    let v_dot_h = max(dot(view, middle), 0.0);
    // The lights are soft boxes, not points, so highlights are never sharper than this.
    let alpha = max(roughness * roughness, 0.05);
    let a2 = alpha * alpha;
    let d = n_dot_h * n_dot_h * (a2 - 1.0) + 1.0;
    let spread = a2 / (d * d);
    let k = alpha * 0.5;
    let shadowing = 0.25 / ((n_dot_l * (1.0 - k) + k) * (n_dot_v * (1.0 - k) + k));
    let fresnel = f0 + (1.0 - f0) * pow(1.0 - v_dot_h, 5.0);
    return fresnel * spread * shadowing * n_dot_l;
}
