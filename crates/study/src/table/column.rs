//! The columns of a table of designs: the one definition that CSV, Parquet, recordings, window and terminal follow.

use std::borrow::Cow;

use crate::{Catalogues, Study};
use kinefront_model::evaluation::{Better, Constraint, Quantity, QuantitySet, Scale};
use kinefront_model::mechanism::{DESIGN_VARIABLES, Design, DesignVariable, FURTHER_VARIABLES};

/// A column of a table of designs.
///
/// ```
/// use kinefront_model::evaluation::Quantity;
/// use kinefront_study::{Column, ColumnType, Study};
///
/// let names: Vec<_> = Column::of_designs(&Study::default()).map(Column::name).collect();
/// assert_eq!(names[..5], ["id", "generation", "architecture", "working_mode", "R"]);
/// assert_eq!(Column::find("mass_kg"), Some(Column::Quantity(Quantity::Mass)));
/// assert_eq!(Column::Quantity(Quantity::Mass).kind(), ColumnType::Number);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Column {
    /// Id of the design in its run, from 0.
    Id,
    /// Generation in which the design was evaluated, from 1.
    Generation,
    /// Architecture.
    Architecture,
    /// Working mode, a sign per leg.
    WorkingMode,
    /// One of the variables of a design \[m, or deg for an angle\].
    Dimension(DesignVariable),
    /// Home orientation `φ_c` \[deg\].
    HomePhi,
    /// Whether the design is feasible.
    Feasible,
    /// Relative margin of a constraint; missing where the study does not require the constraint.
    Margin(Constraint),
    /// Ids of the active constraints, joined by `+`.
    Active,
    /// Constraint violation; 0 for a feasible design.
    Violation,
    /// A quantity; those that are not known of every design have a column where a study names them.
    Quantity(Quantity),
    /// Workspace radius on the reference grid \[m\], in a verified front.
    ReferenceRadius,
    /// What the design stands out by on its front: `lightest`, `knee` or `largest`.
    Mark,
    /// Radius of a disc in which every pose is proved feasible \[m\], in a front whose workspaces were proved.
    CertifiedLower,
    /// Distance of a pose that is proved infeasible \[m\].
    CertifiedUpper,
    /// State of the proof: `proved` or `open`.
    Certificate,
    /// Name of the bars of the legs in the catalogue that they are selected from.
    LegSection,
    /// Name of the bars of the platform in the catalogue that they are selected from.
    PlatformSection,
    /// Name of the drive in the catalogue that it is selected from.
    Drive,
    /// Whether the design is on the front of all architectures together.
    OnJointFront,
    /// Whether the design was verified on the fine grid.
    Verified,
    /// Whether the user has starred the design.
    Starred,
    /// The user's note on the design.
    Note,
}

/// Type of the values of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnType {
    /// Whole numbers.
    Integer,
    /// Floating-point numbers.
    Number,
    /// True or false.
    Flag,
    /// Texts.
    Text,
}

impl Column {
    /// The columns of every table of designs, in their order; the columns of `designs.csv` begin with them.
    pub fn common() -> impl Iterator<Item = Column> {
        [Self::Id, Self::Generation, Self::Architecture, Self::WorkingMode]
            .into_iter()
            .chain(DESIGN_VARIABLES.map(Self::Dimension))
            .chain([Quantity::Mass, Quantity::WorkspaceRadius].map(Self::Quantity))
            .chain([Self::HomePhi, Self::Feasible])
    }

    /// The columns of `designs.csv` of every study, in their order.
    fn of_every_study() -> impl Iterator<Item = Column> {
        Self::common()
            .chain(Constraint::ALL.map(Self::Margin))
            .chain(Constraint::ALL.map(|constraint| Self::Quantity(Quantity::of_constraint(constraint))))
            .chain([Self::Active, Self::Violation])
    }

    /// The columns of `designs.csv`, in their order.
    pub fn of_designs(study: &Study) -> impl Iterator<Item = Column> + use<> {
        Self::of_every_study()
            .chain(Self::further(study.named_quantities()))
            .chain(study.bounds.further_variables().map(Self::Dimension))
    }

