@group(0) @binding(4) var<storage, read> importance: array<f32>;

fn importance_at(x: u32, y: u32) -> u32 { return clean(importance[y * placed.texels.x + x]); }
