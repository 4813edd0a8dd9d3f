//! Proofs that every pose of a prescribed region is feasible: against random poses, against weaker designs, and blind.

use glam::DVec2;
use kinefront_model::certify::{Certificate, CertifyOptions, Patch, Verdict};
use kinefront_model::evaluation::{GridChoice, Model, PoseScalar, WorkspaceTarget};
use kinefront_model::mechanism::{Architecture, Design, WorkingMode};
use kinefront_model::polygon::Polygon;
use kinefront_model::spatial::Pose;
use kinefront_model::workspace::Region;
use kinefront_testkit::poses_of_region;
use rayon::prelude::*;

use super::regions::RANGES;
use super::strategies::{self, PAPER_LIMITS, parsed};

fn with_region(region: Region) -> Model {
    strategies::model(|settings| settings.workspace.region = region)
}

fn polygon(corners: &[[f64; 2]]) -> Region {
    let corners = corners.iter().map(|&[x, y]| DVec2::new(x, y)).collect();
    Region::Polygon(Polygon::new(corners).expect("a polygon"))
}

/// A polygon that is not convex and does not contain its centre.
const HORSESHOE: [[f64; 2]; 8] = [
    [-0.25, -0.2],
    [0.25, -0.2],
    [0.25, 0.2],
    [0.15, 0.2],
    [0.12, -0.1],
    [-0.12, -0.1],
    [-0.15, 0.2],
    [-0.25, 0.2],
];

fn regions() -> Vec<(&'static str, Region)> {
    vec![
        ("disc", Region::Disc(0.25)),
        (
            "rectangle",
            Region::Polygon(Polygon::rectangle(0.5, 0.4).expect("a rectangle")),
        ),
        ("triangle", polygon(&[[-0.2, -0.25], [0.3, -0.1], [-0.05, 0.3]])),
        ("horseshoe", polygon(&HORSESHOE)),
    ]
}

/// Returns a design of an architecture whose bars are sized for the region of a model, and so much thicker.
fn sized(model: &Model, architecture: Architecture, increase: f64) -> Option<Design> {
    let start = Design::new(architecture, WorkingMode::new([true; 3]), [1.5, 0.4, 1.2, 0.03, 0.03]).expect("a design");
    let found = model.sized(&start, &RANGES, WorkspaceTarget::Prescribed(GridChoice::Reference))?;
    with_thicker_bars(&found, 1.0 + increase)
}

fn with_thicker_bars(design: &Design, factor: f64) -> Option<Design> {
    let mut values = design.values();
    values[3..].iter_mut().for_each(|radius| *radius *= factor);
    design.with_dimensions(values).ok()
}

fn proof(model: &Model, design: &Design, phi_deg: f64) -> Certificate {
    let claim = CertifyOptions {
        phi_deg,
        max_boxes: 60_000,
        is_of_region: true,
        ..CertifyOptions::default()
    };
    model.certify(design, &claim).expect("a certificate")
}

fn random_poses(model: &Model, phi_deg: f64, count: usize) -> Vec<Pose> {
    poses_of_region(&model.settings().workspace, phi_deg, count, 11)
}

/// The least margin of the paper's limits at a pose; negative where a leg does not reach it.
fn least_margin(model: &Model, design: &Design, pose: &Pose) -> f64 {
    if model.pose(design, pose).is_err() {
        return -1.0;
    }
    let margins = PAPER_LIMITS.map(|scalar| model.margin_at(design, pose, scalar));
    margins.into_iter().fold(f64::INFINITY, f64::min)
}

