//! A scene may be as unusual as it likes: no panic, no number that is not finite, starts inside
//! something solid, and the same answer at every scale.

#![allow(clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::error::SceneFault;
use cable_core::model::Model;
use cable_core::solution::{CableSolution, Solution, WarningKind};
use cable_core::{Error, Scene, Simulation};

const SOLVERS: [Model; 3] = [Model::Auto, Model::Fem, Model::MassSpring];

fn scene(text: &str) -> Scene {
    Scene::from_toml(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn rest(scene: &Scene, model: Model) -> Result<Solution, Error> {
    Ok(Simulation::new(scene.clone(), model)?.settle()?)
}

/// A cable of rubber between supports.
fn cable(length_m: f64, diameter_m: f64, more: &str, supports: &str) -> String {
    format!(
        "version = 1\n[[cables]]\nname = \"c\"\npreset = \"soow-6-4\"\nlength_m = {length_m}\ndiameter_m = {diameter_m}\n{more}\nsupports = [ {supports} ]\n"
    )
}

fn fixed(name: &str, x: f64, y: f64) -> String {
    format!("{{ name = \"{name}\", kind = \"fixed\", at_m = [{x}, {y}] }}")
}

fn ground(points: &str) -> String {
    format!("[[obstacles]]\nname = \"ground\"\nkind = \"terrain\"\npoints_m = {points}\nfriction = 0.5\n")
}

/// Every number of an answer.
fn is_finite(cables: &[CableSolution]) -> bool {
    let node = |n: &cable_core::solution::Node| {
        [n.arc_length_m, n.x_m, n.y_m, n.tension_n, n.strain, n.stress_pa, n.curvature_per_m]
            .iter()
            .all(|v| v.is_finite())
    };
    cables.iter().all(|c| {
        !c.nodes.is_empty()
            && c.nodes.iter().all(node)
            && c.supports.iter().all(|r| (r.x_m + r.y_m + r.reaction_x_n + r.reaction_y_n + r.arc_length_m).is_finite())
            && c.contacts.iter().all(|k| (k.x_m + k.y_m + k.normal_n + k.friction_n + k.turn_deg).is_finite())
    })
}

fn assert_clean(text: &str) {
    let words: Vec<&str> = text.split(|c: char| !c.is_ascii_alphanumeric()).collect();
    assert!(!words.contains(&"NaN") && !words.contains(&"inf"), "{text}");
    let numbered = words.windows(2).any(|w| w[0] == "node" && w[1].parse::<usize>().is_ok());
    assert!(!numbered, "nobody counts nodes: {text}");
}

#[test]
fn supports_without_a_way_between_them_are_refused_by_check() {
    let eye = "{ name = \"eye\", kind = \"pulley\", at_m = [0.0, 5.0] }";
    let wheel = "{ name = \"wheel\", kind = \"pulley\", at_m = [3.5, 5.6], radius_m = 7.15, friction = 0.1 }";
    for between in [eye, wheel] {
        let supports = format!("{}, {between}, {}", fixed("a", 0.0, 5.0), fixed("b", 11.0, 1.5));
        let error = Scene::from_toml(&cable(13.2, 0.028, "", &supports)).unwrap_err();
        assert!(matches!(error.fault, SceneFault::NoWay { .. }), "{error}");
        assert_clean(&error.to_string());
    }
    // Beside each other, and one wheel on top of the next, are ways.
    let near = "{ name = \"eye\", kind = \"pulley\", at_m = [0.001, 5.0] }";
    let supports = format!("{}, {near}, {}", fixed("a", 0.0, 5.0), fixed("b", 11.0, 1.5));
    let near = scene(&cable(13.2, 0.028, "", &supports));
    for model in [Model::Auto, Model::MassSpring] {
        match rest(&near, model) {
            Ok(s) => assert!(is_finite(&s.cables)),
            Err(e) => assert_clean(&e.to_string()),
        }
    }
}

#[test]
fn a_weightless_cable_is_slack_or_straight_and_says_so() {
    for model in [Model::Auto, Model::Catenary, Model::Fem] {
        let still = "[environment]\ngravity_m_per_s2 = 0.0\n";
        for (length, tension) in [(12.0, false), (9.99, true)] {
            let text = cable(
                length,
                0.028,
                "breaking_tension_n = 1e9",
                &format!("{}, {}", fixed("a", 0.0, 5.0), fixed("b", 10.0, 5.0)),
            );
            let s = rest(&scene(&(text.replace("[[cables]]", &format!("{still}[[cables]]")))), model).unwrap();
            assert!(is_finite(&s.cables));
            let greatest = s.max_tension().tension_n;
            let stretch = scene(&text).cables[0].axial_stiffness_n * (10.0 / length - 1.0);
            if tension {
                assert!((greatest / stretch - 1.0).abs() < 1e-9, "{model}: {greatest} N for {stretch} N");
            } else {
                assert!(greatest < 1e-5, "{model}: {greatest} N");
                assert!(s.warnings.iter().any(|w| w.kind == WarningKind::NotUnique), "{model} says nothing of it");
            }
        }
    }
}

#[test]
fn a_support_on_a_surface_is_held_off_it_and_a_buried_one_refused() {
    let flat = ground("[[-10.0, 0.0], [20.0, 0.0]]");
    let on = scene(&(cable(5.2, 0.028, "", &format!("{}, {}", fixed("a", 0.0, 0.0), fixed("b", 5.0, 0.0))) + &flat));
    for model in SOLVERS {
        let s = rest(&on, model).unwrap_or_else(|e| panic!("{model}: {e}"));
        assert!(is_finite(&s.cables), "{model}");
        let words = s.warnings.iter().filter(|w| w.kind == WarningKind::InitialPenetration).count();
        assert_eq!(words, 2, "{model}: {:?}", s.warnings);
        let ends: Vec<f64> = s.cables[0].supports.iter().map(|r| r.y_m).collect();
        assert!(ends.iter().all(|y| (y - 0.014).abs() < 1e-3), "{model}: {ends:?}");
    }
    let under =
        scene(&(cable(7.0, 0.028, "", &format!("{}, {}", fixed("a", 0.0, -1.0), fixed("b", 5.0, 1.0))) + &flat));
    let error = cable_core::problem::check(&under).unwrap_err();
    assert_eq!(error.path, "cables[0].supports[0].at_m");
    let SceneFault::SupportInside { depth_m, clear_m: Some([x, y]), .. } = &error.fault else { panic!("{error}") };
    assert!((depth_m - 1.0).abs() < 1e-9 && x.abs() < 1e-9 && (y - 0.014).abs() < 1e-3, "{error}");
    for model in SOLVERS {
        assert!(matches!(rest(&under, model), Err(Error::Scene(_))), "{model}");
    }
}

#[test]
fn a_support_that_rounding_leaves_inside_is_put_out() {
    let post =
        "[[obstacles]]\nname = \"post\"\nkind = \"circle\"\ncenter_m = [0.0, 2.0]\nradius_m = 0.5\nfriction = 0.3\n";
    let slope = ground("[[-5000.0, 250.0], [5000.0, -250.0]]");
    for depth in [0.0, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4] {
        let ends = format!("{}, {}", fixed("a", 0.0, 2.514 - depth), fixed("b", 4.0, 3.0));
        let s = rest(&scene(&(cable(4.5, 0.028, "", &ends) + post)), Model::Auto);
        assert!(s.is_ok(), "{depth}: {}", s.unwrap_err());
        let y = 0.014 * (1.0f64 + 0.05 * 0.05).sqrt();
        let ends = format!("{}, {}", fixed("a", 0.0, y - depth), fixed("b", 40.0, 9.0));
        let s = rest(&scene(&(cable(43.5, 0.028, "", &ends) + &slope)), Model::Auto);
        assert!(s.is_ok(), "{depth}: {}", s.unwrap_err());
    }
}

#[test]
fn ends_that_nothing_holds_come_down_on_what_is_below_them() {
    let floor = ground("[[-10.0, 0.0], [10.0, 0.0]]");
    for end in ["kind = \"free\"", "kind = \"load\", force_n = [0.0, -20.0]"] {
        let ends = format!("{}, {{ name = \"b\", {end} }}", fixed("a", 0.0, 2.0));
        for more in ["", "route_m = [[0.0, 2.0], [0.3, 0.3], [0.4, -1.0]]"] {
            let s = rest(&scene(&(cable(3.0, 0.028, more, &ends) + &floor)), Model::Auto);
            let s = s.unwrap_or_else(|e| panic!("{end}, {more}: {e}"));
            // At most 1.986 m hang, and the load lies.
            let top = -s.cables[0].supports[0].reaction_y_n;
            assert!((24.0..24.6).contains(&top), "{end}, {more}: {top} N");
        }
    }
}

#[test]
fn slack_that_weighs_nothing_is_told() {
    let still = "[environment]\ngravity_m_per_s2 = 0.0\n";
    let beam = "[[obstacles]]\nname = \"o\"\nkind = \"polygon\"\npoints_m = [[2.0, 1.0], [3.0, 1.0], [3.0, 2.0], [2.0, 2.0]]\n";
    let text = cable(12.0, 0.028, "", &format!("{}, {}", fixed("a", 0.0, 0.1), fixed("b", 5.0, 3.0)));
    let s = rest(&scene(&(text.replace("[[cables]]", &format!("{still}[[cables]]")) + beam)), Model::Auto).unwrap();
    let told = |w: &cable_core::solution::Warning| w.to_string().contains("no weight");
    assert!(s.max_tension().tension_n == 0.0 && s.warnings.iter().any(told), "{:?}", s.warnings);
}

#[test]
fn a_loaded_end_on_the_ground_has_the_force_that_comes_to_it() {
    let ends = format!("{}, {{ name = \"b\", kind = \"load\", force_n = [60.0, -200.0] }}", fixed("a", 0.0, 3.0));
    let text =
        cable(4.3, 0.028, "friction = 0.0", &ends) + &ground("[[-10.0, 0.0], [20.0, 0.0]]").replace("0.5", "0.0");
    let s = rest(&scene(&text), Model::Spans).unwrap();
    let nodes = &s.cables[0].nodes;
    let [before, last] = [nodes[nodes.len() - 2], nodes[nodes.len() - 1]];
    let off = (last.force_n[0] - before.force_n[0]).hypot(last.force_n[1] - before.force_n[1]);
    assert!(off < 1.0 && (last.force_n[0] - 60.0).abs() < 1e-6, "{:?} after {:?}", last.force_n, before.force_n);
}

#[test]
fn a_route_below_sloping_ground_ends_above_it() {
    let route = "route_m = [[0.0, 4.0], [0.6, 0.9], [1.4, 0.1], [6.6, 0.1], [7.4, 0.9], [8.0, 4.0]]\nsegments = 100";
    let text = cable(14.0, 0.028, route, &format!("{}, {}", fixed("left", 0.0, 4.0), fixed("right", 8.0, 4.0)));
    let text = text + &ground("[[-2.0, 2.0], [10.0, 0.0]]");
    for model in SOLVERS {
        let s = rest(&scene(&text), model).unwrap_or_else(|e| panic!("{model}: {e}"));
        assert!(s.warnings.iter().any(|w| w.kind == WarningKind::InitialPenetration), "{model} says nothing of it");
        for n in &s.cables[0].nodes {
            let above = n.y_m - (2.0 - (n.x_m + 2.0) / 6.0);
            assert!(above > 0.0, "{model}: {above} m at {:.3} m", n.arc_length_m);
        }
    }
}

/// Cables that hang, lie and bend round something, at a scale `l` of lengths and `f` of forces.
fn copies(l: f64, f: f64) -> Vec<(&'static str, Scene)> {
    let at = |x: f64, y: f64| format!("[{:?}, {:?}]", x * l, y * l);
    let held = |n: &str, x, y| format!("{{ name = \"{n}\", kind = \"fixed\", at_m = {} }}", at(x, y));
    let body = |length: f64, ei: f64, supports: String| {
        format!(
            "version = 1\n[[cables]]\nname = \"c\"\nlength_m = {:?}\nlinear_density_kg_per_m = {:?}\naxial_stiffness_n = {:?}\nbending_stiffness_n_m2 = {:?}\ndiameter_m = {:?}\nfriction = 0.3\nservice_tension_n = 1e15\nbreaking_tension_n = 1e15\nsupports = [ {supports} ]\n",
            length * l,
            1.246 * f / l,
            2e6 * f,
            ei * f * l * l,
            0.016 * l
        )
    };
    let floor = format!(
        "[[obstacles]]\nname = \"g\"\nkind = \"terrain\"\npoints_m = [{}, {}]\nfriction = 0.5\n",
        at(-20.0, 0.0),
        at(30.0, 0.0)
    );
    let beam = format!(
        "[[obstacles]]\nname = \"p\"\nkind = \"polygon\"\npoints_m = [{}, {}, {}, {}]\nfriction = 0.3\n",
        at(4.0, 3.2),
        at(5.0, 3.2),
        at(5.0, 3.8),
        at(4.0, 3.8)
    );
    vec![
        ("span", scene(&body(12.0, 0.0, format!("{}, {}", held("a", 0.0, 5.0), held("b", 10.0, 4.0))))),
        ("floor", scene(&(body(14.0, 0.0, format!("{}, {}", held("a", 0.0, 3.0), held("b", 10.0, 3.0))) + &floor))),
        ("beam", scene(&(body(11.0, 0.0, format!("{}, {}", held("a", 0.0, 3.0), held("b", 9.0, 3.5))) + &beam))),
        ("stiff", scene(&body(12.0, 1.4, format!("{}, {}", held("a", 0.0, 5.0), held("b", 10.0, 4.0))))),
    ]
}

/// The greatest difference of a force on a support, of the greatest tension.
fn apart(a: &Solution, b: &Solution, force: f64) -> f64 {
    let pairs = a.cables[0].supports.iter().zip(&b.cables[0].supports);
    let off =
        pairs.flat_map(|(a, b)| [b.reaction_x_n / force - a.reaction_x_n, b.reaction_y_n / force - a.reaction_y_n]);
    off.fold(0.0, |m: f64, d| m.max(d.abs())) / a.max_tension().tension_n
}

#[test]
fn the_same_cable_at_another_scale_pulls_alike() {
    for model in SOLVERS {
        let whole = copies(1.0, 1.0);
        for (l, f) in [(1e-3, 1.0), (1e-3, 1e-6), (0.02, 30.0), (600.0, 1.0), (1.0, 1e-4), (1.0, 1e3)] {
            for ((name, a), (_, b)) in whole.iter().zip(&copies(l, f)) {
                // Plain nodes at a corner show a sawtooth that no scale takes away.
                if *name == "beam" && model == Model::MassSpring {
                    continue;
                }
                let (a, b) = (rest(a, model).unwrap(), rest(b, model));
                let b = b.unwrap_or_else(|e| panic!("{name}, {model}, {l}, {f}: {e}"));
                assert!(apart(&a, &b, f) < 3e-3, "{name}, {model}, lengths {l}, forces {f}: {}", apart(&a, &b, f));
            }
        }
    }
}

#[test]
fn one_millimetre_of_cable_five_metres_up_weighs_what_it_weighs() {
    let text = cable(0.001, 1e-5, "", &format!("{}, {}", fixed("a", 0.0, 5.0), fixed("b", 0.0009, 5.0)));
    for model in SOLVERS {
        let s = rest(&scene(&text), model).unwrap();
        assert!((s.max_tension().tension_n / 0.009174 - 1.0).abs() < 1e-3, "{model}: {}", s.max_tension().tension_n);
    }
}

#[test]
fn a_very_fine_mesh_begins_at_a_coarse_one() {
    let flat = ground("[[-20.0, 0.0], [30.0, 0.0]]");
    let ends = format!("{}, {}", fixed("a", 0.0, 5.0), fixed("b", 10.0, 5.0));
    let s =
        rest(&scene(&(cable(16.0, 0.028, "self_contact = true\nsegments = 3000", &ends) + &flat)), Model::Fem).unwrap();
    let held: f64 = s.cables[0].supports.iter().map(|r| -r.reaction_y_n).sum();
    let lies: f64 = s.cables[0].contacts.iter().map(|c| c.normal_n).sum();
    let weight = 16.0 * 9.80665 * scene(&cable(16.0, 0.028, "", &ends)).cables[0].linear_density_kg_per_m;
    assert!(((held + lies) / weight - 1.0).abs() < 1e-5, "{held} + {lies} for {weight}");
}

/// Numbers in a row that look random, the same every time (D. H. Lehmer's generator).
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0
    }

    fn log(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.next())
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[((self.next() * of.len() as f64) as usize).min(of.len() - 1)]
    }
}

