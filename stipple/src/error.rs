//! Why there are no dots.

use std::fmt;

use glam::DVec2;
use twelvefold::estimate::ExactError;
use twelvefold::refine::RefineError;
use twelvefold::{MapError, SamplingError};

/// Why there are no dots, or no more of them.
#[derive(Debug)]
pub enum DotsError<E> {
    Map(MapError),
    Sampling(SamplingError),
    Exact(ExactError),
    Refine(RefineError),
    /// There is no memory for a list of so many dots.
    Memory(usize),
    /// Whoever takes the dots failed.
    Taker(E),
}

impl<E> DotsError<E> {
    /// The same, or for a taker's failure what `of` makes of it.
    pub(crate) fn map_taker<F>(self, of: impl FnOnce(E) -> DotsError<F>) -> DotsError<F> {
        match self {
            Self::Map(error) => DotsError::Map(error),
            Self::Sampling(error) => DotsError::Sampling(error),
            Self::Exact(error) => DotsError::Exact(error),
            Self::Refine(error) => DotsError::Refine(error),
            Self::Memory(count) => DotsError::Memory(count),
            Self::Taker(error) => of(error),
        }
    }
}

impl<E: fmt::Display> fmt::Display for DotsError<E> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(error) => error.fmt(out),
            Self::Sampling(error) => error.fmt(out),
            Self::Exact(error) => error.fmt(out),
            Self::Refine(error) => error.fmt(out),
            Self::Memory(count) => {
                write!(
                    out,
                    "there is no memory for {} MiB of dots",
                    (count * size_of::<DVec2>()) >> 20
                )
            }
            Self::Taker(error) => error.fmt(out),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> std::error::Error for DotsError<E> {}