/// Designs whose bars carry with a little to spare are proved over each kind of region, and no random pose is infeasible; with bars
/// that are a little too thin, the proof ends with a pose of the region that the evaluation calls infeasible, too.
#[test]
fn regions_are_proved_and_refuted() {
    const POSES: usize = 4000;
    let tasks: Vec<_> = regions()
        .into_iter()
        .flat_map(|(name, region)| {
            Architecture::ALL
                .iter()
                .map(move |&architecture| (name, region.clone(), architecture))
        })
        .collect();
    let counts: Vec<[usize; 2]> = tasks
        .into_par_iter()
        .map(|(name, region, architecture)| {
            let model = with_region(region);
            let Some(design) = sized(&model, architecture, 1e-2) else {
                return [0; 2];
            };
            let phi_deg = model.evaluate(&design, GridChoice::Reference).home_phi_deg;
            // Nothing but the bars may be missing.
            let Some(phi_deg) = phi_deg else { return [0; 2] };
            let found = proof(&model, &design, phi_deg);
            if found.verdict == Verdict::Proved {
                for pose in random_poses(&model, phi_deg, POSES) {
                    let margin = least_margin(&model, &design, &pose);
                    assert!(margin > -1e-12, "{name}, {design}: {margin} at {pose:?}");
                }
                let inscribed = model.settings().workspace.region.inscribed_radius().expect("a radius");
                assert_eq!(found.lower, inscribed);
            }
            // The home orientation of the design may leave room for bars that are a little thinner.
            let thin_by = |factor: f64| with_thicker_bars(&design, factor).expect("a design");
            let thin = [0.99, 0.9, 0.5].map(thin_by).into_iter().find(|thin| {
                let poses = random_poses(&model, phi_deg, 500);
                poses.iter().any(|pose| least_margin(&model, thin, pose) < 0.0)
            });
            let thin = thin.expect("bars that are too thin");
            let refuted = proof(&model, &thin, phi_deg);
            assert_eq!(refuted.verdict, Verdict::Refuted, "{name}, {thin}: {refuted:?}");
            let violation = refuted.violation.expect("a pose");
            assert!(
                model.margin_at(&thin, &violation.pose, violation.scalar) < 1e-12,
                "{name}, {thin}"
            );
            assert_eq!(refuted.lower, 0.0);
            [1, usize::from(found.verdict == Verdict::Proved)]
        })
        .collect();
    let [designs, proved] = counts
        .iter()
        .fold([0; 2], |sum, count| [sum[0] + count[0], sum[1] + count[1]]);
    println!("{proved} of {designs} designs are proved");
    assert!(designs >= 40, "{designs} designs");
    // What is not proved has a margin of geometry that sizing does not see.
    assert!(proved * 10 >= designs * 9, "{proved} of {designs}");
}

/// A corner of a region is pulled outwards until it is not feasible. A proof that looks for no infeasible pose must not end, whichever
/// corner it is: a proof that left a part of the region out, or a constraint, would.
#[test]
fn a_blind_proof_does_not_pass_an_infeasible_corner() {
    let design = parsed("3-RRR R=1.5 r=0.4 Lb=1.2 rj=0.05 rp=0.06");
    for (name, corners) in [
        (
            "rectangle",
            vec![[-0.2, -0.15], [0.2, -0.15], [0.2, 0.15], [-0.2, 0.15]],
        ),
        ("horseshoe", HORSESHOE.to_vec()),
    ] {
        let model = with_region(polygon(&corners));
        let claim = model.claim(&model.evaluate(&design, GridChoice::Fine)).expect("a home");
        let blind = CertifyOptions {
            max_boxes: 4000,
            blind_radius: Some(1.0),
            ..claim
        };
        let whole = model.certify(&design, &blind).expect("a certificate");
        assert_eq!(whole.verdict, Verdict::Proved, "{name}: {whole:?}");
        for corner in 0..corners.len() {
            let mut pulled = corners.clone();
            let share = 2.4 / DVec2::from_array(corners[corner]).length();
            pulled[corner] = corners[corner].map(|part| part * share);
            let Ok(polygon) = Polygon::new(pulled.iter().map(|&at| DVec2::from_array(at)).collect()) else {
                continue;
            };
            let model = with_region(Region::Polygon(polygon));
            let found = model.certify(&design, &blind).expect("a certificate");
            assert_ne!(found.verdict, Verdict::Proved, "{name}, corner {corner}");
            let seeing = CertifyOptions {
                blind_radius: None,
                ..blind
            };
            let found = model.certify(&design, &seeing).expect("a certificate");
            assert_eq!(found.verdict, Verdict::Refuted, "{name}, corner {corner}");
        }
    }
}

