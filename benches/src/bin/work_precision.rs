//! This program draws work–precision charts: the error of every model against its cost, on several
//! meshes and steps, for every scene of the catalogue and every motion of
//! [`cable_benches::motion`], and for comparison those of other programs.
//!
//! Run from the root of the repository:
//! `cargo run --release -p cable-benches --bin work-precision`. It measures, and writes
//! `docs/charts/work_precision.csv`, a chart a scene into `docs/charts/work_precision/` and the
//! page `docs/charts/work_precision.md`. `-- tank swing` measures some of them and prints their
//! points; `-- anew tank swing` measures them and takes the others as they are in the table;
//! `-- draw` draws the table again. Points of other programs are read from `docs/charts/peers.csv`,
//! which `benches/peers/run` writes.
//!
//! A cost is the least time of several solves, on one core, without building the model and without
//! the search of other friction histories.

use std::collections::BTreeSet;
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use cable_benches::chart::{Panel, Series, svg};
use cable_benches::compare::{self, Question, Reference, lies_in_itself};
use cable_benches::dots::{self, Dot, Line, Plot};
use cable_benches::machine::{MEASURED, Spent, measured_now};
use cable_benches::motion::{Measured, Motion, motions};
use cable_benches::span_of;
use cable_core::catenary::Catenary;
use cable_core::scene::{SupportKind, catalog};
use cable_core::{Model, Scene, Vec2};
use serde::{Deserialize, Serialize};

const FOLDER: &str = "docs/charts";
const TABLE: &str = "docs/charts/work_precision.csv";
const PEERS: &str = "docs/charts/peers.csv";
const PAGE: &str = "docs/charts/work_precision.md";

/// Meshes of scenes at rest, and of slow motion, in elements.
const REST_MESHES: [usize; 7] = [10, 20, 40, 80, 160, 320, 640];
const SLOW_MESHES: [usize; 4] = [20, 40, 80, 160];
/// Elements of the reference if no model without a mesh answers; the first mesh with an answer
/// counts.
const FINEST_AT_REST: [usize; 3] = [2560, 640, 160];
const FINEST_SLOW: [usize; 3] = [640, 320, 160];
/// Steps of motions, s. Within [`MASS_SPRING_STEP_S`], `mass-spring` takes the longest stable inner
/// steps of its mesh.
const STEPS: [f64; 6] = [1.0 / 30.0, 1.0 / 60.0, 1.0 / 120.0, 1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0];
const MASS_SPRING_STEP_S: f64 = 1.0 / 240.0;
/// A finer mesh is not tried if the present one took longer than this, s.
const LONGEST_S: f64 = 6.0;
/// Least number of runs of a motion.
const MOTION_REPEATS: usize = 3;
/// Number of calls of the catenary as a function; the least time counts.
const FUNCTION_REPEATS: usize = 2000;
/// Errors below this are drawn as this value, as the axis is logarithmic.
const LEAST_ERROR: f64 = 1e-13;
/// Errors for which the page names the cheapest program and setting.
const GOALS: [f64; 3] = [1e-2, 1e-3, 1e-6];

/// Colour and mark of every model and program. The colours are those of M. Okabe and K. Ito, "Color
/// universal design" (2008), and grey tones beyond eight.
const MARKS: [(&str, &str, u32); 14] = [
    ("catenary", "#000000", 4),
    ("spans", "#009E73", 3),
    ("fem", "#0072B2", 0),
    ("mass-spring", "#D55E00", 4),
    ("moorpy", "#CC79A7", 5),
    ("moordyn", "#CC79A7", 3),
    ("cabledyn", "#F0E442", 4),
    ("opensees", "#56B4E9", 5),
    ("exudyn", "#56B4E9", 3),
    ("mujoco", "#E69F00", 5),
    ("pymunk", "#E69F00", 3),
    ("box2d", "#999999", 5),
    ("rapier2d", "#999999", 3),
    ("other", "#BBBBBB", 6),
];

/// One measured point, a line of the table.
#[derive(Clone, Debug, Deserialize, Serialize)]
struct Point {
    scene: String,
    who: String,
    setting: String,
    cost_s: Option<f64>,
    error: Option<f64>,
    shape_error: Option<f64>,
    note: String,
}

