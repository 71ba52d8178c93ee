// Candidates: a lane each, whatever tile it is of.

fn candidates_before(source: u32) -> u32 {
    if source < placed.tiles {
        return work[placed.work.x + 2u * (source / LANES)] + work[2u * source];
    }
    let sub = source - placed.tiles;
    return work[placed.work.z + sub / LANES] + work[placed.work.y + 3u * sub];
}

// The last source at or before candidate `index`, between two of which that is known.
fn source_of(index: u32, first: u32, last: u32) -> u32 {
    var low = first; var high = last;
    while low < high {
        let middle = (low + high + 1u) / 2u;
        if candidates_before(middle) <= index { low = middle; } else { high = middle - 1u; }
    }
    return low;
}

// Entry `entry` of the tile that a path of `depth` digits leads to from a start tile.
struct Candidate {
    node: Node, entry: u32, ab: u32, at: vec2<f32>,
    tile: u32, path: u32, depth: u32,
}

fn candidate_at(index: u32, first: u32, last: u32) -> Candidate {
    let source = source_of(index, first, last);
    let entry = index - candidates_before(source);
    var tile = source; var path = 0u; var depth = 0u;
    if source >= placed.tiles {
        let at = placed.work.y + 3u * (source - placed.tiles);
        tile = work[at + 1u];
        path = work[at + 2u] & 0xffffu;
        depth = work[at + 2u] >> 16u;
    }
    let node = descend(tile, path, depth);
    // In edges of the level of its birth.
    var center = node.center;
    var level = node.level;
    if entry == 0u {
        for (; level > node.born; level--) { center = coarser(center); }
    } else {
        for (var j = 1u; j < 4u; j++) {
            if entry >= born_before(node.kind, j) { center = finer(center); level++; }
        }
        center += offset_of(node, entry);
    }
    return Candidate(node, entry, coefficients(node, entry),
        place(center, placed.levels[level].edge, placed.origin), tile, path, depth);
}

// By the least coordinate of each texel as the library has it, from a guess.
fn texel_of(x: f32, scale: f32, count: u32, borders: u32) -> u32 {
    var texel = min(u32(max(x * scale, 0.0)), count - 1u);
    while texel > 0u && x < bitcast<f32>(table[borders + texel]) { texel--; }
    while texel + 1u < count && x >= bitcast<f32>(table[borders + texel + 1u]) { texel++; }
    return texel;
}
fn value_at(at: vec2<f32>) -> u32 {
    return importance_at(texel_of(at.x, placed.texels_per_unit.x, placed.texels.x, placed.table.z),
        texel_of(at.y, placed.texels_per_unit.y, placed.texels.y, placed.table.w));
}
fn is_inside(at: vec2<f32>) -> bool { return all(at >= vec2(0.0)) && all(at < placed.extent); }

var<workgroup> bits: array<atomic<u32>, 4>;
var<workgroup> base: atomic<u32>;

struct Taken { accepted: bool, key: u32, at: vec2<f32> }

fn sources_of_group(group: u32, total: u32) -> vec2<u32> {
    let end = placed.tiles + subtile_count() - 1u;
    let first = source_of(group * LANES, 0u, end);
    return vec2(first, source_of(min(group * LANES + LANES, total) - 1u, first, end));
}

fn total_candidates() -> u32 { return min(atomicLoad(&counters[2]), placed.capacity.y); }

fn note(l: u32, accepted: bool) {
    if accepted { atomicOr(&bits[l / 32u], 1u << (l % 32u)); }
}
fn counted() -> u32 {
    var total = 0u;
    for (var k = 0u; k < 4u; k++) { total += countOneBits(atomicLoad(&bits[k])); }
    return total;
}
fn counted_before(l: u32) -> u32 {
    var before = countOneBits(atomicLoad(&bits[l / 32u]) & ((1u << (l % 32u)) - 1u));
    for (var k = 0u; k < l / 32u; k++) { before += countOneBits(atomicLoad(&bits[k])); }
    return before;
}

// In the caller's coordinates, inside the half-open domain.
fn to_caller(at: vec2<f32>) -> vec2<f32> {
    let sum = vec2(add(placed.corner.x, at.x), add(placed.corner.y, at.y));
    return min(max(sum, placed.least), placed.greatest);
}

