//! STEP files, read by a reader of their own: the topology and geometry of every solid, the placements of the assembly, and planted
//! faults that other readers accept.

mod records;
mod solids;

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use kinefront_export::{ExportSubject, Format, export};
use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_model::mechanism::{Architecture, Design, WorkingMode};
use kinefront_scene::{Linkage, SolidShape, linkage};
use kinefront_study::{PreparedStudy, Study};

use self::records::{Records, Value};
use self::solids::volume;

/// The volumes of the solids of a product \[mm³\], and its frame in the assembly.
type Placed = (Vec<f64>, [DVec3; 3]);

/// Returns the products by their names, or what is wrong with the file.
fn check(text: &str) -> Result<BTreeMap<String, Placed>, String> {
    fn references(value: &Value, found: &mut Vec<usize>) {
        match value {
            Value::Record(record) => found.push(*record),
            Value::List(list) | Value::Entity(_, list) => list.iter().for_each(|item| references(item, found)),
            Value::Number(_) | Value::Word(_) => {}
        }
    }
    let records = Records::read(text)?;
    let mut found = Vec::new();
    records.0.values().for_each(|record| references(record, &mut found));
    if let Some(missing) = found.iter().find(|record| !records.0.contains_key(record)) {
        return Err(format!("#{missing} does not exist"));
    }
    let styled: Vec<usize> = records
        .all("STYLED_ITEM")
        .map(|(_, parts)| parts[2].record())
        .collect::<Result<_, _>>()?;
    let mut products = BTreeMap::new();
    // The placement of each component is the second one of its transformation.
    for (_, parts) in records.all("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") {
        let Some(Value::List(relation)) = records.0.get(&parts[0].record()?) else {
            return Err("a relation is missing".to_owned());
        };
        let [Value::Entity(_, ends), Value::Entity(_, transformation), _] = &relation[..] else {
            return Err(format!("{relation:?}"));
        };
        let shape = ends[2].record()?;
        let moved = records.of(transformation[0].record()?, "ITEM_DEFINED_TRANSFORMATION")?;
        let brep = records.of(shape, "ADVANCED_BREP_SHAPE_REPRESENTATION")?;
        let Value::Word(name) = &brep[0] else {
            return Err("a product has no name".to_owned());
        };
        let mut volumes = Vec::new();
        for item in &brep[1].list()?[1..] {
            if !styled.contains(&item.record()?) {
                return Err(format!("#{} has no colour", item.record()?));
            }
            let solid = records.of(item.record()?, "MANIFOLD_SOLID_BREP")?;
            volumes.push(volume(&records, solid[1].record()?)?);
        }
        if records.placement(moved[2].record()?)? != [DVec3::ZERO, DVec3::Z, DVec3::X] {
            return Err("a product is not at the origin of its coordinates".to_owned());
        }
        let usage = records.of(parts[1].record()?, "PRODUCT_DEFINITION_SHAPE")?;
        let usage = records.of(usage[2].record()?, "NEXT_ASSEMBLY_USAGE_OCCURRENCE")?;
        if usage[0] != brep[0] {
            return Err(format!("{name} is used as {:?}", usage[0]));
        }
        products.insert(
            name.trim_matches('\'').to_owned(),
            (volumes, records.placement(moved[3].record()?)?),
        );
    }
    Ok(products)
}

/// The volume of a solid \[mm³\].
fn analytic(shape: &SolidShape) -> f64 {
    1e9 * match *shape {
        SolidShape::Bar {
            from,
            to,
            radius,
            inner,
        } => PI * (radius * radius - inner * inner) * from.distance(to),
        SolidShape::Block { half_size, inner, .. } => 8.0 * half_size.x * (half_size.y * half_size.z - inner * inner),
    }
}

/// Compares a file with the scene that it shows.
fn agrees(text: &str, linkage: &Linkage) -> Result<(), String> {
    let mut products = check(text)?;
    for body in &linkage.bodies {
        let wanted: Vec<f64> = body
            .solids
            .iter()
            .filter(|solid| solid.shape.has_volume())
            .map(|solid| analytic(&solid.shape))
            .collect();
        // A body of joints alone is no product.
        if wanted.is_empty() {
            continue;
        }
        let Some((volumes, [origin, z, x])) = products.remove(&body.name) else {
            return Err(format!("{} is missing", body.name));
        };
        if volumes.len() != wanted.len() {
            return Err(format!(
                "{} has {} solids, not {}",
                body.name,
                volumes.len(),
                wanted.len()
            ));
        }
        for (volume, wanted) in volumes.iter().zip(wanted) {
            // Far from the origin, the parts of the surface cancel.
            if (volume / wanted - 1.0).abs() > 1e-9 {
                return Err(format!("{}: {volume} mm³ instead of {wanted}", body.name));
            }
        }
        let axis = DVec2::new(body.frame.angle.cos(), body.frame.angle.sin()).extend(0.0);
        let off = (origin - 1e3 * body.frame.origin.extend(0.0)).length() + 1e3 * (x - axis).length();
        if off > 1e-9 || z != DVec3::Z {
            return Err(format!("{} is off by {off} mm", body.name));
        }
    }
    match products.keys().map(String::as_str).collect::<Vec<_>>()[..] {
        ["base"] => Ok(()),
        ref rest => Err(format!("{rest:?}")),
    }
}

fn study(sections: &str) -> PreparedStudy {
    let text = format!("name = \"step\"\n{sections}");
    PreparedStudy::new(Study::parse(&text, "step.toml").expect("a study")).expect("a model")
}