impl Point {
    /// Cost (s) and error, if the point has both.
    fn measured(&self) -> Option<(f64, f64)> {
        let (cost, error) = (self.cost_s?, self.error?);
        (cost > 0.0 && error.is_finite()).then_some((cost, if error > LEAST_ERROR { error } else { LEAST_ERROR }))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut asked: Vec<String> = std::env::args().skip(1).collect();
    let anew = asked.first().is_some_and(|a| a == "anew");
    if anew {
        asked.remove(0);
    }
    if asked.iter().any(|a| a == "draw") {
        // The page says of its points when they were measured.
        let page = std::fs::read_to_string(PAGE).unwrap_or_default();
        let line = page.lines().find(|line| line.starts_with(MEASURED)).unwrap_or("");
        return draw(&read(TABLE)?, line);
    }
    let wanted = |id: &str| asked.is_empty() || asked.iter().any(|a| a == id);
    let mut points = Vec::new();
    for (id, scene) in scenes() {
        if wanted(id) {
            points.extend(at_rest(id, &scene));
        }
    }
    for motion in motions().iter().filter(|m| wanted(m.id)) {
        points.extend(in_motion(motion)?);
    }
    if anew {
        let mut all: Vec<Point> = read(TABLE)?.into_iter().filter(|p| !wanted(&p.scene)).collect();
        all.append(&mut points);
        let order: Vec<&str> = scenes().iter().map(|s| s.0).chain(motions().iter().map(|m| m.id)).collect();
        all.sort_by_key(|p| order.iter().position(|id| *id == p.scene));
        points = all;
    } else if !asked.is_empty() {
        return Ok(());
    }
    write(TABLE, &points)?;
    draw(&points, &measured_now())
}

/// The outward drive in the tank: on the way back the cable folds, and `spans` has no answer.
const TANK_DRIVE: &str = "tank-drive";
/// Knots of the drive on its way out.
const OUT_KNOTS: usize = 3;
/// The drive is shortened to this fraction of its time: without inertia its speed does not matter.
const HURRY: f64 = 0.4;

/// The catalogue, and the drive in the tank.
fn scenes() -> Vec<(&'static str, Scene)> {
    let mut drive = catalog::tank();
    let supports = drive.cables.iter_mut().flat_map(|c| &mut c.supports);
    for motion in supports.filter_map(|s| s.motion.as_mut()) {
        motion.times_s.iter_mut().for_each(|t| *t *= HURRY);
        motion.times_s.truncate(OUT_KNOTS);
        motion.points_m.truncate(OUT_KNOTS);
    }
    let mut scenes = catalog::all();
    scenes.push((TANK_DRIVE, drive));
    scenes
}

fn tell(point: &Point) {
    let number = |n: Option<f64>| n.map_or("–".to_owned(), |n| format!("{n:.2e}"));
    let [cost, error, shape] = [point.cost_s, point.error, point.shape_error].map(number);
    println!("{} {} {}: {cost} s, error {error}, shape {shape} {}", point.scene, point.who, point.setting, point.note);
}

/// Measures every model on a scene at rest, or at the end of its slow motion.
fn at_rest(id: &'static str, scene: &Scene) -> Vec<Point> {
    let rests = Question::of(scene) == Question::Rest;
    let (meshes, finest) = if rests { (&REST_MESHES[..], FINEST_AT_REST) } else { (&SLOW_MESHES[..], FINEST_SLOW) };
    let usable = |n: &usize| !lies_in_itself(scene, *n);
    let Some(reference) = finest.into_iter().filter(usable).find_map(|n| Reference::of(scene, n)) else {
        eprintln!("skipped: {id} has no reference");
        return Vec::new();
    };
    let mut out: Vec<Point> = catenary_alone(id, scene).into_iter().collect();
    let mut ask = |model: Model, segments: Option<usize>| {
        let point = measured(id, scene, &reference, model, segments)?;
        out.push(point.clone());
        point.cost_s
    };
    ask(Model::Catenary, None);
    ask(Model::Spans, None);
    for model in [Model::Fem, Model::MassSpring] {
        for &n in meshes.iter().filter(|n| usable(n)) {
            if ask(model, Some(n)).is_some_and(|cost| cost > LONGEST_S) {
                break;
            }
        }
    }
    out
}

/// Measures a model on a scene; `None`, with a line on standard error, if it has no answer.
fn measured(
    id: &'static str,
    scene: &Scene,
    reference: &Reference,
    model: Model,
    segments: Option<usize>,
) -> Option<Point> {
    let row = compare::measure(id, scene, reference, (model, segments))?;
    let own = reference.by == model.name();
    let note = match reference.by.as_str() {
        "catenary" | "spans" => format!("against {}", reference.by),
        by => format!("against {by}, known to {:.0e}", reference.uncertainty),
    };
    let point = Point {
        scene: id.to_owned(),
        who: model.name().to_owned(),
        setting: segments.map_or_else(|| "no mesh".to_owned(), |n| format!("N={n}")),
        cost_s: Some(row.cost_s),
        // The error of the reference itself is its rounding, which it estimates.
        error: Some(if own { row.said.unwrap_or(0.0) } else { row.error }),
        shape_error: (!own).then_some(row.shape_error),
        note,
    };
    tell(&point);
    Some(point)
}

/// Measures the catenary as a function, without a simulation, for a scene of one span; its error is
/// the closure error.
fn catenary_alone(id: &str, scene: &Scene) -> Option<Point> {
    let flexible = scene.cables.iter().all(|c| c.bending_stiffness_n_m2 == 0.0);
    let span = span_of(scene).filter(|_| scene.obstacles.is_empty() && scene.loads.is_empty() && flexible)?;
    let mut least = f64::INFINITY;
    for _ in 0..FUNCTION_REPEATS {
        let clock = Instant::now();
        let solved = std::hint::black_box(Catenary::solve(std::hint::black_box(&span)));
        least = least.min(clock.elapsed().as_secs_f64());
        solved.ok()?;
    }
    let error = (Catenary::solve(&span).ok()?.position_at(span.length) - span.chord).norm() / span.length;
    let point = Point {
        scene: id.to_owned(),
        who: "catenary".to_owned(),
        setting: "the function alone".to_owned(),
        cost_s: Some(least),
        error: Some(error),
        shape_error: None,
        note: "how far its end is off, over its length".to_owned(),
    };
    tell(&point);
    Some(point)
}

/// Measures `fem` and `mass-spring` on a motion.
fn in_motion(motion: &Motion) -> Result<Vec<Point>, Box<dyn Error>> {
    let finest = extrapolated(motion)?;
    let exact = motion.exact.map_or(finest.figure, |exact| exact());
    let mut out = Vec::new();
    for model in [Model::Fem, Model::MassSpring] {
        let steps = if model == Model::Fem { &STEPS[..] } else { &[MASS_SPRING_STEP_S] };
        'meshes: for &n in motion.meshes {
            for &step_s in steps {
                let found = followed(motion, model, n, step_s);
                let (cost, error, shape_error, note) = match &found {
                    Ok(runs) => {
                        let cost = Spent::least_s(&runs.iter().map(|r| r.spent).collect::<Vec<_>>());
                        let figure = runs.first().map_or_else(Vec2::zeros, |r| r.figure);
                        let shape_error = runs.first().and_then(|r| apart(r, &finest));
                        (Some(cost), Some((figure - exact).norm() / exact.norm()), shape_error, String::new())
                    }
                    Err(e) => (None, None, None, e.to_string()),
                };
                let setting =
                    if model == Model::Fem { format!("N={n} dt=1/{:.0}", 1.0 / step_s) } else { format!("N={n}") };
                let (scene, who) = (motion.id.to_owned(), model.name().to_owned());
                let point = Point { scene, who, setting, cost_s: cost, error, shape_error, note };
                tell(&point);
                out.push(point);
                if cost.is_some_and(|c| c > LONGEST_S) {
                    break 'meshes;
                }
            }
        }
    }
    Ok(out)
}

