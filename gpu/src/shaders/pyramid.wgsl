// Maxima of the importance, as bits, which are in the order of the numbers: mip 1 to 6 of 64 × 64 texels
// in a workgroup, then the rest in one.

var<workgroup> reduced: array<u32, 256>;

fn store_mip(mip: u32, x: u32, y: u32, value: u32) {
    if mip < placed.mips {
        let to = placed.mip[mip];
        if x < to.y && y < to.z { pyramid[to.x + y * to.y + x] = value; }
    }
}

@compute @workgroup_size(16, 16)
fn reduce_texels(@builtin(workgroup_id) w: vec3<u32>, @builtin(local_invocation_id) l: vec3<u32>) {
    var most = 0u;
    let corner = w.xy * 64u + l.xy * 4u;
    for (var j = 0u; j < 2u; j++) {
        for (var i = 0u; i < 2u; i++) {
            var four = 0u;
            for (var k = 0u; k < 4u; k++) {
                let at = corner + vec2(2u * i + (k & 1u), 2u * j + (k >> 1u));
                if all(at < placed.texels) { four = max(four, importance_at(at.x, at.y)); }
            }
            store_mip(1u, corner.x / 2u + i, corner.y / 2u + j, four);
            most = max(most, four);
        }
    }
    store_mip(2u, corner.x / 4u, corner.y / 4u, most);
    reduced[l.y * 16u + l.x] = most;
    for (var n = 1u; n < 5u; n++) {
        let side = 16u >> n;
        workgroupBarrier();
        var value = 0u;
        let within = l.x < side && l.y < side;
        if within {
            let i = 2u * l.y * 16u + 2u * l.x;
            value = max(max(reduced[i], reduced[i + 1u]), max(reduced[i + 16u], reduced[i + 17u]));
        }
        workgroupBarrier();
        if within {
            reduced[l.y * 16u + l.x] = value;
            store_mip(2u + n, w.x * side + l.x, w.y * side + l.y, value);
        }
    }
}

@compute @workgroup_size(256)
fn reduce_rest(@builtin(local_invocation_index) l: u32) {
    for (var m = 7u; m < placed.mips; m++) {
        storageBarrier();
        let source = placed.mip[m - 1u]; let to = placed.mip[m];
        for (var i = l; i < to.y * to.z; i += 256u) {
            let x = 2u * (i % to.y); let y = 2u * (i / to.y);
            let x1 = min(x + 1u, source.y - 1u); let y1 = min(y + 1u, source.z - 1u);
            pyramid[to.x + i] = max(
                max(pyramid[source.x + y * source.y + x], pyramid[source.x + y * source.y + x1]),
                max(pyramid[source.x + y1 * source.y + x], pyramid[source.x + y1 * source.y + x1]));
        }
    }
}
