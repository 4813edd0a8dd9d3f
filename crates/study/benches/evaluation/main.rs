//! Measures how fast designs and poses are evaluated: `cargo bench -p kinefront-study --bench evaluation`.
//!
//! - `pose`: all values that the constraints need at one reachable pose: by the general 6×6 stiffness, by the closed
//!   form, and by the closed form at several poses at once with every instruction set that the machine has, with all
//!   values written to memory.
//! - `design`: one evaluation on the reference grid, of a Sobol sample of the paper's bounds and of designs of a
//!   converged front: by the definition, ray by ray, in either form, and by the search; finally by the search on the
//!   fine grid.
//! - `threads`: the front's designs on one thread and on two.
//! - `clearance`: optimizer runs in which members may collide, and in which they must not.
//! - `algorithm`: a search of the paper's study, and what its optimizer alone does in it.
//! - `proof`: evaluations on the fine grid and proofs of designs of the best fronts known.
//!
//! The operations of a pose are counted, and `pose/limit` is the time that the machine takes for as many operations of
//! each kind, none of which waits for another.

mod counted;
mod limit;
mod proofs;

use std::hint::black_box;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec2;
use kinefront_model::clearance::Layers;
use kinefront_model::evaluation::{GridChoice, Model, PoseScalar};
use kinefront_model::kinematics::Jacobian;
use kinefront_model::lanes::{InstructionSet, Planar};
use kinefront_model::mechanism::{AnyLeg, Architecture, Design, Manipulator};
use kinefront_model::spatial::{LEGS, Rotation, smaller_eigenvalue};
use kinefront_model::stiffness::joint_model;
use kinefront_model::workspace::plain::plain;
use kinefront_model::workspace::{PoseEvaluator, ValueColumns};
use kinefront_optimize::{Algorithm, Candidate, Evaluated, FrontDe, FrontDeSettings, run, sobol};
use kinefront_study::{DesignProblem, Study};
use rayon::prelude::*;

use self::counted::{Operations, operations};
use self::proofs::proofs;

/// Returns designs of one architecture, spread over the paper's bounds.
fn sample(architecture: Architecture, count: usize) -> Vec<Design> {
    let study = Study::default().with_one_architecture(architecture);
    let problem = DesignProblem::new(&study).expect("a valid study");
    let sample = sobol(&problem.variables(), count, 1);
    sample.iter().map(|x| problem.design(x).expect("a design")).collect()
}

