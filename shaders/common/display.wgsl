// Colors of the display in the target of the scene, whatever it takes.

// What is drawn with a color of the display: where the target takes light, that of which the tone map makes this color. Without lighting
// there is no tone map.
fn display_color(color: vec3f) -> vec3f {
    if frame.sampling.x < 0.5 || frame.studio.z > 1.5 {
        return color;
    }
    return light_of(color);
}
