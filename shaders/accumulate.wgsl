// A frame as the mean of its sub-frames: added, divided, tone-mapped and encoded once.
//
// Technique: the accumulation buffer (Haeberli and Akeley, SIGGRAPH 1990). Every sub-frame is drawn with a position in the pixel, a point of
// the lens, a time and a point of each light of its own, in light before the tone map; equal weights, because positions are drawn from the
// pixel filter. So edges, motion, lens and shadows are exact in the limit, without anything kept from frame to frame.
// Limits: all pixels have the same points, so few sub-frames show as steps in wide blurs, not as noise. What is drawn under the scene is in
// colors of the display: it is no light, and lies under the scene after the tone map. A straight alpha cannot hold light without a surface.

// Rust twin: picture::accumulation::sum::DevelopUniform
struct Develop {
    // 1 divided by the number of sub-frames.
    weight: f32,
    // 1 where the tone map is applied, 0 where colors are shown as they are.
    tone: f32,
    pad: vec2f,
}

@group(0) @binding(0) var sum: texture_2d<f32>;
// The sub-frame to add, and for developing what is drawn under the scene.
@group(0) @binding(1) var scene: texture_2d<f32>;
@group(0) @binding(2) var<uniform> develop: Develop;

// Largest number of a sub-frame: no pixel is lost to one that is infinite.
const MOST_LIGHT: f32 = 65504.0;

@vertex
fn vs_accumulate(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

fn sub_frame_at(pixel: vec2i) -> vec4f {
    return min(max(textureLoad(scene, pixel, 0), vec4f(0.0)), vec4f(MOST_LIGHT));
}

@fragment
fn fs_first(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return sub_frame_at(vec2i(position.xy));
}

@fragment
fn fs_add(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    return textureLoad(sum, pixel, 0) + sub_frame_at(pixel);
}

// The mean of the sub-frames, multiplied by alpha.
fn mean_at(pixel: vec2i) -> vec4f {
    let mean = textureLoad(sum, pixel, 0) * develop.weight;
    return vec4f(mean.rgb, min(mean.a, 1.0));
}

// The color of the mean, multiplied by the part of the pixel that it takes. A surface takes what it covers, so its edges are exact; light of
// more than white takes more, so that the trace of a highlight is bright.
fn developed(mean: vec4f) -> vec3f {
    let peak = max(mean.r, max(mean.g, mean.b));
    let taken = max(mean.a, min(peak, 1.0));
    if taken <= 0.0 {
        return vec3f(0.0);
    }
    var color = mean.rgb / taken;
    if develop.tone > 0.5 {
        color = tone_map(color);
    }
    return min(color, vec3f(1.0)) * taken;
}

// The image, sRGB with straight alpha.
@fragment
fn fs_develop(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let mean = mean_at(pixel);
    let below = textureLoad(scene, pixel, 0);
    let alpha = mean.a + below.a * (1.0 - mean.a);
    if alpha < 0.5 / 255.0 {
        return vec4f(0.0);
    }
    let color = developed(mean) + below.rgb * (1.0 - mean.a);
    let encoded = srgb_encode(min(color / alpha, vec3f(1.0)));
    // What is below has this noise already.
    let noise = dither(position.xy) / 255.0 * 0.5 * mean.a;
    return vec4f(encoded + noise, alpha);
}

// The light of the image, multiplied by alpha.
@fragment
fn fs_linear(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let mean = mean_at(pixel);
    let below = textureLoad(scene, pixel, 0);
    var light = below.rgb / max(below.a, 1e-6);
    if develop.tone > 0.5 {
        light = light_of(light);
    }
    return vec4f(mean.rgb + light * below.a * (1.0 - mean.a), mean.a + below.a * (1.0 - mean.a));
}
