//! Forces and moments in the legs at several poses at once (docs/model.md, sections 14.1, 14.4 and 14.6).

use super::bars::Beyond;
use super::path::{BARS, PathLanes};
use super::{LegStiffness, Loads, StrengthInputs, StrengthModel};
use crate::lanes::{Planar, Real, dot, less, scaled, sum};
use crate::spatial::LEGS;

/// A force or moment: its value under the given wrench and the weight, and by how much the set of wrenches changes it at most.
#[derive(Clone, Copy)]
pub(super) struct Ranged<V> {
    pub value: V,
    pub range: V,
}

impl<V: Real> Ranged<V> {
    /// Returns bounds of the magnitude and of the range.
    #[inline(always)]
    pub fn bound(self) -> Self {
        Self {
            value: self.value.magnitude_bound(),
            range: self.range.magnitude_bound(),
        }
    }

    /// Returns the largest magnitude.
    #[inline(always)]
    pub fn most(self) -> V {
        self.value.abs() + self.range
    }
}

/// What the part towards the platform exerts at a place of a leg on the part towards the base.
#[derive(Clone, Copy)]
pub(super) struct Resultants<V> {
    /// Force in the plane under the given wrench and the weight \[N\].
    pub force: Planar<V>,
    /// Force along z \[N\].
    pub lift: Ranged<V>,
    /// Moments in the plane's axes under the given wrench and the weight \[N·m\].
    pub moment: Planar<V>,
    /// Moment about z \[N·m\].
    pub turn: Ranged<V>,
}

/// What the loads on a leg at several poses at once follow from.
pub(super) struct LegBasis<'a, V: Real> {
    pub path: &'a PathLanes<V>,
    /// What lies from each bar on.
    pub from: [Beyond<V>; BARS + 1],
    /// `u_i`, and the moment of the line about `P`.
    pub u: Planar<V>,
    pub moment: V,
    pub transmission: V,
    pub stiffness: &'a LegStiffness<V>,
    /// The inverse of the twists of the joints, as the force and moment at `P` for a unit power of each.
    pub reactions: [[V; 3]; 3],
    /// `g_i⁰`: what the leg transmits at `P` because of its weight in the plane.
    pub own: [V; 3],
}

/// A leg at several poses at once, with what it transmits.
pub(super) struct LoadedLeg<'a, V: Real> {
    basis: &'a LegBasis<'a, V>,
    /// `λ_i`.
    pub line: Ranged<V>,
    /// `g_i` under the given wrench and the weight.
    pub out: [V; 3],
    /// `S_i⁻¹ C_out`.
    pub share: [[V; 3]; 3],
}

impl<'a, V: Real> std::ops::Deref for LoadedLeg<'a, V> {
    type Target = LegBasis<'a, V>;

    #[inline(always)]
    fn deref(&self) -> &LegBasis<'a, V> {
        self.basis
    }
}

/// The three legs at several poses at once, with what they transmit.
pub(super) struct LoadedLegs<'a, V: Real> {
    pub legs: [LoadedLeg<'a, V>; LEGS],
    /// `A⁻ᵀ`: what the line of each leg takes of a wrench in the plane.
    pub by: [[V; 3]; LEGS],
    /// `C_out`.
    pub bending: [V; 6],
}

/// Returns the product of a symmetric matrix, given as an upper triangle, and a vector.
#[inline(always)]
pub(super) fn times<V: Real>(s: &[V; 6], v: &[V; 3]) -> [V; 3] {
    [
        s[0] * v[0] + s[1] * v[1] + s[2] * v[2],
        s[1] * v[0] + s[3] * v[1] + s[4] * v[2],
        s[2] * v[0] + s[4] * v[1] + s[5] * v[2],
    ]
}

/// Returns the in-plane wrench about `P` of a mass beyond a place.
#[inline(always)]
fn weight_in_plane<V: Real>(loads: &Loads, beyond: &Beyond<V>) -> [V; 3] {
    let like = beyond.mass;
    let [x, y] = [like.splat(loads.gravity[0]), like.splat(loads.gravity[1])];
    [
        beyond.mass * x,
        beyond.mass * y,
        beyond.moment.x * y - beyond.moment.y * x,
    ]
}

/// Returns the moment about a place, relative to `P`, of the weight along z of a mass.
#[inline(always)]
pub(super) fn weight_moment<V: Real>(loads: &Loads, beyond: &Beyond<V>, about: Planar<V>) -> Planar<V> {
    let arm = beyond.moment.minus(about.scaled(beyond.mass));
    let z = arm.x.splat(loads.gravity[2]);
    Planar::new(arm.y * z, -(arm.x * z))
}

