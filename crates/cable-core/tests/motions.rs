//! Every scene of the catalogue in which something moves runs to its end, and says the same of its
//! greatest tension whatever the mesh and the tolerance.
//!
//! All of it: `cargo test --locked -p cable-core --test motions -- --ignored --nocapture` (hours);
//! `SCENE=tank` takes one scene, `SEED=7` rolls other dice, `WAYS=random` leaves out one factor at
//! a time, `ONLY="Fem Dynamic"` takes the ways of a model, an inertia or both.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

use cable_core::model::{Inertia, Question};
use cable_core::scene::{Scene, catalog};
use cable_core::timeline::{Instant, Timeline};
use cable_core::{Model, Settings, Simulation};

use self::dice::Dice;

/// The parameter that is varied.
#[derive(Clone, Copy, Debug)]
struct Way {
    model: Model,
    inertia: Inertia,
    segments: Option<usize>,
    tolerance: f64,
    friction: f64,
    every_s: f64,
    /// Distance by which the held ends begin to the side, m.
    aside: f64,
}

const PLAIN: Way = Way {
    model: Model::Fem,
    inertia: Inertia::Dynamic,
    segments: None,
    tolerance: 1e-3,
    friction: 1.0,
    every_s: 0.1,
    aside: 0.0,
};

/// Scenes with motions, with the time at which all is over, s.
fn moving() -> Vec<(&'static str, Scene, f64)> {
    let only = std::env::var("SCENE").ok();
    let over = |scene: &Scene| {
        let last = |s: &cable_core::scene::Support| s.motion.as_ref().and_then(|m| m.times_s.last().copied());
        scene.cables.iter().flat_map(|c| &c.supports).filter_map(last).fold(0.0, f64::max)
    };
    let all = catalog::all().into_iter().filter(|(name, _)| only.as_deref().is_none_or(|o| o == *name));
    let timed = all.map(|(name, scene)| {
        let end = if scene.robot.is_some() { 40.0 } else { over(&scene) };
        (name, scene, end)
    });
    timed.filter(|(_, _, end)| *end > 0.0).collect()
}

/// The greatest tension of a run to `end` (s), N, or why it stopped.
fn greatest(scene: &Scene, end: f64, way: Way) -> Result<f64, String> {
    run(scene, end, way, false).map(|found| found.0)
}

/// The same, and from what to what it may be as the answer says (N), where that is asked for and
/// said.
fn run(scene: &Scene, end: f64, way: Way, errors: bool) -> Result<(f64, [f64; 2]), String> {
    let mut scene = scene.clone();
    for cable in &mut scene.cables {
        cable.segments = way.segments.or(cable.segments);
        cable.friction *= way.friction;
        for s in &mut cable.supports {
            for p in s.at_m.iter_mut().chain(s.motion.iter_mut().flat_map(|m| &mut m.points_m)) {
                p[0] += way.aside;
            }
        }
    }
    for o in &mut scene.obstacles {
        o.friction = o.friction.map(|f| f * way.friction);
    }
    let settings = Settings { tolerance: way.tolerance, ..Settings::default() };
    let question = Question::History(way.inertia);
    let mut sim = Simulation::for_question(scene, way.model, settings, question).map_err(|e| e.to_string())?;
    sim.settle().map_err(|e| format!("no first rest: {e}"))?;
    let timeline = Timeline::new(sim, way.inertia, None).map_err(|e| e.to_string())?;
    let mut timeline = if errors { timeline.with_errors() } else { timeline };
    let mut most = 0.0f64;
    for k in 1..=(end / way.every_s).floor() as u64 {
        let at = Instant::nearest(way.every_s).times(k);
        timeline.at(at, |sim| most = most.max(sim.max_tension().tension_n)).map_err(|e| e.to_string())?;
    }
    // Of inner steps, as the range is.
    let ranges = timeline
        .monitor()
        .peaks()
        .iter()
        .filter_map(|run| Some((run.peaks.greatest.tension_n, run.ranges?.greatest_n)));
    let range = ranges.max_by(|a, b| a.0.total_cmp(&b.0)).map_or([most; 2], |found| found.1);
    Ok((most, [range[0].min(most), range[1].max(most)]))
}

/// The runs with which the others of a scene are compared: the one on its own mesh, and those that
/// begin a little aside.
#[derive(Clone, Copy, Debug)]
struct Reference {
    most: f64,
    /// From what to what it may be, as it says itself and as the others are, N.
    range: [f64; 2],
    /// Greatest difference between runs that begin micrometres apart.
    scatter: f64,
}

/// Starts aside from which a path that is not chaotic does not part, m.
const ASIDE: [f64; 3] = [1e-6, 1e-5, 1e-4];

fn reference(scene: &Scene, end: f64, way: Way) -> Result<Reference, String> {
    let (most, mut range) = run(scene, end, way, true)?;
    let mut all = [most; 2];
    for aside in ASIDE {
        let other = greatest(scene, end, Way { aside, ..way })?;
        all = [all[0].min(other), all[1].max(other)];
    }
    range = [range[0].min(all[0]), range[1].max(all[1])];
    Ok(Reference { most, range, scatter: all[1] / all[0] - 1.0 })
}

