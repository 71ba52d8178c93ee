//! The order of triangles: along a Hilbert curve through space, so that neighbors on the curve are near.

use glam::DVec3;

/// Bits a coordinate.
const BITS: u32 = 16;

/// How far along a Hilbert curve through the cube [0, 1]³ the cell of a point comes.
///
/// J. Skilling, *Programming the Hilbert curve* (2004): undo the turns of each level from the top down,
/// then Gray-decode, then interleave.
pub(super) fn place(at: DVec3) -> u64 {
    let most = f64::from((1u32 << BITS) - 1);
    // Truncation takes NaN, of a mesh without extent, to 0.
    let mut cell = at.to_array().map(|x| (x * most) as u32);
    let mut bit = 1u32 << (BITS - 1);
    while bit > 1 {
        let below = bit - 1;
        for i in 0..3 {
            if cell[i] & bit != 0 {
                cell[0] ^= below;
            } else {
                let swapped = (cell[0] ^ cell[i]) & below;
                cell[0] ^= swapped;
                cell[i] ^= swapped;
            }
        }
        bit >>= 1;
    }
    cell[1] ^= cell[0];
    cell[2] ^= cell[1];
    let mut turn = 0;
    let mut bit = 1u32 << (BITS - 1);
    while bit > 1 {
        if cell[2] & bit != 0 {
            turn ^= bit - 1;
        }
        bit >>= 1;
    }
    let [x, y, z] = cell.map(|c| u64::from(c ^ turn));
    (0..BITS).rev().fold(0, |place, bit| {
        let digit = (x >> bit & 1) << 2 | (y >> bit & 1) << 1 | (z >> bit & 1);
        place << 3 | digit
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_cell_on_the_curve_is_a_neighbor() {
        // The first 3 bits of each coordinate: 512 cells.
        let mut cells: std::vec::Vec<_> = (0..512u32)
            .map(|i| {
                let cell = [i & 7, i >> 3 & 7, i >> 6].map(f64::from);
                (place((DVec3::from_array(cell) + 0.01) / 8.0) >> (3 * (BITS - 3)), cell)
            })
            .collect();
        cells.sort_by_key(|(place, _)| *place);
        assert!(cells.iter().map(|(place, _)| *place).eq(0..512));
        for pair in cells.windows(2) {
            let [a, b] = [pair[0].1, pair[1].1].map(DVec3::from_array);
            assert_eq!((a - b).abs().element_sum(), 1.0, "{a} {b}");
        }
    }
}
