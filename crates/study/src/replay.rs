//! The replay of a search from the designs that it has evaluated already.

use rayon::prelude::*;

use super::{Cell, Column, DesignProblem, EndReason, Row, SearchError, Study, StudySearch, TableRow};
use kinefront_optimize::Evaluated;

/// Number of rows of a resumed run that are evaluated again and compared.
const SAMPLED_ROWS: usize = 24;

/// Why designs cannot be replayed: they are not those that the study leads to.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The search cannot be prepared.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// The table has more rows than the study allows.
    #[error("the table has {rows} designs, but the study allows {budget} evaluations; one of the two was changed")]
    Budget {
        /// Number of rows.
        rows: usize,
        /// Budget of the study.
        budget: usize,
    },
    /// The design of a row is not the one that the algorithm asks for.
    #[error(
        "design #{id} does not follow from the study and the designs before it; the study, the algorithm or a row before \
         it was changed"
    )]
    Design {
        /// Id of the row.
        id: usize,
    },
    /// A row states a generation other than that of its place.
    #[error("design #{id} states generation {found}, but belongs to generation {expected}")]
    Generation {
        /// Id of the row.
        id: usize,
        /// Generation that the row states.
        found: u32,
        /// Generation of its place.
        expected: usize,
    },
    /// A row that was evaluated again has another value.
    #[error(
        "design #{id} states {column} = {stated}, but its evaluation gives {found}; the study or the row was changed"
    )]
    Value {
        /// Id of the row.
        id: usize,
        /// Name of the column.
        column: String,
        /// Value in the row.
        stated: String,
        /// Value of the evaluation.
        found: String,
    },
}

impl StudySearch {
    /// Prepares the search of a study from the designs that it has evaluated already: the algorithm is asked for each
    /// generation and told the outcomes in `rows`, up to the last complete generation. Some rows are evaluated again and
    /// compared.
    ///
    /// # Errors
    /// [`ReplayError`] if the rows are not those that the study leads to.
    pub fn resume(study: Study, mut rows: Vec<TableRow>, threads: Option<usize>) -> Result<Self, ReplayError> {
        let mut search = Self::new(study, threads)?;
        if rows.len() > search.budget {
            return Err(ReplayError::Budget {
                rows: rows.len(),
                budget: search.budget,
            });
        }
        search.check_sample(&rows)?;
        let (mut start, mut generation) = (0, 1);
        while start < rows.len() {
            let mut candidates = search.algorithm.ask();
            let count = candidates.len().min(search.budget - start);
            let whole = rows.get(start..start + count);
            let present = whole.unwrap_or(&rows[start..]);
            for (entry, candidate) in present.iter().zip(&candidates) {
                let (id, found) = (entry.id, entry.row.generation);
                if found as usize != generation {
                    return Err(ReplayError::Generation {
                        id,
                        found,
                        expected: generation,
                    });
                }
                if !search.problem.follows(candidate, &entry.row.design) {
                    return Err(ReplayError::Design { id });
                }
            }
            let Some(whole) = whole else {
                search.asked = Some(candidates);
                break;
            };
            candidates.truncate(count);
            let evaluated = whole.iter().zip(candidates).map(|(entry, candidate)| Evaluated {
                x: DesignProblem::values(&candidate, &entry.row.design),
                outcome: entry.row.outcome(),
            });
            search.algorithm.tell(evaluated.collect());
            start += count;
            generation += 1;
        }
        rows.truncate(start);
        search.replayed = rows;
        Ok(search)
    }

    /// Prepares a search that has evaluated the designs of `rows` and nothing more, to which no algorithm leads: those of several
    /// searches. Some rows are evaluated again and compared.
    ///
    /// # Errors
    /// [`ReplayError`] if a row is not as the study evaluates it.
    pub fn of_rows(study: Study, rows: Vec<TableRow>, threads: Option<usize>) -> Result<Self, ReplayError> {
        let mut search = Self::new(study, threads)?;
        search.check_sample(&rows)?;
        search.budget = rows.len();
        search.replayed = rows;
        search.end_after_replay(EndReason::Completed);
        Ok(search)
    }

    /// Evaluates some rows again and compares all their values.
    fn check_sample(&self, rows: &[TableRow]) -> Result<(), ReplayError> {
        let last = rows.len().saturating_sub(1);
        let mut places: Vec<usize> = (0..SAMPLED_ROWS).map(|k| k * last / (SAMPLED_ROWS - 1)).collect();
        places.dedup();
        places.retain(|&place| place < rows.len());
        let (problem, study) = (&self.problem, self.study());
        let check = |&place: &usize| problem.check_row(study, &rows[place]);
        self.pool.install(|| places.par_iter().try_for_each(check))
    }
}

impl DesignProblem {
    /// Evaluates a row again and compares all its values.
    ///
    /// # Errors
    /// [`ReplayError::Value`] for the first value that differs.
    pub fn check_row(&self, study: &Study, entry: &TableRow) -> Result<(), ReplayError> {
        let evaluation = self.evaluate_design(&entry.row.design);
        let found = TableRow {
            row: Row::new(entry.row.generation as usize, &evaluation),
            ..*entry
        };
        let differs = |column: &Column| column.cell(entry) != column.cell(&found);
        let Some(column) = Column::of_designs(study).find(differs) else {
            return Ok(());
        };
        let text = |cell: Cell| match cell {
            Cell::Missing => "no value".to_owned(),
            cell => cell.to_string(),
        };
        Err(ReplayError::Value {
            id: entry.id,
            column: column.name().into_owned(),
            stated: text(column.cell(entry)),
            found: text(column.cell(&found)),
        })
    }
}
