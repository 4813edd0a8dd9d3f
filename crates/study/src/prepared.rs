//! A study that is ready to evaluate designs.

use crate::Study;
use kinefront_model::evaluation::Model;
use kinefront_model::workspace::GridError;

/// A study with its model. The two belong together: the model follows from the study alone.
#[derive(Debug, Clone)]
pub struct PreparedStudy {
    study: Study,
    model: Model,
}

/// Two prepared studies are equal if their studies are.
impl PartialEq for PreparedStudy {
    fn eq(&self, other: &Self) -> bool {
        self.study == other.study
    }
}

impl PreparedStudy {
    /// Prepares a study.
    ///
    /// # Errors
    /// [`GridError`] if a grid of the study is invalid, which [`Study::faults`] tells beforehand.
    pub fn new(study: Study) -> Result<Self, GridError> {
        Ok(Self {
            model: study.model()?,
            study,
        })
    }

    /// Makes evaluations contain every quantity, whether the study asks for it or not.
    #[must_use]
    pub fn with_all_quantities(self) -> Self {
        Self {
            model: self.model.with_all_quantities(),
            ..self
        }
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The model with which its designs are evaluated.
    pub fn model(&self) -> &Model {
        &self.model
    }
}
