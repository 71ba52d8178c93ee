//! Placements: where in the infinite tiling a domain lies.

mod torus;

use glam::DVec2;

use crate::domain::Domain;
use crate::error::SamplingError;
use crate::random::SplitMix64;
use crate::tables::{DisplacementTable, ExactPoint, Tables};
use crate::tiling::counts::Numbering;
use crate::tiling::numbers::{REACH, SQRT_3, direction, lambda_power};
use crate::tiling::{FCode, MAX_LEVEL, RankError, TileCounts, TileType};
use crate::tree::frame::Frame;
use crate::tree::node::Node;
use torus::Torus;

/// The level of the few tiles at which every walk of a placement starts.
pub(crate) const FRONTIER_LEVEL: u8 = 4;

const _: () = assert!(FRONTIER_LEVEL == torus::ROOT_LEVEL + 1, "children of roots");

/// Points of earlier levels stay where they are: they occur where fewer than some four points are
/// expected in a domain, and the tiles from which they could move in would be very many.
pub(crate) const FIRST_RELAXED_LEVEL: u8 = FRONTIER_LEVEL + 2;

/// The most frontier tiles. Their centers are at least one edge apart and lie within 1.09 edges of
/// the domain's center (half a diagonal plus the reach of a tile, [`FRONTIER_EDGE`]), so that no more
/// than 9 fit; relaxed points can move in from up to 0.58 edges farther
/// ([`MAX_LENGTH`](crate::bake::displacement::MAX_LENGTH)), which admits 17.
const MAX_FRONTIER: usize = 24;

/// The edge of the frontier's tiles, in diagonals of the domain. The root's edge is λ⁴ = 194 times
/// that, 258 diagonals: roots under 128 domain widths give measurably biased sets, because a window
/// is then likely to hold one of the root's oldest points.
const FRONTIER_EDGE: f64 = 4.0 / 3.0;

/// Successive tile counts differ by a factor of at most 14, edges by its root; a little more for rounding.
const MAX_STRETCH: f64 = 3.75;

/// The part of [`REACH`] that descendants at most 0, 1, 2, 3 levels down come near: a child is within
/// 2 cos 15°/λ edges, a grandchild within 2 cos 15°(1/λ + 1/λ²), and so on: 1 − λ^−j of the whole.
/// Rounded up.
const WITHIN: [f64; 5] = [0.0, 0.732_050_81, 0.928_203_24, 0.980_762_12, 1.0];

/// Every point of the plane within this many edges of an `a` center is covered by its descendants.
const INNER_RADIUS: f64 = 1.0 - REACH;

/// Position, rotation and scale of a domain inside a far larger root tile, all from one seed.
///
/// A placement fixes an endless sequence of points in its domain, dense everywhere, each with a rank;
/// an importance decides how far into the sequence each place goes. Since position and rotation are
/// random, points accepted by an importance are an unbiased sample of it.
///
/// Making one costs microseconds: it finds the path from the root down to the at most nine tiles
/// that touch the domain. Keep it from frame to frame.
#[derive(Clone, Debug)]
pub struct Placement<'t> {
    domain: Domain,
    tables: Tables<'t>,
    /// In [0, 1), added to every rank before it is compared.
    rank_shift: f64,
    numbering: Numbering,
    frontier: [Option<Node>; MAX_FRONTIER],
    /// What stands in for the root and the frontier of a seamless domain.
    torus: Option<Torus>,
    /// The reference tile's center, relative to the domain's least corner.
    origin: DVec2,
    /// For each level: the vector of half an edge along the tiling's x axis.
    half_edges: [DVec2; MAX_LEVEL + 1],
    /// For each level: [`REACH`] of its edges, in units.
    reach: [f64; MAX_LEVEL + 1],
    /// f32 positions are off by up to 2⁻²¹ diagonals; this is twice that, and what adding the corner
    /// rounds.
    slack: f64,
    /// The area of the whole root, or torus, in squared units.
    root_area: f64,
}

