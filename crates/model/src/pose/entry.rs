//! What there is to know about a quantity, whatever study asks for it (docs/model.md, section 6.5).

/// Over what a quantity is taken, and so what its limit bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// The design alone, whatever its pose.
    Design,
    /// All poses of the region, of which the quantity is the least or the largest value. Its limit bounds each pose, and with them
    /// the largest disc.
    Poses,
    /// The region as a whole.
    Region,
}

/// Direction in which the values of a quantity are better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// Smaller values are better.
    Lower,
    /// Larger values are better.
    Higher,
}

impl Better {
    /// Returns the factor with which smaller values are worse.
    pub const fn sign(self) -> f64 {
        match self {
            Better::Higher => 1.0,
            Better::Lower => -1.0,
        }
    }
}

/// How a range of values is divided evenly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Linear in the value.
    Linear,
    /// Linear in the logarithm of the value, which spans decades.
    Logarithmic,
}

/// A value that few designs exceed, as the reference point of a hypervolume in which the quantity is to be small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reference {
    /// The reference mass of the study.
    Mass,
    /// A number.
    Number(f64),
    /// A multiple of the limit that the study states.
    Limit(f64),
    /// A multiple of the largest base radius.
    BaseRadius(f64),
    /// A multiple of the largest link length.
    LinkLength(f64),
    /// A multiple of the largest bar radius.
    BarRadius(f64),
    /// A multiple of the displacement that the study allows.
    Displacement(f64),
}

/// What there is to know about a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantityEntry {
    /// Name with the unit, as in study files and tables.
    pub key: &'static str,
    /// Unit; empty for a number without one.
    pub unit: &'static str,
    /// Name to display, without the unit.
    pub label: &'static str,
    /// Name to display where there is little room.
    pub short: &'static str,
    /// What it is, in one sentence.
    pub meaning: &'static str,
    /// Over what it is taken.
    pub scope: Scope,
    /// Which values are better.
    pub better: Better,
    /// Scale that suits its values.
    pub scale: Scale,
    /// Number that no value reaches.
    pub most: Option<f64>,
    /// Whether 0 is a limit that excludes something.
    pub may_be_zero: bool,
    /// Value that few designs exceed.
    pub reference: Reference,
    /// What the best design of a front is called, if there is a word for it.
    pub superlative: Option<&'static str>,
}

impl QuantityEntry {
    /// Creates the entry of a quantity with a linear scale, whose values few designs exceed 1.
    pub(crate) const fn new(
        key: &'static str,
        unit: &'static str,
        label: &'static str,
        scope: Scope,
        better: Better,
        meaning: &'static str,
    ) -> Self {
        Self {
            key,
            unit,
            label,
            short: label,
            meaning,
            scope,
            better,
            scale: Scale::Linear,
            most: None,
            may_be_zero: true,
            reference: Reference::Number(1.0),
            superlative: None,
        }
    }

    /// Sets the scale to a logarithmic one.
    pub(crate) const fn logarithmic(mut self) -> Self {
        self.scale = Scale::Logarithmic;
        self
    }

    /// States the value that few designs exceed.
    pub(crate) const fn reference(mut self, reference: Reference) -> Self {
        self.reference = reference;
        self
    }

    /// States a shorter name.
    pub(crate) const fn short(mut self, short: &'static str) -> Self {
        self.short = short;
        self
    }

    /// States what the best design of a front is called.
    pub(crate) const fn superlative(mut self, word: &'static str) -> Self {
        self.superlative = Some(word);
        self
    }

    /// States a number that no value reaches.
    pub(crate) const fn below(mut self, most: f64) -> Self {
        self.most = Some(most);
        self
    }

    /// States that a limit of 0 excludes nothing, or everything.
    pub(crate) const fn above_zero(mut self) -> Self {
        self.may_be_zero = false;
        self
    }
}
