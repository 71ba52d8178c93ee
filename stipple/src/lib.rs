//! Photographs as dots, from the picture to the file: what the program and the page share.
//!
//! `wish`: what is wanted. `budget`: how many dots, and how large. `gain`: what ink covers. `raw`: where they go. `dots`: and are refined to. `frames`: those of moving pictures.
//! `page`: what they are drawn on. `drawing`: the files.

#![allow(
    missing_docs,
    reason = "for the doors of this workspace only; what a name does not say is documented"
)]

pub mod budget;
pub mod dots;
pub mod drawing;
pub mod error;
pub mod frames;
pub mod gain;
pub mod page;
pub mod raw;
pub mod wish;
