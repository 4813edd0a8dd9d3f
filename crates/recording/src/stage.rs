//! A scene that is updated in place: entities that are no longer drawn disappear.
//!
//! The rows are static, so a viewer keeps only the last row of each entity. Static data cannot be cleared, so
//! components that the new drawing no longer has are overwritten with empty ones.

use std::collections::BTreeMap;

use rerun::{AsComponents, ComponentDescriptor, SerializedComponentBatch};

use super::writer::{ALWAYS, RecordingError, RecordingWriter};

/// The entities that are shown below one path, each with empty batches of its components.
type DrawnComponents = BTreeMap<String, BTreeMap<ComponentDescriptor, SerializedComponentBatch>>;

/// Entities that are drawn together and replaced together.
#[derive(Default)]
pub(super) struct Stage {
    standing: DrawnComponents,
}

impl Stage {
    /// Replaces the entities that are shown by `rows`.
    pub(super) fn show(&mut self, writer: &RecordingWriter, rows: Rows) -> Result<(), RecordingError> {
        let mut drawn = DrawnComponents::new();
        for (entity, mut batches) in rows.0 {
            let known: BTreeMap<ComponentDescriptor, SerializedComponentBatch> = batches
                .iter()
                .map(|batch| {
                    let nothing = SerializedComponentBatch::new(batch.array.slice(0, 0), batch.descriptor.clone());
                    (batch.descriptor.clone(), nothing)
                })
                .collect();
            if let Some(before) = self.standing.remove(&entity) {
                batches.extend(
                    before
                        .into_iter()
                        .filter(|(name, _)| !known.contains_key(name))
                        .map(|(_, batch)| batch),
                );
            }
            writer.batches(&entity, ALWAYS, batches)?;
            drawn.insert(entity, known);
        }
        for (entity, components) in std::mem::replace(&mut self.standing, drawn) {
            writer.batches(&entity, ALWAYS, components.into_values().collect())?;
        }
        Ok(())
    }
}

/// Rows to be shown at once.
#[derive(Default)]
pub(super) struct Rows(Vec<(String, Vec<SerializedComponentBatch>)>);

impl Rows {
    pub(super) fn push(&mut self, entity: &str, archetype: &dyn AsComponents) {
        self.0.push((entity.to_owned(), archetype.as_serialized_batches()));
    }
}
