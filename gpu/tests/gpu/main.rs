//! The GPU's points against the CPU's, to the bit. Without an adapter these tests say so and pass, unless
//! `TWELVEFOLD_REQUIRE_GPU` is set.

mod device;
mod exact;
mod golden;
mod relaxed;
