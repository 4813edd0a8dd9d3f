//! Prescribed regions: against the largest disc, against every pose one by one, and the bars that are sized for them.

use glam::DVec2;
use kinefront_model::evaluation::{
    Better, Constraint, Evaluation, GridChoice, Model, Objective, PoseScalar, Quantity, SizingRanges, WorkspaceTarget,
};
use kinefront_model::mechanism::{Architecture, Design, WorkingMode};
use kinefront_model::polygon::{Polygon, PolygonError};
use kinefront_model::spatial::{Pose, unit};
use kinefront_model::workspace::Region;
use kinefront_testkit::repetitions;
use proptest::prelude::*;
use rayon::prelude::*;

use super::strategies::{self, applicable_cases, bar_ranges, parsed};

fn prescribed(region: Region) -> Model {
    strategies::model(|settings| settings.workspace.region = region)
}

fn rectangle(width: f64, height: f64) -> Region {
    Region::Polygon(Polygon::rectangle(width, height).expect("a rectangle"))
}

/// Designs with a workspace, spread over the design space.
fn designs(count: usize) -> Vec<(Design, f64)> {
    let model = Model::default();
    let mut found = Vec::new();
    for k in 0.. {
        // A Weyl sequence over the five dimensions.
        let fraction = |prime: f64| (f64::from(k) * prime.sqrt()).fract();
        let values = [
            0.6 + 3.0 * fraction(2.0),
            0.1 + 1.4 * fraction(3.0),
            0.5 + 3.0 * fraction(5.0),
            0.01 + 0.09 * fraction(7.0),
            0.01 + 0.09 * fraction(11.0),
        ];
        let architecture = Architecture::ALL[k as usize % 3];
        let mode = WorkingMode::new([true, k % 4 != 1, true]);
        let design = Design::new(architecture, mode, values).expect("a design");
        let radius = model.evaluate(&design, GridChoice::Reference).workspace_radius();
        if radius > 0.0 {
            found.push((design, radius));
        }
        if found.len() == count {
            return found;
        }
    }
    unreachable!("the loop returns")
}

#[test]
fn the_disc_of_the_workspace_radius_is_feasible_and_a_larger_one_is_not() {
    let designs = designs(300);
    let results: Vec<(bool, bool, String)> = designs
        .par_iter()
        .map(|(design, radius)| {
            let feasible = |share: f64| {
                let model = prescribed(Region::Disc(share * radius));
                model.evaluate(design, GridChoice::Reference).is_feasible()
            };
            (feasible(0.9999), feasible(1.0001), design.to_string())
        })
        .collect();
    for (inside, beyond, design) in results {
        assert!(inside && !beyond, "{design}: {inside}, {beyond}");
    }
}

/// Least factor against buckling, which some home orientations miss.
const LEAST_BUCKLING: f64 = 1000.0;

/// Of all home orientations in which a region is feasible, the one with the best objective is found, also where the objective is limited.
#[test]
fn the_home_orientation_is_the_best_one_for_the_objective() {
    let regions = |radius: f64| [Region::Disc(0.7 * radius), rectangle(radius, 0.6 * radius)];
    let objectives = [PoseScalar::StiffnessXy, PoseScalar::Dexterity, PoseScalar::Transmission];
    let mut cases: Vec<(Design, Region, PoseScalar, bool)> = designs(repetitions(16, 40))
        .into_iter()
        .flat_map(|(design, radius)| regions(radius).map(|region| (design, region)))
        .flat_map(|(design, region)| objectives.map(|scalar| (design, region.clone(), scalar, false)))
        .collect();
    // Limits that depend on loads are examined last.
    let under_loads = [PoseScalar::StiffnessXy, PoseScalar::BucklingFactor];
    let of_loads = designs(repetitions(4, 8)).into_iter().flat_map(|(design, radius)| {
        let [_, rectangle] = regions(radius);
        under_loads.map(|scalar| (design, rectangle.clone(), scalar, true))
    });
    cases.extend(of_loads);
    let best_and_found = |(design, region, scalar, is_loaded): &(Design, Region, PoseScalar, bool)| {
        let quantity = Quantity::Worst(*scalar);
        let value = |home_phi_deg: Option<f64>| {
            let model = strategies::model(|settings| {
                settings.workspace.region = region.clone();
                settings.workspace.home_phi_deg = home_phi_deg;
                settings.thresholds.set(PoseScalar::Transmission, Some(0.05));
                let buckling = is_loaded.then_some(LEAST_BUCKLING);
                settings.thresholds.set(PoseScalar::BucklingFactor, buckling);
                let [lower, higher] = [Better::Lower, Better::Higher];
                settings.objectives = [(Quantity::Mass, lower), (quantity, higher)]
                    .map(|(quantity, goal)| Objective { quantity, goal })
                    .to_vec();
            });
            let found = model.evaluate(design, GridChoice::Reference);
            found.quantities.get(quantity).filter(|_| found.is_feasible())
        };
        let homes = (0..144).map(|k| 2.5 * f64::from(k));
        let values: Vec<f64> = homes.filter_map(|home| value(Some(home))).collect();
        let best = values.iter().copied().reduce(f64::max);
        let worst = values.iter().copied().reduce(f64::min);
        (best, worst, value(None))
    };
    let mut differ = 0;
    for (case, (best, worst, found)) in cases
        .iter()
        .zip(cases.par_iter().map(best_and_found).collect::<Vec<_>>())
    {
        let difference = best.zip(found).map(|(best, found)| (found / best - 1.0).abs());
        assert!(
            best.is_some() == found.is_some() && difference.is_none_or(|difference| difference < 1e-9),
            "{case:?}: {best:?} {found:?}"
        );
        differ += usize::from(best.zip(worst).is_some_and(|(best, worst)| best > 1.01 * worst));
    }
    assert!(
        differ > cases.len() / 4,
        "{differ} of {} cases have a choice",
        cases.len()
    );
}

