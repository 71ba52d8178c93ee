//! What a frame reports.

/// The first words of the counters: how a frame went. Read them back when it suits, frames later.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// The points that the importance wants, also where there was no room.
    pub points: u32,
    /// The candidates that were to be tested.
    pub candidates: u32,
    /// The tiles below opened ones.
    pub subtiles: u32,
    flags: u32,
}

impl Status {
    /// Words to read.
    pub const WORDS: usize = 4;

    /// From the words of the counters' buffer.
    #[must_use]
    pub const fn from_words([points, flags, candidates, subtiles]: [u32; Self::WORDS]) -> Self {
        Self { points, candidates, subtiles, flags }
    }

    /// Whether every point was written.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        self.flags & 15 == 0
    }

    /// There were more points than room: the rest was not written. In an ordered frame those that were are
    /// the first ones.
    #[must_use]
    pub const fn lacks_points(&self) -> bool {
        self.flags & 1 != 0
    }

    /// There were more candidates than room.
    #[must_use]
    pub const fn lacks_candidates(&self) -> bool {
        self.flags & 2 != 0
    }

    /// There were more subtiles than room.
    #[must_use]
    pub const fn lacks_subtiles(&self) -> bool {
        self.flags & 4 != 0
    }

    /// Somewhere the importance asks for points deeper than six levels below a start tile (some 70,000
    /// times the density that the capacity means) or past the last level; some are missing there.
    #[must_use]
    pub const fn is_too_dense(&self) -> bool {
        self.flags & 8 != 0
    }

    /// Some points have [`NO_KEY`](crate::NO_KEY): 32 bits number 1.3 billion points a domain at its
    /// brightest place. The points themselves are right.
    #[must_use]
    pub const fn lacks_keys(&self) -> bool {
        self.flags & 16 != 0
    }
}