/// A scene of extreme but allowed values.
fn drawn(seed: u64) -> String {
    let mut d = Draws(seed * 7_919 + 13);
    for _ in 0..5 {
        d.next();
    }
    let length = d.log(1e-3, 1e4);
    let gravity = d.pick(&[9.80665, 9.80665, 0.0, 1e-6, 100.0]);
    let way = length / d.pick(&[1.0, 1.001, 1.1, 1.5, 3.0, 1e3]);
    let y = d.pick(&[0.0, 1.0, 0.5 * length]);
    let ends = format!("{}, {}", fixed("a", 0.0, y), fixed("b", way, y));
    let middle = match (d.next() * 4.0) as usize {
        0 => format!(
            "{{ name = \"p\", kind = \"pulley\", at_m = [{:?}, {:?}], radius_m = {:?}, friction = {} }}, ",
            0.4 * way,
            y + 0.1 * length,
            d.pick(&[0.0, 0.01 * length, length]),
            d.pick(&[0.0, 0.3, 5.0])
        ),
        _ => String::new(),
    };
    let supports = ends.replacen("}, ", &format!("}}, {middle}"), 1);
    let mut text = format!(
        "version = 1\n[environment]\ngravity_m_per_s2 = {gravity}\n[[cables]]\nname = \"c\"\nlength_m = {length:?}\nlinear_density_kg_per_m = {:?}\naxial_stiffness_n = {:?}\nbending_stiffness_n_m2 = {:?}\ndiameter_m = {:?}\nfriction = {}\nservice_tension_n = 1e15\nbreaking_tension_n = 1e15\nsegments = {}\nsupports = [ {supports} ]\n",
        d.log(1e-6, 1e4),
        d.log(1.0, 1e12),
        if d.next() < 0.7 || !middle.is_empty() { 0.0 } else { d.log(1e-9, 1e6) },
        d.pick(&[1e-5, 1e-3 * length, 0.05 * length]).clamp(1e-5, 10.0),
        d.pick(&[0.0, 0.3, 10.0]),
        d.pick(&[1, 2, 7, 20])
    );
    if d.next() < 0.6 {
        let h = y - d.pick(&[0.0, 0.05 * length, 0.4 * length]);
        text += &ground(&format!("[[{:?}, {h:?}], [{:?}, {h:?}]]", -length, way + length));
    }
    text
}

