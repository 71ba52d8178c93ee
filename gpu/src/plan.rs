//! A plan: everything that one placement, one size of importance and one capacity need, as plain data.

use twelvefold::Placement;
use twelvefold::bake::displacement::DELTA;
use twelvefold::export::{Export, ToCaller};

use crate::error::GpuError;
use crate::keys::{KEY_LEVEL, Keys, count};
use crate::pass::{Binding, Groups, Pass};
use crate::tables::TableWords;
use crate::tiles::{Reach, StartTiles, start_tiles};
use crate::uniform::{Level, Uniform};

/// The order of points in the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Order {
    /// The same order at every run: the same input, the same bytes.
    #[default]
    Ordered,
    /// As they come: a pass less, another order at every run.
    Append,
}

/// Where points are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Points {
    /// At their tiles' centers: bits of the CPU's.
    #[default]
    Fixed,
    /// Moved aside, even at every density, as [`Sampling::relaxed`](twelvefold::Sampling::relaxed) has it
    /// for an image map; not for estimates. Positions differ from the CPU's by up to [`RELAXED_ERROR`].
    Relaxed,
}

/// How far a relaxed point is from the CPU's at most: so many edges of its level, some 10⁻⁴ of the distance
/// between points, because the density phase has the precision of `f32`; and the rounding of a coordinate.
/// A point that the CPU moves as near to the domain's border may be lost or found.
pub const RELAXED_ERROR: f64 = 1e-4;

/// How much room there is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capacity {
    /// Points, up to 2²⁴: somewhat more than are expected, because the coarseness of the first pass is
    /// chosen by it. Points past it are counted, flagged and not written.
    pub points: u32,
    /// Candidates that are tested, of which there are 1.1 to 2.1 a point over smooth
    /// and noisy pictures, more at hard edges. Past it points are missing, and
    /// that is flagged.
    pub candidates: u32,
    /// Tiles below those that are opened at peaks of the importance; as candidates.
    pub subtiles: u32,
}

impl Capacity {
    /// Room for so many points: eight times as many candidates, a bit each, and the subtiles of 330 moderate peaks.
    #[must_use]
    pub const fn points(points: u32) -> Self {
        Self {
            points,
            candidates: points.saturating_mul(8).saturating_add(1 << 16),
            subtiles: 1 << 16,
        }
    }
}

/// Everything that does not change from frame to frame.
#[derive(Clone)]
pub struct Plan {
    uniform: Uniform,
    table: Vec<u32>,
    tiles: Vec<u32>,
    keys: Keys,
    order: Order,
    pyramid_words: u32,
    ranks_per_density: f64,
    rank_shift: f64,
}

/// Threads of a workgroup.
const LANES: u32 = 128;
/// Workgroups whose points are counted together.
const BLOCK: u32 = 64;
/// Words of the counters before the blocks' counts.
const TOTALS: u32 = 16;
/// Words of a storage buffer by WebGPU's default limits.
const BINDING_WORDS: u32 = 1 << 25;

