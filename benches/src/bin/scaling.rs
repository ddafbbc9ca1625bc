//! This program writes the page of scaling: time and memory over elements, contacts, corners of the
//! ground, and cables.
//!
//! Run from the root of the repository: `cargo run --release -p cable-benches --bin scaling-page`.
//! It writes `docs/charts/scaling.csv`, `scaling.svg` and `scaling.md`.

use std::error::Error;
use std::fmt::Write as _;
use std::time::Instant;

use cable_benches::chart::{Panel, Series, svg};
use cable_benches::machine::{Clock, measured_now};
use cable_benches::ridges::{arched, ridges};
use cable_core::model::Stepping;
use cable_core::scene::{Obstacle, Shape, Support, catalog};
use cable_core::{Model, Scene, Settings, Simulation};

const FOLDER: &str = "docs/charts";
/// A cost is the least of this many runs, or of as many as fit the time below, at least one.
const REPEATS: usize = 7;
const LONGEST_S: f64 = 1.0;
/// Slope at the foot of the rise that ridges stand on.
const STEEP: f64 = 0.3;
/// Steps of a motion that are timed.
const STEPS: u32 = 4;
const STEP_S: f64 = 1.0 / 240.0;
/// The exponent is that of the sizes from a hundredth of the greatest on.
const FITTED_PART: f64 = 0.01;
/// Pages of memory, bytes.
const PAGE_BYTES: f64 = 4096.0;

/// A question asked at several sizes.
struct Ladder {
    /// Short name, as in the table.
    id: &'static str,
    /// The question.
    about: &'static str,
    /// The things that its size counts.
    size: &'static str,
    sizes: Vec<usize>,
    ask: fn(usize) -> Result<Cost, Box<dyn Error>>,
}

/// The cost of an answer.
#[derive(Clone, Copy)]
struct Cost {
    time_s: f64,
    /// Memory that the process took more of, bytes; None where it took none.
    memory: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    if let [id, size] = &asked[..] {
        return alone(id, size.parse()?);
    }
    let mut measured = Vec::new();
    for ladder in ladders().into_iter().filter(|l| asked.is_empty() || asked.iter().any(|a| a == l.id)) {
        let mut points = Vec::new();
        for &size in &ladder.sizes {
            match in_a_process(ladder.id, size) {
                Ok(cost) => {
                    println!("{} {size}: {:.3e} s, {:?} bytes", ladder.id, cost.time_s, cost.memory);
                    points.push((size, cost));
                }
                Err(e) => println!("{} {size}: {e}", ladder.id),
            }
        }
        measured.push((ladder, points));
    }
    if asked.is_empty() {
        std::fs::create_dir_all(FOLDER)?;
        table(&measured)?;
        std::fs::write(format!("{FOLDER}/scaling.svg"), svg(&panels(&measured), 2))?;
        std::fs::write(format!("{FOLDER}/scaling.md"), page(&measured))?;
    }
    Ok(())
}

/// Measures one size of one question, and prints its time and memory.
fn alone(id: &str, size: usize) -> Result<(), Box<dyn Error>> {
    let ladder = ladders().into_iter().find(|l| l.id == id).ok_or("no such question")?;
    let cost = (ladder.ask)(size)?;
    println!("{} {}", cost.time_s, cost.memory.unwrap_or(0.0));
    Ok(())
}

/// The same in a process of its own, whose memory no other question has used.
fn in_a_process(id: &str, size: usize) -> Result<Cost, Box<dyn Error>> {
    let run = std::process::Command::new(std::env::current_exe()?).args([id, &size.to_string()]).output()?;
    let text = String::from_utf8_lossy(&run.stdout).into_owned();
    let figures: Vec<f64> = text.split_whitespace().filter_map(|t| t.parse().ok()).collect();
    match figures[..] {
        [time_s, memory] => Ok(Cost { time_s, memory: Some(memory).filter(|m| *m > 0.0) }),
        _ => Err(String::from_utf8_lossy(&run.stderr).trim().into()),
    }
}