/// The results of repeated runs of a motion.
fn followed(motion: &Motion, model: Model, elements: usize, step_s: f64) -> Result<Vec<Measured>, cable_core::Error> {
    let (mut runs, mut spent) = (Vec::new(), Vec::new());
    while Spent::wants_more(&spent, MOTION_REPEATS) {
        let run = motion.measure(model, elements, step_s)?;
        spent.push(run.spent);
        runs.push(run);
    }
    Ok(runs)
}

/// Figure and shape of a motion, extrapolated to zero mesh size and step with errors of the second
/// order.
struct Finest {
    figure: Vec2,
    shape: Vec<Vec2>,
}

/// The result of `fem` on the finest mesh in half the shortest step, extrapolated.
fn extrapolated(motion: &Motion) -> Result<Finest, Box<dyn Error>> {
    let finest = motion.meshes.last().copied().ok_or("a motion without meshes")?;
    let step = 0.5 * STEPS[STEPS.len() - 1];
    let at = |n: usize, step_s: f64| motion.measure(Model::Fem, n, step_s);
    let fine = at(finest, step)?;
    let [mesh, steps] = [at(finest / 2, step)?, at(finest, 2.0 * step)?];
    let limit = |fine: Vec2, mesh: Vec2, steps: Vec2| fine + (fine - mesh) / 3.0 + (fine - steps) / 3.0;
    let shape = fine.shape.iter().zip(&mesh.shape).zip(&steps.shape).map(|((a, b), c)| limit(*a, *b, *c)).collect();
    Ok(Finest { figure: limit(fine.figure, mesh.figure, steps.figure), shape })
}