impl Plan {
    /// The plan of a placement whose domain the importance covers with `width` × `height` texels.
    /// `vertices` is the number of vertices of an instance in the draw arguments.
    ///
    /// Takes 1 to 10 ms up to a million points, some 50 ms beyond.
    ///
    /// # Errors
    /// [`GpuError`] for sizes and domains outside of what 32 bits and WebGPU's default limits hold.
    pub fn new(
        placement: &Placement<'_>,
        (width, height): (u32, u32),
        capacity: Capacity,
        order: Order,
        points_are: Points,
        vertices: u32,
    ) -> Result<Self, GpuError> {
        let side = 1..=8192;
        if !(side.contains(&width) && side.contains(&height)) || width * height > BINDING_WORDS {
            return Err(GpuError::Size { width, height });
        }
        let Capacity { points, candidates, subtiles } = capacity;
        if !(1..=1 << 24).contains(&points) {
            return Err(GpuError::Capacity { points });
        }
        if !(LANES..=1 << 29).contains(&candidates) || !(1..=1 << 22).contains(&subtiles) {
            return Err(GpuError::Room);
        }
        let domain = placement.domain();
        let diagonal = domain.diagonal();
        if !(1e-20..=1e20).contains(&diagonal) {
            return Err(GpuError::Domain { diagonal });
        }
        let caller = ToCaller::of(&domain).map_err(|_| GpuError::Domain { diagonal })?;
        let export = Export::of(placement);
        if export.seamless {
            return Err(GpuError::Seamless);
        }
        let relaxed = points_are == Points::Relaxed;
        let longest = match (relaxed, placement.tables().to_relaxation()) {
            (true, Some(relaxation)) => relaxation.smooth.longest(1.0, DELTA.into()),
            (true, None) => return Err(GpuError::NoRelaxation),
            (false, _) => 0.0,
        };
        let reach = Reach { domain, export: &export, longest };
        let StartTiles { words: tiles, count: tile_count, keys } =
            start_tiles(placement, &reach, points)?;
        let table = TableWords::new(placement, (width, height), relaxed)?;
        let (mip, mips, pyramid_words) = mips(width, height);
        let texels = glam::DVec2::new(width.into(), height.into()) / domain.size();
        let single = |v: glam::DVec2| v.to_array().map(|x| x as f32);
        let groups = tile_count.div_ceil(LANES);
        let sums = 2 * tile_count;
        let subtile_words = sums + 2 * groups;
        let levels = std::array::from_fn(|i| {
            let near = export.reach[i] * (1.0 + 1e-5) + 4e-6 * diagonal;
            // Of a square no wider than two texels, three each way hold every place.
            let side = 2.0 * near * texels.max_element() * (1.0 + 1e-5);
            let wide = (0..mips - 1).find(|mip| side < f64::from(2u32 << mip)).unwrap_or(mips - 1);
            let below = i as i32 - i32::from(KEY_LEVEL);
            let (here, before) = (count(i), if i == 0 { 1 } else { count(i - 1) });
            Level {
                edge: single(export.half_edges[i]),
                reach: (near as f32).next_up(),
                margin: if relaxed { (reach.margin(i as u8) as f32).next_up() } else { 0.0 },
                tiles: [here as u32, (here >> 32) as u32],
                before: [before as u32, (before >> 32) as u32],
                tiles_near: here as f32,
                before_near: before as f32,
                stride: keys.stride(below),
                stride_before: keys.stride(below - 1),
                mip: wide,
                pad: [0; 3],
            }
        });
        let uniform = Uniform {
            texels: [width, height],
            mips,
            tiles: tile_count,
            texels_per_unit: single(texels),
            extent: single(domain.size()),
            origin: single(export.origin),
            corner: caller.corner.to_array(),
            least: caller.least.to_array(),
            greatest: caller.greatest.to_array(),
            capacity: [points, candidates, subtiles, vertices],
            table: [table.coefficients, table.offsets, table.columns, table.rows],
            moves: [table.thirds, table.edges, table.slots, table.phases],
            more: [
                table.vectors,
                table.slot_count,
                crate::tiles::TILE_WORDS as u32 * tile_count,
                relaxed.into(),
            ],
            work: [sums, subtile_words, subtile_words + 3 * subtiles, 0],
            mip,
            levels,
        };
        Ok(Self {
            uniform,
            table: table.words,
            tiles,
            keys,
            order,
            pyramid_words,
            ranks_per_density: export.ranks_per_density,
            rank_shift: export.rank_shift,
        })
    }

    /// The words of [`Binding::Placed`].
    #[must_use]
    pub fn uniform(&self) -> &[u32] {
        bytemuck::cast_slice(std::slice::from_ref(&self.uniform))
    }

    /// The words of [`Binding::Table`].
    #[must_use]
    pub fn table(&self) -> &[u32] {
        &self.table
    }

    /// The words of [`Binding::Tiles`].
    #[must_use]
    pub fn tiles(&self) -> &[u32] {
        &self.tiles
    }

    /// What turns keys into ranks.
    #[must_use]
    pub fn keys(&self) -> &Keys {
        &self.keys
    }

