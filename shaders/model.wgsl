// Surfaces: morphed, skinned, lit. Where lamps cast shadows, `shaded_lamp` is that of `shaders/common/shadowed.wgsl`.

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec4f,
    @location(4) color: vec4f,
}

@vertex
fn vs_model(in: VertexIn, @builtin(vertex_index) index: u32) -> Surface {
    let posed = posed_vertex(in, index);
    return Surface(
        frame.clip_from_world * vec4f(posed.position, 1.0),
        posed.position, posed.normal, posed.tangent, in.uv, in.color);
}

// The normal perturbed by the normal map. Without tangents in the file they are derived from the screen-space
// derivatives of position and texture coordinates.
fn mapped_normal(in: Surface, smooth_normal: vec3f) -> vec3f {
    let at = coordinates(material.normal_use, in.uv);
    var texel = textureSample(normal_texture, normal_sampler, at).xyz * 2.0 - 1.0;
    texel = vec3f(texel.xy * material.normal_scale, texel.z);
    let dp_x = dpdx(in.world);
    let dp_y = dpdy(in.world);
    let dt_x = dpdx(at);
    let dt_y = dpdy(at);
    var tangent = in.tangent.xyz;
    var bitangent = cross(smooth_normal, tangent) * in.tangent.w;
    if dot(tangent, tangent) < 1e-12 {
        let across = cross(dp_y, smooth_normal);
        let up = cross(smooth_normal, dp_x);
        // The screen's y axis points down, so both derivatives are inverted on front faces.
        let turn = select(-1.0, 1.0, dot(across, dp_x) >= 0.0);
        tangent = turn * (across * dt_x.x + up * dt_y.x);
        // Texture coordinates increase downwards, the map's +Y points up.
        bitangent = -turn * (across * dt_x.y + up * dt_y.y);
        let longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
        if longest < 1e-24 {
            return smooth_normal;
        }
        tangent *= inverseSqrt(longest);
        bitangent *= inverseSqrt(longest);
    } else {
        tangent = normalize(tangent);
        bitangent = normalize(bitangent);
    }
    let mapped = tangent * texel.x + bitangent * texel.y + smooth_normal * texel.z;
    if dot(mapped, mapped) < 1e-12 {
        return smooth_normal;
    }
    return normalize(mapped);
}

// Keeps white surfaces below the white of the screen, so that their shape stays visible.
const EXPOSURE: f32 = 0.76;

// `form` is the normal of the surface without its normal map. With `thin`, this share of the light on the far side passes through: wings,
// leaves, cloth.
fn lit_metallic(
    base: vec3f, metallic: f32, roughness: f32, normal: vec3f, form: vec3f, world: vec3f, view: vec3f,
    occlusion: f32, thin: f32,
) -> vec3f {
    let diffuse = base * (1.0 - metallic);
    let f0 = mix(vec3f(0.04), base, metallic);
    let n_dot_v = clamp(dot(normal, view), 1e-3, 1.0);
    let studio_normal = studio_from_world(normal);
    let studio_view = studio_from_world(view);
    let ambient = mix(studio_ambient(studio_normal), studio_ambient(-studio_normal), 0.5 * thin);
    var light = diffuse * ambient * occlusion;
    for (var index = 0u; index < lamp_count(); index++) {
        let lamp = shaded_lamp(index, world, form);
        let facing = dot(studio_normal, lamp.direction);
        light += diffuse * lamp.color * max(facing, -facing * thin);
        light += lamp.color * highlight(studio_normal, studio_view, lamp.direction, f0, roughness);
    }
    let along = reflect(-studio_view, studio_normal);
    let share = mirrored_share(f0, roughness, n_dot_v);
    // Occluded areas have no reflections either.
    let open = mix(1.0, occlusion, 0.8);
    return light + studio_reflection(along, roughness) * share * open;
}

// Phong lighting as in thesis §2.1.6.2: ambient, diffuse, and a highlight around the reflected light direction.
fn lit_phong(base: vec3f, normal: vec3f, form: vec3f, world: vec3f, view: vec3f, occlusion: f32) -> vec3f {
    let studio_normal = studio_from_world(normal);
    let studio_view = studio_from_world(view);
    var light = base * material.phong_ambient.rgb * studio_ambient(studio_normal) * 2.0 * occlusion;
    for (var index = 0u; index < lamp_count(); index++) {
        let lamp = shaded_lamp(index, world, form);
        let n_dot_l = max(dot(studio_normal, lamp.direction), 0.0);
        light += base * material.phong_diffuse.rgb * lamp.color * n_dot_l;
        let mirrored = reflect(-lamp.direction, studio_normal);
        let cosine = max(dot(mirrored, studio_view), 0.0);
        if n_dot_l > 0.0 {
            light += material.phong_specular.rgb * lamp.color * pow(cosine, max(material.phong_specular.w, 1.0));
        }
    }
    return light;
}