/// The greatest distance between two places of a cable at the end of a motion, over its length.
fn apart(run: &Measured, finest: &Finest) -> Option<f64> {
    let distances = run.shape.iter().zip(&finest.shape).map(|(a, b)| (a - b).norm());
    let most =
        distances.fold(None, |most: Option<f64>, d| Some(most.map_or(d, |most| if d > most { d } else { most })));
    most.map(|most| most / run.length_m)
}

fn read(path: &str) -> Result<Vec<Point>, Box<dyn Error>> {
    Ok(csv::Reader::from_path(path)?.deserialize().collect::<Result<_, _>>()?)
}

fn write(path: &str, points: &[Point]) -> Result<(), Box<dyn Error>> {
    let mut csv = csv::Writer::from_path(path)?;
    for p in points {
        let rounded = |n: Option<f64>| n.and_then(|n| format!("{n:.3e}").parse().ok());
        let [cost_s, error, shape_error] = [p.cost_s, p.error, p.shape_error].map(rounded);
        csv.serialize(Point { cost_s, error, shape_error, ..p.clone() })?;
    }
    Ok(csv.flush()?)
}

/// Charts and page of the table, with the line that says when it was measured, and of what other
/// programs were measured with.
fn draw(own: &[Point], measured: &str) -> Result<(), Box<dyn Error>> {
    let peers = if Path::new(PEERS).exists() { read(PEERS)? } else { Vec::new() };
    let all: Vec<Point> = own.iter().chain(&peers).cloned().collect();
    let mut ids: Vec<String> = Vec::new();
    for p in own {
        if !ids.contains(&p.scene) {
            ids.push(p.scene.clone());
        }
    }
    std::fs::create_dir_all(format!("{FOLDER}/work_precision"))?;
    let (mut sections, mut missed) = (String::new(), Vec::new());
    for id in &ids {
        let points: Vec<&Point> = all.iter().filter(|p| p.scene == *id).collect();
        std::fs::write(format!("{FOLDER}/work_precision/{id}.svg"), svg(&panels(id, &points), 2))?;
        missed.extend(section(&mut sections, id, &points));
    }
    let page = format!("{HEAD}\n{measured}\n{}{sections}", shortfalls(&missed));
    std::fs::write(format!("{FOLDER}/work_precision.svg"), dots::svg(&front(&ids, &all)))?;
    std::fs::write(PAGE, page)?;
    println!("{} points of {} scenes drawn on {PAGE}", all.len(), ids.len());
    Ok(())
}

const HEAD: &str = "# Work and precision

This page shows what an answer costs at what error, scene by scene: each model on its meshes and steps,
and other programs on the same scenes where they can express them ([how](../../benches/peers/README.md)).
`cargo run --release -p cable-benches --bin work-precision` makes it; with `benches/peers/run` before it
the points of other programs are of the same machine and hour. A cost is the least time of
several solves on one core (elapsed, or of the processor where that is less), of the solve alone: without building the model and without the search of
other equilibria that friction allows (`Settings::histories` is off). At rest the error is the largest
of any support's force and of the greatest tension, over the greatest tension; in motion that of the
figure named in [convergence.md](../convergence.md), and that of the shape is how far 33 places of the cable
are at the end from where the finest run of `fem` has them, extrapolated. Figures are in
[work_precision.csv](work_precision.csv) and [peers.csv](peers.csv).

![Cost of an error of 1e-2 and of 1e-3 in every scene](work_precision.svg)
";

/// Reads the figure of a panel off a point.
type Read = fn(&Point) -> Option<(f64, f64)>;

