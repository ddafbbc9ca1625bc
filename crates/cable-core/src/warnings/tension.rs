//! Tension warnings tell of tension above a limit, of breaks, and of slack.

use crate::breakage::Break;
use crate::math::Vec2;
use crate::problem::Problem;
use crate::scene::Cable;
use crate::solution::{CableSolution, Node, TensionPeaks, Warning, WarningKind};

/// Below this part of the whole load a point has no tension to speak of. Larger: the low point of a
/// slack span counts; smaller: friction on the ground leaves enough that nothing is ever slack.
const SLACK_TENSION: f64 = 0.01;

/// Shortest slack part, of the cable's length, that is named. Shorter: every end that lies on the
/// ground is; longer: bights that a robot can run over are not. The low point of a hanging span,
/// however deep, is slack over 2 % of it at most.
const SLACK_PART: f64 = 0.05;

/// Material between two nodes that lies in folds is longer than their distance by more than this
/// part of itself. Smaller: rounding; larger: folds spread over much ground are not seen.
const FOLDED_PART: f64 = 1e-3;

/// Material that lies in folds beyond the ground it has, of the cable's length, that is worth a
/// word. Smaller: every lay that was pushed together a little; larger: 10 m lie on 9.9 m of ground
/// without a word.
const FOLDED_LENGTH: f64 = 5e-3;

/// Appends the tension limit that is exceeded, at the worst place: of a cable in motion by any
/// inner step of the last step, and the breaking tension by what was held.
pub(super) fn limits(cable: &Cable, answer: &CableSolution, out: &mut Vec<Warning>) {
    match answer.peaks {
        Some(peaks) => jerk(cable, answer, &peaks, out),
        None => {
            if let Some(top) = worst(&answer.nodes, |n| n.tension_n) {
                tension(cable, top, out);
            }
        }
    }
}

/// The greatest tension of an answer and of the inner steps before it, N.
pub(super) fn greatest(answer: &CableSolution) -> f64 {
    let before = answer.peaks.map_or(0.0, |p| p.greatest.tension_n);
    answer.nodes.iter().map(|n| n.tension_n).fold(before, |a, b| if b > a { b } else { a })
}

/// What a cable in motion is pulled with.
fn jerk(cable: &Cable, answer: &CableSolution, peaks: &TensionPeaks, out: &mut Vec<Warning>) {
    let (service_n, breaking_n, over_s) = (cable.service_tension_n, cable.breaking_tension_n, peaks.over_s);
    let TensionPeaks { greatest, held, .. } = *peaks;
    let (kind, top, limit, what) = if held.tension_n > breaking_n {
        let what = format!(
            "in the mean over {over_s} s, above its breaking tension of {breaking_n} N: it would break here; the figures assume that it does not"
        );
        (WarningKind::BreakingTension, held, breaking_n, what)
    } else if greatest.tension_n > breaking_n {
        let what = format!(
            "for an instant, above its service tension of {service_n} N and its breaking tension of {breaking_n} N. It holds, as its mean over {over_s} s is {:.1} N at most; but how high such an instant is hangs on loss and mesh",
            held.tension_n
        );
        (WarningKind::ServiceTension, greatest, service_n, what)
    } else if greatest.tension_n > service_n {
        let what = format!(
            "above its service tension of {service_n} N: it wears out early; lengthen the cable or lighten the load"
        );
        (WarningKind::ServiceTension, greatest, service_n, what)
    } else {
        return;
    };
    let at = at(&answer.nodes, top.arc_length_m);
    let message = format!(
        "`{}` is pulled with {:.1} N at {:.3} m ({:.3} m, {:.3} m) at {:.4} s, {what}",
        cable.name, top.tension_n, top.arc_length_m, at.x, at.y, top.time_s
    );
    let warning = Warning::new(kind, &cable.name, top.arc_length_m, [top.tension_n, limit], message);
    out.push(Warning { at_m: Some([at.x, at.y]), ..warning });
}

/// Where a point of the cable is, m.
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
        None => loose(problem, answer, out),
    }
}

