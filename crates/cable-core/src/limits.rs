//! Whether an answer stays within what its cables stand: service and breaking tension, bend radius.

use crate::scene::Cable;
use crate::solution::{CableSolution, Node, Warning, WarningKind};
use crate::strand::Break;

/// Appends what a cable's answer exceeds, each kind once, at its worst place.
pub(crate) fn warn(cable: &Cable, answer: &CableSolution, out: &mut Vec<Warning>) {
    if let Some(top) = worst(&answer.nodes, |n| n.tension_n) {
        tension(cable, top, out);
    }
    let radius_limit = cable.min_bend_radius_m;
    if radius_limit > 0.0
        && let Some(sharp) = worst(&answer.nodes, |n| n.curvature_per_m.abs())
        && sharp.curvature_per_m.abs() * radius_limit > 1.0
    {
        let radius = 1.0 / sharp.curvature_per_m.abs();
        let message = format!(
            "`{}` is bent to a radius of {radius:.4} m at {:.3} m ({:.3} m, {:.3} m), below the {radius_limit} m it allows: lead it round something wider there",
            cable.name, sharp.arc_length_m, sharp.x_m, sharp.y_m
        );
        let limits = [radius, radius_limit];
        out.push(Warning::new(WarningKind::BendRadius, &cable.name, sharp.arc_length_m, limits, message));
    }
}

/// Appends where it has broken.
pub(crate) fn broken(cable: &Cable, breaks: &[Break], out: &mut Vec<Warning>) {
    for b in breaks {
        let (s, t, x, y, limit) = (b.arc_length_m, b.time_s, b.at.x, b.at.y, cable.breaking_tension_n);
        let (how, rest) = match &b.torn_off {
            Some(support) => (format!("tore off `{support}`"), "the rest goes on without it"),
            None => ("broke".to_owned(), "the pieces go on apart"),
        };
        let message = format!(
            "`{}` {how} at {s:.3} m ({x:.3} m, {y:.3} m) at {t:.4} s, where its tension reached its breaking tension of {limit} N: {rest}; pull less, or take a stronger cable",
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
            "it would break; the answer is that of a cable that does not",
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
    out.push(Warning::new(kind, &cable.name, top.arc_length_m, [top.tension_n, limit], message));
}

/// The node with the greatest value (none that is not a number).
fn worst(nodes: &[Node], value: impl Fn(&Node) -> f64) -> Option<&Node> {
    nodes.iter().filter(|n| !value(n).is_nan()).max_by(|a, b| value(a).total_cmp(&value(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::catalog;

    fn warnings(nodes: &[Node]) -> Vec<Warning> {
        let cable = Cable {
            service_tension_n: 800.0,
            breaking_tension_n: 10_000.0,
            min_bend_radius_m: 0.14,
            ..catalog::hanging_span().cables.remove(0)
        };
        let mut out = Vec::new();
        warn(&cable, &CableSolution { nodes: nodes.to_vec(), ..CableSolution::default() }, &mut out);
        out
    }

    #[test]
    fn each_limit_is_named_at_its_worst_place() {
        let at = |arc_length_m, tension_n, curvature_per_m| Node {
            arc_length_m,
            tension_n,
            curvature_per_m,
            ..Node::default()
        };
        assert!(warnings(&[]).is_empty());
        assert!(warnings(&[at(0.0, 799.0, 7.0), at(1.0, 10.0, 0.0)]).is_empty());
        let w = warnings(&[at(0.0, 801.0, 0.0), at(1.0, 900.0, 0.0)]);
        assert_eq!((w.len(), w[0].kind, w[0].arc_length_m), (1, WarningKind::ServiceTension, 1.0));
        assert!(w[0].message.contains("900.0 N at 1.000 m"), "{}", w[0].message);
        let w = warnings(&[at(0.0, 10_001.0, 0.0), at(2.0, 1.0, -10.0)]);
        assert_eq!([w[0].kind, w[1].kind], [WarningKind::BreakingTension, WarningKind::BendRadius]);
        assert_eq!((w[1].arc_length_m, w[1].value), (2.0, 0.1));
    }
}
