//! glTF 2.0, binary: a node for every body, coloured by part, and the tour of the workspace as an animation.

use std::borrow::Cow;
use std::collections::BTreeMap;

use ::gltf::binary::{Glb, Header};
use ::gltf::json;
use glam::DVec3;
use json::accessor::{ComponentType, GenericComponentType, Type};
use json::buffer::Target;
use json::validation::Checked::Valid;
use json::validation::USize64;
use json::{Accessor, Index, Node};

use super::format::{AnyError, Contents, Format};
use super::prepared::Prepared;
use kinefront_model::spatial::unit;
use kinefront_scene::palette;
use kinefront_scene::{Frame, Mesh, Part, RegularCylinder, Solid, linkage};

pub(super) const FORMAT: Format = Format {
    key: "gltf",
    file: "design.glb",
    name: "glTF",
    title: "glTF, for viewers and CAD",
    lost: Some("joints, masses and actuators; the file contains only geometry and an animation"),
    contents: Contents::Binary,
    write,
};

/// Duration of the tour \[s\].
const TOUR_SECONDS: f64 = 12.0;
/// Number of segments of the circle that shows the regular workspace.
const CIRCLE: usize = 96;

fn write(subject: &Prepared) -> Result<Vec<u8>, AnyError> {
    let mut file = File::default();
    let mut nodes = Vec::new();
    let mut bodies = Vec::new();
    for body in &subject.linkage.bodies {
        let mesh = file.solids(&body.name, &body.solids);
        let node = file.root.push(Node {
            name: Some(body.name.clone()),
            mesh,
            translation: Some(translation(&body.frame)),
            rotation: Some(json::scene::UnitQuaternion(rotation(body.frame.angle))),
            ..Node::default()
        });
        bodies.push(node);
        nodes.push(node);
    }
    if let Some(mesh) = file.solids("base", &subject.base) {
        nodes.push(file.node("base", mesh));
    }
    if let Some(cylinder) = subject.cylinder {
        let line = file.line(&rim(subject, cylinder), Part::Workspace);
        if let Some(mesh) = file.mesh("regular_workspace", vec![line]) {
            nodes.push(file.node("regular_workspace", mesh));
        }
    }
    if let Some(tour) = &subject.tour {
        let design = &subject.evaluation.design;
        let frames: Vec<Vec<Frame>> = tour
            .poses
            .iter()
            .map(|pose| {
                let at = linkage(subject.model, design, pose)?;
                Ok(at.bodies.iter().map(|body| body.frame).collect())
            })
            .collect::<Result<_, kinefront_model::evaluation::Unreachable>>()?;
        file.animate(&bodies, &frames);
    }
    // In glTF the y axis points up; in the base frame z does.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let top = file.root.push(Node {
        name: Some(subject.identifier()),
        children: Some(nodes),
        rotation: Some(json::scene::UnitQuaternion([-half, 0.0, 0.0, half])),
        ..Node::default()
    });
    let scene = file.root.push(json::Scene {
        name: Some(subject.title()),
        nodes: vec![top],
        extensions: None,
        extras: Default::default(),
    });
    file.root.scene = Some(scene);
    file.root.asset = json::Asset {
        generator: Some(format!("Kinefront {}", env!("CARGO_PKG_VERSION"))),
        ..json::Asset::default()
    };
    file.finish()
}

/// Returns the closed outline of the regular workspace.
fn rim(subject: &Prepared, cylinder: RegularCylinder) -> Vec<DVec3> {
    match &subject.corners {
        Some(corners) => corners
            .iter()
            .chain(corners.first())
            .map(|corner| corner.extend(0.0))
            .collect(),
        None => (0..=CIRCLE)
            .map(|k| unit(2.0 * std::f64::consts::PI * k as f64 / CIRCLE as f64))
            .map(|direction| (cylinder.centre + direction * cylinder.radius).extend(0.0))
            .collect(),
    }
}

fn translation(frame: &Frame) -> [f32; 3] {
    [frame.origin.x as f32, frame.origin.y as f32, 0.0]
}

/// Returns a rotation about z as a quaternion.
fn rotation(angle: f64) -> [f32; 4] {
    let (sin, cos) = libm::sincos(0.5 * angle);
    [0.0, 0.0, sin as f32, cos as f32]
}

