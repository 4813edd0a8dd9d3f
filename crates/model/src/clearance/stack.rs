//! Where the members and the joints of a design lie along z (docs/model.md, section 8.1).

use super::layers::BodySettings;
use super::places::{DISTAL, MEMBERS, PLATFORM, PROXIMAL, ROWS, kinds};
use crate::mechanism::{Architecture, CylinderSize, Design, JointKind, JointPoint, JointSizes, MemberKind};
use crate::spatial::LEGS;

/// Orders of the three legs.
const ORDERS: [[usize; LEGS]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// How the legs are stacked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum StackOrder {
    /// The legs share their layers.
    #[default]
    Common,
    /// The distal members are in three layers, in the order of the legs that is given from the platform; the proximal members share a layer
    /// beyond them.
    Distal([usize; LEGS]),
    /// Each leg is in layers of its own, in the order that is given from the platform.
    Legs([usize; LEGS]),
}

/// Layers of the members of each leg and of the base, as multiples of the thicker bar's diameter `2·max(r_j, r_p)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stack {
    /// The order that the layers follow.
    pub order: StackOrder,
    /// Layers of each row of members, one for each leg.
    rows: [[f64; LEGS]; ROWS],
    /// Layer of the base.
    base: f64,
    /// Row of the members that are joined to the base.
    first: usize,
}

/// Range of heights of an upright cylinder: from one layer to another, and at least as high as is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Upright {
    /// What it is: a joint or a motor.
    pub kind: MemberKind,
    /// Index of its leg.
    pub leg: usize,
    /// Where it is in the plane.
    pub point: JointPoint,
    /// Rows of the members that are joined to it.
    pub joined: [Option<usize>; 2],
    /// Its radius \[m\].
    pub radius: f64,
    /// The lower and the upper layer between which it reaches.
    pub layers: [f64; 2],
    /// Height \[m\] by which it is higher than these layers at least, about their middle or from the upper one upwards.
    pub height: f64,
    /// Whether it stands on the upper layer.
    pub stands: bool,
}

impl Stack {
    /// Returns the layers that all legs share.
    pub fn common(settings: &BodySettings, architecture: Architecture) -> Self {
        Self::of(settings, architecture, StackOrder::Common)
    }

    /// Returns the stacks that a design can have, the common layers first.
    pub(crate) fn all(settings: &BodySettings, architecture: Architecture) -> impl Iterator<Item = Self> {
        let proximal = architecture.chain().proximal;
        let distal = proximal.map(|_| ORDERS.map(StackOrder::Distal)).into_iter().flatten();
        // The rails of the base remain in one plane.
        let has_rails = proximal == Some(MemberKind::Slider);
        let legs = (!has_rails)
            .then_some(ORDERS.map(StackOrder::Legs))
            .into_iter()
            .flatten();
        let orders = std::iter::once(StackOrder::Common).chain(distal).chain(legs);
        orders.map(move |order| Self::of(settings, architecture, order))
    }

    fn of(settings: &BodySettings, architecture: Architecture, order: StackOrder) -> Self {
        let kinds = kinds(architecture);
        let [proximal, distal, platform] = kinds.map(|kind| kind.map_or(0.0, |kind| settings.layers.of(kind)));
        let has_proximal = kinds[PROXIMAL].is_some();
        // Distances between the layers of the members of a leg, and between the layers of two legs.
        let (from_platform, along_leg) = (distal - platform, proximal - distal);
        let of_leg = if has_proximal { 2.0 * along_leg } else { from_platform };
        let place = |leg: usize, order: [usize; LEGS]| order.iter().position(|other| *other == leg).unwrap_or(0) as f64;
        let each = |layer: &dyn Fn(usize) -> f64| [layer(0), layer(1), layer(2)];
        let (proximal, distal) = match order {
            StackOrder::Common => ([proximal; LEGS], [distal; LEGS]),
            StackOrder::Distal(order) => (
                [proximal + 2.0 * from_platform; LEGS],
                each(&|leg| distal + place(leg, order) * from_platform),
            ),
            StackOrder::Legs(order) => (
                each(&|leg| proximal + place(leg, order) * of_leg),
                each(&|leg| distal + place(leg, order) * of_leg),
            ),
        };
        let first = if has_proximal { PROXIMAL } else { DISTAL };
        // The base is beyond all legs, seen from the platform.
        let nearest_to_base = if has_proximal { proximal[0] } else { distal[0] };
        let beyond = if nearest_to_base >= platform {
            f64::max
        } else {
            f64::min
        };
        let mut rows = [[platform; LEGS]; ROWS];
        (rows[PROXIMAL], rows[DISTAL]) = (proximal, distal);
        Self {
            order,
            base: rows[first].into_iter().fold(rows[first][0], beyond),
            rows,
            first,
        }
    }

    /// Returns the layer of the members of a row that belong to a leg.
    pub(crate) fn layer(&self, row: usize, leg: usize) -> f64 {
        self.rows[row][leg]
    }

