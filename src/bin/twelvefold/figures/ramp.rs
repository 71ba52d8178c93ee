//! Figure 5: a gray ramp and its dots.

use twelvefold::tiling::Rules;

use super::Result;

pub(super) fn ramp(_: &Rules) -> Result<String> {
    Err("waiting for the sampler".into())
}
