//! Frequencies, vibrations and errors of the selected design at its pose.

use std::sync::Arc;

use super::Session;
use crate::threads::StudyOfRun;
use kinefront_model::dynamics::DynamicsReport;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_scene::{BentBar, Vibrations};
use kinefront_study::{DriveSection, JointSection, PayloadSection, Study, ToleranceSection};

/// A vibration that is shown, to a scale that can be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShownVibration {
    /// Place of the mode, from the lowest frequency.
    pub mode: usize,
    /// Displacement of the point that moves most, as a share of `R`; negative in the other half of the vibration.
    pub share: f64,
}

/// What is known of a design at a pose, with the payload, the drives, the joints and the tolerances of the study being edited.
#[derive(Debug, Clone)]
pub struct PoseDynamics {
    asked: Asked,
    /// Frequencies, masses and errors; `None` at a singular or unreachable pose.
    pub report: Option<DynamicsReport>,
    /// Lowest frequencies of the frame of finite elements, in the plane and out of it \[Hz\]; `None` also on rails that bend.
    pub frame_frequencies: Option<[f64; 2]>,
    /// The vibrations; `None` also on rails that bend.
    pub vibrations: Option<Arc<Vibrations>>,
}

/// What that depends on.
#[derive(Debug, Clone, PartialEq)]
struct Asked {
    study: StudyOfRun,
    payload: PayloadSection,
    drives: DriveSection,
    joints: JointSection,
    tolerances: ToleranceSection,
    design: Design,
    pose: Pose,
}

impl Asked {
    fn answered(self) -> PoseDynamics {
        let study = Study {
            payload: self.payload.clone(),
            drives: self.drives.clone(),
            joints: self.joints.clone(),
            tolerances: self.tolerances.clone(),
            ..self.study.0.study().clone()
        };
        let (mut report, mut vibrations, mut frame_frequencies) = (None, None, None);
        if let Ok(model) = study.model()
            && let Ok(Some(posed)) = model.posed(&self.design).dynamics_at(&self.pose)
            && let Some(found) = posed.report()
        {
            vibrations = Vibrations::new(&model, &self.design, &posed, &found).map(Arc::new);
            frame_frequencies = posed.frame_frequencies();
            report = Some(found);
        }
        PoseDynamics {
            asked: self,
            report,
            frame_frequencies,
            vibrations,
        }
    }
}

impl Session {
    /// Returns what is known of the selected design at its pose; `None` without a design.
    pub fn pose_dynamics(&mut self) -> Option<&PoseDynamics> {
        let edited = self.editor.study();
        let asked = Asked {
            study: StudyOfRun(self.prepared()),
            payload: edited.payload.clone(),
            drives: edited.drives.clone(),
            joints: edited.joints.clone(),
            tolerances: edited.tolerances.clone(),
            design: self.known()?.evaluation.design,
            pose: self.pose()?,
        };
        if self.pose_dynamics.as_ref().is_none_or(|known| known.asked != asked) {
            self.pose_dynamics = Some(asked.answered());
        }
        self.pose_dynamics.as_ref()
    }

    /// Returns the bars of the selected design as they bend in the vibration that is shown; none if none is shown.
    pub(super) fn bent(&mut self) -> Arc<Vec<BentBar>> {
        let bent = self.view.vibration.and_then(|shown| {
            let known = self.pose_dynamics()?;
            let amplitude = shown.share * known.asked.design.base_radius();
            Some(known.vibrations.as_ref()?.bent(shown.mode, amplitude))
        });
        Arc::new(bent.unwrap_or_default())
    }
}
