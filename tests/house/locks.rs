//! The lock files of the packages outside the workspace.

use super::sources::{manifest, read, root};

/// A lock file that names an earlier version of a crate of the workspace does not build with `--locked`.
#[test]
fn lock_files_name_the_version_of_the_workspace() {
    let workspace = manifest("");
    let version = workspace["workspace"]["package"]["version"]
        .as_str()
        .expect("a version");
    for (place, least) in [("Cargo.lock", 10), ("fuzz/Cargo.lock", 4), ("python/Cargo.lock", 4)] {
        let lock: toml::Table = read(&root().join(place)).parse().expect("a lock file");
        let packages = lock["package"].as_array().expect("packages");
        let ours: Vec<(&str, &str)> = packages
            .iter()
            .map(|package| (package["name"].as_str().expect("a name"), package))
            .filter(|(name, package)| name.starts_with("kinefront-") && package.get("source").is_none())
            .map(|(name, package)| (name, package["version"].as_str().expect("a version")))
            .filter(|(name, _)| {
                root()
                    .join("crates")
                    .join(name.trim_start_matches("kinefront-"))
                    .is_dir()
            })
            .collect();
        assert!(ours.len() >= least, "{place}: {ours:?}");
        for (name, found) in ours {
            assert_eq!(found, version, "{name} in {place}");
        }
    }
}
