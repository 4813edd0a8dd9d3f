//! The colours of the palette as Rerun colours, and the colours of overlays.

use rerun::Color;

use kinefront_model::mechanism::{Architecture, ReachReason};
use kinefront_scene::Part;
use kinefront_scene::palette;

/// Returns the colour of an architecture.
pub(super) fn architecture(architecture: Architecture) -> Color {
    rgb(palette::architecture(architecture))
}

/// Returns the colour of a part.
pub(super) fn part(part: Part) -> Color {
    rgb(palette::part(part))
}

/// The regular workspace.
pub(super) const WORKSPACE: [u8; 3] = [255, 255, 255];
/// The regular workspace on a light background.
pub(super) const WORKSPACE_ON_LIGHT: [u8; 3] = [24, 26, 32];
/// Parallel singularities.
pub(super) const SINGULAR: [u8; 3] = [255, 40, 40];
/// Poses that limit the regular workspace.
pub(super) const LIMIT: [u8; 3] = [255, 70, 60];
/// Text and ticks.
pub(super) const TEXT: [u8; 3] = [205, 208, 214];
/// Text on a light background.
pub(super) const INK: [u8; 3] = [12, 14, 18];
/// Ellipsoids.
pub(super) const ELLIPSOID: [u8; 3] = [255, 235, 140];

/// A force on the platform, and a moment.
pub(super) const FORCE: [u8; 3] = [255, 90, 200];
pub(super) const MOMENT: [u8; 3] = [90, 220, 255];

/// Returns the colour of an edge of the reachable workspace: orange at the end of a leg's reach, which is a serial
/// singularity, and where two joints of a leg coincide; grey at a joint limit.
pub(super) fn edge(reason: ReachReason) -> Color {
    rgb(match reason {
        ReachReason::OutOfReach | ReachReason::Degenerate => [255, 140, 60],
        ReachReason::BelowLimit | ReachReason::AboveLimit => [150, 156, 168],
    })
}

pub(super) fn rgb([r, g, b]: [u8; 3]) -> Color {
    Color::from_rgb(r, g, b)
}
