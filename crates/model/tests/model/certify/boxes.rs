//! The forms of poses and of boxes of poses, compared with the margins of the model, whose formulas are others.

use kinefront_model::enclosure::{PoseEnclosure, TaylorModel};
use kinefront_model::evaluation::PoseScalar;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::StiffnessDefinition;
use proptest::prelude::*;

use super::definitions::{ISOTROPIC, other_model};
use super::{AT_POSES, is_required, point};
use crate::strategies::{applicable_cases, design, model};

/// Generates the middle of a box as `(r/R, θ, φ)`, no farther from O than a share of `R`.
fn middle(farthest: f64) -> impl Strategy<Value = (f64, f64, f64)> {
    (0.0..farthest, -3.0..3.0f64, -3.0..3.0f64)
}

/// Generates places in a box, in half widths from its middle.
fn places(count: usize) -> impl Strategy<Value = Vec<(f64, f64, f64)>> {
    prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), count)
}

/// A box of poses about a point `(r/R, θ, φ)`.
struct PolarBox {
    radius: f64,
    theta: f64,
    phi: f64,
    /// Half widths of the radius and of both angles.
    widths: [f64; 3],
}

impl PolarBox {
    fn new(design: &Design, (part, theta, phi): (f64, f64, f64), width: f64) -> Self {
        let radius = part * design.base_radius();
        Self {
            radius,
            theta,
            phi,
            widths: [width * radius, width, 0.5 * width],
        }
    }

    fn enclosure(&self) -> PoseEnclosure {
        let (sine, cosine) = TaylorModel::sine_and_cosine(1, self.theta, self.widths[1]);
        let (phi_sine, phi_cosine) = TaylorModel::sine_and_cosine(2, self.phi, self.widths[2]);
        let distance = TaylorModel::variable(0, self.radius, self.widths[0]);
        PoseEnclosure {
            position: [distance * cosine, distance * sine],
            cosine: phi_cosine,
            sine: phi_sine,
        }
    }

    /// Returns the pose at a place in half widths from the middle.
    fn pose(&self, (a, b, c): (f64, f64, f64)) -> Pose {
        let at = self.radius + a * self.widths[0];
        let (theta, phi) = (self.theta + b * self.widths[1], self.phi + c * self.widths[2]);
        Pose::new(at * theta.cos(), at * theta.sin(), phi)
    }
}

/// Whether a form of a scalar is not proved to be positive on a box.
fn is_open(enclosed: &[(PoseScalar, TaylorModel)], scalar: PoseScalar) -> bool {
    enclosed.iter().any(|(found, value)| {
        // A comparison with NaN is false: nothing is proved then.
        let is_proved = value.range()[0] > 0.0;
        *found == scalar && !is_proved
    })
}

