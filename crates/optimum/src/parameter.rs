//! What a price is of: thresholds, material, actuators, region, travels, cross-sections and bounds.

use glam::DVec2;
use kinefront_model::evaluation::{Bound, ModelSettings, PoseScalar, Quantity};
use kinefront_model::mechanism::{Arrangement, CrossSection, JointKind, MemberKind, Wall};
use kinefront_model::polygon::Polygon;
use kinefront_model::workspace::Region;

use super::problem::LocalProblem;
use super::question::LocalQuestion;
use super::requirement::{End, Requirement, threshold_name};

/// A number of a question that may be changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Parameter {
    /// `E`.
    YoungsModulus,
    /// `G`.
    ShearModulus,
    /// `E` and `G` together.
    Moduli,
    /// `ν`.
    Density,
    /// Yield strength.
    YieldStrength,
    /// Stiffness of the actuators.
    ActuatorStiffness,
    /// The limit of a scalar at each pose.
    Threshold(PoseScalar),
    /// A limit that is none of poses, by its place.
    Limit(usize),
    /// Radius of the disc.
    WorkspaceRadius,
    /// Width of the region, along `Ox`.
    Width,
    /// Height of the region, along `Oy`.
    Height,
    /// Rotation range.
    RotationRange,
    /// Start of the travel on the rails.
    RailStart,
    /// End of the travel on the rails.
    RailEnd,
    /// Start of the travel on the other guides.
    GuideStart,
    /// End of the travel on the other guides.
    GuideEnd,
    /// Shortest length of a telescopic leg.
    TelescopicShortest,
    /// Wall of the bars of the legs, as a share of their radius.
    LegWall,
    /// Wall of the bars of the platform.
    PlatformWall,
    /// A bound of a free variable, by its place.
    Bound(usize, End),
}

/// What a parameter is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterKind {
    /// A limit of what a design must have: at each pose, or as a whole.
    Limit,
    /// The size of the region, or the rotation range.
    Region,
    /// The range in which a guide or a telescopic leg moves.
    Travel,
    /// A bound of a design variable.
    Bound,
    /// The wall of a cross-section.
    Section,
    /// The material, or the stiffness of the actuators.
    Material,
}

impl ParameterKind {
    /// Returns whether less is asked for where the parameter is smaller: it is a requirement, not a property of the material.
    pub fn is_requirement(self) -> bool {
        matches!(self, ParameterKind::Limit | ParameterKind::Region)
    }
}

/// How a parameter is changed by a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// It is multiplied by the exponential of the step: a price is in per cent for 1 %.
    Relative,
    /// The step times `R` is added to a distance that is 0: a price is in per cent for 1 % of `R`.
    OfBaseRadius,
    /// The step \[rad\] is added to an angle.
    Angle,
}

impl Parameter {
    /// Returns the parameters of a problem that may have a price; bounds follow from the design.
    pub(crate) fn all(problem: &LocalProblem) -> Vec<Parameter> {
        let question = problem.question();
        let settings = &question.settings;
        let chain = problem.architecture().chain();
        let mut all = vec![
            Parameter::YoungsModulus,
            Parameter::ShearModulus,
            Parameter::Moduli,
            Parameter::Density,
            Parameter::ActuatorStiffness,
        ];
        all.extend(Self::of_requirements(problem));
        match question.workspace.region {
            Region::Disc(_) if question.objective.quantity != Quantity::WorkspaceRadius => {
                all.push(Parameter::WorkspaceRadius)
            }
            Region::Polygon(_) => all.extend([Parameter::Width, Parameter::Height]),
            _ => {}
        }
        all.push(Parameter::RotationRange);
        if chain.is_on_rails() {
            all.extend([Parameter::RailStart, Parameter::RailEnd]);
        }
        if chain.distal == MemberKind::TelescopicLeg {
            all.push(Parameter::TelescopicShortest);
        } else if chain.joints[1..].contains(&JointKind::Prismatic) {
            all.extend([Parameter::GuideStart, Parameter::GuideEnd]);
        }
        for (section, wall) in [
            (&settings.sections.legs, Parameter::LegWall),
            (&settings.sections.platform, Parameter::PlatformWall),
        ] {
            if let CrossSection::Tube(Wall::Ratio(_)) | CrossSection::SquareTube(Wall::Ratio(_)) = section {
                all.push(wall);
            }
        }
        all
    }