fn written(study: &PreparedStudy, evaluation: &Evaluation) -> String {
    let subject = ExportSubject {
        study,
        evaluation,
        pose: None,
    };
    let step = Format::find("step").expect("the format");
    String::from_utf8(export(&subject, step).expect("a file")).expect("ASCII")
}

#[test]
fn every_architecture_is_an_assembly_of_exact_solids() {
    let hollow = "[sections]\nlegs = { kind = \"tube\", wall_ratio = 0.2 }\nplatform = { kind = \"square_tube\", wall_ratio = 0.15 }\n";
    let mut count = 0;
    for study in [study(""), study(hollow)] {
        for &architecture in Architecture::ALL {
            let design =
                Design::new(architecture, WorkingMode::ALL_PLUS, [1.5, 0.4, 1.2, 0.02, 0.03]).expect("a design");
            let evaluation = study.model().evaluate(&design, GridChoice::Reference);
            let text = written(&study, &evaluation);
            assert!(text.is_ascii());
            let pose = study.model().home(&evaluation);
            let bodies = linkage(study.model(), &design, &pose).expect("reachable");
            agrees(&text, &bodies).unwrap_or_else(|error| panic!("{architecture}: {error}"));
            assert_eq!(text, written(&study, &evaluation));
            count += 1;
        }
    }
    assert_eq!(count, 2 * Architecture::ALL.len());
}

/// Each of these is a file that looks sound, and some of them other programs accept.
#[test]
fn planted_faults_are_found() {
    let study = study("[sections]\nlegs = { kind = \"tube\", wall_ratio = 0.2 }\n");
    let design: Design = "3-RRR R=1.5 r=0.4 Lb=1.2 rj=0.02 rp=0.03".parse().expect("a design");
    let evaluation = study.model().evaluate(&design, GridChoice::Reference);
    let text = written(&study, &evaluation);
    let bodies = linkage(study.model(), &design, &study.model().home(&evaluation)).expect("reachable");
    agrees(&text, &bodies).expect("a sound file");
    let line =
        |is_wanted: &dyn Fn(&str) -> bool| text.lines().find(|line| is_wanted(line)).expect("a record").to_owned();
    let faulty = |from: &str, to: &str| text.replacen(from, to, 1);
    // Faces whose surface points into the material: the bore of a tube.
    let bore = line(&|line| line.contains("ADVANCED_FACE") && line.ends_with(",.F.);"));
    let cap = line(&|line| line.contains("=ADVANCED_FACE") && line.ends_with(",.T.);") && line.contains("),#"));
    let edge = line(&|line| line.contains("=ORIENTED_EDGE") && line.ends_with(",.T.);"));
    let styled = line(&|line| line.contains("=STYLED_ITEM"));
    let cylinder = line(&|line| line.contains("=CYLINDRICAL_SURFACE"));
    let curve = line(&|line| line.contains("=EDGE_CURVE"));
    let moved: Vec<&str> = text
        .lines()
        .filter(|line| line.contains("=ITEM_DEFINED_TRANSFORMATION"))
        .collect();
    let target = |line: &str| line.rsplit(',').next().expect("a place").to_owned();
    let swapped = {
        let [first, second] = [moved[1], moved[2]].map(target);
        let changed = [(moved[1], &first, &second), (moved[2], &second, &first)];
        changed.iter().fold(text.clone(), |text, (line, own, other)| {
            text.replace(line, &line.replace(own.as_str(), other.as_str()))
        })
    };
    let vertex = {
        let point = line(&|line| line.contains("=VERTEX_POINT"));
        let number = point.rsplit('#').next().expect("a point").trim_end_matches(");");
        let point = line(&|line| line.starts_with(&format!("#{number}=CARTESIAN_POINT")));
        faulty(&point, &point.replacen("('',(", "('',(1", 1))
    };
    let (before_radius, _) = cylinder.rsplit_once(',').expect("a radius");
    let thicker = format!("{before_radius},77.);");
    let faults = [
        ("a flipped bore", faulty(&bore, &bore.replace(",.F.);", ",.T.);"))),
        ("a flipped face", faulty(&cap, &cap.replace(",.T.);", ",.F.);"))),
        ("swapped placements", swapped),
        ("a flipped edge", faulty(&edge, &edge.replace(",.T.);", ",.F.);"))),
        ("a moved vertex", vertex),
        ("another radius", faulty(&cylinder, &thicker)),
        (
            "a solid without a colour",
            faulty(&styled, &styled.replace("STYLED_ITEM", "STYLED")),
        ),
        (
            "a curve that does not exist",
            faulty(&curve, &curve.replace(",.T.);", "99999,.T.);")),
        ),
    ];
    for (name, text) in faults {
        assert!(agrees(&text, &bodies).is_err(), "{name} is not found");
    }
}

/// Names that are not ASCII are written by their codes, and apostrophes are doubled.
#[test]
fn the_description_names_the_design() {
    let study = study("");
    let design: Design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"
        .parse()
        .expect("a design");
    let evaluation = study.model().evaluate(&design, GridChoice::Reference);
    let text = written(&study, &evaluation);
    assert!(text.starts_with("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('3-PRR R=3.066 r=1.283"));
    assert!(text.contains("Lengths in mm") && text.contains("Not in this file: joints"));
    assert!(text.ends_with("ENDSEC;\nEND-ISO-10303-21;\n"));
}
