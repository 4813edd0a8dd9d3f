//! How fast designs and poses are evaluated: `cargo bench --no-default-features`.
//!
//! - `pose`: everything the constraints look at, at one reachable pose; the general 6×6 stiffness against the closed form.
//! - `design`: one evaluation on the reference grid; a Sobol sample of the paper's bounds, and designs of a converged front.
//! - `threads`: the front's designs on one thread and on two.

use std::cell::Cell;
use std::hint::black_box;
use std::ops::{Add, Div, Mul, Neg, Sub};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec2;
use kinefront::evaluation::{GridChoice, Model};
use kinefront::kinematics::Jacobian;
use kinefront::lanes::{InstructionSet, Planar, Real};
use kinefront::mechanism::{Architecture, Design, Leg, PrrLeg, RprLeg, RrrLeg};
use kinefront::optimize::sobol;
use kinefront::spatial::{LEGS, Rotation};
use kinefront::stiffness::joint_model;
use kinefront::study::{DesignProblem, Study};
use kinefront::workspace::{PoseChecker, ValueColumns};
use rayon::prelude::*;

/// Designs of one architecture, spread over the paper's bounds.
fn sample(architecture: Architecture, count: usize) -> Vec<Design> {
    let study = Study {
        architectures: vec![architecture],
        ..Study::default()
    };
    let problem = DesignProblem::new(&study);
    let sample = sobol(&problem.variables(), count, 1);
    sample.iter().map(|x| problem.design(x).expect("a design")).collect()
}

/// Designs of a converged front.
fn front() -> Vec<Design> {
    include_str!("front.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.parse().expect("a design"))
        .collect()
}

/// A design in one orientation, with positions that it reaches there.
struct Batch<L> {
    checker: PoseChecker<L>,
    arms: [DVec2; LEGS],
    xs: Vec<f64>,
    ys: Vec<f64>,
}

/// A number that counts what is done with it; what does not depend on the position is done once an orientation and not
/// counted.
#[derive(Clone, Copy)]
struct Counted {
    value: f64,
    varies: bool,
}

thread_local! {
    /// Sums and products, quotients, square roots, comparisons and choices.
    static OPERATIONS: Cell<[u32; 4]> = const { Cell::new([0; 4]) };
}

impl Counted {
    fn made(value: f64, from: &[Counted], kind: usize) -> Self {
        let varies = from.iter().any(|operand| operand.varies);
        if varies {
            OPERATIONS.with(|cell| {
                let mut counts = cell.get();
                counts[kind] += 1;
                cell.set(counts);
            });
        }
        Self { value, varies }
    }
}

impl Add for Counted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::made(self.value + other.value, &[self, other], 0)
    }
}

impl Sub for Counted {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::made(self.value - other.value, &[self, other], 0)
    }
}

impl Mul for Counted {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        // A factor of 1 (the drive of a telescopic leg) is known to the compiler.
        let one = |operand: Self| !operand.varies && operand.value == 1.0;
        if one(self) {
            other
        } else if one(other) {
            self
        } else {
            Self::made(self.value * other.value, &[self, other], 0)
        }
    }
}

impl Div for Counted {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::made(self.value / other.value, &[self, other], 1)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self::made(-self.value, &[self], 3)
    }
}

impl Real for Counted {
    type Mask = bool;

    fn splat(self, value: f64) -> Self {
        Self { value, varies: false }
    }

    fn sqrt(self) -> Self {
        Self::made(self.value.sqrt(), &[self], 2)
    }

    fn abs(self) -> Self {
        Self::made(self.value.abs(), &[self], 3)
    }

    fn at_least(self, other: Self) -> bool {
        Self::made(0.0, &[self, other], 3);
        self.value >= other.value
    }

    fn exceeds(self, other: Self) -> bool {
        Self::made(0.0, &[self, other], 3);
        self.value > other.value
    }

    fn where_set(self, mask: bool, other: Self) -> Self {
        Self::made(if mask { self.value } else { other.value }, &[self, other], 3)
    }
}

/// Prints what one pose costs in floating-point operations.
fn count_operations<L: Leg>(architecture: Architecture, batch: &Batch<L>) {
    OPERATIONS.set([0; 4]);
    let [x, y] = [batch.xs[1], batch.ys[1]].map(|value| Counted { value, varies: true });
    let arms = batch.arms.map(|arm| Planar::splat(x, arm));
    black_box(batch.checker.lanes(Planar::new(x, y), &arms).k_xy.value);
    let [linear, quotients, roots, choices] = OPERATIONS.get();
    println!(
        "{architecture}: {linear} sums and products, {quotients} quotients, {roots} roots, {choices} comparisons and choices"
    );
}

/// Positions in a batch.
const BATCH: usize = 64;

