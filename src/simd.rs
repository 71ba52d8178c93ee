//! Wider vector instructions, chosen when the program runs.
//!
//! Closures run through [`Simd`] are compiled several times, for the baseline of the target and for
//! AVX2 or AVX-512 where they exist; all of them round alike, so that the points are the same.

/// The widest instructions of this machine that this build knows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simd {
    #[cfg(feature = "simd")]
    arch: pulp::Arch,
}

impl Simd {
    /// Asks the machine once, and then remembers: a nanosecond.
    #[inline(always)]
    pub(crate) fn detect() -> Self {
        Self {
            #[cfg(feature = "simd")]
            arch: pulp::Arch::new(),
        }
    }

    /// Runs the closure; what is inlined into it uses these instructions.
    #[inline(always)]
    pub(crate) fn run<R>(self, work: impl FnOnce() -> R) -> R {
        #[cfg(feature = "simd")]
        return self.arch.dispatch(work);
        #[cfg(not(feature = "simd"))]
        work()
    }
}
