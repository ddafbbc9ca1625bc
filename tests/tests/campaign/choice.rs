//! This campaign measures the cost of `auto` beside the cheapest setting that is as near as asked.

use std::time::Instant;

use cable_core::scene::View;
use cable_core::{Model, Settings, Simulation, Solution};

use crate::case::Case;
use crate::chance::Chance;
use crate::driver::distance;
use crate::families::FAMILIES;
use crate::judge;
use crate::relations::end_forces;

/// Settings that `auto` is compared with: models, and elements of those that have any.
const MODELS: [Model; 3] = [Model::Catenary, Model::Spans, Model::Fem];
const ELEMENTS: [usize; 7] = [20, 40, 80, 160, 320, 640, 1280];
/// A cost is the least of so many answers.
const REPEATS: usize = 3;
/// A setting that takes so many times as long as the cheapest is not asked with more elements.
const TOO_DEAR: f64 = 30.0;

/// The outcome of all scenes.
#[derive(Debug, Default)]
pub struct Choices {
    /// Scenes with a reference.
    pub scenes: usize,
    /// Those of which `auto` is within its tolerance.
    pub within: usize,
    /// Those of which it is not, and says so.
    pub flagged: usize,
    /// Cost over that of the cheapest setting that is within the tolerance; sorted.
    pub ratios: Vec<f64>,
    /// The same with the family and seed.
    pub dearest: Vec<(f64, String)>,
}

/// The answer and the least time to settle, s.
fn ask(case: &Case, model: Model, segments: Option<usize>) -> Option<(Solution, f64)> {
    let settings = Settings { segments, histories: false, ..Settings::default() };
    let mut least = f64::INFINITY;
    let mut found = None;
    for _ in 0..REPEATS {
        let mut simulation = Simulation::with_settings(case.scene.clone(), model, settings).ok()?;
        let clock = Instant::now();
        found = Some(simulation.settle().ok()?);
        least = least.min(clock.elapsed().as_secs_f64());
    }
    Some((found?, least))
}

/// Returns how far the forces on both ends are from those of a reference, in parts of its greatest
/// tension.
fn off(case: &Case, answer: &Solution, reference: &Solution) -> f64 {
    let (own, right) = (end_forces(answer), end_forces(reference));
    let greatest = judge::greatest(&case.scene, &case.scene.cables[0], &reference.cables[0]);
    (0..2).map(|k| distance(own[k], right[k])).fold(0.0, f64::max) / greatest
}

/// Asks `cases` scenes of each family whose rest is one: without friction, as with it several rests
/// are right.
pub fn compare(first: u64, cases: usize, names: &[String]) -> Choices {
    let mut out = Choices::default();
    let tolerance = Settings::default().tolerance;
    for family in FAMILIES.iter().filter(|f| names.is_empty() || names.iter().any(|n| f.0.contains(n.as_str()))) {
        for seed in first..first + cases as u64 {
            let mut case = family.1(&mut Chance::new(family.0, seed));
            let of_auto = case.model == Model::Auto;
            case.scene.obstacles.iter_mut().for_each(|o| o.friction = Some(0.0));
            case.scene.cables[0].supports.iter_mut().for_each(|s| s.friction = None);
            // In plan view the floor rubs.
            let rests_once = case.scene.view == View::Elevation;
            let (true, Some((answer, cost))) = (of_auto && rests_once, ask(&case, Model::Auto, None)) else { continue };
            // Closed forms and intervals have no mesh; else the finest mesh is the reference.
            let exact = [Model::Catenary, Model::Spans].into_iter().find_map(|m| ask(&case, m, None));
            let Some((reference, _)) = exact.or_else(|| ask(&case, Model::Fem, Some(1280))) else { continue };
            out.scenes += 1;
            let error = off(&case, &answer, &reference);
            let said = answer.cables[0].error_estimate.unwrap_or(0.0);
            out.within += usize::from(error <= tolerance);
            out.flagged += usize::from(error > tolerance && said > tolerance);
            let mut cheapest = f64::INFINITY;
            for model in MODELS {
                let meshes: Vec<_> = if model == Model::Fem { ELEMENTS.map(Some).into() } else { vec![None] };
                for segments in meshes {
                    let Some((found, time)) = ask(&case, model, segments) else { continue };
                    if off(&case, &found, &reference) <= tolerance {
                        cheapest = cheapest.min(time);
                        break;
                    }
                    if time > TOO_DEAR * cheapest {
                        break;
                    }
                }
            }
            if cheapest.is_finite() {
                out.ratios.push(cost / cheapest);
                out.dearest.push((cost / cheapest, format!("{} {seed}: {} in {cost:.2e} s", family.0, answer.model)));
            }
        }
    }
    out.ratios.sort_by(f64::total_cmp);
    out.dearest.sort_by(|a, b| b.0.total_cmp(&a.0));
    out
}