proptest! {
    #![proptest_config(applicable_cases(400))]

    /// At a pose, the forms have the signs of the margins of the model, whose formulas are others.
    #[test]
    fn forms_have_the_signs_of_the_margins(
        design in design(0.005),
        x in -1.0..1.0f64,
        y in -1.0..1.0f64,
        phi in -3.0..3.0f64,
        place in prop::sample::select(vec![0, 1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 12, 13]),
    ) {
        let (name, model) = other_model(place);
        let scale = 0.4 * design.base_radius();
        let pose = Pose::new(scale * x, scale * y, phi);
        let values = model.enclose(&design, &point(&pose)).expect("values");
        let is_reached = model.pose(&design, &pose).is_ok();
        // The forms of a clearance are those that are not proved.
        let least = |wanted: PoseScalar| {
            let of = values.iter().filter(|(scalar, _)| *scalar == wanted);
            of.map(|(_, value)| value.constant).fold(f64::INFINITY, f64::min)
        };
        let reach = least(PoseScalar::Reach);
        // At a joint limit, rounding tells.
        prop_assert!(reach.abs() < 1e-12 || (reach > 0.0) == is_reached, "{} {:?}", design, pose);
        if !is_reached || reach <= 0.0 {
            return Err(TestCaseError::reject("the legs do not reach"));
        }
        for &scalar in AT_POSES.iter() {
            let margin = model.margin_at(&design, &pose, scalar);
            if margin.abs() > 1e-6 && is_required(&model, scalar) && model.has(&design, scalar) {
                let of = values.iter().filter(|(found, _)| *found == scalar);
                let ranges: Vec<[f64; 2]> = of.map(|(_, value)| value.range()).collect();
                let is_proved = ranges.iter().all(|[lower, _]| *lower > 0.0);
                let is_refuted = ranges.iter().any(|[_, upper]| *upper < 0.0);
                // The isotropic length is not known where an orientation is at a joint limit or nearly singular: nothing is
                // claimed then.
                let is_open = !is_proved && !is_refuted && name == ISOTROPIC;
                prop_assert!(
                    is_open || is_proved == (margin > 0.0),
                    "{}: {} {:?} {}: {}", name, design, pose, scalar.limit_id(), margin
                );
            }
        }
    }

    /// Where the forms of a box are positive, the clearance is kept at each of its poses.
    #[test]
    fn a_box_without_open_forms_keeps_the_clearance(
        design in design(0.005),
        middle in middle(0.3),
        width in 0.001..0.1f64,
        places in places(20),
        place in prop::sample::select(vec![3, 4, 11, 13]),
    ) {
        let (_, model) = other_model(place);
        let around = PolarBox::new(&design, middle, width);
        let enclosed = model.enclose(&design, &around.enclosure()).expect("values");
        let may_be_unreached = enclosed.iter().all(|(scalar, _)| *scalar == PoseScalar::Reach);
        if may_be_unreached || is_open(&enclosed, PoseScalar::Clearance) {
            return Err(TestCaseError::reject("the clearance is not proved"));
        }
        for place in places {
            let pose = around.pose(place);
            let margin = model.margin_at(&design, &pose, PoseScalar::Clearance);
            prop_assert!(margin >= -1e-12, "{} {:?}: {}", design, pose, margin);
        }
    }

    /// Where no form of the stiffness in the plane is open on a box, it is above its threshold at each of its poses. The middle of the box is
    /// near the centre, where both eigenvalues of a symmetric manipulator are equal, and the threshold is near its stiffness there.
    #[test]
    fn a_box_without_open_forms_keeps_the_stiffness_in_the_plane(
        design in design(0.005),
        middle in middle(0.01),
        exponent in 1.0..5.0f64,
        below in 1.0..6.0f64,
        is_compliance: bool,
        places in places(20),
    ) {
        let definition = match is_compliance {
            true => StiffnessDefinition::Compliance,
            false => StiffnessDefinition::Stiffness,
        };
        let limited = |threshold: Option<f64>| model(|settings| {
            settings.stiffness_definition = definition;
            settings.thresholds.set(PoseScalar::StiffnessXy, threshold);
        });
        let Ok(at_centre) = limited(Some(1e6)).pose(&design, &Pose::new(0.0, 0.0, middle.2)) else {
            return Err(TestCaseError::reject("the legs do not reach"));
        };
        let threshold = at_centre.values[PoseScalar::StiffnessXy] * (1.0 - 10.0_f64.powf(-below));
        let model = limited(Some(threshold));
        let around = PolarBox::new(&design, middle, 10.0_f64.powf(-exponent));
        let enclosed = model.enclose(&design, &around.enclosure()).expect("values");
        let is_incomplete = enclosed.iter().all(|(scalar, _)| *scalar == PoseScalar::Reach)
            || enclosed.iter().any(|(_, value)| value.range()[0].is_nan());
        if is_incomplete || is_open(&enclosed, PoseScalar::StiffnessXy) {
            return Err(TestCaseError::reject("the stiffness is not proved"));
        }
        for place in places {
            let pose = around.pose(place);
            let margin = model.margin_at(&design, &pose, PoseScalar::StiffnessXy);
            prop_assert!(margin >= -1e-9, "{} {:?}: {}", design, pose, margin);
        }
    }

    /// Where the forms of a box are positive, the limits of a motion are kept at each of its poses.
    #[test]
    fn a_box_without_open_forms_keeps_the_limits_of_a_motion(
        design in design(0.005),
        middle in middle(0.3),
        width in 0.0005..0.02f64,
        places in places(10),
    ) {
        let (_, model) = other_model(12);
        let around = PolarBox::new(&design, middle, width);
        let enclosed = model.enclose(&design, &around.enclosure()).expect("values");
        let proved: Vec<PoseScalar> = AT_POSES
            .iter()
            .copied()
            .filter(|scalar| PoseScalar::OF_MOTION.contains(scalar))
            .filter(|scalar| {
                let mut forms = enclosed.iter().filter(|(found, _)| found == scalar).peekable();
                forms.peek().is_some() && forms.all(|(_, value)| value.range()[0] > 0.0)
            })
            .collect();
        if proved.is_empty() {
            return Err(TestCaseError::reject("nothing is proved"));
        }
        for place in places {
            let pose = around.pose(place);
            for scalar in &proved {
                let margin = model.margin_at(&design, &pose, *scalar);
                prop_assert!(margin >= -1e-9, "{} {:?} {}: {}", design, pose, scalar.limit_id(), margin);
            }
        }
    }

    /// The enclosure of a box contains the values at its poses.
    #[test]
    fn enclosures_contain_the_values_of_their_boxes(
        design in design(0.005),
        middle in middle(0.3),
        width in 0.001..0.2f64,
        places in places(20),
        place in prop::sample::select(vec![0, 1, 2, 5, 6, 9, 10, 12]),
    ) {
        let (_, model) = other_model(place);
        let around = PolarBox::new(&design, middle, width);
        let enclosed = model.enclose(&design, &around.enclosure()).expect("values");
        if enclosed.len() < 12 || enclosed.iter().any(|(_, value)| value.range()[0].is_nan()) {
            return Err(TestCaseError::reject("the legs may not reach the whole box"));
        }
        for (a, b, c) in places {
            let values = model.enclose(&design, &point(&around.pose((a, b, c)))).expect("values");
            // Only g5 is left out, where one leg alone is stiff enough.
            prop_assert!(values.len() + 1 >= enclosed.len());
            let of_box = |place: usize| {
                let (scalar, _) = values[place];
                let before = values[..place].iter().filter(|(other, _)| *other == scalar).count();
                enclosed.iter().filter(|(other, _)| *other == scalar).nth(before)
            };
            for (place, (constraint, value)) in values.iter().enumerate() {
                let Some((_, whole)) = of_box(place) else { continue };
                // Its forms are scaled by the middle of the box.
                if *constraint == PoseScalar::NaturalFrequency {
                    continue;
                }
                let [lower, upper] = value.range();
                // Within the remainder of the polynomial, not only within its range.
                let polynomial = whole.value([a, b, c]);
                let slack = whole.remainder + value.remainder + 1e-13 * (1.0 + polynomial.abs());
                prop_assert!((value.constant - polynomial).abs() <= slack, "{}: {} is not {} ± {}", constraint.limit_id(), value.constant, polynomial, slack);
                let [low, high] = whole.range();
                prop_assert!(lower <= high && upper >= low, "{}: [{}, {}] in [{}, {}]", constraint.limit_id(), lower, upper, low, high);
            }
        }
    }
}
