//! Settings of a study that describe members beyond the design vector: the sizes of sliders and the layers in which
//! members lie.

use serde::{Deserialize, Serialize};

use crate::mechanism::{Design, MemberKind};

/// Heights of the layers of members along z, as multiples of the thicker bar's diameter `2·max(r_j, r_p)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Layers {
    /// Layer of the platform bars.
    pub platform: f64,
    /// Layer of the links, which end at the platform.
    pub link: f64,
    /// Layer of the telescopic legs.
    pub telescopic_leg: f64,
    /// Layer of the cranks.
    pub crank: f64,
    /// Layer of the guides that turn about a base joint.
    pub turning_guide: f64,
    /// Layer of the guides on the platform or on sliders.
    pub guide: f64,
    /// Layer of the sliders.
    pub slider: f64,
}

/// Sizes and layers of members, which the design vector does not specify.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BodySettings {
    /// Length of a slider along its rail, including the rounded ends, as a multiple of `r_j`.
    pub slider_length: f64,
    /// Half the width of a slider, which is also half its height, as a multiple of `r_j`; at most half its length.
    pub slider_half_width: f64,
    /// Layers in which the members lie.
    pub layers: Layers,
    /// Whether all legs share their layers.
    pub stacking: Stacking,
}

/// Whether the legs share their layers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stacking {
    /// Members of a kind are in one layer, whatever their leg.
    #[default]
    Common,
    /// For each design, the order of the legs that gives the largest clearance, if their common layers do not give the one that is
    /// required.
    Chosen,
}

impl Stacking {
    /// The names in study files.
    pub const NAMES: [&'static str; 2] = ["common", "chosen"];
}

impl Layers {
    /// Layers that place all members in one plane.
    pub const ONE_PLANE: Layers = Layers {
        platform: 0.0,
        link: 0.0,
        telescopic_leg: 0.0,
        crank: 0.0,
        turning_guide: 0.0,
        guide: 0.0,
        slider: 0.0,
    };

    /// Returns the layer of members of `kind`.
    pub fn of(&self, kind: MemberKind) -> f64 {
        match kind {
            MemberKind::Slider => self.slider,
            MemberKind::TelescopicLeg => self.telescopic_leg,
            MemberKind::Crank => self.crank,
            MemberKind::TurningGuide => self.turning_guide,
            MemberKind::Guide => self.guide,
            MemberKind::Link => self.link,
            MemberKind::PlatformBar => self.platform,
            // Joints have no layer of their own: they reach from one member to another.
            MemberKind::Joint(_) | MemberKind::Motor => 0.0,
        }
    }
}

impl Default for Layers {
    /// Returns layers that can be built for every architecture: the members of a leg are stacked on top of each other
    /// with the platform at the bottom, so that the pin of a joint runs between neighbouring layers and hits no member
    /// in between.
    fn default() -> Self {
        Self {
            platform: 0.0,
            link: 1.25,
            telescopic_leg: 1.25,
            crank: 2.5,
            turning_guide: 2.5,
            guide: 1.25,
            slider: 2.75,
        }
    }
}

impl Default for BodySettings {
    fn default() -> Self {
        Self {
            slider_length: 6.0,
            slider_half_width: 1.5,
            layers: Layers::default(),
            stacking: Stacking::default(),
        }
    }
}

impl BodySettings {
    /// Returns the radius of members of `kind`, or that of a leg's bars for joints \[m\].
    pub fn radius(&self, kind: MemberKind, design: &Design) -> f64 {
        match kind {
            MemberKind::Slider => self.slider_half_width * design.leg_bar_radius(),
            MemberKind::PlatformBar => design.platform_bar_radius(),
            _ => design.leg_bar_radius(),
        }
    }

    /// Returns half the length of a slider \[m\].
    pub fn slider_half_length(&self, design: &Design) -> f64 {
        0.5 * self.slider_length * design.leg_bar_radius()
    }
}
