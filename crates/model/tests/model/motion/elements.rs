//! Natural frequencies of the frame: those of its finite elements in space, and those of its condensed mass.

use glam::DVec2;
use kinefront_model::dynamics::Payload;
use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{Architecture, BarLength, LegPosture};
use kinefront_model::spatial::{Pose, Rotation};
use kinefront_model::stiffness::RailSupports;
use nalgebra::{DMatrix, DVector, Matrix6, Matrix6xX};

use super::frame::{AXES, FrameBar, about_p, joint_twist};
use super::{DRIVES, PAYLOAD, Subject, for_all};
use crate::strategies::{self, parsed, round_rails};

/// How the ends of an element move, as twists at `P` for a unit of each coordinate.
struct FrameElement<'a> {
    bar: &'a FrameBar,
    from: f64,
    to: f64,
    base: Matrix6xX<f64>,
    tip: Matrix6xX<f64>,
}

/// Returns the displacement of a place in a direction, or the rotation about it, as a row over all coordinates.
fn row_of(twist: &Matrix6xX<f64>, at: DVec2, direction: [f64; 3], rotation: bool) -> DVector<f64> {
    let lever = [DVec2::new(0.0, 0.0), at][usize::from(!rotation)];
    let offset = if rotation { 3 } else { 0 };
    let mut row = DVector::zeros(twist.ncols());
    for (k, part) in direction.into_iter().enumerate() {
        row += twist.row(offset + k).transpose() * part;
    }
    if !rotation {
        let [x, y, z] = direction;
        row += twist.row(5).transpose() * (y * lever.x - x * lever.y);
        row += (twist.row(3) * lever.y - twist.row(4) * lever.x).transpose() * z;
    }
    row
}

impl FrameElement<'_> {
    /// Displacements and rotations of an end in the axes of the bar, and those that deform the element.
    fn local(&self, twist: &Matrix6xX<f64>, at: f64) -> [DVector<f64>; 6] {
        let (place, axes) = (self.bar.base + self.bar.axis * at, self.bar.axes());
        std::array::from_fn(|k| row_of(twist, place, axes[k % 3], k >= 3))
    }

    fn add(&self, stiffness: &mut DMatrix<f64>, mass: &mut DMatrix<f64>, own: &[Option<DVector<f64>>]) {
        /// Gauss's rule with five points.
        const RULE: [[f64; 2]; 5] = [
            [-0.906_179_845_938_664, 0.236_926_885_056_189_08],
            [-0.538_469_310_105_683, 0.478_628_670_499_366_47],
            [0.0, 0.568_888_888_888_888_9],
            [0.538_469_310_105_683, 0.478_628_670_499_366_47],
            [0.906_179_845_938_664, 0.236_926_885_056_189_08],
        ];
        let length = self.to - self.from;
        let (rigid, tip) = (self.local(&self.base, self.to), self.local(&self.tip, self.to));
        let strain: Vec<DVector<f64>> = tip.iter().zip(&rigid).map(|(tip, rigid)| tip - rigid).collect();
        let elastic = self.bar.compliance.matrix(length).try_inverse().expect("stiff");
        for i in 0..6 {
            for k in 0..6 {
                if elastic[(i, k)] != 0.0 {
                    *stiffness += &strain[i] * strain[k].transpose() * elastic[(i, k)];
                }
            }
        }
        for (piece, &(from, to, density)) in self.bar.pieces.iter().enumerate() {
            let (from, to) = (from.max(self.from), to.min(self.to));
            if to <= from {
                continue;
            }
            for [abscissa, weight] in RULE {
                let x = 0.5 * (from + to) + 0.5 * (to - from) * abscissa;
                let of_place = 0.5 * (to - from) * weight * density;
                let s = (x - self.from) / length;
                let [along, across, up, about, pitch, turn] = self.local(&self.base, x);
                let (value, slope) = (s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / length);
                let (of_turn, slope_of_turn) = (length * s * s * (s - 1.0), s * (3.0 * s - 2.0));
                let rows = [
                    (own[piece].clone().unwrap_or_else(|| along + &strain[0] * s), of_place),
                    (across + &strain[1] * value + &strain[5] * of_turn, of_place),
                    (up + &strain[2] * value - &strain[4] * of_turn, of_place),
                    (about + &strain[3] * s, 2.0 * of_place * self.bar.gyration),
                    (
                        pitch - &strain[2] * slope + &strain[4] * slope_of_turn,
                        of_place * self.bar.gyration,
                    ),
                    (
                        turn + &strain[1] * slope + &strain[5] * slope_of_turn,
                        of_place * self.bar.gyration,
                    ),
                ];
                for (row, by) in rows {
                    *mass += &row * row.transpose() * by;
                }
            }
        }
    }
}

