//! Who uses whom: what the sources import, compared with the tables of ARCHITECTURE.md.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::Visit;

use super::sources::{dependencies, files, read, root};

/// The folders of sources, each of one crate.
const CRATES: [&str; 12] = [
    "crates/explorer/src",
    "crates/export/src",
    "crates/model/src",
    "crates/optimize/src",
    "crates/optimum/src",
    "crates/recording/src",
    "crates/report/src",
    "crates/scene/src",
    "crates/study/src",
    "crates/testkit/src",
    "python/src",
    "src",
];

/// Names from the root of a crate to a module or to an item in one.
type ItemPath = Vec<String>;

/// What a module imports and hands on.
#[derive(Default)]
struct Module {
    file: PathBuf,
    /// Names that it hands on from other modules.
    handed_on: BTreeMap<String, ItemPath>,
    /// Modules all of whose names it hands on.
    globs: Vec<ItemPath>,
    /// What it imports or names.
    used: BTreeSet<ItemPath>,
}

/// The modules of a crate by their paths.
struct Crate {
    modules: BTreeMap<ItemPath, Module>,
}

impl Crate {
    fn read(folder: &str) -> Self {
        let folder = root().join(folder);
        let mut modules = BTreeMap::new();
        for file in files(&folder, "rs") {
            let relative = file
                .strip_prefix(&folder)
                .expect("a file of the folder")
                .with_extension("");
            let names = relative.iter().map(|name| name.to_string_lossy().into_owned());
            let mut path: ItemPath = names.collect();
            if path
                .last()
                .is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str()))
            {
                path.pop();
            }
            let parsed = syn::parse_file(&read(&file)).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            let mut reader = Reader {
                modules: &mut modules,
                file: &file,
                path,
            };
            reader.module().file.clone_from(&file);
            reader.visit_file(&parsed);
        }
        Self { modules }
    }

    /// The module that defines an item, behind all modules that hand it on; `None` for what is not of this crate.
    fn home_of(&self, path: &[String]) -> Option<&ItemPath> {
        let mut at: ItemPath = Vec::new();
        for (place, name) in path.iter().enumerate() {
            let inner: ItemPath = at.iter().chain([name]).cloned().collect();
            if self.modules.contains_key(&inner) {
                at = inner;
                continue;
            }
            let (module, rest) = (&self.modules[&at], &path[place + 1..]);
            // What a module hands on of another crate has no home in this one.
            let origin = module.handed_on.get(name).filter(|origin| **origin != inner);
            if let Some(origin) = origin {
                let origin: ItemPath = origin.iter().chain(rest).cloned().collect();
                return self.home_of(&origin);
            }
            break;
        }
        self.modules.get_key_value(&at).map(|(path, _)| path)
    }

    /// The pairs of modules of which the first uses an item that the second defines.
    fn edges(&self) -> BTreeSet<(&ItemPath, &ItemPath)> {
        let uses = self.modules.iter().flat_map(|(path, module)| {
            let homes = module.used.iter().filter_map(|used| self.home_of(used));
            homes.map(move |home| (path, home))
        });
        uses.filter(|(from, to)| self.modules[*from].file != self.modules[*to].file)
            .collect()
    }
}

/// Notes the imports of a file.
struct Reader<'a> {
    modules: &'a mut BTreeMap<ItemPath, Module>,
    file: &'a Path,
    path: ItemPath,
}

