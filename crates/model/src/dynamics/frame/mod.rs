//! Natural frequencies of the manipulator as a frame of finite elements (docs/model.md, section 15.4).
//!
//! The condensed mass lets each bar bend as its ends make it. Here each bar is divided into elements, so that it bends between its ends as
//! its own mass makes it. The coordinates of a leg are those of the platform, the rates of its joints, and the motions of the ends of
//! its elements.

mod element;
mod vibration;

use nalgebra::DMatrix;

use element::{Body, Displacement, Element, ElementEnd, add_mass};
use vibration::Frame;

use super::DynamicsModel;
use super::legs::{DynamicsInputs, MovingLeg};
use super::modes::distance_of_joint;
use crate::lanes::Planar;
use crate::spatial::LEGS;
use crate::strength::bars::BarLanes;
use crate::strength::path::{BARS, DISTAL, PLATFORM};

/// Number of elements into which each bar, and each end of a guide beyond its carriage, is divided.
const ELEMENTS: usize = 3;

/// Length as a fraction of the length of the leg, below which a stretch of a bar is one rigid element: its stiffness would exceed that of
/// all others by so much that rounding decides.
const RIGID: f64 = 1e-3;

/// Number of coordinates of the platform, which come first.
const OF_PLATFORM: usize = 3;

/// The plane of a vibration.
#[derive(Clone, Copy, PartialEq)]
enum Plane {
    /// `x`, `y`, `φz`.
    In,
    /// `z`, `φx`, `φy`.
    Out,
}

/// The elements of a bar, in the order of their distance from its end at the base.
struct ElementBar {
    elements: Vec<Element>,
    /// Displacements along the bar of the bodies at its ends.
    along: [Displacement; 2],
}

/// A leg in a vibration: its coordinates follow those of the platform.
struct FrameLeg {
    plane: Plane,
    coordinates: usize,
    bars: [Option<ElementBar>; BARS],
    /// Displacements that a mass or an inertia opposes.
    points: Vec<(Displacement, f64)>,
    /// The coordinate of the actuated joint.
    driven: Option<usize>,
}

impl FrameLeg {
    fn new_coordinates(&mut self, count: usize) -> usize {
        self.coordinates += count;
        self.coordinates - count
    }

    /// Divides a bar from a body to another one into elements, from the distances `from` to `to` along the bar between them, and with what
    /// extends beyond.
    fn divide(
        &mut self,
        bar: &BarLanes<f64>,
        [base, tip]: [&Body; 2],
        [from, to]: [f64; 2],
        shortest: f64,
    ) -> Vec<Element> {
        let pieces = || bar.pieces.iter().filter(|piece| piece.density > 0.0);
        let first = pieces().fold(from, |least, piece| piece.from.min(least));
        let last = pieces().fold(to, |most, piece| piece.to.max(most));
        let mut elements = Vec::new();
        let mut begin = (first, self.free_end(from - first, shortest, base));
        for (end, body) in [
            (from, base),
            (to, tip),
            (last, &self.free_end(last - to, shortest, tip)),
        ] {
            let start = begin.0;
            let length = end - start;
            let is_rigid = length < shortest;
            let count = if is_rigid { 1 } else { ELEMENTS };
            for place in 1..=count {
                let at = start + length * place as f64 / count as f64;
                let next = if place == count {
                    (end, body.clone())
                } else {
                    (at, Body::of_coordinates(self.new_coordinates(3)))
                };
                let ends = [&begin, &next].map(|(at, body)| ElementEnd::new(self.plane, bar, body, *at));
                elements.push(Element { ends, is_rigid });
                begin = next;
            }
        }
        elements
    }

    /// Returns the body at the end of a stretch beyond a body that holds it.
    fn free_end(&mut self, length: f64, shortest: f64, held: &Body) -> Body {
        if length < shortest {
            held.clone()
        } else {
            Body::of_coordinates(self.new_coordinates(3))
        }
    }
}

impl DynamicsModel {
    /// Returns the lowest natural frequencies of the frame of finite elements, in the plane and out of it \[Hz\]; `None` on rails that bend,
    /// and at a singular pose.
    pub fn frame_frequencies(&self, inputs: &DynamicsInputs<f64>) -> Option<[f64; 2]> {
        if self.is_on_bending_rails {
            return None;
        }
        let legs = self.legs(inputs);
        let payload = &self.settings.payload;
        let centre = self.payload_centre(inputs);
        let platform = Body::of_coordinates(0);
        let mut of_plane = [None; 2];
        for (found, plane) in of_plane.iter_mut().zip([Plane::In, Plane::Out]) {
            let mut mass = DMatrix::zeros(OF_PLATFORM, OF_PLATFORM);
            match plane {
                Plane::In => {
                    for direction in [Planar::new(1.0, 0.0), Planar::new(0.0, 1.0)] {
                        platform
                            .in_direction(direction, centre)
                            .add_square(&mut mass, payload.mass);
                    }
                    platform.0[2].add_square(&mut mass, payload.inertia);
                }
                Plane::Out => {
                    platform.lift(centre).add_square(&mut mass, payload.mass);
                    for turn in &platform.0[1..] {
                        turn.add_square(&mut mass, 0.5 * payload.inertia);
                    }
                }
            }
            let mut frame = Frame::new(mass.fixed_view::<3, 3>(0, 0).into_owned());
            for leg in &legs {
                frame.add(self.frame_leg(plane, leg))?;
            }
            *found = frame.lowest_frequency();
        }
        let [in_plane, out_of_plane] = of_plane;
        Some([in_plane?, out_of_plane?])
    }

