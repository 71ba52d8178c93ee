// What all passes share. Everything that decides is an integer, or an f32 whose bits are forced.

// How f32 sums and products are computed where their bits count: 0 plainly, which may be fused;
// 1 behind barriers; 2 in integers.
override ARITHMETIC: u32 = 1u;

struct Level {
    edge: vec2<f32>,   // half an edge along the tiling's x axis, units
    reach: f32,        // no descendant of a tile is farther from it, units
    margin: f32,       // how far a point born here may be moved, units
    tiles: vec2<u32>,  // N of the level, 64 bits as (low, high)
    before: vec2<u32>, // N of the level above
    tiles_near: f32,
    before_near: f32,
    stride: u32,       // what A counts in keys
    stride_before: u32,
    mip: u32,          // of this mip, three texels each way hold the disc of a tile
    pad0: u32, pad1: u32, pad2: u32,
}

struct Placed {
    texels: vec2<u32>,
    mips: u32,
    tiles: u32,
    texels_per_unit: vec2<f32>,
    extent: vec2<f32>,
    origin: vec2<f32>,
    corner: vec2<f32>,
    least: vec2<f32>,
    greatest: vec2<f32>,
    capacity: vec4<u32>,  // points, candidates, subtiles; vertices an instance
    table: vec4<u32>,     // coefficients, offsets, columns, rows
    moves: vec4<u32>,     // thirds, edges, slots, phases
    more: vec4<u32>,      // vectors, slots' number, first word of the lineages, 1 if relaxed
    work: vec4<u32>,      // sums of tiles, subtiles, sums of subtiles
    mip: array<vec4<u32>, 16>, // first word, width, height
    levels: array<Level, 17>,
}

struct Frame {
    magnification: vec4<u32>, // 53 bits (low, high), exponent
    shift: vec4<u32>,         // u·2⁵³ (low, high); the greatest admitted value's bits; 0
    near: vec4<f32>,          // both rounded, the greatest value whose threshold f32 holds
}

@group(0) @binding(0) var<uniform> placed: Placed;
@group(0) @binding(1) var<uniform> frame: Frame;
@group(0) @binding(2) var<storage, read> table: array<u32>;
@group(0) @binding(3) var<storage, read> tiles: array<u32>;
@group(0) @binding(5) var<storage, read_write> pyramid: array<u32>;
@group(0) @binding(6) var<storage, read_write> work: array<u32>;
// 0 points, 1 flags, 2 candidates, 3 subtiles, 4 candidates of the start tiles; from 16 on points a block
@group(0) @binding(7) var<storage, read_write> counters: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> masks: array<u32>;
@group(0) @binding(9) var<storage, read_write> positions: array<vec2<f32>>;
@group(0) @binding(10) var<storage, read_write> keys: array<u32>;
@group(0) @binding(11) var<storage, read_write> arguments: array<u32>;
@group(0) @binding(12) var<storage, read_write> draw: array<u32>;

const FEW_POINTS = 1u; const FEW_CANDIDATES = 2u; const FEW_SUBTILES = 4u;
const TOO_DENSE = 8u; const NO_KEYS = 16u;
const TOTALS = 16u;
const LANES = 128u;
const BLOCK = 64u; // workgroups whose points are counted together

// A value as it counts, as bits: finite and positive, or 0.
fn clean(value: f32) -> u32 {
    let bits = bitcast<u32>(value);
    return select(bits, 0u, bits > frame.shift.z);
}

fn group_of(group: vec3<u32>, groups: vec3<u32>) -> u32 { return group.y * groups.x + group.x; }