#[test]
fn extreme_values_are_answered_or_refused_in_words() {
    let (mut answered, mut refused) = (0, 0);
    for seed in 1..=60 {
        let text = drawn(seed);
        let Ok(scene) = Scene::from_toml(&text) else { continue };
        for model in SOLVERS {
            let solved = Simulation::new(scene.clone(), model).and_then(|mut s| Ok(s.settle()?));
            match solved {
                Ok(s) => {
                    assert!(is_finite(&s.cables), "seed {seed}, {model}\n{text}");
                    s.warnings.iter().for_each(|w| assert_clean(&w.to_string()));
                    answered += 1;
                }
                Err(e) => {
                    assert_clean(&e.to_string());
                    println!("seed {seed}, {model}: {e}\n{text}");
                    refused += 1;
                }
            }
        }
    }
    println!("{answered} answered, {refused} refused");
    assert!(answered > 9 * refused, "{answered} answered, {refused} refused");
}

/// A step of no time, back in time, of no number or of ages is refused as such by every model, and
/// nothing has moved.
#[test]
fn steps_that_cannot_be_are_refused_and_change_nothing() {
    use cable_core::scene::catalog;
    use cable_core::{Model, Simulation, SolveError};
    let scenes = [("hanging-span", catalog::hanging_span()), ("tank", catalog::tank())];
    for (name, scene) in scenes {
        for model in [Model::Auto, Model::Spans, Model::Fem, Model::MassSpring] {
            let Ok(mut sim) = Simulation::new(scene.clone(), model) else { continue };
            if sim.settle().is_err() {
                continue;
            }
            for dt_s in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e12] {
                let before = sim.states();
                for quasi_static in [false, true] {
                    let done = if quasi_static { sim.step_quasi_static(dt_s) } else { sim.step(dt_s) };
                    let refused = matches!(done, Err(SolveError::TimeStep { .. } | SolveError::Unsupported { .. }));
                    assert!(refused, "{name}, {model}, {dt_s} s, without inertia {quasi_static}: {done:?}");
                    assert_eq!(sim.states(), before, "{name}, {model}, {dt_s} s");
                }
            }
        }
    }
}

