//! Cross-sections of bars: tubes against a finite-element solver, the 6×6 form, and solid bars.

use std::sync::Arc;

use kinefront_model::evaluation::{GridChoice, Model, PoseScalar};
use kinefront_model::mechanism::{
    AnyLeg, Catalogue, CatalogueEntry, CatalogueError, CrossSection, CrossSections, Design, Manipulator, Wall,
};
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::joint_model;
use proptest::prelude::*;
use serde_json::Value;

use super::reference::{cases_of, close, design, difference, matrix, number, pose};
use super::strategies::{self, applicable_cases, parsed};

/// The cross-sections of a case.
pub fn sections(case: &Value) -> CrossSections {
    let section = |value: &Value| {
        let wall = || Wall::Ratio(number(&value["wall_ratio"]));
        match value["kind"].as_str() {
            Some("tube") => CrossSection::Tube(wall()),
            Some("square_tube") => CrossSection::SquareTube(wall()),
            _ => CrossSection::Round,
        }
    };
    CrossSections {
        legs: section(&case["sections"]["legs"]),
        platform: section(&case["sections"]["platform"]),
    }
}

fn model_with(sections: CrossSections) -> Model {
    strategies::model(|settings| settings.sections = sections)
}

fn joint_form(model: &Model, design: &Design, pose: &Pose) -> nalgebra::Matrix6<f64> {
    let posture = Manipulator::<AnyLeg>::new(design, &model.settings().legs)
        .posture(pose)
        .expect("reachable");
    let stiffness = model.stiffness(design).expect("stiff");
    joint_model::stiffness(&stiffness, design.architecture(), &posture).expect("regular")
}

#[test]
fn hollow_bars_agree_with_the_finite_element_solver() {
    let cases = cases_of("sections.json", "cases");
    assert_eq!(cases.len(), 12);
    for (index, case) in cases.iter().enumerate() {
        let model = model_with(sections(case));
        let (design, pose) = (design(case), pose(case));
        close(model.mass(&design), number(&case["mass"]), 1e-12, "mass");
        let found = model.pose(&design, &pose).expect("reachable");
        let wanted = matrix(&case["stiffness_matrix"]);
        let error = difference(&found.stiffness, &wanted);
        assert!(error < 1e-7, "case {index}: {error}");
        let values = found.values;
        for (value, key) in [
            (values[PoseScalar::StiffnessXy], "k_xy"),
            (values[PoseScalar::StiffnessZ], "k_z"),
            (values[PoseScalar::StiffnessPhiZ], "k_phi_z"),
        ] {
            close(value, number(&case[key]), 1e-7, key);
        }
        let general = joint_form(&model, &design, &pose);
        let error = difference(&found.stiffness, &general);
        assert!(error < 1e-9, "case {index}: {error} from the 6×6 form");
    }
}

#[test]
fn a_wall_as_thick_as_the_radius_is_a_solid_bar_to_the_bit() {
    let round = Model::default();
    let solid = || CrossSection::Tube(Wall::Ratio(1.0));
    let thick = || CrossSection::Tube(Wall::Thickness(0.2));
    for make in [&solid as &dyn Fn() -> CrossSection, &thick] {
        let model = model_with(CrossSections {
            legs: make(),
            platform: make(),
        });
        for text in [
            "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
            "3-RPR R=1.5636 r=0.1006 Lb=2.2135 rj=0.017 rp=0.021",
            "3-RRR R=0.7 r=0.31 Lb=0.66 rj=0.03 rp=0.02",
            "3-RRR R=2.0 r=0.6 Lb=1.6 rj=0.0 rp=0.04",
        ] {
            let design = parsed(text);
            let [hollow, solid] = [&model, &round].map(|model| model.evaluate(&design, GridChoice::Reference));
            assert_eq!(hollow, solid, "{text}");
        }
    }
}

