//! Where one family of designs takes over from another along a front.

use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::{Architecture, Design, DesignVariable};
use kinefront_study::{DesignProblem, DriversAlong, Study};

use super::{builtin, problem};

/// Neighbours on the front of the 3-RPR, with home orientations of about 12°, 148° and 164°.
const BELOW: &str =
    "3-RPR R=0.6450903984930788 r=0.1 Lb=0.7328191400630438 rj=0.007736818691923176 rp=0.01008972877902294";
const ABOVE: [&str; 2] = [
    "3-RPR R=0.5002267512674378 r=0.1 Lb=0.7817012420721547 rj=0.008054277711055852 rp=0.009332484254359676",
    "3-RPR R=0.500197467111528 r=0.1 Lb=0.7945580317533498 rj=0.00810084925263768 rp=0.009312836760133286",
];

fn study() -> Study {
    let paper = builtin("paper").study().expect("a valid study");
    paper.with_one_architecture(Architecture::Rpr)
}

fn evaluated(designs: &[&str]) -> (DesignProblem, Vec<Evaluation>) {
    let study = study();
    let designs: Vec<Design> = designs
        .iter()
        .map(|design| Design::parse(design, study.working_mode).expect("a design"))
        .collect();
    let problem = problem(&study);
    let evaluations = problem.evaluate_on_fine_grid(&designs);
    (problem, evaluations)
}

fn thicker(design: &Design) -> Design {
    let bars = [DesignVariable::LegBarRadius, DesignVariable::PlatformBarRadius];
    bars.into_iter().fold(*design, |design, bar| {
        design.with(bar, 1.0001 * design.value(bar)).expect("a design")
    })
}

fn along(designs: &[&str]) -> DriversAlong {
    let (problem, evaluations) = evaluated(designs);
    problem.drivers_along(&evaluations).pop().expect("one architecture")
}

/// The two families have different home orientations, the same mass where they meet, and different prices there.
#[test]
fn a_family_takes_over_from_another_of_the_same_architecture() {
    let along = along(&[BELOW, ABOVE[0], ABOVE[1]]);
    let [crossing] = along.crossings[..] else {
        panic!("{:?}", along.crossings);
    };
    let (problem, evaluations) = evaluated(&[BELOW, ABOVE[0]]);
    let ends = [0, 1].map(|place| evaluations[place].workspace_radius());
    assert!(ends[0] < crossing.at && crossing.at < ends[1], "{crossing:?}");
    for (design, home) in crossing.designs.iter().zip(crossing.homes_deg) {
        let mass = problem.model().mass(design);
        assert!((mass / crossing.objective - 1.0).abs() < 1e-7, "{crossing:?}");
        // At its home orientation, each of the two has the radius at which they meet, with bars that leave room for rounding.
        let mut study = study();
        study.workspace.home_phi_deg = Some(home);
        let at_home = super::problem(&study);
        let radius = at_home.evaluate_on_fine_grid(&[thicker(design)])[0].workspace_radius();
        assert!((radius / crossing.at - 1.0).abs() < 2e-3, "{radius}, {crossing:?}");
    }
    let [below, above] = crossing.homes_deg;
    assert!(
        (below - 12.29).abs() < 0.01 && (above - 146.28).abs() < 0.01,
        "{crossing:?}"
    );
    // The price falls at a concave kink.
    assert!(crossing.prices[0] > crossing.prices[1] + 1.0, "{crossing:?}");
    let sentences = along.sentences();
    let told = sentences
        .iter()
        .find(|sentence| sentence.contains("Another family of the 3-RPR"));
    assert!(
        told.is_some_and(|told| told.contains("146.28° instead of 12.29°")),
        "{sentences:?}"
    );
}

/// Neighbours of one family are not followed to a place where they would meet.
#[test]
fn neighbours_of_one_family_do_not_cross() {
    let along = along(&ABOVE);
    assert_eq!(along.designs.len(), 2);
    assert_eq!(along.crossings, []);
}