/// Every pose of the region that an evaluation calls feasible holds every constraint; the reports are their least values.
fn examine(model: &Model, design: &Design, positions: &[DVec2]) {
    let found = model.evaluate(design, GridChoice::Reference);
    let home = found.home_phi_deg.expect("a home");
    assert_eq!(found.violation, 0.0);
    for phi_deg in (-4..=4).map(|k| home + 2.5 * f64::from(k)) {
        for &position in positions {
            let pose = Pose {
                position,
                phi: phi_deg.to_radians(),
            };
            for report in &found.constraints {
                let Some(scalar) = report.constraint.scalar() else {
                    continue;
                };
                let margin = model.margin_at(design, &pose, scalar);
                assert!(
                    margin >= report.margin - 1e-6 * report.margin.abs() - 1e-9,
                    "{design}: {:?} {margin} below {} at {pose:?}",
                    report.constraint,
                    report.margin
                );
            }
        }
    }
}

#[test]
fn reports_over_a_rectangle_are_the_least_of_its_poses() {
    let model = prescribed(rectangle(0.6, 0.4));
    let corners = [[-0.3, -0.2], [0.3, -0.2], [0.3, 0.2], [-0.3, 0.2]].map(DVec2::from_array);
    for text in [
        "3-PRR R=1.2 r=0.3 Lb=0.9 rj=0.03 rp=0.03",
        "3-RRR R=1.2 r=0.4 Lb=1.1 rj=0.05 rp=0.05",
    ] {
        examine(&model, &parsed(text), &corners);
    }
}

#[test]
fn the_home_is_the_orientation_with_the_best_worst_margin() {
    let design = parsed("3-PRR R=1.2 r=0.3 Lb=0.9 rj=0.03 rp=0.03");
    let free = prescribed(rectangle(0.5, 0.3));
    let found = free.evaluate(&design, GridChoice::Reference);
    let worst = |evaluation: &Evaluation| {
        let reports = evaluation.constraints.iter().filter(|report| report.required);
        let of_poses = reports.filter(|report| report.constraint != Constraint::Assembly);
        of_poses.map(|report| report.margin).fold(f64::INFINITY, f64::min)
    };
    let best = worst(&found);
    for k in 0..144 {
        let fixed = strategies::model(|settings| {
            settings.workspace.region = rectangle(0.5, 0.3);
            settings.workspace.home_phi_deg = Some(2.5 * f64::from(k));
        });
        let other = worst(&fixed.evaluate(&design, GridChoice::Reference));
        assert!(other <= best + 1e-12, "{}°: {other} > {best}", 2.5 * f64::from(k));
        if 2.5 * f64::from(k) == found.home_phi_deg.expect("a home") {
            assert!((other - best).abs() < 1e-12);
        }
    }
}

