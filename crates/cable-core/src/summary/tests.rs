//! These tests compare the figures of a summary with closed forms.

use super::*;
use crate::analysis::{Bending, end_stiffness, neglected_bending, settle_with_bending};
use crate::model::{Model, Settings};
use crate::scene::{Motion, Obstacle, Shape, Support, catalog};
use crate::simulation::Simulation;
use crate::solution::{ContactReport, SupportReaction};

fn answered(scene: &Scene, model: Model) -> Solution {
    Simulation::new(scene.clone(), model).unwrap().settle().unwrap()
}

fn first(scene: &Scene, model: Model) -> CableSummary {
    summaries(scene, &answered(scene, model)).remove(0)
}

/// An inextensible catenary between two points of one height, for a horizontal pull: y = (H/w)
/// cosh(w x/H).
struct Catenary {
    pull: f64,
    weight: f64,
    span: f64,
}

impl Catenary {
    /// The horizontal force H (N) at which a length L hangs in a span d: 2 (H/w) sinh(w d/2H) = L,
    /// by bisection.
    fn of(length: f64, span: f64, weight: f64) -> Self {
        let long = |h: f64| 2.0 * h / weight * (0.5 * weight * span / h).sinh();
        let (mut low, mut high) = (1e-2 * weight * span, 1e6 * weight * span);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if long(middle) > length { low = middle } else { high = middle }
        }
        Self { pull: 0.5 * (low + high), weight, span }
    }

    fn half(&self) -> f64 {
        0.5 * self.weight * self.span / self.pull
    }
}

/// 12 m over 10 m, of steel so stiff that its stretch is not seen.
fn inextensible() -> (Scene, Catenary) {
    let mut scene = catalog::hanging_span();
    scene.cables[0].axial_stiffness_n = 1e11;
    let weight = scene.cables[0].linear_density_kg_per_m * scene.environment.gravity_m_per_s2;
    (scene, Catenary::of(12.0, 10.0, weight))
}

#[test]
fn a_hanging_span_reads_as_the_closed_form() {
    let (scene, exact) = inextensible();
    let s = first(&scene, Model::Auto);
    let (pull, weight, u) = (exact.pull, exact.weight, exact.half());
    let near = |a: f64, b: f64, to: f64| assert!((a / b - 1.0).abs() < to, "{a} against {b}");
    let top = pull * u.cosh();
    for (end, side) in s.ends.iter().zip([1.0, -1.0]) {
        near(end.horizontal_n, side * pull, 1e-8);
        near(end.vertical_n, -0.5 * weight * 12.0, 1e-8);
        near(end.tension_n, top, 1e-8);
        near(end.elevation_deg.unwrap(), -u.sinh().atan().to_degrees(), 1e-8);
    }
    near(s.ends[0].angle_deg.unwrap(), -u.sinh().atan().to_degrees(), 1e-8);
    near(s.ends[1].angle_deg.unwrap(), u.sinh().atan().to_degrees() - 180.0, 1e-8);
    near(s.greatest_tension.tension_n, top, 1e-8);
    near(s.least_tension.tension_n, pull, 1e-8);
    let sag = pull / weight * (u.cosh() - 1.0);
    near(s.sag.unwrap().sag_m, sag, 1e-8);
    near(s.lowest.y_m, 5.0 - sag, 1e-8);
    assert_eq!((s.lowest.arc_length_m, s.highest.y_m), (6.0, 5.0));
    near(s.tightest_bend.unwrap().radius_m, pull / weight, 1e-8);
    assert_eq!((s.lying_m, s.suspended_m, s.length_m), (0.0, 12.0, 12.0));
    assert!(s.touchdowns.is_empty() && s.friction.is_none() && s.judged_bend.is_none());
    let cable = &scene.cables[0];
    assert_eq!(s.utilisation.service_tension_ratio, s.greatest_tension.tension_n / cable.service_tension_n);
    assert_eq!(s.utilisation.breaking_tension_ratio, s.greatest_tension.tension_n / cable.breaking_tension_n);
    near(s.utilisation.bend_radius_ratio.unwrap(), cable.min_bend_radius_m * weight / pull, 1e-8);
    assert!(s.balance.unwrap().relative_residual < 1e-12, "{:?}", s.balance);
}

