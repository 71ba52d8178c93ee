//! One class: its dots, and where they should be.

use alloc::vec::Vec;

use super::super::cells::{Cells, Dot};
use super::super::density::Density;
use super::super::error::{RefineError, filled};
use super::super::ink::Ink;
use super::planes::Classes;
use super::pyramid::Pyramid;
use crate::simd::Simd;

/// The dots of one class and where they should be.
#[derive(Debug)]
pub(super) struct Class<'a> {
    pub(super) ink: Ink<'a>,
    pub(super) density: Density,
    pub(super) pyramid: Pyramid,
    pub(super) cells: Cells,
    pub(super) dots: Vec<Dot>,
    pub(super) sorted: Vec<Dot>,
}

impl<'a> Class<'a> {
    pub(super) fn new(
        classes: &'a Classes,
        plane: usize,
        count: usize,
    ) -> Result<Option<Self>, RefineError> {
        let (width, height) = (classes.width, classes.height);
        let Some(ink) = Ink::new(width, height, &classes.planes[plane])? else { return Ok(None) };
        if count == 0 {
            return Ok(None);
        }
        let density = Simd::detect().run(
            #[inline(always)]
            || Density::new(&ink, count),
        )?;
        let pyramid = Pyramid::new(&density)?;
        let cells = Cells::new(&ink, count, density.usual_spacing)?;
        let dots = filled(count, Dot::default())?;
        let sorted = filled(count, Dot::default())?;
        Ok(Some(Self { ink, density, pyramid, cells, dots, sorted }))
    }
}