    /// The columns of `front.csv`, in their order.
    pub fn of_front(study: &Study) -> impl Iterator<Item = Column> + use<> {
        Self::of_every_study()
            .chain(Self::OF_FRONT)
            .chain(Self::further(study.named_quantities()))
            .chain(study.bounds.further_variables().map(Self::Dimension))
            .chain(Self::selected(study))
    }

    /// The columns of those bars and drives that are selected from a catalogue.
    fn selected(study: &Study) -> impl Iterator<Item = Column> + use<> {
        let sections = &study.sections;
        let legs = sections.legs.catalogue.is_some().then_some(Self::LegSection);
        let platform = sections.platform.catalogue.is_some().then_some(Self::PlatformSection);
        let drive = study.drives.catalogue.is_some().then_some(Self::Drive);
        legs.into_iter().chain(platform).chain(drive)
    }

    /// The columns that `front.csv` has besides those of `designs.csv`.
    const OF_FRONT: [Self; 5] = [
        Self::ReferenceRadius,
        Self::Mark,
        Self::CertifiedLower,
        Self::CertifiedUpper,
        Self::Certificate,
    ];

    /// The columns of those quantities that not every study has.
    fn further(quantities: QuantitySet) -> impl Iterator<Item = Column> {
        let named = quantities.iter().filter(|quantity| !quantity.is_always_known());
        named.map(Self::Quantity).collect::<Vec<_>>().into_iter()
    }

    /// Every column that a table may have.
    fn all() -> impl Iterator<Item = Column> {
        Self::of_every_study()
            .chain(Self::OF_FRONT)
            .chain(Self::further(QuantitySet::all()))
            .chain(FURTHER_VARIABLES.map(Self::Dimension))
            .chain([Self::LegSection, Self::PlatformSection, Self::Drive])
            .chain([Self::OnJointFront, Self::Verified, Self::Starred, Self::Note])
    }

    /// The numerical columns that an axis, a filter or a column of the window can show: mass and workspace radius, dimensions,
    /// margins, clearance, and what else is known of every design, then the other quantities among `named`.
    pub fn quantities(named: QuantitySet) -> impl Iterator<Item = Column> {
        let clearance = Quantity::of_constraint(Constraint::Clearance);
        let others = named
            .iter()
            .filter(move |quantity| ![Quantity::Mass, Quantity::WorkspaceRadius, clearance].contains(quantity));
        [Quantity::Mass, Quantity::WorkspaceRadius]
            .map(Self::Quantity)
            .into_iter()
            .chain(DESIGN_VARIABLES.map(Self::Dimension))
            .chain(Constraint::ALL.map(Self::Margin))
            .chain([Self::Quantity(clearance), Self::HomePhi, Self::Violation])
            .chain(others.map(Self::Quantity))
    }

    /// The column of a name.
    pub fn find(name: &str) -> Option<Column> {
        Self::all().find(|column| column.name() == name)
    }

    /// The numerical column of a name that an axis, a filter or a column of the window can show.
    pub fn find_quantity(name: &str) -> Option<Column> {
        Self::quantities(QuantitySet::all()).find(|column| column.name() == name)
    }

