//! Other loading histories would have left other tensions in a cable that rubs where it lies, and
//! for which no model knows them in closed form; an experiment estimates them.
//!
//! Friction keeps what was drawn into it. So each end of the cable is drawn out and put back, then
//! let in and put back, without inertia, each time from the rest that was found. An end moves
//! further and further until it makes no difference any more: then all that lies has slid, and the
//! friction has forgotten how it was laid. The range of the results is a lower bound: other
//! histories may leave more.

use crate::math::{Vec2, larger, smaller};
use crate::model::{Inertia, Model, ModelSource, Settings};
use crate::simulated_cable::SimulatedCable;
use crate::solution::{CableSolution, EndMove, Histories};

/// Ways of an end, of the cable's length, shortest first. Less: what is held in the middle of a
/// long cable is not reached at first; more: a cable that is nearly taut is torn rather than drawn,
/// and it takes longer.
const END_TRAVEL_FRACTIONS: [f64; 3] = [0.01, 0.02, 0.04];

/// Most elements of a cable that is drawn to and fro. More: a finer range, in a time that grows
/// with their square (540 elements on a slope took 38 s); fewer: a rest that may be another.
const MAX_ELEMENTS: usize = 100;

/// Largest work for an end in one direction, and for a step, in iterations times elements: a few
/// tenths of a second. The results found until then are kept.
const MAX_WORK: usize = 200_000;

/// Largest work of the search for the equilibrium of the copy that is moved, in the same unit: some
/// seconds. A larger value would report the range of other histories for a few scenes more, after a
/// longer wait.
const MAX_SEARCH_WORK: usize = 1_000_000;

/// Relative change of the greatest tension below which a longer displacement of an end counts as
/// making no difference: less than an engineer would act on.
const SAME_TENSION_FRACTION: f64 = 0.01;

/// Time in which an end moves, s: too short for any other motion to matter.
const MOVE_TIME_S: f64 = 1e-6;

/// The same cable at rest as the most capable model has it, on a mesh of few elements, to be
/// drawn to and fro; None where that finds no rest.
pub(super) fn exploration_copy(cable: &SimulatedCable) -> Option<SimulatedCable> {
    let elements = cable.answer().nodes.len().saturating_sub(1);
    if cable.model().capabilities().explores_histories && elements <= MAX_ELEMENTS {
        return Some(cable.clone());
    }
    let source = ModelSource::Registered(Model::MOST_CAPABLE);
    let settings = Settings { segments: Some(elements.clamp(1, MAX_ELEMENTS)), ..cable.settings() };
    let mut other = cable.rebuilt_with(source, settings).ok()?;
    other.limit_work(MAX_SEARCH_WORK);
    if refused_by_spans(cable) {
        other.start_without_spans();
    }
    other.settle().ok()?;
    Some(other)
}

/// Returns whether `spans` was asked for the cable before another model, and refused: it would
/// refuse again. Of a stiff cable it was not asked.
pub(super) fn refused_by_spans(cable: &SimulatedCable) -> bool {
    cable.refusal().is_some() && !(cable.problem().bending_stiffness > 0.0)
}

/// Other histories, and what they would have left in the cable; `sound` judges each as if it
/// were the answer.
pub(super) fn other_histories(cable: &SimulatedCable, sound: impl Fn(&CableSolution) -> bool) -> Histories {
    let answer = cable.answer();
    let tensions_here = tensions(&answer);
    let (mut moves, mut left) = (Vec::new(), vec![tensions_here]);
    let supports: Vec<_> = cable.problem().supports.iter().zip(&answer.supports).enumerate().collect();
    for &(k, (support, reaction)) in supports.first().into_iter().chain(supports.last()) {
        let pull = Vec2::new(reaction.reaction_x_n, reaction.reaction_y_n);
        let at = Vec2::new(reaction.x_m, reaction.y_m);
        let Some(inward) = pull.try_normalize(0.0).filter(|_| support.at.is_some()) else { continue };
        for direction in [-inward, inward] {
            let found = move_and_return(cable, k, at, direction, &sound);
            left.extend(found.iter().map(|f| f.tensions));
            moves.extend(found.last().map(|furthest| EndMove {
                support: support.name.clone(),
                drawn_out_m: -furthest.displacement_m * direction.dot(&inward),
                greatest_n: furthest.tensions[2],
            }));
        }
    }
    let range = |k: usize| left.iter().fold([tensions_here[k]; 2], |[a, b], t| [smaller(a, t[k]), larger(b, t[k])]);
    let (start_n, end_n, range_n) = (range(0), range(1), range(2));
    let greatest_n = tensions_here[2];
    if moves.is_empty() {
        return Histories::NotFound { greatest_n };
    }
    Histories::EndsMoved { greatest_n, moves, start_n, end_n, range_n }
}

/// Returns the tensions that are left after a support has been moved from its place (m) in a
/// direction and put back, further each time, until that makes no difference any more.
fn move_and_return(
    cable: &SimulatedCable,
    support: usize,
    place: Vec2,
    direction: Vec2,
    sound: impl Fn(&CableSolution) -> bool,
) -> Vec<ResidualTensions> {
    let tensions_here = tensions(&cable.answer());
    let mut moved = cable.clone();
    moved.limit_work(MAX_WORK);
    let (mut found, mut work): (Vec<ResidualTensions>, usize) = (Vec::new(), 0);
    for displacement_m in END_TRAVEL_FRACTIONS.map(|part| part * cable.problem().length) {
        let Some(there) = move_support_to(&mut moved, support, place + direction * displacement_m) else { break };
        let mut put_back = moved.clone();
        let Some(back) = move_support_to(&mut put_back, support, place) else { break };
        let answer = put_back.answer();
        if !sound(&answer) {
            break;
        }
        let now = tensions(&answer);
        if found.last().is_some_and(|before| same(before.tensions, now) && !same(tensions_here, now)) {
            break;
        }
        found.push(ResidualTensions { displacement_m, tensions: now });
        work += (there + back) * answer.nodes.len();
        if work > MAX_WORK {
            break;
        }
    }
    found
}

/// Draws a support to a place (m) without inertia; the iterations that it took, None where that
/// fails or breaks the cable.
fn move_support_to(cable: &mut SimulatedCable, support: usize, place: Vec2) -> Option<usize> {
    cable.drag_support(support, place);
    let report = cable.advance(MOVE_TIME_S, Inertia::QuasiStatic).ok()?;
    cable.breaks().is_empty().then_some(report.cost.iterations)
}

/// The tensions that a history left in the cable.
struct ResidualTensions {
    /// Way of the end, m.
    displacement_m: f64,
    /// Tension at the start, at the end and at most, N.
    tensions: [f64; 3],
}

fn tensions(answer: &CableSolution) -> [f64; 3] {
    let at = |n: Option<&crate::solution::Node>| n.map_or(f64::NAN, |n| n.tension_n);
    let most = answer.nodes.iter().map(|n| n.tension_n).fold(0.0, larger);
    [at(answer.nodes.first()), at(answer.nodes.last()), most]
}

/// True if no tension differs by more than an engineer would act on.
fn same(one: [f64; 3], other: [f64; 3]) -> bool {
    one.iter().zip(other).all(|(a, b)| (a - b).abs() <= SAME_TENSION_FRACTION * one[2])
}