fn ladders() -> Vec<Ladder> {
    let elements = vec![100, 300, 1000, 3000, 10_000, 30_000, 100_000];
    let contacts = vec![1, 3, 10, 30, 100, 300];
    vec![
        Ladder {
            id: "fem-rest",
            about: "`fem`: a free span comes to rest",
            size: "elements",
            sizes: elements.clone(),
            ask: |n| at_rest(&free_span(), Model::Fem, Some(n)),
        },
        Ladder {
            id: "fem-motion",
            about: "`fem`: a step of 1/240 s of the span as it swings",
            size: "elements",
            sizes: elements.clone(),
            ask: |n| in_motion(&catalog::swinging_span(), Model::Fem, n),
        },
        Ladder {
            id: "fem-floor",
            about: "`fem`: a step of 1/240 s of a cable drawn along a floor",
            size: "elements",
            sizes: elements[..6].to_vec(),
            ask: |n| in_motion(&drawn_along_a_floor(), Model::Fem, n),
        },
        Ladder {
            id: "mass-spring-motion",
            about: "`mass-spring`: a step of 1/240 s of the span as it swings, explicit, in as many inner steps as are \
                    stable: as many as there are elements",
            size: "elements",
            sizes: elements[..4].to_vec(),
            ask: |n| in_motion(&catalog::swinging_span(), Model::MassSpring, n),
        },
        Ladder {
            id: "spans-contacts",
            about: "`spans`: a taut cable over ridges comes to rest",
            size: "contacts",
            sizes: contacts.clone(),
            ask: |n| at_rest(&arched(n, 1, STEEP), Model::Spans, None),
        },
        Ladder {
            id: "fem-contacts",
            about: "`fem`: the same, ten elements a ridge",
            size: "contacts",
            sizes: contacts[..5].to_vec(),
            ask: |n| at_rest(&arched(n, 1, STEEP), Model::Fem, Some(10 * (n + 1))),
        },
        Ladder {
            id: "corners-read",
            about: "a scene over ten ridges is made ready",
            size: "corners of the ground",
            sizes: vec![100, 1000, 10_000, 100_000, 999_000],
            ask: |n| made_ready(&ridges(10, n / 9), Model::Spans),
        },
        Ladder {
            id: "corners-rest",
            about: "`spans`: the cable over them comes to rest",
            size: "corners of the ground",
            sizes: vec![100, 1000, 10_000, 100_000, 999_000],
            ask: |n| at_rest(&ridges(10, n / 9), Model::Spans, None),
        },
        Ladder {
            id: "cables-rest",
            about: "`auto`: cables that lie partly on a floor come to rest",
            size: "cables",
            sizes: vec![1, 3, 10, 30, 100],
            ask: |n| at_rest(&cables(n), Model::Auto, None),
        },
        Ladder {
            id: "cables-motion",
            about: "`fem`: a step of 1/240 s of such cables, 50 elements each",
            size: "cables",
            sizes: vec![1, 3, 10, 30, 100],
            ask: |n| in_motion(&cables(n), Model::Fem, 50),
        },
    ]
}

fn free_span() -> Scene {
    let mut scene = catalog::hanging_span();
    for cable in &mut scene.cables {
        cable.bending_stiffness_n_m2 = 0.0;
    }
    scene
}

fn floor() -> Obstacle {
    let shape = Shape::Terrain { points_m: vec![[-100.0, 0.0], [200.0, 0.0]] };
    Obstacle { name: "floor".into(), shape, friction: Some(0.4) }
}

fn drawn_along_a_floor() -> Scene {
    let lies = 0.01;
    let mut scene = catalog::floor_drag();
    for cable in &mut scene.cables {
        cable.bending_stiffness_n_m2 = 0.0;
        cable.diameter_m = 2.0 * lies;
    }
    scene
}

/// So many cables side by side, each with its middle on a floor.
fn cables(count: usize) -> Scene {
    let supports = |k: usize| {
        let x = 0.1 * k as f64;
        vec![Support::fixed("a", [x, 2.0]), Support::fixed("b", [x + 8.0, 2.0])]
    };
    let mut scene = catalog::cable_alone([10.5, 0.5, 1e6], supports(0));
    let first = scene.cables.first().cloned();
    scene.cables = first
        .into_iter()
        .flat_map(|cable| {
            (0..count).map(move |k| {
                let mut next = cable.clone();
                (next.name, next.supports) = (format!("c{k}"), supports(k));
                next
            })
        })
        .collect();
    scene.obstacles = vec![floor()];
    scene
}

fn simulation(scene: &Scene, model: Model, segments: Option<usize>) -> Result<Simulation, Box<dyn Error>> {
    let settings = Settings { segments, histories: false, stepping: Stepping::Explicit, ..Settings::default() };
    Ok(Simulation::with_settings(scene.clone(), model, settings)?)
}

/// Memory of this process, bytes; None where the system does not say.
fn memory() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    text.split_whitespace().nth(1)?.parse::<f64>().ok().map(|pages| pages * PAGE_BYTES)
}

/// The least time of several runs of what is given, and the memory that the first took.
fn cost(mut run: impl FnMut() -> Result<(f64, Simulation), Box<dyn Error>>) -> Result<Cost, Box<dyn Error>> {
    let (before, clock) = (memory(), Instant::now());
    let (mut least, kept) = run()?;
    let grown = memory().zip(before).map(|(after, before)| after - before).filter(|m| *m > 0.0);
    for _ in 1..REPEATS {
        if clock.elapsed().as_secs_f64() > LONGEST_S {
            break;
        }
        least = least.min(run()?.0);
    }
    drop(kept);
    Ok(Cost { time_s: least, memory: grown })
}

fn at_rest(scene: &Scene, model: Model, segments: Option<usize>) -> Result<Cost, Box<dyn Error>> {
    cost(|| {
        let mut simulation = simulation(scene, model, segments)?;
        let clock = Clock::start();
        simulation.settle()?;
        Ok((clock.spent().seconds(), simulation))
    })
}

fn made_ready(scene: &Scene, model: Model) -> Result<Cost, Box<dyn Error>> {
    cost(|| {
        let clock = Clock::start();
        let simulation = simulation(scene, model, None)?;
        Ok((clock.spent().seconds(), simulation))
    })
}