/// The file being assembled: its JSON description and its binary numbers.
#[derive(Default)]
struct File {
    root: json::Root,
    numbers: Vec<u8>,
    materials: BTreeMap<Part, Index<json::Material>>,
}

impl File {
    /// Adds numbers of 4 bytes each and returns an accessor of `count` elements; `target` says what of a mesh they are, if they are of one.
    fn accessor(
        &mut self,
        bytes: &[u8],
        count: usize,
        component: ComponentType,
        kind: Type,
        target: Option<Target>,
    ) -> Accessor {
        let view = self.root.push(json::buffer::View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(self.numbers.len())),
            byte_stride: None,
            name: None,
            target: target.map(Valid),
            extensions: None,
            extras: Default::default(),
        });
        self.numbers.extend(bytes);
        Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(count),
            component_type: Valid(GenericComponentType(component)),
            type_: Valid(kind),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: Default::default(),
        }
    }

    /// Adds vectors of floats; with `bounds` also their smallest and largest values, which some uses require.
    fn floats<const N: usize>(
        &mut self,
        values: &[[f32; N]],
        kind: Type,
        target: Option<Target>,
        bounds: bool,
    ) -> Index<Accessor> {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let mut accessor = self.accessor(&bytes, values.len(), ComponentType::F32, kind, target);
        if bounds {
            let fold = |pick: fn(f32, f32) -> f32, start: f32| {
                let folded = values.iter().fold([start; N], |found, value| {
                    std::array::from_fn(|k| pick(found[k], value[k]))
                });
                json::Value::from(folded.to_vec())
            };
            accessor.min = Some(fold(f32::min, f32::INFINITY));
            accessor.max = Some(fold(f32::max, f32::NEG_INFINITY));
        }
        self.root.push(accessor)
    }

    fn points(&mut self, points: &[DVec3]) -> Index<Accessor> {
        let values: Vec<[f32; 3]> = points.iter().map(|point| point.as_vec3().to_array()).collect();
        self.floats(&values, Type::Vec3, Some(Target::ArrayBuffer), true)
    }

    /// Adds solids as a mesh with one surface for each kind of part, so that each has its own colour.
    fn solids(&mut self, name: &str, solids: &[Solid]) -> Option<Index<json::Mesh>> {
        let mut surfaces: BTreeMap<Part, Mesh> = BTreeMap::new();
        for solid in solids.iter().filter(|solid| solid.shape.has_volume()) {
            surfaces.entry(solid.part).or_default().append(&solid.shape.mesh());
        }
        let primitives = surfaces.iter().map(|(part, mesh)| self.surface(mesh, *part)).collect();
        self.mesh(name, primitives)
    }

    fn surface(&mut self, mesh: &Mesh, part: Part) -> json::mesh::Primitive {
        let positions = self.points(&mesh.positions);
        // Normalised again, so that the normals have unit length in single precision too.
        let normals: Vec<[f32; 3]> = mesh
            .normals
            .iter()
            .map(|normal| normal.as_vec3().normalize_or_zero().to_array())
            .collect();
        let normals = self.floats(&normals, Type::Vec3, Some(Target::ArrayBuffer), false);
        let indices: Vec<u8> = mesh
            .triangles
            .iter()
            .flatten()
            .flat_map(|index| index.to_le_bytes())
            .collect();
        let indices = self.accessor(
            &indices,
            3 * mesh.triangles.len(),
            ComponentType::U32,
            Type::Scalar,
            Some(Target::ElementArrayBuffer),
        );
        let indices = self.root.push(indices);
        json::mesh::Primitive {
            attributes: BTreeMap::from([
                (Valid(json::mesh::Semantic::Positions), positions),
                (Valid(json::mesh::Semantic::Normals), normals),
            ]),
            indices: Some(indices),
            ..self.primitive(json::mesh::Mode::Triangles, part)
        }
    }

    fn line(&mut self, points: &[DVec3], part: Part) -> json::mesh::Primitive {
        let positions = self.points(points);
        json::mesh::Primitive {
            attributes: BTreeMap::from([(Valid(json::mesh::Semantic::Positions), positions)]),
            ..self.primitive(json::mesh::Mode::LineStrip, part)
        }
    }

    fn primitive(&mut self, mode: json::mesh::Mode, part: Part) -> json::mesh::Primitive {
        json::mesh::Primitive {
            attributes: BTreeMap::new(),
            indices: None,
            material: Some(self.material(part)),
            mode: Valid(mode),
            targets: None,
            extensions: None,
            extras: Default::default(),
        }
    }

    fn material(&mut self, part: Part) -> Index<json::Material> {
        if let Some(&material) = self.materials.get(&part) {
            return material;
        }
        // The palette is in sRGB; the format requires linear values.
        let linear = |value: u8| {
            let value = f64::from(value) / 255.0;
            let light = if value <= 0.04045 {
                value / 12.92
            } else {
                libm::pow((value + 0.055) / 1.055, 2.4)
            };
            light as f32
        };
        let [r, g, b] = palette::part(part).map(linear);
        let material = self.root.push(json::Material {
            name: Some(format!("{part:?}")),
            pbr_metallic_roughness: json::material::PbrMetallicRoughness {
                base_color_factor: json::material::PbrBaseColorFactor([r, g, b, 1.0]),
                metallic_factor: json::material::StrengthFactor(0.1),
                roughness_factor: json::material::StrengthFactor(0.5),
                ..Default::default()
            },
            ..Default::default()
        });
        self.materials.insert(part, material);
        material
    }

    fn mesh(&mut self, name: &str, primitives: Vec<json::mesh::Primitive>) -> Option<Index<json::Mesh>> {
        (!primitives.is_empty()).then(|| {
            self.root.push(json::Mesh {
                name: Some(name.to_owned()),
                primitives,
                weights: None,
                extensions: None,
                extras: Default::default(),
            })
        })
    }

    fn node(&mut self, name: &str, mesh: Index<json::Mesh>) -> Index<Node> {
        self.root.push(Node {
            name: Some(name.to_owned()),
            mesh: Some(mesh),
            ..Node::default()
        })
    }

    /// Adds an animation that moves the nodes through `frames[step][body]`.
    fn animate(&mut self, nodes: &[Index<Node>], frames: &[Vec<Frame>]) {
        let last = (frames.len() - 1).max(1) as f64;
        let times: Vec<[f32; 1]> = (0..frames.len())
            .map(|step| [(TOUR_SECONDS * step as f64 / last) as f32])
            .collect();
        let input = self.floats(&times, Type::Scalar, None, true);
        let (mut channels, mut samplers) = (Vec::new(), Vec::new());
        for (body, &node) in nodes.iter().enumerate() {
            let places: Vec<[f32; 3]> = frames.iter().map(|step| translation(&step[body])).collect();
            let mut angle = frames[0][body].angle;
            let turns: Vec<[f32; 4]> = frames
                .iter()
                .map(|step| {
                    // Unwrapped: a jump of 2π changes the sign of the quaternion and turns the body the long way round.
                    angle += libm::remainder(step[body].angle - angle, 2.0 * std::f64::consts::PI);
                    rotation(angle)
                })
                .collect();
            let outputs = [
                (
                    self.floats(&places, Type::Vec3, None, false),
                    json::animation::Property::Translation,
                ),
                (
                    self.floats(&turns, Type::Vec4, None, false),
                    json::animation::Property::Rotation,
                ),
            ];
            for (output, property) in outputs {
                let sampler = json::animation::Sampler {
                    input,
                    output,
                    interpolation: Valid(json::animation::Interpolation::Linear),
                    extensions: None,
                    extras: Default::default(),
                };
                channels.push(json::animation::Channel {
                    sampler: Index::push(&mut samplers, sampler),
                    target: json::animation::Target {
                        node,
                        path: Valid(property),
                        extensions: None,
                        extras: Default::default(),
                    },
                    extensions: None,
                    extras: Default::default(),
                });
            }
        }
        self.root.push(json::Animation {
            name: Some("tour".to_owned()),
            channels,
            samplers,
            extensions: None,
            extras: Default::default(),
        });
    }

    fn finish(mut self) -> Result<Vec<u8>, AnyError> {
        self.root.push(json::Buffer {
            byte_length: USize64::from(self.numbers.len()),
            uri: None,
            name: None,
            extensions: None,
            extras: Default::default(),
        });
        let text = json::serialize::to_vec(&self.root)?;
        let glb = Glb {
            header: Header {
                magic: *b"glTF",
                version: 2,
                // The writer fills in the actual length.
                length: 0,
            },
            json: Cow::Owned(text),
            bin: Some(Cow::Owned(self.numbers)),
        };
        Ok(glb.to_vec()?)
    }
}
