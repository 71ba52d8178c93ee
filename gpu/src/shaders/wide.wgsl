// 64 bits as (low, high).

fn multiply(a: u32, b: u32) -> vec2<u32> {
    let low = (a & 0xffffu) * (b & 0xffffu);
    let left = (a >> 16u) * (b & 0xffffu);
    let right = (a & 0xffffu) * (b >> 16u);
    let middle = (low >> 16u) + (left & 0xffffu) + (right & 0xffffu);
    let high = (a >> 16u) * (b >> 16u) + (left >> 16u) + (right >> 16u) + (middle >> 16u);
    return vec2((middle << 16u) | (low & 0xffffu), high);
}
fn plus(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2(low, a.y + b.y + u32(low < a.x));
}
fn minus(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2(a.x - b.x, a.y - b.y - u32(a.x < b.x));
}
fn times(a: vec2<u32>, n: u32) -> vec2<u32> {
    let low = multiply(a.x, n);
    return vec2(low.x, low.y + a.y * n);
}
fn below(a: vec2<u32>, b: vec2<u32>) -> bool { return a.y < b.y || (a.y == b.y && a.x < b.x); }
// Shifts by 32 or more are taken mod 32 in WGSL.
fn up(a: vec2<u32>, n: u32) -> vec2<u32> {
    if n == 0u { return a; }
    if n >= 64u { return vec2(0u); }
    if n >= 32u { return vec2(0u, a.x << (n - 32u)); }
    return vec2(a.x << n, (a.y << n) | (a.x >> (32u - n)));
}
fn down(a: vec2<u32>, n: u32) -> vec2<u32> {
    if n == 0u { return a; }
    if n >= 64u { return vec2(0u); }
    if n >= 32u { return vec2(a.y >> (n - 32u), 0u); }
    return vec2((a.x >> n) | (a.y << (32u - n)), a.y >> n);
}
fn top_bit(a: vec2<u32>) -> u32 {
    return select(31u - countLeadingZeros(a.x), 63u - countLeadingZeros(a.y), a.y > 0u);
}
fn near(a: vec2<u32>) -> f32 { return f32(a.y) * 4294967296.0 + f32(a.x); }
