//! The line and the loads of a leg over a box of poses.

use super::DrivenLeg;
use super::line::DistalGeometry;
use crate::enclosure::{PlanarModel, PoseEnclosure, TaylorModel, cross, dot};
use crate::mechanism::{Chain, ChainEnclosure, EnclosedLoads, LegEnclosure, LegToEnclose};

impl<C: Chain, const DRIVEN: usize> DrivenLeg<C, DRIVEN> {
    /// Encloses the leg over a box of poses.
    pub(in crate::mechanism) fn enclose(leg: &LegToEnclose<'_>, pose: &PoseEnclosure) -> LegEnclosure {
        let frame = leg.frame;
        let arm = frame.arm(pose);
        let chain = C::enclose(leg, pose.position, arm);
        // As multiples of r: along the distal bar, and the moment of its line.
        let multiple = frame.arm_multiple;
        let (along, across) = (
            dot(arm, chain.tangent).scaled(multiple),
            cross(arm, chain.tangent).scaled(multiple),
        );
        if Self::IS_ALONG_DISTAL {
            return LegEnclosure {
                u: chain.tangent,
                moment: across,
                along,
                across,
                transmission_square: Self::distal_transmission_square(&chain),
                loads: None,
                arm,
                chain,
            };
        }
        let radius = frame.platform_radius;
        let geometry = DistalGeometry {
            arm: [along.scaled(radius), -across.scaled(radius)],
            offset: chain.offset,
            proximal: chain.proximal.map(|bar| [bar.vector, bar.direction]),
            chord: Self::enclosed_chord(&chain),
            guides: chain.guides,
        };
        let line = Self::line(&geometry);
        let [distal, proximal, platform] = line.loads(&geometry, [along, across], chain.signed_beam);
        let [x, y] = line.u;
        let normal = [-chain.tangent[1], chain.tangent[0]];
        LegEnclosure {
            u: [0, 1].map(|k| chain.tangent[k] * x + normal[k] * y),
            moment: line.moments[3].scaled(frame.per_platform_radius),
            along,
            across,
            transmission_square: line.transmission.squared(),
            loads: Some(EnclosedLoads {
                distal,
                proximal,
                platform,
            }),
            arm,
            chain,
        }
    }

    /// Encloses the square of the transmission for a line along the distal bar.
    fn distal_transmission_square(chain: &ChainEnclosure) -> TaylorModel {
        match (chain.lever_square, chain.guides[DRIVEN], chain.proximal) {
            (Some(square), ..) => square,
            (None, Some([x, _]), _) => x.squared(),
            (None, None, Some(bar)) => bar.vector[1].squared(),
            (None, None, None) => TaylorModel::exactly(0.0),
        }
    }

    /// Encloses the unit vector from `A_i` to `C_i` in the distal axes, if the line may lead along it.
    fn enclosed_chord(chain: &ChainEnclosure) -> Option<PlanarModel> {
        chain.proximal.filter(|_| Self::IS_ALONG_CHORD).map(|bar| {
            let chord = [bar.vector[0] + chain.offset, bar.vector[1]];
            let to_unit = dot(chord, chord).sqrt().reciprocal();
            chord.map(|part| part * to_unit)
        })
    }
}
