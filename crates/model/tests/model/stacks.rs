//! Joints that are bodies, and legs in layers of their own.

use glam::DVec2;
use kinefront_model::certify::{CertifyOptions, Verdict};
use kinefront_model::clearance::{Capsule, StackOrder, Stacking};
use kinefront_model::evaluation::{GridChoice, Model, PoseScalar};
use kinefront_model::mechanism::{
    AnyLeg, Architecture, CylinderSize, Design, JointKind, JointPoint, JointSizes, Manipulator, MemberKind,
};

use crate::clearance::Random;
use crate::strategies::{model, parsed};
use kinefront_testkit::oracle::distance_to_cylinder;
use kinefront_testkit::repetitions;

/// A joint or a motor as it is defined.
struct Cylinder {
    leg: usize,
    point: JointPoint,
    at: DVec2,
    radius: f64,
    heights: [f64; 2],
}

/// Returns the joints of a design whose members lie as the capsules do.
fn cylinders(model: &Model, design: &Design, points: [[[f64; 2]; 3]; 3], capsules: &[Capsule]) -> Vec<Cylinder> {
    let chain = design.architecture().chain();
    let sizes = model.settings().joint_sizes;
    let height = |leg: usize, kind: MemberKind| {
        let own = capsules
            .iter()
            .find(|capsule| capsule.member.leg == leg && capsule.member.kind == kind);
        own.map(|capsule| capsule.from.z)
    };
    let firsts = [0, 1, 2].map(|leg| height(leg, chain.proximal.unwrap_or(chain.distal)).expect("the first member"));
    // The legs share their layers.
    let base = firsts[0];
    let mut all = Vec::new();
    for leg in 0..3 {
        let distal = height(leg, chain.distal).expect("the distal member");
        let proximal = chain.proximal.and_then(|kind| height(leg, kind));
        for joint in (0..3).filter(|&joint| chain.joints[joint] == JointKind::Revolute) {
            let point = match chain.points[joint] {
                // A telescopic leg has B at A.
                JointPoint::B if proximal.is_none() => JointPoint::A,
                point => point,
            };
            let ends = match point {
                JointPoint::A => [proximal.unwrap_or(distal), base],
                JointPoint::B => [distal, proximal.expect("a proximal member")],
                JointPoint::C => [height(leg, MemberKind::PlatformBar).expect("the platform"), distal],
            };
            let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let middle = 0.5 * (low + high);
            let CylinderSize { radius, height } = sizes.revolute;
            let at = DVec2::from_array(points[leg][point as usize]);
            let thinnest = match point {
                JointPoint::C => design.leg_bar_radius().min(design.platform_bar_radius()),
                _ => design.leg_bar_radius(),
            };
            all.push(Cylinder {
                leg,
                point,
                at,
                radius: radius.max(thinnest),
                heights: [low.min(middle - 0.5 * height), high.max(middle + 0.5 * height)],
            });
            if design.architecture().driven() == joint {
                all.push(Cylinder {
                    leg,
                    point,
                    at,
                    radius: sizes.motor.radius,
                    heights: [high, high + sizes.motor.height],
                });
            }
        }
    }
    all
}

/// Whether a joint is at an end of a member.
fn is_at_end(cylinder: &Cylinder, capsule: &Capsule, has_proximal: bool) -> bool {
    use JointPoint::{A, B, C};
    let of_member: &[JointPoint] = match capsule.member.kind {
        // The platform is rigid.
        MemberKind::PlatformBar => return cylinder.point == C,
        MemberKind::Slider => &[B],
        MemberKind::Crank | MemberKind::TurningGuide => &[A, B],
        MemberKind::TelescopicLeg => &[A, C],
        _ if has_proximal => &[B, C],
        _ => &[A, B, C],
    };
    capsule.member.leg == cylinder.leg && of_member.contains(&cylinder.point)
}

/// Distance of two upright cylinders.
fn between(a: &Cylinder, b: &Cylinder) -> f64 {
    let across = a.at.distance(b.at) - a.radius - b.radius;
    let along = (a.heights[0] - b.heights[1]).max(b.heights[0] - a.heights[1]);
    if across > 0.0 || along > 0.0 {
        across.max(0.0).hypot(along.max(0.0))
    } else {
        across.max(along)
    }
}

/// The least distance of the joints from members and from each other; negative infinity where an axis is within a joint, whose depth there
/// is not measured.
fn clearance_of_joints(joints: &[Cylinder], capsules: &[Capsule], has_proximal: bool) -> f64 {
    let mut least = f64::INFINITY;
    for (index, joint) in joints.iter().enumerate() {
        for capsule in capsules
            .iter()
            .filter(|capsule| !is_at_end(joint, capsule, has_proximal))
        {
            let ends = [capsule.from, capsule.to].map(|end| end.to_array());
            let axis = distance_to_cylinder(ends, joint.at.to_array(), joint.radius, joint.heights);
            let clear = if axis > 0.0 {
                axis - capsule.radius
            } else {
                f64::NEG_INFINITY
            };
            least = least.min(clear);
        }
        for other in &joints[..index] {
            let shares = other.leg == joint.leg
                && (other.point != JointPoint::A || joint.point != JointPoint::C || !has_proximal);
            let is_rigid = other.point == joint.point && joint.point != JointPoint::B;
            if !shares && !is_rigid {
                least = least.min(between(joint, other));
            }
        }
    }
    least
}