    /// Returns the stiffness and the mass of a leg in its coordinates.
    fn frame_leg(&self, plane: Plane, leg: &MovingLeg<f64>) -> [DMatrix<f64>; 2] {
        let frame = self.elements_of(plane, leg);
        let count = frame.coordinates;
        let (mut stiffness, mut mass) = (DMatrix::zeros(count, count), DMatrix::zeros(count, count));
        if let Some(driven) = frame.driven {
            let rate = Displacement::of_coordinate(driven);
            rate.add_square(&mut stiffness, 1.0 / self.actuator_compliance);
            rate.add_square(&mut mass, self.settings.drives.of(self.actuator));
        }
        for (place, bar) in frame.bars.iter().enumerate() {
            let Some(bar) = bar else { continue };
            let compliance = self.compliance(place);
            let along = match plane {
                Plane::In => compliance.axial,
                Plane::Out => compliance.torsion,
            };
            for element in &bar.elements {
                element.add_stiffness(&mut stiffness, compliance.bending, along);
            }
            for (end, piece) in leg.path.bars[place].pieces.iter().enumerate() {
                // The tube of a telescopic leg moves along it with the base, and the rod with the platform.
                let own = match plane {
                    Plane::In if self.is_telescopic(place) => Some(&bar.along[end]),
                    _ => None,
                };
                for element in &bar.elements {
                    add_mass(&mut mass, plane, element, piece, self.gyration(place), own);
                }
            }
        }
        for (displacement, of_point) in &frame.points {
            displacement.add_square(&mut mass, *of_point);
        }
        [stiffness, mass]
    }

    /// Divides the bars of a leg into elements.
    fn elements_of(&self, plane: Plane, leg: &MovingLeg<f64>) -> FrameLeg {
        let mut frame = FrameLeg {
            plane,
            coordinates: OF_PLATFORM,
            bars: [const { None }; BARS],
            points: Vec::new(),
            driven: None,
        };
        let path = &self.paths[0];
        let size: f64 = leg.path.bars[path.first..].iter().map(|bar| bar.length).sum();
        let mut body = Body::default();
        let mut joint = 0;
        for place in path.first..BARS {
            let bar = &leg.path.bars[place];
            let held = body.clone();
            while plane == Plane::In && joint < LEGS && path.joints[joint].before <= place {
                let coordinate = frame.new_coordinates(1);
                if joint == self.driven {
                    frame.driven = Some(coordinate);
                }
                let before = body.clone();
                body = body.with_twist(&leg.twists[joint], coordinate);
                self.add_points_of_joint(&mut frame, leg, joint, [&before, &body]);
                joint += 1;
            }
            let (length, shortest) = (self.elastic_length(place, bar.length), RIGID * size);
            let tip = match place {
                PLATFORM => Body::of_coordinates(0),
                _ if length < shortest => body.clone(),
                _ => Body::of_coordinates(frame.new_coordinates(3)),
            };
            let elements = frame.divide(bar, [&body, &tip], [bar.length - length, bar.length], shortest);
            if plane == Plane::Out {
                self.add_points_of_bar(&mut frame, leg, place, &elements);
            }
            let along =
                [(&held, 0.0), (&tip, bar.length)].map(|(body, at)| ElementEnd::new(plane, bar, body, at).along);
            frame.bars[place] = Some(ElementBar { elements, along });
            body = tip;
        }
        frame
    }

    /// Returns the length of a bar in the beam model, which ends at the tip of the bar \[m\].
    fn elastic_length(&self, place: usize, length: f64) -> f64 {
        self.telescopic_beam.filter(|_| place == DISTAL).unwrap_or(length)
    }

    /// Adds the point masses at a joint, before and behind which the leg moves as given.
    fn add_points_of_joint(&self, frame: &mut FrameLeg, leg: &MovingLeg<f64>, joint: usize, sides: [&Body; 2]) {
        for point in self.points.iter().flatten().filter(|point| point.joint == joint) {
            for direction in [Planar::new(1.0, 0.0), Planar::new(0.0, 1.0)] {
                let moved = sides[point.body - joint].in_direction(direction, leg.path.joints[joint]);
                frame.points.push((moved, point.mass));
            }
        }
    }

    /// Adds the point masses at the joints before a bar, which move out of the plane with the bar.
    fn add_points_of_bar(&self, frame: &mut FrameLeg, leg: &MovingLeg<f64>, place: usize, elements: &[Element]) {
        let bar = &leg.path.bars[place];
        for point in self.points.iter().flatten() {
            let joint = &self.paths[0].joints[point.joint];
            if joint.before != place {
                continue;
            }
            let distance = distance_of_joint(leg, joint, point.joint, bar);
            let found = elements.iter().find(|element| distance <= element.ends[1].at);
            if let Some(element) = found.or(elements.last()) {
                let [lift, _] = element.at(distance);
                frame.points.push((lift, point.mass));
            }
        }
    }
}