impl StrengthModel {
    /// Returns what the legs transmit at several poses at once.
    #[inline(always)]
    pub(super) fn loaded<'a, V: Real>(&self, legs: &'a [LegBasis<'a, V>; LEGS]) -> LoadedLegs<'a, V> {
        let like = legs[0].moment;
        let [fx, fy, fz, mx, my, mz] = self.loads.wrench;
        let mut left = [like.splat(fx), like.splat(fy), like.splat(mz)];
        let mut wrench = [like.splat(fz), like.splat(mx), like.splat(my)];
        let mut stiffness = [like.splat(0.0); 6];
        // What keeps the free ends of the legs where they are without weight.
        let mut held = [[like.splat(0.0); 3]; LEGS];
        let [_, sags_down] = self.loads.weighs();
        for (leg, held) in legs.iter().zip(&mut held) {
            left = less(&left, &leg.own);
            for entry in 0..stiffness.len() {
                stiffness[entry] = stiffness[entry] + leg.stiffness.at_platform[entry];
            }
            if sags_down {
                *held = self.held(leg);
                wrench = sum(&wrench, held);
            }
        }
        let bending = V::symmetric_inverse(&stiffness);
        let by = V::inverse_transpose(&[row(&legs[0]), row(&legs[1]), row(&legs[2])]);
        LoadedLegs {
            legs: [
                self.loaded_leg(&legs[0], (&by[0], &left), (&wrench, &held[0]), &bending),
                self.loaded_leg(&legs[1], (&by[1], &left), (&wrench, &held[1]), &bending),
                self.loaded_leg(&legs[2], (&by[2], &left), (&wrench, &held[2]), &bending),
            ],
            by,
            bending,
        }
    }

    /// Returns a leg whose line takes the part `by` of the wrench `left`, and which takes its share of the wrench out of the plane less
    /// what is `held` of its own weight.
    #[inline(always)]
    fn loaded_leg<'a, V: Real>(
        &self,
        leg: &'a LegBasis<'a, V>,
        (by, left): (&[V; 3], &[V; 3]),
        (wrench, held): (&[V; 3], &[V; 3]),
        bending: &[V; 6],
    ) -> LoadedLeg<'a, V> {
        let [a, b, c, d, e, f] = *bending;
        let columns = [
            times(&leg.stiffness.at_platform, &[a, b, c]),
            times(&leg.stiffness.at_platform, &[b, d, e]),
            times(&leg.stiffness.at_platform, &[c, e, f]),
        ];
        let share = [
            [columns[0][0], columns[1][0], columns[2][0]],
            [columns[0][1], columns[1][1], columns[2][1]],
            [columns[0][2], columns[1][2], columns[2][2]],
        ];
        let taken = [dot(&share[0], wrench), dot(&share[1], wrench), dot(&share[2], wrench)];
        LoadedLeg {
            basis: leg,
            line: Ranged {
                value: dot(by, left),
                range: self.loads.in_plane_range(by),
            },
            out: less(&taken, held),
            share,
        }
    }

    /// Returns the bars and joints of the legs.
    #[inline(always)]
    pub(super) fn paths_at<V: Real>(&self, inputs: &StrengthInputs<V>) -> [PathLanes<V>; LEGS] {
        [
            self.paths[0].at(&inputs.legs[0], inputs.arms[0]),
            self.paths[1].at(&inputs.legs[1], inputs.arms[1]),
            self.paths[2].at(&inputs.legs[2], inputs.arms[2]),
        ]
    }

    /// Returns the legs, before the loads are shared.
    #[inline(always)]
    pub(super) fn legs<'a, V: Real>(
        &self,
        inputs: &'a StrengthInputs<V>,
        paths: &'a [PathLanes<V>; LEGS],
    ) -> [LegBasis<'a, V>; LEGS] {
        [
            self.leg(inputs, &paths[0], 0),
            self.leg(inputs, &paths[1], 1),
            self.leg(inputs, &paths[2], 2),
        ]
    }

    #[inline(always)]
    fn leg<'a, V: Real>(&self, inputs: &'a StrengthInputs<V>, path: &'a PathLanes<V>, index: usize) -> LegBasis<'a, V> {
        let leg = &inputs.legs[index];
        let like = leg.moment;
        let platform = path.bars[2].mass();
        let distal = path.bars[1].mass().and(platform);
        let proximal = path.bars[0].mass().and(distal);
        let from = [proximal, distal, platform, Beyond::nothing(like)];
        let twists = [
            self.paths[index].twist(path, 0),
            self.paths[index].twist(path, 1),
            self.paths[index].twist(path, 2),
        ];
        let reactions = V::inverse_transpose(&twists);
        let mut own = [like.splat(0.0); 3];
        let [is_loaded, _] = self.loads.weighs();
        if is_loaded {
            for joint in 0..LEGS {
                let beyond = self.beyond_joint(path, &from, index, joint);
                let power = dot(&twists[joint], &weight_in_plane(&self.loads, &beyond));
                own = less(&own, &scaled(&reactions[joint], power));
            }
        }
        LegBasis {
            path,
            from,
            u: leg.u,
            moment: leg.moment,
            transmission: leg.transmission,
            stiffness: &inputs.stiffness[index],
            reactions,
            own,
        }
    }

    /// Returns what lies beyond a joint, given what lies from each bar on.
    #[inline(always)]
    pub(super) fn beyond_joint<V: Real>(
        &self,
        path: &PathLanes<V>,
        from: &[Beyond<V>; BARS + 1],
        index: usize,
        joint: usize,
    ) -> Beyond<V> {
        let joint = &self.paths[index].joints[joint];
        if joint.is_bush {
            // The rod, and what it carries.
            path.bars[1].mass_of_piece(1).and(from[2])
        } else {
            from[joint.before]
        }
    }

    /// Returns the resultants at a place, relative to `P`, beyond which there is a mass; `lever` is the moment of the line about the place.
    #[inline(always)]
    pub(super) fn resultants<V: Real>(
        &self,
        leg: &LoadedLeg<'_, V>,
        (place, lever): (Planar<V>, V),
        beyond: &Beyond<V>,
    ) -> Resultants<V> {
        let [fx, fy, turn] = leg.own;
        let line = leg.line.value;
        let mut force = leg.u.scaled(line).plus(Planar::new(fx, fy));
        let mut about = line * lever + turn - (place.x * fy - place.y * fx);
        // The arm from the place to `P`, turned as a force along z turns it.
        let arm = place.perp();
        let [lift, tilt_x, tilt_y] = leg.out;
        let mut lift = lift;
        let mut moment = Planar::new(tilt_x, tilt_y).plus(arm.scaled(lift));
        if self.weighs() {
            let [x, y, turn] = weight_in_plane(&self.loads, beyond);
            force = force.plus(Planar::new(x, y));
            about = about + turn - (place.x * y - place.y * x);
            lift = lift + beyond.mass * beyond.mass.splat(self.loads.gravity[2]);
            moment = moment.plus(weight_moment(&self.loads, beyond, place));
        }
        Resultants {
            force,
            lift: Ranged {
                value: lift,
                range: self.loads.out_of_plane_range(&leg.share[0]),
            },
            moment,
            turn: Ranged {
                value: about,
                range: lever.abs() * leg.line.range,
            },
        }
    }
}

