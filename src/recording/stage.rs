//! A scene that changes in place: what is no longer drawn disappears.
//!
//! Its rows are static, so that a viewer keeps only the last of each. Static data cannot be cleared; what a drawing leaves
//! out of what stood there before is overwritten with nothing.

use std::collections::BTreeMap;

use rerun::{AsComponents, ComponentDescriptor, SerializedComponentBatch};

use super::writer::{ALWAYS, RecordingError, Writer};

/// What stands below one path: for each entity its components, empty.
type Standing = BTreeMap<String, BTreeMap<ComponentDescriptor, SerializedComponentBatch>>;

/// Entities that are drawn together and replaced together.
#[derive(Default)]
pub(super) struct Stage {
    standing: Standing,
}

impl Stage {
    /// Replaces what stands here by `rows`.
    pub(super) fn show(&mut self, writer: &Writer, rows: Rows) -> Result<(), RecordingError> {
        let mut drawn = Standing::new();
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
