//! STEP files, read by a reader of their own: the topology and geometry of every solid, the placements of the assembly, and planted
//! faults that other readers accept.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use kinefront_export::{ExportSubject, Format, export};
use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_model::mechanism::{Architecture, Design, WorkingMode};
use kinefront_scene::{Linkage, SolidShape, linkage};
use kinefront_study::{PreparedStudy, Study};

#[derive(Debug, Clone, PartialEq)]
enum Value {
    Record(usize),
    Number(f64),
    /// A text, an enumeration, `$` or `*`.
    Word(String),
    List(Vec<Value>),
    /// An entity within another record.
    Entity(String, Vec<Value>),
}

impl Value {
    fn record(&self) -> Result<usize, String> {
        match self {
            Value::Record(record) => Ok(*record),
            other => Err(format!("{other:?} is no reference")),
        }
    }

    fn number(&self) -> Result<f64, String> {
        match self {
            Value::Number(number) => Ok(*number),
            other => Err(format!("{other:?} is no number")),
        }
    }

    fn list(&self) -> Result<&[Value], String> {
        match self {
            Value::List(list) => Ok(list),
            other => Err(format!("{other:?} is no list")),
        }
    }

    fn is_true(&self) -> bool {
        *self == Value::Word(".T.".to_owned())
    }
}

/// Reads one value from the start of a text; returns what follows.
fn value(text: &str) -> Result<(Value, &str), String> {
    let text = text.trim_start();
    let first = text.chars().next().ok_or("the text ends")?;
    let take = |is_part: fn(char) -> bool| {
        let end = text[1..].find(|c| !is_part(c)).map_or(text.len(), |at| at + 1);
        (&text[..end], &text[end..])
    };
    match first {
        '#' => {
            let (word, rest) = take(|c| c.is_ascii_digit());
            Ok((Value::Record(word[1..].parse().map_err(|_| word.to_owned())?), rest))
        }
        '(' => {
            let mut list = Vec::new();
            let mut rest = &text[1..];
            loop {
                rest = rest.trim_start_matches([',', ' ']);
                if let Some(after) = rest.strip_prefix(')') {
                    return Ok((Value::List(list), after));
                }
                let (item, after) = value(rest)?;
                list.push(item);
                rest = after;
            }
        }
        '\'' => {
            // Apostrophes within a text are doubled.
            let mut end = 1;
            loop {
                end += text[end..].find('\'').ok_or("a text does not end")? + 1;
                if !text[end..].starts_with('\'') {
                    return Ok((Value::Word(text[..end].to_owned()), &text[end..]));
                }
                end += 1;
            }
        }
        '.' => {
            let (word, rest) = take(|c| c.is_ascii_alphanumeric() || c == '.' || c == '_');
            Ok((Value::Word(word.to_owned()), rest))
        }
        '$' | '*' => Ok((Value::Word(first.to_string()), &text[1..])),
        '-' | '0'..='9' => {
            let (word, rest) = take(|c| c.is_ascii_digit() || ".E-+".contains(c));
            if !word.contains('.') {
                return Err(format!("{word} has no decimal point"));
            }
            Ok((Value::Number(word.parse().map_err(|_| word.to_owned())?), rest))
        }
        _ => {
            let (name, rest) = take(|c| c.is_ascii_alphanumeric() || c == '_');
            let (arguments, rest) = value(rest)?;
            Ok((Value::Entity(name.to_owned(), arguments.list()?.to_vec()), rest))
        }
    }
}

/// The records of a file by their numbers.
struct Records(BTreeMap<usize, Value>);

impl Records {
    fn read(text: &str) -> Result<Self, String> {
        let data = text.split("DATA;\n").nth(1).ok_or("no data")?;
        let data = data.split("ENDSEC;").next().ok_or("no end")?;
        let mut records = BTreeMap::new();
        for line in data.lines() {
            let (number, body) = line.split_once('=').ok_or_else(|| line.to_owned())?;
            let number = number[1..].parse().map_err(|_| line.to_owned())?;
            // A protocol's year is a whole number.
            let body = body
                .strip_suffix(';')
                .ok_or_else(|| line.to_owned())?
                .replace(",2020,", ",2020.,");
            let body = body.replace("CONTEXT(3)", "CONTEXT(3.)");
            let (found, rest) = value(&body)?;
            if !rest.is_empty() || records.insert(number, found).is_some() {
                return Err(format!("{line}: {rest}"));
            }
        }
        Ok(Self(records))
    }