fn panels(id: &str, points: &[&Point]) -> Vec<Panel> {
    let shape: Read = |p| {
        let error = p.shape_error?;
        (error.is_finite() && p.cost_s? > 0.0)
            .then_some((p.cost_s?, if error > LEAST_ERROR { error } else { LEAST_ERROR }))
    };
    let reads: [(Read, &'static str); 2] =
        [(Point::measured, "error of forces or figure (relative)"), (shape, "error of shape (distance / length)")];
    let shown: Vec<_> = reads.into_iter().filter(|(read, _)| points.iter().any(|p| read(p).is_some())).collect();
    let who: BTreeSet<&str> = points.iter().map(|p| p.who.as_str()).collect();
    let known = |name: &str| MARKS.iter().any(|m| m.0 == name);
    shown
        .into_iter()
        .map(|(read, y_label)| {
            let mut series = Vec::new();
            for (name, colour, corners) in MARKS {
                let is = |p: &&&Point| p.who == name || (name == "other" && !known(&p.who));
                if !who.iter().any(|w| *w == name || (name == "other" && !known(w))) {
                    continue;
                }
                let mut all: Vec<(f64, f64)> = points.iter().filter(is).filter_map(|p| read(p)).collect();
                all.sort_by(|a, b| a.0.total_cmp(&b.0));
                let mut best = f64::INFINITY;
                let (front, rest): (Vec<_>, Vec<_>) = all.into_iter().partition(|p| {
                    let better = p.1 < best;
                    best = best.min(p.1);
                    better
                });
                let name = name.to_owned();
                series.push(Series { name, colour, corners, joined: true, points: front });
                series.push(Series { name: String::new(), colour, corners, joined: false, points: rest });
            }
            let title = id.to_owned();
            Panel { title, x_label: "cost of an answer (s)", y_label, x_decades: (-7, 2), y_decades: (-13, 0), series }
        })
        .collect()
}

/// The cheapest of some points whose error is at most `goal`.
fn cheapest<'a>(points: &[&'a Point], goal: f64) -> Option<(&'a Point, f64)> {
    let within = points.iter().filter_map(|p| p.measured().filter(|m| m.1 <= goal).map(|m| (*p, m.0)));
    within.min_by(|a, b| a.1.total_cmp(&b.1))
}

fn is_ours(p: &Point) -> bool {
    Model::from_name(&p.who).is_some()
}

/// A cost as text.
fn cost(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.3} µs", 1e6 * s),
        s if s < 1.0 => format!("{:.3} ms", 1e3 * s),
        s => format!("{s:.2} s"),
    }
}

/// The factor by which the best other program should cost more at an equal error: with obstacles or
/// wheels, and in the air or in motion.
const ASKED_TIMES: [f64; 2] = [100.0, 5.0];

/// The goal of a scene or motion.
fn asked_times(id: &str) -> f64 {
    let leads = |s: &Scene| {
        let mut supports = s.cables.iter().flat_map(|c| &c.supports);
        !s.obstacles.is_empty() || supports.any(|s| s.kind == SupportKind::Pulley)
    };
    ASKED_TIMES[usize::from(!scenes().iter().any(|(known, scene)| *known == id && leads(scene)))]
}

/// Remarks on scenes.
const REMARKS: [(&str, &str); 1] = [(
    TANK_DRIVE,
    "Without inertia, in 60 steps out. With inertia its greatest tension depends on small \
     differences of mesh and step, so that there is nothing to compare with.",
)];

/// A missed goal.
struct Missed {
    id: String,
    error: f64,
    times: f64,
    asked: f64,
    /// The cheapest program and its caveats.
    by: String,
}

/// The program, its setting, and the reservations about its answer.
fn with_caveat(p: &Point) -> String {
    let caveat = if p.note.is_empty() || is_ours(p) { String::new() } else { format!(" ({})", p.note) };
    format!("{}, {}{caveat}", p.who, p.setting)
}

