//! The selected design, and what is known of it.

use std::sync::Arc;

use super::Session;
use crate::Known;
use crate::data::DesignOrigin;
use kinefront_scene::{Field, WorkspaceProof};
use kinefront_study::CertifiedWorkspace;

impl Session {
    /// Returns the evaluation of the selected design, if it is known.
    pub fn known(&self) -> Option<&Known> {
        let design = self.document().selected_design()?;
        let known = self.answer.known.as_ref();
        known.filter(|known| known.evaluation.design == design)
    }

    /// Returns what the front states about the workspace of the selected design, if it is a design of a certified front.
    pub fn certified(&self) -> Option<CertifiedWorkspace> {
        match self.document().selected.as_ref()?.origin {
            DesignOrigin::Evaluated(id) => self.front[self.place_on_front(id)?].certified,
            DesignOrigin::Wished(index) => self.document().wished.get(index)?.certified,
            _ => None,
        }
    }

    /// Returns the proof of the workspace of the selected design, once it is known.
    pub fn proof(&self) -> Option<&Arc<WorkspaceProof>> {
        let design = self.document().selected_design()?;
        self.answer.proof.as_ref().filter(|proof| proof.design == design)
    }

    /// Returns the fields that have values for the selected design, or all without one.
    pub fn fields(&self) -> Vec<Field> {
        match self.document().selected_design() {
            Some(design) => Field::of(self.model(), &design).collect(),
            None => Field::all().collect(),
        }
    }

    /// Returns the name of the selected design.
    pub fn selected_name(&self) -> Option<String> {
        let document = self.document();
        Some(match &document.selected.as_ref()?.origin {
            DesignOrigin::Evaluated(id) => format!("#{id}"),
            DesignOrigin::Modified { from: Some(id) } => format!("modified from #{id}"),
            DesignOrigin::Modified { from: None } => "modified".to_owned(),
            DesignOrigin::Kept(index) => document.kept.get(*index).map_or("kept", |kept| &kept.name).to_owned(),
            DesignOrigin::Wished(index) => document
                .wished
                .get(*index)
                .map_or("wish", |wished| &wished.name)
                .to_owned(),
            DesignOrigin::Reference(index) => self
                .references
                .get(*index)
                .map_or("reference", |reference| &reference.name)
                .to_owned(),
        })
    }

    /// Returns whether the selected design is a modified design that was not kept.
    pub fn is_modified(&self) -> bool {
        let selected = self.document().selected.as_ref();
        selected.is_some_and(|selected| matches!(selected.origin, DesignOrigin::Modified { .. }))
    }
}
