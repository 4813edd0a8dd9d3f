//! The smallest time that the machine can take for the operations of a pose: as many operations of each kind, none of
//! which waits for another.

use pulp::{Arch, Simd, WithSimd};

use super::counted::Operations;

/// Number of independent operations of one kind in flight, more than any latency requires.
const CHAINS: usize = 12;
/// Number of independent operations in flight of the kinds that take long.
const SLOW: usize = 4;

/// Runs the operations of [`poses`] poses on the widest registers.
pub fn run(operations: Operations, start: f64) -> f64 {
    Arch::new().dispatch(Mix { operations, start })
}

/// Returns the number of poses whose operations [`run`] does.
pub fn poses() -> usize {
    struct Lanes;
    impl WithSimd for Lanes {
        type Output = usize;
        fn with_simd<S: Simd>(self, _: S) -> usize {
            S::F64_LANES
        }
    }
    CHAINS * Arch::new().dispatch(Lanes)
}

struct Mix {
    operations: Operations,
    start: f64,
}

impl WithSimd for Mix {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Operations {
            sums_and_products,
            quotients,
            roots,
            comparisons_and_choices,
        } = self.operations;
        let factor = simd.splat_f64s(self.start);
        let small = simd.splat_f64s(1e-9);
        let mut limit = factor;
        let mut chains = [factor; CHAINS];
        let mut slow = [factor; SLOW];
        // A round is an operation on every chain. Quotients and roots are distributed evenly over the rounds, one at a
        // time, so that they run in parallel with the others.
        let rounds = sums_and_products + comparisons_and_choices;
        let (mut quotients_due, mut roots_due) = (0, 0);
        let mut round = 0;
        macro_rules! round {
            ($($slow:literal)+) => {$(
                if round >= sums_and_products {
                    // The limit changes, so that the compiler cannot omit a round.
                    limit = simd.sub_f64s(limit, small);
                    for chain in &mut chains[..CHAINS / 2] {
                        *chain = simd.select_f64s(simd.greater_than_f64s(*chain, limit), limit, *chain);
                    }
                } else if round % 2 == 0 {
                    for chain in &mut chains {
                        *chain = simd.mul_f64s(*chain, factor);
                    }
                } else {
                    for chain in &mut chains {
                        *chain = simd.add_f64s(*chain, factor);
                    }
                }
                quotients_due += CHAINS * quotients;
                roots_due += CHAINS * roots;
                if quotients_due >= rounds {
                    quotients_due -= rounds;
                    slow[$slow] = simd.div_f64s(factor, slow[$slow]);
                } else if roots_due >= rounds {
                    roots_due -= rounds;
                    slow[$slow] = simd.sqrt_f64s(slow[$slow]);
                }
                round += 1;
            )+};
        }
        while round < rounds {
            round!(0 1 2 3);
        }
        let mut sum = limit;
        for chain in chains.into_iter().chain(slow) {
            sum = simd.add_f64s(sum, chain);
        }
        simd.reduce_sum_f64s(sum)
    }
}
