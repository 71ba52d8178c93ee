//! The snub-square tiling 3².4.3.4: a square-triangle tiling that repeats.
//!
//! Its vertices are tiles of the types c and d, four to a square cell of 2 cos 15° edges, so that it can stand
//! in for a root: subdivided, it keeps the periods, λ times as many edges long at each level.

use super::cyclotomic::Cyclotomic;
use super::tile::TileType;

/// The sides of the cell: 1 + ζ and ζ³ + ζ⁴, at 15° and 105°.
pub const CELL: [Cyclotomic; 2] = [Cyclotomic([1, 1, 0, 0]), Cyclotomic([-1, 0, 1, 1])];

/// The tiles of a cell: type, rotation in units of 30°, center in edges.
pub const VERTICES: [(TileType, u8, Cyclotomic); 4] = [
    (TileType::C, 0, Cyclotomic::ZERO),
    (TileType::C, 6, Cyclotomic([0, 0, 1, 0])),
    (TileType::D, 3, Cyclotomic([0, 1, 1, 0])),
    (TileType::D, 9, Cyclotomic([0, 0, 1, 1])),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// `z` less the multiples of the cell's sides that leave it nearest to 0, if any do.
    fn is_period(z: Cyclotomic) -> bool {
        let [a, b] = CELL.map(|side| side.0);
        (-3..=3).any(|i| (-3..=3).any(|j| (0..4).all(|c| z.0[c] == i * a[c] + j * b[c])))
    }

    #[test]
    fn every_edge_of_every_star_leads_to_a_vertex_whose_star_leads_back() {
        for (kind, rotation, center) in VERTICES {
            for k in kind.star() {
                let edge = Cyclotomic::zeta_power((k + rotation).into());
                let end = center.checked_add(edge).unwrap();
                let others: std::vec::Vec<_> = VERTICES
                    .iter()
                    .filter(|(.., other)| is_period(end.checked_sub(*other).unwrap()))
                    .collect();
                let [(other, turned, _)] = others[..] else { panic!("{others:?}") };
                let back = (k + rotation + 6) % 12;
                assert!(other.star().iter().any(|k| (k + turned) % 12 == back));
                // One parity for all.
                assert_eq!((kind.parity() + rotation) % 2, (other.parity() + turned) % 2);
            }
        }
    }
}