/// What lies without tension on less ground than it is long.
fn folds(problem: &Problem, answer: &CableSolution) -> Option<Warning> {
    let limit_n = SLACK_TENSION * problem.force_scale();
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
    let name = &problem.cable.name;
    let what = if anywhere { "way" } else { "ground" };
    let message = format!(
        "{material:.2} m of `{name}` lie without tension in folds on {ground:.2} m of {what}, most of it at {:.3} m ({:.3} m, {:.3} m): in a plane layers and loops cannot be seen, so how they lie is left open; shorten the cable or give it more ground",
        at.arc_length_m, at.x_m, at.y_m
    );
    let warning = Warning::new(WarningKind::Slack, name, at.arc_length_m, [over, least], message);
    (over > least).then_some(Warning { at_m: Some([at.x_m, at.y_m]), ..warning })
}

/// Appends the longest part without tension.
fn loose(problem: &Problem, answer: &CableSolution, out: &mut Vec<Warning>) {
    let limit_n = SLACK_TENSION * problem.force_scale();
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
    let least = SLACK_PART * problem.length;
    // Nothing has been solved yet where no node has tension.
    let solved = answer.nodes.iter().any(|n| n.tension_n > limit_n);
    if let Some((length, run)) = longest.filter(|(l, _)| *l >= least && solved)
        && let Some(middle) = run.get(run.len() / 2)
    {
        let message = format!(
            "{length:.2} m of `{}` round {:.3} m ({:.3} m, {:.3} m) have less than {limit_n:.3} N of tension: this part may be run over, snag or loop; shorten the cable or pull it in",
            problem.cable.name, middle.arc_length_m, middle.x_m, middle.y_m
        );
        let name = &problem.cable.name;
        let warning = Warning::new(WarningKind::Slack, name, middle.arc_length_m, [length, least], message);
        out.push(Warning { at_m: Some([middle.x_m, middle.y_m]), ..warning });
    }
}

/// Appends where it has broken.
pub(super) fn broken(cable: &Cable, breaks: &[Break], out: &mut Vec<Warning>) {
    for b in breaks {
        let (s, t, x, y, limit) = (b.arc_length_m, b.time_s, b.at.x, b.at.y, cable.breaking_tension_n);
        let (how, rest) = match &b.detached_from {
            Some(support) => (format!("tore off `{support}`"), "the rest goes on without it"),
            None => ("broke".to_owned(), "the pieces go on apart"),
        };
        let held = match b.over_s {
            over_s if over_s > 0.0 => format!("the mean of its tension over {over_s} s"),
            _ => "its tension".to_owned(),
        };
        let message = format!(
            "`{}` {how} at {s:.3} m ({x:.3} m, {y:.3} m) at {t:.4} s, where {held} reached its breaking tension of {limit} N: {rest}; pull less, or take a stronger cable",
            cable.name
        );
        let warning = Warning::new(WarningKind::Broken, &cable.name, s, [limit, limit], message);
        out.push(Warning { at_m: Some([x, y]), since_s: Some(t), ..warning });
    }
}

fn tension(cable: &Cable, top: &Node, out: &mut Vec<Warning>) {
    let (kind, limit, what) = if top.tension_n > cable.breaking_tension_n {
        (
            WarningKind::BreakingTension,
            cable.breaking_tension_n,
            "it would break here; the figures assume that it does not",
        )
    } else if top.tension_n > cable.service_tension_n {
        (
            WarningKind::ServiceTension,
            cable.service_tension_n,
            "it wears out early; lengthen the cable or lighten the load",
        )
    } else {
        return;
    };
    let name = if kind == WarningKind::BreakingTension { "breaking" } else { "service" };
    let message = format!(
        "`{}` is pulled with {:.1} N at {:.3} m ({:.3} m, {:.3} m), above its {name} tension of {limit} N: {what}",
        cable.name, top.tension_n, top.arc_length_m, top.x_m, top.y_m
    );
    let warning = Warning::new(kind, &cable.name, top.arc_length_m, [top.tension_n, limit], message);
    out.push(Warning { at_m: Some([top.x_m, top.y_m]), ..warning });
}

/// The node with the greatest value (none that is not a number).
fn worst(nodes: &[Node], value: impl Fn(&Node) -> f64) -> Option<&Node> {
    nodes.iter().filter(|n| !value(n).is_nan()).max_by(|a, b| value(a).total_cmp(&value(b)))
}
