// Morphing and skinning on the device, equal to anim::skin.

// Affine matrix by rows. Rust twin: picture::uniform::Affine
struct Affine {
    x: vec4f,
    y: vec4f,
    z: vec4f,
}

@group(1) @binding(0) var<storage, read> palettes: array<Affine>;
@group(1) @binding(1) var<storage, read> weights: array<f32>;
// Nine values per vertex and target: position, normal, tangent; target after target.
@group(1) @binding(2) var<storage, read> deltas: array<f32>;

fn delta(at: u32) -> vec3f {
    return vec3f(deltas[at], deltas[at + 1u], deltas[at + 2u]);
}

fn morphed(draw: Draw, start: Posed, vertex: u32) -> Posed {
    var posed = start;
    for (var target_index = 0u; target_index < draw.morph_targets; target_index++) {
        let weight = weights[draw.morph_weights + target_index];
        if weight != 0.0 {
            let at = (target_index * draw.vertices + vertex) * 9u;
            posed.position += weight * delta(at);
            posed.normal += weight * delta(at + 3u);
            posed.tangent += vec4f(weight * delta(at + 6u), 0.0);
        }
    }
    return posed;
}

fn add_share(sum: Affine, matrix: Affine, weight: f32) -> Affine {
    return Affine(sum.x + weight * matrix.x, sum.y + weight * matrix.y, sum.z + weight * matrix.z);
}

fn blended_matrix(draw: Draw, joints0: vec4u, joints1: vec4u, weights0: vec4f, weights1: vec4f) -> Affine {
    if draw.influences == 0u {
        return palettes[draw.palette];
    }
    var sum = Affine(vec4f(0.0), vec4f(0.0), vec4f(0.0));
    sum = add_share(sum, palettes[draw.palette + joints0.x], weights0.x);
    sum = add_share(sum, palettes[draw.palette + joints0.y], weights0.y);
    sum = add_share(sum, palettes[draw.palette + joints0.z], weights0.z);
    sum = add_share(sum, palettes[draw.palette + joints0.w], weights0.w);
    if draw.influences > 4u {
        sum = add_share(sum, palettes[draw.palette + joints1.x], weights1.x);
        sum = add_share(sum, palettes[draw.palette + joints1.y], weights1.y);
        sum = add_share(sum, palettes[draw.palette + joints1.z], weights1.z);
        sum = add_share(sum, palettes[draw.palette + joints1.w], weights1.w);
    }
    return sum;
}

fn largest_of(v: vec3f) -> f32 {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

// Normalizes `v` whatever its length; returns `otherwise` for a vector without direction.
fn unit_or(v: vec3f, otherwise: vec3f) -> vec3f {
    let largest = largest_of(v);
    if !(largest > 0.0) {
        return otherwise;
    }
    let near_one = v / largest;
    return near_one * inverseSqrt(dot(near_one, near_one));
}

// Directions are normalized here and not after interpolation: otherwise longer ones would get more weight.
fn moved(matrix: Affine, start: Posed) -> Posed {
    let p = vec4f(start.position, 1.0);
    // Divided by the largest component, so that products of three neither underflow nor overflow.
    let largest = max(largest_of(matrix.x.xyz), max(largest_of(matrix.y.xyz), largest_of(matrix.z.xyz)));
    let scale = select(1.0, 1.0 / largest, largest > 0.0);
    let linear_x = matrix.x.xyz * scale;
    let linear_y = matrix.y.xyz * scale;
    let linear_z = matrix.z.xyz * scale;
    // Rows of the cofactor matrix: the inverse transpose times the determinant, whose sign is removed.
    let cofactor_x = cross(linear_y, linear_z);
    let cofactor_y = cross(linear_z, linear_x);
    let cofactor_z = cross(linear_x, linear_y);
    let side = select(-1.0, 1.0, dot(linear_x, cofactor_x) >= 0.0);
    let tilted = side * vec3f(
        dot(cofactor_x, start.normal), dot(cofactor_y, start.normal), dot(cofactor_z, start.normal));
    let along = vec3f(
        dot(linear_x, start.normal), dot(linear_y, start.normal), dot(linear_z, start.normal));
    let normal = unit_or(tilted, unit_or(along, unit_or(start.normal, vec3f(0.0, 1.0, 0.0))));
    let flat = start.tangent.xyz;
    let tangent = unit_or(vec3f(dot(linear_x, flat), dot(linear_y, flat), dot(linear_z, flat)), flat);
    // A mirroring matrix flips the bitangent.
    return Posed(
        vec3f(dot(matrix.x, p), dot(matrix.y, p), dot(matrix.z, p)),
        normal, vec4f(tangent, side * start.tangent.w));
}
