// How many candidates each tile has. Tiles whose blocks are too shallow for their bound are opened: all
// their descendants so many levels down take their place.

var<workgroup> sums: array<vec2<u32>, 128>;

// Sums over the workgroup before each lane; the whole in `sums[127]`.
fn scan(l: u32, value: vec2<u32>) -> vec2<u32> {
    sums[l] = value;
    workgroupBarrier();
    for (var d = 1u; d < LANES; d *= 2u) {
        var before = vec2(0u);
        if l >= d { before = sums[l - d]; }
        workgroupBarrier();
        sums[l] += before;
        workgroupBarrier();
    }
    return sums[l] - value;
}

const POWERS = array<u32, 4>(0u, 14u, 196u, 2744u);

@compute @workgroup_size(128)
fn classify(@builtin(workgroup_id) w: vec3<u32>, @builtin(num_workgroups) n: vec3<u32>,
            @builtin(local_invocation_index) l: u32) {
    let group = group_of(w, n);
    let i = group * LANES + l;
    var found = vec2(0u);
    var depth = 0u;
    if i < placed.tiles {
        let most = admitted(load_tile(i));
        depth = min(most.y, 3u);
        if most.y > 3u { atomicOr(&counters[1], TOO_DENSE); }
        var powers = POWERS;
        found = vec2(select(0u, most.x, depth == 0u), powers[depth]);
    }
    let before = scan(l, found);
    if i < placed.tiles {
        work[2u * i] = before.x;
        work[2u * i + 1u] = before.y | (depth << 28u);
    }
    if l == LANES - 1u {
        work[placed.work.x + 2u * group] = sums[127].x;
        work[placed.work.x + 2u * group + 1u] = sums[127].y;
    }
}

fn store_arguments(threads: u32) {
    let groups = (threads + LANES - 1u) / LANES;
    arguments[0] = min(groups, 32768u);
    arguments[1] = (groups + 32767u) / 32768u;
    arguments[2] = 1u;
}

@compute @workgroup_size(128)
fn sum_tiles(@builtin(local_invocation_index) l: u32) {
    let groups = (placed.tiles + LANES - 1u) / LANES;
    var carry = vec2(0u);
    for (var first = 0u; first < groups; first += LANES) {
        let at = placed.work.x + 2u * (first + l);
        var value = vec2(0u);
        if first + l < groups { value = vec2(work[at], work[at + 1u]); }
        let before = carry + scan(l, value);
        if first + l < groups { work[at] = before.x; work[at + 1u] = before.y; }
        carry += sums[127];
        workgroupBarrier();
    }
    if l == 0u {
        atomicStore(&counters[4], carry.x);
        atomicStore(&counters[3], carry.y);
        if carry.y > placed.capacity.z { atomicOr(&counters[1], FEW_SUBTILES); }
        store_arguments(min(carry.y, placed.capacity.z));
    }
}

fn subtile_count() -> u32 { return min(atomicLoad(&counters[3]), placed.capacity.z); }

// The tile that a path of base-14 digits leads to; kind 4 if there is none.
fn descend(tile: u32, path: u32, depth: u32) -> Node {
    var node = load_tile(tile);
    for (var j = depth; j > 0u; j--) {
        var rest = path;
        for (var k = 1u; k < j; k++) { rest /= 14u; }
        let digit = rest % 14u;
        if digit == 13u && node.kind == 0u { node.kind = 4u; return node; }
        node = child_of(node, digit);
    }
    return node;
}

@compute @workgroup_size(128)
fn open(@builtin(workgroup_id) w: vec3<u32>, @builtin(num_workgroups) n: vec3<u32>,
        @builtin(local_invocation_index) l: u32) {
    let group = group_of(w, n);
    let s = group * LANES + l;
    let exists = s < subtile_count();
    var found = 0u; var tile = 0u; var path = 0u; var depth = 0u;
    if exists {
        var high = placed.tiles - 1u;
        while tile < high {
            let middle = (tile + high + 1u) / 2u;
            let before = work[placed.work.x + 2u * (middle / LANES) + 1u] + (work[2u * middle + 1u] & 0xfffffffu);
            if before <= s { tile = middle; } else { high = middle - 1u; }
        }
        let record = work[2u * tile + 1u];
        path = s - work[placed.work.x + 2u * (tile / LANES) + 1u] - (record & 0xfffffffu);
        depth = record >> 28u;
        let node = descend(tile, path, depth);
        if node.kind < 4u {
            let most = admitted(node);
            found = most.x;
            if most.y > 0u { atomicOr(&counters[1], TOO_DENSE); }
        }
    }
    let before = scan(l, vec2(found, 0u));
    if exists {
        let at = placed.work.y + 3u * s;
        work[at] = before.x;
        work[at + 1u] = tile;
        work[at + 2u] = path | (depth << 16u);
    }
    if l == LANES - 1u && s - l < subtile_count() { work[placed.work.z + group] = sums[127].x; }
}

@compute @workgroup_size(128)
fn sum_subtiles(@builtin(local_invocation_index) l: u32) {
    if l == 0u { open_groups = (subtile_count() + LANES - 1u) / LANES; first_sum = atomicLoad(&counters[4]); }
    let groups = workgroupUniformLoad(&open_groups);
    var carry = workgroupUniformLoad(&first_sum);
    for (var first = 0u; first < groups; first += LANES) {
        let at = placed.work.z + first + l;
        var value = 0u;
        if first + l < groups { value = work[at]; }
        let before = carry + scan(l, vec2(value, 0u)).x;
        if first + l < groups { work[at] = before; }
        carry += sums[127].x;
        workgroupBarrier();
    }
    if l == 0u {
        atomicStore(&counters[2], carry);
        if carry > placed.capacity.y { atomicOr(&counters[1], FEW_CANDIDATES); }
        store_arguments(min(carry, placed.capacity.y));
    }
}
var<workgroup> open_groups: u32;
var<workgroup> first_sum: u32;
