//! The command `kinefront pose`.

use kinefront_export::{AssemblyModesJson, DynamicsJson, PoseReportJson};
use kinefront_model::dynamics::Motion;
use kinefront_model::kinematics::assembly_modes;
use kinefront_model::spatial::{Acceleration, JointValues, Pose, Twist, Wrench};

use super::subject::{A_DESIGN, SubjectArguments, exactly_one_of};
use super::{Ending, Failure, print, tables};

#[derive(Debug, clap::Args)]
#[command(group = exactly_one_of(A_DESIGN))]
pub struct PoseArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Pose, as in "x=0.1 y=0.2 phi_deg=30" (metres and degrees).
    #[arg(long, required_unless_present = "actuators", conflicts_with = "actuators")]
    pose: Option<String>,
    /// Values of the actuated joints, as in "q1=0.9 q2=1.0 q3=1.1" (metres or radians): prints all poses that they allow.
    #[arg(long, value_name = "VALUES")]
    actuators: Option<String>,
    /// Wrench on the platform in place of the loads of the study, as in "fx=100 fy=0 mz=-5" (N and N·m; omitted components are 0).
    #[arg(long, conflicts_with = "actuators")]
    wrench: Option<String>,
    /// Twist of the platform at P, as in "vx=1 vy=0 omega=0.5" (m/s and rad/s; omitted components are 0): prints the speeds of the actuators.
    #[arg(long, conflicts_with = "actuators")]
    twist: Option<String>,
    /// Acceleration of the platform at P, as in "ax=10 ay=0 alpha=5" (m/s² and rad/s²): prints the forces of the actuators.
    #[arg(long, conflicts_with = "actuators")]
    acceleration: Option<String>,
    /// Print the result as one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &PoseArguments) -> Result<Ending, Failure> {
    let (study, design, _) = arguments.subject.read().map_err(Failure::Input)?;
    let model = study.model().map_err(Failure::runtime)?;
    let Some(pose) = &arguments.pose else {
        let values = arguments.actuators.as_deref().unwrap_or_default();
        let values: JointValues = values.parse().map_err(Failure::input)?;
        let modes = assembly_modes(&design, &model.settings().legs, values.0);
        let json = arguments.json.then(|| AssemblyModesJson::new(&modes));
        return print(json, || tables::assembly_modes(&design, values.0, &modes));
    };
    let pose = pose.parse::<Pose>().map_err(Failure::input)?;
    let wrench = arguments.wrench.as_deref().map(str::parse::<Wrench>).transpose();
    let wrench = wrench.map_err(Failure::input)?.map(|Wrench(wrench)| wrench);
    let posed = model.posed(&design);
    let outcome = posed.at(&pose);
    let strength = posed.strength_at(&pose, wrench).ok().flatten();
    let motion = arguments.motion()?;
    let dynamics = posed.dynamics_at(&pose).ok().flatten();
    let (strength, motion) = (strength.as_ref(), motion.as_ref());
    let json = arguments.json.then(|| {
        let dynamics = dynamics.as_ref();
        let dynamics = dynamics.and_then(|dynamics| DynamicsJson::new(dynamics, motion));
        PoseReportJson::new(&outcome, strength, dynamics)
    });
    print(json, || {
        let dynamics = dynamics.as_ref();
        let dynamics = dynamics.map(|dynamics| tables::dynamics(&design, dynamics, motion));
        tables::pose(&design, &pose, &outcome, strength) + &dynamics.unwrap_or_default()
    })
}

impl PoseArguments {
    /// Returns the motion that is asked for, if one is.
    fn motion(&self) -> Result<Option<Motion>, Failure> {
        let twist = self.twist.as_deref().map(str::parse::<Twist>).transpose();
        let acceleration = self.acceleration.as_deref().map(str::parse::<Acceleration>).transpose();
        let (twist, acceleration) = (twist.map_err(Failure::input)?, acceleration.map_err(Failure::input)?);
        let is_asked = twist.is_some() || acceleration.is_some();
        Ok(is_asked.then(|| Motion {
            twist: twist.map_or([0.0; 3], |Twist(twist)| twist),
            acceleration: acceleration.map_or([0.0; 3], |Acceleration(acceleration)| acceleration),
        }))
    }
}