#[test]
fn a_polygon_may_lie_beside_the_centre() {
    let corners = [[0.1, 0.1], [0.4, 0.1], [0.25, 0.3]].map(DVec2::from_array);
    let polygon = Polygon::new(corners.to_vec()).expect("a triangle");
    assert_eq!(polygon.inscribed_radius(), 0.0);
    let model = prescribed(Region::Polygon(polygon));
    let design = parsed("3-PRR R=1.2 r=0.3 Lb=0.9 rj=0.03 rp=0.03");
    examine(&model, &design, &corners);
}

#[test]
fn a_region_out_of_reach_is_infeasible_by_more_than_one_that_is_too_soft() {
    let design = parsed("3-PRR R=1.2 r=0.3 Lb=0.9 rj=0.006 rp=0.006");
    let violation = |region: Region| prescribed(region).evaluate(&design, GridChoice::Reference).violation;
    let (near, far) = (violation(Region::Disc(0.2)), violation(Region::Disc(5.0)));
    assert!(near > 0.0 && near < 1.0 && far > 1.0, "{near}, {far}");
    assert!(violation(Region::Disc(6.0)) >= far);
}

#[test]
fn corners_that_are_no_polygon_are_refused() {
    let polygon = |corners: &[[f64; 2]]| Polygon::new(corners.iter().copied().map(DVec2::from_array).collect());
    assert_eq!(polygon(&[[0.0, 0.0], [1.0, 0.0]]), Err(PolygonError::TooFew(2)));
    assert_eq!(
        polygon(&[[0.0, 0.0], [1.0, f64::NAN], [1.0, 1.0]]),
        Err(PolygonError::NotFinite(2))
    );
    let bow = polygon(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(bow, Err(PolygonError::Crossing(1, 3)));
    assert!(polygon(&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.0]]).is_err());
    assert!(Polygon::rectangle(0.0, 1.0).is_err());
    let concave = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]]).expect("a polygon");
    assert!(concave.contains(DVec2::new(1.0, 0.4)) && !concave.contains(DVec2::new(1.0, 0.6)));
}

pub const RANGES: SizingRanges = bar_ranges(true);

#[test]
fn bars_for_a_region_hold_on_its_grid_and_not_with_less() {
    let model = prescribed(rectangle(0.5, 0.3));
    for text in [
        "3-PRR R=1.2 r=0.3 Lb=0.9 rj=0.03 rp=0.03",
        "3-RRR R=1.2 r=0.4 Lb=1.1 rj=0.05 rp=0.05",
        "3-RPR R=1.4 r=0.3 Lb=1.9 rj=0.03 rp=0.03",
    ] {
        let design = parsed(text);
        let target = WorkspaceTarget::Prescribed(GridChoice::Reference);
        let sized = model.sized(&design, &RANGES, target).expect("bars");
        let found = model.evaluate(&sized, GridChoice::Reference);
        assert!(found.is_feasible(), "{sized}: {}", found.violation);
        let thinner = |leg: f64, platform: f64| {
            let [base, radius, link, rj, rp] = sized.values();
            let values = [base, radius, link, rj * leg, rp * platform];
            sized.with_dimensions(values).expect("a design")
        };
        let less = thinner(1.0 - 1e-7, 1.0 - 1e-7);
        assert!(!model.evaluate(&less, GridChoice::Reference).is_feasible(), "{sized}");
        // No pair of radii about it is lighter and holds.
        for k in 1..=40 {
            let leg = 1.0 + 0.01 * f64::from(k - 20);
            let mass_left = found.mass() * (1.0 - 1e-6) - model.legs_mass(&thinner(leg, 1.0));
            let share = mass_left / model.platform_mass(&sized);
            if share > 0.0 {
                let other = thinner(leg, share.sqrt());
                let evaluation = model.evaluate(&other, GridChoice::Reference);
                assert!(!evaluation.is_feasible(), "{other} is lighter than {sized}");
            }
        }
    }
}

