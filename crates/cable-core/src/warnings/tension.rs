//! Tension warnings report tension above a limit, breaks, and slack.

use crate::breakage::Break;
use crate::math::Vec2;
use crate::problem::Problem;
use crate::scene::Cable;
use crate::solution::{CableSolution, MeanTension, Node, TensionPeaks, Warning, WarningCause};

/// Below this part of the whole load a point has no tension to speak of. Larger: the low point of a
/// slack span counts; smaller: friction on the ground leaves enough that nothing is ever slack.
const SLACK_TENSION_FRACTION: f64 = 0.01;

/// Shortest slack part, of the cable's length, that is named. Shorter: every end that lies on the
/// ground is; longer: bights that a robot can run over are not. The low point of a hanging span,
/// however deep, is slack over 2 % of it at most.
const LEAST_SLACK_PART_FRACTION: f64 = 0.05;

/// Material between two nodes that lies in folds is longer than their distance by more than this
/// part of itself. Smaller: rounding; larger: folds spread over much ground are not seen.
const FOLDED_PART: f64 = 1e-3;

/// Material that lies in folds beyond the ground it has, of the cable's length, that is worth a
/// word. Smaller: every lay that was pushed together a little; larger: 10 m lie on 9.9 m of ground
/// without a word.
const FOLDED_LENGTH: f64 = 5e-3;

/// Appends the tension limit that is exceeded, at the worst place: of a cable in motion by any
/// inner step of the last step, and the breaking tension by what was held.
pub(super) fn limits(cable: &Cable, answer: &CableSolution, breaks: &[Break], out: &mut Vec<Warning>) {
    match answer.peaks {
        Some(peaks) => jerk(cable, answer, &peaks, breaks, out),
        None => {
            if let Some(top) = worst(&answer.nodes, |n| n.tension_n) {
                warn_tension(cable, top, out);
            }
        }
    }
}

/// The greatest tension of an answer and of the inner steps before it, N.
pub(super) fn greatest(answer: &CableSolution) -> f64 {
    let before = answer.peaks.map_or(0.0, |p| p.greatest.tension_n);
    answer.nodes.iter().map(|n| n.tension_n).fold(before, |a, b| if b > a { b } else { a })
}

/// Warns of jerks of a cable in motion, or of the pieces of one that broke.
fn jerk(cable: &Cable, answer: &CableSolution, peaks: &TensionPeaks, breaks: &[Break], out: &mut Vec<Warning>) {
    let (service_n, breaking_n, over_s) = (cable.service_tension_n, cable.breaking_tension_n, peaks.over_s);
    let TensionPeaks { greatest, held, .. } = *peaks;
    let (cause, top, limit) = if held.tension_n > breaking_n {
        let mean = MeanTension { over_s, time_s: held.time_s };
        let cause = match breaks {
            [] => WarningCause::AboveBreaking { mean: Some(mean) },
            [..] => WarningCause::AboveBreakingAfterBreak { mean },
        };
        (cause, held, breaking_n)
    } else if greatest.tension_n > breaking_n {
        let (time_s, held_n) = (greatest.time_s, held.tension_n);
        (WarningCause::BrieflyAboveBreaking { time_s, breaking_n, held_n, over_s }, greatest, service_n)
    } else if greatest.tension_n > service_n {
        (WarningCause::AboveService { time_s: Some(greatest.time_s) }, greatest, service_n)
    } else {
        return;
    };
    let at = at(&answer.nodes, top.arc_length_m);
    out.push(Warning::new(cause, &cable.name, top.arc_length_m, [top.tension_n, limit]).at(at.into()));
}

/// Returns where a point of the cable is, m.
fn at(nodes: &[Node], s: f64) -> Vec2 {
    let k = nodes.partition_point(|n| n.arc_length_m < s);
    match (k.checked_sub(1).and_then(|k| nodes.get(k)), nodes.get(k)) {
        (Some(a), Some(b)) => {
            a.at() + (b.at() - a.at()) * ((s - a.arc_length_m) / (b.arc_length_m - a.arc_length_m)).clamp(0.0, 1.0)
        }
        (Some(n), None) | (None, Some(n)) => n.at(),
        (None, None) => Vec2::zeros(),
    }
}

/// Appends how much cable lies in folds, or else the longest part without tension.
pub(super) fn slack(problem: &Problem, answer: &CableSolution, out: &mut Vec<Warning>) {
    match folds(problem, answer) {
        Some(warning) => out.push(warning),
        None => warn_slack_part(problem, answer, out),
    }
}

