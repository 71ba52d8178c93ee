//! Work on parts of a slice, by rayon's threads where there are any: parts share nothing, so that the
//! result does not depend on who does which.

/// Dots a part: a tenth of a millisecond.
pub(super) const PART: usize = 512;

/// Calls `work` with every `part` elements and the index of the first.
#[inline(always)]
pub(super) fn for_parts<T: Send>(
    all: &mut [T],
    part: usize,
    work: impl Fn(usize, &mut [T]) + Sync + Send,
) {
    let part = part.max(1);
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        all.par_chunks_mut(part).enumerate().for_each(|(index, some)| work(index * part, some));
    }
    #[cfg(not(feature = "parallel"))]
    all.chunks_mut(part).enumerate().for_each(|(index, some)| work(index * part, some));
}