/// Every limit counts on its own: with a threshold that lies just above the least value over the region, nothing is proved.
#[test]
fn each_limit_ends_the_proof_of_a_region() {
    let region = || Region::Polygon(Polygon::rectangle(0.4, 0.3).expect("a rectangle"));
    let design = parsed("3-PRR R=1.5 r=0.4 Lb=1.2 rj=0.05 rp=0.06");
    let phi_deg = with_region(region())
        .evaluate(&design, GridChoice::Fine)
        .home_phi_deg
        .expect("a home");
    let others = [
        PoseScalar::Transmission,
        PoseScalar::Displacement,
        PoseScalar::Clearance,
        PoseScalar::Stress,
        PoseScalar::BucklingFactor,
        PoseScalar::NaturalFrequency,
    ];
    for scalar in PAPER_LIMITS.into_iter().chain(others) {
        let limited = |limit: f64| {
            strategies::model(|settings| {
                settings.workspace.region = region();
                settings.workspace.home_phi_deg = Some(phi_deg);
                settings.thresholds.set(scalar, Some(limit));
            })
        };
        let open = with_region(region());
        let values = random_poses(&open, phi_deg, 4000)
            .into_iter()
            .map(|pose| open.pose(&design, &pose).expect("a pose").values[scalar]);
        let is_lower_better = matches!(scalar, PoseScalar::Displacement | PoseScalar::Stress);
        let worst = if is_lower_better {
            values.fold(f64::NEG_INFINITY, f64::max)
        } else {
            values.fold(f64::INFINITY, f64::min)
        };
        let room = 0.02 * worst.abs() * if is_lower_better { -1.0 } else { 1.0 };
        for (limit, expected) in [(worst - room, Verdict::Proved), (worst + 1e-3 * room, Verdict::Refuted)] {
            let model = limited(limit);
            let claim = CertifyOptions {
                phi_deg,
                is_of_region: true,
                ..CertifyOptions::default()
            };
            let found = model.certify(&design, &claim).expect("a certificate");
            assert_eq!(found.verdict, expected, "{scalar:?} at {limit}: {found:?}");
            if expected == Verdict::Refuted {
                assert_eq!(found.violation.expect("a pose").scalar, scalar);
            }
        }
    }
}

/// The parts of a rectangle are found as one, those of other polygons as triangles.
#[test]
fn boxes_lie_in_the_parts_of_the_region() {
    struct Boxes(Vec<Patch>);
    impl kinefront_model::certify::ProofObserver for Boxes {
        fn watches_boxes(&self) -> bool {
            true
        }
        fn examined(&mut self, part: &kinefront_model::certify::ExaminedBox) {
            self.0.push(part.patch);
        }
    }
    let design = parsed("3-PRR R=1.5 r=0.4 Lb=1.2 rj=0.05 rp=0.06");
    for (name, region) in regions() {
        let model = with_region(region);
        let claim = model.claim(&model.evaluate(&design, GridChoice::Fine)).expect("a home");
        let mut boxes = Boxes(Vec::new());
        let found = model
            .certify_observed(&design, &claim, &mut boxes)
            .expect("a certificate");
        assert_eq!(found.verdict, Verdict::Proved, "{name}");
        let count = |is_of: fn(&Patch) -> bool| boxes.0.iter().filter(|patch| is_of(patch)).count();
        let counts = [
            count(|patch| matches!(patch, Patch::Disc)),
            count(|patch| matches!(patch, Patch::Rectangle(_))),
            count(|patch| matches!(patch, Patch::Triangle(_))),
        ];
        let expected = match name {
            "disc" => 0,
            "rectangle" => 1,
            _ => 2,
        };
        for (kind, count) in counts.into_iter().enumerate() {
            assert_eq!(count > 0, kind == expected, "{name}: {counts:?}");
        }
    }
}
