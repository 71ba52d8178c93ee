//! The tiles at which every frame starts: all of one level from which points come.

use twelvefold::bake::class::Classes;
use twelvefold::export::{self, Export, FIRST_RELAXED_LEVEL};
use twelvefold::tiling::{Cyclotomic, FCode, Rules, TileType};
use twelvefold::{Domain, Placement};

use crate::error::GpuError;
use crate::keys::{KEY_LEVEL, Keys, count};

/// Words of a tile in the buffer.
pub(crate) const TILE_WORDS: usize = 12;

/// ((u + v√3)/2, (p + q√3)/2).
type Exact = [i32; 4];

/// A tile on the way down.
#[derive(Clone, Copy)]
struct Tile {
    kind: TileType,
    rotation: u8,
    level: u8,
    /// The level of its center's birth.
    born: u8,
    center: Exact,
    rank: u64,
    key: u32,
    classes: Classes,
    /// How its parent, its grandparent and its great-grandparent are turned.
    ancestors: [u8; 3],
}

/// Start tiles as words, and what they were made with.
pub(crate) struct StartTiles {
    /// [`TILE_WORDS`] a tile, then the lineages of old tiles.
    pub(crate) words: Vec<u32>,
    pub(crate) count: u32,
    pub(crate) keys: Keys,
}

/// The geometry that decides which tiles are kept.
pub(crate) struct Reach<'a> {
    pub(crate) domain: Domain,
    pub(crate) export: &'a Export,
    /// The longest relaxed vector, in edges of a point's level; 0 for fixed points.
    pub(crate) longest: f64,
}

impl Reach<'_> {
    /// How far, in units, relaxation moves points of `level` or later at most.
    pub(crate) fn margin(&self, level: u8) -> f64 {
        let level =
            usize::from(level.max(FIRST_RELAXED_LEVEL)).min(self.export.half_edges.len() - 1);
        2.0 * self.export.half_edges[level].length() * self.longest * (1.0 + 1e-6)
    }

    /// Whether points come from a tile: its own center, or what is born below it.
    fn holds(&self, tile: &Tile) -> bool {
        let level = usize::from(tile.level);
        let [u, v, p, q] = tile.center.map(f64::from);
        let root = twelvefold::tiling::numbers::SQRT_3;
        let at = glam::DVec2::new(u + root * v, p + root * q);
        let at = self.export.origin + self.export.half_edges[level].rotate(at);
        let distance = at.clamp(glam::DVec2::ZERO, self.domain.size()).distance(at);
        let slack = 4e-6 * self.domain.diagonal();
        distance <= self.export.reach[level] + self.margin(tile.level + 1) + slack
            || distance <= self.margin(tile.born) + slack
    }
}

/// How a start level is chosen: the coarsest at which a tile has at most so many points. Finer ones have
/// more tiles to classify; coarser ones bound the importance less sharply: at 400, thin rings have 13
/// candidates a point. Blocks hold 2716.
const POINTS_A_TILE: f64 = 120.0;

/// The finest start level: 160,000 tiles of 48 bytes. Deeper tiles come from opening these.
const FINEST: u8 = 9;

/// The start tiles for about so many points.
pub(crate) fn start_tiles(
    placement: &Placement<'_>,
    reach: &Reach<'_>,
    points: u32,
) -> Result<StartTiles, GpuError> {
    let rules = placement.tables().rules();
    let walk = Walk { rules: &rules, turned: turned_offsets(&rules)?, reach };
    let frontier = walk.frontier()?;
    let mut level = KEY_LEVEL;
    // In ranks: a level-m tile owns 1/N_m of the root.
    let ranks = f64::from(points) / reach.domain.area() * reach.export.ranks_per_density;
    while level < FINEST && ranks > POINTS_A_TILE * count(level.into()) as f64 {
        level += 1;
    }
    Ok(walk.collect(&frontier, level))
}

