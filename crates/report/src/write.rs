//! Writing a report to a folder.

use std::path::{Path, PathBuf};

use super::{Figure, Front, Report, ReportError, SideBySide, chart, page};
use kinefront_model::evaluation::Evaluation;
use kinefront_study::{Cell, Column, Row, TableRow, WriteError, table_bytes, write_whole};

/// Pixels per unit of the figures of runs side by side.
const SCALE: f32 = 2.0;

impl Report {
    /// Writes the report to a folder; with `replace`, the files of a report that is already there are replaced.
    ///
    /// # Errors
    /// [`ReportError::Occupied`] if the folder already holds a report and `replace` is false, [`ReportError::Figure`]
    /// if a file cannot be created, [`ReportError::Write`] if one cannot be written.
    pub fn write(&self, folder: &Path, replace: bool) -> Result<(), ReportError> {
        free(folder, replace)?;
        let figures = write_figures(folder, &self.figures, self.options.scale)?;
        let pictures = made(folder.join("pictures"))?;
        for picture in &self.pictures {
            write_whole(&pictures.join(format!("{}.png", picture.name)), &picture.png)?;
        }
        let members = || self.fronts.alone.iter().flat_map(|(_, front)| front.shown());
        let joint_front = Front::new(members().cloned().collect(), usize::MAX).members;
        let joint = |member: &Evaluation| joint_front.contains(member);
        let columns = || Column::of_designs(&self.study).chain([Column::OnJointFront]);
        let rows = members().enumerate().map(|(id, member)| {
            let entry = TableRow::new(id, Row::new(0, member));
            let cell = |column| match column {
                Column::OnJointFront => Cell::Flag(joint(member)),
                column => column.cell(&entry),
            };
            columns().map(cell).collect()
        });
        let table = table_bytes(columns(), rows).map_err(|error| ReportError::of("fronts.csv")(error.into()))?;
        write_whole(&folder.join("fronts.csv"), &table)?;
        // The page contains its figures and pictures. At any instant it is that of one report or of the other.
        write_whole(&folder.join("index.html"), page::html(self).as_bytes())?;
        remove_stale(&figures, |name| self.figures.iter().any(|figure| figure.name == name))?;
        remove_stale(&pictures, |name| {
            self.pictures.iter().any(|picture| picture.name == name)
        })?;
        Ok(())
    }
}

impl SideBySide {
    /// Writes the page and its figures to a folder; with `replace`, the files of a report that is already there are replaced.
    ///
    /// # Errors
    /// As [`Report::write`].
    pub fn write(&self, folder: &Path, replace: bool) -> Result<(), ReportError> {
        free(folder, replace)?;
        let figures = write_figures(folder, &self.figures, SCALE)?;
        write_whole(&folder.join("index.html"), page::side_by_side(self).as_bytes())?;
        remove_stale(&figures, |name| self.figures.iter().any(|figure| figure.name == name))?;
        Ok(())
    }
}

/// Writes figures as SVG and PNG, with `scale` pixels per unit, to their folder, which is returned.
fn write_figures(folder: &Path, all: &[Figure], scale: f32) -> Result<PathBuf, ReportError> {
    let figures = made(folder.join("figures"))?;
    for figure in all {
        write_whole(&figures.join(format!("{}.svg", figure.name)), figure.svg.as_bytes())?;
        let png = chart::png(&figure.svg, scale).map_err(ReportError::of(&figure.name))?;
        write_whole(&figures.join(format!("{}.png", figure.name)), &png)?;
    }
    Ok(figures)
}

/// Makes a folder, unless it is there.
fn made(folder: PathBuf) -> Result<PathBuf, WriteError> {
    match std::fs::create_dir_all(&folder) {
        Ok(()) => Ok(folder),
        Err(cause) => Err(WriteError::Write { path: folder, cause }),
    }
}

/// Checks that a report may be written to the folder.
///
/// # Errors
/// [`ReportError::Occupied`] if the folder already holds a report and `replace` is false.
pub fn free(folder: &Path, replace: bool) -> Result<(), ReportError> {
    if folder.join("index.html").exists() && !replace {
        return Err(ReportError::Occupied(folder.to_owned()));
    }
    Ok(())
}

/// Removes the files that an earlier report left in the folders of figures and pictures.
fn remove_stale(kind: &Path, is_current: impl Fn(&str) -> bool) -> Result<(), WriteError> {
    let failed = |path: &Path, cause: std::io::Error| WriteError::Write {
        path: path.to_owned(),
        cause,
    };
    let entries = std::fs::read_dir(kind).map_err(|error| failed(kind, error))?;
    for path in entries.flatten().map(|entry| entry.path()) {
        // Files of other kinds were not written by a report and are kept.
        let is_ours = path
            .extension()
            .is_some_and(|extension| extension == "svg" || extension == "png");
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if is_ours && !is_current(&name) {
            std::fs::remove_file(&path).map_err(|error| failed(&path, error))?;
        }
    }
    Ok(())
}