/// The frame of all elements: its stiffness and its mass over the coordinates of the platform, and then those of each leg, of its joints
/// and of the ends of its elements.
struct Elements {
    stiffness: DMatrix<f64>,
    mass: DMatrix<f64>,
    /// Number of coordinates that are used.
    used: usize,
    /// Number of elements of a bar.
    count: usize,
}

impl Elements {
    /// Returns the first of some coordinates that are not used yet.
    fn free(&mut self, columns: usize) -> usize {
        self.used += columns;
        self.used - columns
    }

    /// Returns how a body moves whose twist is six coordinates.
    fn unit(&self, first: usize) -> Matrix6xX<f64> {
        let mut twist = Matrix6xX::zeros(self.mass.ncols());
        twist.view_mut((0, first), (6, 6)).copy_from(&Matrix6::identity());
        twist
    }

    fn free_end(&mut self) -> Matrix6xX<f64> {
        let first = self.free(6);
        self.unit(first)
    }

    /// Adds a mass at a point of a body.
    fn add_point(&mut self, body: &Matrix6xX<f64>, at: DVec2, mass: f64) {
        for axis in AXES {
            let row = row_of(body, at, axis, false);
            self.mass += &row * row.transpose() * mass;
        }
    }

    /// Adds the joints and the bars of a leg. Returns the coordinate of its actuator.
    fn add_leg(&mut self, architecture: Architecture, leg: &LegPosture, bars: &[FrameBar]) -> usize {
        let chain = architecture.chain();
        let mut driven = None;
        let mut body = Matrix6xX::zeros(self.mass.ncols());
        let mut joint = 0;
        let first = 3 - bars.len();
        for (place, bar) in bars.iter().enumerate() {
            let held = body.clone();
            while joint < 3 && chain.points[joint] as usize <= place + first {
                let coordinate = self.free(1);
                let mut column = body.column_mut(coordinate);
                column += joint_twist(leg, chain, joint);
                if joint == architecture.driven() {
                    driven = Some(coordinate);
                }
                if joint == 0 && chain.is_on_rails() {
                    self.add_point(&body, about_p(leg, leg.chain.b), DRIVES.slider_mass);
                }
                joint += 1;
            }
            let tip = if place + 1 == bars.len() {
                self.unit(0)
            } else {
                self.free_end()
            };
            self.add_bar(bar, &held, &body, &tip);
            body = tip;
        }
        driven.expect("a driven joint")
    }