    /// Name in CSV, Parquet, recordings and filters.
    pub fn name(self) -> Cow<'static, str> {
        Cow::Borrowed(match self {
            Self::Id => "id",
            Self::Generation => "generation",
            Self::Architecture => "architecture",
            Self::WorkingMode => "working_mode",
            Self::Dimension(variable) => variable.key(),
            Self::HomePhi => "phi_deg",
            Self::Feasible => "feasible",
            Self::Margin(constraint) => return Cow::Owned(format!("margin_{}", constraint.id())),
            Self::Active => "active",
            Self::Violation => "violation",
            Self::Quantity(quantity) => match quantity.constraint() {
                Some(constraint) => return Cow::Owned(format!("value_{}", constraint.id())),
                None => quantity.entry().key,
            },
            Self::ReferenceRadius => "workspace_radius_reference_m",
            Self::Mark => "mark",
            Self::CertifiedLower => "certified_lower_m",
            Self::CertifiedUpper => "certified_upper_m",
            Self::Certificate => "certificate",
            Self::LegSection => "leg_section",
            Self::PlatformSection => "platform_section",
            Self::Drive => "drive",
            Self::OnJointFront => "on_joint_front",
            Self::Verified => "verified",
            Self::Starred => "starred",
            Self::Note => "note",
        })
    }

    /// Returns the name that the column states of what a design selects from a catalogue: its bars, or the drive at a place of the catalogue.
    pub(super) fn selected_of<'a>(
        self,
        catalogues: &'a Catalogues,
        design: &Design,
        drive: Option<usize>,
    ) -> Option<&'a str> {
        let sections = &catalogues.sections;
        match self {
            Self::LegSection => sections.legs.catalogue_name(design.leg_bar_radius()),
            Self::PlatformSection => sections.platform.catalogue_name(design.platform_bar_radius()),
            Self::Drive => catalogues.drives.get(drive?).map(|drive| drive.name.as_str()),
            _ => None,
        }
    }

    /// Type of the values.
    pub fn kind(self) -> ColumnType {
        match self {
            Self::Id | Self::Generation => ColumnType::Integer,
            Self::Architecture
            | Self::WorkingMode
            | Self::Active
            | Self::Mark
            | Self::Certificate
            | Self::LegSection
            | Self::PlatformSection
            | Self::Drive
            | Self::Note => ColumnType::Text,
            Self::Feasible | Self::OnJointFront | Self::Verified | Self::Starred => ColumnType::Flag,
            Self::Dimension(_)
            | Self::HomePhi
            | Self::Margin(_)
            | Self::Violation
            | Self::Quantity(_)
            | Self::ReferenceRadius
            | Self::CertifiedLower
            | Self::CertifiedUpper => ColumnType::Number,
        }
    }

    /// Unit of the values; empty for a number without a unit and for texts.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Dimension(variable) if variable.is_angle() => "°",
            Self::Dimension(_) | Self::ReferenceRadius | Self::CertifiedLower | Self::CertifiedUpper => "m",
            Self::HomePhi => "°",
            Self::Quantity(quantity) => quantity.entry().unit,
            _ => "",
        }
    }

    /// Whether a row may have no value.
    pub fn is_optional(self) -> bool {
        match self {
            // A chain may not have a further variable.
            Self::Dimension(variable) => FURTHER_VARIABLES.contains(&variable),
            Self::Quantity(quantity) => ![Quantity::Mass, Quantity::WorkspaceRadius].contains(&quantity),
            Self::HomePhi | Self::Margin(_) | Self::CertifiedLower | Self::CertifiedUpper => true,
            _ => false,
        }
    }

    /// Name to display, without the unit.
    fn label(self) -> Cow<'static, str> {
        match self {
            Self::Dimension(variable) => variable.symbol().into(),
            Self::HomePhi => "φ_c".into(),
            Self::Margin(constraint) => format!("margin {}", constraint.id()).into(),
            Self::Quantity(quantity) => quantity.entry().label.into(),
            _ => self.name(),
        }
    }

    /// Name to display, with the unit.
    pub fn title(self) -> String {
        match self.unit() {
            "" => self.label().into_owned(),
            unit => format!("{} [{unit}]", self.label()),
        }
    }

    /// Short name for the heading of a narrow axis.
    pub fn short(self) -> Cow<'static, str> {
        match self {
            Self::Quantity(quantity) => quantity.entry().short.into(),
            Self::Margin(Constraint::DeterminantSign) => "det A".into(),
            Self::Margin(constraint) => constraint.id().into(),
            _ => self.label(),
        }
    }

    /// Direction in which the values are better, if there is one.
    pub fn better(self) -> Option<Better> {
        match self {
            Self::Violation => Some(Better::Lower),
            Self::Margin(_) => Some(Better::Higher),
            Self::Quantity(quantity) => Some(quantity.entry().better),
            _ => None,
        }
    }

    /// Whether the values differ by orders of magnitude, so that a logarithmic axis suits them.
    pub fn is_logarithmic(self) -> bool {
        match self {
            Self::Violation => true,
            Self::Quantity(quantity) => quantity.entry().scale == Scale::Logarithmic,
            _ => false,
        }
    }
}
