//! Forces between the points of a patch, gathered into the table entries that the points read.

use glam::{DVec2, Vec2};

use super::site::{Site, cosine_and_sine};

/// Forces reach this many spacings √(s_i·s_j).
const REACH: f32 = 2.0;

/// Pairs are listed a little further, so that a list serves several sweeps.
const LISTED: f32 = 2.3;

/// The force between two points at distance r, in units of √(s_i·s_j):
/// exp(−r²/2σ²)·r/σ + stiffness·(contact − r) for r < contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// σ.
    pub sigma: f64,
    /// The stiffness of contacts.
    pub stiffness: f64,
    /// Points nearer than this touch.
    pub contact: f64,
}

/// A law tabled over r²: force divided by r.
#[derive(Clone, Debug)]
pub struct LawTable(Vec<f32>);

const LAW_STEPS: usize = 2048;

impl Law {
    /// Tables the law.
    #[must_use]
    pub fn table(&self) -> LawTable {
        let reach = f64::from(REACH);
        let force_over_r = |k: usize| {
            let squared = reach * reach * k as f64 / LAW_STEPS as f64;
            let r = libm::sqrt(squared).max(0.02);
            let soft = libm::exp(-squared / (2.0 * self.sigma * self.sigma)) / self.sigma;
            soft + self.stiffness * (self.contact - r).max(0.0) / r
        };
        LawTable((0..=LAW_STEPS + 1).map(|k| force_over_r(k) as f32).collect())
    }
}

impl LawTable {
    #[inline]
    fn over_r(&self, squared: f32) -> f32 {
        let t = squared * (LAW_STEPS as f32 / (REACH * REACH));
        let k = t as usize;
        let (a, b) = (self.0[k], self.0[k + 1]);
        a + (b - a) * (t - k as f32)
    }
}

/// The most entries that one point reads: two slots of two layers.
pub const READS: usize = 4;

/// What a gathered sum holds: force in the grandparent's frame and weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    /// Σ weight · force.
    pub force: Vec2,
    /// Σ weight.
    pub weight: f32,
}

/// Points of one patch, ready for many sweeps.
#[derive(Clone, Debug)]
pub struct Points {
    centers: Vec<Vec2>,
    /// Edge · (cos, sin) of the grandparent's rotation.
    frames: Vec<Vec2>,
    reads: Vec<[(u32, f32); READS]>,
    spacings: Vec<f32>,
    /// Points that gather; the others, at the border, only push.
    gathers: Vec<bool>,
    positions: Vec<Vec2>,
    forces: Vec<Vec2>,
    pair_starts: Vec<u32>,
    pairs: Vec<u32>,
    /// The first entry that any point reads; the sums begin there.
    pub first: usize,
    /// Gathered sums.
    pub sums: Vec<Sum>,
}

impl Points {
    /// From sites, what each reads, and which of them gather.
    #[must_use]
    pub fn new(
        sites: &[Site],
        reads: impl Fn(&Site) -> [(u32, f32); READS],
        gathers: impl Fn(&Site) -> bool,
    ) -> Self {
        let reads: Vec<_> = sites.iter().map(reads).collect();
        let used = || reads.iter().flatten().filter(|r| r.1 > 0.0).map(|r| r.0 as usize);
        let first = used().min().unwrap_or(0);
        let end = used().max().map_or(first, |e| e + 1);
        let frame =
            |site: &Site| DVec2::from(cosine_and_sine(site.rotation)).as_vec2() * site.edge as f32;
        Self {
            centers: sites.iter().map(|s| s.center.as_vec2()).collect(),
            frames: sites.iter().map(frame).collect(),
            reads,
            spacings: sites.iter().map(|s| s.spacing as f32).collect(),
            gathers: sites.iter().map(gathers).collect(),
            positions: vec![Vec2::ZERO; sites.len()],
            forces: vec![Vec2::ZERO; sites.len()],
            pair_starts: Vec::new(),
            pairs: Vec::new(),
            first,
            sums: vec![Sum::default(); end - first],
        }
    }

