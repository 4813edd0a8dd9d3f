//! What the pointer is over in the 3-D view, in words and numbers.

use glam::DVec2;

use super::Session;
use kinefront_model::evaluation::{Better, Contribution, MemberReport};
use kinefront_model::mechanism::MemberKind;
use kinefront_model::spatial::Pose;
use kinefront_recording::SceneTarget;
use kinefront_scene::text::{self, number};
use kinefront_scene::{BarStresses, EllipsoidKind, Field, Heatmap, Part, ellipsoids, manipulator};

/// Entity under the pointer.
#[derive(Debug, Clone, PartialEq)]
pub struct Pointed {
    /// Path of the entity.
    pub entity: String,
    /// Index of the instance, if one is meant.
    pub instance: Option<u64>,
    /// Position under the pointer \[m\].
    pub at: DVec2,
}

/// What is told of the entity under the pointer.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// What it is.
    pub title: String,
    /// Its numbers, one line each.
    pub lines: Vec<String>,
    /// Whether the value passes its threshold, for a field.
    pub passes: Option<bool>,
}

impl Description {
    fn new(title: impl Into<String>, lines: Vec<String>) -> Self {
        Self {
            title: title.into(),
            lines,
            passes: None,
        }
    }
}

/// Describes what the pointer is over; `None` where there is nothing to tell.
pub fn describe(session: &Session, pointed: &Pointed) -> Option<Description> {
    match SceneTarget::of_entity(&pointed.entity, pointed.instance)? {
        SceneTarget::Field(field) => of_field(session, field, pointed.at),
        SceneTarget::Solid(parts, index) => of_solid(session, parts, index),
        SceneTarget::Ellipsoid(kind, index) => of_ellipsoid(session, kind, index),
        SceneTarget::Workspace => of_workspace(session),
        SceneTarget::Threshold => Some(Description::new(
            "threshold",
            vec!["the field has the value that the study requires".to_owned()],
        )),
        SceneTarget::Singularity => Some(Description::new(
            "parallel singularity",
            vec!["det A = 0: the platform can move although all actuators are locked".to_owned()],
        )),
        SceneTarget::Edge => Some(Description::new(
            "edge of reach",
            vec!["grey: a joint limit; orange: the end of a leg's reach, a serial singularity".to_owned()],
        )),
    }
}

fn of_field(session: &Session, field: Field, position: DVec2) -> Option<Description> {
    let design = session.known()?.evaluation.design;
    let phi = session.view().heatmap_phi.unwrap_or(session.home()?.phi);
    let pose = Pose { position, phi };
    let model = session.model();
    let value = Heatmap::value_at(model, &design, field, &pose)?;
    let threshold = field.threshold(model);
    let passes = match field.better() {
        Better::Lower => value <= threshold,
        Better::Higher => value >= threshold,
    };
    let factor = field.display_factor();
    let verdict = if passes { "passes" } else { "misses" };
    Some(Description {
        title: format!("{}: {}", field.title(), number(factor * value)),
        lines: vec![
            format!("{verdict} its threshold {}", number(factor * threshold)),
            format!(
                "x {} m, y {} m, φ {:.1}°",
                number(position.x),
                number(position.y),
                phi.to_degrees()
            ),
            "a click moves the platform here".to_owned(),
        ],
        passes: Some(passes),
    })
}

