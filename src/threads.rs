//! Work on parts of a slice, by rayon's threads where there are any: parts share nothing, so that the
//! result does not depend on who does which.

/// Dots a part: a tenth of a millisecond.
#[cfg(feature = "std")]
pub(crate) const PART: usize = 512;

/// How many parts are worked on at a time.
pub(crate) fn count() -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "parallel"))]
    1
}

/// Calls `work` with every `part` elements and the index of the first.
#[cfg(feature = "std")]
#[inline(always)]
pub(crate) fn for_parts<T: Send>(
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

/// Calls `work` with each element, and returns a failure if there is one.
pub(crate) fn for_each<T: Send, E: Send>(
    all: &mut [T],
    work: impl Fn(&mut T) -> Result<(), E> + Sync + Send,
) -> Result<(), E> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        all.par_iter_mut().try_for_each(work)
    }
    #[cfg(not(feature = "parallel"))]
    all.iter_mut().try_for_each(work)
}