    /// Returns the height of the member of a leg that is of a kind above `z = 0` \[m\].
    pub fn height(&self, kind: MemberKind, leg: usize, design: &Design) -> f64 {
        let row = match kind {
            MemberKind::PlatformBar => PLATFORM,
            kind if kind == design.architecture().chain().distal => DISTAL,
            _ => PROXIMAL,
        };
        self.layer(row, leg) * thickness(design)
    }

    /// Returns the height of the base above `z = 0` \[m\].
    pub fn base_height(&self, design: &Design) -> f64 {
        self.base * thickness(design)
    }

    /// Returns the lowest and the highest point of a joint and its radius \[m\]; `None` if the joint is no body.
    pub fn joint(&self, leg: usize, point: JointPoint, sizes: &JointSizes, design: &Design) -> Option<[f64; 3]> {
        let own = |upright: &Upright| upright.leg == leg && upright.kind == MemberKind::Joint(point);
        let upright = self.uprights(sizes, design).into_iter().find(own)?;
        let [low, high] = upright.heights(thickness(design));
        Some([low, high, upright.radius])
    }

    /// Returns the joints of the legs that are bodies: those with a size, and the pins of joints whose members are not in neighbouring layers.
    pub(crate) fn uprights(&self, sizes: &JointSizes, design: &Design) -> Vec<Upright> {
        let architecture = design.architecture();
        let chain = architecture.chain();
        let is_common = self.order == StackOrder::Common;
        let mut uprights = Vec::new();
        for leg in 0..LEGS {
            for joint in (0..chain.joints.len()).filter(|&joint| chain.joints[joint] == JointKind::Revolute) {
                let point = match chain.points[joint] {
                    // A telescopic leg has B at A.
                    JointPoint::B if self.first == DISTAL => JointPoint::A,
                    point => point,
                };
                let (below, above) = match point {
                    JointPoint::A => (Some(self.first), None),
                    JointPoint::B => (Some(DISTAL), Some(PROXIMAL)),
                    JointPoint::C => (Some(PLATFORM), Some(DISTAL)),
                };
                let layer = |row: Option<usize>| row.map_or(self.base, |row| self.layer(row, leg));
                let ends = [layer(below), layer(above)];
                let layers = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                // A pin is as thick as the thinner bar that it joins.
                let pin = match point {
                    JointPoint::C => design.leg_bar_radius().min(design.platform_bar_radius()),
                    JointPoint::A | JointPoint::B => design.leg_bar_radius(),
                };
                let CylinderSize { radius, height } = sizes.revolute;
                let mut add = |kind: MemberKind, radius: f64, height: f64, stands: bool| {
                    uprights.push(Upright {
                        kind,
                        leg,
                        point,
                        joined: [below, above],
                        radius,
                        layers,
                        height,
                        stands,
                    });
                };
                if radius > 0.0 || !is_common {
                    add(MemberKind::Joint(point), radius.max(pin), height, false);
                }
                if sizes.motor.radius > 0.0 && architecture.driven() == joint {
                    add(MemberKind::Motor, sizes.motor.radius, sizes.motor.height, true);
                }
            }
        }
        uprights
    }
}

/// Returns the pairs of a joint and a member, and of two joints, that are not joined, as indices of members and, beyond [`MEMBERS`], of joints.
pub(crate) fn pairs_of_joints(
    kinds: [Option<MemberKind>; ROWS],
    uprights: &[Upright],
) -> impl Iterator<Item = [usize; 2]> {
    let with_members = uprights.iter().enumerate().flat_map(move |(index, upright)| {
        let members = (0..MEMBERS).filter(move |member| {
            let (row, leg) = (member / LEGS, member % LEGS);
            let is_own = leg == upright.leg && upright.joined.contains(&Some(row));
            let is_on_platform = upright.point == JointPoint::C && row == PLATFORM;
            kinds[row].is_some() && !is_own && !is_on_platform
        });
        members.map(move |member| [member, MEMBERS + index])
    });
    let with_joints = uprights.iter().enumerate().flat_map(move |(second, upright)| {
        let before = uprights[..second].iter().enumerate().filter(move |(_, other)| {
            let shares = |row: &Option<usize>| row.is_some() && upright.joined.contains(row);
            let is_own = other.leg == upright.leg && other.joined.iter().any(shares);
            // The base and the platform are rigid.
            let is_rigid = other.point == upright.point && upright.point != JointPoint::B;
            !is_own && !is_rigid
        });
        before.map(move |(first, _)| [MEMBERS + first, MEMBERS + second])
    });
    with_members.chain(with_joints)
}

/// Returns the height of a layer \[m\].
pub(crate) fn thickness(design: &Design) -> f64 {
    2.0 * design.leg_bar_radius().max(design.platform_bar_radius())
}

impl Upright {
    /// Returns the lowest and the highest point \[m\], for a height of a layer \[m\].
    pub fn heights(&self, thickness: f64) -> [f64; 2] {
        let [low, high] = self.layers.map(|layer| layer * thickness);
        if self.stands {
            return [high, high + self.height];
        }
        let (middle, half) = (0.5 * (low + high), 0.5 * self.height);
        [low.min(middle - half), high.max(middle + half)]
    }
}