    fn of(&self, record: usize, name: &str) -> Result<&[Value], String> {
        match self.0.get(&record) {
            Some(Value::Entity(found, arguments)) if found == name => Ok(arguments),
            other => Err(format!("#{record} is {other:?}, not {name}")),
        }
    }

    fn name(&self, record: usize) -> &str {
        match self.0.get(&record) {
            Some(Value::Entity(name, _)) => name,
            _ => "",
        }
    }

    fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = (usize, &'a [Value])> {
        self.0.iter().filter_map(move |(number, found)| match found {
            Value::Entity(entity, arguments) if entity == name => Some((*number, &arguments[..])),
            _ => None,
        })
    }

    fn vector(&self, record: usize, name: &str) -> Result<DVec3, String> {
        let parts = self.of(record, name)?[1].list()?;
        let [x, y, z] = [0, 1, 2].map(|k| parts[k].number());
        Ok(DVec3::new(x?, y?, z?))
    }

    /// Origin, z axis and x axis of a placement.
    fn placement(&self, record: usize) -> Result<[DVec3; 3], String> {
        let parts = self.of(record, "AXIS2_PLACEMENT_3D")?;
        let [z, x] = [2, 3].map(|k| self.vector(parts[k].record()?, "DIRECTION"));
        let (z, x) = (z?, x?);
        if (z.length() - 1.0).abs() > 1e-12 || (x.length() - 1.0).abs() > 1e-12 || z.dot(x).abs() > 1e-12 {
            return Err(format!("#{record} is no frame"));
        }
        Ok([self.vector(parts[1].record()?, "CARTESIAN_POINT")?, z, x])
    }

    fn vertex(&self, record: usize) -> Result<DVec3, String> {
        self.vector(self.of(record, "VERTEX_POINT")?[1].record()?, "CARTESIAN_POINT")
    }
}

const NEAR: f64 = 1e-7;

/// An edge in the direction in which a face uses it.
struct Edge {
    record: usize,
    forward: bool,
    ends: [usize; 2],
    /// Radius and axis of a circle.
    circle: Option<(f64, DVec3, DVec3)>,
}

fn edge(records: &Records, oriented: usize) -> Result<Edge, String> {
    let parts = records.of(oriented, "ORIENTED_EDGE")?;
    let (record, forward) = (parts[3].record()?, parts[4].is_true());
    let parts = records.of(record, "EDGE_CURVE")?;
    let ends = [parts[1].record()?, parts[2].record()?];
    let curve = parts[3].record()?;
    let points = [records.vertex(ends[0])?, records.vertex(ends[1])?];
    let circle = match records.name(curve) {
        "CIRCLE" => {
            let parts = records.of(curve, "CIRCLE")?;
            let ([origin, z, _], radius) = (records.placement(parts[1].record()?)?, parts[2].number()?);
            for point in points {
                let way = point - origin;
                if (way.length() - radius).abs() > NEAR || way.dot(z).abs() > NEAR {
                    return Err(format!("a vertex of #{record} is not on its circle"));
                }
            }
            Some((radius, z, origin))
        }
        _ => {
            let parts = records.of(curve, "LINE")?;
            let from = records.vector(parts[1].record()?, "CARTESIAN_POINT")?;
            let vector = records.of(parts[2].record()?, "VECTOR")?;
            let along = records.vector(vector[1].record()?, "DIRECTION")?;
            for point in points {
                if (point - from).cross(along).length() > NEAR {
                    return Err(format!("a vertex of #{record} is not on its line"));
                }
            }
            if (points[1] - points[0]).dot(along) <= 0.0 {
                return Err(format!("#{record} runs against its line"));
            }
            None
        }
    };
    Ok(Edge {
        record,
        forward,
        ends: if forward { ends } else { [ends[1], ends[0]] },
        circle,
    })
}

