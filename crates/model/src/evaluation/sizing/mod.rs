//! Sizing of the bars: determines how thin the bars of a geometry may be for a regular workspace of a given radius, and
//! so the lightest ones (docs/model.md, section 9).
//!
//! Mass and stiffness grow with both bar radii, and neither reach nor dexterity depends on them. For a given geometry
//! and workspace radius, finding the lightest pair of bar radii is therefore a problem of two variables. It is solved
//! on a few rings of the disc, with some hundred poses of which a few dozen matter, whereas an evaluation examines ten
//! thousand. A sized design is therefore only a proposal that must be evaluated.

mod disc;
mod golden_section;
mod growth;
mod lightest;
mod listed;
mod pose_columns;
mod prescribed;
mod scale;
mod sizer;

use super::{GridChoice, Model};
use crate::mechanism::Design;
use crate::pose::PoseScalar;
use sizer::Sizer;

/// Ranges that sizing may vary.
#[derive(Debug, Clone, PartialEq)]
pub struct SizingRanges {
    /// Range of `r_j` \[m\].
    pub leg: [f64; 2],
    /// Range of `r_p` \[m\].
    pub platform: [f64; 2],
    /// Values of `r_j` and `r_p` within their ranges \[m\], if they are listed.
    pub listed: [Option<Vec<f64>>; 2],
    /// Whether bars for a prescribed region are sized to the last digits, not to 1/1000 of their mass.
    pub is_exact: bool,
    /// Smallest and largest factor by which `R`, `r` and `L_b` may be multiplied, if bars are sized exactly for a prescribed region;
    /// both are 1 if the lengths must stay as they are.
    pub scale: [f64; 2],
}

/// Workspace radius for which bars are sized.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WorkspaceTarget {
    /// A given radius \[m\].
    Radius(f64),
    /// Largest radius that the geometry allows with the thickest bars.
    Largest,
    /// The region that the study prescribes, as it is examined on one of the grids.
    Prescribed(GridChoice),
}

impl Model {
    /// Returns `design` with the lightest bars within `ranges` that provide the required stiffness on the disc of the
    /// workspace radius `target`. The design's own bars are the starting point. Returns `None` if the geometry or the
    /// ranges do not allow such bars.
    ///
    /// Exact sizing for a prescribed region, and nothing else, also multiplies `R`, `r` and `L_b` by a factor within `ranges`.
    ///
    /// The disc and the orientations are sampled, the latter as on the reference grid. The other constraints are
    /// checked only at the centre and on the rim, and the clearance with members as thick as the design's own bars. The
    /// home orientation is the one in which the design is stiffest before it is sized.
    pub fn sized(&self, design: &Design, ranges: &SizingRanges, target: WorkspaceTarget) -> Option<Design> {
        let assembly = self.assembly(design);
        if assembly.value < assembly.threshold {
            return None;
        }
        let grid = match target {
            WorkspaceTarget::Prescribed(grid) => grid,
            WorkspaceTarget::Radius(_) | WorkspaceTarget::Largest => GridChoice::Reference,
        };
        with_leg!(design.architecture(), L => {
            let is_frequency = |scalar: PoseScalar| scalar.entry().is_frequency;
            let sized = |with_frequencies: bool| {
                let mut sizer = Sizer::<L>::new(self, design, ranges, grid);
                if !with_frequencies {
                    sizer.checker.drop_limits(is_frequency);
                }
                sizer.set_bars([ranges.leg[1], ranges.platform[1]]);
                match target {
                    WorkspaceTarget::Radius(radius) => sizer.sized_for_disc(Some(radius)),
                    WorkspaceTarget::Largest => sizer.sized_for_disc(None),
                    WorkspaceTarget::Prescribed(grid) if ranges.is_exact => sizer.sized_exactly(grid),
                    WorkspaceTarget::Prescribed(grid) => sizer.sized_prescribed(grid),
                }
            };
            // Beyond some radius, the mass of the bars lowers the natural frequency more than their stiffness raises it: the bars are then
            // sized for all else, and the design may still have the frequency.
            let limits_frequency = self.settings().thresholds.iter().any(|(scalar, _)| is_frequency(scalar));
            sized(true).or_else(|| limits_frequency.then(|| sized(false)).flatten())
        })
    }
}
