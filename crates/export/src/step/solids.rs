//! Solids as prisms with exact faces.

use glam::{DVec2, DVec3};

use super::MM;
use super::records::{File, Placement, list, real, truth};
use kinefront_model::spatial::unit;
use kinefront_scene::SolidShape;

/// An outline across the axis of a prism \[mm\].
enum Profile {
    Circle(f64),
    /// Corners, counter-clockwise about the axis.
    Polygon(Vec<DVec2>),
}

/// A prism with a profile, and perhaps a bore with a profile of the same kind.
struct Prism {
    place: Placement,
    length: f64,
    outer: Profile,
    bore: Option<Profile>,
}

impl Prism {
    fn of(shape: &SolidShape) -> Self {
        match *shape {
            SolidShape::Bar {
                from,
                to,
                radius,
                inner,
            } => {
                let axis = (to - from).normalize();
                // Bars lie in the plane of motion, pins are along z.
                let is_in_plane = axis.truncate().length() > 0.5;
                let across = if is_in_plane { DVec3::Z } else { DVec3::X };
                Self {
                    place: Placement::at(from * MM, axis, across),
                    length: from.distance(to) * MM,
                    outer: Profile::Circle(radius * MM),
                    bore: (inner > 0.0).then_some(Profile::Circle(inner * MM)),
                }
            }
            SolidShape::Block {
                centre,
                half_size,
                angle,
                inner,
            } => {
                let axis = unit(angle).extend(0.0);
                let rectangle = |x: f64, y: f64| {
                    let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                    Profile::Polygon(signs.map(|(sx, sy)| DVec2::new(sx * x, sy * y) * MM).to_vec())
                };
                Self {
                    // The x axis of the profile is z, so that its y axis is across the block.
                    place: Placement::at((centre - axis * half_size.x) * MM, axis, DVec3::Z),
                    length: 2.0 * half_size.x * MM,
                    outer: rectangle(half_size.z, half_size.y),
                    bore: (inner > 0.0).then(|| rectangle(inner, inner)),
                }
            }
        }
    }
}

/// An edge with the direction in which a face uses it.
type Use = (usize, bool);

/// Edges of a profile at both ends of a prism, and along it.
struct Outline {
    first: Vec<usize>,
    last: Vec<usize>,
    along: Vec<usize>,
}

impl File {
    fn vertex(&mut self, at: DVec3) -> usize {
        let point = self.point(at);
        self.add(format!("VERTEX_POINT('',#{point})"))
    }

    fn straight(&mut self, [from, to]: [DVec3; 2], [first, last]: [usize; 2]) -> usize {
        let along = self.direction((to - from).normalize());
        let vector = self.add(format!("VECTOR('',#{along},1.)"));
        let point = self.point(from);
        let line = self.add(format!("LINE('',#{point},#{vector})"));
        self.add(format!("EDGE_CURVE('',#{first},#{last},#{line},.T.)"))
    }

    fn circle(&mut self, place: &Placement, radius: f64, vertex: usize) -> usize {
        let at = self.placement(place);
        let circle = self.add(format!("CIRCLE('',#{at},{})", real(radius)));
        self.add(format!("EDGE_CURVE('',#{vertex},#{vertex},#{circle},.T.)"))
    }

    /// Adds a face with an outer loop, perhaps an inner one, and a surface whose normal points out of the solid if `is_outward`.
    fn face(&mut self, loops: &[Vec<Use>], surface: usize, is_outward: bool) -> usize {
        let mut bounds = Vec::new();
        for (place, uses) in loops.iter().enumerate() {
            let edges: Vec<usize> = uses
                .iter()
                .map(|(edge, forward)| self.add(format!("ORIENTED_EDGE('',*,*,#{edge},{})", truth(*forward))))
                .collect();
            let edges = self.add(format!("EDGE_LOOP('',({}))", list(&edges)));
            let kind = if place == 0 { "FACE_OUTER_BOUND" } else { "FACE_BOUND" };
            bounds.push(self.add(format!("{kind}('',#{edges},.T.)")));
        }
        self.add(format!(
            "ADVANCED_FACE('',({}),#{surface},{})",
            list(&bounds),
            truth(is_outward)
        ))
    }

