//! The filter that applies to all panels, and its text format.

use kinefront_study::Column;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

use super::{FrontEntry, Store};
use kinefront_model::evaluation::QuantitySet;
use kinefront_model::mechanism::Architecture;

/// Criteria for designs; those that do not pass the filter are dimmed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Filter {
    /// Whether only feasible designs pass.
    pub feasible_only: bool,
    /// Architectures whose designs do not pass.
    pub hidden: Vec<Architecture>,
    /// Permitted range of a quantity, by the quantity's key; both ends are included.
    pub ranges: BTreeMap<String, [f64; 2]>,
}

/// A filter prepared for testing many designs.
pub struct PreparedFilter<'a> {
    store: &'a Store,
    feasible_only: bool,
    hidden: Vec<Architecture>,
    /// A quantity with its values in the store and the range that passes.
    ranges: Vec<(Column, &'a [f64], [f64; 2])>,
}

impl Filter {
    /// Returns whether the filter has no criterion, so that every design passes.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the range of a quantity, if the filter has one.
    pub fn range(&self, quantity: Column) -> Option<[f64; 2]> {
        self.ranges.get(&*quantity.name()).copied()
    }

    /// Sets or removes the range of a quantity.
    pub fn set_range(&mut self, quantity: Column, range: Option<[f64; 2]>) {
        match range {
            Some([low, high]) => self
                .ranges
                .insert(quantity.name().into_owned(), [low.min(high), low.max(high)]),
            None => self.ranges.remove(&*quantity.name()),
        };
    }

    /// Prepares the filter for the designs of a store.
    pub fn prepare<'a>(&self, store: &'a Store) -> PreparedFilter<'a> {
        PreparedFilter {
            store,
            feasible_only: self.feasible_only,
            hidden: self.hidden.clone(),
            ranges: self
                .ranges
                .iter()
                .filter_map(|(key, range)| {
                    let column = Column::find_quantity(key)?;
                    Some((column, store.column(column), *range))
                })
                .collect(),
        }
    }

    /// Returns the filter as TOML.
    pub fn to_text(&self) -> String {
        // Every filter can be written as TOML, so this does not fail.
        toml::to_string(self).unwrap_or_default()
    }

    /// Reads a filter from TOML.
    ///
    /// # Errors
    /// Returns a message that says what is wrong with the text and what would be right.
    pub fn parse(text: &str) -> Result<Self, FilterError> {
        let filter: Filter = toml::from_str(text)?;
        for (key, [low, high]) in &filter.ranges {
            if Column::find_quantity(key).is_none() {
                return Err(FilterError::UnknownQuantity(key.clone()));
            }
            if low.is_nan() || high.is_nan() || low > high {
                return Err(FilterError::Range {
                    key: key.clone(),
                    range: [*low, *high],
                });
            }
        }
        Ok(filter)
    }
}

/// Why a text is not a filter.
#[derive(Debug, thiserror::Error)]
pub enum FilterError {
    /// The text is not TOML, or a key is unknown or of the wrong type.
    #[error("not a filter: {}", .0.message())]
    Toml(#[from] toml::de::Error),
    /// A range of a quantity that designs do not have.
    #[error("the filter has a range of the unknown quantity `{0}`; expected one of {known}", known = quantity_names())]
    UnknownQuantity(String),
    /// A range that is not two numbers, the lower one first.
    #[error("the range of `{key}` is {range:?}; expected two numbers, the lower one first")]
    Range {
        /// Name of the quantity.
        key: String,
        /// The range.
        range: [f64; 2],
    },
}

fn quantity_names() -> String {
    let names: Vec<_> = Column::quantities(QuantitySet::all()).map(Column::name).collect();
    names.join(", ")
}

impl PreparedFilter<'_> {
    /// Returns whether a design of the front passes the filter; a design with thicker bars is not one of the search.
    pub fn passes_entry(&self, entry: &FrontEntry) -> bool {
        if entry.id < self.store.len() {
            return self.passes(entry.id);
        }
        let row = &entry.row;
        (!self.feasible_only || row.is_feasible())
            && !self.hidden.contains(&row.design.architecture())
            && self.ranges.iter().all(|(column, _, [low, high])| {
                let number = row.number(*column);
                number.is_some_and(|number| (*low..=*high).contains(&number))
            })
    }

    /// Returns whether design `id` exists and passes the filter.
    pub fn passes(&self, id: usize) -> bool {
        id < self.store.len()
            && (!self.feasible_only || self.store.is_feasible(id))
            && (self.hidden.is_empty() || !self.hidden.contains(&self.store.architecture(id)))
            && self
                .ranges
                .iter()
                .all(|(_, values, [low, high])| values.get(id).is_some_and(|value| (*low..=*high).contains(value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kinefront_model::evaluation::Quantity;
    use kinefront_model::mechanism::DesignVariable;

    #[test]
    fn a_filter_reads_what_it_writes() {
        let mut filter = Filter {
            feasible_only: true,
            hidden: vec![Architecture::ALL[1]],
            ranges: BTreeMap::new(),
        };
        let mass = Column::Quantity(Quantity::Mass);
        filter.set_range(mass, Some([10.0, 2.5]));
        filter.set_range(Column::Dimension(DesignVariable::LinkLength), Some([0.5, 1.0 / 3.0]));
        assert_eq!(filter.range(mass), Some([2.5, 10.0]));
        assert_eq!(Filter::parse(&filter.to_text()).expect("a filter"), filter);
    }

    #[test]
    fn a_wrong_filter_is_told() {
        let unknown = Filter::parse("[ranges]\nweight = [0.0, 1.0]")
            .expect_err("unknown")
            .to_string();
        assert!(unknown.contains("`weight`") && unknown.contains("mass_kg"), "{unknown}");
        assert!(Filter::parse("[ranges]\nmass_kg = [2.0, 1.0]").is_err());
        assert!(Filter::parse("3-PRR R=1").is_err());
    }
}
