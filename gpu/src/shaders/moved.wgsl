// Where points are: at their tiles' centers, or relaxed, aside from them.

fn decides(c: Candidate) -> bool {
    if placed.more.w == 0u { return is_inside(c.at) && accepts(c.node, c.ab, value_at(c.at)); }
    // What lies in the domain is decided by where a point ends up.
    return accepts(c.node, c.ab, value_at(c.at)) && is_inside(moved(c));
}

// What a tile is to its descendants: its classes over 1, 2, 3 and 4 generations, its own type and
// rotation, and how its parent, grandparent and great-grandparent are turned.
struct Kin { classes: vec4<u32>, kind: u32, rotation: u32, ancestors: vec3<u32> }

fn young(word: u32) -> vec3<u32> { return vec3(word & 63u, (word >> 6u) & 1023u, word >> 16u); }

// Of the tile that so many of the first digits of a path lead to.
fn kin_of(c: Candidate, steps: u32) -> Kin {
    let at = 12u * c.tile;
    let old = tiles[at + 9u];
    var node = load_tile(c.tile);
    var kin = Kin(vec4(young(tiles[at + 8u]), old & 0x3ffffu), node.kind, node.rotation,
        vec3((old >> 18u) & 15u, (old >> 22u) & 15u, (old >> 26u) & 15u));
    for (var j = 0u; j < steps; j++) {
        var rest = c.path;
        for (var k = j + 1u; k < c.depth; k++) { rest /= 14u; }
        let d = rest % 14u;
        let packed = table[20u + 14u * kin.kind + d];
        let carry = u32(d == 13u);
        let above = vec4(kin.kind, kin.classes.xyz);
        let classes = above + d * vec4(4u, 55u, 766u, 10669u) - carry * vec4(1u, 4u, 55u, 766u);
        kin = Kin(classes, packed & 3u, (kin.rotation + (packed >> 2u)) % 12u,
            vec3(kin.rotation, kin.ancestors.xy));
    }
    return kin;
}
fn class_over(kin: Kin, generations: u32) -> u32 {
    if generations == 0u { return kin.kind; }
    var classes = kin.classes;
    return classes[min(generations, 4u) - 1u];
}

// How a tile is turned so many levels below another along its centers, or above it.
fn chain_rotation(kin: Kin, down: i32) -> u32 {
    if down < 0 {
        var ancestors = kin.ancestors;
        return ancestors[min(-down - 1, 2)];
    }
    var kind = kin.kind; var rotation = kin.rotation;
    for (var j = 0; j < down; j++) {
        let packed = table[20u + 14u * kind];
        kind = packed & 3u;
        rotation = (rotation + (packed >> 2u)) % 12u;
    }
    return rotation;
}

// A point's classes over 0 to 4 generations, and how its grandparent and great-grandparent are turned.
struct Lineage { classes: array<u32, 5>, grand: u32, great: u32 }

const CLASSES = array<u32, 6>(1u, 4u, 55u, 766u, 10669u, 148600u);

fn lineage_of(c: Candidate, level: u32) -> Lineage {
    var lineage: Lineage;
    let start = c.node.level - c.depth;
    if c.entry == 0u && level < start {
        // Older than the start tiles: as the host has it.
        let first = max(c.node.born, 6u);
        let at = placed.more.z + tiles[12u * c.tile + 10u] + 2u * (level - min(first, level));
        let old = tiles[at + 1u];
        let new_classes = young(tiles[at]);
        lineage.classes = array<u32, 5>((old >> 26u) & 3u, new_classes.x, new_classes.y, new_classes.z, old & 0x3ffffu);
        lineage.grand = (old >> 18u) & 15u;
        lineage.great = (old >> 22u) & 15u;
        return lineage;
    }
    if c.entry == 0u {
        let kin = kin_of(c, min(level - start, c.depth));
        let down = level - min(c.node.level, level);
        for (var g = 0u; g < 5u; g++) {
            // Below the tile, oldest ancestors are centers, of type a.
            lineage.classes[g] = 0u;
            if g >= down { lineage.classes[g] = class_over(kin, g - down); }
        }
        lineage.grand = chain_rotation(kin, i32(down) - 2);
        lineage.great = chain_rotation(kin, i32(down) - 3);
        return lineage;
    }
    let kin = kin_of(c, c.depth);
    var birth = 1u;
    for (var j = 2u; j < 4u; j++) { birth += u32(c.entry >= born_before(c.node.kind, j)); }
    let down = clamp(level - min(level, c.node.level), birth, 3u);
    var counts = CLASSES;
    for (var g = 2u; g < 5u; g++) {
        let older = g - min(g, down);
        lineage.classes[g] = class_over(kin, older) + (c.ab & 0xffffu) * counts[older + 1u]
            - (c.ab >> 16u) * counts[older];
    }
    lineage.grand = chain_rotation(kin, i32(down) - 2);
    lineage.great = chain_rotation(kin, i32(down) - 3);
    if down == 3u {
        let third = table[placed.moves.x + table[c.node.kind] + c.entry];
        lineage.classes[2] = third >> 8u;
        lineage.grand = (kin.rotation + (third & 0xffu)) % 12u;
    }
    return lineage;
}

