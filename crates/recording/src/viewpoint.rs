//! Directions from which the manipulator is seen.

use glam::DVec3;

/// Distance of the scene to the left of the middle of the view, as a multiple of its size: the legend covers what is far to the right.
const ASIDE: f64 = 0.25;

/// Direction from which the manipulator is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Viewpoint {
    /// From the front and above, so low that the layers of the members can be told apart.
    #[default]
    Oblique,
    /// Along z, with y upwards, as in a drawing.
    Top,
    /// Along y, which shows the layers of the members.
    Front,
    /// Along −x.
    Side,
}

impl Viewpoint {
    /// All viewpoints.
    pub const ALL: [Viewpoint; 4] = [Viewpoint::Oblique, Viewpoint::Top, Viewpoint::Front, Viewpoint::Side];

    /// Returns the name for people.
    pub fn name(self) -> &'static str {
        match self {
            Viewpoint::Oblique => "Oblique",
            Viewpoint::Top => "Top",
            Viewpoint::Front => "Front",
            Viewpoint::Side => "Side",
        }
    }

    /// Returns the place of the eye and the point that it looks at, as multiples of the size of the scene.
    pub(super) fn eye_and_target(self) -> [[f64; 3]; 2] {
        let eye = DVec3::from_array(self.eye());
        let right = eye.truncate().normalize().perp();
        let target = (ASIDE * right).extend(0.0);
        [(eye + target).to_array(), target.to_array()]
    }

    /// Returns the place of an eye that looks at the centre of the scene.
    fn eye(self) -> [f64; 3] {
        match self {
            Viewpoint::Oblique => [0.35, -1.75, 1.55],
            // From exactly above, the viewer would turn the picture upside down.
            Viewpoint::Top => [0.0, -0.08, 2.4],
            Viewpoint::Front => [0.0, -2.4, 0.02],
            Viewpoint::Side => [2.4, 0.0, 0.02],
        }
    }
}