/// Designs of a Sobol sample, each with positions spread evenly over a disc that it reaches.
fn batches<L: Leg>(architecture: Architecture) -> Vec<Batch<L>> {
    let model = Model::default();
    let mut found = Vec::new();
    for design in sample(architecture, 512) {
        let checker = model.checker::<L>(&design).expect("a whole grid");
        let evaluation = model.evaluate(&design, GridChoice::Reference).expect("a whole grid");
        let Some(home) = evaluation.home else { continue };
        let arms = checker.manipulator.arms(&Rotation::new(home.phi));
        let [xs, ys] = [0, 1].map(|axis| {
            (0..BATCH)
                .map(|k| {
                    // A sunflower: even in area.
                    let radius = evaluation.workspace_radius * ((k as f64 + 0.5) / BATCH as f64).sqrt();
                    let angle = 2.399_963 * k as f64;
                    radius * if axis == 0 { angle.cos() } else { angle.sin() }
                })
                .collect()
        });
        found.push(Batch { checker, arms, xs, ys });
    }
    found
}

fn poses_of<L: Leg>(criterion: &mut Criterion, architecture: Architecture) {
    let mut batches = batches::<L>(architecture);
    count_operations(architecture, &batches[0]);
    let mut group = criterion.benchmark_group("pose");
    group.throughput(Throughput::Elements((batches.len() * BATCH) as u64));
    let posture = |batch: &Batch<L>, k: usize| {
        let position = DVec2::new(batch.xs[k], batch.ys[k]);
        let posture = batch.checker.manipulator.posture_at(position, &batch.arms);
        posture.ok().expect("reachable")
    };
    group.bench_function(BenchmarkId::new("general 6x6", architecture), |bencher| {
        bencher.iter(|| {
            for batch in &batches {
                let model = batch.checker.stiffness.as_ref().expect("stiff");
                for k in 0..BATCH {
                    let posture = posture(batch, k);
                    let condition = Jacobian::new(&posture).inverse_condition(batch.checker.length);
                    black_box((
                        condition,
                        joint_model::stiffness(model, &batch.checker.manipulator, &posture),
                    ));
                }
            }
        });
    });
    group.bench_function(BenchmarkId::new("closed form", architecture), |bencher| {
        bencher.iter(|| {
            for batch in &batches {
                for k in 0..BATCH {
                    let posture = posture(batch, k);
                    black_box(batch.checker.values_at(&posture, &Jacobian::new(&posture)));
                }
            }
        });
    });
    for instructions in InstructionSet::available() {
        for batch in &mut batches {
            batch.checker.instructions = instructions;
        }
        let mut values = ValueColumns::default();
        let name = format!("reduced, {}", instructions.name());
        group.bench_function(BenchmarkId::new(name, architecture), |bencher| {
            bencher.iter(|| {
                for batch in &batches {
                    batch
                        .checker
                        .at_positions(&batch.arms, &batch.xs, &batch.ys, &mut values);
                    black_box(&values);
                }
            });
        });
    }
    group.finish();
}

fn poses(criterion: &mut Criterion) {
    poses_of::<PrrLeg>(criterion, Architecture::Prr);
    poses_of::<RprLeg>(criterion, Architecture::Rpr);
    poses_of::<RrrLeg>(criterion, Architecture::Rrr);
}

fn evaluate(model: &Model, design: &Design) -> f64 {
    model
        .evaluate(design, GridChoice::Reference)
        .expect("a whole grid")
        .workspace_radius
}

fn designs(criterion: &mut Criterion) {
    let model = Model::default();
    let mut group = criterion.benchmark_group("design");
    group.sample_size(20);
    let mut bench = |name: BenchmarkId, designs: &[Design]| {
        group.throughput(Throughput::Elements(designs.len() as u64));
        group.bench_function(name, |bencher| {
            bencher.iter(|| designs.iter().map(|design| evaluate(&model, design)).sum::<f64>());
        });
    };
    for &architecture in Architecture::ALL {
        bench(BenchmarkId::new("sobol", architecture), &sample(architecture, 256));
    }
    bench(BenchmarkId::new("front", "3-PRR"), &front());
    group.finish();
}

fn threads(criterion: &mut Criterion) {
    let model = Model::default();
    let designs = front();
    let mut group = criterion.benchmark_group("threads");
    group.sample_size(20);
    group.throughput(Throughput::Elements(designs.len() as u64));
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        group.bench_function(BenchmarkId::from_parameter(threads), |bencher| {
            bencher.iter(|| pool.install(|| designs.par_iter().map(|design| evaluate(&model, design)).sum::<f64>()));
        });
    }
    group.finish();
}

criterion_group!(benches, poses, designs, threads);
criterion_main!(benches);
