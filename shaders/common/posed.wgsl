// A vertex of a model whose position was computed before, once for all passes (`shaders/skin.wgsl`).

@group(1) @binding(0) var<storage, read> posed_vertices: array<PosedVertex>;

// The attributes that a pose leaves as they are; the others of a vertex are not read.
struct VertexIn {
    // Two texture coordinate sets.
    @location(3) uv: vec4f,
    @location(4) color: vec4f,
    // Of the instance, as in `shaders/common/vertex.wgsl`.
    @location(10) draw1: vec3u,
}

fn posed_vertex(in: VertexIn, index: u32) -> Posed {
    let vertex = posed_vertices[in.draw1.z + index];
    return Posed(
        vec3f(vertex.position_x, vertex.position_y, vertex.position_z),
        vec3f(vertex.normal_x, vertex.normal_y, vertex.normal_z),
        vec4f(vertex.tangent_x, vertex.tangent_y, vertex.tangent_z, vertex.tangent_w));
}