impl Reader<'_> {
    fn module(&mut self) -> &mut Module {
        let module = self.modules.entry(self.path.clone()).or_default();
        module.file = self.file.to_owned();
        module
    }

    /// Resolves `crate`, `self` and `super`; a path that begins otherwise may begin with a module below.
    fn absolute(&self, path: &[String]) -> ItemPath {
        let mut base = self.path.clone();
        let mut rest = path;
        match path.first().map(String::as_str) {
            Some("crate") => {
                base.clear();
                rest = &path[1..];
            }
            Some("self") => rest = &path[1..],
            _ => {}
        }
        while rest.first().is_some_and(|name| name == "super") {
            base.pop();
            rest = &rest[1..];
        }
        base.extend(rest.iter().cloned());
        base
    }

    fn imports(&mut self, tree: &syn::UseTree, before: &[String], is_private: bool) {
        let mut path = before.to_vec();
        match tree {
            syn::UseTree::Path(inner) => {
                path.push(inner.ident.to_string());
                self.imports(&inner.tree, &path, is_private);
            }
            syn::UseTree::Group(group) => group
                .items
                .iter()
                .for_each(|tree| self.imports(tree, &path, is_private)),
            syn::UseTree::Glob(_) => {
                let path = self.absolute(&path);
                if is_private {
                    self.module().used.insert(path);
                } else {
                    self.module().globs.push(path);
                }
            }
            syn::UseTree::Name(syn::UseName { ident }) => self.import(path, &ident.to_string(), None, is_private),
            syn::UseTree::Rename(renamed) => {
                let name = renamed.rename.to_string();
                self.import(path, &renamed.ident.to_string(), Some(name), is_private);
            }
        }
    }

    fn import(&mut self, mut path: ItemPath, name: &str, renamed: Option<String>, is_private: bool) {
        if name != "self" {
            path.push(name.to_owned());
        }
        let absolute = self.absolute(&path);
        if is_private {
            self.module().used.insert(absolute);
        } else {
            let name = renamed.unwrap_or_else(|| path.last().cloned().unwrap_or_default());
            self.module().handed_on.insert(name, absolute);
        }
    }
}

fn is_of_tests(attributes: &[syn::Attribute]) -> bool {
    let is_test = |attribute: &syn::Attribute| {
        let list = attribute.meta.require_list();
        attribute.path().is_ident("cfg") && list.is_ok_and(|list| list.tokens.to_string() == "test")
    };
    attributes.iter().any(is_test)
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        if module.content.is_some() && !is_of_tests(&module.attrs) {
            self.path.push(module.ident.to_string());
            self.module();
            syn::visit::visit_item_mod(self, module);
            self.path.pop();
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        let is_private = matches!(item.vis, syn::Visibility::Inherited);
        self.imports(&item.tree, &[], is_private);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if names.len() > 1 && ["crate", "self", "super"].contains(&names[0].as_str()) {
            let absolute = self.absolute(&names);
            self.module().used.insert(absolute);
        }
        syn::visit::visit_path(self, path);
    }
}

/// A table of ARCHITECTURE.md below a heading `| {subject} | purpose | may use |`: the names in the first column, with those in the
/// last one.
fn table(subject: &str) -> BTreeMap<String, BTreeSet<String>> {
    let text = read(&root().join("ARCHITECTURE.md"));
    let heading = format!("| {subject} | purpose | may use |");
    let rows = text.lines().skip_while(|line| *line != heading).skip(2);
    let quoted = |cell: &str| -> BTreeSet<String> {
        let names = cell.split('`').skip(1).step_by(2);
        names.map(|name| name.trim_end_matches('/').to_owned()).collect()
    };
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").collect();
        let name = quoted(cells[0]).pop_first().expect("a name");
        (name, quoted(cells[cells.len() - 1]))
    };
    let found: BTreeMap<_, _> = rows.take_while(|line| line.starts_with('|')).map(row).collect();
    found
}

fn assert_used(subject: &str, actual: &BTreeMap<String, BTreeSet<String>>) {
    let stated = table(subject);
    let row = |(name, used): (&String, &BTreeSet<String>)| {
        let used: Vec<String> = used.iter().map(|name| format!("`{name}`")).collect();
        format!("`{name}`: {}", used.join(", "))
    };
    let wrong: Vec<String> = actual
        .iter()
        .filter(|(name, used)| stated.get(*name) != Some(used))
        .map(row)
        .collect();
    assert!(
        wrong.is_empty(),
        "the table of the {subject} does not state what these use: {wrong:#?}"
    );
    for name in stated.keys() {
        assert!(
            actual.contains_key(name),
            "the table of the {subject} has `{name}`, which does not exist"
        );
    }
}

#[test]
fn packages_use_what_the_table_states() {
    let mut actual = BTreeMap::new();
    for folder in CRATES {
        let package = folder.trim_end_matches("src").trim_end_matches('/');
        let used = dependencies(package);
        let used = used
            .iter()
            .filter_map(|name| name.strip_prefix("kinefront-"))
            .map(str::to_owned);
        let name = package.trim_start_matches("crates/");
        let name = if name.is_empty() { "kinefront" } else { name };
        actual.insert(name.to_owned(), used.collect());
    }
    assert_used("package", &actual);
}

