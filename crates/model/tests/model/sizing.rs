//! Compares the lightest bars for a geometry with evaluations and an exhaustive search.

use kinefront_model::evaluation::{
    GridChoice, Model, ModelSettings, PoseScalar, Quantity, SizingRanges, WorkspaceTarget,
};
use kinefront_model::mechanism::{Design, DesignVariable, WorkingMode};
use proptest::prelude::*;

use crate::strategies::{self, applicable_cases, bar_ranges, design, parsed};

const RANGES: SizingRanges = bar_ranges(false);

fn sized(model: &Model, design: &Design, target: WorkspaceTarget) -> Option<Design> {
    model.sized(design, &RANGES, target)
}

fn with_bars(design: &Design, [leg, platform]: [f64; 2]) -> Design {
    let with_leg = design.with(DesignVariable::LegBarRadius, leg);
    let with_both = with_leg.and_then(|design| design.with(DesignVariable::PlatformBarRadius, platform));
    with_both.expect("a design")
}

fn radius(model: &Model, design: &Design) -> f64 {
    let evaluation = model.evaluate(design, GridChoice::Reference);
    evaluation.workspace_radius()
}

/// No pair of radii on a fine lattice that reaches the same workspace radius is lighter by more than 1 %.
#[test]
fn no_lighter_pair_of_radii_is_found_by_trying_all() {
    let model = Model::default();
    for (text, target) in [
        ("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056", 1.2),
        ("3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023", 0.22),
        ("3-PRR R=3.872 r=1.947 Lb=1.977 rj=0.039 rp=0.096", 1.58),
        ("3-RPR R=1.5636 r=0.1006 Lb=2.2135 rj=0.017 rp=0.021", 0.54),
        ("3-RRR R=0.7 r=0.11 Lb=0.56 rj=0.03 rp=0.02", 0.45),
    ] {
        let design = parsed(text);
        let found = sized(&model, &design, WorkspaceTarget::Radius(target)).expect("there are such bars");
        let reached = radius(&model, &found);
        assert!(reached >= 0.995 * target, "{text}: {reached} instead of {target}");
        let least = model.mass(&found);
        // r_j ranges from three times thinner to three times thicker; for each r_j, bisection finds the lightest r_p.
        let lightest = (-20..=20)
            .filter_map(|k| {
                let leg = found.leg_bar_radius() * 3f64.powf(f64::from(k) / 20.0);
                let with = |platform: f64| with_bars(&found, [leg, platform]);
                let (mut short, mut enough) = (1e-4, 0.1);
                if radius(&model, &with(enough)) < reached {
                    return None;
                }
                for _ in 0..12 {
                    let middle = 0.5 * (short + enough);
                    if radius(&model, &with(middle)) < reached {
                        short = middle;
                    } else {
                        enough = middle;
                    }
                }
                Some(model.mass(&with(enough)))
            })
            .fold(f64::INFINITY, f64::min);
        assert!(
            least <= 1.01 * lightest,
            "{text}: {least} kg, but {lightest} kg is sufficient"
        );
    }
}

/// Returns a pair of radii near those of a design that is lighter by more than 1 % and holds what is asked for.
fn lighter_pair(model: &Model, design: &Design, holds: impl Fn(&Design) -> bool) -> Option<Design> {
    let factors = (-8..=8).map(|k| 1.0 + 0.025 * f64::from(k));
    let pairs = factors
        .clone()
        .flat_map(|leg| factors.clone().map(move |platform| [leg, platform]));
    let radii = [design.leg_bar_radius(), design.platform_bar_radius()];
    pairs
        .map(|[leg, platform]| with_bars(design, [leg * radii[0], platform * radii[1]]))
        .filter(|other| model.mass(other) < 0.99 * model.mass(design))
        .find(holds)
}