impl Placement<'static> {
    /// The domain's placement under this seed, with the tables of this build.
    #[must_use]
    pub fn new(domain: Domain, seed: u64) -> Self {
        Self::new_in(domain, seed, Tables::built_in())
    }

    /// A placement whose scale makes a constant density a *complete level* of the tiling.
    ///
    /// At `density` points a squared unit the threshold T is the tile count of a level, and the points
    /// are all tile centers of that level: far more even than between levels (least distance 0.96 of the
    /// hexagonal lattice's, and integration as accurate as with the best low-discrepancy sets), for
    /// any density. With an importance, pass the density that its most common value will get.
    ///
    /// Position and rotation stay random, so points are as unbiased a sample as under
    /// [`new`](Self::new); only the scale is no longer the domain's.
    ///
    /// ```
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling};
    /// let placement = Placement::aligned(Domain::UNIT, 7, 1000.0)?;
    /// let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Density(1000.0))?;
    /// assert!((sampling.expected_points().unwrap() - 1000.0).abs() < 1e-9);
    /// # Ok::<(), twelvefold::SamplingError>(())
    /// ```
    ///
    /// # Errors
    /// [`SamplingError::Amount`] unless the density is finite and positive, [`SamplingError::TooDense`]
    /// past the deepest level.
    pub fn aligned(domain: Domain, seed: u64, density: f64) -> Result<Self, SamplingError> {
        Self::aligned_in(domain, seed, density, Tables::built_in())
    }

    /// The placement of a domain that has no border: opposite sides are one, and copies of its points side
    /// by side in rows and columns show no seam.
    ///
    /// The domain's sides must be as k to l, whole numbers up to 16 (rounding in `f32` is forgiven): the
    /// domain is k × l cells of a square-triangle tiling that repeats, whose subdivisions repeat with it.
    /// All else is as under [`new`](Self::new), with these differences:
    ///
    /// - The number of points under a constant importance is exact: n for n points asked for.
    /// - Importance continues on the other side: a map should wrap too, or its own seam will show.
    /// - Distances are those of the torus: at 56·k·l, 780·k·l, 10,864·k·l … points the set is a complete
    ///   level, as in [`aligned`](Self::aligned).
    /// - Relaxed points cross the border. One that would enter a place of importance 0 there stays at its
    ///   center. Where density is at most that of 780·k·l points, all stay there: the tiles that they would be
    ///   told apart by are above the roots.
    /// - Only position and quarter turns are random: rows of points at 15° and every 30° from there are as
    ///   likely in any place, so that estimates are unbiased, but no other direction gets its turn.
    ///
    /// ```
    /// use glam::DVec2;
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling};
    /// let placement = Placement::seamless(Domain::UNIT, 7)?;
    /// let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(780.0))?;
    /// let points: Vec<DVec2> =
    ///     sampling.points()?.map(|p| Ok(p?.position)).collect::<Result<_, twelvefold::SamplingError>>()?;
    /// assert_eq!(points.len(), 780);
    /// // The nearest neighbors are equally far apart, over the border as well.
    /// let distance = |a: DVec2, b: DVec2| {
    ///     let away = (a - b).abs();
    ///     away.min(1.0 - away).length()
    /// };
    /// let nearest = |a: &DVec2| {
    ///     points.iter().filter(|b| *b != a).map(|b| distance(*a, *b)).fold(1.0, f64::min)
    /// };
    /// assert!(points.iter().all(|a| (nearest(a) - nearest(&points[0])).abs() < 1e-12));
    /// # Ok::<(), twelvefold::SamplingError>(())
    /// ```
    ///
    /// # Errors
    /// [`SamplingError::Ratio`] for sides that are not as k to l.
    pub fn seamless(domain: Domain, seed: u64) -> Result<Self, SamplingError> {
        Self::seamless_in(domain, seed, Tables::built_in())
    }
}

