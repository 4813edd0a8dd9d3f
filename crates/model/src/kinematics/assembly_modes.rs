//! Forward kinematics: all assembly modes, the poses that belong to given values of the actuated joints (docs/model.md, section 2.9).
//!
//! With its actuated joint locked, a leg is one constraint on the platform ([`LockedLeg`]). Three lines have at most two solutions, in
//! closed form; three circles have at most six, the real roots of a polynomial of degree six.

use glam::DVec2;
use nalgebra::{Matrix3, Vector3};

use super::polynomial::real_roots;
use crate::mechanism::{AnyLeg, Design, JointKind, Leg, LegSettings, LockedKind, LockedLeg, WorkingMode};
use crate::spatial::{LEGS, Pose, Rotation, cross};

/// Two poses are one mode if they differ by less than this, in the scale of the lengths and in radians.
const SAME: f64 = 1e-6;

/// A pose at which the actuated joints have given values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AssemblyMode {
    /// The pose.
    pub pose: Pose,
    /// Working mode that the legs need there; `None` if a leg would have to reach backwards, as a telescopic leg of negative length.
    pub working_mode: Option<WorkingMode>,
    /// Whether all joints are within their limits.
    pub is_within_limits: bool,
    /// Whether it is a mode of the design: in its working mode, and within its limits.
    pub is_of_design: bool,
}

/// Returns all poses at which the actuated joints of `design` have the given values \[m or rad\], in the order of their orientations
/// in (−π, π]. There is none if the values fit no pose, and none is returned where a continuum of poses fits.
///
/// ```
/// use kinefront_model::kinematics::assembly_modes;
/// use kinefront_model::mechanism::{Design, LegSettings};
///
/// let design: Design = "3-RPR R=1 r=0.4 Lb=1.4 rj=0.02 rp=0.02".parse()?;
/// let modes = assembly_modes(&design, &LegSettings::default(), [0.9, 1.0, 1.1]);
/// assert_eq!(modes.len(), 2);
/// assert!(modes.iter().all(|mode| mode.is_of_design));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn assembly_modes(design: &Design, settings: &LegSettings, values: [f64; LEGS]) -> Vec<AssemblyMode> {
    let legs = [0, 1, 2].map(|index| AnyLeg::new(design, settings, index));
    let locked = [0, 1, 2].map(|index| legs[index].locked(values[index]));
    let scale = design.base_radius() + design.platform_radius() + design.link_length();
    let mut poses = poses_of(&locked, scale);
    poses.sort_by(|a, b| a.phi.total_cmp(&b.phi).then(a.position.x.total_cmp(&b.position.x)));
    poses
        .into_iter()
        .map(|pose| mode_at(design, settings, values, pose))
        .collect()
}

/// Returns all poses that satisfy three constraints of one kind; lengths are about as large as `scale` \[m\].
pub fn poses_of(locked: &[LockedLeg; LEGS], scale: f64) -> Vec<Pose> {
    let candidates = match locked[0].kind {
        LockedKind::BaseLine(_) => on_lines(locked),
        LockedKind::PlatformLine(_) => on_platform_lines(locked),
        LockedKind::Circle(_) => on_circles(locked, scale),
    };
    let mut found: Vec<Pose> = Vec::new();
    for candidate in candidates {
        let Some(pose) = polished(locked, candidate, scale) else {
            continue;
        };
        let is_same = |other: &Pose| {
            let turn = libm::remainder(other.phi - pose.phi, std::f64::consts::TAU);
            other.position.distance(pose.position) < SAME * scale && turn.abs() < SAME
        };
        if !found.iter().any(is_same) {
            found.push(pose);
        }
    }
    found
}

