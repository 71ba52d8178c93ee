//! The position formula's golden vectors, on CPU and GPU.

use std::fmt::Write;

use glam::DVec2;
use twelvefold::export::{Export, position};
use twelvefold::{Domain, Placement};
use twelvefold_gpu::{Arithmetic, choose_arithmetic, golden, is_exact};

use crate::device::device;

#[test]
fn golden_positions_are_the_cpus() {
    let vectors = golden();
    assert_eq!(vectors.len(), 1024);
    for vector in vectors {
        let single = |bits: [u32; 2]| DVec2::from_array(bits.map(|b| f32::from_bits(b).into()));
        let at = position(single(vector.origin), single(vector.half_edge), vector.at);
        assert_eq!(at.to_array().map(f32::to_bits), vector.position, "{vector:?}");
    }
}

#[test]
fn golden_positions_are_the_gpus_but_not_plainly() {
    let Some(gpu) = device() else { return };
    let exact = |arithmetic| is_exact(&gpu.device, &gpu.queue, arithmetic).unwrap();
    assert!(exact(Arithmetic::Integers));
    assert_eq!(
        choose_arithmetic(&gpu.device, &gpu.queue).unwrap() == Arithmetic::Barriers,
        exact(Arithmetic::Barriers)
    );
    if std::env::var_os("TWELVEFOLD_REQUIRE_GPU").is_some() {
        assert!(exact(Arithmetic::Barriers) && !exact(Arithmetic::Plain));
    }
}

/// They are made here, so that a formula that is changed on purpose can renew them:
/// `TWELVEFOLD_BLESS=1 cargo test -p twelvefold-gpu --test gpu the_committed_vectors`.
#[test]
fn the_committed_vectors_are_those_of_today() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/golden.txt");
    let made = vectors();
    if std::env::var_os("TWELVEFOLD_BLESS").is_some() {
        return std::fs::write(path, made).unwrap();
    }
    let committed = std::fs::read_to_string(path).unwrap();
    let different = made.lines().zip(committed.lines()).find(|(made, committed)| made != committed);
    assert_eq!(different, None);
    assert_eq!(made.lines().count(), committed.lines().count());
}

/// A line for each: placements' own numbers of every level, and integers from a generator.
fn vectors() -> String {
    let mut text = String::new();
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        (state >> 32) as i32
    };
    for i in 0..1024u64 {
        let size = [1.0, 1024.0, 3e-3][i as usize % 3];
        let domain = Domain::new(DVec2::ZERO, DVec2::new(size, 0.7 * size)).unwrap();
        let export = Export::of(&Placement::new(domain, i));
        let level = 4 + (i as usize / 3) % 13;
        // About as many edges as a domain has at this level.
        let shift = 30u32.saturating_sub(2 * level as u32).max(1);
        let at = [next() >> shift, next() >> shift, next() >> shift, next() >> shift];
        let bits = |v: DVec2| v.to_array().map(|x| (x as f32).to_bits());
        let (origin, half_edge) = (bits(export.origin), bits(export.half_edges[level]));
        let single = |bits: [u32; 2]| DVec2::from_array(bits.map(|b| f32::from_bits(b).into()));
        let place = position(single(origin), single(half_edge), at).to_array().map(f32::to_bits);
        let [u, v, p, q] = at;
        for word in origin.iter().chain(&half_edge).chain(&place) {
            write!(text, "{word:08x} ").unwrap();
        }
        writeln!(text, "{u} {v} {p} {q}").unwrap();
    }
    text
}
