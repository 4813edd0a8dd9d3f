//! What the documents and the sources say of each other.

use std::fs;

use super::sources::{files, root};

/// Headings of a document, `2.1 Geometry common to all` as `2.1`.
fn sections(document: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join(document)).expect("a document");
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let number = |line: &str| {
        line.trim_start_matches('#')
            .split_whitespace()
            .next()
            .map(str::to_owned)
    };
    headings.filter_map(number).collect()
}

/// Sources and tests refer to sections of the documentation that exist, and to nothing outside the repository.
#[test]
fn references_to_the_model_lead_to_its_sections() {
    let model = sections("docs/model.md");
    assert!(
        model.contains(&"4.3".to_owned()) && model.contains(&"12".to_owned()),
        "{model:?}"
    );
    let mut count = 0;
    for place in ["crates", "python", "src", "tests", "benches", "examples"] {
        for path in files(&root().join(place), "rs") {
            let text = fs::read_to_string(&path).expect("a source");
            if path.ends_with("house/documents.rs") {
                continue;
            }
            assert!(
                !text.contains("SPEC"),
                "{} refers to a document of others",
                path.display()
            );
            // A reference may be broken over two lines of a comment.
            let joined = text
                .replace("\n//! ", " ")
                .replace("\n/// ", " ")
                .replace("\n    /// ", " ");
            for rest in joined.split("docs/model.md, section ").skip(1) {
                let number: String = rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
                let number = number.trim_end_matches('.').to_owned();
                assert!(
                    model.contains(&number),
                    "{}: there is no section {number}",
                    path.display()
                );
                count += 1;
            }
        }
    }
    assert!(count > 20, "only {count} references");
}

/// Files that the documents name exist, equations are numbered without gaps, and links between documents lead somewhere.
#[test]
fn documents_refer_to_what_is_there() {
    let at_the_top = [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "SECURITY.md",
        "python/README.md",
    ]
    .map(str::to_owned);
    let in_docs = fs::read_dir(root().join("docs"))
        .expect("a folder")
        .filter_map(|entry| {
            let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
            name.ends_with(".md").then(|| format!("docs/{name}"))
        });
    let documents: Vec<String> = at_the_top.into_iter().chain(in_docs).collect();
    assert!(documents.len() > 8, "{documents:?}");
    for document in &documents {
        let path = root().join(document);
        let text = fs::read_to_string(&path).expect("a document");
        for rest in text.split("](").skip(1) {
            let link = rest.split([')', ' ']).next().unwrap_or_default();
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            if file.starts_with("http") {
                continue;
            }
            let target = if file.is_empty() {
                path.clone()
            } else {
                path.with_file_name("").join(file)
            };
            assert!(target.exists(), "{document} links to {link}");
            if !anchor.is_empty() {
                let slug = |line: &str| {
                    let kept = line.trim_start_matches('#').trim().to_lowercase();
                    let kept: String = kept
                        .chars()
                        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-'))
                        .collect();
                    kept.replace(' ', "-")
                };
                let target = fs::read_to_string(&target).expect("a document");
                let found = target
                    .lines()
                    .filter(|line| line.starts_with('#'))
                    .any(|line| slug(line) == anchor);
                assert!(found, "{document} links to {link}, which has no such heading");
            }
        }
        for word in text.split('`').skip(1).step_by(2) {
            let is_file = word.contains('/')
                && [".rs", ".md", ".json", ".py", ".toml"]
                    .iter()
                    .any(|end| word.ends_with(end));
            let is_ours = ["crates/", "src/", "tests/", "docs/", "benches/", "assets/"]
                .iter()
                .any(|start| word.starts_with(start));
            if is_file && is_ours && !word.contains('*') {
                assert!(root().join(word).exists(), "{document} names {word}");
            }
        }
    }
    let model = fs::read_to_string(root().join("docs/model.md")).expect("the model");
    let tags: Vec<usize> = model
        .split("\\tag{")
        .skip(1)
        .filter_map(|rest| rest.split('}').next()?.parse().ok())
        .collect();
    assert_eq!(tags, (1..=tags.len()).collect::<Vec<_>>());
    assert!(tags.len() > 30);
}

/// The contract lists the columns of the tables in their order.
#[test]
fn the_interfaces_list_every_column_in_order() {
    let text = fs::read_to_string(root().join("docs/interfaces.md")).expect("the interfaces");
    let mut rest = text.as_str();
    for column in kinefront_study::Column::of_front(&kinefront_study::Study::default()) {
        let name = format!("`{}`", column.name());
        let found = rest
            .find(&name)
            .unwrap_or_else(|| panic!("{name} is missing, or not in its place"));
        rest = &rest[found..];
    }
}
