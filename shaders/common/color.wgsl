// Color conversions. All shaders work in linear light; a texture view or the composite pass encodes.

fn luminance(color: vec3f) -> f32 {
    return dot(color, vec3f(0.2126, 0.7152, 0.0722));
}

// Encodes linear light with the sRGB curve.
fn srgb_encode(linear: vec3f) -> vec3f {
    let low = linear * 12.92;
    let high = 1.055 * pow(max(linear, vec3f(0.0)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, low, linear <= vec3f(0.0031308));
}

// Khronos' neutral tone mapping: colors below 0.8 are unchanged, highlights roll off to white.
fn tone_map(light: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let desaturation = 0.15;
    let least = min(light.r, min(light.g, light.b));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    var color = light - offset;
    let peak = max(color.r, max(color.g, color.b));
    if peak < start {
        return max(color, vec3f(0.0));
    }
    let rest = 1.0 - start;
    let new_peak = 1.0 - rest * rest / (peak + rest - start);
    color *= new_peak / peak;
    let white = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(color, vec3f(new_peak), white);
}

// Noise of -0.5..0.5 per pixel without a visible pattern: hides the steps of dark gradients.
fn dither(pixel: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715)))) - 0.5;
}