/// Returns the row of `A` of a leg.
#[inline(always)]
fn row<V: Real>(leg: &LegBasis<'_, V>) -> [V; 3] {
    [leg.u.x, leg.u.y, leg.moment]
}

impl<V: Real> LegBasis<'_, V> {
    /// Returns the moment of the line about a place.
    #[inline(always)]
    pub(super) fn lever(&self, place: Planar<V>) -> V {
        self.moment - place.cross(self.u)
    }
}

impl<V: Real> LoadedLeg<'_, V> {
    /// Returns the derivatives of the moment about an axis in the plane through a place by `f_z`, `m_x` and `m_y`.
    #[inline(always)]
    pub(super) fn moment_by(&self, place: Planar<V>, axis: Planar<V>) -> [V; 3] {
        let lever = axis.dot(place.perp());
        let [lift, x, y] = &self.share;
        [
            axis.x * x[0] + axis.y * y[0] + lever * lift[0],
            axis.x * x[1] + axis.y * y[1] + lever * lift[1],
            axis.x * x[2] + axis.y * y[2] + lever * lift[2],
        ]
    }
}

impl<V: Real> LoadedLegs<'_, V> {
    /// Returns 0 where all loads are finite numbers, and what is not a number elsewhere.
    #[inline(always)]
    pub(super) fn check(&self) -> V {
        let zero = self.bending[0].splat(0.0);
        let mut total = zero;
        for leg in &self.legs {
            let [fx, fy, turn] = leg.own;
            let [lift, x, y] = leg.out;
            total = total + leg.line.value + leg.line.range + fx + fy + turn + lift + x + y;
        }
        total * zero
    }
}