#[test]
fn a_stretched_and_heated_cable_is_as_long_as_it_is() {
    let mut scene = catalog::near_taut();
    scene.environment.temperature_change_k = 3.0;
    let answer = answered(&scene, Model::Auto);
    let s = summaries(&scene, &answer).remove(0);
    let cable = &scene.cables[0];
    let thermal = 1.0 + 3.0 * cable.thermal_expansion_per_k;
    let mean = 0.5 * (s.greatest_tension.tension_n + s.least_tension.tension_n) / cable.axial_stiffness_n;
    assert!((s.stretched_length_m / (cable.length_m * thermal * (1.0 + mean)) - 1.0).abs() < 1e-6, "{s:?}");
}

/// Moved by dd, the pull changes by dH/dd where L(H, d) is constant; moved up, the whole force
/// turns.
#[test]
fn end_stiffness_is_that_of_the_catenary() {
    let (scene, exact) = inextensible();
    let (weight, u) = (exact.weight, exact.half());
    // L = 2(H/w) sinh u, u = wd/2H: ∂L/∂d = cosh u, ∂L/∂H = (2/w)(sinh u − u cosh u).
    let along = u.cosh() / (2.0 / weight * (u * u.cosh() - u.sinh()));
    // With the ends v apart in height L² = v² + (2(H/w) sinh u)² keeps H to the first order in v,
    // and the upper one carries (w/2)(v coth u + L).
    let across = 0.5 * weight / u.tanh();
    let all = end_stiffness(&scene, Model::Auto, Settings::default()).unwrap();
    assert_eq!(all.len(), 2);
    for end in &all {
        let k = end.stiffness_n_per_m;
        assert!((k[0][0] / along - 1.0).abs() < 1e-5, "{k:?} against {along}");
        assert!((k[1][1] / across - 1.0).abs() < 1e-5, "{k:?} against {across}");
        assert!(k[0][1].abs() + k[1][0].abs() < 1e-5 * along, "{k:?}");
    }
    // A taut weightless rope: EA/L along it, T/L across it.
    let mut taut = scene;
    taut.environment.gravity_m_per_s2 = 0.0;
    let cable = &mut taut.cables[0];
    (cable.length_m, cable.axial_stiffness_n) = (9.99, 1e6);
    let tension = 1e6 * (10.0 / 9.99 - 1.0);
    for end in end_stiffness(&taut, Model::Auto, Settings::default()).unwrap() {
        let k = end.stiffness_n_per_m;
        assert!((k[0][0] / (1e6 / 9.99) - 1.0).abs() < 1e-6, "{k:?}");
        assert!((k[1][1] / (tension / 10.0) - 1.0).abs() < 1e-5, "{k:?} against {}", tension / 10.0);
    }
}

/// An end from which a loose cable hangs plumb carries what hangs: a metre more of it for each
/// metre that it is raised, and nothing more where it is moved aside.
#[test]
fn issue_016_an_end_over_loose_cable_is_as_stiff_as_the_cable_is_heavy() {
    for (slack, heights) in [(0.1, [1.21, 1.61]), (1.5, [0.4, 2.0])] {
        let mut scene = catalog::slack_to_floor();
        scene.loads.clear();
        let floor = Shape::Terrain { points_m: vec![[-5.0, 0.0], [10.0, 0.0]] };
        scene.obstacles = vec![Obstacle { name: "floor".into(), shape: floor, friction: Some(0.5) }];
        let cable = &mut scene.cables[0];
        (cable.diameter_m, cable.bending_stiffness_n_m2, cable.linear_density_kg_per_m) = (0.02, 0.0, 1.0);
        cable.route_m.clear();
        cable.length_m = 4.0 + heights[0] + heights[1] + slack;
        cable.supports = vec![Support::fixed("a", [0.0, heights[0]]), Support::fixed("b", [4.0, heights[1]])];
        for end in end_stiffness(&scene, Model::Auto, Settings::default()).unwrap() {
            let [[xx, xy], [yx, yy]] = end.stiffness_n_per_m;
            assert!((yy / 9.80665 - 1.0).abs() < 1e-3, "{end:?}");
            assert!(xx.abs() + xy.abs() + yx.abs() < 1e-3, "{end:?}");
        }
    }
}