    /// Returns the limits of a problem, those of poses first and then those of designs, with the yield strength where it counts.
    fn of_requirements(problem: &LocalProblem) -> Vec<Parameter> {
        let thresholds = &problem.question().settings.thresholds;
        let requirements = problem.requirements().iter();
        let of_poses = requirements.clone().filter_map(|requirement| match *requirement {
            Requirement::Scalar(scalar) if thresholds.get(scalar).is_some() => Some(Parameter::Threshold(scalar)),
            _ => None,
        });
        let of_designs = requirements.filter_map(|requirement| match *requirement {
            Requirement::Quantity(place) => Some(Parameter::Limit(place)),
            _ => None,
        });
        let safety_factor = thresholds.get(PoseScalar::SafetyFactor);
        let strength = safety_factor.map(|_| Parameter::YieldStrength);
        of_poses.chain(strength).chain(of_designs).collect()
    }

    /// Returns the name in results, the name for a person, and the unit: of the variable itself for a bound of it.
    fn words(self, question: &LocalQuestion) -> [&'static str; 3] {
        match self {
            Parameter::YoungsModulus => ["E", "Young's modulus E", "Pa"],
            Parameter::ShearModulus => ["G", "shear modulus G", "Pa"],
            Parameter::Moduli => ["E_and_G", "E and G together", ""],
            Parameter::Density => ["density", "density", "kg/m³"],
            Parameter::YieldStrength => ["yield_strength", "yield strength", "Pa"],
            Parameter::ActuatorStiffness => ["K_act", "stiffness of the actuators", "N/m"],
            Parameter::Threshold(scalar) => {
                let entry = &scalar.entry().quantity;
                [threshold_name(scalar), entry.label, entry.unit]
            }
            Parameter::Limit(place) => {
                let entry = question.settings.limits[place].quantity.entry();
                [entry.key, entry.label, entry.unit]
            }
            Parameter::WorkspaceRadius => ["workspace_radius", "workspace radius R_w", "m"],
            Parameter::Width => ["width", "width of the region", "m"],
            Parameter::Height => ["height", "height of the region", "m"],
            Parameter::RotationRange => ["rotation_range", "rotation range", "°"],
            Parameter::RailStart => ["rail_start", "start of the rails", ""],
            Parameter::RailEnd => ["rail_end", "end of the rails", ""],
            Parameter::GuideStart => ["guide_start", "start of the guides", ""],
            Parameter::GuideEnd => ["guide_end", "end of the guides", ""],
            Parameter::TelescopicShortest => ["telescopic_shortest", "shortest telescopic leg", ""],
            Parameter::LegWall => ["wall_legs", "wall of the leg tubes", ""],
            Parameter::PlatformWall => ["wall_platform", "wall of the platform tubes", ""],
            Parameter::Bound(place, _) => {
                let variable = question.variables[place].variable;
                [variable.key(), variable.symbol(), variable.unit()]
            }
        }
    }

    /// Returns the name in results.
    pub fn name(self, question: &LocalQuestion) -> String {
        let [name, _, _] = self.words(question);
        match self {
            Parameter::Bound(_, end) => format!("bounds.{name}.{}", end.name()),
            _ => name.to_owned(),
        }
    }

    /// Returns the name for a person.
    pub fn label(self, question: &LocalQuestion) -> String {
        let [_, label, _] = self.words(question);
        match self {
            Parameter::Bound(_, end) => format!("{} bound of {label}", end.name()),
            _ => label.to_owned(),
        }
    }