    /// Texels a row and rows.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        self.uniform.texels.into()
    }

    /// The most points that are written.
    #[must_use]
    pub fn capacity(&self) -> u32 {
        self.uniform.capacity[0]
    }

    /// The order of the points.
    #[must_use]
    pub fn order(&self) -> Order {
        self.order
    }

    /// The words of [`Binding::Frame`] for `density` points a squared unit where the importance is 1: the
    /// amount that [`Amount::Density`](twelvefold::Amount::Density) means.
    ///
    /// # Errors
    /// [`GpuError::Density`].
    pub fn frame(&self, density: f64) -> Result<[u32; 12], GpuError> {
        let magnification = density * self.ranks_per_density;
        let none = density == 0.0;
        if !none && !(1e-30..=1e30).contains(&magnification) {
            return Err(GpuError::Density { density });
        }
        let bits = magnification.to_bits();
        let mantissa = if none { 0 } else { bits & ((1 << 52) - 1) | 1 << 52 };
        let exponent = (bits >> 52) as i32 - 1075;
        // u is a multiple of 2⁻⁵³.
        let shift = (self.rank_shift * (1u64 << 53) as f64) as u64;
        let greatest = if none { 0 } else { f32::MAX.to_bits() };
        let near = magnification as f32;
        let holds = if none { 0.0 } else { (1e37 / near).min(f32::MAX) };
        Ok([
            mantissa as u32,
            (mantissa >> 32) as u32,
            exponent as u32,
            0,
            shift as u32,
            (shift >> 32) as u32,
            greatest,
            0,
            near.to_bits(),
            (self.rank_shift as f32).to_bits(),
            holds.to_bits(),
            0,
        ])
    }

    /// The least number of bytes of a storage buffer, the importance's included.
    #[must_use]
    pub fn bytes(&self, binding: Binding) -> u64 {
        let [points, candidates, subtiles, _] = self.uniform.capacity.map(u64::from);
        let words = match binding {
            Binding::Placed => self.uniform().len() as u64,
            Binding::Frame => 12,
            Binding::Table => self.table.len() as u64,
            Binding::Tiles => self.tiles.len() as u64,
            Binding::Importance => self.uniform.texels.map(u64::from).iter().product(),
            Binding::Pyramid => self.pyramid_words.max(4).into(),
            Binding::Work => u64::from(self.uniform.work[2]) + subtiles.div_ceil(LANES.into()),
            Binding::Counters => u64::from(TOTALS) + candidates.div_ceil(u64::from(LANES * BLOCK)),
            Binding::Masks => 4 * candidates.div_ceil(LANES.into()),
            Binding::Positions => 2 * points,
            Binding::Keys => points,
            Binding::Arguments | Binding::Draw => 4,
        };
        4 * words
    }

    /// The dispatches of a frame, in order, once the counters are cleared: nine, or eight to append.
    #[must_use]
    pub fn passes(&self) -> Vec<Pass> {
        use Binding::*;
        let pass = |entry, bindings, groups| Pass { entry, bindings, groups };
        let one = Groups::Direct([1, 1, 1]);
        let [width, height] = self.uniform.texels.map(|n| n.div_ceil(64));
        let tiles = self.uniform.tiles.div_ceil(LANES);
        let mut passes = vec![
            pass(
                "reduce_texels",
                &[Placed, Frame, Importance, Pyramid][..],
                Groups::Direct([width, height, 1]),
            ),
            pass("reduce_rest", &[Placed, Pyramid], one),
            pass(
                "classify",
                &[Placed, Frame, Table, Tiles, Importance, Pyramid, Work, Counters],
                Groups::Direct([tiles, 1, 1]),
            ),
            pass("sum_tiles", &[Placed, Work, Counters, Arguments], one),
            pass(
                "open",
                &[Placed, Frame, Table, Tiles, Importance, Pyramid, Work, Counters],
                Groups::Indirect,
            ),
            pass("sum_subtiles", &[Placed, Work, Counters, Arguments], one),
        ];
        match self.order {
            Order::Ordered => passes.extend([
                pass(
                    "count",
                    &[Placed, Frame, Table, Tiles, Importance, Work, Counters, Masks],
                    Groups::Indirect,
                ),
                pass("sum_points", &[Placed, Counters, Draw], one),
                pass(
                    "write",
                    &[
                        Placed, Frame, Table, Tiles, Importance, Work, Counters, Masks, Positions,
                        Keys,
                    ],
                    Groups::Indirect,
                ),
            ]),
            Order::Append => passes.extend([
                pass(
                    "append",
                    &[Placed, Frame, Table, Tiles, Importance, Work, Counters, Positions, Keys],
                    Groups::Indirect,
                ),
                pass("finish", &[Placed, Counters, Draw], one),
            ]),
        }
        passes
    }
}

