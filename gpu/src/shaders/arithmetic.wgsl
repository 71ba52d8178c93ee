// f32 sums and products whose bits are those of the CPU. WGSL lets a compiler fuse and reassociate, and
// nothing in it forbids that; so each result passes through an integer that no compiler knows, or is
// computed in integers altogether.

fn add(a: f32, b: f32) -> f32 {
    if ARITHMETIC == 2u { return bitcast<f32>(soft_add(bitcast<u32>(a), bitcast<u32>(b))); }
    if ARITHMETIC == 1u { return opaque(a + b); }
    return a + b;
}
fn mul(a: f32, b: f32) -> f32 {
    if ARITHMETIC == 2u { return bitcast<f32>(soft_mul(bitcast<u32>(a), bitcast<u32>(b))); }
    if ARITHMETIC == 1u { return opaque(a * b); }
    return a * b;
}
fn whole(n: i32) -> f32 {
    if ARITHMETIC == 2u { return bitcast<f32>(soft_whole(n)); }
    return f32(n);
}
fn opaque(x: f32) -> f32 { return bitcast<f32>(bitcast<u32>(x) ^ frame.shift.w); }

fn rounded(sign: u32, exponent: u32, mantissa: u32, rest: u32, half: u32) -> u32 {
    let up = u32(rest > half || (rest == half && (mantissa & 1u) == 1u));
    // A carry out of the mantissa is one of the exponent.
    return sign | ((exponent << 23u) + (mantissa - 0x800000u) + up);
}
// Of normal numbers and zeros, to nearest even.
fn soft_mul(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & 0x80000000u;
    let ea = (a >> 23u) & 255u; let eb = (b >> 23u) & 255u;
    if ea == 0u || eb == 0u { return sign; }
    let p = multiply((a & 0x7fffffu) | 0x800000u, (b & 0x7fffffu) | 0x800000u);
    let top = p.y >> 15u;
    let s = 23u + top;
    let q = (p.y << (32u - s)) | (p.x >> s);
    return rounded(sign, ea + eb + top - 127u, q, p.x & ((1u << s) - 1u), 1u << (s - 1u));
}
fn soft_add(x: u32, y: u32) -> u32 {
    let swap = (x & 0x7fffffffu) < (y & 0x7fffffffu);
    let a = select(x, y, swap); let b = select(y, x, swap);
    let ea = (a >> 23u) & 255u; let eb = (b >> 23u) & 255u;
    if ea == 0u { return a & b & 0x80000000u; }
    if eb == 0u { return a; }
    let ma = ((a & 0x7fffffu) | 0x800000u) << 3u;
    var mb = ((b & 0x7fffffu) | 0x800000u) << 3u;
    let d = ea - eb;
    if d > 27u { mb = 1u; }
    else if d > 0u { mb = (mb >> d) | u32((mb & ((1u << d) - 1u)) != 0u); }
    var m = select(ma + mb, ma - mb, ((a ^ b) >> 31u) == 1u);
    if m == 0u { return 0u; }
    var e = ea;
    if m >= 0x8000000u { m = (m >> 1u) | (m & 1u); e += 1u; }
    else { let z = countLeadingZeros(m) - 5u; m <<= z; e -= z; }
    return rounded(a & 0x80000000u, e, m >> 3u, m & 7u, 4u);
}
fn soft_whole(n: i32) -> u32 {
    if n == 0 { return 0u; }
    let sign = select(0u, 0x80000000u, n < 0);
    let m = u32(abs(n));
    let length = 32u - countLeadingZeros(m);
    if length <= 24u { return rounded(sign, 126u + length, m << (24u - length), 0u, 1u); }
    let s = length - 24u;
    return rounded(sign, 126u + length, m >> s, m & ((1u << s) - 1u), 1u << (s - 1u));
}

const SQRT_3 = 1.7320508f;

// origin + half edge · ((u + v√3) + i(p + q√3)), each operation rounded, as the library promises.
fn place(at: vec4<i32>, edge: vec2<f32>, origin: vec2<f32>) -> vec2<f32> {
    let x = add(whole(at.x), mul(SQRT_3, whole(at.y)));
    let y = add(whole(at.z), mul(SQRT_3, whole(at.w)));
    return vec2(add(origin.x, add(mul(edge.x, x), mul(-edge.y, y))),
        add(origin.y, add(mul(edge.y, x), mul(edge.x, y))));
}