/// Appends the section of a scene; returns the goals that it misses.
fn section(page: &mut String, id: &str, points: &[&Point]) -> Vec<Missed> {
    let _ = write!(page, "\n## {id}\n\n![Error over cost in {id}](work_precision/{id}.svg)\n\n");
    if let Some((_, remark)) = REMARKS.iter().find(|(of, _)| *of == id) {
        let _ = writeln!(page, "{remark}\n");
    }
    let asked = asked_times(id);
    let mut missed = Vec::new();
    let _ = writeln!(
        page,
        "| error | cheapest | cost | cheapest other program | cost | times ours | goal |\n|---|---|---|---|---|---|---|"
    );
    let ours: Vec<&Point> = points.iter().copied().filter(|p| is_ours(p)).collect();
    let others: Vec<&Point> = points.iter().copied().filter(|p| !is_ours(p)).collect();
    for goal in GOALS {
        let way = |of: &[&Point]| {
            cheapest(of, goal).map_or(["–".to_owned(), "–".to_owned()], |(p, s)| [with_caveat(p), cost(s)])
        };
        let ([a, b], [c, d]) = (way(&ours), way(&others));
        let (times, met) = match (cheapest(&ours, goal), cheapest(&others, goal)) {
            (own, Some((p, other))) => {
                // If no model of this simulator has an answer, the goal is missed without a figure.
                let times = own.map_or(0.0, |(_, own)| other / own);
                if times < asked {
                    missed.push(Missed { id: id.to_owned(), error: goal, times, asked, by: with_caveat(p) });
                }
                let met = if times < asked { "less than" } else { "met:" };
                (show_times(times), format!("{met} {asked:.0}"))
            }
            _ => ("–".to_owned(), "–".to_owned()),
        };
        let _ = writeln!(page, "| {goal:.0e} | {a} | {b} | {c} | {d} | {times} | {met} |");
    }
    let notes: BTreeSet<String> = points
        .iter()
        .filter(|p| p.measured().is_none() && !p.note.is_empty())
        .map(|p| format!("{} ({}): {}", p.who, p.setting, p.note))
        .collect();
    if !notes.is_empty() {
        let _ = writeln!(page, "\nWithout an answer:\n");
        for note in notes {
            let _ = writeln!(page, "- {note}");
        }
    }
    missed
}

/// The ratio of two costs as text; 0 stands for none.
fn show_times(times: f64) -> String {
    match times {
        0.0 => "–".to_owned(),
        t if t < 1.0 => format!("{t:.2}"),
        t => format!("{t:.1}"),
    }
}

/// The goals that are missed, for the head of the page.
fn shortfalls(missed: &[Missed]) -> String {
    let mut out = format!(
        "\n## Goals missed\n\nAt an equal error the best other program should cost {:.0} times ours with obstacles or \
         wheels, {:.0} times in the air and in motion. ",
        ASKED_TIMES[0], ASKED_TIMES[1]
    );
    if missed.is_empty() {
        out.push_str("Wherever another program answers, that is so.\n");
        return out;
    }
    out.push_str(
        "It is less here:\n\n| scene | error | times ours | asked | best other program |\n|---|---|---|---|---|\n",
    );
    for m in missed {
        let times = if m.times > 0.0 { show_times(m.times) } else { "ours has no answer".to_owned() };
        let _ = writeln!(out, "| [{0}](#{0}) | {1:.0e} | {times} | {2:.0} | {3} |", m.id, m.error, m.asked, m.by);
    }
    out
}

/// The front over all scenes: what an error of 1e-2 and one of 1e-3 costs each.
fn front(scenes: &[String], all: &[Point]) -> Plot {
    let line = |id: &String| {
        let points: Vec<&Point> = all.iter().filter(|p| p.scene == *id).collect();
        let dots = [GOALS[0], GOALS[1]].map(|goal| {
            let of = |(name, colour, corners): (&str, &'static str, u32)| {
                let own: Vec<&Point> = points.iter().copied().filter(|p| p.who == name).collect();
                cheapest(&own, goal).map(|(_, value)| Dot { value, colour, corners })
            };
            MARKS.into_iter().filter_map(of).collect()
        });
        Line { name: id.clone(), note: String::new(), blind_to: 0.0, dots }
    };
    let present = |name: &str| all.iter().any(|p| p.who == name && p.measured().is_some());
    Plot {
        title: "What an error of 1e-2 and of 1e-3 costs (further left is better)".to_owned(),
        legend: MARKS.into_iter().filter(|m| present(m.0)).map(|(n, c, k)| (n.to_owned(), c, k)).collect(),
        columns: [("cost of an error of 1e-2 (s)", (-7, 1)), ("cost of an error of 1e-3 (s)", (-7, 1))],
        lines: scenes.iter().map(line).collect(),
    }
}