#[test]
fn a_catalogue_gives_the_wall_and_the_mass_of_the_nearest_entry() {
    let entry = |name: &str, radius: f64, wall: f64, mass_per_length| CatalogueEntry {
        name: name.to_owned(),
        radius,
        wall,
        mass_per_length,
    };
    let (thin, thick) = (
        entry("40 x 2", 0.02, 0.002, Some(1.9)),
        entry("60 x 3", 0.03, 0.003, None),
    );
    let catalogue = Catalogue::new(vec![thick.clone(), thin.clone()]).expect("two tubes");
    assert_eq!(catalogue.entries(), [thin.clone(), thick.clone()]);
    for (radius, wanted) in [
        (0.0, &thin),
        (0.02, &thin),
        (0.0251, &thick),
        (0.0249, &thin),
        (1.0, &thick),
    ] {
        assert_eq!(catalogue.nearest(radius), wanted, "{radius}");
    }
    let listed = CrossSection::SquareTube(Wall::Listed(Arc::new(catalogue)));
    assert_eq!(listed.mass_per_length(7850.0, 0.02), 1.9);
    let square = CrossSection::SquareTube(Wall::Thickness(0.003));
    assert_eq!(
        listed.mass_per_length(7850.0, 0.03),
        square.mass_per_length(7850.0, 0.03)
    );
    assert!((square.area(0.03) - (0.06f64.powi(2) - 0.054f64.powi(2))).abs() < 1e-15);
    assert_eq!(listed.inertia(0.03), square.inertia(0.03));
    for (entries, wanted) in [
        (vec![], CatalogueError::Empty),
        (
            vec![thin.clone(), entry("40 x 3", 0.02, 0.003, None)],
            CatalogueError::Twice("40 x 2".to_owned(), "40 x 3".to_owned()),
        ),
        (
            vec![entry("bad", 0.02, 0.03, None)],
            CatalogueError::NoBar("bad".to_owned()),
        ),
    ] {
        assert_eq!(Catalogue::new(entries), Err(wanted));
    }
}

/// A square tube is a prism: in one layer its clearance is that in plan, and crossing members keep that of their layers.
#[test]
fn the_certificate_of_square_tubes_agrees_with_the_grid() {
    let model = strategies::model(|settings| {
        settings.sections = CrossSections {
            legs: CrossSection::SquareTube(Wall::Ratio(0.3)),
            platform: CrossSection::Tube(Wall::Ratio(0.4)),
        };
        settings.thresholds.set(PoseScalar::Clearance, Some(0.005));
    });
    for text in [
        "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.04 rp=0.06",
        "3-RRR R=1.2 r=0.5 Lb=1.0 rj=0.04 rp=0.05",
    ] {
        let design = parsed(text);
        let evaluation = model.evaluate(&design, GridChoice::Fine);
        assert!(evaluation.workspace_radius() > 0.1, "{text}");
        let options = model.claim(&evaluation).expect("a workspace");
        let certificate = model.certify(&design, &options).expect("a certificate");
        assert!(certificate.is_closed(1e-3), "{text}: {certificate:?}");
        let upper = certificate.upper.expect("a limit");
        assert!(upper >= evaluation.workspace_radius() * (1.0 - 2e-3), "{text}: {upper}");
        assert!(
            certificate.lower <= evaluation.workspace_radius() * (1.0 + 1e-9),
            "{text}"
        );
    }
}

proptest! {
    #![proptest_config(applicable_cases(200))]

    /// The clearance of prisms lies between that of the capsules in them and that of the capsules around them.
    #[test]
    fn the_clearance_of_square_tubes_is_that_of_prisms(design in strategies::design(0.005), pose in strategies::pose()) {
        let round = Model::default();
        let square = model_with(CrossSections {
            legs: CrossSection::SquareTube(Wall::Ratio(0.5)),
            platform: CrossSection::SquareTube(Wall::Ratio(0.5)),
        });
        let found = [&round, &square].map(|model| model.pose(&design, &pose));
        prop_assume!(found.iter().all(Result::is_ok));
        let [inside, found] = found.map(|report| report.map_or(f64::NAN, |report| report.nearest.distance));
        // The radii of two sliders are the largest.
        let radii = 3.0 * design.leg_bar_radius().max(design.platform_bar_radius());
        prop_assert!(found <= inside + 1e-12, "{found} > {inside}");
        prop_assert!(found >= inside - (2f64.sqrt() - 1.0) * radii - 1e-12, "{found} << {inside}");
    }
}