#[test]
fn modules_use_what_the_tables_state() {
    for (folder, subject) in [
        ("crates/model/src", "module of `model`"),
        ("crates/study/src", "module of `study`"),
        ("crates/explorer/src", "module of `explorer`"),
    ] {
        let found = Crate::read(folder);
        let tops = found.modules.keys().filter_map(|path| path.first().cloned());
        let mut actual: BTreeMap<String, BTreeSet<String>> = tops.map(|top| (top, BTreeSet::new())).collect();
        for (from, to) in found.edges() {
            if let (Some(from), Some(to)) = (from.first(), to.first())
                && from != to
            {
                actual.entry(from.clone()).or_default().insert(to.clone());
            }
        }
        assert!(actual.len() > 5, "{folder} has only {} modules", actual.len());
        assert_used(subject, &actual);
    }
}

/// The modules that can be reached from one.
fn reached<'a>(edges: &BTreeMap<&'a ItemPath, Vec<&'a ItemPath>>, from: &'a ItemPath) -> BTreeSet<&'a ItemPath> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(at) = open.pop() {
        for &next in edges.get(at).into_iter().flatten() {
            if found.insert(next) {
                open.push(next);
            }
        }
    }
    found
}

/// The circles that ARCHITECTURE.md gives a reason for: the files that a line of the list below its heading names first.
fn explained() -> Vec<BTreeSet<String>> {
    let text = read(&root().join("ARCHITECTURE.md"));
    let lines = text.lines().skip_while(|line| *line != "## Circles").skip(1);
    let lines = lines.take_while(|line| !line.starts_with("## "));
    let names = |line: &str| {
        let named = line.split(": ").next().unwrap_or_default();
        named.split('`').skip(1).step_by(2).map(str::to_owned).collect()
    };
    lines.filter(|line| line.starts_with("- ")).map(names).collect()
}

/// No two files use each other, directly or through others, unless ARCHITECTURE.md says why. A module and those below it are one
/// thing in several files, so what they use of each other does not count.
#[test]
fn files_form_no_circle_without_a_reason() {
    let explained = explained();
    // The files of a circle, with who uses whom in it.
    let mut circles: BTreeMap<BTreeSet<String>, BTreeSet<String>> = BTreeMap::new();
    for folder in CRATES {
        let found = Crate::read(folder);
        let mut edges: BTreeMap<&ItemPath, Vec<&ItemPath>> = BTreeMap::new();
        for (from, to) in found.edges() {
            if !from.starts_with(to) && !to.starts_with(from) {
                edges.entry(from).or_default().push(to);
            }
        }
        let from: BTreeMap<_, _> = edges.keys().map(|&from| (from, reached(&edges, from))).collect();
        for (&module, onwards) in from.iter().filter(|(module, onwards)| onwards.contains(*module)) {
            let back = |other: &&ItemPath| from.get(*other).is_some_and(|onwards| onwards.contains(module));
            let circle: Vec<&ItemPath> = onwards.iter().copied().filter(back).collect();
            let name = |path: &ItemPath| {
                let file = found.modules[path]
                    .file
                    .strip_prefix(root())
                    .expect("a file of the repository");
                file.display().to_string()
            };
            let names = circle.iter().map(|path| name(path)).collect();
            let within = edges[module].iter().filter(|to| circle.contains(to));
            let within = within.map(|to| format!("{} uses {}", module.join("::"), to.join("::")));
            circles.entry(names).or_default().extend(within);
        }
    }
    let unexplained: Vec<_> = circles
        .iter()
        .filter(|(circle, _)| !explained.contains(*circle))
        .collect();
    assert!(
        unexplained.is_empty(),
        "ARCHITECTURE.md gives no reason for these circles: {unexplained:#?}"
    );
    for circle in &explained {
        assert!(
            circles.contains_key(circle),
            "ARCHITECTURE.md explains a circle that there is not: {circle:?}"
        );
    }
}