/// Returns the volume of a solid by the divergence theorem, or what is wrong with it.
fn volume(records: &Records, shell: usize) -> Result<f64, String> {
    let (mut uses, mut vertices) = (BTreeMap::<usize, [usize; 2]>::new(), Vec::new());
    let (mut faces, mut rings, mut sum) = (0, 0, 0.0);
    for face in records.of(shell, "CLOSED_SHELL")?[1].list()? {
        let parts = records.of(face.record()?, "ADVANCED_FACE")?;
        let (surface, sign) = (parts[2].record()?, if parts[3].is_true() { 1.0 } else { -1.0 });
        faces += 1;
        let mut loops = Vec::new();
        for (place, bound) in parts[1].list()?.iter().enumerate() {
            let kind = if place == 0 { "FACE_OUTER_BOUND" } else { "FACE_BOUND" };
            let bound = records.of(bound.record()?, kind)?;
            rings += usize::from(place > 0);
            let edges: Result<Vec<Edge>, String> = records.of(bound[1].record()?, "EDGE_LOOP")?[1]
                .list()?
                .iter()
                .map(|oriented| edge(records, oriented.record()?))
                .collect();
            let edges = edges?;
            for (k, edge) in edges.iter().enumerate() {
                if edge.ends[1] != edges[(k + 1) % edges.len()].ends[0] {
                    return Err(format!("a loop of #{} is open", face.record()?));
                }
                uses.entry(edge.record).or_default()[usize::from(edge.forward)] += 1;
                vertices.extend(edge.ends);
            }
            loops.push(edges);
        }
        sum += match records.name(surface) {
            "PLANE" => of_plane(records, surface, sign, &loops)?,
            "CYLINDRICAL_SURFACE" => of_cylinder(records, surface, sign, &loops)?,
            other => return Err(format!("a surface is a {other}")),
        };
    }
    if uses.values().any(|used| *used != [1, 1]) {
        return Err("an edge is not used once in each direction".to_owned());
    }
    vertices.sort_unstable();
    vertices.dedup();
    // A bore makes the solid a ring.
    let euler = vertices.len() as i64 - uses.len() as i64 + faces - rings as i64;
    if euler != if rings > 0 { 0 } else { 2 } {
        return Err(format!("the characteristic of #{shell} is {euler}"));
    }
    Ok(sum)
}

fn of_plane(records: &Records, surface: usize, sign: f64, loops: &[Vec<Edge>]) -> Result<f64, String> {
    let [origin, z, _] = records.placement(records.of(surface, "PLANE")?[1].record()?)?;
    let normal = z * sign;
    let mut area = 0.0;
    for (place, edges) in loops.iter().enumerate() {
        let mut part = 0.0;
        for edge in edges {
            let points = [records.vertex(edge.ends[0])?, records.vertex(edge.ends[1])?];
            if points.iter().any(|point| (*point - origin).dot(z).abs() > NEAR) {
                return Err(format!("a vertex is not on #{surface}"));
            }
            part += match edge.circle {
                Some((radius, axis, _)) => {
                    let turns = if edge.forward { 1.0 } else { -1.0 };
                    PI * radius * radius * turns * axis.dot(normal)
                }
                None => 0.5 * (points[0] - origin).cross(points[1] - origin).dot(normal),
            };
        }
        // The outer loop runs counter-clockwise about the normal, an inner one against it.
        if (part > 0.0) != (place == 0) {
            return Err(format!("a loop on #{surface} runs the wrong way"));
        }
        area += part;
    }
    Ok(origin.dot(normal) * area / 3.0)
}

fn of_cylinder(records: &Records, surface: usize, sign: f64, loops: &[Vec<Edge>]) -> Result<f64, String> {
    let parts = records.of(surface, "CYLINDRICAL_SURFACE")?;
    let ([origin, z, _], radius) = (records.placement(parts[1].record()?)?, parts[2].number()?);
    let mut heights = Vec::new();
    for edge in loops.iter().flatten() {
        for end in edge.ends {
            let way = records.vertex(end)? - origin;
            if (way.reject_from(z).length() - radius).abs() > NEAR {
                return Err(format!("a vertex is not on #{surface}"));
            }
        }
        if let Some((_, axis, centre)) = edge.circle {
            let turns = if edge.forward { 1.0 } else { -1.0 } * axis.dot(z);
            heights.push(((centre - origin).dot(z), turns));
        }
    }
    let [(first, at_first), (last, at_last)] = heights[..] else {
        return Err(format!("#{surface} has {} circles", heights.len()));
    };
    // Seen from outside, the lower circle runs with the axis and the upper one against it.
    let (low, high) = if first < last {
        (at_first, at_last)
    } else {
        (at_last, at_first)
    };
    if low * sign < 0.5 || high * sign > -0.5 {
        return Err(format!("the loop on #{surface} runs the wrong way"));
    }
    // The axis contributes nothing, because the normals about it sum to 0.
    Ok(sign * radius * 2.0 * PI * radius * (last - first).abs() / 3.0)
}

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
        let number = point
            .rsplit('#')
            .next()
            .expect("a point")
            .trim_end_matches(");")
            .to_owned();
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
