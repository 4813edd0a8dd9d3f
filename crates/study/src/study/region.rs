//! The region of positions of a study.

use glam::DVec2;

use super::Study;
use crate::settings::GeometrySection;
use kinefront_model::mechanism::DesignVariable;
use kinefront_model::workspace::Region;

impl Study {
    /// Returns the region; that of a study at fault is the largest disc.
    pub fn region(&self) -> Region {
        self.workspace.region.region().unwrap_or(Region::Largest)
    }

    /// Returns the distance from `O` of the farthest position of a prescribed region \[m\].
    fn farthest_position(&self) -> Option<f64> {
        let centre = DVec2::from_array(self.workspace.centre_m);
        match self.region() {
            Region::Largest => None,
            Region::Disc(radius) => Some(centre.length() + radius),
            Region::Polygon(polygon) => {
                let distances = polygon.corners().iter().map(|corner| (centre + *corner).length());
                distances.reduce(f64::max)
            }
        }
    }

    /// Explains that no design within the bounds reaches the region, if that is certain.
    pub(super) fn unreachable_region(&self) -> Option<String> {
        let distance = self.farthest_position()?;
        let [base, platform, link] = [
            self.range(DesignVariable::BaseRadius)[0],
            self.range(DesignVariable::PlatformRadius)[1],
            self.range(DesignVariable::LinkLength)[1],
        ];
        // Elsewhere than in the paper, rails and guides may lead anywhere.
        let has_other_rails = self.bounds.range(DesignVariable::RailAngle) != [0.0; 2];
        if self.geometry != GeometrySection::default() || has_other_rails {
            return None;
        }
        let lengths = [self.bounds.range(DesignVariable::ProximalLength)[1], link];
        let reach = self
            .architectures
            .iter()
            .map(|architecture| architecture.farthest_reach(base, platform, lengths))
            .fold(0.0, f64::max);
        (distance > reach).then(|| {
            format!(
                "extends to {distance:.3} m from O, but no design within the bounds reaches farther than {reach:.3} m; make the \
                 region smaller, or enlarge the bounds of Lb and r"
            )
        })
    }
}
