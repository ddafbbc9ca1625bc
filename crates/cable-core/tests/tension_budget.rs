//! The terms of a tension budget add up, and each is what an answer says of it by itself.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::analysis::tension_budget::{Cause, StartEnd, TensionBudget, tension_budget};
use cable_core::scene::catalog;
use cable_core::{Model, Scene, Simulation, Solution};

fn settle(scene: &Scene, model: Model) -> Option<Solution> {
    let mut simulation = Simulation::new(scene.clone(), model).ok()?;
    simulation.settle().ok()
}

fn sum(o: &TensionBudget, of: impl Fn(Cause) -> bool) -> f64 {
    o.contributions.iter().filter(|t| of(t.cause)).map(|t| t.tension_n).sum()
}

/// Tension at an arc length, linear between nodes.
fn tension(answer: &Solution, s: f64) -> f64 {
    let nodes = &answer.cables[0].nodes;
    let k = nodes.partition_point(|n| n.arc_length_m < s).clamp(1, nodes.len() - 1);
    let (a, b) = (&nodes[k - 1], &nodes[k]);
    a.tension_n + (b.tension_n - a.tension_n) * (s - a.arc_length_m) / (b.arc_length_m - a.arc_length_m)
}

#[test]
fn terms_add_up_in_every_scene_with_every_model_from_both_ends() {
    for (id, scene) in catalog::all() {
        for model in [Model::Catenary, Model::Spans, Model::Fem] {
            let Some(answer) = settle(&scene, model) else { continue };
            let (length, most) = (scene.cables[0].length_m, answer.max_tension().tension_n);
            for (k, from) in
                [StartEnd::Start, StartEnd::End, StartEnd::Slacker].into_iter().cycle().take(12).enumerate()
            {
                let s = length * k as f64 / 11.0;
                let o = tension_budget(&scene, &answer, 0, s, from).unwrap();
                let contributions: f64 = o.contributions.iter().map(|t| t.tension_n).sum();
                assert!((contributions - tension(&answer, s)).abs() <= 1e-6 * most, "{id} {model} at {s}: {o:?}");
            }
        }
    }
}

#[test]
fn nothing_is_left_over_where_answers_are_exact() {
    let mut seen = 0;
    for (id, scene) in catalog::all() {
        for model in [Model::Catenary, Model::Spans] {
            let Some(answer) = settle(&scene, model) else { continue };
            let most = answer.max_tension().tension_n;
            for from in [StartEnd::Start, StartEnd::End] {
                let end = if from == StartEnd::Start { scene.cables[0].length_m } else { 0.0 };
                let o = tension_budget(&scene, &answer, 0, end, from).unwrap();
                let rest = sum(&o, |c| c == Cause::Rest);
                assert!(rest.abs() <= 1e-6 * most, "{id} {model}: {rest} N of {most} N left\n{o:?}");
                seen += 1;
            }
        }
    }
    assert!(seen >= 16, "{seen}");
}

/// Every contact's term is the friction that the model itself reports.
#[test]
fn friction_of_a_contact_is_what_the_model_says_of_it() {
    let mut seen = 0;
    for (id, scene) in catalog::all() {
        let Some(answer) = settle(&scene, Model::Spans) else { continue };
        let (solved, most) = (&answer.cables[0], answer.max_tension().tension_n);
        let o = tension_budget(&scene, &answer, 0, scene.cables[0].length_m, StartEnd::Start).unwrap();
        for (k, c) in solved.contacts.iter().enumerate() {
            let term = sum(&o, |cause| cause == Cause::Contact(k));
            assert!((term + c.friction_n).abs() <= 2e-6 * most, "{id}: {term} N against {c:?}");
            seen += 1;
        }
    }
    assert!(seen >= 4, "{seen}");
}