impl<'t> Placement<'t> {
    /// The same with other tables. Tables of another depth but the same digits give the same points.
    #[must_use]
    pub fn new_in(domain: Domain, seed: u64, tables: Tables<'t>) -> Self {
        Self::with_scale(domain, seed, FRONTIER_EDGE, tables)
    }

    /// [`aligned`](Placement::aligned) with other tables.
    ///
    /// # Errors
    /// As [`aligned`](Placement::aligned).
    pub fn aligned_in(
        domain: Domain,
        seed: u64,
        density: f64,
        tables: Tables<'t>,
    ) -> Result<Self, SamplingError> {
        if !(density > 0.0 && density.is_finite()) {
            return Err(SamplingError::Amount { value: density });
        }
        // The smallest level that makes the root no smaller than it is without alignment: at most λ
        // times as large, so that the frontier is no larger than it is there.
        let diagonal = domain.diagonal();
        let least_edge = frontier_edges_per_root() * FRONTIER_EDGE * diagonal;
        let least_tiles = density * (0.5 * SQRT_3 * least_edge * least_edge);
        let tiles = TileCounts::HEXAGON
            .all()
            .iter()
            .map(|tiles| *tiles as f64)
            .find(|tiles| *tiles >= least_tiles)
            .ok_or(SamplingError::TooDense { near: domain.disc().center })?;
        let stretch = libm::sqrt(tiles / least_tiles);
        if !stretch.is_finite() || stretch > MAX_STRETCH {
            // Less than one point in the whole root: any scale is as good.
            return Ok(Self::new_in(domain, seed, tables));
        }
        Ok(Self::with_scale(domain, seed, FRONTIER_EDGE * stretch, tables))
    }

    /// [`seamless`](Placement::seamless) with other tables.
    ///
    /// # Errors
    /// As [`seamless`](Placement::seamless).
    pub fn seamless_in(
        domain: Domain,
        seed: u64,
        tables: Tables<'t>,
    ) -> Result<Self, SamplingError> {
        let size = domain.size();
        let ratio = SamplingError::Ratio { width: size.x, height: size.y };
        let cells = Torus::cells_of(size).ok_or(ratio)?;
        let numbering =
            Numbering::of_pentagons(Torus::roots(cells), torus::ROOT_LEVEL).ok_or(ratio)?;
        let mut random = SplitMix64::new(seed);
        let quarters = (random.next_u64() >> 62) as u8;
        let shift = DVec2::new(random.unit(), random.unit());
        let rank_shift = random.unit();
        let torus = Torus::new(size, cells, shift, quarters);
        let root_half_edge = Torus::half_edge(size, cells);
        let half_edges = core::array::from_fn(|level| {
            let root = usize::from(torus::ROOT_LEVEL);
            match level.checked_sub(root) {
                Some(below) => root_half_edge / lambda_power(below),
                None => root_half_edge * lambda_power(root - level),
            }
        });
        Ok(Self {
            domain,
            tables,
            rank_shift,
            numbering,
            frontier: [None; MAX_FRONTIER],
            origin: torus.origin() + 0.0,
            torus: Some(torus),
            half_edges,
            reach: half_edges.map(|half: DVec2| REACH * 2.0 * half.length()),
            slack: Self::slack(&domain),
            root_area: domain.area(),
        })
    }

    /// Twice what rounding in `f32` puts positions off, and what adding the corner rounds.
    fn slack(domain: &Domain) -> f64 {
        let farthest = domain.min().abs().max(domain.max().abs()).max_element();
        domain.diagonal() * 1e-6 + farthest * 1e-15
    }