/// The comparison of a run with its reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Same {
    /// Within 2 %.
    Near,
    /// Further apart, where starts micrometres aside are, too: within the range that is stated.
    Chaotic,
    /// The path is not chaotic, but the mesh of one of them is coarse, and the range that it states
    /// says so.
    Coarse,
    Apart,
}

const NEAR: f64 = 0.02;

fn compared(scene: &Scene, end: f64, way: Way, most: f64, with: &Reference) -> Same {
    let inside = |n: f64, [from, to]: [f64; 2]| from * (1.0 - NEAR) <= n && n <= to * (1.0 + NEAR);
    if (most / with.most - 1.0).abs() < NEAR {
        return Same::Near;
    }
    let open = if with.scatter > NEAR { Same::Chaotic } else { Same::Coarse };
    if inside(most, with.range) {
        return open;
    }
    match run(scene, end, way, true) {
        Ok((_, own)) if inside(with.most, own) => open,
        _ => Same::Apart,
    }
}

/// Runs and how they compare.
#[derive(Debug, Default)]
struct Found {
    runs: usize,
    stops: Vec<String>,
    same: BTreeMap<Same, usize>,
    /// All that are not near.
    apart: Vec<String>,
}

/// The way that a run is compared with: on the scene's own mesh, of the same model, inertia and
/// friction.
fn plain_of(way: Way) -> Way {
    Way { model: way.model, inertia: way.inertia, friction: way.friction, ..PLAIN }
}

/// Runs a scene in one way and compares it with its reference.
fn compare_one((name, scene, end): (&str, &Scene, f64), way: Way, with: &Result<Reference, String>) -> Found {
    let mut found = Found { runs: 1, ..Found::default() };
    match (&greatest(scene, end, way), with) {
        (Err(why), _) | (Ok(_), Err(why)) => {
            println!("{name} {way:?}: stopped: {why}");
            found.stops.push(format!("{name} {way:?}: {why}"));
        }
        (Ok(most), Ok(with)) => {
            let same = compared(scene, end, way, *most, with);
            println!("{name} {way:?}: {most:.3} N, {same:?}");
            *found.same.entry(same).or_default() += 1;
            if same != Same::Near {
                found.apart.push(format!("{same:?} {name} {way:?}: {most} N for {with:?}"));
            }
        }
    }
    found
}

/// Runs each scene in its ways on all cores; a reference is run once, by the first that needs it.
fn compare_all(tasks: &[(&str, &Scene, f64, Way)]) -> Found {
    let key = |name: &str, way: Way| format!("{name} {:?}", plain_of(way));
    let references: BTreeMap<String, OnceLock<Result<Reference, String>>> =
        tasks.iter().map(|(name, _, _, way)| (key(name, *way), OnceLock::new())).collect();
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Found::default()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(&(name, scene, end, way)) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let with = references[&key(name, way)].get_or_init(|| {
                        let with = reference(scene, end, plain_of(way));
                        println!("{name} {:?}: {with:?}", plain_of(way));
                        with
                    });
                    let one = compare_one((name, scene, end), way, with);
                    found.lock().expect("no panic").add(one);
                }
            });
        }
    });
    found.into_inner().expect("no panic")
}

/// Ways at random: all factors together.
fn at_random(dice: &mut Dice, count: usize, most_segments: f64) -> Vec<Way> {
    let mut any = |of: &[f64]| of[(dice.unit() * of.len() as f64) as usize];
    (0..count)
        .map(|_| Way {
            model: if any(&[0.0, 1.0]) > 0.0 { Model::Fem } else { Model::Auto },
            inertia: if any(&[0.0, 1.0]) > 0.0 { Inertia::Dynamic } else { Inertia::QuasiStatic },
            friction: any(&[0.8, 1.0, 1.2]),
            every_s: any(&[1.0 / 60.0, 0.1, 0.25, 0.5, 1.0]),
            tolerance: any(&[1e-2, 3e-3, 1e-3, 3e-4, 1e-4]),
            segments: Some(any(&[42.0, 60.0, 100.0, 150.0, 250.0, 500.0, 1000.0]).min(most_segments) as usize),
            aside: 0.0,
        })
        .collect()
}

fn seed() -> u64 {
    std::env::var("SEED").ok().and_then(|v| v.parse().ok()).unwrap_or(1)
}

impl Found {
    fn add(&mut self, more: Self) {
        self.runs += more.runs;
        self.stops.extend(more.stops);
        self.apart.extend(more.apart);
        for (same, count) in more.same {
            *self.same.entry(same).or_default() += count;
        }
    }

    fn tell(&self) {
        println!("{} runs, {} stopped, {:?}:", self.runs, self.stops.len(), self.same);
        for line in self.stops.iter().chain(&self.apart) {
            println!("  {line}");
        }
    }

    fn check(&self) {
        self.tell();
        assert!(self.stops.is_empty(), "{:?}", self.stops);
        assert_eq!(self.same.get(&Same::Apart), None, "{:?}", self.apart);
    }
}