fn write_point(to: u32, candidate: Candidate, at: vec2<f32>) {
    if to >= placed.capacity.x { return; }
    positions[to] = to_caller(at);
    let key = key_of(candidate.node, candidate.ab);
    if key == 0xffffffffu { atomicOr(&counters[1], NO_KEYS); }
    keys[to] = key;
}

// Ordered: which candidates are points, and how many there are in each block of workgroups.
@compute @workgroup_size(128)
fn count(@builtin(workgroup_id) w: vec3<u32>, @builtin(num_workgroups) n: vec3<u32>,
         @builtin(local_invocation_index) l: u32) {
    let group = group_of(w, n);
    let total = total_candidates();
    let index = group * LANES + l;
    if index < total {
        let sources = sources_of_group(group, total);
        let candidate = candidate_at(index, sources.x, sources.y);
        note(l, decides(candidate));
    }
    workgroupBarrier();
    if group * LANES < total {
        if l < 4u { masks[4u * group + l] = atomicLoad(&bits[l]); }
        if l == 0u { atomicAdd(&counters[TOTALS + group / BLOCK], counted()); }
    }
}

// Ordered: the points before each block.
@compute @workgroup_size(128)
fn sum_points(@builtin(local_invocation_index) l: u32) {
    if l == 0u { open_groups = (total_candidates() + LANES * BLOCK - 1u) / (LANES * BLOCK); }
    let blocks = workgroupUniformLoad(&open_groups);
    var carry = 0u;
    for (var first = 0u; first < blocks; first += LANES) {
        let at = TOTALS + first + l;
        var value = 0u;
        if first + l < blocks { value = atomicLoad(&counters[at]); }
        let before = carry + scan(l, vec2(value, 0u)).x;
        if first + l < blocks { atomicStore(&counters[at], before); }
        carry += sums[127].x;
        workgroupBarrier();
    }
    if l == 0u {
        atomicStore(&counters[0], carry);
        finish_with(carry);
    }
}

fn finish_with(points: u32) {
    if points > placed.capacity.x { atomicOr(&counters[1], FEW_POINTS); }
    draw[0] = placed.capacity.w;
    draw[1] = min(points, placed.capacity.x);
    draw[2] = 0u;
    draw[3] = 0u;
}

// Ordered: the points at their places.
@compute @workgroup_size(128)
fn write(@builtin(workgroup_id) w: vec3<u32>, @builtin(num_workgroups) n: vec3<u32>,
         @builtin(local_invocation_index) l: u32) {
    let group = group_of(w, n);
    let total = total_candidates();
    let index = group * LANES + l;
    if group * LANES < total {
        if l < 4u { atomicStore(&bits[l], masks[4u * group + l]); }
        var before = 0u;
        for (var i = group / BLOCK * BLOCK * 4u + l; i < 4u * group; i += LANES) {
            before += countOneBits(masks[i]);
        }
        atomicAdd(&base, before);
    }
    workgroupBarrier();
    if index < total && (atomicLoad(&bits[l / 32u]) >> (l % 32u) & 1u) == 1u {
        let sources = sources_of_group(group, total);
        let candidate = candidate_at(index, sources.x, sources.y);
        let to = atomicLoad(&counters[TOTALS + group / BLOCK]) + atomicLoad(&base) + counted_before(l);
        write_point(to, candidate, moved(candidate));
    }
}

// Unordered: all at once.
@compute @workgroup_size(128)
fn append(@builtin(workgroup_id) w: vec3<u32>, @builtin(num_workgroups) n: vec3<u32>,
          @builtin(local_invocation_index) l: u32) {
    let group = group_of(w, n);
    let total = total_candidates();
    let index = group * LANES + l;
    var accepted = false;
    var candidate: Candidate;
    if index < total {
        let sources = sources_of_group(group, total);
        candidate = candidate_at(index, sources.x, sources.y);
        accepted = decides(candidate);
        note(l, accepted);
    }
    workgroupBarrier();
    if l == 0u { atomicStore(&base, atomicAdd(&counters[0], counted())); }
    workgroupBarrier();
    if accepted { write_point(atomicLoad(&base) + counted_before(l), candidate, moved(candidate)); }
}

@compute @workgroup_size(1)
fn finish() { finish_with(atomicLoad(&counters[0])); }
