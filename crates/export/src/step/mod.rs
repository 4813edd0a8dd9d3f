//! STEP (AP242): an assembly with one product for the base and for each rigid body, as exact solids with planes and cylinders.
//!
//! Every solid of a scene is a prism: a profile, round or square, perhaps with a bore, along an axis. The writer is our own: the format
//! is a list of numbered records, of which this needs few, and the libraries known turn cylinders into splines.

mod records;
mod solids;

use glam::DVec3;

use self::records::{File, Placement, list, real, string};
use super::format::{AnyError, Contents, Format};
use super::prepared::Prepared;
use kinefront_model::spatial::unit;
use kinefront_scene::{Part, Solid, palette};

pub(super) const FORMAT: Format = Format {
    key: "step",
    file: "design.step",
    name: "STEP",
    title: "STEP, for CAD",
    lost: Some("joints, masses and actuators; the bodies stand where they are at the exported pose"),
    contents: Contents::Text,
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
    let base = ("base", Placement::ORIGIN, &subject.base[..]);
    let bodies = subject.linkage.bodies.iter().map(|body| {
        let axis = unit(body.frame.angle).extend(0.0);
        let place = Placement::at(body.frame.origin.extend(0.0) * MM, DVec3::Z, axis);
        (body.name.as_str(), place, &body.solids[..])
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

impl File {
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
        let origin = self.placement(&Placement::ORIGIN);
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
            let shell = self.shell(&solid.shape);
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
}