/// Returns the designs of a converged front.
fn front() -> Vec<Design> {
    include_str!("../front.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.parse().expect("a design"))
        .collect()
}

/// A design in one orientation, with positions that it reaches there.
struct Batch {
    design: Design,
    evaluator: Box<dyn PoseEvaluator>,
    arms: [DVec2; LEGS],
    xs: Vec<f64>,
    ys: Vec<f64>,
}

/// Counts and prints the floating-point operations of one pose.
fn count_operations(batch: &Batch) -> Operations {
    let counts = operations(batch.xs[1], batch.ys[1], |x, y| {
        let arms = batch.arms.map(|arm| Planar::splat(x, arm));
        black_box(
            Model::default()
                .run_formulas(&batch.design, Planar::new(x, y), arms)
                .value(),
        );
    });
    println!("{}: {counts:?}", batch.design.architecture());
    counts
}

/// Number of positions in a batch.
const BATCH: usize = 64;

/// Returns the feasible designs of a Sobol sample, each with positions spread evenly over a disc that it reaches.
fn batches(architecture: Architecture) -> Vec<Batch> {
    let model = Model::default();
    let mut found = Vec::new();
    for design in sample(architecture, 512) {
        let evaluation = model.evaluate(&design, GridChoice::Reference);
        let Some(home) = evaluation.home else { continue };
        let evaluator = model.pose_evaluator(&design);
        let arms = evaluator.arms(&Rotation::new(home.phi));
        let [xs, ys] = [0, 1].map(|axis| {
            (0..BATCH)
                .map(|k| {
                    // The positions form a sunflower pattern, which is even in area.
                    let radius = evaluation.workspace_radius() * ((k as f64 + 0.5) / BATCH as f64).sqrt();
                    let angle = 2.399_963 * k as f64;
                    radius * if axis == 0 { angle.cos() } else { angle.sin() }
                })
                .collect()
        });
        found.push(Batch {
            design,
            evaluator,
            arms,
            xs,
            ys,
        });
    }
    found
}

fn poses_of(criterion: &mut Criterion, architecture: Architecture) {
    let mut batches = batches(architecture);
    let counts = count_operations(&batches[0]);
    let mut group = criterion.benchmark_group("pose");
    group.throughput(Throughput::Elements(limit::poses() as u64));
    group.bench_function(BenchmarkId::new("limit", architecture), |bencher| {
        bencher.iter(|| black_box(limit::run(counts, black_box(1.000_001))));
    });
    group.throughput(Throughput::Elements((batches.len() * BATCH) as u64));
    let model = Model::default();
    group.bench_function(BenchmarkId::new("general 6x6", architecture), |bencher| {
        bencher.iter(|| {
            for batch in &batches {
                let manipulator = Manipulator::<AnyLeg>::new(&batch.design, &model.settings().legs);
                let stiffness = model.stiffness(&batch.design).expect("stiff");
                for k in 0..BATCH {
                    let position = DVec2::new(batch.xs[k], batch.ys[k]);
                    let posture = manipulator.posture_at(position, &batch.arms).expect("reachable");
                    let condition = Jacobian::new(&posture).inverse_condition(batch.design.platform_radius());
                    black_box((condition, joint_model::stiffness(&stiffness, architecture, &posture)));
                }
            }
        });
    });
    group.bench_function(BenchmarkId::new("closed form", architecture), |bencher| {
        bencher.iter(|| {
            for batch in &batches {
                for k in 0..BATCH {
                    let position = DVec2::new(batch.xs[k], batch.ys[k]);
                    black_box(batch.evaluator.evaluate_plainly(&batch.arms, position)).expect("reachable");
                }
            }
        });
    });
    for instructions in InstructionSet::available() {
        for batch in &mut batches {
            batch.evaluator.use_instructions(instructions);
        }
        let mut values = ValueColumns::default();
        let name = format!("reduced, {}", instructions.name());
        group.bench_function(BenchmarkId::new(name, architecture), |bencher| {
            bencher.iter(|| {
                for batch in &batches {
                    batch
                        .evaluator
                        .evaluate_positions(&batch.arms, &batch.xs, &batch.ys, &mut values);
                    black_box(&values);
                }
            });
        });
    }
    group.finish();
}

fn poses(criterion: &mut Criterion) {
    for &architecture in Architecture::PAPER {
        poses_of(criterion, architecture);
    }
}

/// Returns the workspace radius by its definition, ray by ray and one pose at a time, in the given form of the
/// stiffness.
fn plainly(model: &Model, design: &Design, general: bool) -> f64 {
    let manipulator = Manipulator::<AnyLeg>::new(design, &model.settings().legs);
    let evaluator = model.pose_evaluator(design);
    let stiffness = model.stiffness(design);
    let limit = |scalar| model.settings().thresholds.get(scalar).expect("a limit of the paper");
    let general_form = |position: DVec2, arms: &[DVec2; LEGS]| {
        let posture = manipulator.posture_at(position, arms).ok()?;
        let jacobian = Jacobian::new(&posture);
        if jacobian.inverse_condition(design.platform_radius()) < limit(PoseScalar::Dexterity) {
            return None;
        }
        let k = joint_model::stiffness(stiffness.as_ref()?, design.architecture(), &posture)?;
        let k_xy = smaller_eigenvalue(k[(0, 0)], k[(0, 1)], k[(1, 1)]);
        let stiff = k_xy >= limit(PoseScalar::StiffnessXy)
            && k[(2, 2)] >= limit(PoseScalar::StiffnessZ)
            && k[(5, 5)] >= limit(PoseScalar::StiffnessPhiZ);
        stiff.then(|| jacobian.determinant().signum())
    };
    let closed_form = |position: DVec2, arms: &[DVec2; LEGS]| evaluator.feasible_sign(arms, position);
    let (arms_at, sampling) = (
        |rotation: &Rotation| evaluator.arms(rotation),
        model.sampling(GridChoice::Reference),
    );
    let found = if general {
        plain(arms_at, sampling, design.base_radius(), general_form)
    } else {
        plain(arms_at, sampling, design.base_radius(), closed_form)
    };
    found.radius
}

fn evaluate(model: &Model, design: &Design, grid: GridChoice, instructions: InstructionSet) -> f64 {
    let evaluation = model.evaluate_with(design, grid, instructions);
    evaluation.workspace_radius()
}

fn designs(criterion: &mut Criterion) {
    let model = Model::default();
    let mut group = criterion.benchmark_group("design");
    group.sample_size(10);
    let mut workloads: Vec<(String, Vec<Design>)> = Architecture::PAPER
        .iter()
        .map(|&architecture| (format!("sobol {architecture}"), sample(architecture, 32)))
        .collect();
    workloads.push(("front".to_owned(), front().into_iter().step_by(4).collect()));
    for (workload, designs) in &workloads {
        group.throughput(Throughput::Elements(designs.len() as u64));
        let mut bench = |name: &str, evaluate: &dyn Fn(&Design) -> f64| {
            group.bench_function(BenchmarkId::new(name, workload), |bencher| {
                bencher.iter(|| designs.iter().map(evaluate).sum::<f64>());
            });
        };
        bench("plain, general 6x6", &|design| plainly(&model, design, true));
        bench("plain, closed form", &|design| plainly(&model, design, false));
        for instructions in InstructionSet::available() {
            bench(instructions.name(), &|design| {
                evaluate(&model, design, GridChoice::Reference, instructions)
            });
        }
        bench("fine grid", &|design| {
            evaluate(&model, design, GridChoice::Fine, InstructionSet::best())
        });
    }
    group.finish();
}

fn threads(criterion: &mut Criterion) {
    let model = Model::default();
    // There are enough designs that no thread waits long for the last design of the other.
    let designs = front().repeat(10);
    let of = |design: &Design| evaluate(&model, design, GridChoice::Reference, InstructionSet::best());
    let mut group = criterion.benchmark_group("threads");
    group.throughput(Throughput::Elements(designs.len() as u64));
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        group.bench_function(BenchmarkId::from_parameter(threads), |bencher| {
            bencher.iter(|| pool.install(|| designs.par_iter().map(of).sum::<f64>()));
        });
    }
    group.finish();
}

