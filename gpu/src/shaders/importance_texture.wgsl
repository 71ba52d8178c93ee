@group(0) @binding(4) var importance: texture_2d<f32>;

fn importance_at(x: u32, y: u32) -> u32 {
    return clean(textureLoad(importance, vec2<i32>(i32(x), i32(y)), 0).x);
}
