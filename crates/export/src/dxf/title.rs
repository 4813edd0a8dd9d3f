//! The title block beside the plan view: what is drawn, and what has to be ordered and cut for it.

use glam::DVec2;

use super::{MM, Prepared, Sheet};
use crate::parts::{outline, section_name};
use kinefront_scene::text::number;

const LAYER: &str = "TITLE_BLOCK";

/// Width of a character and distance of two lines, as multiples of the height of the text.
const CHARACTER: f64 = 0.9;
const LINE: f64 = 1.8;

/// Number of columns of the list of parts: name, section, length, pieces.
const COLUMNS: usize = 4;

/// Distance from the drawing to the title block as a share of `R`.
const MARGIN: f64 = 0.3;

impl Sheet {
    /// Adds a frame with the facts of the drawing and the list of parts, to the right of it.
    pub(super) fn title_block(&mut self, subject: &Prepared, height: f64) {
        let radius = subject.evaluation.design.base_radius();
        let (facts, parts) = (facts(subject), parts(subject));
        let longest = facts.iter().map(|words| words.chars().count()).max().unwrap_or(0);
        let columns: [usize; COLUMNS] =
            std::array::from_fn(|column| 2 + parts.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
        let characters = longest.max(columns.iter().sum());
        let width = (characters as f64 + 1.0) * CHARACTER * height;
        let corner = DVec2::new(rightmost(subject) + MARGIN * radius, radius);
        let step = LINE * height;
        let mut below = corner.y;
        let rule = |sheet: &mut Sheet, y: f64| {
            sheet.line(LAYER, DVec2::new(corner.x, y), DVec2::new(corner.x + width, y));
        };
        let beginning = |below: f64| DVec2::new(corner.x + 0.5 * height, below + 0.4 * height);
        rule(self, below);
        for words in &facts {
            below -= step;
            self.text(LAYER, beginning(below), height, words);
        }
        rule(self, below);
        for row in &parts {
            below -= step;
            let mut at = beginning(below);
            for (cell, column) in row.iter().zip(columns) {
                if !cell.is_empty() {
                    self.text(LAYER, at, height, cell);
                }
                at.x += column as f64 * CHARACTER * height;
            }
            rule(self, below);
        }
        for x in [corner.x, corner.x + width] {
            self.line(LAYER, DVec2::new(x, corner.y), DVec2::new(x, below));
        }
    }
}

fn facts(subject: &Prepared) -> Vec<String> {
    let (evaluation, pose) = (subject.evaluation, &subject.pose);
    let mut facts = vec![
        subject.title(),
        format!("study {}", subject.study.name),
        "lengths in mm, scale 1:1".to_owned(),
        format!("mass in motion {} kg", number(evaluation.mass())),
    ];
    if let Some(cylinder) = subject.cylinder {
        let region = match &subject.corners {
            Some(_) => "prescribed region".to_owned(),
            None => format!("regular workspace R_w {} mm", number(MM * cylinder.radius)),
        };
        let range = number(cylinder.phi_range.to_degrees());
        facts.push(format!("{region}, rotation range {range} deg"));
    }
    let [x, y] = (pose.position * MM).to_array();
    let phi = pose.phi.to_degrees();
    facts.push(format!(
        "drawn at x {} mm, y {} mm, phi {} deg",
        number(x),
        number(y),
        number(phi)
    ));
    facts
}

/// The rows of the list of parts, with its headings.
fn parts(subject: &Prepared) -> Vec<[String; COLUMNS]> {
    let headings = ["part", "section", "length", "pieces"].map(str::to_owned);
    let design = &subject.evaluation.design;
    let rows = subject
        .model
        .parts(design, subject.evaluation.drive)
        .into_iter()
        .map(|part| {
            let [section, length] = match &part.bar {
                Some(bar) => [
                    match section_name(&part) {
                        Some(name) => format!("{name}, {}", outline(bar)),
                        None => outline(bar),
                    },
                    format!("{:.1}", MM * bar.length),
                ],
                None => [section_name(&part).unwrap_or_default(), String::new()],
            };
            [part.name.to_owned(), section, length, part.pieces.to_string()]
        });
    std::iter::once(headings).chain(rows).collect()
}

/// Returns the largest x of what is drawn.
fn rightmost(subject: &Prepared) -> f64 {
    let scene = &subject.scene;
    let lines = scene
        .lines
        .iter()
        .flat_map(|line| line.points.iter().map(|point| point.x));
    let solids = scene
        .solids
        .iter()
        .flat_map(|solid| solid.shape.mesh().positions)
        .map(|corner| corner.x);
    let region = subject.corners.iter().flatten().map(|corner| corner.x);
    let disc = subject.cylinder.map(|cylinder| cylinder.centre.x + cylinder.radius);
    lines
        .chain(solids)
        .chain(region)
        .chain(disc)
        .fold(subject.pose.position.x, f64::max)
}
