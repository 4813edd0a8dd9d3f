//! The search for infeasible poses, of which the nearest one bounds the radius from above.

use super::{BadPose, Examiner};
use crate::certify::Violation;
use crate::certify::forms::{Enclosures, ProvedForms};
use crate::certify::patch::Patch;
use crate::certify::pose_box::PoseBox;
use crate::enclosure::{Interval, PoseEnclosure, TaylorModel, VARIABLES};
use crate::evaluation::PoseScalar;
use crate::spatial::Pose;

impl Examiner<'_> {
    /// The pose at a point of a patch, within the window.
    fn pose_at(&self, patch: Patch, [first, second, phi]: [f64; VARIABLES]) -> Pose {
        Pose {
            position: self.model.settings().workspace.centre + patch.position([first, second]),
            phi: phi.clamp(self.inner_window[0], self.inner_window[1]),
        }
    }

    /// Returns a constraint that is proved to be violated at a pose, of those that are not proved there.
    fn violated_at(&self, pose: &Pose, proved: ProvedForms) -> Option<PoseScalar> {
        let position = pose.position.to_array().map(Interval::exactly);
        let pose = PoseEnclosure::point(position, Interval::exactly(pose.phi));
        self.forms.enclose_pose(&pose, proved).violated().next()
    }

    /// Takes the pose at a point of a patch if it is bad and nearer than the one that is known; returns a constraint that it violates, of
    /// those that are not proved there.
    fn try_point(
        &self,
        bad: &mut Option<BadPose>,
        patch: Patch,
        point: [f64; VARIABLES],
        proved: ProvedForms,
    ) -> Option<PoseScalar> {
        // In a window without width, no double is known to lie.
        let [first, last] = self.inner_window;
        if self.options.blind_radius.is_some() || first > last || proved.is_all() {
            return None;
        }
        let pose = self.pose_at(patch, point);
        let scalar = self.violated_at(&pose, proved)?;
        let distance = self.distance(&pose);
        if bad.is_none_or(|bad| distance < bad.distance) {
            let violation = Violation { pose, scalar };
            *bad = Some(BadPose { distance, violation });
        }
        Some(scalar)
    }

    /// Returns the distance of a pose from the centre, rounded up.
    fn distance(&self, pose: &Pose) -> f64 {
        let centre = self.model.settings().workspace.centre;
        if pose.position == centre {
            return 0.0;
        }
        let part = |at: f64, of: f64| (Interval::exactly(at) - Interval::exactly(of)).square();
        let square = part(pose.position.x, centre.x) + part(pose.position.y, centre.y);
        square.sqrt().upper()
    }

    /// Looks for bad poses: those of a ring just beyond the claimed radius, each moved inwards as long as it stays bad.
    pub fn find_bad_poses(&self) -> Option<BadPose> {
        const DIRECTIONS: usize = 24;
        const ORIENTATIONS: usize = 5;
        let [first, last] = self.inner_window;
        let mut bad = None;
        if first > last {
            return bad;
        }
        let limit = self.target(bad);
        let mut radius = if self.options.claimed_radius > 0.0 {
            1.005 * self.options.claimed_radius
        } else {
            0.05 * self.design.base_radius()
        };
        for place in 0..=4 * ORIENTATIONS {
            let phi = first + (last - first) * place as f64 / (4 * ORIENTATIONS) as f64;
            self.try_point(&mut bad, Patch::Disc, [0.0, 0.0, phi], ProvedForms::default());
        }
        while bad.is_none() && radius < limit {
            for place in 0..DIRECTIONS * ORIENTATIONS {
                let theta = self.sector * (place % DIRECTIONS) as f64 / DIRECTIONS as f64;
                let phi = first + (last - first) * (place / DIRECTIONS) as f64 / (ORIENTATIONS - 1) as f64;
                let point = [radius, theta, phi];
                if bad.is_none_or(|bad| radius <= bad.distance)
                    && let Some(scalar) = self.try_point(&mut bad, Patch::Disc, point, ProvedForms::default())
                {
                    self.move_inwards(&mut bad, point, scalar);
                }
            }
            radius *= 1.5;
        }
        bad
    }

    /// Moves a bad point towards the centre while it stays bad: along the ray by halving, and sideways by a pattern search.
    /// Only the constraint that it violates is looked at, which any bad pose nearer to the centre may violate.
    fn move_inwards(&self, bad: &mut Option<BadPose>, mut point: [f64; VARIABLES], scalar: PoseScalar) {
        let others = ProvedForms::all_but(scalar);
        let [first, last] = self.inner_window;
        let mut steps = [0.05, 0.2 * (last - first)];
        for _ in 0..40 {
            point[0] = self.nearest_bad(bad, point, scalar);
            let mut has_moved = false;
            for (k, &step) in [1, 2].iter().zip(&steps) {
                for direction in [-1.0, 1.0] {
                    let mut moved = point;
                    moved[*k] += direction * step;
                    moved[2] = moved[2].clamp(first, last);
                    moved[0] *= 1.0 - 1e-6;
                    if self.try_point(bad, Patch::Disc, moved, others).is_some() {
                        point = moved;
                        has_moved = true;
                        break;
                    }
                }
            }
            if !has_moved {
                steps = steps.map(|step| 0.3 * step);
            }
            if steps[0] < 1e-6 {
                break;
            }
        }
        self.nearest_bad(bad, point, scalar);
    }

    /// Returns the least radius found at which the pose in the direction of a bad point violates the same constraint.
    fn nearest_bad(&self, known: &mut Option<BadPose>, point: [f64; VARIABLES], scalar: PoseScalar) -> f64 {
        let others = ProvedForms::all_but(scalar);
        let (mut good, mut bad) = (0.95 * point[0], point[0]);
        for _ in 0..18 {
            let middle = 0.5 * (good + bad);
            if self
                .try_point(known, Patch::Disc, [middle, point[1], point[2]], others)
                .is_some()
            {
                bad = middle;
            } else {
                good = middle;
            }
        }
        bad
    }

    /// Tries poses of the boundary of a prescribed region: those at which a constraint is most often missed.
    pub fn try_boundary(&self) -> Option<BadPose> {
        const POSITIONS: usize = 48;
        const ORIENTATIONS: usize = 5;
        let mut bad = None;
        let region = self.region?;
        let [first, last] = self.inner_window;
        for position in region.outline(POSITIONS) {
            for place in 0..ORIENTATIONS {
                let phi = first + (last - first) * place as f64 / (ORIENTATIONS - 1) as f64;
                let at = Patch::Rectangle([position; 2]);
                self.try_point(&mut bad, at, [position.x, position.y, phi], ProvedForms::default());
            }
        }
        bad
    }

    /// Tries the poses of a box that are likely to be bad: its middle, and the one at which the polynomial of the weakest constraint is
    /// least.
    pub(super) fn try_poses(
        &self,
        bad: &mut Option<BadPose>,
        part: &PoseBox,
        found: &Enclosures,
        worst: Option<&(PoseScalar, TaylorModel)>,
    ) {
        // What the polynomials tell of a pose need not be tried.
        let known_at = |epsilon| part.proved.with_those_that_hold_at(found, epsilon);
        let middle = part.point([0.0; VARIABLES]);
        self.try_point(bad, part.patch, middle, known_at([0.0; VARIABLES]));
        if part.lower[0] == 0.0 && part.patch == Patch::Disc {
            self.try_point(bad, Patch::Disc, [0.0, 0.0, middle[2]], part.proved);
        }
        if let Some(least) = worst.map(|(_, value)| value.least_point()) {
            let point = part.point(least);
            if let Some(scalar) = self.try_point(bad, part.patch, point, known_at(least))
                && !self.is_prescribed()
            {
                self.nearest_bad(bad, point, scalar);
            }
        }
    }
}