    /// Returns the value in the unit of [`Parameter::unit`], if it has one: `E` and `G` together have none.
    pub fn value(self, question: &LocalQuestion, actuator: JointKind) -> Option<f64> {
        let settings = &question.settings;
        let arrangement = settings.legs.geometry.arrangement();
        let wall = |section: &CrossSection| section.wall_ratio(1.0);
        Some(match self {
            Parameter::YoungsModulus => settings.material.youngs_modulus,
            Parameter::ShearModulus => settings.material.shear_modulus,
            Parameter::Moduli => return None,
            Parameter::Density => settings.material.density,
            Parameter::YieldStrength => settings.material.yield_strength?,
            Parameter::ActuatorStiffness => match actuator {
                JointKind::Prismatic => settings.actuators.prismatic,
                JointKind::Revolute => settings.actuators.revolute,
            },
            Parameter::Threshold(scalar) => settings.thresholds.get(scalar)?,
            Parameter::Limit(place) => settings.limits[place].threshold(),
            Parameter::WorkspaceRadius => question.workspace.region.inscribed_radius()?,
            Parameter::Width => extent(&question.workspace.region)?.x,
            Parameter::Height => extent(&question.workspace.region)?.y,
            Parameter::RotationRange => question.workspace.rotation_range_deg,
            Parameter::RailStart => arrangement.rail[0],
            Parameter::RailEnd => arrangement.rail[1],
            Parameter::GuideStart => arrangement.guide[0],
            Parameter::GuideEnd => arrangement.guide[1],
            Parameter::TelescopicShortest => settings.legs.telescopic_shortest,
            Parameter::LegWall => wall(&settings.sections.legs),
            Parameter::PlatformWall => wall(&settings.sections.platform),
            Parameter::Bound(place, end) => question.variables[place].range[end as usize],
        })
    }