/// Returns what lies without tension on less ground than it is long.
fn folds(problem: &Problem, answer: &CableSolution) -> Option<Warning> {
    let limit_n = SLACK_TENSION_FRACTION * problem.force_scale();
    // Seen from above, and where nothing weighs, it can lie anywhere.
    let anywhere = problem.weight.norm() == 0.0;
    let lies = |s: f64| anywhere || answer.contacts.iter().any(|c| c.begins_m <= s && s <= c.ends_m);
    let (mut material, mut ground, mut most) = (0.0, 0.0, 0.0);
    let mut middle = None;
    for pair in answer.pieces().flat_map(|p| p.windows(2)) {
        let [a, b] = pair else { continue };
        let (length, way) = (b.arc_length_m - a.arc_length_m, (b.at() - a.at()).norm());
        let over = length * problem.thermal_stretch - way;
        let slack = a.tension_n <= limit_n && b.tension_n <= limit_n;
        if slack && over > FOLDED_PART * length && lies(0.5 * (a.arc_length_m + b.arc_length_m)) {
            material += length;
            ground += way;
            if over > most {
                (most, middle) = (over, Some(a));
            }
        }
    }
    let (over, least, at) = (material - ground, FOLDED_LENGTH * problem.length, middle?);
    let cause = WarningCause::Folds { material_m: material, ground_m: ground, on_ground: !anywhere };
    let warning = Warning::new(cause, &problem.cable.name, at.arc_length_m, [over, least]);
    (over > least).then_some(warning.at([at.x_m, at.y_m]))
}

/// Appends the longest part without tension.
fn warn_slack_part(problem: &Problem, answer: &CableSolution, out: &mut Vec<Warning>) {
    let limit_n = SLACK_TENSION_FRACTION * problem.force_scale();
    let mut longest: Option<(f64, &[Node])> = None;
    for piece in answer.pieces() {
        for run in piece.chunk_by(|a, b| a.tension_n < limit_n && b.tension_n < limit_n) {
            if let [first, .., last] = run {
                let length = last.arc_length_m - first.arc_length_m;
                if longest.is_none_or(|(l, _)| length > l) {
                    longest = Some((length, run));
                }
            }
        }
    }
    let least = LEAST_SLACK_PART_FRACTION * problem.length;
    // Nothing has been solved yet where no node has tension.
    let solved = answer.nodes.iter().any(|n| n.tension_n > limit_n);
    if let Some((length, run)) = longest.filter(|(l, _)| *l >= least && solved)
        && let Some(middle) = run.get(run.len() / 2)
    {
        let cause = WarningCause::LowTension { below_n: limit_n };
        let warning = Warning::new(cause, &problem.cable.name, middle.arc_length_m, [length, least]);
        out.push(warning.at([middle.x_m, middle.y_m]));
    }
}

/// Appends where it has broken.
pub(super) fn broken(cable: &Cable, breaks: &[Break], out: &mut Vec<Warning>) {
    for b in breaks {
        let limit = cable.breaking_tension_n;
        let (time_s, over_s, detached_from) = (b.time_s, b.over_s, b.detached_from.clone());
        let cause = WarningCause::Broke { time_s, over_s, detached_from };
        let warning = Warning::new(cause, &cable.name, b.arc_length_m, [limit, limit]).at(b.at.into());
        out.push(Warning { since_s: Some(time_s), ..warning });
    }
}

/// Appends a warning if the node with the greatest tension is above a limit of the cable.
fn warn_tension(cable: &Cable, top: &Node, out: &mut Vec<Warning>) {
    let (cause, limit) = if top.tension_n > cable.breaking_tension_n {
        (WarningCause::AboveBreaking { mean: None }, cable.breaking_tension_n)
    } else if top.tension_n > cable.service_tension_n {
        (WarningCause::AboveService { time_s: None }, cable.service_tension_n)
    } else {
        return;
    };
    let warning = Warning::new(cause, &cable.name, top.arc_length_m, [top.tension_n, limit]);
    out.push(warning.at([top.x_m, top.y_m]));
}

/// The node with the greatest value (none that is not a number).
fn worst(nodes: &[Node], value: impl Fn(&Node) -> f64) -> Option<&Node> {
    nodes.iter().filter(|n| !value(n).is_nan()).max_by(|a, b| value(a).total_cmp(&value(b)))
}
