//! Answers to edits: a draft first where the answer takes long, then the scene laid at rest.

use std::time::Instant;

use cable_core::math::Point;
use cable_core::model::Question;
use cable_core::{Error, Model, Scene, Settings, Simulation};

use super::run::{MOTION, Run, RunStart, is_quasi_static};
use super::{Engine, Phase};
use crate::state::NoAnswer;
use crate::worker::draft;
use crate::worker::request::{Edit, EditStart};
use crate::worker::timing::{DRAFT_AFTER_S, DRAFT_FIRST_S};
use crate::worker::{shape_as_route, winding_number};

impl Engine {
    /// Shows an edit with few segments, if answering it in full would take long; whether it did. A
    /// single edit is answered at once: a draft from an answer takes 0.1 s itself.
    pub(super) fn show_draft(&mut self, edit: &Edit, came_during_solve: bool) -> bool {
        let Some(last) = &self.edit else { return false };
        let same = edit.start != EditStart::NewScene && last.model == edit.model && last.settings == edit.settings;
        let slow =
            self.wall_times.solve_s > if came_during_solve || self.draft() { DRAFT_AFTER_S } else { DRAFT_FIRST_S };
        let later = self.refinement.is_later();
        let (true, Some(old)) = (later && same && slow, self.run.as_ref().map(Run::simulation)) else {
            return false;
        };
        // The answer is another run from its start on, or the same motion: neither is drafted.
        if old.time_s() > 0.0 && (draft::begins_another_run(edit, old) || self.keeps_motion(edit)) {
            return false;
        }
        let falls = draft::settling_draft(edit, old);
        let settling = falls.is_some();
        // Models without a mesh have no fewer segments to be asked with.
        let coarse = || Some(self.rebuild(&draft::coarse_edit(edit, old), Some(old)).ok()?.simulation);
        let draft = if is_quasi_static(old.model()) { falls } else { falls.or_else(coarse) };
        let Some(draft) = draft else { return false };
        self.run = Some(Run::new(draft, RunStart::Lost));
        self.phase = Phase::Draft { settling };
        self.edit = Some(edit.clone());
        true
    }

    /// Solves the scene of a draft in full.
    pub(super) fn solve_draft(&mut self) -> Result<(), Error> {
        let (Phase::Draft { .. }, Some(edit)) = (&self.phase, self.edit.clone()) else { return Ok(()) };
        // The answer is one at rest even where time is to run next: what runs on from the draft
        // itself is still falling, and strikes what it falls on.
        let paused = std::mem::replace(&mut self.playback.paused, true);
        let result = self.take_edit(edit);
        self.playback.paused = paused || result.is_err();
        result
    }

    /// Answers an edit: from the present state, or at rest if time has not run.
    pub(super) fn take_edit(&mut self, edit: Edit) -> Result<(), Error> {
        let began = Instant::now();
        let keeps_motion = self.keeps_motion(&edit);
        if edit.start == EditStart::NewScene {
            (self.run, self.ended_run) = (None, None);
            self.outbox.restart();
        }
        let mut before = self.run.take();
        let old = before.as_ref().map(Run::simulation);
        self.steering.hand = None;
        // Models are compared by what they answer for the scene as laid, not for where another
        // model left the cable.
        let same_model = self.edit.as_ref().is_some_and(|e| e.model == edit.model && e.settings == edit.settings);
        let from = old.filter(|o| same_model || o.time_s() > 0.0);
        let from = from.filter(|o| o.time_s() <= 0.0 || !draft::begins_another_run(&edit, o));
        // Before time has run there is nothing to go on from, whether or not it is to run next.
        let at_rest = from.is_none_or(|o| o.time_s() <= 0.0);
        self.outbox.routes.clear();
        let mut edit = edit;
        // Other histories take longer than the rest itself: each is another rest. Where nobody
        // refines the answer they are asked for at once.
        self.refinement.put_off(at_rest && edit.settings.histories);
        let rebuilt = if at_rest {
            self.settle_edit(&mut edit, from).map(|s| Run::new(s, RunStart::Settled))
        } else {
            self.rebuild(&edit, from).map(|rebuilt| rebuilt.run(before.as_ref()))
        };
        let rebuilt = match (rebuilt, &mut before) {
            // The figures of the run so far are those of the same motion.
            (Ok(run), before) if keeps_motion && !at_rest => Ok(run.with_figures_of(before.take())),
            (rebuilt, _) => rebuilt,
        };
        self.edit = Some(edit);
        self.wall_times.solve_s = began.elapsed().as_secs_f64();
        match rebuilt {
            Ok(run) => {
                self.run = Some(run);
                self.phase = Phase::Answer;
                self.sample();
                Ok(())
            }
            Err(e) => {
                // The old one stays: undoing the edit goes on from it.
                self.run = before.map(Run::unmonitored);
                self.playback.paused = true;
                self.phase = Phase::Refused { reason: NoAnswer::Error(e.clone()) };
                Err(e)
            }
        }
    }