/// Three lines fixed in the base, each of which a point of the platform stays on.
fn on_lines(locked: &[LockedLeg; LEGS]) -> Vec<Pose> {
    let normals = locked.map(|leg| leg.normal());
    // The left null vector of the normals eliminates the position.
    let weights = [0, 1, 2].map(|i| cross(normals[(i + 1) % LEGS], normals[(i + 2) % LEGS]));
    let sum = |term: &dyn Fn(usize) -> f64| (0..LEGS).map(|i| weights[i] * term(i)).sum::<f64>();
    let cosine = sum(&|i| normals[i].dot(locked[i].platform));
    let sine = sum(&|i| normals[i].dot(locked[i].platform.perp()));
    let wanted = sum(&|i| normals[i].dot(locked[i].base));
    let size = libm::hypot(cosine, sine);
    let fraction = wanted / size;
    // Rounding must not lose two modes that coincide.
    if fraction.is_nan() || fraction.abs() > 1.0 + 1e-12 {
        return Vec::new();
    }
    let (middle, half) = (libm::atan2(sine, cosine), libm::acos(fraction.clamp(-1.0, 1.0)));
    let pose = |phi: f64| {
        let turn = Rotation::new(phi);
        // The two lines that cross at the widest angle determine the position best.
        let (best, _) = (0..LEGS)
            .map(|i| (i, weights[i].abs()))
            .fold((0, -1.0), |best, next| if next.1 > best.1 { next } else { best });
        let [j, k] = [(best + 1) % LEGS, (best + 2) % LEGS];
        let offset = |i: usize| normals[i].dot(locked[i].base - turn.apply(locked[i].platform));
        let (first, second) = (offset(j), offset(k));
        let position = DVec2::new(
            first * normals[k].y - second * normals[j].y,
            second * normals[j].x - first * normals[k].x,
        );
        Pose {
            position: position / weights[best],
            phi,
        }
    };
    vec![pose(middle - half), pose(middle + half)]
}

/// Three lines fixed in the platform, each of which stays on a point of the base: lines of the inverse motion.
fn on_platform_lines(locked: &[LockedLeg; LEGS]) -> Vec<Pose> {
    let inverse = locked.map(|leg| LockedLeg {
        platform: leg.base,
        base: leg.platform,
        kind: LockedKind::BaseLine(leg.normal()),
    });
    let back = |pose: Pose| Pose {
        position: -Rotation::new(-pose.phi).apply(pose.position),
        phi: -pose.phi,
    };
    on_lines(&inverse).into_iter().map(back).collect()
}

/// Three circles, each of which a point of the platform stays on.
///
/// The differences of the circles are linear in the position; with it, the first circle is a trigonometric polynomial of degree 3
/// of the orientation (its degree 4 cancels), so a polynomial of degree 6 of the tangent of half the angle.
fn on_circles(locked: &[LockedLeg; LEGS], scale: f64) -> Vec<Pose> {
    const DEGREE: usize = 3;
    const SAMPLES: usize = 2 * DEGREE + 1;
    let radii = locked.map(|leg| leg.radius());
    let circles = |phi: f64| Circles::new(locked, &radii, phi);
    let at = |k: usize| std::f64::consts::TAU * k as f64 / SAMPLES as f64;
    let samples: [f64; SAMPLES] = std::array::from_fn(|k| circles(at(k)).residual());
    // The substitution has its point at infinity opposite to its origin: there the polynomial must not vanish.
    let (largest, _) =
        samples.iter().enumerate().fold(
            (0, 0.0),
            |best, (k, value)| if value.abs() > best.1 { (k, value.abs()) } else { best },
        );
    let origin = at(largest) + std::f64::consts::PI;
    let harmonics: [[f64; 2]; DEGREE + 1] = std::array::from_fn(|k| {
        let sum = |of: &dyn Fn(f64) -> f64| {
            (0..SAMPLES)
                .map(|s| samples[s] * of(k as f64 * (at(s) - origin)))
                .sum::<f64>()
        };
        let share = if k == 0 { 1.0 } else { 2.0 } / SAMPLES as f64;
        [share * sum(&libm::cos), share * sum(&libm::sin)]
    });
    let roots = real_roots(&in_half_tangent(&harmonics));
    let mut candidates = Vec::new();
    for root in roots {
        let phi = origin + 2.0 * libm::atan(root);
        let positions = circles(phi).positions(scale);
        candidates.extend(positions.into_iter().flatten().map(|position| Pose { position, phi }));
    }
    candidates
}