/// A cable drawn over a post holds its end by friction: what is beyond the post is felt less than
/// without friction, and all models that know contact say the same.
#[test]
fn end_stiffness_in_contact_is_symmetric_and_the_same_by_all_models() {
    let mut scene = catalog::round_post();
    for s in &mut scene.cables[0].supports {
        s.motion = None::<Motion>;
    }
    let spans = end_stiffness(&scene, Model::Spans, Settings::default()).unwrap();
    let fem = end_stiffness(&scene, Model::Fem, Settings::default()).unwrap();
    for (a, b) in spans.iter().zip(&fem) {
        let [x, y] = a.stiffness_n_per_m;
        let size = x[0].abs() + y[1].abs();
        assert!(size > 0.0 && x[0] >= -1e-3 * size && y[1] >= -1e-3 * size, "{a:?}");
        for i in 0..2 {
            for j in 0..2 {
                let off = (a.stiffness_n_per_m[i][j] - b.stiffness_n_per_m[i][j]).abs();
                assert!(off < 0.05 * size, "{a:?} against {b:?}");
            }
        }
    }
}

#[test]
fn identities_hold_over_the_catalogue() {
    let mut looked = 0;
    for (id, scene) in catalog::all() {
        for model in Model::SOLVERS {
            let Some(answer) = Simulation::new(scene.clone(), model).ok().and_then(|mut s| s.settle().ok()) else {
                continue;
            };
            for (s, (cable, solved)) in summaries(&scene, &answer).iter().zip(scene.cables.iter().zip(&answer.cables)) {
                looked += 1;
                assert!((s.lying_m + s.suspended_m - cable.length_m).abs() < 1e-12 * cable.length_m, "{id} {model}");
                assert!(s.lying_m >= 0.0 && s.suspended_m >= 0.0, "{id} {model}: {s:?}");
                assert_eq!(s.greatest_tension.tension_n, answer.max_tension().tension_n, "{id} {model}");
                assert_eq!(
                    s.utilisation.service_tension_ratio * cable.service_tension_n,
                    s.greatest_tension.tension_n / cable.service_tension_n * cable.service_tension_n
                );
                assert!(s.least_tension.tension_n <= s.greatest_tension.tension_n);
                assert!(s.lowest.y_m <= s.highest.y_m && s.ends.len() == 2);
                for t in &s.touchdowns {
                    assert!(t.at.arc_length_m >= 0.0 && t.at.arc_length_m <= cable.length_m, "{id} {model}: {t:?}");
                    assert!(solved.contacts.iter().any(|c| c.obstacle == t.obstacle));
                }
                if let Some(f) = &s.friction {
                    assert!(f.used_n <= f.available_n * 1.05 && f.greatest_ratio < 1.05, "{id} {model}: {f:?}");
                }
            }
        }
    }
    assert!(looked > 25, "{looked}");
}

#[test]
fn a_cable_on_the_floor_lies_between_its_touchdowns() {
    let scene = catalog::slack_to_floor();
    let s = first(&scene, Model::Auto);
    assert!(s.lying_m > 0.0 && s.suspended_m > 0.0, "{s:?}");
    let places: Vec<(TouchKind, f64)> = s.touchdowns.iter().map(|t| (t.touch, t.at.arc_length_m)).collect();
    assert!(matches!(places.first(), Some((TouchKind::Begins, _))), "{places:?}");
}

#[test]
fn a_dead_load_at_an_end_is_counted_once() {
    let mut scene = catalog::hanging_span();
    let mut end = Support::new("load", crate::scene::SupportKind::Load);
    end.force_n = Some([40.0, -30.0]);
    scene.cables[0].supports[1] = end;
    scene.cables[0].length_m = 6.0;
    scene.loads.push(crate::scene::Load {
        cable: "cable".into(),
        arc_length_m: 3.0,
        force_n: Some([5.0, -20.0]),
        times_s: Vec::new(),
        forces_n: Vec::new(),
    });
    scene.environment.wind_n_per_m = [1.5, 0.0];
    for model in [Model::Catenary, Model::Spans, Model::Fem] {
        let b = first(&scene, model).balance.unwrap();
        assert!(b.relative_residual < 1e-8, "{model}: {b:?}");
        assert_eq!(b.loads_n, [5.0, -20.0]);
    }
}

