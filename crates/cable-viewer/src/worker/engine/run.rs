//! A run is a simulation in time with its start, its whole steps and its greatest tensions.

use cable_core::model::{Inertia, Question};
use cable_core::solution::Solution;
use cable_core::timeline::{RunMonitor, RunPeaks, TimeDebt, answer_between_steps, make_steps, usual_step};
use cable_core::{Error, Model, Settings, Simulation};

/// The setting with which `auto` chooses a model once time runs.
pub(super) const MOTION: Question = Question::History(Inertia::Dynamic);

/// A simulation in time.
#[derive(Debug)]
pub(super) struct Run {
    simulation: Simulation,
    start: RunStart,
    /// The figures of the run so far; None if it did not begin at rest, as after a change while
    /// time runs.
    monitor: Option<RunMonitor>,
    /// Time that has passed on screen since the last whole step.
    debt: TimeDebt,
    /// An edit brought it to rest at its present time.
    brought_to_rest: bool,
}

/// The start of a run, to which a reset goes back.
#[derive(Clone, Debug)]
pub(super) enum RunStart {
    /// The scene has changed since, or the state is that of another scene: a reset lays the cables
    /// anew.
    Lost,
    /// The simulation was settled from the present scene at t = 0.
    Settled,
    /// The simulation that `auto` chose for rest was settled so; one that can move has taken its
    /// place.
    Rest(Box<Simulation>),
}

impl Run {
    /// A run that goes on from a simulation as it is.
    pub fn new(simulation: Simulation, start: RunStart) -> Self {
        Self { simulation, start, monitor: None, debt: TimeDebt::default(), brought_to_rest: false }
    }

    /// The same for a simulation that takes the place of that of `before` at the same time.
    pub fn after(before: Option<&Self>, simulation: Simulation) -> Self {
        Self { debt: before.map_or_else(TimeDebt::default, |b| b.debt), ..Self::new(simulation, RunStart::Lost) }
    }

    /// The same with another start.
    pub fn with_start(self, start: RunStart) -> Self {
        Self { start, ..self }
    }

    /// The same, which an edit has brought to rest.
    pub fn at_rest(self) -> Self {
        Self { brought_to_rest: true, ..self }
    }

    /// The same with the figures of a run of the same motion.
    pub fn with_figures_of(self, before: Option<Self>) -> Self {
        let Some(before) = before else { return self };
        Self { monitor: before.monitor, brought_to_rest: before.brought_to_rest, ..self }
    }

    /// Returns whether an edit has brought it to rest, and no time has passed since.
    pub fn is_brought_to_rest(&self) -> bool {
        self.brought_to_rest
    }

    /// A copy without the figures of the run: the two coarser runs beside it begin again with the
    /// next start.
    pub fn checkpoint(&self) -> Self {
        Self {
            simulation: self.simulation.clone(),
            start: self.start.clone(),
            monitor: None,
            debt: self.debt,
            brought_to_rest: self.brought_to_rest,
        }
    }

    /// The same run without its figures.
    pub fn unmonitored(self) -> Self {
        Self { monitor: None, ..self }
    }

    /// The simulation at the last whole step.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The simulation of a draft that falls, to change it.
    pub fn simulation_mut(&mut self) -> &mut Simulation {
        &mut self.simulation
    }

    /// Takes the place of the simulation with one of the same start.
    pub fn replace(&mut self, simulation: Simulation) {
        self.simulation = simulation;
    }

    /// Returns whether a reset goes back to where it began.
    pub fn keeps_start(&self) -> bool {
        !matches!(self.start, RunStart::Lost)
    }

    /// Returns the greatest tensions so far, where they are known from the start.
    pub fn peaks(&self) -> Vec<RunPeaks> {
        self.monitor.as_ref().map_or_else(Vec::new, |m| m.peaks().to_vec())
    }

    /// Applies a function to the simulation, and to the coarser ones beside it.
    pub fn steer(&mut self, mut how: impl FnMut(&mut Simulation)) {
        how(&mut self.simulation);
        if let Some(monitor) = &mut self.monitor {
            monitor.steer(how);
        }
    }

    /// Notes that a hand moves a support: a reset cannot go back to the start.
    pub fn draw(&mut self, how: impl FnMut(&mut Simulation)) {
        self.start = RunStart::Lost;
        self.steer(how);
    }

    /// Makes ready for the first step of a run.
    pub fn begin(&mut self, inertia: Inertia, settings: Settings) -> Result<(), Error> {
        let mut starts = self.keeps_start() && self.simulation.time_s() <= 0.0 && self.monitor.is_none();
        if inertia == Inertia::Dynamic && is_quasi_static(self.simulation.model()) {
            let (moving, settled) = moving(&self.simulation, settings)?;
            let rest = std::mem::replace(&mut self.simulation, moving);
            if self.keeps_start() {
                self.start = RunStart::Rest(Box::new(rest));
            }
            starts &= settled;
        }
        if starts {
            self.monitor = Some(RunMonitor::with_errors(&mut self.simulation, inertia));
        }
        Ok(())
    }

    /// Has time pass; returns the whole steps that are due for it.
    pub fn owe(&mut self, time_s: f64, inertia: Inertia) -> u64 {
        self.debt.add(time_s);
        self.debt.take_steps(usual_step(inertia))
    }

    /// Makes a number of whole steps and reads the answer after them.
    pub fn make_steps(&mut self, count: u64, inertia: Inertia) -> Result<(), Error> {
        self.brought_to_rest = false;
        Ok(make_steps(&mut self.simulation, inertia, count, self.monitor.as_mut())?)
    }

    /// Returns the answer at the instant on screen; None where that is a whole step, or there is no
    /// answer.
    pub fn answer_between_steps(&self, inertia: Inertia) -> Option<Solution> {
        let later_s = self.debt.seconds();
        let between = later_s > 0.0;
        between.then(|| answer_between_steps(&self.simulation, inertia, later_s, self.monitor.as_ref()).ok()).flatten()
    }

    /// Goes back to the start; returns whether it could. At the start already it cannot: the scene
    /// is laid anew, which forgets the friction of edits since.
    pub fn back_to_start(&mut self) -> bool {
        if self.simulation.time_s() <= 0.0 {
            return false;
        }
        match std::mem::replace(&mut self.start, RunStart::Settled) {
            RunStart::Lost => {
                self.start = RunStart::Lost;
                return false;
            }
            RunStart::Settled => {}
            RunStart::Rest(rest) => self.simulation = *rest,
        }
        self.simulation.reset();
        (self.monitor, self.debt) = (None, TimeDebt::default());
        true
    }
}

/// The simulation that moves from where the one stands that `auto` chose for rest, and whether it
/// has come to rest there on its own mesh.
fn moving(rest: &Simulation, settings: Settings) -> Result<(Simulation, bool), Error> {
    // The warning of other histories would be lost with the first step.
    let settings = Settings { histories: false, ..settings };
    let mut moving = Simulation::for_question(rest.scene().clone(), Model::Auto, settings, MOTION)?;
    moving.carry(rest)?;
    let mut settled = moving.clone();
    match settled.settle() {
        Ok(_) => Ok((settled, true)),
        Err(_) => Ok((moving, false)),
    }
}

/// Returns true if the user chose a model that lets time run without inertia because it has none.
#[must_use]
pub fn is_quasi_static(model: Model) -> bool {
    !model.capabilities().inertia
}