#[test]
fn the_lightest_pair_of_two_lists_is_the_one_found_by_trying_all() {
    let model = prescribed(Region::Disc(0.25));
    let radii: Vec<f64> = (1..=8).map(|k| 0.006 * f64::from(k)).collect();
    let ranges = SizingRanges {
        leg: [radii[0], radii[7]],
        platform: [radii[0], radii[7]],
        listed: [Some(radii.clone()), Some(radii.clone())],
        ..RANGES
    };
    for text in [
        "3-PRR R=1.2 r=0.3 Lb=0.9 rj=0.03 rp=0.03",
        "3-RRR R=1.2 r=0.4 Lb=1.1 rj=0.05 rp=0.05",
    ] {
        let design = parsed(text);
        let target = WorkspaceTarget::Prescribed(GridChoice::Reference);
        let sized = model.sized(&design, &ranges, target).expect("bars");
        let [base, platform, link, ..] = design.values();
        let mut lightest = f64::INFINITY;
        for &leg in &radii {
            for &bar in &radii {
                let pair = design.with_dimensions([base, platform, link, leg, bar]);
                let found = model.evaluate(&pair.expect("a design"), GridChoice::Reference);
                if found.is_feasible() {
                    lightest = lightest.min(found.mass());
                }
            }
        }
        assert_eq!(model.mass(&sized), lightest, "{sized}");
    }
}

proptest! {
    #![proptest_config(applicable_cases(60))]

    /// A prescribed region that holds has a worst margin of at least 0, and one that does not has a pose that shows it.
    #[test]
    fn feasibility_is_that_of_the_worst_pose(design in strategies::design(0.005), width in 0.1..0.8, height in 0.1..0.8) {
        let model = prescribed(rectangle(width, height));
        let found = model.evaluate(&design, GridChoice::Reference);
        let worst = found.constraints.iter().filter(|report| report.required).map(|report| report.margin);
        let worst = worst.fold(f64::INFINITY, f64::min);
        prop_assert_eq!(found.is_feasible(), worst >= 0.0 && found.violation == 0.0);
        prop_assert_eq!(found.home.is_some(), found.is_feasible());
        if !found.is_feasible() {
            prop_assert!(worst < 0.0 || found.constraint(Constraint::DeterminantSign).margin <= 0.0, "{found:?}");
        }
    }
}

#[test]
fn directions_of_the_unit_circle_are_used_for_discs() {
    // A disc about a centre off O has no threefold symmetry; all its poses are examined.
    let centre = DVec2::new(0.1, -0.05);
    let model = strategies::model(|settings| {
        settings.workspace.region = Region::Disc(0.15);
        settings.workspace.centre = centre;
    });
    let design = parsed("3-PRR R=1.2 r=0.3 Lb=0.9 rj=0.03 rp=0.03");
    let rim: Vec<DVec2> = (0..36)
        .map(|k| centre + unit(f64::from(k) * 10f64.to_radians()) * 0.15)
        .collect();
    examine(&model, &design, &rim);
}

/// With the scale left open, no similar design that holds the region is lighter, whatever its scale and home orientation.
#[test]
fn the_scale_of_a_sized_geometry_is_the_lightest() {
    let model = prescribed(Region::Disc(0.3));
    let target = WorkspaceTarget::Prescribed(GridChoice::Reference);
    for text in [
        "3-PRR R=0.7 r=0.15 Lb=0.5 rj=0.02 rp=0.02",
        "3-PRR R=3.0 r=0.55 Lb=1.98 rj=0.02 rp=0.02",
        "3-RRR R=0.9 r=0.2 Lb=1.0 rj=0.03 rp=0.03",
        "3-RPR R=1.0 r=0.1 Lb=1.4 rj=0.03 rp=0.03",
    ] {
        let design = parsed(text);
        let open = SizingRanges {
            scale: [0.05, 5.0],
            ..RANGES
        };
        let sized = model
            .sized(&design, &open, target)
            .expect("a design that holds the region");
        let found = model.evaluate(&sized, GridChoice::Reference);
        assert!(found.is_feasible(), "{sized}: {}", found.violation);
        let [base, platform, link, ..] = design.values();
        let factor = sized.base_radius() / base;
        for (k, value) in [platform, link].into_iter().enumerate() {
            assert!(
                (sized.values()[k + 1] / value / factor - 1.0).abs() < 1e-12,
                "{sized} is not similar to {design}"
            );
        }
        for step in -40..=60 {
            let factor = factor * (1.0 + 2e-3 * f64::from(step));
            let values = [base * factor, platform * factor, link * factor, 0.02, 0.02];
            let similar = design.with_dimensions(values).expect("a design");
            let Some(other) = model.sized(&similar, &RANGES, target) else {
                continue;
            };
            let other = model.evaluate(&other, GridChoice::Reference);
            // On the reference grid the number of rings changes with the scale, so that the mass is not quite smooth.
            assert!(
                !other.is_feasible() || other.mass() >= found.mass() * (1.0 - 2e-4),
                "{} is lighter than {sized}",
                other.design
            );
        }
    }
}