    /// Adds the elements of a bar from a body to its tip, and of what goes on beyond its ends. The tube of a telescopic leg moves along it
    /// as what holds the leg does.
    fn add_bar(&mut self, bar: &FrameBar, held: &Matrix6xX<f64>, body: &Matrix6xX<f64>, tip: &Matrix6xX<f64>) {
        let count = self.count;
        let along = |twist: &Matrix6xX<f64>, at: f64| row_of(twist, bar.base + bar.axis * at, bar.axes()[0], false);
        let own = match bar.is_telescopic {
            true => vec![Some(along(held, 0.0)), Some(along(tip, bar.length))],
            false => vec![None; bar.pieces.len()],
        };
        let first = bar.pieces.iter().fold(0.0, |least: f64, piece| piece.0.min(least));
        let last = bar.pieces.iter().fold(bar.length, |most: f64, piece| piece.1.max(most));
        for (from, to, base, tip) in [
            (first, 0.0, None, Some(body)),
            (0.0, bar.length, Some(body), Some(tip)),
            (bar.length, last, Some(tip), None),
        ] {
            if to - from < 1e-9 {
                continue;
            }
            let mut ends = vec![base.cloned().unwrap_or_else(|| self.free_end())];
            ends.extend((1..count).map(|_| self.free_end()));
            ends.push(tip.cloned().unwrap_or_else(|| self.free_end()));
            for (k, pair) in ends.windows(2).enumerate() {
                let at = |k: usize| from + (to - from) * k as f64 / count as f64;
                let element = FrameElement {
                    bar,
                    from: at(k),
                    to: at(k + 1),
                    base: pair[0].clone(),
                    tip: pair[1].clone(),
                };
                element.add(&mut self.stiffness, &mut self.mass, &own);
            }
        }
    }

    /// Returns the twelve lowest natural frequencies in increasing order.
    fn frequencies(&self) -> Vec<f64> {
        let [stiffness, mass] =
            [&self.stiffness, &self.mass].map(|matrix| matrix.view((0, 0), (self.used, self.used)).into_owned());
        let factor = stiffness.cholesky().expect("no mechanism").l();
        let half = factor.solve_lower_triangular(&mass).expect("regular");
        let compliance = factor.solve_lower_triangular(&half.transpose()).expect("regular");
        let compliance = (&compliance + compliance.transpose()) * 0.5;
        let mut found: Vec<f64> = compliance.symmetric_eigenvalues().iter().copied().collect();
        found.sort_by(|a, b| b.total_cmp(a));
        found.truncate(12);
        let tau = 2.0 * std::f64::consts::PI;
        found.into_iter().map(|value| 1.0 / (value.sqrt() * tau)).collect()
    }
}

/// Returns natural frequencies of the whole frame in space, with all bars divided into so many elements.
fn frequencies_of_elements(subject: &Subject, count: usize) -> Vec<f64> {
    let posture = subject.manipulator.posture(&subject.pose).expect("reached");
    let bars: Vec<Vec<FrameBar>> = posture.legs.iter().map(|leg| subject.frame_bars(leg)).collect();
    let stretches = |bar: &FrameBar| {
        let before = bar.pieces.iter().any(|piece| piece.0 < 0.0);
        let beyond = bar.pieces.iter().any(|piece| piece.1 > bar.length);
        1 + usize::from(before) + usize::from(beyond)
    };
    let stretches: usize = bars.iter().flatten().map(stretches).sum();
    let total = 6 + 3 * 3 + 6 * count * stretches;
    let mut elements = Elements {
        stiffness: DMatrix::zeros(total, total),
        mass: DMatrix::zeros(total, total),
        used: 6,
        count,
    };
    let architecture = subject.design.architecture();
    let legs = posture.legs.iter().zip(&bars);
    let driven: Vec<usize> = legs
        .map(|(leg, bars)| elements.add_leg(architecture, leg, bars))
        .collect();
    let actuator = subject.model.settings().actuators.of(architecture.actuator());
    for coordinate in driven {
        elements.stiffness[(coordinate, coordinate)] += actuator;
        elements.mass[(coordinate, coordinate)] += DRIVES.of(architecture.actuator());
    }
    let centre = Rotation::new(subject.pose.phi).apply(PAYLOAD.centre.into());
    elements.add_point(&elements.unit(0), centre, PAYLOAD.mass);
    for (k, share) in [(3, 0.5), (4, 0.5), (5, 1.0)] {
        elements.mass[(k, k)] += share * PAYLOAD.inertia;
    }
    elements.frequencies()
}