    /// The placement whose frontier tiles have an edge of `frontier_edge` diagonals of the domain.
    fn with_scale(domain: Domain, seed: u64, frontier_edge: f64, tables: Tables<'t>) -> Self {
        let mut random = SplitMix64::new(seed);
        let axis = DVec2::from_array(random.direction());
        // The domain's center in root edges. Density ∝ (1 − r²)² towards the rim rather than uniform:
        // the bias that a finite root leaves is ten times smaller.
        let root_edge = frontier_edges_per_root() * frontier_edge * domain.diagonal();
        let range = INNER_RADIUS - 0.5 * domain.diagonal() / root_edge;
        let center = range * DVec2::from_array(random.in_disc(2));
        let rank_shift = random.unit();

        let mut placement = Self {
            domain,
            tables,
            rank_shift,
            numbering: Numbering::HEXAGON,
            frontier: [None; MAX_FRONTIER],
            torus: None,
            origin: DVec2::ZERO,
            half_edges: core::array::from_fn(|level| {
                0.5 * (root_edge / lambda_power(level)) * axis
            }),
            reach: core::array::from_fn(|level| REACH * root_edge / lambda_power(level)),
            slack: Self::slack(&domain),
            // A root `a` owns √3/2 squared edges.
            root_area: 0.5 * SQRT_3 * root_edge * root_edge,
        };
        placement.find_frontier(center, frontier_edge);
        placement
    }

    /// Walks from the root to the tiles of the frontier level whose descendants can reach the domain,
    /// whose center is `center` in root edges; their edge is `frontier_edge` diagonals.
    fn find_frontier(&mut self, center: DVec2, frontier_edge: f64) {
        let mut count = 0;
        let mut nearest = (f64::INFINITY, ExactPoint::default());
        // Depth first; at most 13 siblings wait on each of the levels above the frontier.
        let mut stack = [Node::root(); 14 * FRONTIER_LEVEL as usize];
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let node = stack[waiting];
            // Everything in edges of this level.
            let to_domain = center * lambda_power(node.level.into()) - node.center.to_dvec2();
            let half_diagonal =
                0.5 / frontier_edge / lambda_power(usize::from(FRONTIER_LEVEL - node.level));
            // Relaxed points move in from farther away.
            let step = self.tables.displacements().map_or(0.0, DisplacementTable::longest)
                / lambda_power(usize::from(FIRST_RELAXED_LEVEL - node.level));
            if to_domain.length() > REACH + half_diagonal + step + 1e-9 {
                continue;
            }
            if node.level == FRONTIER_LEVEL {
                if to_domain.length() < nearest.0 {
                    nearest = (to_domain.length(), node.center);
                }
                debug_assert!(count < MAX_FRONTIER, "the packing bound of MAX_FRONTIER");
                if let Some(slot) = self.frontier.get_mut(count) {
                    *slot = Some(node);
                    count += 1;
                }
                continue;
            }
            for digit in (0..node.kind.child_count()).rev() {
                if let Some(child) = node.child(&self.tables, &self.numbering, digit) {
                    stack[waiting] = child;
                    waiting += 1;
                }
            }
        }

