// Shadows of lamps: the maps of depth that `shaders/shadow.wgsl` draws, read with soft edges.
//
// Technique: cascaded shadow maps of a sun and one map of each spot light, with reversed depth. A point is lifted along its normal by some texels
// before it is looked up, in addition to the slope bias of the maps. The filter is a tent 5 texels wide, exact for each texel, of nine bilinear
// comparisons.
// Sources: Dimitrov, "Cascaded Shadow Maps", 2007; Holbert, "Saying Goodbye to Shadow Acne", 2011 (normal offset); Castano, "Shadow Mapping
// Summary", 2013 (tents of bilinear comparisons).
// Limits: one sun and four spot lights, no point lights. An edge is as soft far from what casts the shadow as near to it; in a frame of many
// sub-frames those of a sun are softer far away, because each sub-frame has maps of another point of the sun.

// Rust twin: picture::shadow::CASCADES
const CASCADES: u32 = 3u;
// Rust twin: picture::shadow::SPOT_SHADOWS
const SPOT_SHADOWS: u32 = 4u;

// Rust twin: picture::shadow::maps::ShadowUniform
struct Shadows {
    // Scene space to the place in the map, 0..1 with y downwards, and depth.
    sun: array<mat4x4f, CASCADES>,
    spots: array<mat4x4f, SPOT_SHADOWS>,
    // Scene units per texel of each cascade; w: per texel and unit of distance of the spot lights.
    texels: vec4f,
    // Number of cascades; 1 where the key light of the studio casts their shadow; sides of a map of the sun and of a spot light, texels.
    counts: vec4f,
}

@group(3) @binding(0) var<uniform> shadows: Shadows;
@group(3) @binding(1) var sun_map: texture_depth_2d_array;
@group(3) @binding(2) var spot_map: texture_depth_2d_array;
@group(3) @binding(3) var shadow_sampler: sampler_comparison;

// Texels by which a point of a surface that the light grazes is lifted along its normal. More would move the edges of shadows, less would
// leave stripes on slopes.
const LIFT: f32 = 2.0;
// Texels at the border of a map that a filter must not reach. Rust twin: picture::shadow::frame::BORDER
const BORDER: f32 = 4.0;
// Part of half a map in which a cascade fades into the next one.
const FADE: f32 = 0.08;

// Integral of a tent of width 5 and area 1 up to `x` from its middle.
fn tent_below(x: vec2f) -> vec2f {
    let u = clamp(x / 2.5, vec2f(-1.0), vec2f(1.0));
    return 0.5 + u - 0.5 * u * abs(u);
}

// Light at three places of a row of a map.
fn row_light(map: texture_depth_2d_array, layer: u32, x: vec3f, y: f32, depth: f32, weights: vec3f) -> f32 {
    let light = vec3f(
        textureSampleCompareLevel(map, shadow_sampler, vec2f(x.x, y), layer, depth),
        textureSampleCompareLevel(map, shadow_sampler, vec2f(x.y, y), layer, depth),
        textureSampleCompareLevel(map, shadow_sampler, vec2f(x.z, y), layer, depth));
    return dot(light, weights);
}

// Share of the light that arrives around a place of a map with `side` texels, 0..1.
fn filtered_light(map: texture_depth_2d_array, layer: u32, at: vec2f, depth: f32, side: f32) -> f32 {
    // The tent touches six texels in a row from `first` on; a bilinear comparison weighs two of them.
    let center = at * side;
    let first = floor(center - 2.5);
    let start = first - center;
    let below_1 = tent_below(start + 1.0);
    let below_2 = tent_below(start + 2.0);
    let below_3 = tent_below(start + 3.0);
    let below_4 = tent_below(start + 4.0);
    let below_5 = tent_below(start + 5.0);
    let weight_0 = below_2;
    let weight_1 = below_4 - below_2;
    let weight_2 = 1.0 - below_4;
    let least = vec2f(1e-6);
    let place_0 = (first + 0.5 + (below_2 - below_1) / max(weight_0, least)) / side;
    let place_1 = (first + 2.5 + (below_4 - below_3) / max(weight_1, least)) / side;
    let place_2 = (first + 4.5 + (1.0 - below_5) / max(weight_2, least)) / side;
    let x = vec3f(place_0.x, place_1.x, place_2.x);
    let weights = vec3f(weight_0.x, weight_1.x, weight_2.x);
    return weight_0.y * row_light(map, layer, x, place_0.y, depth, weights)
        + weight_1.y * row_light(map, layer, x, place_1.y, depth, weights)
        + weight_2.y * row_light(map, layer, x, place_2.y, depth, weights);
}

// Share of the light of the sun at a point, 0..1; `lift` is a distance in texels.
fn sun_share(world: vec3f, lift: vec3f) -> f32 {
    let side = shadows.counts.z;
    var light = 0.0;
    // Weight that the cascades so far leave to the next one.
    var rest = 1.0;
    for (var cascade = 0u; cascade < min(u32(shadows.counts.x), CASCADES); cascade++) {
        let lifted = vec4f(world + lift * shadows.texels[cascade], 1.0);
        let at = (shadows.sun[cascade] * lifted).xyz;
        let aside = abs(2.0 * at.xy - 1.0);
        let inside = 1.0 - max(aside.x, aside.y) - 2.0 * BORDER / side;
        if inside > 0.0 {
            let share = rest * min(inside / FADE, 1.0);
            // What casts shadows is nearer than depth 0; ground behind that is not.
            light += share * filtered_light(sun_map, cascade, at.xy, max(at.z, 0.0), side);
            rest -= share;
        }
        if rest <= 0.0 {
            break;
        }
    }
    // Far away there are no shadows.
    return light + rest;
}

// Share of the light of a spot light at a point, 0..1.
fn spot_share(spot: u32, world: vec3f, lift: vec3f, away: f32) -> f32 {
    let side = shadows.counts.w;
    let clip = shadows.spots[spot] * vec4f(world + lift * shadows.texels.w * away, 1.0);
    if clip.w <= 0.0 {
        return 1.0;
    }
    let at = clip.xyz / clip.w;
    let aside = abs(2.0 * at.xy - 1.0);
    if max(aside.x, aside.y) > 1.0 - 2.0 * BORDER / side {
        return 1.0;
    }
    return filtered_light(spot_map, spot, at.xy, at.z, side);
}

// Share of the light of a lamp at a point of a surface with this normal, 0..1; `towards` is the direction to the lamp, studio space.
fn lamp_share(index: u32, world: vec3f, normal: vec3f, towards: vec3f) -> f32 {
    // 0 without a shadow, 1 for the sun, 2 and more for spot lights.
    var slot = 0u;
    if frame.counts.x < 0.5 {
        slot = select(0u, 1u, index == 0u && shadows.counts.y > 0.5);
    } else {
        slot = u32(frame.lights[index].direction.w);
    }
    if slot == 0u {
        return 1.0;
    }
    let facing = dot(studio_from_world(normal), towards);
    // To the side of the lamp, also of a surface that faces away from it.
    let grazing = sqrt(max(1.0 - facing * facing, 0.0)) * select(-1.0, 1.0, facing >= 0.0);
    let lift = LIFT * grazing * normal;
    if slot == 1u {
        return sun_share(world, lift);
    }
    return spot_share(slot - 2u, world, lift, distance(frame.lights[index].position.xyz, world));
}

// A lamp as it shines on a point of a surface with this normal.
fn shaded_lamp(index: u32, world: vec3f, normal: vec3f) -> Light {
    let lamp = lamp_at(index, world);
    return Light(lamp.direction, lamp.color * lamp_share(index, world, normal, lamp.direction));
}
