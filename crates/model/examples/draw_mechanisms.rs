//! Draws the three mechanisms at a pose, as they stand in `docs/model.md`.
//!
//! `cargo run --release -p kinefront-model --example draw_mechanisms -- docs/figures`

use std::error::Error;
use std::fmt::Write as _;
use std::path::PathBuf;

use glam::DVec2;
use kinefront_model::evaluation::{Model, PoseEvaluation};
use kinefront_model::mechanism::{Design, JointKind};
use kinefront_model::spatial::{ANCHOR_DIRECTIONS, LEGS, Pose, Rotation};

const DESIGNS: [&str; 3] = [
    "3-PRR R=1 r=0.36 Lb=0.62 rj=0.02 rp=0.02",
    "3-RPR R=1 r=0.36 Lb=1.1 rj=0.02 rp=0.02",
    "3-RRR R=1 r=0.36 Lb=0.6 rj=0.02 rp=0.02",
];

const INK: &str = "#1f2933";
const PALE: &str = "#9aa5b1";
const ACTUATED: &str = "#d9730d";
const PLATFORM: &str = "#2b6cb0";

/// A picture in the plane, y upwards, with 200 pixels per metre.
struct Drawing(String);

impl Drawing {
    fn pixel(at: DVec2) -> (f64, f64) {
        (270.0 + 200.0 * at.x, 235.0 - 200.0 * at.y)
    }

    fn line(&mut self, from: DVec2, to: DVec2, color: &str, width: f64, more: &str) {
        let ((x1, y1), (x2, y2)) = (Self::pixel(from), Self::pixel(to));
        let _ = writeln!(
            self.0,
            r#"<line x1="{x1:.1}" y1="{y1:.1}" x2="{x2:.1}" y2="{y2:.1}" stroke="{color}" stroke-width="{width}" {more}/>"#
        );
    }

    fn arrow(&mut self, from: DVec2, to: DVec2, color: &str) {
        self.line(from, to, color, 1.5, "");
        let back = (from - to).normalize() * 0.05;
        for side in [0.4, -0.4] {
            self.line(to, to + Rotation::new(side).apply(back), color, 1.5, "");
        }
    }

    fn joint(&mut self, at: DVec2, color: &str) {
        let (x, y) = Self::pixel(at);
        let _ = writeln!(
            self.0,
            r#"<circle cx="{x:.1}" cy="{y:.1}" r="5" fill="white" stroke="{color}" stroke-width="2"/>"#
        );
    }

    fn slider(&mut self, at: DVec2, along: DVec2) {
        let (x, y) = Self::pixel(at);
        let angle = -libm::atan2(along.y, along.x).to_degrees();
        let _ = writeln!(
            self.0,
            r#"<rect x="-14" y="-8" width="28" height="16" fill="white" stroke="{ACTUATED}" stroke-width="2" transform="translate({x:.1} {y:.1}) rotate({angle:.1})"/>"#
        );
    }

    fn text(&mut self, at: DVec2, text: &str, color: &str) {
        let (x, y) = Self::pixel(at);
        let _ = writeln!(
            self.0,
            r#"<text x="{x:.1}" y="{:.1}" fill="{color}">{text}</text>"#,
            y + 5.0
        );
    }
}

fn subscript(leg: usize) -> char {
    ['₁', '₂', '₃'][leg]
}

/// Base triangle with its frame, and the platform with its frame.
fn draw_frames(drawing: &mut Drawing, anchors: [DVec2; LEGS], ends: [DVec2; LEGS], pose: &Pose) {
    for leg in 0..LEGS {
        drawing.line(
            anchors[leg],
            anchors[(leg + 1) % LEGS],
            PALE,
            1.0,
            r#"stroke-dasharray="5 4""#,
        );
        drawing.line(
            ends[leg],
            ends[(leg + 1) % LEGS],
            PLATFORM,
            1.0,
            r#"stroke-dasharray="3 3""#,
        );
        drawing.line(ends[leg], pose.position, PLATFORM, 4.0, "");
    }
    for (axis, name) in [(DVec2::X, "x"), (DVec2::Y, "y")] {
        drawing.arrow(DVec2::ZERO, 0.2 * axis, PALE);
        drawing.text(0.26 * axis, name, PALE);
    }
    drawing.text(DVec2::new(-0.06, -0.07), "O", PALE);
    let turned = Rotation::new(pose.phi);
    drawing.arrow(pose.position, pose.position + turned.apply(0.24 * DVec2::X), PLATFORM);
    drawing.text(pose.position + turned.apply(DVec2::new(0.3, 0.0)), "X", PLATFORM);
    drawing.text(pose.position + turned.apply(DVec2::new(0.03, 0.12)), "P", PLATFORM);
}

