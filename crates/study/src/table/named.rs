//! Names of designs that every table of a run has, so that a command can be written down before the ids are known.

use kinefront_optimize::{Archive, Objectives, knee};

use super::TableRow;
use crate::Study;

/// The design that is best in the first objective.
const BEST: &str = "best";
/// The knee of the front; with one objective, the best design.
const KNEE: &str = "knee";
/// The design with the largest regular workspace.
const LARGEST: &str = "largest";

/// Returns whether a text is the name of a design rather than an id.
pub fn is_row_name(text: &str) -> bool {
    text.starts_with(|first: char| first.is_ascii_lowercase())
}

/// Returns the names that [`named_row`] finds in a table: `best`, `knee`, `largest`, and the marks of the front.
pub fn row_names(rows: &[TableRow], study: &Study) -> Vec<String> {
    let mut names: Vec<String> = [BEST, KNEE, LARGEST].map(str::to_owned).into();
    let (_, marks) = front_of(rows, study);
    for mark in marks.into_iter().filter(|mark| !mark.is_empty()) {
        if !names.contains(&mark) {
            names.push(mark);
        }
    }
    names
}

/// Returns the row with a name, among equals the first: `best` (in the first objective), a mark of the front, as in the column `mark` of
/// `front.csv`, or `largest` (regular workspace). `None` if the table has no feasible design or the name is none of these.
pub fn named_row<'a>(rows: &'a [TableRow], study: &Study, name: &str) -> Option<&'a TableRow> {
    let (front, marks) = front_of(rows, study);
    let marked = || Some(front[marks.iter().position(|mark| mark == name)?]);
    match name {
        BEST => front.first().copied(),
        KNEE => marked().or(front.first().copied()),
        LARGEST => marked().or_else(|| largest(rows)),
        _ => marked(),
    }
}

fn largest(rows: &[TableRow]) -> Option<&TableRow> {
    let feasible = rows.iter().filter(|row| row.row.is_feasible());
    // Of equal keys, `min_by` returns the first.
    feasible.min_by(|a, b| b.row.workspace_radius().total_cmp(&a.row.workspace_radius()))
}

/// Returns the archive of the feasible rows that no other dominates; its ids are the places of the rows.
pub(crate) fn archive_of<'a>(rows: impl IntoIterator<Item = &'a TableRow>) -> Archive {
    let mut archive = Archive::default();
    for (place, row) in rows.into_iter().enumerate() {
        archive.insert(place, &[], &row.row.outcome());
    }
    archive
}

/// Returns the rows that no other dominates, in the order of the first objective, and their marks.
fn front_of<'a>(rows: &'a [TableRow], study: &Study) -> (Vec<&'a TableRow>, Vec<String>) {
    let archive = archive_of(rows);
    let objectives: Vec<Objectives> = archive.iter().map(|member| member.objectives).collect();
    let front = archive.iter().map(|member| &rows[member.id]).collect();
    (front, front_marks(study, &objectives))
}

/// Returns the mark of each design of a front: `knee`, what the best designs in the objectives are called, and an empty text for all
/// others. Where each of several objectives has a word for its best design, as `lightest` and `largest`, these are the marks;
/// otherwise `best_` with the key of the quantity.
pub fn front_marks(study: &Study, objectives: &[Objectives]) -> Vec<String> {
    let asked = study.objectives();
    let words: Option<Vec<&str>> = asked.iter().map(|objective| objective.superlative()).collect();
    let words = words.filter(|words| words.len() > 1);
    let mut marks = vec![String::new(); objectives.len()];
    for (place, objective) in asked.iter().enumerate().rev() {
        let value = |member: &usize| objectives[*member][place];
        let best = (0..marks.len()).min_by(|a, b| value(a).total_cmp(&value(b)));
        if let Some(best) = best {
            marks[best] = match &words {
                Some(words) => words[place].to_owned(),
                None => format!("best_{}", objective.quantity.entry().key),
            };
        }
    }
    if let Some(knee) = knee(objectives).filter(|_| objectives[0].len() > 1) {
        marks[knee] = "knee".to_owned();
    }
    marks
}