/// A parabola of depth 1 below a chord of 1 m with a slope.
fn parabola(tilt: f64) -> (Cable, CableSolution) {
    let node = |i: i32| {
        let x = f64::from(i) / 10.0;
        Node { arc_length_m: x, x_m: x, y_m: tilt * x - 4.0 * x * (1.0 - x), ..Node::default() }
    };
    let support = |x: f64| SupportReaction { x_m: x, y_m: tilt * x, arc_length_m: x, ..SupportReaction::default() };
    let answer = CableSolution {
        nodes: (0..=10).map(node).collect(),
        supports: vec![support(0.0), support(1.0)],
        ..CableSolution::default()
    };
    (catalog::hanging_span().cables.remove(0), answer)
}

#[test]
fn sag_is_vertical_whatever_the_slope_and_square_to_the_line_in_plan() {
    for tilt in [0.0, 3.0, -2.0] {
        let (cable, answer) = parabola(tilt);
        let s = sag(&cable, &answer, View::Elevation).unwrap();
        assert!((s.sag_m - 1.0).abs() < 1e-12 && s.at.x_m == 0.5, "{tilt}: {s:?}");
    }
    let (cable, mut answer) = parabola(1.0);
    assert!((sag(&cable, &answer, View::Plan).unwrap().sag_m - 0.5_f64.sqrt()).abs() < 1e-12);
    answer.supports[1].x_m = 0.0;
    assert!(sag(&cable, &answer, View::Elevation).is_none_or(|s| s.sag_m.is_finite()));
}

/// The window showed a sag of 104.9 m for a cable whose halves had fallen.
#[test]
fn a_broken_cable_has_no_sag_between_what_its_pieces_hang_on() {
    let (cable, mut answer) = parabola(0.0);
    assert!(sag(&cable, &answer, View::Elevation).is_some());
    answer.breaks = vec![5];
    assert_eq!(sag(&cable, &answer, View::Elevation), None);
    // A piece that two supports hold has its own.
    let mut third = answer.supports[1].clone();
    (third.arc_length_m, third.x_m, third.y_m) = (0.4, 0.4, -0.96);
    answer.supports.insert(1, third);
    assert!(sag(&cable, &answer, View::Elevation).is_some_and(|s| (s.sag_m - 0.16).abs() < 1e-12));
}

/// The window showed a sag of 4.477 m for a cable that had torn off both of its supports.
#[test]
fn a_cable_that_nothing_holds_has_no_sag() {
    let (cable, answer) = parabola(0.0);
    let ends = [0, answer.nodes.len()];
    for breaks in [&ends[..1], &ends[1..], &ends] {
        let torn = crate::solution::CableSolution { breaks: breaks.to_vec(), ..answer.clone() };
        assert_eq!(sag(&cable, &torn, View::Elevation), None, "{breaks:?}");
    }
}

#[test]
fn a_slack_cable_is_as_long_as_it_is_however_it_sags() {
    let (_, mut answer) = parabola(0.0);
    assert!((stretched_length_m(&answer, 1.0) - 1.0).abs() < 1e-12);
    for node in &mut answer.nodes {
        node.strain = 1e-3;
    }
    assert!((stretched_length_m(&answer, 1.002) - 1.002 * 1.001).abs() < 1e-12);
}