// Whether a pixel has only one sample.
override single_sample: bool = false;

// Whether the target takes light before the tone map, which is applied to the mean of sub-frames.
override linear_light: bool = false;

// The light of a surface in the target.
fn exposed(light: vec3f) -> vec3f {
    if linear_light {
        return light;
    }
    return tone_map(light);
}

// Coverage of the texel, with an edge one pixel wide at the cutoff of a masked surface.
fn mask_coverage(alpha: f32, cut: f32) -> f32 {
    return clamp((alpha - cut) / max(fwidth(alpha), 1e-4) + 0.5, 0.0, 1.0);
}

@fragment
fn fs_model(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    var base = material.base_color * in.color;
    if has_texture(material.base_color_use) {
        base *= textureSample(
            base_color_texture, base_color_sampler, coordinates(material.base_color_use, in.uv));
    }
    let covered = mask_coverage(base.a, material.emissive.w);

    var metallic = material.metallic;
    var roughness = material.roughness;
    if has_texture(material.metallic_roughness_use) {
        let texel = textureSample(
            metallic_roughness_texture, metallic_roughness_sampler,
            coordinates(material.metallic_roughness_use, in.uv));
        roughness *= texel.g;
        metallic *= texel.b;
    }
    var smooth_normal = in.normal * inverseSqrt(max(dot(in.normal, in.normal), 1e-24));
    var normal = smooth_normal;
    if has_texture(material.normal_use) {
        normal = mapped_normal(in, smooth_normal);
    }
    // Flipped on back faces, so that both sides of a leaf are lit.
    if !front {
        normal = -normal;
        smooth_normal = -smooth_normal;
    }
    var occlusion = 1.0;
    if has_texture(material.occlusion_use) {
        let texel = textureSample(
            occlusion_texture, occlusion_sampler, coordinates(material.occlusion_use, in.uv)).r;
        occlusion = 1.0 + material.occlusion_strength * (texel - 1.0);
    }
    var emissive = material.emissive.rgb;
    if has_texture(material.emissive_use) {
        emissive *= textureSample(
            emissive_texture, emissive_sampler, coordinates(material.emissive_use, in.uv)).rgb;
    }

    let view = towards_viewer(in.world);
    var alpha = 1.0;
    if material.alpha_mode == 1u { alpha = covered; }
    if material.alpha_mode == 2u { alpha = base.a; }

    if frame.studio.z > 1.5 {
        return shown(base.rgb, alpha);
    }
    if frame.studio.z > 0.5 {
        let gray = vec3f(0.50, 0.485, 0.47);
        let clay = lit_metallic(gray, 0.0, 0.62, smooth_normal, smooth_normal, in.world, view, 1.0, 0.0);
        return shown(exposed(clay), alpha);
    }
    if material.unlit == 1u {
        return shown(display_color(base.rgb), alpha);
    }
    var light: vec3f;
    if material.use_phong == 1u {
        light = lit_phong(base.rgb, normal, smooth_normal, in.world, view, occlusion);
    } else {
        // Transparent surfaces also transmit light.
        let thin = select(0.0, 0.8, material.alpha_mode == 2u);
        light = lit_metallic(
            base.rgb, metallic, clamp(roughness, 0.045, 1.0), normal, smooth_normal, in.world, view, occlusion, thin);
    }
    return shown(exposed(EXPOSURE * (light + emissive)), alpha);
}

// Blended colors are premultiplied by alpha; a mask's alpha only discards samples: in the fixed part of the pipeline where
// a pixel has several, here where it has one. A sub-frame discards up to a threshold of its own, so that their mean has the mask's alpha.
fn shown(color: vec3f, alpha: f32) -> vec4f {
    if linear_light && material.alpha_mode == 1u {
        if alpha <= frame.sampling.y {
            discard;
        }
        return vec4f(color, 1.0);
    }
    if single_sample && material.alpha_mode == 1u && alpha < 0.5 {
        discard;
    }
    if material.alpha_mode == 2u {
        return vec4f(color * alpha, alpha);
    }
    return vec4f(color, alpha);
}