/// Returns the coefficients, from the constant on, of a trigonometric polynomial multiplied by `(1 + t²)³`, with `t = tan(ψ/2)`.
fn in_half_tangent(harmonics: &[[f64; 2]; 4]) -> Vec<f64> {
    let multiply = |a: &[f64], b: &[f64]| {
        let mut product = vec![0.0; a.len() + b.len() - 1];
        for (i, x) in a.iter().enumerate() {
            for (j, y) in b.iter().enumerate() {
                product[i + j] += x * y;
            }
        }
        product
    };
    let (cosine, sine, weight) = ([1.0, 0.0, -1.0], [0.0, 2.0, 0.0], [1.0, 0.0, 1.0]);
    let mut sum = vec![0.0; 7];
    // Powers of `cos ψ + i sin ψ`, each multiplied by `(1 + t²)` as often.
    let (mut real, mut imaginary) = (vec![1.0], vec![0.0]);
    for (k, [of_cosine, of_sine]) in harmonics.iter().enumerate() {
        let rest = (k..3).fold(vec![1.0], |rest, _| multiply(&rest, &weight));
        for (part, factor) in [(&real, of_cosine), (&imaginary, of_sine)] {
            for (entry, value) in sum.iter_mut().zip(multiply(part, &rest)) {
                *entry += factor * value;
            }
        }
        let minus = |a: Vec<f64>, b: Vec<f64>| -> Vec<f64> { a.iter().zip(b).map(|(x, y)| x - y).collect() };
        let plus = |a: Vec<f64>, b: Vec<f64>| -> Vec<f64> { a.iter().zip(b).map(|(x, y)| x + y).collect() };
        let next = minus(multiply(&real, &cosine), multiply(&imaginary, &sine));
        imaginary = plus(multiply(&real, &sine), multiply(&imaginary, &cosine));
        real = next;
    }
    sum
}

/// Three circles at one orientation: `|p + b_i|² = L_i²`.
struct Circles {
    centres: [DVec2; LEGS],
    /// `|b_i|² − L_i²`.
    powers: [f64; LEGS],
}

impl Circles {
    fn new(locked: &[LockedLeg; LEGS], radii: &[f64; LEGS], phi: f64) -> Self {
        let turn = Rotation::new(phi);
        let centres = locked.map(|leg| turn.apply(leg.platform) - leg.base);
        Self {
            centres,
            powers: [0, 1, 2].map(|i| centres[i].length_squared() - radii[i] * radii[i]),
        }
    }

    /// Returns the position multiplied by a determinant, and the determinant: the intersection of the two lines on which the first
    /// circle meets the others.
    fn intersection(&self) -> (DVec2, f64) {
        let [first, second] = [1, 2].map(|j| self.centres[j] - self.centres[0]);
        let [at_first, at_second] = [1, 2].map(|j| 0.5 * (self.powers[0] - self.powers[j]));
        let position = DVec2::new(
            at_first * second.y - at_second * first.y,
            first.x * at_second - second.x * at_first,
        );
        (position, cross(first, second))
    }

    /// Returns the first circle at the intersection, cleared of the determinant.
    fn residual(&self) -> f64 {
        let (position, determinant) = self.intersection();
        position.length_squared()
            + 2.0 * determinant * position.dot(self.centres[0])
            + self.powers[0] * determinant * determinant
    }

