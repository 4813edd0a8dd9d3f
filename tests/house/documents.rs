//! What the documents and the sources say of each other.

use super::sources::{files, read, root};

/// Headings of a document, `2.1 Geometry common to all` as `2.1`.
fn sections(document: &str) -> Vec<String> {
    let text = read(&root().join(document));
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
            let text = read(&path);
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

/// The documents that users and contributors read.
fn documents() -> Vec<String> {
    let at_the_top = "README.md ARCHITECTURE.md CONTRIBUTING.md SECURITY.md python/README.md".split(' ');
    let folder = root().join("docs");
    let in_docs = files(&folder, "md")
        .into_iter()
        .filter(|path| path.parent() == Some(folder.as_path()));
    let in_docs = in_docs.map(|path| {
        let path = path.strip_prefix(root()).expect("a file of the repository");
        path.to_string_lossy().into_owned()
    });
    at_the_top.map(str::to_owned).chain(in_docs).collect()
}

/// The anchor by which a link leads to a heading.
fn anchor_of(heading: &str) -> String {
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    let kept: String = text
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-'))
        .collect();
    kept.replace(' ', "-")
}

/// Links between documents lead to a file, and to a heading that it has.
#[test]
fn links_of_the_documents_lead_somewhere() {
    let documents = documents();
    assert!(documents.len() > 8, "{documents:?}");
    for document in &documents {
        let path = root().join(document);
        let text = read(&path);
        for rest in text.split("](").skip(1) {
            let link = rest.split([')', ' ']).next().unwrap_or_default();
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            if file.starts_with("http") {
                continue;
            }
            let target = match file {
                "" => path.clone(),
                file => path.with_file_name("").join(file),
            };
            assert!(target.exists(), "{document} links to {link}");
            if !anchor.is_empty() {
                let target = read(&target);
                let mut headings = target.lines().filter(|line| line.starts_with('#'));
                let has_heading = headings.any(|line| anchor_of(line) == anchor);
                assert!(has_heading, "{document} links to {link}, which has no such heading");
            }
        }
    }
}

/// Files of the repository that the documents name exist.
#[test]
fn documents_refer_to_what_is_there() {
    for document in documents() {
        for word in read(&root().join(&document)).split('`').skip(1).step_by(2) {
            let is_file = [".rs", ".md", ".json", ".py", ".toml"]
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
}

/// Equations are numbered without gaps.
#[test]
fn equations_are_numbered_in_order() {
    let model = read(&root().join("docs/model.md"));
    let tags = model.split("\\tag{").skip(1);
    let tags: Vec<usize> = tags.filter_map(|rest| rest.split('}').next()?.parse().ok()).collect();
    assert_eq!(tags, (1..=tags.len()).collect::<Vec<_>>());
    assert!(tags.len() > 30);
}

/// The contract lists the columns of the tables in their order.
#[test]
fn the_interfaces_list_every_column_in_order() {
    let text = read(&root().join("docs/interfaces.md"));
    let mut rest = text.as_str();
    for column in kinefront_study::Column::of_front(&kinefront_study::Study::default()) {
        let name = format!("`{}`", column.name());
        let found = rest
            .find(&name)
            .unwrap_or_else(|| panic!("{name} is missing, or not in its place"));
        rest = &rest[found..];
    }
}