#[test]
fn a_wrap_multiplies_by_the_capstan_factor() {
    let scene = catalog::draped_slipping();
    let answer = settle(&scene, Model::Spans).expect("an answer");
    let slips = answer.cables[0].contacts.iter().enumerate().find(|(_, c)| c.turn_deg.abs() > 90.0);
    let (k, c) = slips.expect("a wrap");
    let o = tension_budget(&scene, &answer, 0, scene.cables[0].length_m, StartEnd::Start).unwrap();
    let term = o.contributions.iter().find(|t| t.cause == Cause::Contact(k)).unwrap();
    let factor = c.tension_after_n / c.tension_before_n;
    assert!((term.factor.unwrap() / factor - 1.0).abs() < 1e-6, "{term:?} {factor}");
}

/// A free end: all tension is weight, w·(height above it).
#[test]
fn below_a_hanging_end_there_is_only_weight() {
    let mut scene = catalog::hanging_span();
    let cable = &mut scene.cables[0];
    cable.supports =
        vec![cable_core::Support::fixed("top", [0.0, 9.0]), cable_core::Support::fixed("end", [0.0, -4.0])];
    let end = &mut cable.supports[1];
    (end.kind, end.at_m) = (cable_core::scene::SupportKind::Free, None);
    let (w, length) = (cable.linear_density_kg_per_m * scene.environment.gravity_m_per_s2, cable.length_m);
    let answer = settle(&scene, Model::Catenary).expect("an answer");
    let o = tension_budget(&scene, &answer, 0, 0.25 * length, StartEnd::Slacker).unwrap();
    assert!((o.from_m - length).abs() < 1e-12, "the sum begins at the free end");
    let weight = sum(&o, |c| c == Cause::Weight);
    assert!((weight - 0.75 * w * length).abs() < 1e-9 * w * length, "{o:?}");
    assert!((o.tension_n - weight).abs() < 1e-9 * w * length);
}

/// Contacts say where they begin and end, and parts of a contact fill it.
#[test]
fn parts_of_a_contact_fill_it_and_change_at_fronts() {
    let mut fronts = 0;
    for (id, scene) in catalog::all() {
        for model in [Model::Spans, Model::Fem, Model::MassSpring] {
            let Some(answer) = settle(&scene, model) else { continue };
            for c in answer.cables.iter().flat_map(|c| &c.contacts) {
                let [a, b] = c.extent_m();
                assert!(
                    a <= c.arc_length_m && c.arc_length_m <= b && b <= scene.cables[0].length_m + 1e-9,
                    "{id} {c:?}"
                );
                if let (Some(first), Some(last)) = (c.parts.first(), c.parts.last()) {
                    assert!((first.begins_m - a).abs() < 1e-9 && (last.ends_m - b).abs() < 1e-9, "{id} {c:?}");
                    assert!(c.parts.windows(2).all(|p| p[0].ends_m == p[1].begins_m && p[0].state != p[1].state));
                    fronts += c.parts.len() - 1;
                }
            }
        }
    }
    assert!(fronts > 0, "no slip front anywhere");
}

/// The sign of a turn is that of the shape, whichever model says it: a cable over a post to the
/// right turns clockwise.
#[test]
fn turns_are_positive_anticlockwise_in_every_model() {
    let scene = catalog::draped_slipping();
    for model in [Model::Spans, Model::Fem, Model::MassSpring] {
        let Some(answer) = settle(&scene, model) else { continue };
        let nodes = &answer.cables[0].nodes;
        let c = answer.cables[0].contacts.iter().max_by(|a, b| a.turn_deg.abs().total_cmp(&b.turn_deg.abs())).unwrap();
        let [from, to] = c.extent_m();
        let inside: Vec<_> = nodes
            .windows(3)
            .filter(|w| w[1].arc_length_m >= from - 0.05 && w[1].arc_length_m <= to + 0.05)
            .map(|w| {
                let (a, b) = ([w[1].x_m - w[0].x_m, w[1].y_m - w[0].y_m], [w[2].x_m - w[1].x_m, w[2].y_m - w[1].y_m]);
                (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
            })
            .collect();
        let shape = inside.iter().sum::<f64>().to_degrees();
        assert!((c.turn_deg - shape).abs() < 15.0, "{model}: {} against {shape}", c.turn_deg);
    }
}
