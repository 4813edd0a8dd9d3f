//! What is proved about the workspace of a design (docs/model.md, section 13.5).

use std::fmt;

use kinefront_model::certify::{Certificate, CertifyOptions, Verdict};

/// What is proved about the workspace of a design at its home orientation: bounds of its radius, or that a prescribed region holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CertifiedWorkspace {
    /// Radius \[m\] of a disc about the centre in which every pose is proved feasible; for a prescribed region, that of the largest
    /// disc within it if the whole region is proved, and otherwise 0.
    pub lower: f64,
    /// Distance from the centre \[m\] of a pose that is proved infeasible, if one was found.
    pub upper: Option<f64>,
    /// Whether the proof is complete: every pose of the prescribed region is feasible, or the bounds of the radius are as close as the
    /// tolerance asks, or the radius of the fine grid is proved.
    pub is_proved: bool,
    /// Whether the study prescribes the region.
    pub is_of_region: bool,
}

impl CertifiedWorkspace {
    /// The text of a proof that is complete.
    pub const PROVED: &str = "proved";
    /// The text of a proof that is not complete.
    pub const OPEN: &str = "open";

    /// Takes what a certificate proves of a claim.
    pub fn new(certificate: &Certificate, claim: &CertifyOptions) -> Self {
        let is_closed = !claim.is_of_region && certificate.is_closed(claim.tolerance);
        Self {
            lower: certificate.lower,
            upper: certificate.upper,
            is_proved: certificate.verdict == Verdict::Proved || is_closed,
            is_of_region: claim.is_of_region,
        }
    }

    /// The state of the proof in tables: `proved` or `open`.
    pub fn state(&self) -> &'static str {
        if self.is_proved { Self::PROVED } else { Self::OPEN }
    }

    /// Whether nothing is proved about the radius of a design, so that it has no workspace for certain.
    pub fn is_empty(&self) -> bool {
        !self.is_of_region && self.lower <= 0.0
    }
}

impl fmt::Display for CertifiedWorkspace {
    /// Writes the state of the proof and its bounds as a sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.state())?;
        match (self.is_of_region, self.is_proved, self.upper) {
            (true, true, _) => write!(f, "every pose of the region is feasible"),
            (true, false, None) => write!(
                f,
                "no infeasible pose of the region was found, and not every pose is proved feasible"
            ),
            (true, false, Some(upper)) => {
                write!(f, "a pose of the region at {upper:.5} m from its centre is infeasible")
            }
            (false, _, Some(upper)) => {
                write!(
                    f,
                    "every pose within {:.5} m is feasible, and one at {upper:.5} m is not",
                    self.lower
                )
            }
            (false, _, None) => {
                write!(
                    f,
                    "every pose within {:.5} m is feasible, and no infeasible pose was found",
                    self.lower
                )
            }
        }
    }
}
