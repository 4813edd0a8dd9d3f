//! Which setting differs between two studies.

use toml::Table;

use super::Study;
use crate::settings::settings;

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
    /// Returns every setting in which another study differs, apart from names and how it is searched.
    pub fn differences(&self, other: &Study) -> Vec<SettingDifference> {
        let (Ok(ours), Ok(theirs)) = (Table::try_from(self), Table::try_from(other)) else {
            return Vec::new();
        };
        let of_search = |path: &str| is_of_search(path) && path != "architectures";
        let settings = settings().filter(|setting| !of_search(&setting.path()));
        let of_settings = settings.filter_map(|setting| {
            let values = [setting.value(&ours), setting.value(&theirs)];
            (values[0] != values[1]).then(|| SettingDifference {
                key: setting.path(),
                values: values.map(|value| value.map(|value| value.to_string())),
            })
        });
        let of_lists = [
            (
                "obstacles",
                self.obstacles.len(),
                other.obstacles.len(),
                self.obstacles != other.obstacles,
            ),
            (
                "room",
                usize::from(self.room.is_some()),
                usize::from(other.room.is_some()),
                self.room != other.room,
            ),
        ];
        let of_lists = of_lists.into_iter().filter(|(.., differs)| *differs);
        let of_lists = of_lists.map(|(key, ours, theirs, _)| SettingDifference {
            key: key.to_owned(),
            values: [ours, theirs].map(|count| (count > 0).then(|| format!("{count} stated"))),
        });
        of_settings.chain(of_lists).collect()
    }

    /// Returns the first setting by which another study is another search; `None` if the two differ in seed, budget and name at
    /// most.
    pub fn key_of_other_search(&self, other: &Study) -> Option<String> {
        self.first_difference(other, is_of_one_search)
    }

    /// Returns the first setting that makes another study another problem; `None` if designs of both can be compared:
    /// they are evaluated by the same model, within the same bounds, beside the same reference designs.
    pub fn differing_key(&self, other: &Study) -> Option<String> {
        self.first_difference(other, is_of_search)
    }

    fn first_difference(&self, other: &Study, may_differ: fn(&str) -> bool) -> Option<String> {
        let (Ok(ours), Ok(theirs)) = (Table::try_from(self), Table::try_from(other)) else {
            // A number beyond the range of TOML is not valid in a study.
            return (self != other).then(|| "optimizer".to_owned());
        };
        settings()
            .filter(|setting| setting.value(&ours) != setting.value(&theirs))
            .map(|setting| setting.path())
            .find(|path| !may_differ(path))
            .or_else(|| (self.obstacles != other.obstacles).then(|| "obstacles".to_owned()))
            .or_else(|| (self.room != other.room).then(|| "room".to_owned()))
            .or_else(|| (self.references != other.references).then(|| "references".to_owned()))
    }
}