struct Walk<'a> {
    rules: &'a Rules,
    /// By type and digit: the child's offset at each rotation of the parent.
    turned: [Vec<[Exact; 12]>; 4],
    reach: &'a Reach<'a>,
}

fn turned_offsets(rules: &Rules) -> Result<[Vec<[Exact; 12]>; 4], GpuError> {
    let mut all: [Vec<[Exact; 12]>; 4] = Default::default();
    for kind in TileType::ALL {
        for child in rules.children(kind) {
            let mut row = [[0; 4]; 12];
            for (rotation, turned) in (0u8..).zip(&mut row) {
                *turned = surds(child.offset, rotation)?;
            }
            all[kind.index()].push(row);
        }
    }
    Ok(all)
}

fn surds(offset: Cyclotomic, rotation: u8) -> Result<Exact, GpuError> {
    let surds = offset.checked_rotate(rotation).and_then(Cyclotomic::to_surds);
    let [x, y] = surds.map_err(|_| GpuError::Tiling)?;
    let mut exact = [0; 4];
    for (to, from) in exact.iter_mut().zip([x.whole, x.root, y.whole, y.root]) {
        *to = i32::try_from(from).map_err(|_| GpuError::Tiling)?;
    }
    Ok(exact)
}

impl Walk<'_> {
    /// The placement's frontier with its ancestry; keys are not yet known.
    fn frontier(&self) -> Result<Vec<Tile>, GpuError> {
        let export = self.reach.export;
        let level = export.frontier_level;
        let mut tiles = Vec::new();
        for tile in &export.frontier {
            let code = FCode::from_rank(TileType::A, level.into(), tile.rank)
                .map_err(|_| GpuError::Tiling)?;
            let (mut kind, mut rotation, mut ancestors) = (TileType::A, 0, [0; 3]);
            let mut classes = Classes::root(kind);
            let mut born = 0;
            for (above, digit) in (0u8..).zip(code.oldest_first()) {
                let children = self.rules.children(kind);
                let child = children.get(usize::from(digit)).ok_or(GpuError::Tiling)?;
                ancestors = [rotation, ancestors[0], ancestors[1]];
                (kind, rotation) = (child.kind, (rotation + child.rotation) % 12);
                classes = classes.child(digit, child.kind);
                born = if digit == 0 { born } else { above + 1 };
            }
            tiles.push(Tile {
                kind: tile.kind,
                rotation: tile.rotation,
                level,
                born,
                center: tile.center,
                rank: tile.rank,
                key: 0,
                classes,
                ancestors,
            });
        }
        Ok(tiles)
    }

    /// The children from which points come, with the key strides S_j and S_{j−1} of the parent.
    fn children(&self, tile: &Tile, strides: [u32; 2]) -> impl Iterator<Item = Tile> {
        let [u, v, p, q] = tile.center;
        let finer = [2 * u + 3 * v, u + 2 * v, 2 * p + 3 * q, p + 2 * q];
        let here = count(tile.level.into());
        let before = if tile.level == 0 { 1 } else { count(usize::from(tile.level) - 1) };
        let offsets = &self.turned[tile.kind.index()];
        (0u8..).zip(self.rules.children(tile.kind)).zip(offsets).filter_map(
            move |((digit, child), offsets)| {
                let offset = offsets[usize::from(tile.rotation)];
                let carry = digit == 13;
                let tile = Tile {
                    kind: child.kind,
                    rotation: (tile.rotation + child.rotation) % 12,
                    level: tile.level + 1,
                    born: if digit == 0 { tile.born } else { tile.level + 1 },
                    center: std::array::from_fn(|i| finer[i] + offset[i]),
                    rank: tile.rank + u64::from(digit) * here - if carry { before } else { 0 },
                    key: tile.key + u32::from(digit) * strides[0]
                        - if carry { strides[1] } else { 0 },
                    classes: tile.classes.child(digit, child.kind),
                    ancestors: [tile.rotation, tile.ancestors[0], tile.ancestors[1]],
                };
                self.reach.holds(&tile).then_some(tile)
            },
        )
    }

    /// All tiles of a level, depth first, so that neighbors in the list are neighbors in the plane.
    fn collect(&self, frontier: &[Tile], level: u8) -> StartTiles {
        let mut references: Vec<Tile> =
            frontier.iter().flat_map(|tile| self.children(tile, [0; 2])).collect();
        references.sort_by_key(|tile| tile.rank);
        let keys = Keys::new(references.iter().map(|tile| tile.rank).collect());
        let mut list = List { words: Vec::new(), lineages: Vec::new(), level, keys: &keys };
        for (key, reference) in (0u32..).zip(&references) {
            let mut path = vec![Tile { key, ..*reference }];
            self.descend(&mut path, &mut list);
        }
        let List { mut words, lineages, .. } = list;
        let count = (words.len() / TILE_WORDS) as u32;
        words.extend(lineages);
        StartTiles { words, count, keys }
    }

    fn descend(&self, path: &mut Vec<Tile>, list: &mut List<'_>) {
        let Some(tile) = path.last().copied() else { return };
        if tile.level == list.level {
            list.push(path, self.reach.longest > 0.0);
            return;
        }
        let below = i32::from(tile.level) - i32::from(KEY_LEVEL);
        let strides = [list.keys.stride(below), list.keys.stride(below - 1)];
        for child in self.children(&tile, strides) {
            path.push(child);
            self.descend(path, list);
            path.pop();
        }
    }
}

