//! What the entities of a window's scene represent, for a window that tells what the pointer is over.

use super::draw::{BAR_AXES, GROUPS};
use super::paths;
use kinefront_scene::{EllipsoidKind, Field, Part};

/// What an entity of the scene represents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SceneTarget {
    /// A field over the positions of the platform.
    Field(Field),
    /// The solid with this index among those of the given parts.
    Solid(&'static [Part], usize),
    /// The ellipsoid with this index.
    Ellipsoid(EllipsoidKind, usize),
    /// The regular workspace.
    Workspace,
    /// Line on which a field has the value of its threshold.
    Threshold,
    /// Parallel singularities.
    Singularity,
    /// Edge of the positions that the legs reach.
    Edge,
}

impl SceneTarget {
    /// Returns what an entity of the scene represents, and which of its instances is meant; `None` for labels and axes.
    pub fn of_entity(entity: &str, instance: Option<u64>) -> Option<Self> {
        let entity = format!("/{}", entity.trim_start_matches('/'));
        let below = |root: &str| entity.strip_prefix(root)?.strip_prefix('/');
        if entity == paths::WORKSPACE || below(paths::WORKSPACE).is_some() {
            return Some(SceneTarget::Workspace);
        }
        if let Some(rest) = below(paths::HEATMAP) {
            return match rest.split_once('/') {
                Some((key, "field")) => Field::find(key).map(SceneTarget::Field),
                Some((_, "threshold")) => Some(SceneTarget::Threshold),
                Some((_, "singular")) => Some(SceneTarget::Singularity),
                Some((_, "edge")) => Some(SceneTarget::Edge),
                _ => None,
            };
        }
        let instance = instance? as usize;
        if let Some(rest) = below(paths::ELLIPSOIDS) {
            let kind = EllipsoidKind::ALL
                .into_iter()
                .find(|kind| rest == format!("{}/bodies", kind.key()))?;
            return Some(SceneTarget::Ellipsoid(kind, instance));
        }
        let group = below(paths::MANIPULATOR)?;
        // The axis of a bar is the bar.
        let group = group
            .strip_suffix(BAR_AXES)
            .and_then(|rest| rest.strip_suffix('/'))
            .unwrap_or(group);
        let (_, parts) = GROUPS.iter().find(|(name, _)| *name == group)?;
        Some(SceneTarget::Solid(parts, instance))
    }
}

#[cfg(test)]
mod tests {
    use kinefront_model::evaluation::PoseScalar;

    use super::*;

    #[test]
    fn entities_tell_what_they_are() {
        let field = SceneTarget::of_entity("/design/heatmap/k_xy/field", Some(0));
        assert_eq!(field, Some(SceneTarget::Field(Field::Scalar(PoseScalar::StiffnessXy))));
        let singular = SceneTarget::of_entity("design/heatmap/outlines/singular", Some(3));
        assert_eq!(singular, Some(SceneTarget::Singularity));
        let link = SceneTarget::of_entity("/design/manipulator/legs", Some(4));
        assert!(matches!(link, Some(SceneTarget::Solid(parts, 4)) if parts.contains(&Part::Link)));
        let axis = SceneTarget::of_entity("/design/manipulator/legs/axes", Some(4));
        assert_eq!(axis, link);
        let slider = SceneTarget::of_entity("/design/manipulator/joints/sliders", Some(1));
        assert_eq!(slider, Some(SceneTarget::Solid(&[Part::Slider], 1)));
        let ellipsoid = SceneTarget::of_entity("/design/ellipsoids/stiffness/bodies", Some(2));
        assert_eq!(ellipsoid, Some(SceneTarget::Ellipsoid(EllipsoidKind::Stiffness, 2)));
        assert_eq!(
            SceneTarget::of_entity("/design/workspace/outline", None),
            Some(SceneTarget::Workspace)
        );
        for nothing in [
            "/design/manipulator/labels",
            "/design/heatmap/k_xy/unknown",
            "/pins/0",
            "/design",
        ] {
            assert_eq!(SceneTarget::of_entity(nothing, Some(0)), None, "{nothing}");
        }
    }
}
