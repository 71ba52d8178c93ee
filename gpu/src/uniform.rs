//! The placement's numbers as the shaders read them.

/// The placement's uniform, one level.
#[repr(C)]
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Level {
    pub(crate) edge: [f32; 2],
    pub(crate) reach: f32,
    pub(crate) margin: f32,
    pub(crate) tiles: [u32; 2],
    pub(crate) before: [u32; 2],
    pub(crate) tiles_near: f32,
    pub(crate) before_near: f32,
    pub(crate) stride: u32,
    pub(crate) stride_before: u32,
    pub(crate) mip: u32,
    pub(crate) pad: [u32; 3],
}

/// The placement's uniform, as `types.wgsl` has it.
#[repr(C)]
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Uniform {
    pub(crate) texels: [u32; 2],
    pub(crate) mips: u32,
    pub(crate) tiles: u32,
    pub(crate) texels_per_unit: [f32; 2],
    pub(crate) extent: [f32; 2],
    pub(crate) origin: [f32; 2],
    pub(crate) corner: [f32; 2],
    pub(crate) least: [f32; 2],
    pub(crate) greatest: [f32; 2],
    pub(crate) capacity: [u32; 4],
    pub(crate) table: [u32; 4],
    pub(crate) moves: [u32; 4],
    pub(crate) more: [u32; 4],
    pub(crate) work: [u32; 4],
    pub(crate) mip: [[u32; 4]; 16],
    pub(crate) levels: [Level; 17],
}
