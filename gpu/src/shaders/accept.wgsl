// Whether rank k is a point where the importance is v: k < fl(fl(v·M) − u), fl rounding to 53 bits.

// In integers alone.
fn accepts_exactly(rank: vec2<u32>, bits: u32) -> bool {
    if bits == 0u { return false; }
    let subnormal = bits < 0x800000u;
    let exponent = select(bits >> 23u, 1u, subnormal);
    let mantissa = (bits & 0x7fffffu) | select(0x800000u, 0u, subnormal);
    // The product of 24 and 53 bits, rounded to nearest even at 53: T = q·2^t.
    let low = multiply(mantissa, frame.magnification.x);
    let high = plus(vec2(low.y, 0u), multiply(mantissa, frame.magnification.y));
    let upper = select(0u, 32u - countLeadingZeros(high.y), high.y > 0u);
    let length = select(32u + 32u - countLeadingZeros(high.x), 64u + upper, high.y > 0u);
    var q = vec2(low.x, high.x);
    var s = 0u;
    if length > 53u {
        s = length - 53u; // at most 24
        q = vec2((low.x >> s) | (high.x << (32u - s)), (high.x >> s) | (high.y << (32u - s)));
        let rest = low.x & ((1u << s) - 1u);
        let half = 1u << (s - 1u);
        if rest > half || (rest == half && (q.x & 1u) == 1u) { q = plus(q, vec2(1u, 0u)); }
    }
    var t = i32(exponent) - 150 + bitcast<i32>(frame.magnification.z) + i32(s);
    // Just below 2⁵³, integers are the last bits again.
    if t == 1 && all(q == vec2(0u, 0x100000u)) { q = vec2(0u, 0x200000u); t = 0; }
    // From there on T is an integer that u does not change; no rank reaches 2⁶².
    if t >= 10 { return true; }
    if t >= 1 { return below(rank, up(q, u32(t))); }
    let n = u32(-t);
    let u = frame.shift.xy; // in units of 2⁻⁵³, as all fractions
    if n > 53u {
        let fraction = down(q, n - 53u);
        let exact = all(up(fraction, n - 53u) == q);
        let above = below(u, fraction) || (all(fraction == u) && !exact);
        return all(rank == vec2(0u)) && above;
    }
    var whole = down(q, n);
    let fraction = up(minus(q, up(whole, n)), 53u - n);
    var rest = minus(fraction, u);
    if below(fraction, u) {
        if all(whole == vec2(0u)) { return false; }
        whole = minus(whole, vec2(1u, 0u));
        rest = plus(rest, vec2(0u, 1u << 21u));
    }
    // T − u = whole + rest, and k < whole + 1 unless rounding takes the rest away.
    if !all(rank == whole) { return below(rank, whole); }
    if all(rest == vec2(0u)) { return false; }
    if all(whole == vec2(0u)) { return true; }
    let j = top_bit(whole);
    let half = up(vec2(1u, 0u), j);
    if all(half == rest) { return j == 52u && (whole.x & 1u) == 1u; }
    return below(half, rest);
}

// The same, by f32 where its errors do not matter: rank and threshold have relative errors of less than
// 2⁻²¹ together, however the device rounds; one candidate in 10⁵ or 10⁶ is doubtful.
fn accepts(node: Node, ab: u32, bits: u32) -> bool {
    let level = node.level;
    let a = ab & 0xffffu; let b = ab >> 16u;
    let rank = near(node.rank) + f32(a) * placed.levels[level].tiles_near
        - f32(b) * placed.levels[level].before_near + frame.near.y;
    let threshold = min(bitcast<f32>(bits), frame.near.z) * frame.near.x;
    let doubt = (max(rank, threshold) + 1.0) * 0x1p-18;
    if abs(threshold - rank) > doubt { return rank < threshold; }
    return accepts_exactly(rank_of(node, ab), bits);
}

fn rank_of(node: Node, ab: u32) -> vec2<u32> {
    let level = node.level;
    return minus(plus(node.rank, times(placed.levels[level].tiles, ab & 0xffffu)),
        times(placed.levels[level].before, ab >> 16u));
}