/// A cable that is answered at another scale says why the first model has no answer as others do,
/// with the places of its own scene. (No resting place is found for this one: it lies on a smooth
/// slope, a kilometre long and as light as a thread.)
#[test]
fn what_a_first_model_says_is_told_at_the_scale_of_the_scene() {
    use cable_core::scene::{Obstacle, Shape, Support, catalog};
    use cable_core::{Model, Simulation};
    let ends =
        vec![Support::fixed("a", [-0.020_871_9, 0.042_036]), Support::fixed("b", [902.120_943_8, 645.258_519_7])];
    let mut scene = catalog::cable_alone([1_189.712_097_8, 3.567_511_869e-5, 281.826_448_8], ends);
    scene.cables[0].diameter_m = 0.093_865;
    let slope = Shape::Terrain { points_m: vec![[-6_275.499_125, -3_115.937_886_4], [12_550.998_25, 6_231.875_772_8]] };
    scene.obstacles = vec![Obstacle { name: "slope".into(), shape: slope, friction: Some(0.0) }];
    let said = match Simulation::new(scene, Model::Auto).unwrap().settle() {
        Ok(answer) => answer.reason.to_string(),
        Err(error) => error.to_string(),
    };
    println!("{said}");
    assert!(said.contains("spans found no resting place") && said.contains("1189.712 m along the cable"), "{said}");
}

