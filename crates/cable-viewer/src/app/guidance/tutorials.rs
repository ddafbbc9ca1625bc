//! Six guided scenes ask for a few things to do, and the window sees that they were done.

use cable_core::scene::SupportKind;

use crate::command::FileCommand;
use crate::state::tutorial_place::TutorialPlace;
use crate::state::{AppState, Item};

/// A guided scene.
pub struct Tutorial {
    /// The subject that it teaches.
    pub title: &'static str,
    /// Short id of its scene in the catalogue.
    pub scene: &'static str,
    /// The things to do, one after the other.
    pub steps: &'static [TutorialStep],
}

/// A thing to do.
pub struct TutorialStep {
    /// In words.
    pub text: &'static str,
    /// True once the step is done; None: the step is only read.
    pub done: Option<fn(&AppState) -> bool>,
    /// Name of the control or of the thing on the canvas that it speaks of.
    pub points_at: &'static str,
}

/// Returns the step at a place.
#[must_use]
pub fn step(place: TutorialPlace) -> Option<&'static TutorialStep> {
    TUTORIALS.get(place.tutorial)?.steps.get(place.step)
}

/// The command that opens a tutorial.
#[must_use]
pub fn open(tutorial: usize) -> FileCommand {
    FileCommand::OpenTutorial { tutorial, scene: TUTORIALS.get(tutorial).map_or("", |t| t.scene) }
}

const fn act(points_at: &'static str, text: &'static str, done: fn(&AppState) -> bool) -> TutorialStep {
    TutorialStep { text, done: Some(done), points_at }
}

const fn read(points_at: &'static str, text: &'static str) -> TutorialStep {
    TutorialStep { text, done: None, points_at }
}

fn changed(state: &AppState) -> bool {
    state.document.scene != state.document.saved
}

fn supports(state: &AppState) -> usize {
    state.document.scene.cables.first().map_or(0, |c| c.supports.len())
}

fn saved_supports(state: &AppState) -> usize {
    state.document.saved.cables.first().map_or(0, |c| c.supports.len())
}

fn time_s(state: &AppState) -> f64 {
    state.live.latest.solution.as_ref().map_or(0.0, |s| s.time_s)
}

/// All of them, in the order they are best taken.
pub const TUTORIALS: [Tutorial; 6] = [
    Tutorial {
        title: "Drag an end",
        scene: "hanging-span",
        steps: &[
            act(
                "Support right of cable",
                "Drag the right support: the cable follows and its colours show the tension",
                changed,
            ),
            read(
                "Readouts section",
                "Read the greatest tension, its place and the sag on the right: a scale explains the colours, and Readouts has more",
            ),
            act("Edit menu", "Undo it with Ctrl+Z, or Undo in the Edit menu", |s| !changed(s)),
        ],
    },
    Tutorial {
        title: "Change the cable",
        scene: "over-beam",
        steps: &[
            act("Select cable", "Click the cable in the outline on the left: its properties open on the right", |s| {
                matches!(s.selection.selected, Some(Item::Cable(_)))
            }),
            act(
                "Linear density",
                "Choose another preset or move a slider: every property has a unit, a range and a source",
                changed,
            ),
            read(
                "Linear density",
                "Hover over a name to see what it is and how sure its figure is; ≈ marks an estimate",
            ),
            act(
                "Length",
                "Type a length below 9 m: the window says what is wrong before anything fails, and offers the fix",
                |s| s.document.fault.is_some() || s.document.scene.cables.first().is_some_and(|c| c.length_m < 9.0),
            ),
            act("The scene cannot be solved", "Press the fix, or undo", |s| s.document.fault.is_none()),
        ],
    },
    Tutorial {
        title: "Lay it over waypoints",
        scene: "hanging-span",
        steps: &[
            act("Middle of cable", "Double-click the cable: a waypoint, which it slides through", |s| {
                supports(s) > saved_supports(s)
            }),
            act(
                "Support waypoint of cable",
                "Drag the waypoint upwards, and give it a wheel on the right if you like",
                |s| {
                    let of = s.document.scene.cables.first().map(|c| &c.supports);
                    of.is_some_and(|list| {
                        list.iter().any(|p| p.kind == SupportKind::Pulley && p.at_m.is_some_and(|at| at[1] > 4.5))
                    })
                },
            ),
            act("Support waypoint of cable", "Press Delete while it is selected to remove it again", |s| {
                supports(s) == saved_supports(s)
            }),
        ],
    },
    Tutorial {
        title: "Let time run",
        scene: "floor-drag",
        steps: &[
            act("Play", "Press Space: time runs and the graphs fill", |s| time_s(s) > 0.3),
            act("Pause", "Press Space again to stop", |s| s.live.playback.paused),
            act(
                "Timeline",
                "Drag the timeline below the canvas, or press the left arrow, to look at an earlier time",
                |s| s.live.recording.shown_s.is_some(),
            ),
            act("Latest", "Resume from there, or press Latest to come back", |s| s.live.recording.shown_s.is_none()),
        ],
    },
    Tutorial {
        title: "Drive the robot",
        scene: "robot-drive",
        steps: &[
            act("Robot on the canvas", "Hold D: the robot drives to the right and draws its cable along", |s| {
                s.live.latest.solution.as_ref().and_then(|a| a.robot).is_some_and(|r| r.x_m > 10.4)
            }),
            act(
                "Select robot",
                "Click the robot: on the right stands what slows it: slope, ground, cable. Drive on and it stalls or slips",
                |s| s.selection.selected == Some(Item::Robot),
            ),
            act(
                "Find safe reach",
                "Press Find safe reach on the right: it draws where the robot stays below the service tension",
                |s| matches!(s.analysis.safe_reach.progress, crate::jobs::safe_reach::Progress::Done(..)),
            ),
        ],
    },
    Tutorial {
        title: "Compare and save",
        scene: "hanging-span",
        steps: &[
            act("Pin this result", "Press Pin this result under Compare on the right", |s| {
                !s.analysis.references.is_empty()
            }),
            act(
                "Select cable",
                "Select the cable and change its length: both are drawn, and what differs is told under Compare",
                |s| !s.analysis.references.is_empty() && changed(s),
            ),
            read(
                "Export Along the cable",
                "Export… beside a graph writes it as CSV, SVG or PNG; Save run… in the File menu keeps everything",
            ),
        ],
    },
];

#[cfg(test)]
mod tests {
    use cable_core::scene::catalog;

    use super::*;

    #[test]
    fn every_guide_has_its_scene_and_begins_undone() {
        for tutorial in &TUTORIALS {
            let found = catalog::all().into_iter().find(|(id, _)| *id == tutorial.scene);
            let (_, scene) = found.unwrap_or_else(|| panic!("{}", tutorial.scene));
            let state = AppState::new(scene, None);
            let first = tutorial.steps.first().and_then(|s| s.done).expect("begins with something to do");
            assert!(!first(&state), "{}", tutorial.title);
            assert!((3..=5).contains(&tutorial.steps.len()), "{}", tutorial.title);
        }
    }
}
