//! Numbers of a design that can stand on an axis, in a column or in a filter.

use super::Row;
use kinefront_model::evaluation::Constraint;
use kinefront_model::mechanism::{VARIABLES, Variable};

/// A number of a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Mass in motion.
    Mass,
    /// `R_w`.
    Radius,
    /// One of the five dimensions.
    Variable(Variable),
    /// `φ_c`.
    Phi,
    /// Relative margin of a constraint.
    Margin(Constraint),
    /// Least clearance of bodies that are not joined, whether the study asks for it or not.
    Clearance,
    /// How far from feasible.
    Violation,
}

/// Which way a quantity is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// Less is better.
    Lower,
    /// More is better.
    Higher,
}

impl Quantity {
    /// All of them: objectives, variables, margins, the rest.
    pub fn all() -> Vec<Quantity> {
        let mut all = vec![Quantity::Mass, Quantity::Radius];
        all.extend(VARIABLES.map(Quantity::Variable));
        all.extend(Constraint::ALL.map(Quantity::Margin));
        all.extend([Quantity::Clearance, Quantity::Phi, Quantity::Violation]);
        all
    }

    /// Name in tables and files, as the columns of `designs.csv`.
    pub fn key(self) -> String {
        match self {
            Quantity::Mass => "mass_kg".to_owned(),
            Quantity::Radius => "workspace_radius_m".to_owned(),
            Quantity::Variable(variable) => variable.key().to_owned(),
            Quantity::Phi => "phi_deg".to_owned(),
            Quantity::Margin(constraint) => format!("margin_{}", constraint.id()),
            Quantity::Clearance => format!("value_{}", Constraint::Clearance.id()),
            Quantity::Violation => "violation".to_owned(),
        }
    }

    /// The quantity of a key.
    pub fn find(key: &str) -> Option<Quantity> {
        Self::all().into_iter().find(|quantity| quantity.key() == key)
    }

    /// Name for people, with its unit.
    pub fn title(self) -> String {
        match self {
            Quantity::Mass => "mass in motion [kg]".to_owned(),
            Quantity::Radius => "R_w [m]".to_owned(),
            Quantity::Variable(variable) => format!("{} [m]", variable.symbol()),
            Quantity::Phi => "φ_c [°]".to_owned(),
            Quantity::Margin(constraint) => format!("margin {}", constraint.id()),
            Quantity::Clearance => "clearance [m]".to_owned(),
            Quantity::Violation => "violation".to_owned(),
        }
    }

    /// Short name for the head of a narrow axis.
    pub fn short(self) -> String {
        match self {
            Quantity::Mass => "mass".to_owned(),
            Quantity::Radius => "R_w".to_owned(),
            Quantity::Variable(variable) => variable.symbol().to_owned(),
            Quantity::Phi => "φ_c".to_owned(),
            Quantity::Margin(Constraint::DeterminantSign) => "det A".to_owned(),
            Quantity::Margin(constraint) => constraint.id().to_owned(),
            Quantity::Clearance => "clearance".to_owned(),
            Quantity::Violation => "violation".to_owned(),
        }
    }

    /// Which way is better, where one is.
    pub fn better(self) -> Option<Better> {
        match self {
            Quantity::Mass | Quantity::Violation => Some(Better::Lower),
            Quantity::Radius | Quantity::Margin(_) | Quantity::Clearance => Some(Better::Higher),
            Quantity::Variable(_) | Quantity::Phi => None,
        }
    }

    /// Whether its differences are orders of magnitude.
    pub fn is_logarithmic(self) -> bool {
        matches!(self, Quantity::Mass | Quantity::Violation)
    }

    /// Its value of a stored design; not a number where there is none.
    pub fn of(self, row: &Row) -> f64 {
        match self {
            Quantity::Mass => row.mass,
            Quantity::Radius => row.radius,
            Quantity::Variable(variable) => row.design.values()[variable as usize],
            Quantity::Phi => row.phi.unwrap_or(f64::NAN),
            Quantity::Margin(constraint) => row.margins[constraint as usize].unwrap_or(f64::NAN),
            Quantity::Clearance => row.clearance.unwrap_or(f64::NAN),
            Quantity::Violation => row.violation,
        }
    }
}