/// Nodes on a post went round between holding and slipping for ever: stopped at 0.0, 2.0 and 5.0 s.
#[test]
fn rounds_run_to_their_end_on_every_mesh() {
    let plain = greatest(&catalog::round_post(), 3.5, PLAIN).expect("it runs");
    for segments in [42, 84] {
        let most = greatest(&catalog::round_post(), 3.5, Way { segments: Some(segments), ..PLAIN }).expect("it runs");
        println!("round-post, {segments} segments: {most:.2} N, as it is {plain:.2} N");
        assert!((most / plain - 1.0).abs() < 0.02, "{most} and {plain} N");
    }
    for friction in [0.8, 1.2] {
        greatest(&catalog::round_post(), 3.5, Way { friction, ..PLAIN }).expect("it runs");
    }
    greatest(&catalog::draped_slipping(), 5.0, Way { segments: Some(42), ..PLAIN }).expect("it runs");
}

/// Rounds of finding what slips were used up in silence: 40 N beyond the cone, and the run stopped
/// at 1.1 s.
#[test]
fn a_draped_cable_slips_without_inertia_on_a_fine_mesh() {
    let way = Way { segments: Some(168), inertia: Inertia::QuasiStatic, ..PLAIN };
    let most = greatest(&catalog::draped_slipping(), 1.5, way).expect("it runs");
    println!("{most:.3} N");
    assert!((most / 224.46 - 1.0).abs() < 1e-3, "{most} N");
}

/// Four faults ended runs: cables that go slack on the way back, friction that was still that of
/// the round before, a residual left at a hundred nodes, and bars that were changed and not
/// balanced again. They struck the tank at 7.2 s (`fem`) and 36.7 s (`auto`), and the robot's cable
/// at 31.8 s.
#[test]
fn slack_cables_run_to_their_end_without_inertia() {
    let still = Way { inertia: Inertia::QuasiStatic, ..PLAIN };
    let tank = |way: Way| greatest(&catalog::tank(), 42.0, way).expect("it runs");
    let robot = |way: Way| greatest(&catalog::robot_drive(), 40.0, way).expect("it runs");
    let by_auto = Way { model: Model::Auto, ..still };
    let found = [
        [tank(by_auto), tank(Way { segments: Some(84), ..still })],
        [robot(Way { segments: Some(84), ..still }), robot(Way { segments: Some(42), ..still })],
    ];
    for [a, b] in found {
        println!("{a:.3} and {b:.3} N");
        assert!((a / b - 1.0).abs() < 1e-3, "{a} and {b} N");
    }
}

/// Outputs change nothing, to the bit.
#[test]
fn output_intervals_change_no_greatest_tension() {
    let [a, b] = [0.1, 0.25].map(|every_s| greatest(&catalog::tank(), 4.0, Way { every_s, ..PLAIN }).expect("it runs"));
    assert_eq!(a, b);
}

/// Some of the ways that the long test tries.
#[test]
fn rounds_and_floors_agree_in_some_random_ways() {
    let scenes = [("round-post", catalog::round_post(), 3.5), ("floor-drag", catalog::floor_drag(), 4.0)];
    let ways = |_| at_random(&mut Dice(seed()), 4, 150.0);
    let tasks = scenes.iter().flat_map(|s| ways(s).into_iter().map(move |way| (s.0, &s.1, s.2, way)));
    compare_all(&tasks.collect::<Vec<_>>()).check();
}

#[test]
#[ignore = "hours: every motion of the catalogue, one factor at a time and twenty ways at random"]
fn every_motion_of_the_catalogue_runs_to_its_end() {
    let only_random = std::env::var("WAYS").is_ok_and(|w| w == "random");
    let only = std::env::var("ONLY").unwrap_or_default();
    let scenes = moving();
    let mut tasks = Vec::new();
    for (name, scene, end) in &scenes {
        let mut ways = Vec::new();
        for (model, inertia) in [Model::Auto, Model::Fem]
            .into_iter()
            .flat_map(|model| [Inertia::Dynamic, Inertia::QuasiStatic].map(|inertia| (model, inertia)))
        {
            let plain = Way { model, inertia, ..PLAIN };
            if !only_random {
                ways.extend([42, 84, 168, 336, 1000].map(|n| Way { segments: Some(n), ..plain }));
                ways.extend([1e-2, 1e-4].map(|tolerance| Way { tolerance, ..plain }));
                ways.extend([0.8, 1.2].map(|friction| Way { friction, ..plain }));
                ways.extend([1.0 / 60.0, 1.0].map(|every_s| Way { every_s, ..plain }));
            }
        }
        ways.extend(at_random(&mut Dice(seed()), 20, 1000.0));
        let chosen = |way: &Way| {
            let label = format!("{:?} {:?}", way.model, way.inertia);
            only.split_whitespace().all(|word| label.contains(word))
        };
        tasks.extend(ways.into_iter().filter(chosen).map(|way| (*name, scene, *end, way)));
    }
    compare_all(&tasks).check();
}
