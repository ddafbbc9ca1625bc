//! This module pushes nodes and bars of a shape out of obstacles.

use crate::contact::Gap;
use crate::math::Vec2;
use crate::model::fem::mesh::Mesh;
use crate::problem::Problem;

/// Part of a point of a bar that must be free for its nodes to move the point out: held nodes do
/// not. Smaller: a free node beside a held one is thrown a hundred times as far; larger: points
/// beside supports stay inside. A choice, tuned on no campaign.
const LEAST_FREE_SHARE: f64 = 0.01;
/// Lack of a gap from which a point is pushed out, as a fraction of the gap. Smaller: more rounds
/// for points that are clear already; larger: points are left at the surface.
const MIN_LACK_FRACTION: f64 = 0.5;

/// Maximum number of passes that push the first shape out of obstacles. Ten are enough for routes
/// drawn within a diameter.
const MAX_PASSES: usize = 60;

/// Depth (m) inside an obstacle up to which a first shape is detected and pushed out.
const DEPENETRATION_DEPTH: f64 = 0.5;

/// Pushes free nodes and segments out of obstacles until every gap is at least half of `clear` (m)
/// or the passes are spent.
pub fn depenetrate(problem: &Problem, mesh: &Mesh, x: &mut [Vec2], clear: f64) {
    push_chain_out(problem, &mesh.fixity, &|e, feature| mesh.rounds(e).contains(&Some(feature)), x, clear);
}

/// Pushes out a chain whose nodes may be `held` and whose bars may lie on rounds.
pub fn push_chain_out(
    problem: &Problem,
    fixity: &[bool],
    lies_on: &dyn Fn(usize, usize) -> bool,
    x: &mut [Vec2],
    clear: f64,
) {
    let mut gaps: Vec<Gap> = Vec::new();
    for _ in 0..MAX_PASSES {
        let mut moved = false;
        for k in (0..x.len()).filter(|&k| !fixity[k]) {
            if let Some(g) = problem.world.signed_gap(x[k], DEPENETRATION_DEPTH)
                && g.gap_m < 0.5 * clear
            {
                x[k] += g.normal * (clear - g.gap_m);
                moved = true;
            }
        }
        for e in 0..x.len().saturating_sub(1) {
            gaps.clear();
            problem.world.segment_gaps(x[e], x[e + 1], clear, &mut gaps);
            let inside = |g: &&Gap| g.fraction > 0.0 && g.fraction < 1.0 && !lies_on(e, g.feature);
            for g in gaps.iter().filter(inside) {
                let inside = problem.world.geometry().outward_of(g).is_some_and(|o| o.dot(&g.normal) < 0.0);
                let distance = (x[e] + (x[e + 1] - x[e]) * g.fraction - g.point).norm();
                // A segment that cuts off a corner is nearest to it from inside.
                let (way, lack) =
                    if inside { (-g.normal, clear - g.gap_m + 2.0 * distance) } else { (g.normal, clear - g.gap_m) };
                if lack > MIN_LACK_FRACTION * clear {
                    let shares = [1.0 - g.fraction, g.fraction];
                    let free = [0, 1].map(|j| if fixity[e + j] { 0.0 } else { shares[j] });
                    let sum = free[0] * shares[0] + free[1] * shares[1];
                    if sum > LEAST_FREE_SHARE {
                        x[e] += way * (lack * free[0] / sum);
                        x[e + 1] += way * (lack * free[1] / sum);
                        moved = true;
                        break;
                    }
                }
            }
        }
        if !moved {
            return;
        }
    }
}