fn slot_word(slot: u32, field: u32) -> u32 { return table[placed.moves.z + 5u * slot + field]; }

// The vector of a class at a slot, or at the first later slot that holds it.
fn vector_at(lineage: Lineage, slot: u32) -> vec2<f32> {
    if slot == 0u { return vec2(0.0); }
    var classes = lineage.classes;
    for (var s = slot; s < placed.more.y; s++) {
        let packed = slot_word(s, 4u);
        let number = classes[min(packed >> 24u, 4u)];
        if number < (packed & 0xffffffu) {
            let i = slot_word(s, 3u) + number;
            let both = bitcast<i32>(table[placed.more.x + i / 2u] << (16u * (1u - i % 2u)));
            let scale = bitcast<f32>(slot_word(s, 2u));
            return vec2(mul(f32((both << 8u) >> 24u), scale), mul(f32(both >> 24u), scale));
        }
    }
    return vec2(0.0);
}

const H = 0.8660254f;
const COSINES = array<f32, 12>(1.0, H, 0.5, 0.0, -0.5, -H, -1.0, -H, -0.5, 0.0, 0.5, H);

fn multiplied(v: vec2<f32>, by: vec2<f32>) -> vec2<f32> {
    return vec2(add(mul(by.x, v.x), mul(-by.y, v.y)), add(mul(by.y, v.x), mul(by.x, v.y)));
}

// A point's place. The phase is in f32 here, in f64 on the CPU; everything after it has the CPU's bits.
fn moved(c: Candidate) -> vec2<f32> {
    if placed.more.w == 0u { return c.at; }
    let threshold = min(bitcast<f32>(value_at(c.at)), frame.near.z) * frame.near.x;
    var level = 0u;
    for (var j = 0u; j < 17u; j++) { level += u32(placed.levels[j].tiles_near < threshold); }
    level = min(level, 16u);
    if level < 6u { return c.at; }
    let tau = threshold / placed.levels[level - 1u].tiles_near;
    if tau <= 1.0 { return c.at; }
    let interval = min((bitcast<u32>(tau) - 0x3f800000u) >> 13u, 4095u);
    var after = (table[placed.moves.w + interval / 2u] >> (16u * (interval & 1u))) & 0xffffu;
    while after < placed.more.y && bitcast<f32>(slot_word(after, 0u)) <= tau { after++; }
    if after == 0u || after >= placed.more.y { return c.at; }
    let first = after - 1u;
    let share = (tau - bitcast<f32>(slot_word(first, 0u))) * bitcast<f32>(slot_word(first, 1u));
    let lineage = lineage_of(c, level);
    let a = vector_at(lineage, first);
    let b = vector_at(lineage, first + 1u);
    let vector = vec2(add(a.x, mul(add(b.x, -a.x), share)), add(a.y, mul(add(b.y, -a.y), share)));
    var cosines = COSINES;
    let turn = (lineage.grand + 12u - lineage.great) % 12u;
    let turned = multiplied(vector, vec2(cosines[turn], cosines[(turn + 9u) % 12u]));
    let at = placed.moves.y + 2u * (12u * level + lineage.great);
    let step = multiplied(turned, vec2(bitcast<f32>(table[at]), bitcast<f32>(table[at + 1u])));
    return vec2(add(c.at.x, step.x), add(c.at.y, step.y));
}
