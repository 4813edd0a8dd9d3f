//! What the processor can do at best: `cargo bench --no-default-features --bench machine`.
//!
//! Independent operations on full registers, enough of them in flight to hide every latency. With the counts that
//! `--bench evaluation` prints this gives the least time a pose can take.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pulp::{Arch, Simd, WithSimd};

/// Operations in flight.
const CHAINS: usize = 12;
/// Operations of each chain in one run.
const LENGTH: usize = 1000;

#[derive(Clone, Copy)]
enum Operation {
    SumsAndProducts,
    Quotients,
    Roots,
    Choices,
}

struct Run {
    operation: Operation,
    start: f64,
}

impl WithSimd for Run {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let mut chains = [simd.splat_f64s(self.start); CHAINS];
        let factor = simd.splat_f64s(black_box(1.000_001));
        let mut limit = factor;
        for _ in 0..LENGTH {
            if let Operation::Choices = self.operation {
                limit = simd.sub_f64s(limit, simd.splat_f64s(1e-9));
            }
            for chain in &mut chains {
                *chain = match self.operation {
                    // Half and half.
                    Operation::SumsAndProducts => simd.add_f64s(simd.mul_f64s(*chain, factor), factor),
                    Operation::Quotients => simd.div_f64s(factor, *chain),
                    Operation::Roots => simd.sqrt_f64s(*chain),
                    Operation::Choices => simd.select_f64s(simd.greater_than_f64s(*chain, factor), factor, *chain),
                };
            }
        }
        let mut sum = simd.splat_f64s(0.0);
        for chain in chains {
            sum = simd.add_f64s(sum, chain);
        }
        simd.reduce_sum_f64s(sum)
    }
}

struct Count;

impl WithSimd for Count {
    type Output = usize;

    fn with_simd<S: Simd>(self, _: S) -> usize {
        S::F64_LANES
    }
}

fn machine(criterion: &mut Criterion) {
    let arch = Arch::new();
    let lanes = arch.dispatch(Count);
    println!("{lanes} lanes");
    let mut group = criterion.benchmark_group("machine");
    for (name, operation, each) in [
        ("sums and products", Operation::SumsAndProducts, 2),
        ("quotients", Operation::Quotients, 1),
        ("roots", Operation::Roots, 1),
        ("comparisons and choices", Operation::Choices, 2),
    ] {
        group.throughput(Throughput::Elements((CHAINS * LENGTH * each * lanes) as u64));
        group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
            bencher.iter(|| {
                black_box(arch.dispatch(Run {
                    operation,
                    start: black_box(2.0),
                }))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, machine);
criterion_main!(benches);