    /// Returns the unit of the value.
    pub fn unit(self, question: &LocalQuestion, actuator: JointKind) -> &'static str {
        let [_, _, unit] = self.words(question);
        match self {
            Parameter::ActuatorStiffness if actuator == JointKind::Revolute => "N·m/rad",
            _ => unit,
        }
    }

    /// Returns how the parameter is changed.
    pub fn change(self, question: &LocalQuestion, actuator: JointKind) -> Change {
        if let Parameter::Bound(place, _) = self
            && question.variables[place].variable.is_angle()
        {
            return Change::Angle;
        }
        match self.value(question, actuator) {
            Some(0.0) => Change::OfBaseRadius,
            _ => Change::Relative,
        }
    }

    /// Returns what the parameter is part of.
    pub fn kind(self) -> ParameterKind {
        match self {
            Parameter::Threshold(_) | Parameter::Limit(_) => ParameterKind::Limit,
            Parameter::WorkspaceRadius | Parameter::Width | Parameter::Height | Parameter::RotationRange => {
                ParameterKind::Region
            }
            Parameter::RailStart
            | Parameter::RailEnd
            | Parameter::GuideStart
            | Parameter::GuideEnd
            | Parameter::TelescopicShortest => ParameterKind::Travel,
            Parameter::Bound(..) => ParameterKind::Bound,
            Parameter::LegWall | Parameter::PlatformWall => ParameterKind::Section,
            Parameter::YoungsModulus
            | Parameter::ShearModulus
            | Parameter::Moduli
            | Parameter::Density
            | Parameter::YieldStrength
            | Parameter::ActuatorStiffness => ParameterKind::Material,
        }
    }

    /// Returns the question with the parameter changed by a step, for a design of base radius `base_radius` \[m\]; `None` if a step has no
    /// meaning for it.
    pub(crate) fn changed(
        self,
        question: &LocalQuestion,
        step: f64,
        base_radius: f64,
        actuator: JointKind,
    ) -> Option<LocalQuestion> {
        let mut changed = question.clone();
        let is_zero = self.change(question, actuator) == Change::OfBaseRadius;
        let factor = libm::exp(step);
        match self {
            Parameter::Threshold(scalar) => {
                let limit = question.settings.thresholds.get(scalar)?;
                let limit = if is_zero { step * base_radius } else { limit * factor };
                changed.settings.thresholds.set(scalar, Some(limit));
            }
            Parameter::WorkspaceRadius | Parameter::Width | Parameter::Height => {
                changed.workspace.region = resized(self, &question.workspace.region, factor);
            }
            Parameter::RotationRange => changed.workspace.rotation_range_deg *= factor,
            // The start of a travel is a share of its length, as large as R, so that a step of a zero start has no other meaning.
            Parameter::RailStart | Parameter::GuideStart if is_zero => return None,
            Parameter::Bound(place, end) => {
                let free = &mut changed.variables[place];
                let bound = &mut free.range[end as usize];
                *bound = if free.variable.is_angle() {
                    *bound + step.to_degrees()
                } else {
                    *bound * factor
                };
            }
            of_settings => of_settings.multiply(&mut changed.settings, factor, actuator),
        }
        Some(changed)
    }

    /// Multiplies a number of the settings by a factor.
    fn multiply(self, settings: &mut ModelSettings, factor: f64, actuator: JointKind) {
        let arrange = |settings: &mut ModelSettings, change: fn(&mut Arrangement, f64)| {
            let mut arrangement = *settings.legs.geometry.arrangement();
            change(&mut arrangement, factor);
            settings.legs.geometry = arrangement.into();
        };
        match self {
            Parameter::YoungsModulus => settings.material.youngs_modulus *= factor,
            Parameter::ShearModulus => settings.material.shear_modulus *= factor,
            Parameter::Moduli => {
                settings.material.youngs_modulus *= factor;
                settings.material.shear_modulus *= factor;
            }
            Parameter::Density => settings.material.density *= factor,
            Parameter::YieldStrength => {
                settings.material.yield_strength = settings.material.yield_strength.map(|strength| strength * factor);
            }
            Parameter::ActuatorStiffness => match actuator {
                JointKind::Prismatic => settings.actuators.prismatic *= factor,
                JointKind::Revolute => settings.actuators.revolute *= factor,
            },
            Parameter::Limit(place) => {
                let bound = &mut settings.limits[place].bound;
                *bound = match *bound {
                    Bound::AtLeast(limit) => Bound::AtLeast(limit * factor),
                    Bound::AtMost(limit) => Bound::AtMost(limit * factor),
                };
            }
            Parameter::RailStart => arrange(settings, |arrangement, factor| arrangement.rail[0] *= factor),
            Parameter::RailEnd => arrange(settings, |arrangement, factor| arrangement.rail[1] *= factor),
            Parameter::GuideStart => arrange(settings, |arrangement, factor| arrangement.guide[0] *= factor),
            Parameter::GuideEnd => arrange(settings, |arrangement, factor| arrangement.guide[1] *= factor),
            Parameter::TelescopicShortest => {
                settings.legs.telescopic_shortest = (settings.legs.telescopic_shortest * factor).min(0.999);
            }
            Parameter::LegWall => settings.sections.legs = thicker(&settings.sections.legs, factor),
            Parameter::PlatformWall => settings.sections.platform = thicker(&settings.sections.platform, factor),
            // These change by a step that is not always a factor, or are no settings.
            Parameter::Threshold(_)
            | Parameter::WorkspaceRadius
            | Parameter::Width
            | Parameter::Height
            | Parameter::RotationRange
            | Parameter::Bound(..) => {}
        }
    }
}

/// Returns a section with another wall.
fn thicker(section: &CrossSection, factor: f64) -> CrossSection {
    match section {
        CrossSection::Tube(Wall::Ratio(ratio)) => CrossSection::Tube(Wall::Ratio(ratio * factor)),
        CrossSection::SquareTube(Wall::Ratio(ratio)) => CrossSection::SquareTube(Wall::Ratio(ratio * factor)),
        other => other.clone(),
    }
}

/// Returns the sides of the smallest rectangle that holds a polygon \[m\].
fn extent(region: &Region) -> Option<DVec2> {
    match region {
        Region::Polygon(polygon) => {
            let [low, high] = polygon.bounds();
            Some(high - low)
        }
        _ => None,
    }
}

fn resized(parameter: Parameter, region: &Region, factor: f64) -> Region {
    let scale = match parameter {
        Parameter::Width => DVec2::new(factor, 1.0),
        Parameter::Height => DVec2::new(1.0, factor),
        _ => DVec2::splat(factor),
    };
    let scaled = |polygon: &Polygon| polygon.mapped(|corner| corner * scale);
    match region {
        Region::Largest => Region::Largest,
        Region::Disc(radius) => Region::Disc(radius * scale.x),
        Region::Polygon(polygon) => Region::Polygon(scaled(polygon)),
    }
}
