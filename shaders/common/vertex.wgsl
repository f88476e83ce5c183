// A vertex of a model and its position: morphed, then skinned.

struct VertexIn {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    // Two texture coordinate sets.
    @location(3) uv: vec4f,
    @location(4) color: vec4f,
    @location(5) joints0: vec4u,
    @location(6) joints1: vec4u,
    @location(7) weights0: vec4f,
    @location(8) weights1: vec4f,
    // Of the instance: palette, influences, morph_targets, morph_weights of its `Draw`, and then vertices, tint, posed.
    @location(9) draw0: vec4u,
    @location(10) draw1: vec3u,
}

fn draw_of(in: VertexIn) -> Draw {
    return Draw(in.draw0.x, in.draw0.y, in.draw0.z, in.draw0.w, in.draw1.x, in.draw1.y, in.draw1.z);
}

fn posed_vertex(in: VertexIn, index: u32) -> Posed {
    let draw = draw_of(in);
    let start = morphed(draw, Posed(in.position, in.normal, in.tangent), index);
    return moved(blended_matrix(draw, in.joints0, in.joints1, in.weights0, in.weights1), start);
}
