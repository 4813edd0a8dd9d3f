//! A 3-D view on the screen: conversion between the scene and screen coordinates.

use egui::{Pos2, Rect, pos2};
use glam::{DQuat, DVec2, DVec3};

/// Distance from the eye \[m\] in front of which nothing is drawn.
const NEAR: f64 = 0.01;

/// Smallest slope of a ray to a horizontal plane. Flatter rays would move a point of that plane by metres per pixel.
const FLATTEST: f64 = 0.05;

/// Place and direction from which a 3-D view shows the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    /// Position in the scene \[m\].
    pub position: DVec3,
    /// Rotation from the frame of the view (x to the right, y up, z towards the viewer) to that of the scene.
    pub rotation: DQuat,
    /// Vertical angle of view \[rad\].
    pub fov_y: f64,
}

/// A 3-D view with the rectangle that it fills on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneView {
    /// The eye.
    pub eye: Eye,
    /// The rectangle.
    pub rect: Rect,
}

impl SceneView {
    /// Screen points per unit of slope from the axis of the view.
    fn focal_length(&self) -> f64 {
        0.5 * f64::from(self.rect.height()) / libm::tan(0.5 * self.eye.fov_y)
    }

    /// Returns the screen coordinates of a point of the scene, and the number of screen points per metre there; `None` if
    /// the point is behind the eye.
    pub fn screen(&self, at: DVec3) -> Option<(Pos2, f64)> {
        let seen = self.eye.rotation.inverse() * (at - self.eye.position);
        let depth = -seen.z;
        let scale = self.focal_length() / depth;
        let centre = self.rect.center();
        let place = pos2(centre.x + (seen.x * scale) as f32, centre.y - (seen.y * scale) as f32);
        (depth > NEAR).then_some((place, scale))
    }

    /// Returns the point under the pointer in the horizontal plane at `height` \[m\]; `None` if the eye does not look at
    /// the plane there, or at too small an angle.
    pub fn on_plane(&self, pointer: Pos2, height: f64) -> Option<DVec2> {
        let offset = pointer - self.rect.center();
        let direction = DVec3::new(f64::from(offset.x), -f64::from(offset.y), -self.focal_length());
        let ray = self.eye.rotation * direction.normalize();
        let distance = (height - self.eye.position.z) / ray.z;
        let is_seen = ray.z.abs() > FLATTEST && distance > NEAR;
        is_seen.then(|| (self.eye.position + distance * ray).truncate())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(position: DVec3) -> SceneView {
        let back = position.normalize();
        let right = DVec3::Z.cross(back).normalize();
        SceneView {
            eye: Eye {
                position,
                rotation: DQuat::from_mat3(&glam::DMat3::from_cols(right, back.cross(right), back)),
                fov_y: 55.0_f64.to_radians(),
            },
            rect: Rect::from_min_max(pos2(300.0, 100.0), pos2(1100.0, 700.0)),
        }
    }

    #[test]
    fn a_point_of_a_plane_is_found_again_at_its_place_on_the_screen() {
        let view = view(DVec3::new(0.3, -1.1, 1.7));
        for (x, y, height) in [(0.0, 0.0, 0.0), (0.4, -0.3, 0.12), (-0.7, 0.5, -0.05)] {
            let (place, _) = view.screen(DVec3::new(x, y, height)).expect("it is before the eye");
            let found = view.on_plane(place, height).expect("the plane is seen");
            assert!((found - DVec2::new(x, y)).length() < 1e-6, "{found}");
        }
        let (centre, scale) = view.screen(DVec3::ZERO).expect("it is before the eye");
        assert_eq!(centre, view.rect.center());
        let expected = 300.0 / (27.5_f64.to_radians().tan() * DVec3::new(0.3, -1.1, 1.7).length());
        assert!((scale - expected).abs() < 1e-9 * expected);
    }

    #[test]
    fn what_is_behind_the_eye_or_seen_too_flatly_has_no_place() {
        let flat = view(DVec3::new(0.0, -2.0, 0.02));
        assert_eq!(flat.on_plane(flat.rect.center(), 0.0), None);
        assert_eq!(flat.on_plane(flat.rect.center_top(), 0.0), None);
        assert_eq!(flat.screen(DVec3::new(0.0, -3.0, 0.0)), None);
    }
}
