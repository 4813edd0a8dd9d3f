//! The stack of a design whose legs may be in layers of their own (docs/model.md, section 8.1).

use glam::DVec2;

use super::{Model, PoseScalar};
use crate::clearance::{Stack, Stacking};
use crate::mechanism::{AnyLeg, Design, Manipulator, Posture};
use crate::spatial::{Rotation, unit};

/// Number of orientations over the full turn at which stacks are compared.
const TURNS: usize = 36;

/// Number of orientations over the rotation range about a prescribed home orientation.
const WITHIN_RANGE: usize = 5;

/// Number of positions on the boundary of the region, besides the centre.
const BOUNDARY: usize = 8;

/// Radius of the circle of positions where the study prescribes no region, as a share of `R`.
const SHARE: f64 = 0.15;

/// What is compared at one orientation: the sign of `det A` at the centre and the postures that the legs reach, the first one there;
/// `None` if the centre is infeasible, whatever the clearance.
type Postures = Option<(f64, Vec<(DVec2, Posture)>)>;

impl Model {
    /// Returns the stack of the members of a design: the layers that all legs share, unless the study lets the stack be chosen and these
    /// layers do not give the clearance that is required. It is then the stack with the largest clearance at some poses about the home
    /// orientation that suits it best, the first one among equals.
    ///
    /// The choice depends on the design and the study alone, and not on a grid.
    pub fn stack_of(&self, design: &Design) -> Stack {
        let settings = &self.settings().bodies;
        let common = Stack::common(settings, design.architecture());
        if settings.stacking == Stacking::Common {
            return common;
        }
        let required = self.settings().thresholds.get(PoseScalar::Clearance).unwrap_or(0.0);
        let manipulator = Manipulator::<AnyLeg>::new(design, &self.settings().legs);
        let (orientations, half_window) = self.orientations_of_stacks();
        let positions = self.positions_of_stacks(design);
        // The clearance is compared, and scalars that depend on loads take long.
        let mut checker = self.checker_in::<AnyLeg>(design, &common);
        checker.drop_limits(|scalar| scalar == PoseScalar::Clearance || scalar.is_of_loads());
        let at_orientation = |phi: f64| -> Postures {
            let arms = manipulator.arms(&Rotation::new(phi));
            let sign = checker.feasible_sign(positions[0], &arms)?;
            let at = |position: DVec2| Some((position, manipulator.posture_at(position, &arms).ok()?));
            Some((sign, positions.iter().filter_map(|&position| at(position)).collect()))
        };
        let postures: Vec<Postures> = orientations.into_iter().map(at_orientation).collect();
        let rate = |stack: &Stack| {
            let bodies = self.bodies_in(design, stack);
            let of_orientation = |postures: &Postures| {
                let (sign, postures) = postures.as_ref()?;
                let least = postures.iter().fold(f64::INFINITY, |least, (position, posture)| {
                    bodies.clearance_up_to(&manipulator, *position, posture, least)
                });
                Some((*sign, least))
            };
            let least: Vec<Option<(f64, f64)>> = postures.iter().map(of_orientation).collect();
            best_window(&least, half_window)
        };
        let mut best = (rate(&common), common);
        if best.0 >= required {
            return common;
        }
        for stack in Stack::all(settings, design.architecture()).skip(1) {
            let clearance = rate(&stack);
            if clearance > best.0 {
                best = (clearance, stack);
            }
        }
        best.1
    }

    /// Returns the orientations \[rad\], and how many of them are within half the rotation range on each side of a home orientation;
    /// `None` if all of them are within that of the only home orientation.
    fn orientations_of_stacks(&self) -> (Vec<f64>, Option<usize>) {
        let spec = &self.settings().workspace;
        let range = spec.rotation_range_deg;
        match spec.home_phi_deg {
            Some(home) => {
                let share = |k: usize| k as f64 / (WITHIN_RANGE - 1) as f64 - 0.5;
                let phi = |k: usize| (home + share(k) * range).to_radians();
                ((0..WITHIN_RANGE).map(phi).collect(), None)
            }
            None => {
                let step = 360.0 / TURNS as f64;
                let phi = |k: usize| (k as f64 * step).to_radians();
                let half = (0.5 * range / step).ceil() as usize;
                ((0..TURNS).map(phi).collect(), Some(half.min(TURNS / 2)))
            }
        }
    }

    /// Returns the centre of the region and positions on its boundary \[m\].
    fn positions_of_stacks(&self, design: &Design) -> Vec<DVec2> {
        let spec = &self.settings().workspace;
        let mut positions = vec![DVec2::ZERO];
        if spec.region.is_prescribed() {
            positions.extend(spec.region.outline(BOUNDARY));
        } else {
            let angle = |k: usize| std::f64::consts::TAU * k as f64 / BOUNDARY as f64;
            positions.extend((0..BOUNDARY).map(|k| unit(angle(k)) * (SHARE * design.base_radius())));
        }
        positions.into_iter().map(|position| spec.centre + position).collect()
    }
}

/// Returns the largest of the least clearances within half a window on each side of an orientation, around the full turn, or that of all
/// orientations without a window; −∞ if none has feasible centres with one sign of `det A`.
fn best_window(orientations: &[Option<(f64, f64)>], half: Option<usize>) -> f64 {
    let count = orientations.len();
    let least = |places: &mut dyn Iterator<Item = usize>| {
        let mut first = None;
        let mut least = f64::INFINITY;
        for place in places {
            let Some((sign, clearance)) = orientations[place] else {
                return f64::NEG_INFINITY;
            };
            if sign != *first.get_or_insert(sign) {
                return f64::NEG_INFINITY;
            }
            least = least.min(clearance);
        }
        least
    };
    let Some(half) = half else {
        return least(&mut (0..count));
    };
    let windows = (0..count).map(|home| least(&mut (0..=2 * half).map(|k| (home + count + k - half) % count)));
    windows.fold(f64::NEG_INFINITY, f64::max)
}
