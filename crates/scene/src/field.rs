//! Scalar fields over poses.

use std::borrow::Cow;

use kinefront_model::evaluation::{Better, Model, PoseScalar, PoseValues, Scale};
use kinefront_model::mechanism::Design;
use kinefront_model::workspace::PoseEvaluator;

/// What a heatmap shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Field {
    /// A scalar of the pose.
    Scalar(PoseScalar),
    /// Smallest relative margin of all limits at the pose.
    WorstMargin,
}

impl Field {
    /// The field that is shown at first: `κ_F⁻¹`.
    pub const DEXTERITY: Field = Field::Scalar(PoseScalar::Dexterity);

    /// All fields.
    pub fn all() -> impl Iterator<Item = Field> {
        let scalars = PoseScalar::ALL.iter().map(|&scalar| Field::Scalar(scalar));
        scalars.chain([Field::WorstMargin])
    }

    /// The fields that tell something of a design.
    pub fn of(model: &Model, design: &Design) -> impl Iterator<Item = Field> {
        let has = |field: &Field| match *field {
            Field::Scalar(scalar) => model.tells(design, scalar),
            Field::WorstMargin => true,
        };
        Self::all().filter(has)
    }

    /// Returns the field with a short name.
    pub fn find(key: &str) -> Option<Field> {
        Self::all().find(|field| field.key() == key)
    }

    /// Returns the short name, as in entity paths and arguments.
    pub fn key(self) -> &'static str {
        match self {
            Field::Scalar(scalar) => scalar.entry().at_pose,
            Field::WorstMargin => "worst_margin",
        }
    }

    /// Returns the display name with its unit.
    pub fn title(self) -> Cow<'static, str> {
        match self {
            Field::Scalar(scalar) => {
                let entry = scalar.entry();
                match entry.shown_in.0 {
                    "" => entry.label.into(),
                    unit => format!("{} [{unit}]", entry.label).into(),
                }
            }
            Field::WorstMargin => "smallest relative margin".into(),
        }
    }

    /// Returns the factor from the SI unit to the unit of [`Field::title`].
    pub fn display_factor(self) -> f64 {
        match self {
            Field::Scalar(scalar) => scalar.entry().shown_in.1,
            Field::WorstMargin => 1.0,
        }
    }

    /// Returns how the values are mapped to colours.
    pub fn scale(self) -> Scale {
        match self {
            Field::Scalar(scalar) => scalar.entry().quantity.scale,
            Field::WorstMargin => Scale::Linear,
        }
    }

    /// Returns which values are better.
    pub fn better(self) -> Better {
        match self {
            Field::Scalar(scalar) => scalar.entry().quantity.better,
            Field::WorstMargin => Better::Higher,
        }
    }

    /// Returns the threshold: the value at which a pose ceases to be feasible; 0 if the study states none.
    pub fn threshold(self, model: &Model) -> f64 {
        let limit = |scalar| model.settings().thresholds.get(scalar);
        match self {
            // The required stiffness follows from the displacement that is allowed.
            Field::Scalar(scalar @ PoseScalar::Displacement) => limit(scalar).unwrap_or_else(|| {
                model.settings().in_plane_force / limit(PoseScalar::StiffnessXy).unwrap_or(f64::INFINITY)
            }),
            Field::Scalar(scalar) => limit(scalar).unwrap_or(0.0),
            Field::WorstMargin => 0.0,
        }
    }

    /// Asks for what the field needs.
    pub(super) fn ask(self, evaluator: &mut dyn PoseEvaluator) {
        if let Field::Scalar(scalar) = self {
            evaluator.ask_for(scalar);
        }
    }

    /// Evaluates the field at a reachable pose. The value is finite: an unbounded displacement is limited to 1 km, and what has no
    /// value is 0.
    pub(super) fn value(self, model: &Model, design: &Design, values: &PoseValues) -> f64 {
        const FARTHEST: f64 = 1e3;
        match self {
            Field::Scalar(scalar @ PoseScalar::Displacement) => values[scalar].min(FARTHEST),
            Field::Scalar(scalar) => values.get(scalar).unwrap_or_default(),
            Field::WorstMargin => {
                let of_limits = model.settings().thresholds.iter().map(|(scalar, limit)| {
                    let value = values.get(scalar).unwrap_or(f64::NAN);
                    scalar.margin(value, limit, design)
                });
                let of_reach = PoseScalar::Reach.margin(values[PoseScalar::Reach], 0.0, design);
                of_limits.fold(of_reach, f64::min)
            }
        }
    }
}

/// Computes the translational in-plane stiffness with the rotation left free, `[xx, xy, yy]` \[N/m\]: the inverse of
/// the xy block of `K⁻¹`. `None` if the stiffness against rotation is 0.
pub(super) fn free_stiffness(&[xx, xy, xm, yy, ym, mm]: &[f64; 6]) -> Option<[f64; 3]> {
    (mm > 0.0).then(|| [xx - xm * xm / mm, xy - xm * ym / mm, yy - ym * ym / mm])
}
