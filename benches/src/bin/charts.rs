//! This program charts speed against accuracy: the error of the largest tension and of the shape
//! against what an answer costs, for a slack and a nearly taut span, into
//! `docs/charts/speed_accuracy.csv` and `.svg`; and every scene of the catalogue, `fem`,
//! `mass-spring` and `spans` side by side, into `scenes.csv`, `scenes.svg` (100 elements) and
//! `scenes_ladder.svg` (25 to 400).
//!
//! Run from the root of the repository: `cargo run --release -p cable-benches --bin charts`; with
//! `-- scenes` only the catalogue is measured, with `-- draw` the scenes are drawn again from their
//! table, and nothing is measured. The exact answer is the elastic catenary's, tested to 1e-9
//! against 40-digit references; the catenary's own points show the round-off between two ways to
//! it. A cost is that of settling from the first route, without building the model and without the
//! search of other friction histories.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use cable_benches::chart::{Panel, Series, svg};
use cable_benches::compare::{self, Question, Reference, lies_in_itself};
use cable_benches::table::{self, Record};
use cable_benches::{dots, fresh, span_of};
use cable_core::catenary::Catenary;
use cable_core::scene::catalog;
use cable_core::{Model, Scene, Solution, Vec2};

const FOLDER: &str = "docs/charts";
const MESHES: [usize; 7] = [10, 20, 40, 80, 160, 320, 640];
/// Errors below round-off are drawn at round-off, for a logarithm's sake.
const ROUND_OFF: f64 = 1e-16;
/// A cost is the median of this many solves, or of as many as fit the time below, at least three.
const REPEATS: usize = 31;
const LONGEST_S: f64 = 4.0;
/// A mesh is not tried where the one half as fine took longer than this.
const TOO_LONG_S: f64 = 3.0;

/// One measured answer.
struct Row {
    scene: &'static str,
    model: Model,
    segments: Option<usize>,
    cost_s: f64,
    tension_error: f64,
    shape_error: f64,
}

/// Reads the figure of an axis off a row.
type Read = fn(&Row) -> f64;

fn main() -> Result<(), Box<dyn Error>> {
    match std::env::args().nth(1).as_deref() {
        Some("draw") => return draw(),
        Some("scenes") => {
            catalogue()?;
            return draw();
        }
        _ => {}
    }
    let scenes = [("hanging-span", catalog::hanging_span()), ("near-taut", catalog::near_taut())];
    let mut rows = Vec::new();
    for (id, scene) in &scenes {
        let exact = exact(scene)?;
        rows.extend(measure(id, scene, &exact, Model::Catenary, None));
        for model in [Model::Fem, Model::MassSpring] {
            for n in MESHES {
                let Some(row) = measure(id, scene, &exact, model, Some(n)) else { break };
                let slow = row.cost_s > TOO_LONG_S;
                rows.push(row);
                if slow {
                    eprintln!("skipped: {model} on \"{id}\" beyond {n} elements: too slow");
                    break;
                }
            }
        }
    }
    std::fs::create_dir_all(FOLDER)?;
    write_csv(&rows)?;
    std::fs::write(format!("{FOLDER}/speed_accuracy.svg"), svg(&panels(&rows), scenes.len()))?;
    catalogue()?;
    draw()?;
    println!("{} points written to {FOLDER}/speed_accuracy.csv and .svg", rows.len());
    Ok(())
}

/// Elements of the ladder over the catalogue. A motion is dearer than a rest.
const REST_MESHES: [usize; 3] = [25, 100, 400];
const MOTION_MESHES: [usize; 3] = [25, 50, 100];
/// Elements of the reference where there is no closed form: the first that answers.
const FINEST: [usize; 3] = [1600, 400, 100];
const FINEST_MOTION: [usize; 3] = [200, 100, 50];
/// The table of the catalogue.
const TABLE: &str = "scenes.csv";

/// Every scene of the catalogue, measured.
fn catalogue() -> Result<(), Box<dyn Error>> {
    let mut records = Vec::new();
    for (id, scene) in catalog::all() {
        let question = Question::of(&scene);
        let (meshes, finest) =
            if question == Question::Rest { (REST_MESHES, FINEST) } else { (MOTION_MESHES, FINEST_MOTION) };
        let Some(reference) =
            finest.iter().filter(|n| !lies_in_itself(&scene, **n)).find_map(|n| Reference::of(&scene, *n))
        else {
            eprintln!("skipped: {id} has no reference");
            continue;
        };
        for (model, ..) in table::MARKS {
            let fine = meshes.into_iter().filter(|n| !lies_in_itself(&scene, *n)).map(Some);
            let asked: Vec<Option<usize>> = if model == Model::Spans { vec![None] } else { fine.collect() };
            for n in asked {
                let Some(row) = compare::measure(id, &scene, &reference, (model, n)) else { continue };
                println!("{id}, {model}, {n:?}: error {:.1e}, {:.2e} s", row.error, row.cost_s);
                records.push(Record::of(&row, question, &reference));
            }
        }
    }
    table::write(&PathBuf::from(FOLDER).join(TABLE), &records)
}