fn draw_leg(
    drawing: &mut Drawing,
    design: &Design,
    found: &PoseEvaluation,
    anchors: [DVec2; LEGS],
    platform: DVec2,
    leg: usize,
) {
    let (a, b, c) = (anchors[leg], DVec2::from(found.b[leg]), DVec2::from(found.c[leg]));
    let u = (c - b).normalize();
    let number = subscript(leg);
    let has_rail = design.architecture().actuator() == JointKind::Prismatic && b.distance(a) > 1e-9;
    let outwards = ANCHOR_DIRECTIONS[leg] * 0.11;
    drawing.line(b, c, INK, 4.0, "");
    if has_rail {
        let along = (anchors[(leg + 1) % LEGS] - a).normalize();
        drawing.line(a, anchors[(leg + 1) % LEGS], PALE, 5.0, "");
        drawing.slider(b, along);
        drawing.text(a.lerp(b, 0.5) + along.perp() * -0.08, &format!("ρ{number}"), ACTUATED);
    } else if design.architecture().actuator() == JointKind::Prismatic {
        drawing.line(a, a.lerp(c, 0.55), ACTUATED, 9.0, "");
        drawing.line(a, a.lerp(c, 0.55), "white", 5.0, "");
        drawing.text(a.lerp(c, 0.45) + u.perp() * 0.1, &format!("ρ{number}"), ACTUATED);
    } else {
        drawing.line(a, b, INK, 4.0, "");
        drawing.text(a + (b - a) * 0.25 - outwards * 0.8, &format!("θ{number}"), ACTUATED);
    }
    let is_crank = design.architecture().actuator() == JointKind::Revolute;
    drawing.joint(a, if is_crank { ACTUATED } else { INK });
    if b.distance(a) > 1e-9 {
        drawing.joint(b, INK);
        drawing.text(b + u.perp() * 0.09 - u * 0.06, &format!("B{number}"), INK);
    }
    drawing.joint(c, INK);
    drawing.arrow(c, c + 0.16 * u, INK);
    drawing.text(c + 0.21 * u, &format!("u{number}"), INK);
    drawing.text(a + outwards, &format!("A{number}"), INK);
    let away = (c - platform).normalize();
    drawing.text(c + Rotation::new(-1.1).apply(away) * 0.1, &format!("C{number}"), INK);
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name the folder for the drawings")?);
    std::fs::create_dir_all(&folder)?;
    let model = Model::default();
    let pose = Pose::new(0.06, 0.05, 0.2);
    for text in DESIGNS {
        let design: Design = text.parse()?;
        let found = model.pose(&design, &pose)?;
        let anchors = ANCHOR_DIRECTIONS.map(|direction| direction * design.base_radius());
        let mut drawing = Drawing(String::new());
        draw_frames(&mut drawing, anchors, found.c.map(DVec2::from), &pose);
        for leg in 0..LEGS {
            draw_leg(&mut drawing, &design, &found, anchors, pose.position, leg);
        }
        let name = design.architecture().name();
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 540 400\" width=\"540\" height=\"400\" \
             font-family=\"Georgia, serif\" font-style=\"italic\" font-size=\"16\" text-anchor=\"middle\">\n\
             <title>Plan view of the {name}</title>\n\
             <rect width=\"540\" height=\"400\" fill=\"white\"/>\n{}</svg>\n",
            drawing.0
        );
        let path = folder.join(format!("mechanism-{}.svg", name.to_lowercase()));
        std::fs::write(&path, svg)?;
        println!("wrote {}", path.display());
    }
    Ok(())
}
