//! Heatmaps and ellipsoids.

use glam::DVec2;
use kinefront_model::evaluation::{GridChoice, Model, ModelSettings, PoseEvaluation, PoseScalar};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_model::stiffness::StiffnessDefinition;
use kinefront_scene::{EllipsoidKind, Field, Heatmap, HeatmapSettings, ellipsoids};
use nalgebra::{Matrix3, Vector3};

use super::{DESIGNS, design, each, model_of, report};

/// Returns the value of a field, computed from the report of a pose.
fn field_value(model: &Model, design: &Design, field: Field, report: &PoseEvaluation) -> f64 {
    match field {
        Field::Scalar(PoseScalar::Displacement) => {
            let inverse = report.stiffness.try_inverse().expect("a stiffness");
            let block = nalgebra::Matrix2::new(inverse[(0, 0)], inverse[(0, 1)], inverse[(1, 0)], inverse[(1, 1)]);
            model.settings().in_plane_force * block.symmetric_eigenvalues().max()
        }
        Field::WorstMargin => {
            let excess = |scalar: PoseScalar| {
                report.values[scalar] / model.settings().thresholds.get(scalar).expect("a limit") - 1.0
            };
            let reach = report.values[PoseScalar::Reach] / design.base_radius();
            let stiffness = [
                PoseScalar::StiffnessXy,
                PoseScalar::StiffnessZ,
                PoseScalar::StiffnessPhiZ,
            ];
            let limited = [PoseScalar::Dexterity].into_iter().chain(stiffness);
            limited.map(excess).fold(reach, f64::min)
        }
        Field::Scalar(scalar) => report.values[scalar],
    }
}

/// Returns the areas of the triangles, which are negative for one that is inverted.
fn areas(heatmap: &Heatmap) -> impl Iterator<Item = f64> {
    let corners = heatmap.triangles.iter();
    let corners = corners.map(|triangle| triangle.map(|vertex| heatmap.vertices[vertex as usize]));
    corners.map(|[a, b, c]| 0.5 * (b - a).perp_dot(c - a))
}

#[test]
fn heatmaps_hold_the_values_of_their_poses_and_contours_lie_on_the_threshold() {
    each(GridChoice::Fine, |model, evaluation| {
        let design = &evaluation.design;
        let phi = evaluation.home.expect("a home").phi;
        for field in Field::of(model, design) {
            let heatmap = Heatmap::new(model, design, field, phi, HeatmapSettings { cells: 60 });
            assert!(heatmap.triangles.len() > 200, "{design} {field:?}");
            let on_edge = |position| heatmap.edges.iter().any(|edge| edge.points.contains(&position));
            let value_at = |position: DVec2| field_value(model, design, field, &report(model, design, position, phi));
            for (&position, &value) in heatmap.vertices.iter().zip(&heatmap.values).step_by(7) {
                let stiff = report(model, design, position, phi).values[PoseScalar::Dexterity] > 1e-3;
                // Near a singularity, the inverse that the displacement is compared with has no correct digits.
                if field != Field::Scalar(PoseScalar::Displacement) || stiff {
                    let wanted = value_at(position);
                    let off = (value - wanted).abs();
                    // At the end of reach, the dexterity is the square root of a difference that is a rounding error.
                    let root = matches!(field, Field::DEXTERITY | Field::WorstMargin);
                    let least = if root && on_edge(position) { 1e-6 } else { 1e-12 };
                    assert!(
                        off <= 1e-6 * wanted.abs() + least,
                        "{design} {field:?}: {value} instead of {wanted}"
                    );
                }
            }
            let threshold = field.threshold(model);
            let scale = threshold.abs().max(1e-3);
            for &position in heatmap.threshold.iter().flatten() {
                let off = (value_at(position) - threshold).abs();
                assert!(
                    off < 1e-6 * scale,
                    "{design} {field:?}: a contour is off its threshold by {off:e}"
                );
            }
            for &position in heatmap.singular.iter().flatten() {
                let off = report(model, design, position, phi).values[PoseScalar::Determinant].abs();
                assert!(off < 1e-9, "{design}: a singularity curve has det A/ℓ = {off:e}");
            }
            assert!(!heatmap.edges.is_empty(), "{design}: the reach has no edge");
            for edge in &heatmap.edges {
                assert!(edge.points.len() > 1, "{design}: an edge is a point");
                for &position in &edge.points {
                    let limit_margin = report(model, design, position, phi).values[PoseScalar::Reach];
                    assert!(
                        (0.0..1e-9).contains(&limit_margin),
                        "{design}: the limit margin at an edge is {limit_margin:e} m"
                    );
                }
            }
            assert!(
                areas(&heatmap).all(|area| area > -5e-13),
                "{design}: a triangle is inverted"
            );
        }
    });
}

