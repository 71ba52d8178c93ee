//! What a frame's dispatches are and what they bind.

/// What a buffer or texture is, and its number in group 0 of the shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Binding {
    /// Uniform: [`Plan::uniform`](crate::Plan::uniform).
    Placed = 0,
    /// Uniform: [`Plan::frame`](crate::Plan::frame).
    Frame = 1,
    /// Read-only storage: [`Plan::table`](crate::Plan::table).
    Table = 2,
    /// Read-only storage: [`Plan::tiles`](crate::Plan::tiles).
    Tiles = 3,
    /// Read-only storage of `f32` row by row, or a texture whose red channel counts.
    Importance = 4,
    /// Storage.
    Pyramid = 5,
    /// Storage.
    Work = 6,
    /// Storage, cleared before each frame. Words 0 to 3: points wanted, flags, candidates, subtiles.
    Counters = 7,
    /// Storage.
    Masks = 8,
    /// Storage: the output, two `f32` a point.
    Positions = 9,
    /// Storage: the output, a `u32` a point.
    Keys = 10,
    /// Storage, and indirect arguments of dispatches.
    Arguments = 11,
    /// Storage, and the output's indirect draw arguments.
    Draw = 12,
}

/// How many workgroups a pass has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Groups {
    /// So many in x, y and z.
    Direct([u32; 3]),
    /// As the beginning of [`Binding::Arguments`] says.
    Indirect,
}

/// One dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// The entry point.
    pub entry: &'static str,
    /// What it binds, ascending.
    pub bindings: &'static [Binding],
    /// Its workgroups.
    pub groups: Groups,
}
