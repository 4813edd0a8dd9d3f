//! Quantities of a design that can be shown on an axis or in a column, or limited by a filter.

use super::Row;
use kinefront_model::evaluation::Constraint;
use kinefront_model::mechanism::{DESIGN_VARIABLES, DesignVariable};

/// A numerical quantity of a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Mass in motion.
    Mass,
    /// Workspace radius `R_w`.
    Radius,
    /// One of the five dimensions.
    DesignVariable(DesignVariable),
    /// Home orientation `φ_c`.
    Phi,
    /// Relative margin of a constraint.
    Margin(Constraint),
    /// Smallest clearance between members that are not joined, whether or not the study requires a clearance.
    Clearance,
    /// Constraint violation; 0 for a feasible design.
    Violation,
}

/// Direction in which a quantity is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// Smaller values are better.
    Lower,
    /// Larger values are better.
    Higher,
}

impl Quantity {
    /// Returns all quantities: objectives, variables, margins, then the others.
    pub fn all() -> Vec<Quantity> {
        let mut all = vec![Quantity::Mass, Quantity::Radius];
        all.extend(DESIGN_VARIABLES.map(Quantity::DesignVariable));
        all.extend(Constraint::ALL.map(Quantity::Margin));
        all.extend([Quantity::Clearance, Quantity::Phi, Quantity::Violation]);
        all
    }

    /// Returns the name in tables and files, which is that of the column of `designs.csv`.
    pub fn key(self) -> String {
        match self {
            Quantity::Mass => "mass_kg".to_owned(),
            Quantity::Radius => "workspace_radius_m".to_owned(),
            Quantity::DesignVariable(variable) => variable.key().to_owned(),
            Quantity::Phi => "phi_deg".to_owned(),
            Quantity::Margin(constraint) => format!("margin_{}", constraint.id()),
            Quantity::Clearance => format!("value_{}", Constraint::Clearance.id()),
            Quantity::Violation => "violation".to_owned(),
        }
    }

    /// Returns the quantity with a given key.
    pub fn find(key: &str) -> Option<Quantity> {
        Self::all().into_iter().find(|quantity| quantity.key() == key)
    }

    /// Returns the name to display, with the unit.
    pub fn title(self) -> String {
        match self {
            Quantity::Mass => "mass in motion [kg]".to_owned(),
            Quantity::Radius => "R_w [m]".to_owned(),
            Quantity::DesignVariable(variable) => format!("{} [m]", variable.symbol()),
            Quantity::Phi => "φ_c [°]".to_owned(),
            Quantity::Margin(constraint) => format!("margin {}", constraint.id()),
            Quantity::Clearance => "clearance [m]".to_owned(),
            Quantity::Violation => "violation".to_owned(),
        }
    }

    /// Returns a short name for the heading of a narrow axis.
    pub fn short(self) -> String {
        match self {
            Quantity::Mass => "mass".to_owned(),
            Quantity::Radius => "R_w".to_owned(),
            Quantity::DesignVariable(variable) => variable.symbol().to_owned(),
            Quantity::Phi => "φ_c".to_owned(),
            Quantity::Margin(Constraint::DeterminantSign) => "det A".to_owned(),
            Quantity::Margin(constraint) => constraint.id().to_owned(),
            Quantity::Clearance => "clearance".to_owned(),
            Quantity::Violation => "violation".to_owned(),
        }
    }

    /// Returns the direction in which the quantity is better, if it has one.
    pub fn better(self) -> Option<Better> {
        match self {
            Quantity::Mass | Quantity::Violation => Some(Better::Lower),
            Quantity::Radius | Quantity::Margin(_) | Quantity::Clearance => Some(Better::Higher),
            Quantity::DesignVariable(_) | Quantity::Phi => None,
        }
    }

    /// Returns whether the values differ by orders of magnitude, so that a logarithmic axis suits them.
    pub fn is_logarithmic(self) -> bool {
        matches!(self, Quantity::Mass | Quantity::Violation)
    }

    /// Returns the value of a stored design; NaN if the design has none.
    pub fn of(self, row: &Row) -> f64 {
        match self {
            Quantity::Mass => row.mass,
            Quantity::Radius => row.radius,
            Quantity::DesignVariable(variable) => row.design.values()[variable as usize],
            Quantity::Phi => row.phi.unwrap_or(f64::NAN),
            Quantity::Margin(constraint) => row.margins[constraint as usize].unwrap_or(f64::NAN),
            Quantity::Clearance => row.clearance.unwrap_or(f64::NAN),
            Quantity::Violation => row.violation,
        }
    }
}