/// Contacts that overlap, touch, lie at an end and are points.
#[test]
fn lying_length_is_that_of_the_union_of_all_contacts() {
    let (mut cable, mut answer) = parabola(0.0);
    cable.length_m = 1.0;
    let contact = |obstacle: &str, from: f64, to: f64| ContactReport {
        obstacle: obstacle.to_owned(),
        begins_m: from,
        ends_m: to,
        arc_length_m: 0.5 * (from + to),
        ..ContactReport::default()
    };
    answer.contacts = vec![
        contact("a", 0.0, 0.2),
        contact("b", 0.15, 0.3),
        contact("c", 0.3, 0.4),
        contact("d", 0.6, 0.6),
        contact(&cable.name, 0.5, 0.9),
    ];
    assert!((shape::lying_m(&cable, &answer) - 0.4).abs() < 1e-12);
    let downs = shape::touchdowns(&cable, &answer);
    let seen: Vec<_> = downs.iter().map(|d| (d.obstacle.as_str(), d.touch, d.at.arc_length_m)).collect();
    assert_eq!(seen, [("c", TouchKind::Ends, 0.4), ("d", TouchKind::Point, 0.6)]);
}

/// A cable whose preset is known to bend stiffly: what that changes is what the same scene says
/// with the stiffness written down. It is nothing that anybody knows of a cable without a preset,
/// and nothing was left out of one whose stiffness was used.
#[test]
fn what_bending_would_change_is_told_where_it_was_left_out() {
    let scene = catalog::round_post();
    let flexible = answered(&scene, Model::Auto);
    let [without_bending] = &neglected_bending(&scene, &flexible, Settings::default())[..] else { panic!("one cable") };
    let mut stiff = scene.clone();
    stiff.cables[0].bending_stiffness_n_m2 = without_bending.bending_stiffness_n_m2;
    let with = answered(&stiff, Model::Auto);
    assert_eq!(without_bending.greatest_tension_n, Some(with.max_tension().tension_n));
    let change = (with.max_tension().tension_n - flexible.max_tension().tension_n).abs();
    let said = without_bending.changes.max_tension_n.unwrap();
    assert!(said >= change && said < 1.02 * change, "{said} for {change}");
    // About a post of this size a cable of 1.4 N·m² is some per cent slacker.
    assert!(change > 0.01 * flexible.max_tension().tension_n);
    assert_eq!(neglected_bending(&stiff, &with, Settings::default()), []);
    let mut unknown = scene;
    unknown.cables[0].preset = None;
    let answer = answered(&unknown, Model::Auto);
    assert_eq!(neglected_bending(&unknown, &answer, Settings::default()), []);
}

/// Asked for, the likely stiffness is taken and said: of every cable that has one, or only where
/// the flexible answer is bent too tightly.
#[test]
fn the_likely_bending_stiffness_is_taken_where_it_is_asked_for() {
    let answered =
        |scene: &Scene, bending| settle_with_bending(scene, Model::Auto, Settings::default(), bending).unwrap();
    let stiffness = |a: &Solution| a.cables[0].assumptions.bending_stiffness_n_m2;
    let span = catalog::hanging_span();
    for (bending, taken) in [(Bending::AsWritten, 0.0), (Bending::Likely, 1.4), (Bending::WhereItMatters, 0.0)] {
        let (scene, answer) = answered(&span, bending);
        assert_eq!((stiffness(&answer), scene.cables[0].bending_stiffness_n_m2), (taken, taken), "{bending:?}");
        assert_eq!(
            answer.reason.to_string().contains("likely bending stiffness of its preset was used: `"),
            taken > 0.0,
            "{}",
            answer.reason
        );
    }
    // A pile of a flexible cable is folded to kinks; with its stiffness it is another.
    let pile = catalog::all().into_iter().find(|(name, _)| *name == "pile").unwrap().1;
    let (scene, answer) = answered(&pile, Bending::WhereItMatters);
    assert_eq!((stiffness(&answer), scene.cables[0].bending_stiffness_n_m2), (1.4, 1.4), "{}", answer.reason);
    assert!(answer.reason.to_string().contains("without bending stiffness it bends too tightly"), "{}", answer.reason);
    let (_, flexible) = answered(&pile, Bending::AsWritten);
    assert!(answer.max_tension().tension_n < 0.9 * flexible.max_tension().tension_n);
    // A cable whose stiffness is written down, or of no preset, is what it is.
    let mut other = pile;
    other.cables[0].preset = None;
    assert_eq!(stiffness(&answered(&other, Bending::WhereItMatters).1), 0.0);
}
