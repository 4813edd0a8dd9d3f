//! What is proved about the workspace radius of a design (docs/model.md, section 13.5).

use std::fmt;

use kinefront_model::certify::{Certificate, Verdict};

/// Bounds of the workspace radius at the home orientation of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CertifiedRadius {
    /// Radius \[m\] of a disc in which every pose is proved feasible.
    pub lower: f64,
    /// Distance \[m\] of a pose that is proved infeasible, if one was found.
    pub upper: Option<f64>,
    /// Whether the proof is complete: the bounds are as close as the tolerance asks, or the radius of the fine grid is proved.
    pub is_proved: bool,
}

impl CertifiedRadius {
    /// The text of a proof that is complete.
    pub const PROVED: &str = "proved";
    /// The text of a proof that is not complete.
    pub const OPEN: &str = "open";

    /// Takes the bounds of a certificate with a tolerance.
    pub fn new(certificate: &Certificate, tolerance: f64) -> Self {
        Self {
            lower: certificate.lower,
            upper: certificate.upper,
            is_proved: certificate.verdict == Verdict::Proved || certificate.is_closed(tolerance),
        }
    }

    /// The state of the proof in tables: `proved` or `open`.
    pub fn state(&self) -> &'static str {
        if self.is_proved { Self::PROVED } else { Self::OPEN }
    }
}

impl fmt::Display for CertifiedRadius {
    /// Writes the state of the proof and its bounds as a sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: every pose within {:.5} m is feasible", self.state(), self.lower)?;
        match self.upper {
            Some(upper) => write!(f, ", and one at {upper:.5} m is not"),
            None => write!(f, ", and no infeasible pose was found"),
        }
    }
}
