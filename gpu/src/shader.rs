//! The WGSL text.

/// Where the importance comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// A storage buffer of `f32`, row by row.
    Buffer,
    /// The red channel of a texture of float values, mip 0.
    Texture,
}

/// How f32 results whose bits count are computed: the override `ARITHMETIC`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum Arithmetic {
    /// As the compiler likes, which may fuse operations: positions differ by a last bit, and a few points
    /// in a million are others. For comparison.
    Plain = 0,
    /// Every result passes through an integer that no compiler knows. Exact wherever hardware rounds +
    /// and × to nearest even, as all common hardware does.
    #[default]
    Barriers = 1,
    /// In integers alone: exact by the letter of the specification, at some 400 operations a candidate.
    Integers = 2,
}

/// The module with all entry points for importance from `source`.
#[must_use]
pub fn wgsl(source: Source) -> String {
    let importance = match source {
        Source::Buffer => include_str!("shaders/importance_buffer.wgsl"),
        Source::Texture => include_str!("shaders/importance_texture.wgsl"),
    };
    [
        include_str!("shaders/types.wgsl"),
        importance,
        include_str!("shaders/wide.wgsl"),
        include_str!("shaders/arithmetic.wgsl"),
        include_str!("shaders/tiles.wgsl"),
        include_str!("shaders/accept.wgsl"),
        include_str!("shaders/pyramid.wgsl"),
        include_str!("shaders/classify.wgsl"),
        include_str!("shaders/points.wgsl"),
        include_str!("shaders/moved.wgsl"),
    ]
    .concat()
}

/// A module with the entry point `self_test`, 64 threads a workgroup, which computes the positions of
/// [`golden`](crate::golden) vectors: binding 0 their first eight words each, read-only storage; 1 a
/// uniform of four zeros; 2 the results, two `f32` each, storage.
#[must_use]
pub fn self_test_wgsl() -> String {
    [
        "override ARITHMETIC: u32 = 1u;\n",
        include_str!("shaders/wide.wgsl"),
        include_str!("shaders/arithmetic.wgsl"),
        include_str!("shaders/self_test.wgsl"),
    ]
    .concat()
}
