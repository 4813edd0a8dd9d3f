//! The line and the loads of a leg at several poses at once.

use super::DrivenLeg;
use super::line::DistalGeometry;
use crate::lanes::{Planar, Real};
use crate::mechanism::leg::{BarLoads, LegLanes, LineLoads};
use crate::mechanism::{Chain, ChainLanes, ProximalLanes};

/// Returns the components of a vector.
#[inline(always)]
fn components<V: Real>(vector: Planar<V>) -> [V; 2] {
    [vector.x, vector.y]
}

/// Returns the components of the vector along a guide, if there is one.
#[inline(always)]
#[allow(
    clippy::manual_map,
    reason = "a closure that is not inlined is compiled for the baseline processor"
)]
fn components_of<V: Real>(guide: Option<Planar<V>>) -> Option<[V; 2]> {
    match guide {
        Some(guide) => Some(components(guide)),
        None => None,
    }
}

/// Returns the vector along the bar from `A_i` to `B_i` and its unit vector, if there is one.
#[inline(always)]
#[allow(
    clippy::manual_map,
    reason = "a closure that is not inlined is compiled for the baseline processor"
)]
fn proximal_of<V: Real>(chain: &ChainLanes<V>) -> Option<[[V; 2]; 2]> {
    match chain.proximal {
        Some(ProximalLanes { vector, direction, .. }) => Some([components(vector), components(direction)]),
        None => None,
    }
}

impl<C: Chain, const DRIVEN: usize> DrivenLeg<C, DRIVEN> {
    /// Returns the transmission for a line along the distal bar: the x component of the guide, or the lever of the first joint.
    #[inline(always)]
    fn distal_transmission<V: Real>(chain: &ChainLanes<V>) -> V {
        match (chain.guides[DRIVEN], &chain.proximal) {
            (Some(guide), _) => guide.x,
            (None, Some(bar)) => -bar.vector.y,
            (None, None) => chain.offset.splat(0.0),
        }
    }

    /// Returns the unit vector from `A_i` to `C_i` in the distal axes, if the line may lead along it.
    #[inline(always)]
    fn chord_of<V: Real>(chain: &ChainLanes<V>) -> Option<[V; 2]> {
        if Self::IS_ALONG_CHORD
            && let Some(bar) = chain.proximal
        {
            let chord = Planar::new(bar.vector.x + chain.offset, bar.vector.y);
            let to_unit = chain.offset.splat(1.0) / chord.dot(chord).sqrt();
            Some(components(chord.scaled(to_unit)))
        } else {
            None
        }
    }

    /// Returns the leg of a chain: adds the line, and the loads of the bars where it is not that of the distal bar.
    #[inline(always)]
    pub(super) fn add_line<V: Real>(chain: ChainLanes<V>) -> LegLanes<V> {
        if Self::IS_ALONG_DISTAL {
            return LegLanes {
                u: chain.tangent,
                moment: chain.across,
                transmission: Self::distal_transmission(&chain),
                loads: None,
                chain,
            };
        }
        let [first, second, third] = chain.guides;
        let geometry = DistalGeometry {
            arm: [chain.along, -chain.across],
            offset: chain.offset,
            proximal: proximal_of(&chain),
            chord: Self::chord_of(&chain),
            guides: [components_of(first), components_of(second), components_of(third)],
        };
        let line = Self::line(&geometry);
        let [distal, proximal, platform] = line.loads(&geometry, [chain.along, chain.across], chain.signed_beam);
        let [x, y] = line.u;
        LegLanes {
            u: chain.tangent.scaled(x).plus(chain.tangent.perp().scaled(y)),
            moment: line.moments[3],
            transmission: line.transmission,
            loads: Some(LineLoads {
                distal: BarLoads::new(distal),
                proximal: BarLoads::new(proximal),
                platform: BarLoads::new(platform),
            }),
            chain,
        }
    }
}