        // From here on, coordinates are relative to the tile nearest to the domain's center.
        let (_, reference) = nearest;
        for node in self.frontier.iter_mut().flatten() {
            node.center = node.center.minus(reference);
        }
        let level = usize::from(FRONTIER_LEVEL);
        let from_domain = reference.to_dvec2() - center * lambda_power(level);
        let edge = 2.0 * self.half_edges[level];
        // + 0.0 turns a −0.0 into 0.0, so that sums do not depend on the sign of a zero term.
        self.origin = 0.5 * self.domain.size() + edge.rotate(from_domain) + 0.0;
    }

    /// The domain.
    #[must_use]
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// The tables.
    #[must_use]
    pub fn tables(&self) -> &Tables<'t> {
        &self.tables
    }

    /// The tiles at which walks start.
    #[cfg(test)]
    pub(crate) fn frontier(&self) -> impl Iterator<Item = Node> {
        (0..).map_while(|i| self.frontier_node(i))
    }

    /// Tile `i` of those at which walks start.
    pub(crate) fn frontier_node(&self, i: usize) -> Option<Node> {
        match &self.torus {
            None => *self.frontier.get(i)?,
            Some(torus) => torus.node(&self.tables, &self.numbering, i),
        }
    }

    /// The first of them from tile `i` on, and which it is; of a seamless domain, those whose ranks are not
    /// below `limit` are passed over.
    pub(crate) fn frontier_below(&self, i: usize, limit: u64) -> Option<(usize, Node)> {
        match &self.torus {
            None => Some((i, (*self.frontier.get(i)?)?)),
            Some(torus) => torus.node_below(&self.tables, &self.numbering, i, limit),
        }
    }

    /// Whether a seamless domain has roots that do not reach all around it.
    pub(crate) fn has_many_roots(&self) -> bool {
        self.torus.as_ref().is_some_and(Torus::has_many_cells)
    }

    /// The root of tile `i` of the frontier of a seamless domain, with its center in the domain.
    pub(crate) fn root_of(&self, i: usize) -> Option<Node> {
        self.torus.as_ref().map(|torus| torus.root_of(i))
    }

    /// The root of a tile of the frontier, and the way from it, which always is.
    pub(crate) fn way_to(&self, node: &Node) -> (Node, Result<FCode, RankError>) {
        match &self.torus {
            None => {
                let code = FCode::from_rank(TileType::A, node.level.into(), node.rank);
                (Node::root(), code)
            }
            Some(torus) => torus.way_to(node),
        }
    }

    /// Whether opposite sides of the domain are one.
    #[inline(always)]
    pub(crate) fn is_seamless(&self) -> bool {
        self.torus.is_some()
    }

    /// How the placement's tiles are numbered.
    #[inline(always)]
    pub(crate) fn numbering(&self) -> &Numbering {
        &self.numbering
    }

    /// The reference tile's center, relative to the domain's least corner.
    pub(crate) fn origin(&self) -> DVec2 {
        self.origin
    }

    /// The number in [0, 1) that is added to every rank before it is compared.
    pub(crate) fn rank_shift(&self) -> f64 {
        self.rank_shift
    }

    /// How many ranks correspond to one point a squared unit: the area of the root or the torus.
    pub(crate) fn ranks_per_density(&self) -> f64 {
        self.root_area
    }

    /// The greatest threshold T in ranks: the tile count of the deepest level.
    pub(crate) fn greatest_threshold(&self) -> f64 {
        self.deepest_count() as f64
    }

    /// The tile count of the deepest level.
    pub(crate) fn deepest_count(&self) -> u64 {
        self.numbering.counts().all()[MAX_LEVEL]
    }

    /// Half an edge of `level`, along the tiling's x axis, in units.
    pub(crate) fn half_edge(&self, level: u8) -> DVec2 {
        self.half_edges[usize::from(level)]
    }

    /// An edge of `level` that makes `rotation`·30° with the tiling's x axis, in units.
    pub(crate) fn turned_edge(&self, level: u8, rotation: u8) -> DVec2 {
        (2.0 * self.half_edge(level)).rotate(DVec2::from_array(direction(rotation)))
    }

    /// A node's center, relative to the domain's least corner.
    pub(crate) fn center(&self, node: &Node) -> DVec2 {
        let half_edge = self.half_edge(node.level);
        DVec2::from_array(Frame::new(half_edge, self.origin, 0).position(node.center))
    }

    /// The radius, in units, of a disc around a node's center that holds all descendants of the node
    /// that are born at most `levels` levels below it, as computed in either precision.
    pub(crate) fn reach(&self, level: u8, levels: usize) -> f64 {
        self.reach[usize::from(level)] * WITHIN[levels.min(WITHIN.len() - 1)] + self.slack
    }
}

/// Frontier edges in a root edge, λ⁴.
fn frontier_edges_per_root() -> f64 {
    lambda_power(FRONTIER_LEVEL.into())
}
