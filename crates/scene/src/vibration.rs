//! The vibrations of a design at a pose: their frequencies, and the bars as they bend.

use glam::DVec3;
use kinefront_model::dynamics::{DynamicsReport, VibratingBar, VibratingPoint};
use kinefront_model::evaluation::{Model, PosedDynamics};
use kinefront_model::mechanism::{Design, MemberKind};
use kinefront_model::spatial::LEGS;

use super::manipulator::Sizes;

/// A bar that is bent, as points along its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct BentBar {
    /// Points from the base towards the platform \[m\].
    pub points: Vec<DVec3>,
    /// Radius of the bar \[m\].
    pub radius: f64,
}

/// A natural frequency, and how the platform moves at it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VibrationMode {
    /// Frequency \[Hz\].
    pub frequency: f64,
    /// Motion of the platform at `P`, to any scale: `x`, `y`, `φz` in the plane, `z`, `φx`, `φy` out of it.
    pub shape: [f64; 3],
    /// Whether the platform stays in the plane.
    pub is_in_plane: bool,
}

/// The vibrations of a design at a pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibrations {
    /// The modes, in the order of their frequencies.
    pub modes: Vec<VibrationMode>,
    bars: Vec<VibratingBar>,
    /// Heights and radii of the bars of each leg and of the platform \[m\].
    sizes: [[[f64; 2]; 3]; LEGS],
}

impl VibrationMode {
    /// Returns what the platform does most, in words; lengths and angles are compared by a lever \[m\].
    pub fn words(&self, lever: f64) -> &'static str {
        let [a, b, c] = self.shape.map(f64::abs);
        match self.is_in_plane {
            true if lever * c > a.hypot(b) => "turns about z",
            true => "shifts in the plane",
            false if lever * b.hypot(c) > a => "tilts",
            false => "heaves",
        }
    }

    /// Returns the displacement of a point of a bar.
    fn displacement(&self, point: &VibratingPoint) -> DVec3 {
        let by_shape = |row: &[f64; 3]| row.iter().zip(&self.shape).map(|(part, by)| part * by).sum::<f64>();
        match self.is_in_plane {
            true => DVec3::new(by_shape(&point.in_plane[0]), by_shape(&point.in_plane[1]), 0.0),
            false => DVec3::new(0.0, 0.0, by_shape(&point.lift)),
        }
    }
}

impl Vibrations {
    /// Returns the vibrations at a pose whose report is known; `None` on rails that bend, of whose share nothing is known.
    pub fn new(model: &Model, design: &Design, posed: &PosedDynamics<'_>, report: &DynamicsReport) -> Option<Self> {
        let (frequencies, shapes) = (report.frequencies?, report.shapes?);
        let mut modes: Vec<VibrationMode> = (0..6)
            .map(|place| VibrationMode {
                frequency: frequencies[place / 3][place % 3],
                shape: shapes[place / 3][place % 3],
                is_in_plane: place < 3,
            })
            .collect();
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        let sizes = Sizes::new(model, design, model.stack_of(design));
        let chain = design.architecture().chain();
        let kinds = [
            chain.proximal.unwrap_or(MemberKind::Crank),
            chain.distal,
            MemberKind::PlatformBar,
        ];
        Some(Self {
            modes,
            bars: posed.vibrating_bars(),
            sizes: [0, 1, 2].map(|leg| kinds.map(|kind| [sizes.height(kind, leg), sizes.radius(kind)])),
        })
    }

    /// Returns the bars, bent by a mode so that the point that moves most moves by an amplitude \[m\], which may be negative.
    pub fn bent(&self, mode: usize, amplitude: f64) -> Vec<BentBar> {
        let Some(mode) = self.modes.get(mode) else {
            return Vec::new();
        };
        let all = self.bars.iter().flat_map(|bar| &bar.points);
        let largest = all.map(|point| mode.displacement(point).length()).fold(0.0, f64::max);
        let scale = if largest > 0.0 { amplitude / largest } else { 0.0 };
        let bent = |bar: &VibratingBar| {
            let [height, radius] = self.sizes[bar.leg][bar.bar];
            let at = |point: &VibratingPoint| point.place.extend(height) + mode.displacement(point) * scale;
            BentBar {
                points: bar.points.iter().map(at).collect(),
                radius,
            }
        };
        self.bars.iter().map(bent).collect()
    }
}