/// A force that is far too great for 10 ms, without damping: `mass-spring` ended with a position
/// that was no number, and `fem` moved at kilometres per second without a word.
#[test]
fn issue_017_a_huge_impulse_is_limited_or_said() {
    let supports = format!("{}, {}", fixed("left", 0.0, 0.0), fixed("right", 10.0, 0.0));
    let more = "damping_ratio = 0.0\nsegments = 40\naxial_stiffness_n = 1e6\nservice_tension_n = 1e11\nbreaking_tension_n = 1e12";
    for force_n in [1e7, 1e9] {
        let load = format!(
            "[[loads]]\ncable = \"c\"\narc_length_m = 5.25\ntimes_s = [0.0, 0.1, 0.1001, 0.11, 0.1101]\nforces_n = [[0.0, 0.0], [0.0, 0.0], [0.0, {force_n:?}], [0.0, {force_n:?}], [0.0, 0.0]]\n"
        );
        let scene = scene(&(cable(10.5, 0.02, more, &supports) + &load));
        for model in [Model::Fem, Model::MassSpring] {
            let mut sim = Simulation::new(scene.clone(), model).unwrap();
            sim.settle().unwrap();
            let (mut said, mut ended) = (false, None);
            for _ in 0..120 {
                if let Err(why) = sim.step(1.0 / 240.0) {
                    ended = Some(why.to_string());
                    break;
                }
                let answer = sim.solution();
                assert!(is_finite(&answer.cables), "{model:?}, {force_n:e} N");
                said |=
                    answer.warnings.iter().any(|w| matches!(w.kind, WarningKind::Stabilised | WarningKind::Accuracy));
            }
            println!("{model:?}, {force_n:e} N: {ended:?}");
            assert!(said, "{model:?}, {force_n:e} N: nothing was said");
            assert!(ended.is_none_or(|why| !why.contains("not a finite number")), "{model:?}, {force_n:e} N");
        }
    }
}