/// Draws what the table says.
fn draw() -> Result<(), Box<dyn Error>> {
    let records = table::read(&PathBuf::from(FOLDER).join(TABLE))?;
    std::fs::write(format!("{FOLDER}/scenes.svg"), dots::svg(&table::plot(&records)))?;
    std::fs::write(format!("{FOLDER}/scenes_ladder.svg"), svg(&table::ladders(&records), 4))?;
    Ok(())
}

/// The catenary of a scene of two fixed supports.
fn exact(scene: &Scene) -> Result<Catenary, Box<dyn Error>> {
    Ok(Catenary::solve(&span_of(scene).ok_or("the scene is no single span")?)?)
}

/// Cost and errors of one model and mesh; None, with a note, where it does not answer.
fn measure(id: &'static str, scene: &Scene, exact: &Catenary, model: Model, segments: Option<usize>) -> Option<Row> {
    let start = fresh(scene, model, segments)?;
    let (mut costs, all) = (Vec::new(), Instant::now());
    let mut answer = None;
    while costs.len() < REPEATS && (costs.len() < 3 || all.elapsed().as_secs_f64() < LONGEST_S) {
        let mut simulation = start.clone();
        let clock = Instant::now();
        let result = simulation.settle();
        costs.push(clock.elapsed().as_secs_f64());
        match result {
            Ok(a) => answer = Some(a),
            Err(e) => {
                eprintln!("skipped: {model} on \"{id}\" with {segments:?} elements: {e}");
                return None;
            }
        }
        if costs[0] > LONGEST_S {
            break;
        }
    }
    costs.sort_by(f64::total_cmp);
    let (tension_error, shape_error) = errors(&answer?, exact);
    let cost_s = costs[costs.len() / 2];
    println!("{id} {model} {segments:?}: {cost_s:.2e} s, tension {tension_error:.2e}, shape {shape_error:.2e}");
    Some(Row { scene: id, model, segments, cost_s, tension_error, shape_error })
}

/// Relative error of the largest tension, and the largest distance of a node from where that
/// material point is, over the length.
fn errors(answer: &Solution, exact: &Catenary) -> (f64, f64) {
    let tension = (answer.max_tension().tension_n / exact.max_tension() - 1.0).abs();
    let Some(cable) = answer.cables.first() else { return (f64::NAN, f64::NAN) };
    let origin = cable.nodes.first().map_or_else(Vec2::zeros, |n| Vec2::new(n.x_m, n.y_m));
    let off = cable
        .nodes
        .iter()
        .map(|n| (Vec2::new(n.x_m, n.y_m) - origin - exact.position_at(n.arc_length_m)).norm() / exact.span().length);
    // NaN is kept: it stands in the table, and has no place on the chart.
    (tension, off.fold(0.0, |worst: f64, d| if worst.is_nan() || d <= worst { worst } else { d }))
}

fn write_csv(rows: &[Row]) -> Result<(), Box<dyn Error>> {
    let mut csv = csv::Writer::from_path(format!("{FOLDER}/speed_accuracy.csv"))?;
    csv.write_record(["scene", "model", "segments", "cost_s", "max_tension_error", "shape_error_per_length"])?;
    for r in rows {
        csv.write_record([
            r.scene.to_owned(),
            r.model.to_string(),
            r.segments.map(|n| n.to_string()).unwrap_or_default(),
            format!("{:.4e}", r.cost_s),
            format!("{:.4e}", r.tension_error),
            format!("{:.4e}", r.shape_error),
        ])?;
    }
    csv.flush()?;
    Ok(())
}

fn panels(rows: &[Row]) -> Vec<Panel> {
    let read: [(&str, Read); 2] = [
        ("error of the largest tension (relative)", |r| r.tension_error),
        ("error of the shape (distance / length)", |r| r.shape_error),
    ];
    let mut out = Vec::new();
    for (y_label, error) in read {
        for (scene, title) in [("hanging-span", "Hanging span"), ("near-taut", "Nearly taut span")] {
            let series =
                [(Model::Catenary, "#000000", 4), (Model::Fem, "#0072B2", 0), (Model::MassSpring, "#D55E00", 3)].map(
                    |(model, colour, corners)| Series {
                        name: match model {
                            Model::Catenary => model.to_string(),
                            _ => format!("{model}, 10 to 640 elements"),
                        },
                        colour,
                        corners,
                        joined: true,
                        points: rows
                            .iter()
                            .filter(|r| r.scene == scene && r.model == model)
                            .map(|r| (r.cost_s, if error(r) < ROUND_OFF { ROUND_OFF } else { error(r) }))
                            .filter(|(_, error)| error.is_finite())
                            .collect(),
                    },
                );
            out.push(Panel {
                title: title.to_owned(),
                x_label: "cost of an answer, wall time (s)",
                y_label,
                x_decades: (-6, 1),
                y_decades: (-16, 0),
                series: series.into(),
            });
        }
    }
    out
}
