//! The random draws that the algorithms need, based on the ChaCha8 generator.
//!
//! They are implemented here rather than taken from a crate of distributions, because such crates may change their
//! streams between versions, whereas a random seed must reproduce the same run in every version. The generator itself
//! is specified to the bit.

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// A stream of random draws from one random seed.
#[derive(Debug, Clone)]
pub struct Random(ChaCha8Rng);

impl Random {
    /// Creates the stream of the random seed `seed`.
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Draws a uniform number in \[0, 1) with 53 random bits.
    pub fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Draws an almost normal number of mean 0 and variance 1: the sum of three uniform numbers of 21 bits, which share one word.
    pub fn almost_normal(&mut self) -> f64 {
        let word = self.0.next_u64();
        let part = |shift: u32| ((word >> shift) & 0x1f_ffff) as f64;
        2.0 * ((part(0) + part(21) + part(42)) / f64::from(1u32 << 21) - 1.5)
    }

    /// Returns `true` with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.uniform() < probability
    }

    /// Draws a uniform integer from 0 to `count` − 1 (multiply and shift; the bias is below `count`·2⁻⁶⁴).
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.0.next_u64()) * count as u128) >> 64) as usize
    }

    /// Shuffles the items (Fisher–Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}