/// The triangles cover the reachable area, no more and no less.
#[test]
fn heatmaps_cover_the_reachable_workspace() {
    each(GridChoice::Fine, |model, evaluation| {
        let design = &evaluation.design;
        let phi = evaluation.home.expect("a home").phi;
        let settings = HeatmapSettings { cells: 80 };
        let heatmap = Heatmap::new(model, design, Field::DEXTERITY, phi, settings);
        let area: f64 = areas(&heatmap).sum();
        let reach = 2.0 * design.link_length() + design.base_radius() + design.platform_radius();
        let steps = 1200;
        let step = 2.0 * reach / f64::from(steps);
        let mut reached = 0.0;
        for i in 0..steps {
            for j in 0..steps {
                let position = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) * step - reach;
                let pose = Pose { position, phi };
                reached += f64::from(u8::from(model.pose(design, &pose).is_ok()));
            }
        }
        let wanted = reached * step * step;
        assert!(
            (area / wanted - 1.0).abs() < 0.01,
            "{design}: {area} m² drawn, {wanted} m² reachable"
        );
    });
}

#[test]
fn ellipsoid_axes_are_the_eigenvectors_of_their_block() {
    each(GridChoice::Fine, |model, evaluation| {
        for kind in [EllipsoidKind::Stiffness, EllipsoidKind::Displacement] {
            let set = ellipsoids(model, evaluation, kind).expect("a set");
            assert_eq!(set.ellipsoids.len(), 19);
            let mut largest = 0.0f64;
            for ellipsoid in &set.ellipsoids {
                let k = report(model, &evaluation.design, ellipsoid.pose.position, ellipsoid.pose.phi).stiffness;
                let block: Matrix3<f64> = match kind {
                    EllipsoidKind::Stiffness => k.fixed_view::<3, 3>(0, 0).into_owned(),
                    EllipsoidKind::Displacement => k
                        .try_inverse()
                        .expect("a stiffness")
                        .fixed_view::<3, 3>(0, 0)
                        .into_owned(),
                };
                let (sin, cos) = ellipsoid.angle.sin_cos();
                let axes = [Vector3::new(cos, sin, 0.0), Vector3::new(-sin, cos, 0.0), Vector3::z()];
                for (axis, value) in axes.into_iter().zip(ellipsoid.values.to_array()) {
                    let off = (block * axis - axis * value).norm();
                    assert!(
                        off < 1e-6 * block.norm(),
                        "{}: {kind:?} axis is off by {off:e}",
                        evaluation.design
                    );
                }
                largest = largest.max(ellipsoid.values.max_element());
            }
            // All ellipsoids have one scale, at which neighbours do not overlap.
            assert!(largest * set.scale <= 0.25 * evaluation.workspace_radius());
            assert!(set.scale_text().contains("0.1 m ="));
        }
    });
}

#[test]
fn a_displacement_matches_the_definition_by_compliance() {
    let design = design(DESIGNS[1]);
    let model = model_of(ModelSettings {
        stiffness_definition: StiffnessDefinition::Compliance,
        ..ModelSettings::default()
    });
    let field = Field::Scalar(PoseScalar::Displacement);
    let heatmap = Heatmap::new(&model, &design, field, 0.5, HeatmapSettings { cells: 40 });
    let mut compared = 0;
    for (&position, &value) in heatmap.vertices.iter().zip(&heatmap.values).step_by(11) {
        let k_xy = report(&model, &design, position, 0.5).values[PoseScalar::StiffnessXy];
        if k_xy > 1.0 {
            assert!((value * k_xy / model.settings().in_plane_force - 1.0).abs() < 1e-6);
            compared += 1;
        }
    }
    assert!(compared > 20, "only {compared} values compared");
}
