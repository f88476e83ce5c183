// Skin once: morphed and skinned vertices, written to a buffer that several passes read.
//
// Technique: one invocation per vertex of an instance, with the functions of the vertex shaders, so that both ways give the same bits. Instances of
// the same part of a mesh share a dispatch: x counts vertices, y instances.
// Source: anim::skin, as `shaders/common/pose.wgsl`.
// Limits: worth its memory only where more than one pass draws the vertices; picture::model::skin decides that.

// Uniform of a dispatch. Rust twin: picture::model::skin::SkinPart
struct SkinPart {
    // Index of its first instance in `jobs`.
    first: u32,
    // Number of vertices of each instance.
    vertices: u32,
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(0) var<uniform> part: SkinPart;
@group(0) @binding(1) var<storage, read> jobs: array<Draw>;
@group(0) @binding(2) var<storage, read_write> posed_vertices: array<PosedVertex>;
// The vertices of the part as 30 words each. Rust twin: picture::model::geometry::GpuVertex
@group(2) @binding(0) var<storage, read> vertex_words: array<u32>;

const VERTEX_WORDS: u32 = 30u;

fn number(at: u32) -> f32 {
    return bitcast<f32>(vertex_words[at]);
}

fn numbers(at: u32) -> vec4f {
    return vec4f(number(at), number(at + 1u), number(at + 2u), number(at + 3u));
}

// Four numbers of 16 bits.
fn indices(at: u32) -> vec4u {
    let low = vertex_words[at];
    let high = vertex_words[at + 1u];
    return vec4u(low & 0xffffu, low >> 16u, high & 0xffffu, high >> 16u);
}

@compute @workgroup_size(64)
fn cs_skin(@builtin(global_invocation_id) at: vec3u) {
    if at.x >= part.vertices {
        return;
    }
    let draw = jobs[part.first + at.y];
    let first = at.x * VERTEX_WORDS;
    let start = Posed(numbers(first).xyz, numbers(first + 3u).xyz, numbers(first + 6u));
    let matrix = blended_matrix(
        draw, indices(first + 18u), indices(first + 20u), numbers(first + 22u), numbers(first + 26u));
    let found = moved(matrix, morphed(draw, start, at.x));
    posed_vertices[draw.posed + at.x] = PosedVertex(
        found.position.x, found.position.y, found.position.z,
        found.normal.x, found.normal.y, found.normal.z,
        found.tangent.x, found.tangent.y, found.tangent.z, found.tangent.w);
}