fn of_solid(session: &Session, parts: &[Part], index: usize) -> Option<Description> {
    let design = session.known()?.evaluation.design;
    let (model, pose) = (session.model(), session.pose()?);
    let scene = manipulator(model, &design, &pose).ok()?;
    let solid = scene
        .solids
        .iter()
        .filter(|solid| parts.contains(&solid.part))
        .nth(index)?;
    let leg = solid.leg.map_or(String::new(), |leg| format!(" of leg {}", leg + 1));
    match solid.part {
        Part::PassiveJoint => Some(Description::new(format!("passive joint{leg}"), Vec::new())),
        Part::ActuatedJoint | Part::Carriage => {
            let report = model.pose(&design, &pose).ok()?;
            let value = report.actuators[solid.leg?];
            let unit = design.architecture().actuator().unit();
            let name = if solid.part == Part::Carriage {
                "carriage"
            } else {
                "actuated joint"
            };
            let line = format!("actuated joint at {} {unit}", number(value));
            Some(Description::new(format!("{name}{leg}"), vec![line]))
        }
        _ => {
            let members = model.members(&design, &pose).ok()?;
            let member = members.iter().find(|member| solid.shows(&member.member))?;
            let mut description = describe_member(member);
            if session.view().layers.stresses
                && let Some(stresses) = BarStresses::new(model, &design, &pose, session.view().layers.wrench)
                && let Some(stress) = stresses.of(solid)
            {
                description
                    .lines
                    .push(format!("stress {} MPa at this pose", number(1e-6 * stress)));
            }
            if solid.part == Part::PlatformBar {
                let hint = "drag it to move the platform, its end to turn it; Shift keeps the angle";
                description.lines.push(hint.to_owned());
            }
            Some(description)
        }
    }
}

/// Describes a member at the pose of its report.
pub(super) fn describe_member(report: &MemberReport) -> Description {
    let is_slider = report.member.kind == MemberKind::Slider;
    let thickness = if is_slider { "half width" } else { "radius" };
    let of_rail = if is_slider { " of its rail" } else { "" };
    let mut lines = vec![format!(
        "length {} m, {thickness} {} mm",
        number(report.length),
        number(1e3 * report.radius)
    )];
    if report.mass > 0.0 {
        lines.push(format!("mass{of_rail} {} kg", number(report.mass)));
    }
    let of_all = |what: &str, contribution: Contribution| {
        let percent = |fraction: f64| format!("{:.1} %", 100.0 * fraction);
        format!(
            "contribution{what} to the compliance at this pose: {} in the plane, {} along z, {} about z",
            percent(contribution.in_plane),
            percent(contribution.vertical),
            percent(contribution.rotation)
        )
    };
    // A rigid rail contributes nothing.
    let yields = |contribution: &Contribution| !is_slider || *contribution != Contribution::default();
    let contribution = report.contribution.filter(yields);
    lines.extend(contribution.map(|contribution| of_all(of_rail, contribution)));
    lines.extend(
        report
            .actuator
            .map(|contribution| of_all(" of its actuator", contribution)),
    );
    Description::new(text::member(&report.member), lines)
}

fn of_ellipsoid(session: &Session, kind: EllipsoidKind, index: usize) -> Option<Description> {
    let known = session.known()?;
    let set = ellipsoids(session.model(), &known.evaluation, kind)?;
    let ellipsoid = set.ellipsoids.get(index)?;
    let unit = match kind {
        EllipsoidKind::Stiffness => "N/m",
        EllipsoidKind::Displacement => "m/N",
    };
    let [first, second, third] = ellipsoid.values.to_array().map(number);
    let position = ellipsoid.pose.position;
    Some(Description::new(
        format!("{} ellipsoid", kind.key()),
        vec![
            format!("in the plane {first} and {second} {unit}, along z {third} {unit}"),
            format!("first axis at {:.1}° to Ox", ellipsoid.angle.to_degrees()),
            format!("x {} m, y {} m", number(position.x), number(position.y)),
        ],
    ))
}

fn of_workspace(session: &Session) -> Option<Description> {
    let evaluation = &session.known()?.evaluation;
    let range = session.model().settings().workspace.rotation_range_deg;
    let home = evaluation.home_phi_deg?;
    Some(Description::new(
        "regular workspace",
        vec![
            format!("R_w = {} m", number(evaluation.workspace_radius())),
            format!("every φ from {:.1}° to {:.1}°", home - 0.5 * range, home + 0.5 * range),
        ],
    ))
}