/// The words as they grow.
struct List<'a> {
    words: Vec<u32>,
    lineages: Vec<u32>,
    level: u8,
    keys: &'a Keys,
}

impl List<'_> {
    /// The last tile of a path from a reference tile.
    fn push(&mut self, path: &[Tile], relaxed: bool) {
        let Some(tile) = path.last() else { return };
        self.words.push(tile.key);
        let born = u32::from(tile.born) << 11;
        let level = u32::from(tile.level) << 6;
        self.words.push(tile.kind.index() as u32 | u32::from(tile.rotation) << 2 | level | born);
        self.words.extend(tile.center.map(|n| n as u32));
        self.words.extend([tile.rank as u32, (tile.rank >> 32) as u32]);
        let [parent, grand, great] = tile.ancestors.map(u32::from);
        let oldest = tile.classes.over(4) | parent << 18 | grand << 22 | great << 26;
        self.words.extend([young_classes(&tile.classes), oldest]);
        self.words.extend([self.lineages.len() as u32, 0]);
        // Where the importance is low, an old center is a point of a coarser level and reads the vector of
        // the tile that it is there.
        let first = tile.born.max(FIRST_RELAXED_LEVEL);
        if relaxed {
            for level in first..tile.level {
                let Some(older) = path.iter().find(|tile| tile.level == level) else { continue };
                let [_, grand, great] = older.ancestors.map(u32::from);
                let kind = older.kind.index() as u32;
                let turns = grand << 18 | great << 22 | kind << 26;
                self.lineages
                    .extend([young_classes(&older.classes), older.classes.over(4) | turns]);
            }
        }
    }
}

/// Classes over 1, 2 and 3 generations in 6, 10 and 14 bits.
fn young_classes(classes: &Classes) -> u32 {
    classes.over(1) | classes.over(2) << 6 | classes.over(3) << 16
}

/// For each level, the 12 edges of a turned tile, as the CPU rounds them.
pub(crate) fn turned_edges(placement: &Placement<'_>) -> Vec<u32> {
    (0..=twelvefold::tiling::MAX_LEVEL as u8)
        .flat_map(|level| (0..12).map(move |rotation| (level, rotation)))
        .flat_map(|(level, rotation)| {
            let edge = export::turned_edge(placement, level, rotation);
            [(edge.x as f32).to_bits(), (edge.y as f32).to_bits()]
        })
        .collect()
}
