//! Which setting differs between two studies.

use toml::Table;

use super::Study;
use crate::settings::{Bounds, settings};
use kinefront_model::mechanism::{Architecture, DesignVariable, FURTHER_VARIABLES};

/// Settings by which two runs of one problem may differ: names, architectures, the grid of the search, and the search itself.
fn is_of_search(path: &str) -> bool {
    let names = ["name", "description", "architectures"];
    let sections = ["grid.reference.", "optimizer.", "hypervolume."];
    names.contains(&path) || sections.iter().any(|section| path.starts_with(section))
}

/// Settings by which two runs of one search may differ, whose designs are those of one problem, found by one algorithm.
fn is_of_one_search(path: &str) -> bool {
    const OWN: [&str; 6] = [
        "name",
        "description",
        "optimizer.seed",
        "optimizer.evaluations",
        "optimizer.threads",
        "optimizer.time_limit_s",
    ];
    OWN.contains(&path) || path.starts_with("optimizer.stagnation.")
}

/// A setting in which two studies differ, with its value in each; absent where a study does not state it and there is no default.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingDifference {
    /// The key with its sections.
    pub key: String,
    /// Its values.
    pub values: [Option<String>; 2],
}

impl Study {
    /// Returns every setting in which another study differs, apart from names, how it is searched, and the designs that it refers to.
    pub fn differences(&self, other: &Study) -> Vec<SettingDifference> {
        let is_told = |key: &str| key == "architectures" || key != "references" && !is_of_search(key);
        let mut differences = self.all_differences(other).unwrap_or_default();
        differences.retain(|difference| is_told(&difference.key));
        differences
    }

    /// Returns the first setting by which another study is another search; `None` if the two differ in seed, budget and name at
    /// most.
    pub fn key_of_other_search(&self, other: &Study) -> Option<String> {
        self.first_difference(other, is_of_one_search)
    }

    /// Returns the first setting that makes another study another problem; `None` if designs of both can be compared:
    /// they are evaluated by the same model, within the same bounds, beside the same reference designs.
    pub fn differing_key(&self, other: &Study) -> Option<String> {
        self.first_difference(other, |key| is_of_search(key) || self.is_bound_of_one(other, key))
    }

    /// Adds the architectures of another study of the same problem, and the bounds of variables that this study's architectures lack.
    pub fn join(&mut self, other: &Study) {
        self.bounds.add_missing(other.bounds.clone());
        let both = [&*self, other].map(|study| study.architectures.clone()).concat();
        let every = Architecture::ALL.iter().copied();
        self.architectures = every.filter(|found| both.contains(found)).collect();
    }

    /// Whether a key is that of the bounds of a variable that the architectures of one of the studies do not have.
    fn is_bound_of_one(&self, other: &Study, key: &str) -> bool {
        let variable = |variable: &DesignVariable| key.strip_prefix("bounds.") == Some(&Bounds::key(*variable));
        let Some(variable) = FURTHER_VARIABLES.into_iter().find(variable) else {
            return false;
        };
        let has = |study: &Study| study.architectures.iter().any(|found| found.has(variable));
        !has(self) || !has(other)
    }

    fn first_difference(&self, other: &Study, may_differ: impl Fn(&str) -> bool) -> Option<String> {
        let Some(differences) = self.all_differences(other) else {
            // A number beyond the range of TOML is not valid in a study.
            return (self != other).then(|| "optimizer".to_owned());
        };
        let mut keys = differences.into_iter().map(|difference| difference.key);
        keys.find(|key| !may_differ(key))
    }

    /// Returns every setting in which two studies differ, then the sections that hold lists; `None` if one of them is not TOML.
    fn all_differences(&self, other: &Study) -> Option<Vec<SettingDifference>> {
        let tables = [Table::try_from(self).ok()?, Table::try_from(other).ok()?];
        let of_settings = settings().filter_map(|setting| {
            let values = tables.each_ref().map(|table| setting.value(table));
            (values[0] != values[1]).then(|| SettingDifference {
                key: setting.path(),
                values: values.map(|value| value.map(toml::Value::to_string)),
            })
        });
        let both = [self, other];
        let of_lists = [
            difference_of_lists("obstacles", both.map(|study| study.obstacles.as_slice())),
            difference_of_lists("room", both.map(|study| study.room.as_slice())),
            difference_of_lists("references", both.map(|study| study.references.as_slice())),
        ];
        Some(of_settings.chain(of_lists.into_iter().flatten()).collect())
    }
}

/// Returns the difference of two lists, if there is one, by the numbers of their entries.
fn difference_of_lists<T: PartialEq>(key: &str, lists: [&[T]; 2]) -> Option<SettingDifference> {
    let stated = |list: &[T]| (!list.is_empty()).then(|| format!("{} stated", list.len()));
    (lists[0] != lists[1]).then(|| SettingDifference {
        key: key.to_owned(),
        values: lists.map(stated),
    })
}
