//! This module grades the nodes of a stiff cable into the boundary layers at its stations.
//!
//! Beside a clamp, a load or a support the curvature of a taut stiff cable falls as e^{−s/λ}, λ =
//! √(EI/T). The bars follow a density that gives a third of them to each end of a stretch,
//! ```text
//! ρ(s) = 1/3L + ⅓ e^{−s/cλ₀}/(cλ₀ (1 − e^{−L/cλ₀})) + the same from the other end,     ∫ρ ds = 1
//! ```
//! node i of n where ∫ρ ds = i/n. Where λ is not small against L this is nearly even.

use crate::numerics::bisect;

/// Reach c of the density in layers λ₀. Smaller: the bars grow faster than the layer fades; larger:
/// too few lie in it. Tuned on clamped spans of 50 to 400 bars with layers of 3e-4 to 0.1 of their
/// length.
const DENSITY_REACH_LAYERS: f64 = 4.0;

/// Fraction of the bars that each end of a stretch gets for its layer.
const END_LAYER_BAR_FRACTION: f64 = 1.0 / 3.0;

/// Bisections of a node's place; 60 exhaust the digits of an f64.
const BISECTIONS: usize = 60;

/// ∫₀ˢ of the layer's part of the density, over a stretch of `length`: 0 … 1.
fn layer_part(s: f64, reach: f64, length: f64) -> f64 {
    (-s / reach).exp_m1() / (-length / reach).exp_m1()
}

/// The places (m, from 0 to `length`) of the nodes of `count` bars between two ends with layers of
/// the given thickness, m.
#[must_use]
pub fn places(layers: [f64; 2], length: f64, count: usize) -> Vec<f64> {
    let reach = layers.map(|l| DENSITY_REACH_LAYERS * l);
    let part = |s: f64| {
        let ends = layer_part(s, reach[0], length) + 1.0 - layer_part(length - s, reach[1], length);
        END_LAYER_BAR_FRACTION * ends + (1.0 - 2.0 * END_LAYER_BAR_FRACTION) * s / length
    };
    let mut out = Vec::with_capacity(count + 1);
    out.push(0.0);
    for k in 1..count {
        let wanted = k as f64 / count as f64;
        let [low, high] = bisect([0.0, length], BISECTIONS, |s| part(s) < wanted);
        out.push(0.5 * (low + high));
    }
    out.push(length);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bars_grow_away_from_their_layers(
            log in (-4.0f64..1.0, -4.0f64..1.0), length in 0.1f64..1000.0, count in 1usize..300,
        ) {
            let layers = [log.0, log.1].map(|l| 10f64.powf(l) * length);
            let places = places(layers, length, count);
            prop_assert_eq!(places.len(), count + 1);
            prop_assert!(places[0] == 0.0 && places[count] == length);
            let bars: Vec<f64> = places.windows(2).map(|p| p[1] - p[0]).collect();
            prop_assert!(bars.iter().all(|&b| b > 0.0));
            // The first bar has at most its share of the layer: ∫ρ over it is 1/count.
            prop_assert!(bars[0] <= 3.0 * DENSITY_REACH_LAYERS * layers[0].min(length) * 1.6 / count as f64 || bars[0] <= 3.0 * length / count as f64);
            if count >= 50 {
                prop_assert!(bars[0] <= 0.4 * layers[0] && bars[count - 1] <= 0.4 * layers[1], "{} of {}", bars[0], layers[0]);
            }
        }

        #[test]
        fn equal_ends_give_a_mirrored_mesh(log in -4.0f64..1.0, half in 1usize..100) {
            let places = places([10f64.powf(log); 2], 1.0, 2 * half);
            prop_assert!((places[half] - 0.5).abs() < 1e-12);
            for (a, b) in places.iter().zip(places.iter().rev()) {
                prop_assert!((a + b - 1.0).abs() < 1e-12);
            }
        }
    }
}