/// Bars are as thick as a natural frequency requires, and no lighter pair of a lattice has it over the same workspace.
#[test]
fn bars_are_sized_for_a_natural_frequency() {
    const FREQUENCY: PoseScalar = PoseScalar::NaturalFrequency;
    let mut sized_for_it = 0;
    for (text, target) in [
        ("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056", 1.2),
        ("3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023", 0.22),
        ("3-RPR R=1.5636 r=0.1006 Lb=2.2135 rj=0.017 rp=0.021", 0.54),
        ("3-RRR R=0.7 r=0.11 Lb=0.56 rj=0.03 rp=0.02", 0.45),
    ] {
        let design = parsed(text);
        let limited_to = |frequency: Option<f64>| {
            let mut settings = ModelSettings {
                quantities: [Quantity::Worst(FREQUENCY)].into_iter().collect(),
                ..ModelSettings::default()
            };
            settings.dynamics.payload.mass = 10.0;
            settings.thresholds.set(FREQUENCY, frequency);
            Model::new(settings).expect("a model")
        };
        let worst = |model: &Model, design: &Design| {
            let evaluation = model.evaluate(design, GridChoice::Reference);
            let frequency = evaluation.quantities.get(Quantity::Worst(FREQUENCY));
            (evaluation.workspace_radius(), frequency.unwrap_or(0.0))
        };
        let free = limited_to(None);
        let stiff = sized(&free, &design, WorkspaceTarget::Radius(target)).expect("there are such bars");
        let (_, before) = worst(&free, &stiff);
        let wanted = 1.2 * before;
        let model = limited_to(Some(wanted));
        let found = sized(&model, &design, WorkspaceTarget::Radius(target)).expect("there are such bars");
        if found == stiff {
            // Where the thickest bars miss the frequency, the bars are those for all else.
            continue;
        }
        sized_for_it += 1;
        let (reached, frequency) = worst(&model, &found);
        assert!(reached >= 0.995 * target, "{text}: {reached} instead of {target}");
        assert!(
            frequency >= wanted && frequency < 1.02 * wanted,
            "{text}: {frequency} Hz instead of {wanted}, and {before} Hz without a limit"
        );
        let least = model.mass(&found);
        assert!(
            least > 0.99 * model.mass(&stiff),
            "{text}: {least} kg and {} kg",
            model.mass(&stiff)
        );
        let lighter = lighter_pair(&model, &found, |other| worst(&model, other).0 >= reached);
        assert!(lighter.is_none(), "{text}: {least} kg, but {lighter:?} is lighter");
    }
    assert!(sized_for_it > 0);
}

#[test]
fn what_cannot_be_had_is_none() {
    let model = Model::default();
    let design = parsed("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056");
    assert_eq!(
        sized(&model, &design, WorkspaceTarget::Radius(3.0)),
        None,
        "the geometry does not allow the radius"
    );
    let thin = SizingRanges {
        leg: [0.0, 0.01],
        platform: [0.0, 0.01],
        ..RANGES
    };
    let found = model.sized(&design, &thin, WorkspaceTarget::Radius(1.0));
    assert_eq!(found, None, "the ranges of the bars do not allow the radius");
    let apart = design.with(DesignVariable::BaseRadius, 8.0).expect("a design");
    assert_eq!(
        sized(&model, &apart, WorkspaceTarget::Largest),
        None,
        "the legs do not reach"
    );
    // The weakest pose of this design is at the centre.
    let text = "3-RPR R=1.5770 r=0.6257 Lb=1.22825 rj=0.0219 rp=0.0324";
    let centre = parsed(text);
    let found = sized(&model, &centre, WorkspaceTarget::Largest).expect("bars");
    assert!(radius(&model, &found) > 0.15);
    // Bars are also sized for an asymmetric working mode, a centre away from O and a given home orientation.
    let model = strategies::model(|settings| {
        settings.workspace.centre = glam::DVec2::new(0.1, -0.05);
        settings.workspace.home_phi_deg = Some(30.0);
    });
    let design = design.with_working_mode(WorkingMode::new([true, true, false]));
    let found = sized(&model, &design, WorkspaceTarget::Largest).expect("bars");
    assert!(radius(&model, &found) > 0.0);
}

proptest! {
    #![proptest_config(applicable_cases(300))]

    /// Over the whole design space, sized bars are within their ranges and reach most of the required workspace.
    #[test]
    fn sized_designs_hold_what_they_were_sized_for(design in design(0.0)) {
        let model = Model::default();
        let strongest = with_bars(&design, [0.1; 2]);
        let found = sized(&model, &design, WorkspaceTarget::Largest)
            .ok_or_else(|| TestCaseError::reject("the geometry cannot be sized"))?;
        for bar in [found.leg_bar_radius(), found.platform_bar_radius()] {
            prop_assert!(bar.is_finite() && bar > 0.0 && bar <= 0.1);
        }
        let (reached, most) = (radius(&model, &found), radius(&model, &strongest));
        prop_assert!(model.mass(&found) <= model.mass(&strongest) * (1.0 + 1e-12));
        // Narrow regions between the sampled poses reduce the radius of a few designs.
        prop_assert!(reached > 0.0 || most < 0.05 * design.base_radius(), "{} of {}", reached, most);
    }
}
