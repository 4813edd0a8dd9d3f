//! All evaluated designs of a run, stored in columns: about 500 bytes per design, so that a million fit in memory.

use kinefront_model::evaluation::{Constraint, ConstraintSet, Quantity};
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES, Design, FURTHER_VARIABLES, WorkingMode};
use kinefront_optimize::Objectives;
use kinefront_study::{Column, Row};

/// Evaluated designs in the order of their ids, which are consecutive from 0.
#[derive(Debug, Clone, Default)]
pub struct Store {
    /// Index of the architecture in [`Architecture::ALL`].
    architecture: Vec<u8>,
    mode: Vec<WorkingMode>,
    generation: Vec<u32>,
    values: [Vec<f64>; DESIGN_VARIABLES.len()],
    /// Further variables; NaN where the chain does not have one.
    further: [Vec<f64>; FURTHER_VARIABLES.len()],
    /// Home orientation `φ_c` \[deg\]; NaN for an infeasible design.
    phi: Vec<f64>,
    violation: Vec<f64>,
    /// Relative margins; NaN where the study does not require the constraint.
    margins: [Vec<f64>; Constraint::COUNT],
    active: Vec<ConstraintSet>,
    /// The objectives of the study, as they are minimised.
    objectives: Vec<Objectives>,
    /// The quantities, by [`Quantity::index`]; NaN where a design has none.
    quantities: QuantityColumns,
}

/// A column for each quantity, by [`Quantity::index`].
#[derive(Debug, Clone)]
struct QuantityColumns([Vec<f64>; Quantity::COUNT]);

impl Default for QuantityColumns {
    fn default() -> Self {
        Self([const { Vec::new() }; Quantity::COUNT])
    }
}

impl Store {
    /// Returns the number of designs.
    pub fn len(&self) -> usize {
        self.violation.len()
    }

    /// Returns whether there are no designs.
    pub fn is_empty(&self) -> bool {
        self.violation.is_empty()
    }

    /// Adds a design; its id is the number of designs before it.
    pub fn push(&mut self, row: &Row) {
        let index = Architecture::ALL
            .iter()
            .position(|&architecture| architecture == row.design.architecture())
            .unwrap_or(0);
        self.architecture.push(index as u8);
        self.mode.push(row.design.working_mode());
        self.generation.push(row.generation);
        for (column, value) in self.values.iter_mut().zip(row.design.values()) {
            column.push(value);
        }
        for (column, variable) in self.further.iter_mut().zip(FURTHER_VARIABLES) {
            column.push(row.number(Column::Dimension(variable)).unwrap_or(f64::NAN));
        }
        self.phi.push(row.phi.unwrap_or(f64::NAN));
        self.violation.push(row.violation);
        for (column, margin) in self.margins.iter_mut().zip(row.margins) {
            column.push(margin.unwrap_or(f64::NAN));
        }
        self.active.push(row.active);
        self.objectives.push(row.objectives);
        for quantity in Quantity::all() {
            let value = row.quantities.get(quantity);
            self.quantities.0[quantity.index()].push(value.unwrap_or(f64::NAN));
        }
    }

    /// Returns the objectives of design `id`, which must exist, as they are minimised.
    pub fn objectives(&self, id: usize) -> Objectives {
        self.objectives[id]
    }

    /// Moves the designs of `other` to the end of this store.
    pub fn append(&mut self, other: &mut Store) {
        self.architecture.append(&mut other.architecture);
        self.mode.append(&mut other.mode);
        self.generation.append(&mut other.generation);
        for (column, more) in self.values.iter_mut().zip(&mut other.values) {
            column.append(more);
        }
        for (column, more) in self.further.iter_mut().zip(&mut other.further) {
            column.append(more);
        }
        self.phi.append(&mut other.phi);
        self.violation.append(&mut other.violation);
        for (column, more) in self.margins.iter_mut().zip(&mut other.margins) {
            column.append(more);
        }
        self.active.append(&mut other.active);
        self.objectives.append(&mut other.objectives);
        for (column, more) in self.quantities.0.iter_mut().zip(&mut other.quantities.0) {
            column.append(more);
        }
    }

    /// Returns all values of design `id`, if it exists.
    pub fn row(&self, id: usize) -> Option<Row> {
        let design = self.design(id)?;
        Some(Row {
            generation: self.generation[id],
            design,
            phi: Some(self.phi[id]).filter(|phi| phi.is_finite()),
            violation: self.violation[id],
            margins: std::array::from_fn(|k| Some(self.margins[k][id]).filter(|margin| margin.is_finite())),
            active: self.active[id],
            quantities: Quantity::all()
                .map(|quantity| (quantity, Some(self.quantities.0[quantity.index()][id])))
                .collect(),
            objectives: self.objectives[id],
        })
    }

    /// Returns design `id`, if it exists.
    pub fn design(&self, id: usize) -> Option<Design> {
        if id >= self.len() {
            return None;
        }
        let values = std::array::from_fn(|k| self.values[k][id]);
        let design = Design::new(self.architecture(id), self.mode[id], values).ok()?;
        let further = FURTHER_VARIABLES.into_iter().zip(&self.further);
        further
            .map(|(variable, column)| (variable, column[id]))
            .filter(|(_, value)| value.is_finite())
            .try_fold(design, |design, (variable, value)| design.with(variable, value))
            .ok()
    }

    /// Returns the architecture of design `id`, which must exist.
    pub fn architecture(&self, id: usize) -> Architecture {
        Architecture::ALL[usize::from(self.architecture[id])]
    }

    /// Returns whether design `id`, which must exist, is feasible.
    pub fn is_feasible(&self, id: usize) -> bool {
        self.violation[id] <= 0.0
    }

    /// Returns all values of one of the [quantities](Column::quantities), in the order of the ids; none for any other column.
    pub fn column(&self, quantity: Column) -> &[f64] {
        match quantity {
            Column::Dimension(variable) => {
                let of_further = FURTHER_VARIABLES.iter().position(|&further| further == variable);
                of_further.map_or_else(|| &self.values[variable as usize], |place| &self.further[place])
            }
            Column::HomePhi => &self.phi,
            Column::Violation => &self.violation,
            Column::Margin(constraint) => &self.margins[constraint as usize],
            Column::Quantity(quantity) => &self.quantities.0[quantity.index()],
            _ => &[],
        }
    }

    /// Returns the memory in use \[bytes\].
    pub fn bytes(&self) -> usize {
        let numbers = self
            .values
            .iter()
            .chain(&self.further)
            .chain(&self.margins)
            .chain(&self.quantities.0);
        let numbers = numbers.chain([&self.phi, &self.violation]).map(bytes_of).sum::<usize>();
        let others = bytes_of(&self.architecture) + bytes_of(&self.mode) + bytes_of(&self.generation);
        numbers + others + bytes_of(&self.active) + bytes_of(&self.objectives)
    }
}

fn bytes_of<T>(column: &Vec<T>) -> usize {
    column.capacity() * size_of::<T>()
}
