//! Fronts of whole searches: completed candidates, the paper's designs, fronts without collisions.

use kinefront_model::evaluation::{Constraint, Evaluation, GridChoice, Model};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_optimize::{FrontDe, FrontDeSettings, Problem, Target, Variable, run};
use kinefront_report::{Fronts, Source};
use kinefront_study::{BUILTIN, Builtin, DesignProblem, Study};
use kinefront_testkit::oracle::{Fault, oracle};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// A number between two others, evenly distributed.
fn between(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

#[test]
fn a_level_that_the_geometry_does_not_allow_becomes_its_largest() {
    let study = Study {
        architectures: vec!["3-PRR".parse().expect("an architecture")],
        ..BUILTIN[0].study().expect("sound")
    };
    let problem = DesignProblem::new(&study).expect("a valid study");
    assert_eq!(problem.variables()[0], Variable::Categorical { choices: 1 });
    let x = [0.0, 3.066, 1.283, 1.896, 0.036, 0.056];
    let best = problem.complete(&x, Target::Best).expect("bars");
    assert_eq!(problem.complete(&x, Target::Level(-3.0)), Some(best.clone()));
    let level = problem.complete(&x, Target::Level(-0.8)).expect("bars");
    assert!(level[4] < best[4] || level[5] < best[5], "less is asked of the bars");
    assert_eq!(level[..4], x[..4], "the geometry stays");
    let outcome = problem.evaluate(&level);
    assert!((outcome.objectives[1] + 0.8).abs() < 0.01, "{outcome:?}");
}

/// A thousand evaluations suffice for lighter designs with a larger workspace than each of the paper's three, verified on
/// the fine grid; the larger one of printed and computed radius counts.
#[test]
fn the_papers_designs_are_dominated() {
    let study = BUILTIN[0].study().expect("sound");
    let problem = DesignProblem::new(&study).expect("a valid study");
    let mut algorithm = FrontDe::new(problem.variables(), FrontDeSettings::default(), 1);
    let archive = run(&problem, &mut algorithm, 1000);
    let model = problem.model();
    let fine = |design: &Design| model.evaluate(design, GridChoice::Fine);
    for reference in &study.references {
        let theirs = fine(&reference.parse(study.working_mode).expect("a design"));
        let printed = [reference.mass_kg, reference.workspace_radius_m].map(|value| value.expect("printed"));
        let (mass, radius) = (theirs.mass().min(printed[0]), theirs.workspace_radius().max(printed[1]));
        let ours = archive
            .iter()
            .filter(|member| -member.objectives[1] >= radius)
            .map(|member| fine(&problem.design(&member.x).expect("a design")))
            .find(|ours| ours.workspace_radius() >= radius)
            .expect("a workspace as large");
        println!(
            "{}: {mass} kg, {radius} m; ours {} kg, {} m",
            reference.name,
            ours.mass(),
            ours.workspace_radius()
        );
        assert!(ours.mass() < 0.5 * mass, "{}: {} kg", reference.name, ours.mass());
    }
}

/// Counts the poses with an overlap of a number of poses drawn from the regular workspace of a design.
fn overlaps_of(model: &Model, member: &Evaluation, mut random: ChaCha8Rng, poses: usize) -> usize {
    let home = member.home.expect("feasible");
    let half_turn = 0.5 * model.settings().workspace.rotation_range_deg.to_radians();
    let drawn = (0..poses).map(|_| {
        let radius = member.workspace_radius() * between(&mut random, 0.0, 1.0).sqrt();
        let angle = between(&mut random, 0.0, std::f64::consts::TAU);
        let phi = home.phi + between(&mut random, -half_turn, half_turn);
        Pose::new(radius * angle.cos(), radius * angle.sin(), phi)
    });
    let overlaps = drawn.filter(|pose| {
        let report = model.pose(&member.design, pose).expect("in the workspace");
        oracle(model, &member.design, pose, &report, Fault::None).least < 0.0
    });
    overlaps.count()
}

/// On the verified front of a study with g7 no pose overlaps, of a million drawn at random from the regular workspaces;
/// without it most designs of its front collide, and are known to.
#[test]
fn a_front_with_clearance_has_no_overlap_on_a_million_poses() {
    let study = |clearance: bool| {
        let builtin = Builtin::find("paper-without-collisions").expect("it comes with the program");
        let mut study = builtin.study().expect("sound");
        study.optimizer.evaluations = 600;
        if !clearance {
            study.requirements.clearance_min_m = None;
        }
        study
    };
    let front = |study: &Study| {
        let source = Source::run("a run", study.clone()).expect("a run");
        let fronts = Fronts::new(&[source], &DesignProblem::new(study).expect("a valid study"), 100).expect("a front");
        let of_each = fronts.alone.into_iter().flat_map(|(_, front)| front.members);
        of_each.collect::<Vec<_>>()
    };
    let clearance = |evaluation: &Evaluation| evaluation.constraint(Constraint::Clearance).value.expect("a clearance");

    let with = study(true);
    let model = with.model().expect("a valid study");
    let least = with.requirements.clearance_min_m.expect("asked");
    let members = front(&with);
    assert!(
        members
            .iter()
            .any(|member| member.active().any(|active| active == Constraint::Clearance))
    );
    let each = 1_000_000usize.div_ceil(members.len());
    let overlaps: usize = members
        .par_iter()
        .enumerate()
        .map(|(index, member)| {
            assert!(clearance(member) >= least);
            overlaps_of(&model, member, ChaCha8Rng::seed_from_u64(index as u64), each)
        })
        .sum();
    let poses = each * members.len();
    assert_eq!(overlaps, 0, "of {poses} poses of {} designs", members.len());

    let colliding = front(&study(false));
    let found: Vec<&Evaluation> = colliding.iter().filter(|member| clearance(member) < 0.0).collect();
    assert!(
        2 * found.len() > colliding.len(),
        "{} of {}",
        found.len(),
        colliding.len()
    );
    for member in found {
        let nearest = member.nearest.as_ref().expect("a pose");
        let report = member.constraint(Constraint::Clearance);
        assert!(nearest.distance < 0.0 && !report.required && !report.active);
        // The same study with g7 has no use for that workspace.
        let required = model.evaluate(&member.design, GridChoice::Fine);
        assert!(required.workspace_radius() < member.workspace_radius());
    }
}
