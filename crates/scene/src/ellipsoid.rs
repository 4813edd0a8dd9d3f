//! Stiffness and displacement ellipsoids at points of the regular workspace.

use glam::{DVec2, DVec3};

use super::field::free_stiffness;
use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::kinematics::Jacobian;
use kinefront_model::mechanism::{AnyLeg, Manipulator};
use kinefront_model::spatial::{Pose, smaller_eigenvalue, unit};
use kinefront_model::stiffness::PlanarStiffness;

/// Meaning of the axes of an ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EllipsoidKind {
    /// Eigenvectors and eigenvalues of the translational block of `K` \[N/m\]: force per displacement.
    Stiffness,
    /// Eigenvectors and eigenvalues of the translational block of `K⁻¹` \[m/N\]: displacement under a unit force.
    Displacement,
}

impl EllipsoidKind {
    /// Both kinds.
    pub const ALL: [EllipsoidKind; 2] = [EllipsoidKind::Stiffness, EllipsoidKind::Displacement];

    /// Returns the short name, as in entity paths.
    pub fn key(self) -> &'static str {
        match self {
            EllipsoidKind::Stiffness => "stiffness",
            EllipsoidKind::Displacement => "displacement",
        }
    }
}

/// One ellipsoid; its third axis is z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// Pose of the platform.
    pub pose: Pose,
    /// Angle of the first axis to `Ox` \[rad\].
    pub angle: f64,
    /// Eigenvalues along the two axes in the plane, the larger one first, and along z \[N/m or m/N\].
    pub values: DVec3,
}

/// Ellipsoids of one kind and their common scale.
#[derive(Debug, Clone, PartialEq)]
pub struct EllipsoidSet {
    /// Kind of the ellipsoids.
    pub kind: EllipsoidKind,
    /// Drawn length per unit of the value \[m/(N/m) or m/(m/N)\].
    pub scale: f64,
    /// The ellipsoids.
    pub ellipsoids: Vec<Ellipsoid>,
}

impl EllipsoidSet {
    /// Returns the scale as a sentence for people.
    pub fn scale_text(&self) -> String {
        match self.kind {
            EllipsoidKind::Stiffness => format!("stiffness ellipsoids: 0.1 m = {:.3e} N/m", 0.1 / self.scale),
            EllipsoidKind::Displacement => {
                let micrometres = 0.1 / self.scale * 1e6;
                format!("displacement ellipsoids under 1 N: 0.1 m = {micrometres:.3} µm")
            }
        }
    }
}

/// Largest semi-axis as a fraction of `R_w`, so that neighbouring ellipsoids do not overlap.
const LARGEST: f64 = 0.24;

/// Computes ellipsoids at the centre and on two rings of the regular workspace, at the home orientation; `None` for a
/// design without a regular workspace.
pub fn ellipsoids(model: &Model, evaluation: &Evaluation, kind: EllipsoidKind) -> Option<EllipsoidSet> {
    let home = evaluation.home?;
    let radius = evaluation.workspace_radius();
    let points = std::iter::once(DVec2::ZERO)
        .chain((0..6).map(|k| unit(f64::from(k) * std::f64::consts::FRAC_PI_3) * 0.5 * radius))
        .chain((0..12).map(|k| unit(f64::from(k) * std::f64::consts::FRAC_PI_6) * 0.97 * radius));
    let poses = points.map(|offset| Pose {
        position: home.position + offset,
        phi: home.phi,
    });
    let manipulator = Manipulator::<AnyLeg>::new(&evaluation.design, &model.settings().legs);
    let stiffness_model = model.stiffness(&evaluation.design)?;
    let at = |pose: Pose| {
        let posture = manipulator.posture(&pose).ok()?;
        let stiffness = stiffness_model.stiffness(&posture, &Jacobian::new(&posture));
        ellipsoid(pose, &stiffness, kind)
    };
    let ellipsoids: Vec<Ellipsoid> = poses.filter_map(at).collect();
    let largest = ellipsoids.iter().map(|e| e.values.max_element()).fold(0.0, f64::max);
    (largest > 0.0).then(|| EllipsoidSet {
        kind,
        scale: LARGEST * radius / largest,
        ellipsoids,
    })
}

fn ellipsoid(pose: Pose, stiffness: &PlanarStiffness, kind: EllipsoidKind) -> Option<Ellipsoid> {
    let [xx, xy, yy, zz] = match kind {
        EllipsoidKind::Stiffness => {
            let k = &stiffness.in_plane;
            [k[0], k[1], k[3], stiffness.out_of_plane[0]]
        }
        EllipsoidKind::Displacement => {
            let [xx, xy, yy] = free_stiffness(&stiffness.in_plane)?;
            let determinant = xx * yy - xy * xy;
            let vertical = stiffness
                .stiffness_values(kinefront_model::stiffness::StiffnessDefinition::Compliance)
                .k_z;
            if determinant <= 0.0 || vertical <= 0.0 {
                return None;
            }
            [yy / determinant, -xy / determinant, xx / determinant, 1.0 / vertical]
        }
    };
    let small = smaller_eigenvalue(xx, xy, yy);
    Some(Ellipsoid {
        pose,
        angle: 0.5 * libm::atan2(2.0 * xy, xx - yy),
        values: DVec3::new(xx + yy - small, small, zz),
    })
}