    /// Returns the positions at a root: the intersection of the lines, and where the better defined line meets the first circle,
    /// because the lines may be one.
    fn positions(&self, scale: f64) -> [Option<DVec2>; 3] {
        let (position, determinant) = self.intersection();
        let crossing = (determinant.abs() > 1e-9 * scale * scale).then(|| position / determinant);
        let ways = [1, 2].map(|j| (j, self.centres[j] - self.centres[0]));
        let (j, way) = if ways[0].1.length_squared() > ways[1].1.length_squared() {
            ways[0]
        } else {
            ways[1]
        };
        let length = way.length();
        if length < 1e-12 * scale {
            return [crossing, None, None];
        }
        let direction = way / length;
        let along = 0.5 * (self.powers[0] - self.powers[j]) / length;
        // On the line, p = along · direction + s · direction⊥; the first circle is a quadratic in s.
        let base = direction * along;
        let half = direction.perp().dot(self.centres[0]);
        let constant = base.length_squared() + 2.0 * base.dot(self.centres[0]) + self.powers[0];
        let root = (half * half - constant).max(0.0).sqrt();
        let at = |s: f64| Some(base + direction.perp() * s);
        [crossing, at(-half + root), at(-half - root)]
    }
}

/// Returns the pose to which Newton's method converges from a candidate; `None` if that is not close to a solution.
fn polished(locked: &[LockedLeg; LEGS], mut pose: Pose, scale: f64) -> Option<Pose> {
    const ITERATIONS: usize = 60;
    let residual = |pose: &Pose| {
        let turn = Rotation::new(pose.phi);
        let found = locked.each_ref().map(|leg| leg.constraint(pose, &turn, scale));
        (
            Vector3::from_fn(|i, _| found[i].0),
            Matrix3::from_fn(|i, column| found[i].1[column]),
        )
    };
    for _ in 0..ITERATIONS {
        let (error, matrix) = residual(&pose);
        let Some(step) = matrix.try_inverse().map(|inverse| inverse * error) else {
            break;
        };
        if !step.iter().all(|part| part.is_finite()) {
            break;
        }
        pose.position -= DVec2::new(step[0], step[1]) * scale;
        pose.phi -= step[2];
        if step.amax() < 1e-15 {
            break;
        }
    }
    pose.phi = libm::remainder(pose.phi, std::f64::consts::TAU);
    if pose.phi == -std::f64::consts::PI {
        pose.phi = std::f64::consts::PI;
    }
    let (error, _) = residual(&pose);
    (error.amax() < 1e-10).then_some(pose)
}

/// Tells what the legs need at a pose.
fn mode_at(design: &Design, settings: &LegSettings, values: [f64; LEGS], pose: Pose) -> AssemblyMode {
    let driven = design.architecture().driven();
    let is_angle = design.architecture().chain().joints[driven] == JointKind::Revolute;
    let turn = Rotation::new(pose.phi);
    let scale = design.base_radius() + design.link_length();
    let signs: &[bool] = if design.architecture().has_working_modes() {
        &[true, false]
    } else {
        &[true]
    };
    // Sign of the branch in which a leg has its value, and whether it is within its limits there.
    let branch = |index: usize| {
        let arm = turn.apply(settings.geometry.platform_joint(index, design.platform_radius()));
        let of_sign = |&plus: &bool| {
            let mode = WorkingMode::new([plus; LEGS]);
            let leg = AnyLeg::new(&design.with_working_mode(mode), settings, index);
            let (found, beyond) = leg.solve(pose.position + arm, arm).ok()?;
            let difference = leg.joint_values(&found)[driven] - values[index];
            let difference = if is_angle {
                libm::remainder(difference, std::f64::consts::TAU)
            } else {
                difference / scale
            };
            Some((difference.abs(), plus, beyond.is_none()))
        };
        let all = signs.iter().filter_map(of_sign);
        let best = all.reduce(|best, next| if next.0 < best.0 { next } else { best })?;
        (best.0 < 1e-5).then_some((best.1, best.2))
    };
    let branches = [branch(0), branch(1), branch(2)];
    let mut mode = AssemblyMode {
        pose,
        working_mode: None,
        is_within_limits: false,
        is_of_design: false,
    };
    if let [Some(first), Some(second), Some(third)] = branches {
        let needed = WorkingMode::new([first.0, second.0, third.0]);
        mode.working_mode = Some(needed);
        mode.is_within_limits = first.1 && second.1 && third.1;
        mode.is_of_design = mode.is_within_limits && needed == design.working_mode();
    }
    mode
}