fn in_motion(scene: &Scene, model: Model, elements: usize) -> Result<Cost, Box<dyn Error>> {
    let mut simulation = simulation(scene, model, Some(elements))?;
    simulation.settle()?;
    // The first steps leave the rest.
    for _ in 0..STEPS {
        simulation.step(STEP_S)?;
    }
    cost(|| {
        let mut copy = simulation.clone();
        let clock = Clock::start();
        for _ in 0..STEPS {
            copy.step(STEP_S)?;
        }
        Ok((clock.spent().seconds() / f64::from(STEPS), copy))
    })
}

type Measured = [(Ladder, Vec<(usize, Cost)>)];

fn table(measured: &Measured) -> Result<(), Box<dyn Error>> {
    let mut csv = csv::Writer::from_path(format!("{FOLDER}/scaling.csv"))?;
    csv.write_record(["question", "size_of", "size", "time_s", "memory_bytes"])?;
    for (ladder, points) in measured {
        for (size, cost) in points {
            let memory = cost.memory.map_or_else(String::new, |m| format!("{m:.0}"));
            csv.write_record([ladder.id, ladder.size, &size.to_string(), &format!("{:.3e}", cost.time_s), &memory])?;
        }
    }
    Ok(csv.flush()?)
}

/// Exponent of the time over the greatest sizes, by least squares of logarithms; None of fewer than
/// two.
fn exponent(points: &[(usize, Cost)]) -> Option<f64> {
    let most = points.last()?.0 as f64;
    let logs: Vec<(f64, f64)> = points
        .iter()
        .filter(|(n, _)| *n as f64 >= FITTED_PART * most)
        .map(|(n, c)| ((*n as f64).ln(), c.time_s.ln()))
        .collect();
    let count = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / count, b + y / count));
    let (top, bottom) = logs.iter().fold((0.0, 0.0), |(a, b), (u, v)| (a + (u - x) * (v - y), b + (u - x) * (u - x)));
    (logs.len() > 1).then(|| top / bottom)
}

const COLOURS: [&str; 4] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7"];

/// One panel for each thing that is counted.
fn panels(measured: &Measured) -> Vec<Panel> {
    let of = |size: &'static str| {
        let ladders = measured.iter().filter(|(l, _)| l.size == size);
        let series: Vec<Series> = ladders
            .enumerate()
            .map(|(k, (ladder, points))| Series {
                name: ladder.id.to_owned(),
                colour: COLOURS[k % COLOURS.len()],
                corners: [0, 4, 3, 5][k % 4],
                joined: true,
                points: points.iter().map(|(n, c)| (*n as f64, c.time_s)).collect(),
            })
            .collect();
        let names: Vec<String> = series.iter().map(|s| s.name.clone()).collect();
        Panel {
            title: names.join(", "),
            x_label: size,
            y_label: "time (s)",
            x_decades: (0, 6),
            y_decades: (-6, 2),
            series,
        }
    };
    ["elements", "contacts", "corners of the ground", "cables"].map(of).into()
}

fn page(measured: &Measured) -> String {
    let mut out = format!(
        "# What size costs

This page shows how time and memory grow with the number of elements, contacts, corners of the ground
and cables. `cargo run --release -p cable-benches --bin scaling-page` makes it. A time is the least
of several on one core (elapsed, or of the processor where that is less); the exponent is fitted over the upper two decades. Memory is what
the process took more of at the greatest size, model and scene together. Figures are in
[scaling.csv](scaling.csv).

{}

![Time over size](scaling.svg)

| question | from | to | time at the least and greatest | exponent | memory |
|---|---|---|---|---|---|
",
        measured_now()
    );
    for (ladder, points) in measured {
        let (Some(first), Some(last)) = (points.first(), points.last()) else { continue };
        let exponent = exponent(points).map_or_else(|| "–".to_owned(), |e| format!("{e:.2}"));
        let most = points.iter().filter_map(|(_, c)| c.memory).fold(0.0, f64::max);
        let memory = if most > 0.0 { format!("{:.1} MB", most / 1e6) } else { "–".to_owned() };
        let [a, b] = [first.1.time_s, last.1.time_s].map(time);
        let _ = writeln!(
            out,
            "| {} | {} | {} {} | {a} to {b} | {exponent} | {memory} |",
            ladder.about, first.0, last.0, ladder.size
        );
    }
    for (ladder, points) in measured {
        let answered = |size: &usize| points.iter().any(|(n, _)| n == size);
        let missing: Vec<String> = ladder.sizes.iter().filter(|n| !answered(n)).map(usize::to_string).collect();
        if !missing.is_empty() {
            let _ = writeln!(out, "\nNo answer ({}) with {} {}.", ladder.about, missing.join(", "), ladder.size);
        }
    }
    out
}

/// A time with its unit.
fn time(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.1} µs", 1e6 * s),
        s if s < 1.0 => format!("{:.2} ms", 1e3 * s),
        s => format!("{s:.2} s"),
    }
}
