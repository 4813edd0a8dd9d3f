//! The design in the arguments of a command, given as text or as a row of a table.

use std::borrow::Cow;
use std::ffi::{OsStr, OsString};
use std::path::Path;

use clap::ArgGroup;
use kinefront_model::evaluation::GridChoice;
use kinefront_model::mechanism::Design;
use kinefront_study::{RunFolder, Study, UnlistedValue, is_row_name, named_row, read_designs, read_table, row_names};
use miette::{IntoDiagnostic, Result, WrapErr, miette};

use super::{load_study, say};

/// The ways to specify a design, of which a command requires one; with the arguments of the command that take its place.
pub fn exactly_one_of(arguments: &'static [&'static str]) -> ArgGroup {
    ArgGroup::new("subject").required(true).args(arguments)
}

/// The names of the arguments that specify a design.
pub const A_DESIGN: &[&str] = &["row", "design"];

/// The same for a command that also reads a stream of designs.
pub const DESIGN_OR_STREAM: &[&str] = &["row", "design", "stdin"];

/// The grid that an argument specifies.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub enum GridArgument {
    /// The grid used in the search.
    Reference,
    /// The grid on which reported designs are verified.
    Fine,
}

impl From<GridArgument> for GridChoice {
    fn from(argument: GridArgument) -> Self {
        match argument {
            GridArgument::Reference => GridChoice::Reference,
            GridArgument::Fine => GridChoice::Fine,
        }
    }
}

#[derive(Debug, clap::Args)]
#[group(skip)]
pub struct SubjectArguments {
    /// Design in a table: run/front.csv#12 is the row with the id 12, and #best (in the first objective), #knee and #largest
    /// (workspace) exist in every table of a run.
    #[arg(value_name = "TABLE#ID")]
    pub row: Option<OsString>,
    /// Design, as in "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056" (metres; optional mode=+++).
    #[arg(long)]
    pub design: Option<String>,
    /// Study file, or name of a built-in study [default: study.toml in the folder of the table, else paper].
    #[arg(long, value_name = "FILE")]
    pub study: Option<OsString>,
}

impl SubjectArguments {
    /// Whether a design is specified, not a table as a whole.
    pub fn is_design(&self) -> bool {
        let is_row = |row: &OsString| row.as_encoded_bytes().contains(&b'#');
        self.design.is_some() || self.row.as_ref().is_some_and(is_row)
    }

    /// Returns the grid on which the design is evaluated. Without one that is stated, a design of a table is evaluated on the grid on which
    /// fronts are verified: on the coarser one, an optimum may be infeasible.
    pub fn grid(&self, stated: Option<GridArgument>) -> GridChoice {
        match (stated, &self.row) {
            (Some(stated), _) => stated.into(),
            (None, Some(_)) => GridChoice::Fine,
            (None, None) => GridChoice::Reference,
        }
    }

    /// Reads the study, the design and a heading for the design; a note tells which of its values the study does not list.
    pub fn read(&self) -> Result<(Study, Design, String)> {
        let found = self.find()?;
        for UnlistedValue {
            variable,
            value,
            nearest,
        } in found.0.unlisted(&found.1)
        {
            let key = variable.key();
            say(format_args!(
                "note: {key} = {value} m is not one of the values that the study or its catalogue has; the nearest is {nearest} m"
            ));
        }
        Ok(found)
    }

    fn find(&self) -> Result<(Study, Design, String)> {
        if let Some(text) = &self.design {
            let study = load_study(self.study.as_deref())?;
            let design = Design::parse(text, study.working_mode).into_diagnostic()?;
            return Ok((study, design, design.architecture().to_string()));
        }
        let row = self.row.as_deref().unwrap_or_default();
        let (table, id) = split_row(row).ok_or_else(|| {
            let row = row.display();
            miette!("`{row}` does not specify a row; expected TABLE#ID, as in run/front.csv#12")
        })?;
        let row = row.display();
        let table = table_at(table);
        let study = study_of(&table, self.study.as_deref())?;
        let design = find_design(&table, &study, &id).wrap_err_with(|| format!("cannot read {row}"))?;
        Ok((study, design, format!("{}, design #{id}", study_name(&table))))
    }

    /// Reads the study and all designs of a table, each with its id.
    pub fn read_table(&self) -> Result<(Study, Vec<(usize, Design)>)> {
        let table = table_at(Path::new(self.row.as_deref().unwrap_or_default()));
        let study = study_of(&table, self.study.as_deref())?;
        let designs = designs_of(&table, &study)?;
        Ok((study, designs))
    }
}