    /// Moves the centers by vectors in the grandparents' frames, in edges: a part that is not trained.
    pub fn displace(&mut self, vector: impl Fn(usize) -> Vec2) {
        for (i, (center, f)) in self.centers.iter_mut().zip(&self.frames).enumerate() {
            let v = vector(i);
            *center += Vec2::new(f.x * v.x - f.y * v.y, f.y * v.x + f.x * v.y);
        }
    }

    /// How many points there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.centers.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.centers.is_empty()
    }

    /// Moves the points by the table, lists pairs anew if asked to, and gathers forces.
    pub fn sweep(&mut self, vectors: &[[f32; 2]], law: &LawTable, list_pairs: bool) {
        for (i, position) in self.positions.iter_mut().enumerate() {
            let mut v = Vec2::ZERO;
            for (entry, weight) in self.reads[i] {
                if weight > 0.0 {
                    v += Vec2::from(vectors[entry as usize]) * weight;
                }
            }
            let f = self.frames[i];
            *position = self.centers[i] + Vec2::new(f.x * v.x - f.y * v.y, f.y * v.x + f.x * v.y);
        }
        if list_pairs || self.pair_starts.is_empty() {
            self.list_pairs();
        }
        self.push(law);
        self.gather();
    }

    fn list_pairs(&mut self) {
        self.pair_starts.clear();
        self.pairs.clear();
        let widest = self.spacings.iter().copied().fold(0.0, f32::max);
        let cell = LISTED * widest;
        let low = self.positions.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let high = self.positions.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        if self.is_empty() || cell <= 0.0 {
            self.pair_starts.resize(self.len() + 1, 0);
            return;
        }
        let columns = ((high.x - low.x) / cell) as usize + 1;
        let rows = ((high.y - low.y) / cell) as usize + 1;
        let cell_of = |p: Vec2| {
            let (x, y) = (((p.x - low.x) / cell) as usize, ((p.y - low.y) / cell) as usize);
            y.min(rows - 1) * columns + x.min(columns - 1)
        };
        // Counting sort by cell.
        let mut starts = vec![0u32; columns * rows + 1];
        for p in &self.positions {
            starts[cell_of(*p) + 1] += 1;
        }
        for c in 0..columns * rows {
            starts[c + 1] += starts[c];
        }
        let mut members = vec![0u32; self.len()];
        let mut next = starts.clone();
        for (i, p) in self.positions.iter().enumerate() {
            let slot = &mut next[cell_of(*p)];
            members[*slot as usize] = i as u32;
            *slot += 1;
        }
        let sorted: Vec<(Vec2, f32)> = members
            .iter()
            .map(|i| (self.positions[*i as usize], self.spacings[*i as usize]))
            .collect();
        for (i, p) in self.positions.iter().enumerate() {
            self.pair_starts.push(self.pairs.len() as u32);
            let spacing = self.spacings[i] * LISTED * LISTED;
            let own = cell_of(*p);
            let (x, y) = (own % columns, own / columns);
            for row in y.saturating_sub(1)..(y + 2).min(rows) {
                let from = starts[row * columns + x.saturating_sub(1)] as usize;
                let to = starts[row * columns + (x + 2).min(columns)] as usize;
                for k in from..to {
                    let (q, s) = sorted[k];
                    if members[k] as usize > i && (q - *p).length_squared() < spacing * s {
                        self.pairs.push(members[k]);
                    }
                }
            }
        }
        self.pair_starts.push(self.pairs.len() as u32);
    }

    fn push(&mut self, law: &LawTable) {
        self.forces.fill(Vec2::ZERO);
        for i in 0..self.len() {
            let (p, spacing) = (self.positions[i], self.spacings[i]);
            let mut own = Vec2::ZERO;
            let range = self.pair_starts[i] as usize..self.pair_starts[i + 1] as usize;
            for &j in &self.pairs[range] {
                let j = j as usize;
                let d = p - self.positions[j];
                let unit = 1.0 / (spacing * self.spacings[j]);
                let squared = d.length_squared() * unit;
                if squared < REACH * REACH {
                    let force = d * (law.over_r(squared) * libm::sqrtf(unit));
                    own += force;
                    self.forces[j] -= force;
                }
            }
            self.forces[i] += own;
        }
    }

    fn gather(&mut self) {
        self.sums.fill(Sum::default());
        for i in 0..self.len() {
            if !self.gathers[i] {
                continue;
            }
            let (f, frame) = (self.forces[i], self.frames[i]);
            // Back into the grandparent's frame; the length of the frame is the edge.
            let edge = libm::sqrtf(frame.length_squared());
            let turned =
                Vec2::new(frame.x * f.x + frame.y * f.y, frame.x * f.y - frame.y * f.x) / edge;
            for (entry, weight) in self.reads[i] {
                if weight > 0.0 {
                    let sum = &mut self.sums[entry as usize - self.first];
                    sum.force += turned * weight;
                    sum.weight += weight;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use twelvefold::bake::class::Classes;
    use twelvefold::tiling::TileType;

    fn site(x: f64, y: f64, rotation: u8) -> Site {
        Site {
            center: DVec2::new(x, y),
            rank: 0,
            level: 9,
            edge: 1.0,
            rotation,
            classes: Classes::root(TileType::A),
            tau: 2.0,
            detail: 0.0,
            spacing: 1.0,
        }
    }

    #[test]
    fn close_points_push_each_other_apart_in_their_own_frames() {
        let sites = [site(0.0, 0.0, 0), site(0.5, 0.0, 3), site(9.0, 0.0, 0)];
        let law = Law { sigma: 0.4, stiffness: 3.0, contact: 0.8 };
        let entry = |s: &Site| [((s.center.x * 2.0) as u32, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)];
        let mut points = Points::new(&sites, entry, |_| true);
        assert_eq!((points.first, points.sums.len(), points.len()), (0, 19, 3));
        points.sweep(&[[0.0; 2]; 19], &law.table(), true);
        let expected = (-0.25f64 / 0.32).exp() * 0.5 / 0.4 + 3.0 * 0.3;
        let (left, right, far) = (points.sums[0], points.sums[1], points.sums[18]);
        assert!((f64::from(left.force.x) + expected).abs() < 1e-3, "{left:?} {expected}");
        assert!(left.force.y.abs() < 1e-6);
        // Its frame is turned by 90°: a push to the right is one along −y there.
        assert!((f64::from(right.force.y) + expected).abs() < 1e-3, "{right:?}");
        assert_eq!((far.force, far.weight), (Vec2::ZERO, 1.0));
    }

    #[test]
    fn the_table_moves_points_before_they_push() {
        let sites = [site(0.0, 0.0, 0), site(0.5, 0.0, 3)];
        let law = Law { sigma: 0.4, stiffness: 0.0, contact: 0.0 };
        let entry = |s: &Site| [((s.center.x * 2.0) as u32, 0.5), (2, 0.5), (0, 0.0), (0, 0.0)];
        let mut points = Points::new(&sites, entry, |s| s.center.x > 0.0);
        // The second goes down by (2 + 0)/2 in its frame's x, which is the plane's y.
        points.sweep(&[[0.0; 2], [-2.0, 0.0], [0.0; 2]], &law.table(), true);
        let r = 1.25f64.sqrt();
        let strength = (-1.25f64 / 0.32).exp() * r / 0.4;
        // Along (0.5, −1)/r in the plane: (−1, −0.5)/r in the frame; half of it to each entry.
        let expected = [-strength / r * 0.5, -0.5 * strength / r * 0.5];
        for sum in [points.sums[1], points.sums[2]] {
            assert!((f64::from(sum.force.x) - expected[0]).abs() < 1e-4, "{sum:?} {expected:?}");
            assert!((f64::from(sum.force.y) - expected[1]).abs() < 1e-4, "{sum:?} {expected:?}");
            assert_eq!(sum.weight, 0.5);
        }
        assert_eq!(points.sums[0], Sum::default());
    }
}
