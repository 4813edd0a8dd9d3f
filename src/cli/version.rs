//! What `kinefront --version` prints.

use std::sync::LazyLock;

/// Commit from which the program was built, where the script that builds the archives states it.
const COMMIT: Option<&str> = option_env!("KINEFRONT_COMMIT");

/// Returns the version, the commit, and whether the program has the window.
pub fn version() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(|| {
        let build = match cfg!(feature = "explorer") {
            true => "with the window",
            false => "without a window",
        };
        let commit = COMMIT.unwrap_or("built from source");
        format!("{} ({commit}, {build})", env!("CARGO_PKG_VERSION"))
    });
    &TEXT
}