/// Measures optimizer runs of the paper's study in which members may collide, in which they keep a clearance of 5 mm,
/// and in which they keep it with all members in one plane.
fn clearance(criterion: &mut Criterion) {
    const EVALUATIONS: usize = 600;
    let mut group = criterion.benchmark_group("clearance");
    group.sample_size(10);
    group.throughput(Throughput::Elements(EVALUATIONS as u64));
    for &architecture in Architecture::PAPER {
        for (name, least, layers) in [
            ("may collide", None, Layers::default()),
            ("5 mm", Some(0.005), Layers::default()),
            ("5 mm, in one plane", Some(0.005), Layers::ONE_PLANE),
        ] {
            let mut study = Study::default().with_one_architecture(architecture);
            study.requirements.clearance_min_m = least;
            study.bodies.layers = layers;
            let problem = DesignProblem::new(&study).expect("a valid study");
            group.bench_function(BenchmarkId::new(name, architecture), |bencher| {
                bencher.iter(|| {
                    let mut algorithm = FrontDe::new(problem.variables(), FrontDeSettings::default(), 1);
                    run(&problem, &mut algorithm, EVALUATIONS).iter().count()
                });
            });
        }
    }
    group.finish();
}

/// An algorithm that keeps what it is told.
struct Recorder {
    algorithm: FrontDe,
    generations: Vec<Vec<Evaluated>>,
}

impl Algorithm for Recorder {
    fn ask(&mut self) -> Vec<Candidate> {
        self.algorithm.ask()
    }

    fn tell(&mut self, evaluated: Vec<Evaluated>) {
        self.generations.push(evaluated.clone());
        self.algorithm.tell(evaluated);
    }
}

/// The share of the optimizer in a search: the same candidates are asked for, and their outcomes told, without evaluating them.
fn algorithm(criterion: &mut Criterion) {
    const EVALUATIONS: usize = 3000;
    let mut group = criterion.benchmark_group("algorithm");
    group
        .sample_size(10)
        .throughput(Throughput::Elements(EVALUATIONS as u64));
    let problem = DesignProblem::new(&Study::default()).expect("a valid study");
    for (name, learned) in [
        ("front-de", FrontDeSettings::default().learned),
        ("front-de without learning", 0.0),
    ] {
        let settings = FrontDeSettings {
            learned,
            ..FrontDeSettings::default()
        };
        let new = || FrontDe::for_problem(&problem, settings, 1);
        group.bench_function(BenchmarkId::new("search", name), |bencher| {
            bencher.iter(|| run(&problem, &mut new(), EVALUATIONS).len());
        });
        let mut recorder = Recorder {
            algorithm: new(),
            generations: Vec::new(),
        };
        run(&problem, &mut recorder, EVALUATIONS);
        group.bench_function(BenchmarkId::new("optimizer alone", name), |bencher| {
            bencher.iter_batched(
                || (new(), recorder.generations.clone()),
                |(mut algorithm, generations)| {
                    for generation in generations {
                        black_box(algorithm.ask());
                        algorithm.tell(generation);
                    }
                },
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, poses, designs, threads, clearance, algorithm, proofs);
criterion_main!(benches);
