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

// Largest color of the display whose light before the tone map is still moderate: 3.4.
const BRIGHTEST: f32 = 0.98;

// Light that the tone map turns into this color: its inverse. The tone map makes bright light paler, so it never gives a bright pure color:
// that becomes as bright as the tone map gives it with this hue, at least 0.85.
fn light_of(color: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let rest = 1.0 - start;
    let desaturation = 0.15;
    let brightest = max(color.r, max(color.g, color.b));
    let share = min(color.r, min(color.g, color.b)) / max(brightest, 1e-9);
    let palest = clamp(share + 0.008, 0.008, 0.95);
    // Where the distance between light and color makes it that pale.
    let span = palest / (desaturation * (1.0 - palest)) + 2.0 * rest;
    let reached = 1.0 - 2.0 * rest * rest / (span + sqrt(span * span - 4.0 * rest * rest));
    let peak = min(brightest, min(reached, BRIGHTEST));
    var light = color * (peak / max(brightest, 1e-9));
    if peak > start {
        let old_peak = rest * rest / (1.0 - peak) + start - rest;
        let white = 1.0 - 1.0 / (desaturation * (old_peak - peak) + 1.0);
        light = max((light - peak * white) / (1.0 - white) * (old_peak / peak), vec3f(0.0));
    }
    let least = min(light.r, min(light.g, light.b));
    return light + select(0.04, 0.4 * sqrt(max(least, 0.0)) - least, least < 0.04);
}

// Noise of -0.5..0.5 per pixel without a visible pattern: hides the steps of dark gradients.
fn dither(pixel: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715)))) - 0.5;
}