/// First word, width and height of each mip, their number, and the words from mip 1 on.
fn mips(width: u32, height: u32) -> ([[u32; 4]; 16], u32, u32) {
    let mut all = [[0; 4]; 16];
    let (mut first, mut count) = (0, 0);
    for (level, mip) in (0u32..).zip(&mut all) {
        let [w, h] = [width, height].map(|n| n.div_ceil(1 << level));
        *mip = [first, w, h, 0];
        first += if level == 0 { 0 } else { w * h };
        count = level + 1;
        if w == 1 && h == 1 {
            break;
        }
    }
    (all, count, first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use twelvefold::Domain;

    fn plan(size: (u32, u32), capacity: Capacity, order: Order) -> Result<Plan, GpuError> {
        let placement = Placement::new(Domain::UNIT, 3);
        Plan::new(&placement, size, capacity, order, Points::Relaxed, 4)
    }

    #[test]
    fn passes_need_no_more_than_every_device_has() {
        for order in [Order::Ordered, Order::Append] {
            let plan = plan((1000, 300), Capacity::points(100_000), order).unwrap();
            let passes = plan.passes();
            assert_eq!(passes.len(), if order == Order::Ordered { 9 } else { 8 });
            for pass in passes {
                let uniform = |b: &&Binding| matches!(b, Binding::Placed | Binding::Frame);
                let storage = pass.bindings.len() - pass.bindings.iter().filter(uniform).count();
                assert!(storage <= 8, "{pass:?}");
                assert!(pass.bindings.is_sorted_by_key(|binding| *binding as u32));
                // A dispatch may not write the buffer that its own arguments are in.
                let writes = pass.bindings.contains(&Binding::Arguments);
                assert!(!(writes && pass.groups == Groups::Indirect));
            }
            assert!(plan.bytes(Binding::Placed) <= 65_536);
        }
    }

    #[test]
    fn domains_without_a_border_are_refused() {
        let placement = Placement::seamless(twelvefold::Domain::UNIT, 1).unwrap();
        let (capacity, order) = (Capacity::points(100), Order::Ordered);
        let plan = Plan::new(&placement, (4, 4), capacity, order, Points::Fixed, 1);
        assert_eq!(plan.err(), Some(GpuError::Seamless));
    }

    #[test]
    fn what_no_buffer_holds_is_refused() {
        let small = Capacity::points(100);
        for size in [(0, 1), (1, 0), (8193, 1), (8192, 8192)] {
            assert!(matches!(plan(size, small, Order::Ordered), Err(GpuError::Size { .. })));
        }
        for points in [0, (1 << 24) + 1, u32::MAX] {
            let refused = plan((4, 4), Capacity::points(points), Order::Ordered).err();
            assert_eq!(refused, Some(GpuError::Capacity { points }));
        }
        for capacity in [
            Capacity { candidates: 0, ..small },
            Capacity { candidates: u32::MAX, ..small },
            Capacity { subtiles: 0, ..small },
            Capacity { subtiles: u32::MAX, ..small },
        ] {
            assert_eq!(plan((4, 4), capacity, Order::Ordered).err(), Some(GpuError::Room));
        }
        let plan = plan((4, 4), small, Order::Ordered).unwrap();
        for density in [-1.0, f64::NAN, f64::INFINITY, 1e300, 1e-300] {
            assert!(plan.frame(density).is_err(), "{density}");
        }
        assert!(plan.frame(0.0).is_ok() && plan.frame(1.0).is_ok());
    }
}
