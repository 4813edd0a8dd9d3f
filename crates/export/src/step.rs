//! STEP (AP242): an assembly with one product for the base and for each rigid body, as exact solids with planes and cylinders.
//!
//! Every solid of a scene is a prism: a profile, round or square, perhaps with a bore, along an axis. The writer is our own: the format
//! is a list of numbered records, of which this needs few, and the libraries known turn cylinders into splines.

use std::fmt::Write as _;

use glam::{DVec2, DVec3};

use super::format::{AnyError, Format};
use super::prepared::Prepared;
use kinefront_model::spatial::unit;
use kinefront_scene::{Part, Solid, SolidShape, palette};

pub(super) const FORMAT: Format = Format {
    key: "step",
    file: "design.step",
    name: "STEP",
    title: "STEP, for CAD",
    lost: Some("joints, masses and actuators; the bodies stand where they are at the exported pose"),
    is_text: true,
    needs_bars: false,
    joints_from_zero: false,
    write,
};

/// Millimetres per metre.
const MM: f64 = 1e3;

/// Distance below which a reader may take two points for one \[mm\].
const ACCURACY: f64 = 1e-6;

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let mut file = File::default();
    let frame = file.product_frame();
    let assembly = file.product(&frame, &subject.identifier());
    let mut items = vec![assembly.origin];
    let mut components = Vec::new();
    let base = (
        "base",
        Placement::at(DVec3::ZERO, DVec3::Z, DVec3::X),
        &subject.base[..],
    );
    let bodies = subject.linkage.bodies.iter().map(|body| {
        let axis = unit(body.frame.angle).extend(0.0);
        let origin = body.frame.origin.extend(0.0) * MM;
        (
            body.name.as_str(),
            Placement::at(origin, DVec3::Z, axis),
            &body.solids[..],
        )
    });
    for (name, place, solids) in std::iter::once(base).chain(bodies) {
        let solids: Vec<&Solid> = solids.iter().filter(|solid| solid.shape.has_volume()).collect();
        if solids.is_empty() {
            continue;
        }
        let product = file.product(&frame, name);
        let shape = file.body(&product, name, &solids);
        let at = file.placement(&place);
        items.push(at);
        components.push((name, product, shape, at));
    }
    let whole = file.add(format!(
        "SHAPE_REPRESENTATION('',({}),#{})",
        list(&items),
        assembly.context
    ));
    file.define(&assembly, whole);
    for (name, product, shape, at) in components {
        file.place(&assembly, whole, (name, &product, shape, at));
    }
    let words = format!(
        "{}\nWritten by Kinefront {}. Lengths in mm; base frame, z out of the plane of motion.\nNot in this file: {}.",
        subject.title(),
        env!("CARGO_PKG_VERSION"),
        FORMAT.lost.unwrap_or_default()
    );
    Ok(file.document(&words, &subject.identifier()).into_bytes())
}

/// A right-handed frame: its origin \[mm\], its z axis and its x axis.
#[derive(Clone, Copy)]
struct Placement {
    origin: DVec3,
    z: DVec3,
    x: DVec3,
}

impl Placement {
    fn at(origin: DVec3, z: DVec3, x: DVec3) -> Self {
        Self { origin, z, x }
    }

    /// Returns the point at coordinates across the z axis.
    fn point(&self, at: DVec2, along: f64) -> DVec3 {
        self.origin + self.x * at.x + self.z.cross(self.x) * at.y + self.z * along
    }
}

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
                let across = if axis.truncate().length() > 0.5 {
                    DVec3::Z
                } else {
                    DVec3::X
                };
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
                    let corner = |sx: f64, sy: f64| DVec2::new(sx * x, sy * y) * MM;
                    Profile::Polygon(vec![
                        corner(-1.0, -1.0),
                        corner(1.0, -1.0),
                        corner(1.0, 1.0),
                        corner(-1.0, 1.0),
                    ])
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

/// What a product is defined by.
struct Product {
    definition: usize,
    shape: usize,
    context: usize,
    origin: usize,
}

