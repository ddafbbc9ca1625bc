//! A job solves a scene at rest by every model and keeps what each answers and costs, or why it
//! does not.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use cable_core::{Error, Model, Scene, Settings, Simulation, Solution};

use crate::jobs::background;

/// The result of a model.
#[derive(Clone, Debug)]
pub struct ModelAnswer {
    /// The model.
    pub model: Model,
    /// Its answer and the wall time it took (s), or why there is none.
    pub result: Result<(Arc<Solution>, f64), Error>,
}

/// The answers of all models, and the scene they were asked about.
#[derive(Clone, Debug)]
pub struct ModelComparison {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The models so far, in the order they are listed everywhere.
    pub answers: Vec<ModelAnswer>,
}

/// Its progress.
pub type Progress = background::Progress<ModelComparison>;
/// Models being asked.
pub type Job = background::Job<ModelComparison>;

/// Asks every model; `shown` is called whenever there is something new to show.
#[must_use]
pub fn start(scene: Scene, settings: Settings, shown: impl Fn() + Send + 'static) -> Job {
    let work = move |listen: background::Listener<'_, ModelComparison>| {
        let mut found = ModelComparison { scene: Arc::new(scene), answers: Vec::new() };
        let all = Model::SOLVERS;
        for (k, model) in all.into_iter().enumerate() {
            if listen(k as f64 / all.len() as f64, Some(found.clone())) == ControlFlow::Break(()) {
                return Err("it was ended".to_owned());
            }
            let result = at_rest(&found.scene, model, settings);
            found.answers.push(ModelAnswer { model, result });
        }
        Ok(found)
    };
    background::Job::start("every model", work, shown)
}

fn at_rest(scene: &Scene, model: Model, settings: Settings) -> Result<(Arc<Solution>, f64), Error> {
    let began = Instant::now();
    let mut simulation = Simulation::with_settings(scene.clone(), model, settings)?;
    let solution = simulation.settle()?;
    Ok((Arc::new(solution), began.elapsed().as_secs_f64()))
}