/// The clearance at random poses is the least distance of capsules and upright cylinders that a library finds.
#[test]
fn joints_keep_their_distance() {
    let mut random = Random::new(5);
    for &architecture in Architecture::ALL {
        let (mut compared, mut decisive) = (0, 0);
        for _ in 0..repetitions(4000, 100_000) {
            let (mut settings, design) = random.subject(architecture);
            let mut size = |most: f64| CylinderSize {
                radius: random.between(0.01, most),
                height: random.between(0.0, 0.4),
            };
            settings.joint_sizes = JointSizes {
                revolute: size(0.15),
                motor: size(0.2),
            };
            let model = Model::new(settings.clone()).expect("the grids fit");
            settings.joint_sizes = JointSizes::default();
            let without = Model::new(settings).expect("the grids fit");
            let pose = random.pose();
            let Ok(report) = model.pose(&design, &pose) else {
                continue;
            };
            let manipulator = Manipulator::<AnyLeg>::new(&design, &model.settings().legs);
            let posture = manipulator.posture(&pose).expect("reachable");
            let capsules = model.bodies_of(&design).capsules(&manipulator, pose.position, &posture);
            let points = [0, 1, 2].map(|leg| {
                let anchor = manipulator.legs[leg];
                let a = kinefront_model::mechanism::Leg::frame(&anchor).anchor.to_array();
                [a, report.b[leg], report.c[leg]]
            });
            let joints = cylinders(&model, &design, points, &capsules);
            let of_members = without.pose(&design, &pose).expect("reachable").nearest.distance;
            let has_proximal = architecture.chain().proximal.is_some();
            let least = of_members.min(clearance_of_joints(&joints, &capsules, has_proximal));
            let found = report.nearest.distance;
            if least.is_finite() {
                assert!(
                    (found - least).abs() < 1e-4,
                    "{design} at {pose:?}: {found} instead of {least}, {:?}",
                    report.nearest.pair()
                );
            } else {
                assert!(found < 0.0, "{design} at {pose:?}: {found}");
            }
            compared += 1;
            decisive += usize::from(found < of_members - 1e-9);
        }
        assert!(
            compared > 20 && decisive > 5,
            "{architecture}: {decisive} of {compared}"
        );
    }
}

/// A design whose legs cross in the plane.
const CROSSING: &str = "3-RPR R=0.99 r=0.67 Lb=2.21 rj=0.019 rp=0.018";

/// A model with a required clearance.
fn stacked(stacking: Stacking) -> Model {
    model(|settings| {
        settings.thresholds.set(PoseScalar::Clearance, Some(0.004));
        settings.bodies.stacking = stacking;
    })
}

/// Legs that cross in the plane do not collide in layers of their own, where the pins of their joints are bodies.
#[test]
fn legs_in_layers_of_their_own_may_cross() {
    let design = parsed(CROSSING);
    let [common, chosen] = [Stacking::Common, Stacking::Chosen].map(stacked);
    assert_eq!(common.stack_of(&design).order, StackOrder::Common);
    assert!(matches!(chosen.stack_of(&design).order, StackOrder::Legs(_)));
    assert!(common.evaluate(&design, GridChoice::Reference).home.is_none());
    let evaluation = chosen.evaluate(&design, GridChoice::Reference);
    let home = evaluation.home.expect("a workspace");
    assert!(evaluation.workspace_radius() > 0.3, "{}", evaluation.workspace_radius());
    // The legs are in three layers, and a pin that passes through one of them is the nearest body.
    let members = chosen.members(&design, &home).expect("reachable");
    let height = |leg: usize| {
        let mut legs = members.iter().filter(|report| report.member.leg == leg);
        let own = legs.find(|report| report.member.kind == MemberKind::TelescopicLeg);
        own.expect("a leg").from.z
    };
    assert!(height(0) != height(1) && height(1) != height(2) && height(0) != height(2));
    let pair = evaluation.nearest.expect("a nearest pair").pair();
    assert!(pair.iter().any(|name| name.contains("joint")), "{pair:?}");
    // Where the common layers suffice, they are kept.
    let apart = parsed("3-PRR R=4.0 r=2.12 Lb=3.3 rj=0.029 rp=0.073");
    assert_eq!(chosen.stack_of(&apart), common.stack_of(&apart));
}

/// The clearance of a workspace in layers of their own is proved with the same heights as it is evaluated.
#[test]
fn a_workspace_in_chosen_layers_is_proved() {
    let (design, model) = (parsed(CROSSING), stacked(Stacking::Chosen));
    let evaluation = model.evaluate(&design, GridChoice::Fine);
    let certify = |claimed_radius: f64| {
        let options = CertifyOptions {
            phi_deg: evaluation.home_phi_deg.expect("a workspace"),
            claimed_radius,
            tolerance: 1e-3,
            ..CertifyOptions::default()
        };
        model.certify(&design, &options).expect("a certificate")
    };
    let radius = evaluation.workspace_radius();
    assert_eq!(certify(0.999 * radius).verdict, Verdict::Proved);
    let beyond = certify(1.01 * radius);
    assert_eq!(beyond.verdict, Verdict::Refuted);
    assert!(
        beyond.upper.is_some_and(|upper| upper < 1.001 * radius),
        "{beyond:?} {radius}"
    );
}