    /// Adds the edges of a profile at both ends of a prism and along it.
    fn outline(&mut self, prism: &Prism, profile: &Profile) -> Outline {
        let place = &prism.place;
        let corners = match profile {
            Profile::Circle(radius) => vec![DVec2::new(*radius, 0.0)],
            Profile::Polygon(corners) => corners.clone(),
        };
        let count = corners.len();
        let ends = [0.0, prism.length];
        let vertices = ends.map(|along| -> Vec<usize> {
            corners
                .iter()
                .map(|corner| self.vertex(place.point(*corner, along)))
                .collect()
        });
        let [first, last] = [0, 1].map(|end| -> Vec<usize> {
            (0..count)
                .map(|k| match profile {
                    Profile::Circle(radius) => {
                        let origin = place.point(DVec2::ZERO, ends[end]);
                        self.circle(&Placement { origin, ..*place }, *radius, vertices[end][0])
                    }
                    Profile::Polygon(corners) => {
                        let next = (k + 1) % count;
                        let points = [k, next].map(|corner| place.point(corners[corner], ends[end]));
                        self.straight(points, [vertices[end][k], vertices[end][next]])
                    }
                })
                .collect()
        });
        let along = (0..count)
            .map(|k| {
                let points = ends.map(|along| place.point(corners[k], along));
                self.straight(points, [vertices[0][k], vertices[1][k]])
            })
            .collect();
        Outline { first, last, along }
    }

    /// Adds the faces along a profile: those of a bore face inwards.
    fn sides(&mut self, prism: &Prism, profile: &Profile, outline: &Outline, is_bore: bool) -> Vec<usize> {
        let count = outline.first.len();
        let mut faces = Vec::new();
        for k in 0..count {
            let next = (k + 1) % count;
            let (first, last) = (outline.first[k], outline.last[k]);
            let (here, there) = (outline.along[k], outline.along[next]);
            let uses = if is_bore {
                vec![(first, false), (here, true), (last, true), (there, false)]
            } else {
                vec![(first, true), (there, true), (last, false), (here, false)]
            };
            let (surface, is_outward) = match profile {
                Profile::Circle(radius) => {
                    let at = self.placement(&prism.place);
                    let surface = self.add(format!("CYLINDRICAL_SURFACE('',#{at},{})", real(*radius)));
                    (surface, !is_bore)
                }
                Profile::Polygon(corners) => {
                    let [a, b] = [k, next].map(|corner| prism.place.point(corners[corner], 0.0));
                    let along = (b - a).normalize();
                    let outwards = along.cross(prism.place.z);
                    let normal = if is_bore { -outwards } else { outwards };
                    let at = self.placement(&Placement::at(a, normal, along));
                    (self.add(format!("PLANE('',#{at})")), true)
                }
            };
            faces.push(self.face(&[uses], surface, is_outward));
        }
        faces
    }

    /// Adds the closed shell of a solid.
    pub(super) fn shell(&mut self, shape: &SolidShape) -> usize {
        let prism = &Prism::of(shape);
        let outer = self.outline(prism, &prism.outer);
        let mut faces = self.sides(prism, &prism.outer, &outer, false);
        let forwards = |edges: &[usize]| -> Vec<Use> { edges.iter().map(|edge| (*edge, true)).collect() };
        let backwards = |edges: &[usize]| -> Vec<Use> { edges.iter().rev().map(|edge| (*edge, false)).collect() };
        let (mut first, mut last) = (vec![backwards(&outer.first)], vec![forwards(&outer.last)]);
        if let Some(profile) = &prism.bore {
            let bore = self.outline(prism, profile);
            faces.extend(self.sides(prism, profile, &bore, true));
            first.push(forwards(&bore.first));
            last.push(backwards(&bore.last));
        }
        for (loops, along, sign) in [(first, 0.0, -1.0), (last, prism.length, 1.0)] {
            let origin = prism.place.point(DVec2::ZERO, along);
            let at = self.placement(&Placement {
                origin,
                z: prism.place.z * sign,
                ..prism.place
            });
            let surface = self.add(format!("PLANE('',#{at})"));
            faces.push(self.face(&loops, surface, true));
        }
        self.add(format!("CLOSED_SHELL('',({}))", list(&faces)))
    }
}
