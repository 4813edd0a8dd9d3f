//! How fast designs and poses are evaluated: `cargo bench --no-default-features`.
//!
//! - `pose`: everything the constraints look at, at one reachable pose; the general 6×6 stiffness against the closed form.
//! - `design`: one evaluation on the reference grid; a Sobol sample of the paper's bounds, and designs of a converged front.
//! - `threads`: the front's designs on one thread and on two.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use kinefront::evaluation::{GridChoice, Model};
use kinefront::kinematics::Jacobian;
use kinefront::mechanism::{Architecture, Design, Leg, PrrLeg, RprLeg, RrrLeg};
use kinefront::optimize::sobol;
use kinefront::spatial::Pose;
use kinefront::stiffness::joint_model;
use kinefront::study::{DesignProblem, Study};
use kinefront::workspace::PoseChecker;
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

/// Designs with poses that they reach, spread evenly.
fn reachable<L: Leg>(architecture: Architecture) -> Vec<(PoseChecker<L>, Pose)> {
    let model = Model::default();
    let designs = sample(architecture, 256);
    let variables = [[-1.0, 1.0], [-1.0, 1.0], [-3.2, 3.2]]
        .map(|[lower, upper]| kinefront::optimize::Variable::Real { lower, upper });
    let poses = sobol(&variables, 8192, 2);
    let mut found = Vec::new();
    for (index, pose) in poses.iter().enumerate() {
        let design = &designs[index % designs.len()];
        let checker = model.checker::<L>(design).expect("a whole grid");
        let pose = Pose::new(pose[0], pose[1], pose[2]);
        if checker.manipulator.posture(&pose).is_ok() && checker.stiffness.is_some() {
            found.push((checker, pose));
        }
    }
    found.truncate(500);
    found
}

fn poses_of<L: Leg>(criterion: &mut Criterion, architecture: Architecture) {
    let poses = reachable::<L>(architecture);
    let mut group = criterion.benchmark_group("pose");
    group.throughput(Throughput::Elements(poses.len() as u64));
    group.bench_function(BenchmarkId::new("general 6x6", architecture), |bencher| {
        bencher.iter(|| {
            for (checker, pose) in &poses {
                let posture = checker.manipulator.posture(pose).expect("reachable");
                let condition = Jacobian::new(&posture).inverse_condition(checker.length);
                let model = checker.stiffness.as_ref().expect("stiff");
                black_box((condition, joint_model::stiffness(model, &checker.manipulator, &posture)));
            }
        });
    });
    group.bench_function(BenchmarkId::new("closed form", architecture), |bencher| {
        bencher.iter(|| {
            for (checker, pose) in &poses {
                let posture = checker.manipulator.posture(pose).expect("reachable");
                let jacobian = Jacobian::new(&posture);
                let stiffness = checker.stiffness_at(&posture, &jacobian).rigidity(checker.definition);
                black_box((jacobian.inverse_condition(checker.length), stiffness));
            }
        });
    });
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
