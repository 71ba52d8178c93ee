// Points that stay at their tiles' centers.

fn decides(c: Candidate) -> bool { return is_inside(c.at) && accepts(c.node, c.ab, value_at(c.at)); }
fn moved(c: Candidate) -> vec2<f32> { return c.at; }
