// Positions of given exact points, to see whether a device's arithmetic has the CPU's bits.

@group(0) @binding(0) var<storage, read> golden: array<u32>; // origin, half an edge, u, v, p, q
@group(0) @binding(1) var<uniform> frame: Frame;
@group(0) @binding(2) var<storage, read_write> results: array<vec2<f32>>;
struct Frame { shift: vec4<u32> }

@compute @workgroup_size(64)
fn self_test(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = 8u * id.x;
    if i + 8u > arrayLength(&golden) { return; }
    let at = bitcast<vec4<i32>>(vec4(golden[i + 4u], golden[i + 5u], golden[i + 6u], golden[i + 7u]));
    results[id.x] = place(at, bitcast<vec2<f32>>(vec2(golden[i + 2u], golden[i + 3u])),
        bitcast<vec2<f32>>(vec2(golden[i], golden[i + 1u])));
}
