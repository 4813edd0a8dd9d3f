//! Drives that can be bought, of which a design selects one type for all its actuators (docs/model.md, section 15.9).

use std::sync::Arc;

use crate::mechanism::JointKind;

/// A drive: a motor with its gear or its screw.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Name, as it is ordered.
    pub name: String,
    /// Kind of the joint that it drives.
    pub kind: JointKind,
    /// Force or torque that it gives all the time \[N or N·m\].
    pub rated: f64,
    /// Force or torque that it gives for a short time \[N or N·m\].
    pub peak: f64,
    /// Largest speed \[m/s or rad/s\].
    pub speed: f64,
    /// Inertia of what turns in it, reflected to the joint \[kg or kg·m²\].
    pub inertia: f64,
    /// Mass \[kg\].
    pub mass: f64,
}

/// Drives in the order of their masses; of equally heavy ones, in the order of their names. By default there are none, which asks nothing.
///
/// ```
/// use kinefront_model::dynamics::{Drive, DriveCatalogue};
/// use kinefront_model::mechanism::JointKind;
///
/// let drive = |name: &str, mass: f64| Drive {
///     name: name.to_owned(),
///     kind: JointKind::Revolute,
///     rated: 10.0,
///     peak: 30.0,
///     speed: 20.0,
///     inertia: 0.01,
///     mass,
/// };
/// let catalogue = DriveCatalogue::new(vec![drive("large", 5.0), drive("small", 2.0)])?;
/// assert_eq!(catalogue.get(0).map(|drive| drive.name.as_str()), Some("small"));
/// assert!(DriveCatalogue::new(vec![drive("weightless", 0.0)]).is_err());
/// # Ok::<(), kinefront_model::dynamics::DriveCatalogueError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DriveCatalogue(Arc<[Drive]>);

/// Why drives are not a catalogue.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DriveCatalogueError {
    /// There is none.
    #[error("it has no entry; it must have at least one drive")]
    Empty,
    /// A drive has a number that no drive has.
    #[error(
        "`{0}` is not a valid drive: rated, peak, speed and mass must be above 0 and at most 1e12, inertia at least 0, and peak at least rated"
    )]
    NoDrive(String),
    /// Two drives have one name.
    #[error("`{0}` is the name of two drives; names must be unique")]
    Twice(String),
}

impl DriveCatalogue {
    /// Makes a catalogue.
    ///
    /// # Errors
    /// [`DriveCatalogueError`].
    pub fn new(mut drives: Vec<Drive>) -> Result<Self, DriveCatalogueError> {
        if drives.is_empty() {
            return Err(DriveCatalogueError::Empty);
        }
        let is_size = |value: f64| value > 0.0 && value <= 1e12;
        for drive in &drives {
            let has_sizes = [drive.rated, drive.peak, drive.speed, drive.mass]
                .into_iter()
                .all(is_size);
            let has_inertia = drive.inertia == 0.0 || is_size(drive.inertia);
            if !has_sizes || !has_inertia || drive.peak < drive.rated {
                return Err(DriveCatalogueError::NoDrive(drive.name.clone()));
            }
        }
        drives.sort_by(|a, b| a.name.cmp(&b.name));
        if let Some(pair) = drives.windows(2).find(|pair| pair[0].name == pair[1].name) {
            return Err(DriveCatalogueError::Twice(pair[0].name.clone()));
        }
        drives.sort_by(|a, b| a.mass.total_cmp(&b.mass));
        Ok(Self(drives.into()))
    }

    /// Returns whether there are no drives, so that designs select none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the drive at a place.
    pub fn get(&self, place: usize) -> Option<&Drive> {
        self.0.get(place)
    }

    /// Returns the place of the drive of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.0.iter().position(|drive| drive.name == name)
    }

    /// Iterates over the drives for a kind of joint, the lightest first, with their places.
    pub fn of_kind(&self, kind: JointKind) -> impl Iterator<Item = (usize, &Drive)> {
        self.0.iter().enumerate().filter(move |(_, drive)| drive.kind == kind)
    }
}
