// Tiles: start tiles as the host has them, and those below an opened one.

struct Node {
    key: u32, kind: u32, rotation: u32, level: u32,
    born: u32, // the level of the center's birth
    center: vec4<i32>,
    rank: vec2<u32>,
}

fn load_tile(i: u32) -> Node {
    let at = 12u * i;
    let packed = tiles[at + 1u];
    return Node(tiles[at], packed & 3u, (packed >> 2u) & 15u, (packed >> 6u) & 31u, packed >> 11u,
        bitcast<vec4<i32>>(vec4(tiles[at + 2u], tiles[at + 3u], tiles[at + 4u], tiles[at + 5u])),
        vec2(tiles[at + 6u], tiles[at + 7u]));
}

fn coefficients(node: Node, entry: u32) -> u32 {
    return table[placed.table.x + table[node.kind] + entry];
}

fn key_of(node: Node, ab: u32) -> u32 {
    let level = node.level;
    let a = ab & 0xffffu;
    // Products past this leave 32 bits, or come near it.
    let most = f32(a) * f32(placed.levels[level].stride) + f32(node.key);
    if node.key == 0xffffffffu || most > 4.29e9 { return 0xffffffffu; }
    return node.key + a * placed.levels[level].stride - (ab >> 16u) * placed.levels[level].stride_before;
}

fn quarter(o: vec4<i32>) -> vec4<i32> { return vec4(-o.zw, o.xy); }

// From a tile's center to an entry's, in edges of its birth.
fn offset_of(node: Node, entry: u32) -> vec4<i32> {
    let at = placed.table.y + 2u * (table[node.kind] + entry);
    let uv = bitcast<i32>(table[at]); let pq = bitcast<i32>(table[at + 1u]);
    var o = vec4((uv << 16u) >> 16u, uv >> 16u, (pq << 16u) >> 16u, pq >> 16u);
    // By 30°: an exact half, because coordinates of a point have fitting parities.
    for (var k = 0u; k < node.rotation % 3u; k++) {
        o = vec4((3 * o.y - o.z) >> 1u, (o.x - o.w) >> 1u, (o.x + 3 * o.w) >> 1u, (o.y + o.z) >> 1u);
    }
    let quarters = node.rotation / 3u;
    if quarters >= 2u { o = -o; }
    if (quarters & 1u) == 1u { o = quarter(o); }
    return o;
}

fn finer(c: vec4<i32>) -> vec4<i32> {
    return vec4(2 * c.x + 3 * c.y, c.x + 2 * c.y, 2 * c.z + 3 * c.w, c.z + 2 * c.w);
}
fn coarser(c: vec4<i32>) -> vec4<i32> {
    return vec4(2 * c.x - 3 * c.y, 2 * c.y - c.x, 2 * c.z - 3 * c.w, 2 * c.w - c.z);
}

// How many entries of a type are born fewer than so many levels down, 1 to 4.
fn born_before(kind: u32, levels: u32) -> u32 { return table[4u + 4u * kind + levels - 1u]; }

fn child_of(node: Node, digit: u32) -> Node {
    let packed = table[20u + 14u * node.kind + digit];
    let ab = coefficients(node, digit);
    return Node(key_of(node, ab), packed & 3u, (node.rotation + (packed >> 2u)) % 12u, node.level + 1u,
        select(node.level + 1u, node.born, digit == 0u), finer(node.center) + offset_of(node, digit),
        rank_of(node, ab));
}

// The greatest importance over a tile's disc, as bits; 0 if no point comes from it. Rounding does not
// matter: radii are rounded up by more.
fn bound_of(node: Node) -> u32 {
    let level = node.level;
    let reach = placed.levels[level].reach;
    let x = f32(node.center.x) + SQRT_3 * f32(node.center.y);
    let y = f32(node.center.z) + SQRT_3 * f32(node.center.w);
    let edge = placed.levels[level].edge;
    var at = placed.origin + vec2(edge.x * x - edge.y * y, edge.y * x + edge.x * y);
    let margin = placed.levels[min(level + 1u, 16u)].margin;
    let far = max(reach + margin, placed.levels[node.born].margin);
    if any(at + far < vec2(0.0)) || any(at - far > placed.extent) { return 0u; }
    if placed.more.w == 1u { at = clamp(at, vec2(0.0), placed.extent); }
    let last = vec2<f32>(placed.texels - 1u);
    let mip = placed.levels[level].mip;
    let a = vec2<u32>(clamp((at - reach) * placed.texels_per_unit, vec2(0.0), last)) >> vec2(mip);
    let b = vec2<u32>(clamp((at + reach) * placed.texels_per_unit, vec2(0.0), last)) >> vec2(mip);
    let size = placed.mip[mip];
    var most = 0u;
    for (var j = a.y; j <= b.y; j++) {
        for (var i = a.x; i <= b.x; i++) {
            if mip == 0u { most = max(most, importance_at(i, j)); }
            else { most = max(most, pyramid[size.x + j * size.y + i]); }
        }
    }
    return most;
}

// How many entries of a tile may be points, itself included, and to what depth it must be opened.
fn admitted(node: Node) -> vec2<u32> {
    let bits = bound_of(node);
    let threshold = min(bitcast<f32>(bits), frame.near.z) * frame.near.x * (1.0 + 0x1p-18);
    let room = threshold - near(node.rank) * (1.0 - 0x1p-18);
    if bits == 0u || room < 0.0 { return vec2(0u); }
    // Relaxed points know their kin within three levels of the tile.
    let deep = select(room, threshold, placed.more.w == 1u);
    var levels = 0u;
    for (var j = node.level; j < 17u; j++) { levels += u32(deep >= placed.levels[j].tiles_near * (1.0 - 0x1p-18)); }
    if threshold > placed.levels[16].tiles_near { atomicOr(&counters[1], TOO_DENSE); }
    let blocks = min(room / placed.levels[node.level].tiles_near, 1e5);
    // A of entry i is at least i, and its rank at least i·(1 − 1/167) − 1/12 tile counts above the tile's.
    let entries = u32((blocks + 0.1) * 1.00627 + 2.0);
    return vec2(min(entries, born_before(node.kind, min(levels, 3u) + 1u)), max(levels, 3u) - 3u);
}
