//! Sharing a walk: a part of its batches, so that the parts in order are the whole.
//!
//! The walk of any part visits the tiles above a grain; a subtree below the grain is one piece, taken
//! whole or not at all. Pieces are laid end to end by their work, in the order of the walk, and a part
//! is an interval of that line: it holds the pieces that begin in it.

/// Which part of a walk's pieces is taken.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shard {
    /// A subtree with at most this much work is one piece.
    grain: u64,
    from: u64,
    to: u64,
    /// The work of the pieces that the walk has passed.
    passed: u64,
    /// How many tiles were open when the current piece began.
    piece_depth: Option<usize>,
}

impl Shard {
    /// No piece at all: a walk that only measures.
    pub(crate) fn nothing(grain: u64) -> Self {
        Self { grain, from: 0, to: 0, passed: 0, piece_depth: None }
    }

    /// Part `index` of `of` of a walk that passed `total` work, `index` < `of`.
    pub(crate) fn part(grain: u64, total: u64, index: usize, of: usize) -> Self {
        let cut = |i: usize| (u128::from(total) * i as u128 / of as u128) as u64;
        let (from, to) = (cut(index), cut(index + 1));
        Self { from, to, ..Self::nothing(grain) }
    }

    /// The work passed.
    pub(crate) fn passed(&self) -> u64 {
        self.passed
    }

    /// Whether work this small is one piece.
    pub(crate) fn is_piece(&self, work: u64) -> bool {
        work <= self.grain
    }

    /// Whether the walk, with `depth` open tiles, is in a piece that is taken.
    pub(crate) fn is_in_piece(&self, depth: usize) -> bool {
        self.piece_depth.is_some_and(|piece| depth > piece)
    }

    /// Passes a piece that begins with `depth` open tiles: whether it is taken.
    pub(crate) fn take(&mut self, work: u64, depth: usize) -> bool {
        let taken = (self.from..self.to).contains(&self.passed);
        self.passed = self.passed.saturating_add(work);
        self.piece_depth = taken.then_some(depth);
        taken
    }
}