/// What all products share.
struct ProductFrame {
    product_context: usize,
    definition_context: usize,
    units: [usize; 3],
    accuracy: usize,
}

/// An edge with the direction in which a face uses it.
type Use = (usize, bool);

/// Edges of a profile at both ends of a prism, and along it.
struct Outline {
    first: Vec<usize>,
    last: Vec<usize>,
    along: Vec<usize>,
}

/// The records so far; a record is named by its number.
#[derive(Default)]
struct File {
    records: Vec<String>,
}

impl File {
    fn add(&mut self, record: impl Into<String>) -> usize {
        self.records.push(record.into());
        self.records.len()
    }

    fn product_frame(&mut self) -> ProductFrame {
        let application = self.add("APPLICATION_CONTEXT('managed model based 3d engineering')");
        self.add(format!(
            "APPLICATION_PROTOCOL_DEFINITION('international standard','ap242_managed_model_based_3d_engineering',2020,#{application})"
        ));
        let length = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        let solid_angle = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        ProductFrame {
            product_context: self.add(format!("PRODUCT_CONTEXT('',#{application},'mechanical')")),
            definition_context: self.add(format!(
                "PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')"
            )),
            units: [length, angle, solid_angle],
            accuracy: self.add(format!(
                "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({}),#{length},'distance_accuracy_value','')",
                real(ACCURACY)
            )),
        }
    }