/// Returns the table that is named: of a run folder, its front.
fn table_at(path: &Path) -> Cow<'_, Path> {
    match RunFolder::is_at(path) {
        true => Cow::Owned(path.join("front.csv")),
        false => Cow::Borrowed(path),
    }
}

/// Reads the study that is named, or else that of a table: the run's, the one beside the table, or the paper's.
pub fn study_of(table: &Path, named: Option<&OsStr>) -> Result<Study> {
    if named.is_some() {
        return load_study(named);
    }
    match run_of(table)? {
        Some(run) => Ok(run.study().clone()),
        None => study_beside(table),
    }
}

/// Reads all designs of a table, each with its id; a table without designs is an error.
pub fn designs_of(table: &Path, study: &Study) -> Result<Vec<(usize, Design)>> {
    let designs = read_designs(table, study).into_diagnostic()?;
    match designs.is_empty() {
        true => Err(without_designs(table)),
        false => Ok(designs),
    }
}

/// Returns the error of a table that has no designs.
pub fn without_designs(table: &Path) -> miette::Report {
    miette!("{} has no designs", table.display())
}

/// Opens the run that a table belongs to, if it stands in a run folder. A run knows what it wrote: a study or a table that was damaged
/// since would give other designs.
pub fn run_of(table: &Path) -> Result<Option<RunFolder>> {
    let Some(folder) = table.parent().filter(|folder| RunFolder::is_at(folder)) else {
        return Ok(None);
    };
    let run = RunFolder::open(folder).into_diagnostic()?;
    if !table.exists() {
        return Err(miette!(
            help = "a run writes its front at its end; kinefront optimize --resume completes one that was interrupted",
            "{} does not exist",
            table.display()
        ));
    }
    run.check_file(table).into_diagnostic()?;
    Ok(Some(run))
}

/// Reads the study of a table that does not stand in a run folder: the one beside it, or the paper's.
pub fn study_beside(table: &Path) -> Result<Study> {
    let beside = table.with_file_name("study.toml");
    if beside.exists() {
        Ok(Study::read(&beside)?)
    } else {
        load_study(None)
    }
}

/// Splits TABLE#ID at its last `#`.
fn split_row(row: &OsStr) -> Option<(&Path, String)> {
    let bytes = row.as_encoded_bytes();
    let place = bytes.iter().rposition(|&byte| byte == b'#')?;
    let id = String::from_utf8_lossy(&bytes[place + 1..]).into_owned();
    Some((path_of(&bytes[..place])?, id))
}

#[cfg(unix)]
fn path_of(bytes: &[u8]) -> Option<&Path> {
    use std::os::unix::ffi::OsStrExt;
    Some(Path::new(OsStr::from_bytes(bytes)))
}

#[cfg(not(unix))]
fn path_of(bytes: &[u8]) -> Option<&Path> {
    std::str::from_utf8(bytes).ok().map(Path::new)
}

fn study_name(table: &Path) -> String {
    let folder = table.parent().filter(|folder| !folder.as_os_str().is_empty());
    // Only the name of the folder: its path on this machine must not be recorded.
    let name = folder.and_then(Path::file_name).unwrap_or(table.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Returns the design in the row with the given id.
fn find_design(table: &Path, study: &Study, id: &str) -> Result<Design> {
    if is_row_name(id) {
        return find_named(table, study, id);
    }
    let rows = designs_of(table, study)?;
    if let Some((_, design)) = rows.iter().find(|(found, _)| found.to_string() == id) {
        return Ok(*design);
    }
    let some: Vec<String> = rows.iter().take(8).map(|(id, _)| id.to_string()).collect();
    let more = if rows.len() > some.len() { ", …" } else { "" };
    Err(miette!(
        help = "#best, #knee and #largest are names that every table of a run has",
        "{} has no design #{id}; it has #{}{more}",
        table.display(),
        some.join(", #")
    ))
}

/// Returns the design with the given name.
fn find_named(table: &Path, study: &Study, name: &str) -> Result<Design> {
    let rows = read_table(table, study).into_diagnostic()?.rows;
    if !rows.iter().any(|row| row.row.is_feasible()) {
        return Err(miette!(
            "{} has no feasible design, so it has no #{name}",
            table.display()
        ));
    }
    let found = named_row(&rows, study, name).ok_or_else(|| {
        miette!(
            "{} has no design #{name}; its names are #{}",
            table.display(),
            row_names(&rows, study).join(", #")
        )
    })?;
    Ok(found.row.design)
}