#[test]
fn the_frequencies_of_the_frame_are_those_of_its_elements() {
    let mut seen = std::collections::BTreeSet::new();
    for_all([0.0; 3], |subject| {
        if !seen.insert(subject.design.architecture().name()) {
            return;
        }
        let posed = subject.model.posed(&subject.design);
        let dynamics = posed.dynamics_at(&subject.pose).expect("reached").expect("stiff");
        let found = dynamics.frame_frequencies().expect("regular");
        let wanted = frequencies_of_elements(subject, 3);
        let lowest = found[0].min(found[1]);
        for (plane, found) in found.iter().enumerate() {
            let is_wanted = wanted.iter().any(|wanted| (found / wanted - 1.0).abs() < 1e-5);
            assert!(
                is_wanted,
                "{} plane {plane}: {found} Hz is none of {wanted:?}",
                subject.design
            );
        }
        assert!((lowest / wanted[0] - 1.0).abs() < 1e-5, "{}", subject.design);
        // More elements change next to nothing.
        if seen.len() <= 4 {
            let finer = frequencies_of_elements(subject, 5)[0];
            assert!((lowest / finer - 1.0).abs() < 1e-3, "{}: {finer} Hz", subject.design);
        }
    });
    assert_eq!(seen.len(), Architecture::ALL.len());
}

/// Returns the lowest frequencies in the plane and out of it, of the condensed mass and of the frame.
fn lowest_of_both(model: &Model, subject: &Subject) -> [[f64; 2]; 2] {
    let posed = model.posed(&subject.design);
    let dynamics = posed.dynamics_at(&subject.pose).expect("reached").expect("stiff");
    let [in_plane, out_of_plane] = dynamics.report().expect("regular").frequencies.expect("rigid rails");
    let frame = dynamics.frame_frequencies().expect("regular");
    [[in_plane[0], out_of_plane[0]], frame]
}

#[test]
fn the_frequencies_of_the_frame_are_below_those_of_its_condensed_mass() {
    let mut ratios = Vec::new();
    for_all([0.0; 3], |subject| {
        let [condensed, frame] = lowest_of_both(&subject.model, subject);
        for (condensed, frame) in condensed.iter().zip(frame) {
            let ratio = condensed / frame;
            assert!(ratio > 1.0 - 1e-9, "{}: {ratio}", subject.design);
            ratios.push(ratio);
        }
        // Beside a heavy payload the bars weigh nothing, and both are what their stiffness makes them.
        for telescopic_bar in [BarLength::Current, BarLength::Longest] {
            let mut settings = subject.model.settings().clone();
            settings.legs.telescopic_bar = telescopic_bar;
            settings.dynamics.payload = Payload {
                mass: 1e10,
                inertia: 1e10,
                ..PAYLOAD
            };
            let model = Model::new(settings).expect("a model");
            let [condensed, frame] = lowest_of_both(&model, subject);
            for (condensed, frame) in condensed.iter().zip(frame) {
                let ratio = condensed / frame;
                assert!((ratio - 1.0).abs() < 1e-5, "{}: {ratio}", subject.design);
            }
        }
    });
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    // What docs/model.md says of them.
    assert!((median - 1.009).abs() < 5e-4, "{median}");
    let above = ratios.iter().filter(|ratio| **ratio > 1.1).count() as f64 / ratios.len() as f64;
    assert!((above - 0.21).abs() < 5e-3, "{above}");
    assert!(ratios[ratios.len() - 1] < 2.45, "{ratios:?}");
}

#[test]
fn rails_that_bend_have_no_frequencies_of_a_frame() {
    let design = parsed("3-PRR R=3 r=1.2 Lb=1.8 rj=0.03 rp=0.05");
    let model = strategies::model(|model| model.rails = round_rails(0.05, RailSupports::Pinned));
    let posed = model.posed(&design);
    let dynamics = posed
        .dynamics_at(&Pose::new(0.0, 0.0, 0.6))
        .expect("reached")
        .expect("stiff");
    assert_eq!(dynamics.frame_frequencies(), None);
    assert_eq!(dynamics.report().expect("regular").frequencies, None);
}