    /// The simulation of a scene at rest: a function of the scene alone, so that typing, undo, load
    /// and reset give the same answer for the same scene. Where that would move a cable through an
    /// obstacle that stays where it is, the way the cable takes now becomes part of the scene.
    pub(super) fn settle_edit(&mut self, edit: &mut Edit, old: Option<&Simulation>) -> Result<Simulation, Error> {
        let histories = edit.settings.histories && !self.refinement.histories_due();
        let settings = Settings { histories, ..edit.settings };
        let of = |scene: &Scene| simulation_at_rest(scene, edit.model, settings);
        let simulation = of(&edit.scene);
        let Some(old) = old.filter(|o| edit.start == EditStart::PresentState && draft::same_cables(edit, o)) else {
            return simulation;
        };
        let tunnelled_cables = match &simulation {
            Ok(simulation) => winding_number::tunnelled_cables(old, simulation),
            // Only a scene that could be solved from where the cable is gets a second look.
            Err(_) if draft::penetrates_new_obstacle(edit, old) => return simulation,
            Err(_) => (0..edit.scene.cables.len()).collect(),
        };
        if tunnelled_cables.is_empty() {
            return simulation;
        }
        let mut scene = edit.scene.clone();
        let routes: Vec<(usize, Vec<Point>)> =
            tunnelled_cables.iter().filter_map(|&k| Some((k, shape_as_route::cable_route(old, k)?))).collect();
        for (k, way) in &routes {
            if let Some(cable) = scene.cables.get_mut(*k) {
                cable.route_m.clone_from(way);
            }
        }
        match of(&scene) {
            Ok(led)
                if simulation.is_err()
                    || winding_number::tunnelled_cables(old, &led).len() < tunnelled_cables.len() =>
            {
                self.outbox.routes = routes;
                edit.scene = scene;
                Ok(led)
            }
            _ => simulation,
        }
    }

    /// Returns whether an edit leaves the motion of the answer on screen as it is.
    fn keeps_motion(&self, edit: &Edit) -> bool {
        let same = |last: &Edit| {
            last.model == edit.model
                && last.settings == edit.settings
                && draft::have_the_same_motion(&last.scene, &edit.scene)
        };
        matches!(self.phase, Phase::Answer) && self.edit.as_ref().is_some_and(same)
    }

    /// The simulation of an edited scene, carrying over where the cables are.
    fn rebuild(&self, edit: &Edit, old: Option<&Simulation>) -> Result<Rebuilt, Error> {
        let time_s = old.map_or(0.0, Simulation::time_s);
        let moves = old.is_some() && (time_s > 0.0 || !self.playback.paused);
        let question = if moves { MOTION } else { Question::Rest };
        let mut is_new_scene = Simulation::for_question(edit.scene.clone(), edit.model, edit.settings, question)?;
        let is_playing = time_s > 0.0 && !self.playback.paused;
        let keeps_motion = self.keeps_motion(edit);
        let stays_inside = if is_playing { draft::is_left_inside_new_obstacle } else { draft::penetrates_new_obstacle };
        if let Some(old) = old
            && draft::same_cables(edit, old)
            && (keeps_motion || !stays_inside(edit, old))
        {
            let mut carried = is_new_scene.clone();
            if carried.carry(old).is_ok() {
                if !self.playback.paused || (keeps_motion && time_s > 0.0) {
                    return Ok(Rebuilt { simulation: carried, outcome: EditOutcome::GoesOn });
                }
                if carried.settle().is_ok() {
                    let outcome = if time_s <= 0.0 { EditOutcome::Settled } else { EditOutcome::BroughtToRest };
                    return Ok(Rebuilt { simulation: carried, outcome });
                }
            }
        }
        is_new_scene.settle()?;
        Ok(Rebuilt { simulation: is_new_scene, outcome: EditOutcome::Settled })
    }

    /// Lays the scene on screen once more and asks what other histories would have left. The rest
    /// is a function of the scene alone, so no figure changes.
    pub(super) fn seek_histories(&mut self) {
        self.refinement.drop_histories();
        let sought = self.edit.as_ref().and_then(|e| simulation_at_rest(&e.scene, e.model, e.settings).ok());
        if let (Some(sought), Some(run)) = (sought, &mut self.run) {
            run.replace(sought);
        }
        self.sample();
        self.show(Ok(()));
    }
}

/// The simulation of an edited scene.
struct Rebuilt {
    simulation: Simulation,
    outcome: EditOutcome,
}

/// The effect of an edit on the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum EditOutcome {
    /// The motion goes on.
    GoesOn,
    /// The cables were moving, and rest where they are now.
    BroughtToRest,
    /// The cables rest, and a run begins.
    Settled,
}

impl Rebuilt {
    /// The run that takes the place of the one `before`.
    fn run(self, before: Option<&Run>) -> Run {
        let run = Run::after(before, self.simulation);
        match self.outcome {
            EditOutcome::GoesOn => run,
            EditOutcome::BroughtToRest => run.at_rest(),
            EditOutcome::Settled => run.with_start(RunStart::Settled),
        }
    }
}

/// A scene laid at rest.
pub(super) fn simulation_at_rest(scene: &Scene, model: Model, settings: Settings) -> Result<Simulation, Error> {
    let mut simulation = Simulation::for_question(scene.clone(), model, settings, Question::Rest)?;
    simulation.settle()?;
    Ok(simulation)
}