    /// Adds a product with a context of its own and the origin of its coordinates.
    fn product(&mut self, frame: &ProductFrame, name: &str) -> Product {
        let name = string(name);
        let product = self.add(format!("PRODUCT({name},{name},'',(#{}))", frame.product_context));
        self.add(format!("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#{product}))"));
        let formation = self.add(format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let definition = self.add(format!(
            "PRODUCT_DEFINITION('design','',#{formation},#{})",
            frame.definition_context
        ));
        let shape = self.add(format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        let context = self.add(format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{}))\
             GLOBAL_UNIT_ASSIGNED_CONTEXT(({}))REPRESENTATION_CONTEXT('',''))",
            frame.accuracy,
            list(&frame.units)
        ));
        let origin = self.placement(&Placement::at(DVec3::ZERO, DVec3::Z, DVec3::X));
        Product {
            definition,
            shape,
            context,
            origin,
        }
    }

    fn define(&mut self, product: &Product, representation: usize) {
        self.add(format!(
            "SHAPE_DEFINITION_REPRESENTATION(#{},#{representation})",
            product.shape
        ));
    }

    /// Adds the solids of a body with their colours, and returns their representation.
    fn body(&mut self, product: &Product, name: &str, solids: &[&Solid]) -> usize {
        let mut items = vec![product.origin];
        let mut styled = Vec::new();
        for (place, solid) in solids.iter().enumerate() {
            let shell = self.shell(&Prism::of(&solid.shape));
            let label = string(&format!("{name}_{}", place + 1));
            let solid_record = self.add(format!("MANIFOLD_SOLID_BREP({label},#{shell})"));
            items.push(solid_record);
            styled.push(self.colour(solid.part, solid_record));
        }
        let representation = self.add(format!(
            "ADVANCED_BREP_SHAPE_REPRESENTATION({},({}),#{})",
            string(name),
            list(&items),
            product.context
        ));
        self.define(product, representation);
        self.add(format!(
            "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',({}),#{})",
            list(&styled),
            product.context
        ));
        representation
    }

    /// Adds the use of a component in the assembly, whose frame is at a placement of the assembly.
    fn place(&mut self, assembly: &Product, whole: usize, (name, product, shape, at): (&str, &Product, usize, usize)) {
        let name = string(name);
        let usage = self.add(format!(
            "NEXT_ASSEMBLY_USAGE_OCCURRENCE({name},{name},'',#{},#{},$)",
            assembly.definition, product.definition
        ));
        let usage_shape = self.add(format!("PRODUCT_DEFINITION_SHAPE('','',#{usage})"));
        let moved = self.add(format!("ITEM_DEFINED_TRANSFORMATION('','',#{},#{at})", product.origin));
        let relation = self.add(format!(
            "(REPRESENTATION_RELATIONSHIP('','',#{shape},#{whole})\
             REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{moved})SHAPE_REPRESENTATION_RELATIONSHIP())"
        ));
        self.add(format!(
            "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{usage_shape})"
        ));
    }

    fn colour(&mut self, part: Part, item: usize) -> usize {
        let [r, g, b] = palette::part(part).map(|level| real((f64::from(level) / 255.0 * 1e4).round() / 1e4));
        let colour = self.add(format!("COLOUR_RGB('',{r},{g},{b})"));
        let fill = self.add(format!("FILL_AREA_STYLE_COLOUR('',#{colour})"));
        let fill = self.add(format!("FILL_AREA_STYLE('',(#{fill}))"));
        let fill = self.add(format!("SURFACE_STYLE_FILL_AREA(#{fill})"));
        let side = self.add(format!("SURFACE_SIDE_STYLE('',(#{fill}))"));
        let usage = self.add(format!("SURFACE_STYLE_USAGE(.BOTH.,#{side})"));
        let style = self.add(format!("PRESENTATION_STYLE_ASSIGNMENT((#{usage}))"));
        self.add(format!("STYLED_ITEM('',(#{style}),#{item})"))
    }

    fn point(&mut self, at: DVec3) -> usize {
        self.add(format!("CARTESIAN_POINT('',({}))", coordinates(at)))
    }

    fn direction(&mut self, along: DVec3) -> usize {
        self.add(format!("DIRECTION('',({}))", coordinates(along)))
    }

    fn placement(&mut self, place: &Placement) -> usize {
        let (at, z, x) = (
            self.point(place.origin),
            self.direction(place.z),
            self.direction(place.x),
        );
        self.add(format!("AXIS2_PLACEMENT_3D('',#{at},#{z},#{x})"))
    }

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
        let mut across = [0, 1].map(|end| -> Vec<usize> {
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
        Outline {
            last: std::mem::take(&mut across[1]),
            first: std::mem::take(&mut across[0]),
            along,
        }
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

    /// Adds the closed shell of a prism.
    fn shell(&mut self, prism: &Prism) -> usize {
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

    /// Returns the file with a description. It has no date, so that the same design gives the same file.
    fn document(&self, description: &str, name: &str) -> String {
        let lines: Vec<String> = description.lines().map(string).collect();
        let mut text = format!(
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(({}),'2;1');\n\
             FILE_NAME({},'1970-01-01T00:00:00',(''),(''),'Kinefront {}','Kinefront','');\n\
             FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF {{ 1 0 10303 442 3 1 4 }}'));\nENDSEC;\nDATA;\n",
            lines.join(","),
            string(name),
            env!("CARGO_PKG_VERSION")
        );
        for (place, record) in self.records.iter().enumerate() {
            let _ = writeln!(text, "#{}={record};", place + 1);
        }
        text + "ENDSEC;\nEND-ISO-10303-21;\n"
    }
}

/// Writes record numbers: `#1,#2`.
fn list(records: &[usize]) -> String {
    let records: Vec<String> = records.iter().map(|record| format!("#{record}")).collect();
    records.join(",")
}

fn truth(value: bool) -> &'static str {
    if value { ".T." } else { ".F." }
}

fn coordinates(at: DVec3) -> String {
    at.to_array().map(real).join(",")
}

/// Writes a number with the decimal point that the format requires.
fn real(value: f64) -> String {
    let text = super::prepared::text(value);
    if text.contains('.') { text } else { format!("{text}.") }
}

/// Writes a text: apostrophes and backslashes are doubled, and what is not ASCII is written by its code.
fn string(text: &str) -> String {
    let mut written = "'".to_owned();
    for letter in text.chars() {
        match letter {
            '\'' => written += "''",
            '\\' => written += "\\\\",
            ' '..='~' => written.push(letter),
            _ => {
                let code = u32::from(letter);
                let _ = match code {
                    0..=0xFFFF => write!(written, "\\X2\\{code:04X}\\X0\\"),
                    _ => write!(written, "\\X4\\{code:08X}\\X0\\"),
                };
            }
        }
    }
    written + "'"
}
